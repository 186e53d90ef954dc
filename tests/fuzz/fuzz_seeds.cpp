// Writes the inputs that the fuzzer starts from: tiny series in every transfer syntax and shape
// that the importer tells apart, and small files of real media. See README.md.
//
// usage: fuzz_seeds FOLDER CODESTREAMS [MEDIA]
//   CODESTREAMS holds HTJ2K pictures, MEDIA folders of DICOM files that are hard to read.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcrleerg.h>
#include <dcmtk/dcmdata/dcrlerp.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djencode.h>
#include <dcmtk/dcmjpeg/djrplol.h>
#include <dcmtk/dcmjpeg/djrploss.h>
#include <dcmtk/dcmjpls/djencode.h>
#include <dcmtk/dcmjpls/djrparam.h>

#include <algorithm>
#include <map>

#include "seed_maker.h"
#include "volume/phantom.h"
#include "volume/volume_files.h"

namespace trephine::fuzz {

namespace {

// Every transfer syntax of imaging/dicom/transfer_syntax.cpp.
void addSyntaxes(const Seeds& seeds, const Series& plain, const fs::path& codestreams) {
  const auto keep = [](DcmDataset&, int) {};
  seeds.add("implicit", changed(plain, keep, EXS_LittleEndianImplicit));
  seeds.add("explicit", plain);
  seeds.add("big_endian", changed(plain, keep, EXS_BigEndianExplicit));
  seeds.add("deflated", changed(plain, keep, EXS_DeflatedLittleEndianExplicit));

  const DcmRLERepresentationParameter rle;
  const DJ_RPLossy lossy;
  const DJ_RPLossless lossless;
  const DJLSRepresentationParameter ls(0, OFTrue), near_ls(2, OFFalse);
  const struct {
    const char* name;
    E_TransferSyntax syntax;
    int bits;
    const DcmRepresentationParameter* parameter;
  } encoders[] = {{"rle", EXS_RLELossless, 16, &rle},
                  {"rle_8", EXS_RLELossless, 8, &rle},
                  {"jpeg_baseline", EXS_JPEGProcess1, 8, &lossy},
                  {"jpeg_extended", EXS_JPEGProcess2_4, 12, &lossy},
                  {"jpeg_lossless", EXS_JPEGProcess14, 16, &lossless},
                  {"jpeg_lossless_1", EXS_JPEGProcess14SV1, 16, &lossless},
                  {"jpeg_lossless_8", EXS_JPEGProcess14SV1, 8, &lossless},
                  {"jpeg_ls", EXS_JPEGLSLossless, 16, &ls},
                  {"jpeg_ls_near", EXS_JPEGLSLossy, 12, &near_ls}};
  for (const auto& e : encoders) {
    const auto encode = [&](DcmDataset& data, int) {
      narrow(data, e.bits);
      demand(data.chooseRepresentation(e.syntax, e.parameter).good(),
             std::string("encode ") + e.name);
    };
    seeds.add(e.name, changed(plain, encode, e.syntax));
  }
  const struct {
    const char* name;
    E_TransferSyntax syntax;
    bool irreversible, jp2;
  } pictures[] = {{"jpeg2000", EXS_JPEG2000LosslessOnly, false, false},
                  {"jpeg2000_lossy", EXS_JPEG2000, true, false},
                  {"jpeg2000_jp2", EXS_JPEG2000, false, true}};
  for (const auto& p : pictures) {
    const auto encode = [&](DcmDataset& data, int) {
      encapsulate(data, p.syntax, jpeg2000(data, p.irreversible, p.jp2));
    };
    seeds.add(p.name, changed(plain, encode, p.syntax));
  }
  // DCMTK 3.6.7 does not know HTJ2K, so that its UID replaces one as long in the finished file.
  const Bytes known = UID_HEVCMainProfileLevel5_1TransferSyntax;
  const Bytes high_throughput = "1.2.840.10008.1.2.4.203";
  const Series large = seriesOf(ramp({64, 48, 4}));
  for (const auto& entry : fs::directory_iterator(codestreams)) {
    if (entry.path().extension() != ".j2c") continue;
    const auto encode = [&](DcmDataset& data, int) {
      encapsulate(data, EXS_HEVCMainProfileLevel5_1, read(entry.path()));
    };
    Series series = changed(large, encode, EXS_HEVCMainProfileLevel5_1);
    for (Bytes& bytes : series) {
      const std::size_t at = bytes.find(known);
      demand(at != bytes.npos && known.size() == high_throughput.size(), "find a transfer syntax");
      bytes.replace(at, known.size(), high_throughput);
    }
    seeds.add(entry.path().stem().string(), series);
  }
}

// What slices can be to each other, and how their words can be stored.
void addShapes(const Seeds& seeds, const Series& plain) {
  const std::pair<const char*, Change> shapes[] = {
      {"missing", [](DcmDataset& d, int n) { putPlace(d, 0, n < 2 ? n : n + 1); }},
      {"uneven", [](DcmDataset& d, int n) { putPlace(d, 0, n * n); }},
      {"jittered", [](DcmDataset& d, int n) { putPlace(d, 0, n + 0.05 * (n % 2)); }},
      {"tilted", [](DcmDataset& d, int n) { putPlace(d, 0.3 * n, n); }},
      {"shifted", [](DcmDataset& d, int n) { putPlace(d, n % 2, n); }},
      {"phases",
       [](DcmDataset& d, int n) {
         putPlace(d, 0, n / 2);
         put(d, DCM_AcquisitionNumber, std::to_string(n % 2));
       }},
      {"repeated", [](DcmDataset& d, int n) { putPlace(d, 0, n == 3 ? 2 : n); }},
      {"signed_12",
       [](DcmDataset& d, int) {
         narrow(d, 12);
         d.putAndInsertUint16(DCM_PixelRepresentation, 1);
       }},
      {"bits_8", [](DcmDataset& d, int) { narrow(d, 8); }},
      {"slope", [](DcmDataset& d, int n) { put(d, DCM_RescaleSlope, n ? "0.5" : "20"); }},
      {"padding", [](DcmDataset& d, int) { d.putAndInsertUint16(DCM_PixelPaddingValue, 24); }},
      {"monochrome_1",
       [](DcmDataset& d, int) { put(d, DCM_PhotometricInterpretation, "MONOCHROME1"); }},
      {"lossy", [](DcmDataset& d, int) { put(d, DCM_LossyImageCompression, "01"); }},
      {"unnamed",
       [](DcmDataset& d, int) {
         put(d, DCM_SeriesInstanceUID, "");
         put(d, DCM_SpecificCharacterSet, "ISO 2022 IR 100\\ISO 2022 IR 87");
         put(d, DCM_SeriesDescription, "\x1B$B;3ED\x1B(J \xE4");
       }},
      {"split",
       [](DcmDataset& d, int n) {
         put(d, DCM_ImageType, n % 2 ? "ORIGINAL\\PRIMARY\\LOCALIZER" : "ORIGINAL\\PRIMARY\\AXIAL");
       }},
  };
  for (const auto& [name, change] : shapes) {
    const Series series = changed(plain, change);
    seeds.add(name, series);
    seeds.add(std::string(name) + "_other", series, kOtherAnswers | kReduce | kCrop);
  }
}

// Files that end too early: a slice in its pixels, one in its header, all in their headers.
void addCuts(const Seeds& seeds, const Series& plain) {
  const Bytes position("\x20\x00\x32\x00", 4);
  Series cut = plain;
  cut[1].resize(cut[1].size() - 10);
  seeds.add("cut_pixels", cut);
  cut[1].resize(cut[1].find(position) + 10);
  seeds.add("cut_header", cut);
  for (Bytes& bytes : cut) bytes.resize(bytes.find(position) + 10);
  seeds.addAnything("cut_headers", cut);
}

// Words that the importer refuses, at one place, where it compares.
void addWide(const Seeds& seeds, const Series& plain) {
  seeds.addAnything("bits_32", changed(plain, [](DcmDataset& data, int) {
                      putPlace(data, 0, 0);
                      const std::vector<Uint16> words(2 * 64, 7);
                      data.putAndInsertUint16(DCM_BitsAllocated, 32);
                      data.putAndInsertUint16Array(DCM_PixelData, words.data(), words.size());
                    }));
}

// An enhanced CT of one file, and the same compressed.
void addEnhanced(const Seeds& seeds) {
  const Volume volume = ramp({8, 8, 4});
  const Series one = seriesOf(volume);
  const auto change = [&](DcmDataset& data, int) {
    put(data, DCM_SOPClassUID, UID_EnhancedCTImageStorage);
    put(data, DCM_NumberOfFrames, std::to_string(volume.geometry.size[2]));
    const auto group = [&](const DcmTagKey& groups, const DcmTagKey& macro, int frame) -> DcmItem& {
      DcmItem *outer = nullptr, *inner = nullptr;
      demand(data.findOrCreateSequenceItem(groups, outer, frame).good() &&
                 outer->findOrCreateSequenceItem(macro, inner, 0).good(),
             "make a functional group");
      return *inner;
    };
    const auto shared = [&](const DcmTagKey& macro) -> DcmItem& {
      return group(DCM_SharedFunctionalGroupsSequence, macro, 0);
    };
    put(shared(DCM_PixelMeasuresSequence), DCM_PixelSpacing, "0.5\\0.5");
    put(shared(DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient, "1\\0\\0\\0\\1\\0");
    DcmItem& values = shared(DCM_PixelValueTransformationSequence);
    put(values, DCM_RescaleIntercept, "-1024");
    put(values, DCM_RescaleSlope, "1");
    put(values, DCM_RescaleType, "HU");
    put(shared(DCM_CTImageFrameTypeSequence), DCM_FrameType, "ORIGINAL\\PRIMARY\\AXIAL\\NONE");
    for (int k = 0; k < volume.geometry.size[2]; ++k) {
      putPlace(group(DCM_PerFrameFunctionalGroupsSequence, DCM_PlanePositionSequence, k), 0, k);
      put(group(DCM_PerFrameFunctionalGroupsSequence, DCM_FrameContentSequence, k),
          DCM_FrameAcquisitionNumber, "1");
    }
    std::vector<Uint16> words;
    for (const std::int16_t hu : volume.hu) words.push_back(Uint16(hu + 1024));
    data.putAndInsertUint16Array(DCM_PixelData, words.data(), words.size());
  };
  const Series enhanced = changed({one.front()}, change);
  seeds.add("enhanced", enhanced);
  seeds.add("enhanced_rle", changed(
                                enhanced,
                                [](DcmDataset& data, int) {
                                  const DcmRLERepresentationParameter rle;
                                  demand(data.chooseRepresentation(EXS_RLELossless, &rle).good(),
                                         "encode frames");
                                },
                                EXS_RLELossless));
  seeds.add("enhanced_deflated",
            changed(
                enhanced, [](DcmDataset&, int) {}, EXS_DeflatedLittleEndianExplicit));
}

void addDicomDir(const Seeds& seeds, const Series& plain) {
  const Scratch scratch;
  DcmFileFormat dicom;
  DcmDataset& data = *dicom.getDataset();
  put(data, DCM_SOPClassUID, UID_MediaStorageDirectoryStorage);
  put(data, DCM_SOPInstanceUID, "2.25.1");
  for (int n = 0; n < int(plain.size()); ++n) {
    DcmItem* record = nullptr;
    demand(data.findOrCreateSequenceItem(DCM_DirectoryRecordSequence, record, n).good(),
           "make a DICOMDIR");
    put(*record, DCM_ReferencedFileID, fileName(kSlice, std::size_t(n) + 1));
  }
  const fs::path file = scratch.path / "DICOMDIR";
  demand(dicom.saveFile(file.c_str(), EXS_LittleEndianExplicit).good(), "write a DICOMDIR");
  Seeds::Parts parts{{kDicomDir, read(file)}};
  for (const Bytes& bytes : plain) parts.emplace_back(kSlice, bytes);
  seeds.add("dicomdir", parts, kOpenFirstFile);
  seeds.add("dicomdir_folder", parts);
  seeds.addAnything("dicomdir_stale", Seeds::Parts{parts[0], parts[1]}, kOpenFirstFile);
}

void addVolumeFiles(const Seeds& seeds) {
  const Scratch scratch;
  const auto written = [&](const Volume& volume, const char* name) {
    demand(writeVolume(volume, scratch.path / name).ok(), "write a volume file");
    return read(scratch.path / name);
  };
  const Volume volume = ramp({6, 5, 4});
  const Bytes voxels(reinterpret_cast<const char*>(volume.hu.data()),
                     volume.hu.size() * sizeof(std::int16_t));
  const Bytes mha = written(volume, "v.mha");
  Bytes mhd = mha.substr(0, mha.size() - voxels.size());
  mhd.replace(mhd.find("LOCAL"), 5, kFileNames[kRaw]);
  const Bytes nrrd =
      "NRRD0004\ntype: short\ndimension: 3\nsizes: 6 5 4\nendian: little\nencoding: raw\n"
      "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,-2)\n"
      "space origin: (0,0,0)\n";
  const Bytes json =
      R"({"size": [6, 5, 4], "spacing_mm": [1, 1, 2], "type": "int16", "byte_order": "little"})";
  seeds.add("nifti", {{kNifti, written(volume, "v.nii")}}, kReduce);
  seeds.add("nifti_gz", {{kNiftiGz, written(volume, "v.nii.gz")}});
  seeds.add("mha", {{kMha, mha}}, kCrop);
  seeds.add("mhd", {{kMhd, mhd}, {kRaw, voxels}});
  seeds.add("nrrd", {{kNrrd, nrrd + "\n" + voxels}});
  seeds.add("nhdr", {{kNhdr, nrrd + "data file: v.raw\n"}, {kRaw, voxels}}, kOpenFirstFile);
  seeds.add("raw", {{kRaw, voxels}, {kJson, json}});

  // Large enough for a face and for a couch.
  for (const std::string name : {"cranium", "abdomen"}) {
    GridGeometry grid = *phantomGeometry(name);
    const double step_mm = 8.0;
    for (int axis = 0; axis < 3; ++axis) {
      grid.size[std::size_t(axis)] =
          std::max(2, int(grid.size[std::size_t(axis)] * grid.spacing_mm[axis] / step_mm));
      grid.spacing_mm[axis] = step_mm;
    }
    Volume body = makePhantomOn(*phantomTruth(name), grid, 0.0);
    for (int k = 0; k < grid.size[2]; ++k) {  // a slab under it
      for (int i = 0; i < grid.size[0]; ++i) body.hu[grid.indexOf(i, grid.size[1] - 2, k)] = 100;
    }
    seeds.add(name, {{kNiftiGz, written(body, "v.nii.gz")}}, kReduce);
  }
}

// Every small file by itself, and every folder of small files.
void addMedia(const Seeds& seeds, const fs::path& media) {
  std::map<fs::path, Seeds::Parts> folders;
  for (const auto& entry : fs::recursive_directory_iterator(media)) {
    if (!entry.is_regular_file() || entry.file_size() == 0 || entry.file_size() > kMostBytes) {
      continue;
    }
    const Name name = entry.path().filename().string().starts_with("DICOMDIR") ? kDicomDir : kSlice;
    folders[entry.path().parent_path()].emplace_back(name, read(entry.path()));
  }
  int number = 0;
  for (const auto& [folder, parts] : folders) {
    seeds.addAnything("media_" + std::to_string(number++), parts);
    for (std::size_t n = 0; n < std::min<std::size_t>(parts.size(), 32); ++n) {
      seeds.addAnything("media_" + std::to_string(number++), Seeds::Parts{parts[n]},
                        kOpenFirstFile);
    }
  }
}

}  // namespace

}  // namespace trephine::fuzz

int main(int count, char** arguments) {
  using namespace trephine;
  using namespace trephine::fuzz;
  demand(count == 3 || count == 4, "start: usage: fuzz_seeds FOLDER CODESTREAMS [MEDIA]");
  OFLog::configure(OFLogger::OFF_LOG_LEVEL);
  DcmRLEEncoderRegistration::registerCodecs();
  DJEncoderRegistration::registerCodecs();
  DJLSEncoderRegistration::registerCodecs();
  const Seeds seeds(arguments[1]);
  const Series plain = seriesOf(ramp({8, 8, 4}));
  addSyntaxes(seeds, plain, arguments[2]);
  addShapes(seeds, seriesOf(ramp({7, 5, 10})));
  addCuts(seeds, seriesOf(ramp({7, 5, 6})));
  addWide(seeds, plain);
  addEnhanced(seeds);
  addDicomDir(seeds, plain);
  addVolumeFiles(seeds);
  if (count == 4) addMedia(seeds, arguments[3]);
  return 0;
}
