#include "imaging/dicom/seg_writer.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmfg/fgderimg.h>
#include <dcmtk/dcmfg/fgfracon.h>
#include <dcmtk/dcmfg/fgpixmsr.h>
#include <dcmtk/dcmfg/fgplanor.h>
#include <dcmtk/dcmfg/fgplanpo.h>
#include <dcmtk/dcmseg/segdoc.h>
#include <dcmtk/dcmseg/segment.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <utility>

#include "base/codes.h"
#include "base/memory.h"
#include "base/purpose.h"
#include "base/system.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/cielab.h"
#include "imaging/common/detail/text.h"
#include "imaging/dicom/detail/dicom_values.h"
#include "imaging/dicom/detail/seg_codes.h"
#include "imaging/dicom/detail/written_values.h"
#include "volume/codes.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSegmentationFile = "structures.dcm";
constexpr const char* kCtFolder = "CT";
constexpr double kCtShare = 0.6;  // of the progress, where a CT is written
// The standard wants a day: this one says nothing.
constexpr const char* kNoDay = "19000101";
constexpr const char* kNoTime = "000000";
constexpr std::size_t kLongestName = 64;  // characters of a LO
constexpr std::uint64_t kMostPixelBytes = 0xFFFFFFFE;

Error cannotWrite(const std::string& what, const fs::path& where, const std::string& next) {
  return Error{code::kCannotWrite, what, cleanUtf8(where.string()), next};
}

Error cancelled() {
  return Error{code::kCancelled, tr("Writing the segmentation was cancelled"), "", ""};
}

// What goes into the file: a structure with voxels, and the slices that hold some.
struct Written {
  Structure structure;
  std::vector<int> slices;
};

// The images that the segmentation is of.
struct Referred {
  std::string study, series, frame_of_reference;
  std::vector<const RawSourceUids::Slice*> of_slice;  // of each k; null: none
};

// As a LO holds it: one line without the separator of values, 64 characters.
std::string labelText(const std::string& name) {
  std::string text = cleanUtf8(name);
  std::ranges::replace(text, '\\', '/');
  std::size_t characters = 0, at = 0;
  for (; at < text.size(); ++at) {
    const bool first = (text[at] & 0xC0) != 0x80;
    if (first && ++characters > kLongestName) break;
  }
  return text.substr(0, at);
}

std::vector<Written> structuresOf(const LabelMap& map, std::vector<std::string>& notes) {
  const GridGeometry& g = map.geometry;
  std::array<std::vector<int>, 256> slices;
  const std::size_t count = std::size_t(g.size[0]) * std::size_t(g.size[1]);
  for (int k = 0; k < g.size[2]; ++k) {
    std::array<bool, 256> met{};
    const std::uint8_t* label = map.labels.data() + std::size_t(k) * count;
    for (std::size_t n = 0; n < count; ++n) met[label[n]] = true;
    for (std::size_t value = 1; value < met.size(); ++value) {
      if (met[value]) slices[value].push_back(k);
    }
  }
  std::vector<Written> all;
  std::array<bool, 256> named{};
  for (const Structure& structure : map.structures) {
    const bool fits = structure.label > 0 && structure.label < 256;
    if (!fits || slices[std::size_t(structure.label)].empty()) {
      notes.push_back(
          tr("The structure \"{}\" has no voxel and was left out.", cleanUtf8(structure.name)));
      continue;
    }
    const auto label = std::size_t(structure.label);
    if (std::exchange(named[label], true)) continue;
    all.push_back({structure, slices[label]});
    Structure& written = all.back().structure;
    written.name = labelText(structure.name);
    if (written.name.empty()) written.name = "label " + std::to_string(label);
    if (cleanUtf8(structure.name).size() > written.name.size()) {
      notes.push_back(tr("The name \"{}\" was cut to 64 characters.", written.name));
    }
  }
  for (std::size_t label = 1; label < 256; ++label) {
    if (named[label] || slices[label].empty()) continue;
    const int number = int(label);
    all.push_back(
        {{number, "label " + std::to_string(number), labelColour(number)}, slices[label]});
  }
  return all;
}

