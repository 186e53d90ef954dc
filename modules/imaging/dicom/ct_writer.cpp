#include "imaging/dicom/ct_writer.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>

#include "base/codes.h"
#include "base/purpose.h"
#include "base/tr.h"
#include "imaging/common/detail/text.h"
#include "imaging/dicom/detail/written_values.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr int kUnsignedOffset = 1024;

struct Writing {
  const Volume& volume;
  CtSeriesText text;
  CtSeriesUids uids;
  bool is_unsigned;
};

std::string identityOf(const Volume& volume, const CtSeriesText& text) {
  const GridGeometry& g = volume.geometry;
  std::string identity = volumeSha256(volume) + text.series_description + "\n" + text.body_part;
  for (const Vec3& v :
       {g.spacing_mm, g.origin_mm, g.direction[0], g.direction[1], g.direction[2]}) {
    identity += '\n';
    identity += decimalsText({v.x, v.y, v.z});
  }
  return identity;
}

OFCondition fillSlice(DcmDataset& data, const Writing& writing, int k, std::vector<Uint16>& words) {
  const GridGeometry& g = writing.volume.geometry;
  const Vec3 position = g.toPatient_mm(Vec3(0.0, 0.0, k));
  const Vec3 row = g.direction[0], column = g.direction[1];
  OFCondition result = EC_Normal;
  const auto put = [&](const DcmTagKey& tag, const std::string& value) {
    if (result.good()) result = data.putAndInsertString(tag, value.c_str());
  };
  const auto put16 = [&](const DcmTagKey& tag, int value) {
    if (result.good()) result = data.putAndInsertUint16(tag, Uint16(value));
  };
  // SOP Common, Patient, General Study, General Series, Frame of Reference, General Equipment.
  put(DCM_SpecificCharacterSet, "ISO_IR 192");
  put(DCM_SOPClassUID, UID_CTImageStorage);
  put(DCM_SOPInstanceUID, writing.uids.slices[std::size_t(k)]);
  put(DCM_StudyInstanceUID, writing.uids.study);
  put(DCM_SeriesInstanceUID, writing.uids.series);
  put(DCM_FrameOfReferenceUID, writing.uids.frame_of_reference);
  put(DCM_PatientName, writing.text.patient_name);
  put(DCM_PatientID, writing.text.patient_id);
  for (const DcmTagKey& empty :
       {DCM_PatientBirthDate, DCM_PatientSex, DCM_StudyDate, DCM_StudyTime, DCM_StudyID,
        DCM_AccessionNumber, DCM_ReferringPhysicianName, DCM_PositionReferenceIndicator, DCM_KVP,
        DCM_AcquisitionNumber, DCM_PatientPosition}) {
    put(empty, "");
  }
  put(DCM_Manufacturer, "Trephine");
  put(DCM_Modality, "CT");
  put(DCM_SeriesNumber, "1");
  put(DCM_SeriesDescription, writing.text.series_description);
  put(DCM_BodyPartExamined, writing.text.body_part);
  // General Image, Image Plane, CT Image.
  put(DCM_ImageType, "DERIVED\\PRIMARY\\AXIAL");
  put(DCM_ImageComments, kPurpose);
  put(DCM_InstanceNumber, std::to_string(k + 1));
  put(DCM_ImagePositionPatient, decimalsText({position.x, position.y, position.z}));
  put(DCM_ImageOrientationPatient,
      decimalsText({row.x, row.y, row.z, column.x, column.y, column.z}));
  put(DCM_PixelSpacing, decimalsText({g.spacing_mm.y, g.spacing_mm.x}));
  put(DCM_SliceThickness, decimalText(g.spacing_mm.z));
  put(DCM_RescaleIntercept, writing.is_unsigned ? std::to_string(-kUnsignedOffset) : "0");
  put(DCM_RescaleSlope, "1");
  put(DCM_RescaleType, "HU");
  // Image Pixel.
  put16(DCM_SamplesPerPixel, 1);
  put(DCM_PhotometricInterpretation, "MONOCHROME2");
  put16(DCM_Rows, g.size[1]);
  put16(DCM_Columns, g.size[0]);
  put16(DCM_BitsAllocated, 16);
  put16(DCM_BitsStored, 16);
  put16(DCM_HighBit, 15);
  put16(DCM_PixelRepresentation, writing.is_unsigned ? 0 : 1);
  const std::int16_t* hu = writing.volume.hu.data() + std::size_t(k) * words.size();
  const int offset = writing.is_unsigned ? kUnsignedOffset : 0;
  std::ranges::transform(hu, hu + words.size(), words.begin(),
                         [offset](std::int16_t v) { return Uint16(v + offset); });
  if (result.good()) {
    result = data.putAndInsertUint16Array(DCM_PixelData, words.data(), words.size());
  }
  return result;
}

Error cannotWrite(const std::string& what, const fs::path& where, const std::string& next) {
  return Error{code::kCannotWrite, what, cleanUtf8(where.string()), next};
}

bool isOurs(const fs::path& file, const std::string& patient_name) {
  std::ifstream in(file, std::ios::binary);
  std::string head(4096, '\0');
  in.read(head.data(), std::streamsize(head.size()));
  head.resize(std::size_t(in.gcount()));
  return !patient_name.empty() && head.find(patient_name) != head.npos;
}

