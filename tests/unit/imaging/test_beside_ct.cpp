// What lies beside a CT, or in its place: volume files, label maps, archives; and whose series are
// shown.
#include <array>
#include <cstring>

#include "imaging/report/provenance.h"
#include "imaging/report/report_page.h"
#include "series_fixture.h"

namespace trephine::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUnpack = ": unpack it first";

// The header of a NIfTI file of this size, in words of this kind (4: int16, 2: uint8, 16: float32).
std::string niftiHeader(std::int16_t x, std::int16_t y, std::int16_t z, std::int16_t kind = 4) {
  std::string header(352, '\0');
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(header.data() + at, &value, sizeof value);
  };
  put(0, std::int32_t(348));
  const std::array<std::int16_t, 8> dim = {3, x, y, z, 1, 1, 1, 1};
  put(40, dim);
  put(70, kind);
  put(72, std::int16_t(kind == 2 ? 8 : kind == 4 ? 16 : 32));
  const std::array<float, 8> pixdim = {1, 1, 1, 2, 1, 1, 1, 1};
  put(76, pixdim);
  put(108, 352.0F);
  put(112, 1.0F);
  put(254, std::int16_t(1));  // sform
  const std::array<float, 12> rows = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0};
  put(280, rows);
  put(344, std::array<char, 4>{'n', '+', '1', '\0'});
  return header;
}

class BesideCt : public SeriesFixture {
 protected:
  BesideCt() { fs::create_directory(folder()); }

  // Of voxels that are all of this value.
  void writeNifti(const std::string& name, std::int16_t slices, std::int16_t kind, int value) {
    std::string bytes = niftiHeader(4, 4, slices, kind);
    for (int n = 0; n < 16 * slices; ++n) {
      bytes += char(value & 255);
      if (kind == 4) bytes += char(value >> 8 & 255);
    }
    writeBytes(folder() / name, bytes);
  }
  // A file of 30 GB of which only its beginning is there.
  void writeSparse(const std::string& name, const std::string& beginning) {
    writeBytes(folder() / name, beginning);
    fs::resize_file(folder() / name, std::uintmax_t(30) << 30);
  }
  static const SeriesReport& of(const CtFolder& ct, const std::string& name) {
    const auto found = std::ranges::find(ct.report().series, name, &SeriesReport::description);
    if (found == ct.report().series.end()) throw std::runtime_error("there is no " + name);
    return *found;
  }
};

// --- Volume files and label maps ---

TEST_F(BesideCt, TheCtIsProposedHoweverManySlicesAVolumeFileHas) {
  write(rampVolume());
  writeNifti("larger.nii", 200, 4, -1000);
  const CtFolder ct = scan();
  ASSERT_EQ(ct.report().series.size(), 2u);
  ASSERT_EQ(of(ct, "larger.nii").verdict, Verdict::pass);
  ASSERT_TRUE(ct.bestSeries());
  EXPECT_EQ(ct.bestSeries()->find("file:"), std::string::npos);
}

TEST_F(BesideCt, WithoutACtThatCanBeReadTheVolumeFileIsProposed) {
  write(rampVolume({7, 5, 1}));
  writeNifti("volume.nii", 20, 4, -1000);
  EXPECT_EQ(scan().bestSeries(), "file:volume.nii");
}

TEST_F(BesideCt, ALabelMapIsOfferedAsAPartOfTheCase) {
  write(rampVolume());
  writeNifti("organs.nii", 6, 2, 3);       // 8 bits
  writeNifti("organs_seg.nii", 6, 4, 3);   // by its name
  writeNifti("another.nii", 6, 4, -1000);  // a CT, as far as anybody knows
  CtFolder ct = scan();
  for (const char* name : {"organs.nii", "organs_seg.nii"}) {
    const Finding* finding = find(of(ct, name), "LABEL_MAP");
    if (!finding) finding = find(of(ct, name), "NAMED_AS_LABELS");
    ASSERT_NE(finding, nullptr) << name;
    EXPECT_NE(finding->action.find("Import the CT beside it"), std::string::npos)
        << finding->action;
    EXPECT_NE(finding->action.find("label map"), std::string::npos) << finding->action;
  }
  ASSERT_EQ(ct.labelFiles().size(), 2u);
  EXPECT_EQ(ct.labelFiles().front().name, "organs.nii");
  EXPECT_EQ(ct.labelFiles().front().file, folder() / "organs.nii");
  // One that shows only when it is read is offered from then on.
  writeNifti("another.nii", 6, 4, 3);
  const auto read = ct.read("file:another.nii", {}, Progress());
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code.str(), "LABEL_MAP");
  EXPECT_NE(read.error().next.find("Import the CT beside it"), std::string::npos);
  EXPECT_EQ(ct.labelFiles().size(), 3u);
}