std::string identityOf(const LabelMap& map, const std::vector<Written>& structures,
                       const Referred& ct) {
  std::string identity = ct.study + "\n" + ct.series + "\n" + labelsSha256(map);
  const GridGeometry& g = map.geometry;
  for (const Vec3& v : {g.spacing_mm, g.origin_mm, g.direction[0], g.direction[1]}) {
    identity += "\n" + decimalsText({v.x, v.y, v.z});
  }
  for (const auto& [structure, slices] : structures) {
    const LabWords lab = labOf(structure.colour);
    identity += "\n" + std::to_string(structure.label) + " " + structure.name;
    for (const std::uint16_t word : lab) identity += " " + std::to_string(word);
  }
  return identity;
}

// Keeps the first fault of many steps.
class Steps {
 public:
  void operator()(const OFCondition& condition) {
    if (first_.good()) first_ = condition;
  }
  bool good() const { return first_.good(); }
  const char* text() const { return first_.text(); }

 private:
  OFCondition first_;
};

std::unique_ptr<DcmSegment> segmentOf(const Structure& structure, Steps& step) {
  const SegmentCodes codes = segmentCodesOf(structure.name);
  DcmSegment* made = nullptr;
  // Its name follows in the data set: DCMTK takes ASCII alone here.
  step(DcmSegment::create(made, "structure",
                          CodeSequenceMacro(codes.category.value, "SCT", codes.category.meaning),
                          CodeSequenceMacro(codes.type.value, "SCT", codes.type.meaning),
                          DcmSegTypes::SAT_SEMIAUTOMATIC, "Trephine"));
  std::unique_ptr<DcmSegment> segment(made);
  if (!segment) return nullptr;
  const LabWords lab = labOf(structure.colour);
  step(segment->setRecommendedDisplayCIELabValue(lab[0], lab[1], lab[2]));
  return segment;
}

void describe(DcmSegmentation& segmentation, const GridGeometry& g, const Referred& ct,
              const std::string& identity, Steps& step) {
  step(segmentation.getSOPCommon().setSpecificCharacterSet("ISO_IR 192"));
  step(segmentation.getSOPCommon().setSOPInstanceUID(uidOf(identity + "\ninstance").c_str()));
  step(segmentation.getStudy().setStudyInstanceUID(ct.study.c_str()));
  step(segmentation.getSeries().setSeriesInstanceUID(uidOf(identity + "\nseries").c_str()));
  step(segmentation.getSeries().setSeriesNumber("2"));
  step(segmentation.getSeries().setSeriesDescription("Structures"));
  step(segmentation.getFrameOfReference().setFrameOfReferenceUID(ct.frame_of_reference.c_str()));

  const std::string organization = uidOf(identity + "\ndimensions");
  IODMultiframeDimensionModule& dimensions = segmentation.getDimensions();
  step(dimensions.addDimensionIndex(DCM_ReferencedSegmentNumber, organization.c_str(),
                                    DCM_SegmentIdentificationSequence, "Segment"));
  step(dimensions.addDimensionIndex(DCM_ImagePositionPatient, organization.c_str(),
                                    DCM_PlanePositionSequence, "Slice"));

  FGPixelMeasures measures;
  step(measures.setPixelSpacing(decimalsText({g.spacing_mm.y, g.spacing_mm.x}).c_str()));
  step(measures.setSliceThickness(decimalText(g.spacing_mm.z).c_str()));
  step(measures.setSpacingBetweenSlices(decimalText(g.spacing_mm.z).c_str()));
  step(segmentation.addForAllFrames(measures));
  FGPlaneOrientationPatient turned;
  const Vec3 row = g.direction[0], column = g.direction[1];
  step(turned.setImageOrientationPatient(
      decimalText(row.x).c_str(), decimalText(row.y).c_str(), decimalText(row.z).c_str(),
      decimalText(column.x).c_str(), decimalText(column.y).c_str(), decimalText(column.z).c_str()));
  step(segmentation.addForAllFrames(turned));
}

// The images that frames are of, listed once for the whole file.
void listReferences(DcmSegmentation& segmentation, const Referred& ct, Steps& step) {
  auto series = std::make_unique<IODSeriesAndInstanceReferenceMacro::ReferencedSeriesItem>();
  step(series->setSeriesInstanceUID(ct.series.c_str()));
  std::vector<std::string> listed;
  for (const RawSourceUids::Slice* slice : ct.of_slice) {
    if (!slice || (!listed.empty() && listed.back() == slice->sop_instance)) continue;
    listed.push_back(slice->sop_instance);
    auto image = std::make_unique<SOPInstanceReferenceMacro>();
    step(image->setReferencedSOPClassUID(slice->sop_class.c_str()));
    step(image->setReferencedSOPInstanceUID(slice->sop_instance.c_str()));
    series->getReferencedInstanceItems().push_back(image.release());
  }
  if (listed.empty()) return;
  segmentation.getCommonInstanceReference().getReferencedSeriesItems().push_back(series.release());
}

