#include "imaging/codes.h"
#include "imaging/report/provenance.h"
#include "imaging/report/report_page.h"
#include "series_fixture.h"
#include "volume/case_memory.h"

namespace trephine::test {

using VolumeSteps = SeriesFixture;
namespace fs = std::filesystem;

namespace {

Result<Volume> readWith(CtFolder& ct, const ImportRequest& request) {
  return ct.read(ct.bestSeries(request.answers).value_or("none"), request, Progress());
}

}  // namespace

TEST_F(VolumeSteps, ACropKeepsEveryVoxelWhereItWas) {
  const Volume whole = rampVolume({9, 8, 7});
  write(whole);
  CtFolder ct = scan();
  ImportRequest request;
  request.crop = VoxelBox{{1, 2, 3}, {8, 7, 5}};
  const auto part = readWith(ct, request);
  ASSERT_TRUE(part.ok()) << part.error().sentence();
  EXPECT_EQ(part->geometry.size, (Index3{7, 5, 2}));
  EXPECT_EQ(part->at(0, 0, 0), whole.at(1, 2, 3));
  EXPECT_EQ(part->at(6, 4, 1), whole.at(7, 6, 4));
  EXPECT_LT(glm::distance(part->geometry.toPatient_mm(Vec3(0.0)),
                          whole.geometry.toPatient_mm(Vec3(1, 2, 3))),
            1e-9);
  EXPECT_EQ(ct.report().provenance->crop, request.crop);
  EXPECT_EQ(ct.report().series.front().geometry, part->geometry);
}

TEST_F(VolumeSteps, ABoxOutsideTheVolumeIsRefusedAndTheNextReadIsWhole) {
  const Volume whole = rampVolume();
  write(whole);
  CtFolder ct = scan();
  ImportRequest request;
  request.crop = VoxelBox{{0, 0, 0}, {8, 5, 6}};
  EXPECT_EQ(readWith(ct, request).error().code.str(), "BAD_CROP");
  EXPECT_FALSE(ct.report().chosen.has_value());
  EXPECT_EQ(readWith(ct, {})->hu, whole.hu);
}

TEST_F(VolumeSteps, HalfResolutionStatesWhatItCost) {
  Volume whole = rampVolume({12, 12, 12});
  for (std::size_t n = 0; n < whole.hu.size(); ++n) whole.hu[n] = n % 2 ? 400 : 200;
  write(whole);
  CtFolder ct = scan();
  ImportRequest request;
  request.reduction = 2;
  const auto half = readWith(ct, request);
  ASSERT_TRUE(half.ok());
  EXPECT_EQ(half->geometry.size, (Index3{6, 6, 6}));
  EXPECT_EQ(half->at(2, 2, 2), 300);
  const auto& provenance = *ct.report().provenance;
  ASSERT_TRUE(provenance.loss.has_value());
  EXPECT_NEAR(provenance.loss->rms_hu, 100.0, 1e-9);  // every voxel is off by 100
  EXPECT_EQ(provenance.reduction, 2);
  const SeriesReport& series = ct.report().series.front();
  EXPECT_EQ(series.verdict, Verdict::pass) << "what a person asked for is no repair";
  ASSERT_NE(find(series, "REDUCED"), nullptr);
  EXPECT_EQ(find(series, "REDUCED")->severity, Severity::edit);
  ASSERT_EQ(provenance.changes.size(), 1u) << "and it is told of all the same";
  EXPECT_EQ(provenance.changes[0].code.str(), "REDUCED");
  EXPECT_EQ(series.hu_max, 300);
}

TEST_F(VolumeSteps, ThickSlicesAreKeptUnlessSlicesBetweenThemAreWanted) {
  Volume whole = rampVolume({12, 10, 5});
  whole.geometry.spacing_mm = {0.5, 0.5, 5.0};
  write(whole);
  CtFolder ct = scan();
  const auto kept = readWith(ct, {});
  ASSERT_TRUE(kept.ok()) << kept.error().sentence();
  EXPECT_EQ(kept->hu, whole.hu);
  const SeriesReport asked = ct.report().series.front();
  ASSERT_NE(find(asked, "THICK_SLICES"), nullptr);
  EXPECT_EQ(find(asked, "THICK_SLICES")->severity, Severity::notice);
  ASSERT_EQ(asked.choices.size(), 1u);
  EXPECT_EQ(asked.choices[0].code, code::kThickSlices);
  EXPECT_NE(asked.choices[0].question.find("5.00 mm apart"), std::string::npos);

  ImportRequest request;
  request.answers[code::kThickSlices] = "interpolate";
  const double mb = memoryMb(ct.report().series.front(), request);
  const auto thin = readWith(ct, request);
  ASSERT_TRUE(thin.ok()) << thin.error().sentence();
  EXPECT_EQ(thin->geometry.size, (Index3{12, 10, 21}));
  EXPECT_NEAR(thin->geometry.spacing_mm.z, 1.0, 1e-9);
  EXPECT_EQ(thin->at(3, 4, 10), whole.at(3, 4, 2));
  const SeriesReport& series = ct.report().series.front();
  EXPECT_EQ(series.verdict, Verdict::pass) << "what a person asked for is no repair";
  EXPECT_EQ(find(series, "THICK_SLICES")->severity, Severity::edit);
  EXPECT_EQ(series.geometry, thin->geometry);
  EXPECT_GT(mb, memoryMb(asked, {}));
  EXPECT_EQ(ct.report().provenance->answers.at(code::kThickSlices), "interpolate");
}

TEST_F(VolumeSteps, SlicesThatAreThinEnoughAskNothing) {
  Volume whole = rampVolume({12, 10, 5});
  whole.geometry.spacing_mm = {0.8, 0.8, 2.5};
  write(whole);
  CtFolder ct = scan();
  ASSERT_TRUE(readWith(ct, {}).ok());
  EXPECT_TRUE(ct.report().series.front().choices.empty());
}

TEST(ImportMemory, IsThatOfWhatComesOutUnlessReadingItTakesMore) {
  SeriesReport series;
  series.geometry.size = {512, 512, 400};
  series.reading_mb = 200.0;
  // Four copies of the voxels, and a bit of each.
  constexpr double kCopies = 4 + 1.0 / 16;
  EXPECT_NEAR(memoryMb(series, {}), kWindow_mb + kExercise_mb + kHeld_mb + kCopies * 200.0, 5.0);
  ImportRequest half;
  half.reduction = 2;
  EXPECT_NEAR(memoryMb(series, half), kWindow_mb + kExercise_mb + kHeld_mb + kCopies * 25.0, 1.0);
  ImportRequest cropped;
  cropped.crop = VoxelBox{{0, 0, 0}, {256, 512, 400}};
  EXPECT_NEAR(memoryMb(series, cropped), kWindow_mb + kExercise_mb + kHeld_mb + kCopies * 100.0,
              3.0);
  series.reading_mb = 2000.0;
  EXPECT_NEAR(memoryMb(series, half), kWindow_mb + 2025.0, 1e-6) << "and the half itself";
  ImportRequest thin;
  thin.answers[code::kThickSlices] = "interpolate";
  EXPECT_NEAR(readingMb(series, thin), 2000.0, 1e-6) << "slices that are thin already";
  series.geometry.spacing_mm = {0.5, 0.5, 3.0};
  EXPECT_NEAR(readingMb(series, thin), 2599.0, 1e-6) << "and all that come out";
}

TEST_F(VolumeSteps, WhatDoesNotFitTheMemoryIsRefusedInWordsBeforeItIsRead) {
  write(rampVolume({64, 64, 40}));
  CtFolder ct = scan();
  EXPECT_NEAR(ct.report().series.front().reading_mb, 64 * 64 * 40 * 2 / 1048576.0, 1e-9);
  ImportRequest request;
  request.most_memory_mb = 0.1;
  const auto volume = readWith(ct, request);
  ASSERT_FALSE(volume.ok());
  EXPECT_EQ(volume.error().code.str(), "OUT_OF_MEMORY");
  EXPECT_NE(volume.error().what.find("can be had"), std::string::npos);
}

TEST_F(VolumeSteps, AnUnknownChoiceAndAnUnknownOptionAreNamed) {
  write(rampVolume());
  fs::remove(slice(3));
  CtFolder ct = scan();
  const std::string uid = ct.report().series.front().uid;
  ImportRequest request;
  request.answers[code::kMissingSlices] = "guess";
  const auto bad_option = ct.read(uid, request, Progress());
  ASSERT_FALSE(bad_option.ok());
  EXPECT_EQ(bad_option.error().code.str(), "BAD_CHOICE");
  EXPECT_NE(bad_option.error().next.find("fill"), std::string::npos);
  request.answers = {{Code("MISSING"), "fill"}};
  EXPECT_EQ(ct.read(uid, request, Progress()).error().code.str(), "BAD_CHOICE");
}

TEST_F(VolumeSteps, ProvenanceAndPageTellWhatWasDoneAndNotWhoseItIs) {
  write(rampVolume());
  fs::remove(slice(3));
  editAll([](DcmDataset& data) {
    put(data, DCM_PatientName, "Secret^Name");
    put(data, DCM_PatientID, "ID-4711");
    put(data, DCM_SeriesDescription, "Skull of Secret");
  });
  CtFolder ct = scan();
  ImportRequest request;
  request.answers[code::kMissingSlices] = "fill";
  const auto volume = readWith(ct, request);
  ASSERT_TRUE(volume.ok()) << volume.error().sentence();
  const fs::path target = temporary_ / "out.nii.gz";
  ASSERT_TRUE(writeProvenance(*ct.report().provenance, target).ok());
  const std::string file = readBytes(temporary_ / "out.nii.gz.provenance.json");
  const std::string page = reportPage(ct.report());
  EXPECT_NE(file.find("\"MISSING_SLICES\": \"fill\""), std::string::npos) << file;
  EXPECT_NE(file.find("102.50 mm"), std::string::npos) << file;
  EXPECT_NE(page.find("Filled in by interpolation"), std::string::npos) << page;
  for (const std::string& text : {file, page}) {
    for (const std::string& secret : {std::string("Secret"), std::string("4711"),
                                      ct.report().series.front().uid, folder().string()}) {
      EXPECT_EQ(text.find(secret), std::string::npos) << secret;
    }
  }
}

}  // namespace trephine::test