TEST_F(BesideCt, ALabelMapAloneIsNoPartOfAnything) {
  writeNifti("organs.nii", 6, 2, 3);
  const CtFolder ct = scan();
  EXPECT_TRUE(ct.labelFiles().empty());
  EXPECT_NE(find(of(ct, "organs.nii"), "LABEL_MAP")->action.find("Open the CT first"),
            std::string::npos);
}

TEST_F(BesideCt, AFileOf30GbIsRefusedByItsHeader) {
  const std::string mhd =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing = 1 1 2\n"
      "DimSize = 2000 2000 1950\nElementType = MET_FLOAT\nElementDataFile = voxels.raw\n";
  const std::string nrrd =
      "NRRD0004\ntype: float\ndimension: 3\nspace: left-posterior-superior\n"
      "sizes: 2000 2000 1950\nspace directions: (1,0,0) (0,1,0) (0,0,2)\n"
      "space origin: (0,0,0)\nendian: little\nencoding: raw\n\n";
  writeSparse("many.nii", niftiHeader(2000, 2000, 4000));      // more voxels than any volume
  writeSparse("fits.nii", niftiHeader(2000, 2000, 1950, 16));  // as many as a volume may have
  writeSparse("fits.nrrd", nrrd);
  writeBytes(folder() / "fits.mhd", mhd);
  writeSparse("voxels.raw", "");
  writeBytes(folder() / "packed.nii.gz",
             packedBy(Deflate::gzip, niftiHeader(2000, 2000, 1950, 16)));
  writeBytes(folder() / "many.nii.gz",
             packedBy(Deflate::gzip, niftiHeader(2000, 2000, 4000) + std::string(30 << 20, '\0')));
  CtFolder ct = scan();
  ASSERT_EQ(ct.report().series.size(), 6u) << "voxels.raw belongs to fits.mhd";
  for (const SeriesReport& series : ImportReport(ct.report()).series) {
    SCOPED_TRACE(series.description);
    EXPECT_EQ(series.verdict, Verdict::refused) << codes(series);
    const auto began = std::chrono::steady_clock::now();
    EXPECT_FALSE(ct.read(series.uid, {}, Progress()));
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(1));
  }
}

// --- Archives ---

TEST_F(BesideCt, WhatIsPackedIsToldByItsFirstBytes) {
  std::string tar(1024, '\0');
  tar.replace(257, 5, "ustar");
  const std::pair<const char*, std::string> files[] = {
      {"a ZIP archive", std::string("PK\3\4\x14\0\0\0\x08\0", 10)},
      {"a gzip file", packedBy(Deflate::gzip, std::string(2000, 'x'))},
      {"a 7z archive", "7z\xBC\xAF\x27\x1C...."},
      {"a RAR archive", "Rar!\x1A\x07...."},
      {"an xz file", std::string("\xFD"
                                 "7zXZ\0....",
                                 10)},
      {"a bzip2 file", "BZh91AY&SY...."},
      {"a Zstandard file", "\x28\xB5\x2F\xFD...."},
      {"a tar archive", tar}};
  for (const auto& [name, bytes] : files) {
    SCOPED_TRACE(name);
    fs::remove_all(folder());
    writeBytes(folder() / "IM0001", bytes);
    for (const fs::path& path : {folder(), folder() / "IM0001"}) {
      const CtFolder ct = scan(path);
      ASSERT_EQ(ct.report().skipped.size(), 1u);
      EXPECT_EQ(ct.report().skipped.front().reason, name + std::string(kUnpack));
      ASSERT_TRUE(ct.report().error);
      EXPECT_EQ(ct.report().error->code.str(), "NO_CT");
      EXPECT_NE(ct.report().error->sentence().find("unpack it first"), std::string::npos);
    }
  }
}