std::unique_ptr<FGDerivationImage> derivationOf(const RawSourceUids::Slice* slice, Steps& step) {
  if (!slice) return std::make_unique<FGDerivationImage>();
  ImageSOPInstanceReferenceMacro image;
  step(image.setReferencedSOPClassUID(slice->sop_class.c_str()));
  step(image.setReferencedSOPInstanceUID(slice->sop_instance.c_str()));
  if (slice->frame > 0) step(image.addReferencedFrameNumber(Uint16(slice->frame)));
  OFVector<ImageSOPInstanceReferenceMacro> images;
  images.push_back(image);
  std::unique_ptr<FGDerivationImage> derivation(
      DcmSegmentation::createDerivationImageFG(images, ""));
  if (!derivation) step(EC_IllegalParameter);
  return derivation;
}

// The frames of one structure, their bits appended to those before.
struct Frames {
  const LabelMap& map;
  const Referred& ct;
  std::vector<Uint8>& bits;
  std::uint64_t bit = 0;
  std::vector<Uint8> mask{};

  void add(DcmSegmentation& segmentation, const Written& written, Uint16 number, int k,
           Steps& step) {
    const GridGeometry& g = map.geometry;
    const std::size_t count = std::size_t(g.size[0]) * std::size_t(g.size[1]);
    mask.resize(count);
    const std::uint8_t* label = map.labels.data() + std::size_t(k) * count;
    for (std::size_t n = 0; n < count; ++n, ++bit) {
      mask[n] = label[n] == written.structure.label;
      if (mask[n]) bits[bit / 8] |= Uint8(1 << bit % 8);
    }
    FGFrameContent content;
    step(content.setDimensionIndexValues(number, 0));
    step(content.setDimensionIndexValues(Uint32(k) + 1, 1));
    FGPlanePosPatient position;
    const Vec3 p = g.toPatient_mm(Vec3(0.0, 0.0, k));
    step(position.setImagePositionPatient(decimalText(p.x).c_str(), decimalText(p.y).c_str(),
                                          decimalText(p.z).c_str()));
    const auto derivation = derivationOf(ct.of_slice[std::size_t(k)], step);
    if (!step.good()) return;
    OFVector<FGBase*> groups;
    groups.push_back(&content);
    groups.push_back(&position);
    groups.push_back(derivation.get());
    step(segmentation.addFrame(mask.data(), number, groups));
  }
};

std::uint64_t pixelBytes(const GridGeometry& g, const std::vector<Written>& structures) {
  std::uint64_t frames = 0;
  for (const Written& one : structures) frames += one.slices.size();
  return (frames * std::uint64_t(g.size[0]) * std::uint64_t(g.size[1]) + 7) / 8;
}