// Slices in `folder` that were written for a patient of that name, a phantom, make room for the new
// ones; anything else called like one of ours forbids writing.
Result<std::set<fs::path>> earlierSlices(const fs::path& folder, int slices,
                                         const std::string& patient_name) {
  std::set<fs::path> earlier;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (!name.starts_with("IM") || !name.ends_with(".dcm")) continue;
    if (isOurs(it->path(), patient_name)) earlier.insert(it->path());
  }
  if (error)
    return cannotWrite(tr("The folder cannot be read"), folder, tr("Choose another folder"));
  for (int k = 0; k < slices; ++k) {
    const fs::path target = folder / sliceFileName(k);
    if (fs::exists(target, error) && !earlier.contains(target)) {
      return cannotWrite(tr("The folder holds a scan of its own"), folder,
                         tr("Choose an empty folder"));
    }
  }
  return earlier;
}

}  // namespace

Status checkCtSeries(const Volume& volume, const fs::path& folder) {
  const GridGeometry& g = volume.geometry;
  if (const Status size = checkSize(g.size, ""); !size) {
    return cannotWrite(size.error().what, folder, "");
  }
  if (g.size[0] > 65535 || g.size[1] > 65535 || g.voxelCount() != volume.hu.size()) {
    return cannotWrite(tr("A volume of this size does not fit DICOM"), folder, tr("Crop it"));
  }
  const Mat3 product = glm::transpose(g.direction) * g.direction;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (!(std::abs(product[i][j] - (i == j ? 1.0 : 0.0)) < 1e-6) || !(g.spacing_mm[i] > 0.0)) {
        return cannotWrite(
            tr("The volume's axes are not perpendicular or its spacing not positive"), folder,
            tr("Resample it"));
      }
    }
  }
  return {};
}

std::string sliceFileName(int k) {
  char name[32];
  std::snprintf(name, sizeof name, "IM%04d.dcm", k + 1);
  return name;
}

CtSeriesUids ctSeriesUids(const Volume& volume, const CtSeriesText& text) {
  const std::string identity = identityOf(volume, text);
  CtSeriesUids uids{uidOf(identity + "\nstudy"), uidOf(identity + "\nseries"),
                    uidOf(identity + "\nframe")};
  for (int k = 0; k < volume.geometry.size[2]; ++k) {
    uids.slices.push_back(uidOf(identity + "\nslice " + std::to_string(k)));
  }
  return uids;
}

Status writeCtSeries(const Volume& volume, const CtSeriesText& text, const fs::path& folder,
                     const Progress& progress) {
  if (const Status valid = checkCtSeries(volume, folder); !valid) return valid;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    return cannotWrite(tr("The folder cannot be made"), folder, tr("Choose another place"));
  const int slices = volume.geometry.size[2];
  const auto earlier = earlierSlices(folder, slices, text.patient_name);
  if (!earlier) return earlier.error();

  // All slices first go to a folder beside the targets, on the same disk, so that a full disk or a
  // cancel leaves what was there.
  std::string pattern = (folder / ".writing-XXXXXX").string();
  if (!::mkdtemp(pattern.data())) {
    return cannotWrite(tr("The folder cannot be written to"), folder, tr("Choose another place"));
  }
  const fs::path unfinished = pattern;
  const auto giveUp = [&](Error reason) -> Status {
    fs::remove_all(unfinished, error);
    return reason;
  };

  const Writing writing{volume,
                        {cleanUtf8(text.series_description), cleanUtf8(text.body_part),
                         cleanUtf8(text.patient_name), cleanUtf8(text.patient_id)},
                        ctSeriesUids(volume, text),
                        *std::ranges::min_element(volume.hu) >= -kUnsignedOffset};
  std::vector<Uint16> words(std::size_t(volume.geometry.size[0]) * volume.geometry.size[1]);
  for (int k = 0; k < slices; ++k) {
    if (progress.cancelled()) {
      return giveUp({code::kCancelled, tr("Writing the CT series was cancelled"), "", ""});
    }
    progress.at(double(k) / slices, tr("Writing slices"));
    DcmFileFormat file;
    OFCondition written = fillSlice(*file.getDataset(), writing, k, words);
    if (written.good()) {
      written = file.saveFile((unfinished / sliceFileName(k)).c_str(), EXS_LittleEndianExplicit,
                              EET_ExplicitLength, EGL_recalcGL);
    }
    if (written.bad()) {
      return giveUp(cannotWrite(tr("A slice cannot be written: {}", written.text()), folder,
                                tr("Check that the disk has room")));
    }
  }
  for (const fs::path& old : *earlier) fs::remove(old, error);
  for (int k = 0; k < slices; ++k) {
    fs::rename(unfinished / sliceFileName(k), folder / sliceFileName(k), error);
    if (error) {
      return giveUp(
          cannotWrite(tr("A slice cannot be put in place"), folder, tr("Choose another place")));
    }
  }
  fs::remove_all(unfinished, error);
  progress.at(1.0, tr("Done"));
  return {};
}

}  // namespace trephine