TEST_F(BesideCt, AnArchiveAmongManyOtherFilesIsWhatTheSentenceSpeaksOf) {
  for (int n = 0; n < 5; ++n) writeBytes(folder() / ("notes" + std::to_string(n)), "no CT at all");
  writeBytes(folder() / "scan", std::string("PK\3\4\x14\0\0\0\x08\0", 10));
  const CtFolder ct = scan();
  EXPECT_NE(ct.report().error->what.find("a ZIP archive: unpack it first"), std::string::npos)
      << ct.report().error->what;
}

TEST_F(BesideCt, AGzippedSliceIsAnArchiveAndAGzippedVolumeIsNone) {
  write(rampVolume());
  const std::string packed = packedBy(Deflate::gzip, readBytes(slice(1)));
  fs::remove_all(folder());
  writeBytes(folder() / "slice.dcm.gz", packed);
  std::string volume = niftiHeader(4, 4, 4);
  for (int n = 0; n < 64; ++n) volume += std::string("\x18\xFC", 2);  // -1000
  writeBytes(folder() / "volume.nii.gz", packedBy(Deflate::gzip, volume));
  const CtFolder ct = scan();
  ASSERT_EQ(ct.report().skipped.size(), 1u);
  EXPECT_EQ(ct.report().skipped.front().reason, std::string("a gzip file") + kUnpack);
  EXPECT_EQ(ct.bestSeries(), "file:volume.nii.gz");
}

// --- Whose series they are ---

TEST_F(BesideCt, NamesAreForTheScreenAndInNothingThatIsWritten) {
  write(rampVolume());
  editAll([](DcmDataset& data) {
    put(data, DCM_SpecificCharacterSet, "ISO_IR 192");
    put(data, DCM_PatientName, "M\xC3\xBCSTERMANN^ERIKA^^DR.=X=Y");
    put(data, DCM_StudyDescription, "Knochenstudie");
    put(data, DCM_StudyDate, "20240503");
  });
  CtFolder ct = scan();
  ASSERT_EQ(ct.screenNames().size(), 1u);
  const ScreenNames names = ct.screenNames().front();
  EXPECT_EQ(names.patient, "M\xC3\xBCSTERMANN, ERIKA DR. (PHANTOM)");
  EXPECT_EQ(names.study, "Knochenstudie, 2024-05-03");
  EXPECT_FALSE(names.patient_key.empty());

  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  const auto volume = ct.read(*ct.bestSeries(), {}, Progress());
  const std::string log =
      ::testing::internal::GetCapturedStderr() + ::testing::internal::GetCapturedStdout();
  ASSERT_TRUE(volume);
  for (const std::string& text : {toJson(ct.report()).dump(), reportPage(ct.report()),
                                  toJson(*ct.report().provenance).dump(), log}) {
    for (const char* secret : {"STERMANN", "ERIKA", "Knochenstudie", "2024-05-03", "20240503"}) {
      EXPECT_EQ(text.find(secret), std::string::npos) << secret << " in " << text;
    }
    EXPECT_EQ(text.find(names.patient_key), std::string::npos);
  }
}

TEST_F(BesideCt, SeriesOfOnePatientAndStudyShareTheirKeys) {
  const auto series = [&](const char* uid, const char* study, const char* patient) {
    for (int k = 0; k < 4; ++k) {
      Image image;
      image.position_mm.z = 100.0 + k;
      image.instance = k + 1;
      fillPattern(image, k);
      DcmDataset data = makeImage(image);
      put(data, DCM_SeriesInstanceUID, uid);
      put(data, DCM_SOPInstanceUID, std::string(uid) + "." + std::to_string(k));
      put(data, DCM_StudyInstanceUID, study);
      put(data, DCM_PatientName, patient);
      add(data);
    }
  };
  series("1.2.1", "1.9.1", "A^B");
  series("1.2.2", "1.9.1", "A^B");
  series("1.2.3", "1.9.2", "A^B");
  series("1.2.4", "1.9.3", "C^D");
  const CtFolder ct = scan();
  const std::vector<ScreenNames> names = ct.screenNames();
  ASSERT_EQ(names.size(), 4u);
  EXPECT_EQ(names[0].patient_key, names[2].patient_key);
  EXPECT_EQ(names[0].study_key, names[1].study_key);
  EXPECT_NE(names[0].study_key, names[2].study_key);
  EXPECT_NE(names[0].patient_key, names[3].patient_key);
}

}  // namespace
}  // namespace trephine::test