Status writeSegmentation(const LabelMap& map, const std::vector<Written>& structures,
                         const Referred& ct, const CtSeriesText& text, const fs::path& file,
                         const fs::path& folder, const Progress& progress) {
  const std::string identity = identityOf(map, structures, ct);
  const std::string build = buildName();
  Steps step;
  DcmSegmentation* made = nullptr;
  step(DcmSegmentation::createBinarySegmentation(
      made, Uint16(map.geometry.size[1]), Uint16(map.geometry.size[0]),
      IODGeneralEquipmentModule::EquipmentInfo("Trephine", "Trephine", "0", build.c_str()),
      ContentIdentificationMacro("1", "STRUCTURES", "", "")));
  const std::unique_ptr<DcmSegmentation> segmentation(made);
  const auto failed = [&] {
    return cannotWrite(tr("The segmentation cannot be written: {}", step.text()), folder,
                       tr("Check that the disk has room"));
  };
  if (!segmentation) return failed();
  describe(*segmentation, map.geometry, ct, identity, step);
  listReferences(*segmentation, ct, step);

  // DCMTK's own packing loses bits where rows x columns is no multiple of eight.
  std::vector<Uint8> bits((pixelBytes(map.geometry, structures) + 1) / 2 * 2);
  Frames frames{map, ct, bits};
  for (std::size_t n = 0; n < structures.size() && step.good(); ++n) {
    std::unique_ptr<DcmSegment> segment = segmentOf(structures[n].structure, step);
    Uint16 number = 0;
    if (step.good()) step(segmentation->addSegment(segment.release(), number));
    for (const int k : structures[n].slices) {
      if (progress.cancelled()) return cancelled();
      if (step.good()) frames.add(*segmentation, structures[n], number, k, step);
    }
    progress.at(0.8 * double(n + 1) / double(structures.size()), tr("Writing structures"));
  }
  // Both checks compare every frame with every other.
  segmentation->setCheckFGOnWrite(OFFalse);
  segmentation->setCheckDimensionsOnWrite(OFFalse);
  DcmFileFormat dicom;
  DcmDataset& data = *dicom.getDataset();
  if (step.good()) step(segmentation->writeDataset(data));
  step(data.putAndInsertString(DCM_ImageComments, kPurpose));
  step(data.putAndInsertString(DCM_ContentDate, kNoDay));
  step(data.putAndInsertString(DCM_ContentTime, kNoTime));
  step(data.putAndInsertString(DCM_PatientName, cleanUtf8(text.patient_name).c_str()));
  step(data.putAndInsertString(DCM_PatientID, cleanUtf8(text.patient_id).c_str()));
  const std::vector<DcmItem*> segments = DicomItem(&data).items(DCM_SegmentSequence);
  if (segments.size() != structures.size()) step(EC_CorruptedData);
  for (std::size_t n = 0; n < structures.size() && step.good(); ++n) {
    step(segments[n]->putAndInsertString(DCM_SegmentLabel, structures[n].structure.name.c_str()));
  }
  step(data.putAndInsertUint8Array(DCM_PixelData, bits.data(),
                                   static_cast<unsigned long>(bits.size())));
  if (!step.good()) return failed();
  if (progress.cancelled()) return cancelled();
  step(dicom.saveFile(file.c_str(), EXS_LittleEndianExplicit, EET_ExplicitLength, EGL_recalcGL));
  if (!step.good()) return failed();
  return {};
}

// What a source's slices lie nearest to.
Referred referredTo(const RawSourceUids& source, const GridGeometry& g) {
  Referred ct{source.study, source.series, source.frame_of_reference,
              std::vector<const RawSourceUids::Slice*>(std::size_t(g.size[2]))};
  std::vector<double> distance(ct.of_slice.size(), 0.5 + 1e-6);
  for (const RawSourceUids::Slice& slice : source.slices) {
    const double at = glm::dot(slice.position_mm - g.origin_mm, g.direction[2]) / g.spacing_mm.z;
    if (!(std::abs(at) < 1e6)) continue;
    for (const int k : {int(std::floor(at)), int(std::floor(at)) + 1}) {
      if (k < 0 || k >= g.size[2] || std::abs(at - k) >= distance[std::size_t(k)]) continue;
      distance[std::size_t(k)] = std::abs(at - k);
      ct.of_slice[std::size_t(k)] = &slice;
    }
  }
  return ct;
}

bool isUid(const std::string& text) {
  return !text.empty() && text.size() <= 64 && text.find_first_not_of("0123456789.") == text.npos;
}

Status checkSource(const RawSourceUids& source) {
  const bool named =
      isUid(source.study) && isUid(source.series) && isUid(source.frame_of_reference);
  const bool slices = std::ranges::all_of(source.slices, [](const RawSourceUids::Slice& slice) {
    return isUid(slice.sop_class) && isUid(slice.sop_instance) && slice.frame >= 0 &&
           slice.frame <= 65535;
  });
  if (named && slices) return {};
  return Error{code::kBadSource, tr("The CT lacks UIDs that a segmentation of it has to name"), "",
               tr("Write the CT anew with the structures")};
}

// A folder beside the targets, on the same disk; gone at the end with what is left in it.
class Unfinished {
 public:
  explicit Unfinished(const fs::path& folder) : path_((folder / ".writing-XXXXXX").string()) {
    made_ = ::mkdtemp(path_.data()) != nullptr;
  }
  ~Unfinished() {
    std::error_code error;
    if (made_) fs::remove_all(path_, error);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  bool made() const { return made_; }
  fs::path path() const { return path_; }

 private:
  std::string path_;
  bool made_ = false;
};

// Puts what was finished in place: all of it or nothing.
Status putInPlace(const fs::path& from, const std::vector<const char*>& names,
                  const fs::path& folder) {
  std::error_code error;
  for (std::size_t n = 0; n < names.size(); ++n) {
    fs::rename(from / names[n], folder / names[n], error);
    if (!error) continue;
    std::error_code ignored;
    for (std::size_t done = 0; done < n; ++done) {
      fs::rename(folder / names[done], from / names[done], ignored);
    }
    return cannotWrite(tr("The segmentation cannot be put in place"), folder,
                       tr("Choose another place"));
  }
  return {};
}

Result<WrittenStructures> write(const Volume& ct, const LabelMap& map, const fs::path& folder,
                                const SegWriting& writing, const Progress& progress) {
  setUpDcmtk();
  if (const Status valid = checkCtSeries(ct, folder); !valid) return valid.error();
  if (!(map.geometry == ct.geometry) || map.labels.size() != ct.geometry.voxelCount()) {
    return Error{code::kLabelsElsewhere, tr("The structures do not lie on the grid of the CT"), "",
                 tr("Fit them to it first")};
  }
  if (writing.source) {
    if (const Status named = checkSource(*writing.source); !named) return named.error();
  }
  WrittenStructures written;
  const std::vector<Written> structures = structuresOf(map, written.notes);
  if (structures.empty()) {
    return Error{code::kNoStructures, tr("No structure has a voxel, so there is nothing to write"),
                 "", ""};
  }
  const std::uint64_t bytes = pixelBytes(map.geometry, structures);
  if (bytes > kMostPixelBytes) {
    return Error{code::kTooLarge, tr("The structures are more than a DICOM file holds"), "",
                 tr("Write fewer of them")};
  }
  // Its bits, and DCMTK's two copies of them.
  if (Status enough =
          enoughMemory(3.0 * double(bytes) / 1048576.0, tr("Writing the segmentation"), "");
      !enough) {
    return enough.error();
  }

  std::error_code error;
  const bool was_there = fs::is_directory(folder, error);
  fs::create_directories(folder, error);
  if (error)
    return cannotWrite(tr("The folder cannot be made"), folder, tr("Choose another place"));
  const auto giveUp = [&](Error why) {
    // An empty folder that was made for this goes as well; another stays.
    if (!was_there) fs::remove(folder, error);
    return why;
  };
  std::vector<const char*> names{kSegmentationFile};
  if (!writing.source) names.push_back(kCtFolder);
  for (const char* name : names) {
    if (fs::symlink_status(folder / name, error).type() == fs::file_type::not_found) continue;
    return giveUp(cannotWrite(tr("The folder already holds \"{}\"", name), folder,
                              tr("Choose an empty folder")));
  }
  Status done;
  {
    const Unfinished unfinished(folder);
    if (!unfinished.made()) {
      return giveUp(
          cannotWrite(tr("The folder cannot be written to"), folder, tr("Choose another place")));
    }
    RawSourceUids own;  // of the CT that is written
    if (!writing.source) {
      const CtSeriesUids uids = ctSeriesUids(ct, writing.text);
      own = {uids.study, uids.series, uids.frame_of_reference};
      for (int k = 0; k < ct.geometry.size[2]; ++k) {
        own.slices.push_back({UID_CTImageStorage, uids.slices[std::size_t(k)], 0,
                              ct.geometry.toPatient_mm(Vec3(0.0, 0.0, k))});
      }
      done = writeCtSeries(ct, writing.text, unfinished.path() / kCtFolder,
                           Progress(progress, 0.0, kCtShare));
      if (!done && done.error().code == code::kCannotWrite) {
        done = cannotWrite(done.error().what, folder, done.error().next);
      }
    }
    if (done) {
      const RawSourceUids& source = writing.source ? *writing.source : own;
      done = writeSegmentation(map, structures, referredTo(source, map.geometry), writing.text,
                               unfinished.path() / kSegmentationFile, folder,
                               Progress(progress, writing.source ? 0.0 : kCtShare, 1.0));
    }
    if (done && progress.cancelled()) done = cancelled();
    if (done) done = putInPlace(unfinished.path(), names, folder);
  }
  if (!done) return giveUp(done.error());
  progress.at(1.0, tr("Done"));
  return written;
}

}  // namespace

Result<WrittenStructures> writeStructuresAsDicom(const Volume& ct, const LabelMap& map,
                                                 const fs::path& folder, const SegWriting& writing,
                                                 const Progress& progress) {
  try {
    return write(ct, map, folder, writing, progress);
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("to write the segmentation"), "");
  }
}

}  // namespace trephine
