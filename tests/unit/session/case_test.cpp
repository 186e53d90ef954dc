// A case in an exercise: its voxels, its label map, and what is said where it does not fit.
#include <algorithm>

#include "cases.h"
#include "session_support.h"
#include "support.h"
#include "training/replay.h"
#include "volume/volume_files.h"

namespace trephine {
namespace {

using test::cranium;
using test::scripted;
using test::smallHead;

TEST(Case, CanBeCancelledWhileItsLandmarksAreFound) {
  Progress* running = nullptr;
  Progress progress([&](double, const std::string&) { running->cancel(); });
  running = &progress;
  const Case of = caseOf(std::make_shared<const Volume>(smallHead()));
  Exercise exercise = cranium();
  const auto placed = place(exercise, of, progress);
  ASSERT_FALSE(placed.ok());
  EXPECT_EQ(placed.error().code.str(), "CANCELLED");
}

// Bone is label 7, and a strip of it in every 8 voxels has another label.
std::shared_ptr<const LabelMap> strips() {
  const GridGeometry geometry = smallHead().geometry;
  LabelMap map{geometry, std::vector<std::uint8_t>(geometry.voxelCount())};
  for (std::size_t i = 0; i < map.labels.size(); ++i) {
    map.labels[i] = geometry.indicesOf(i)[1] % 8 == 5 ? 8 : 7;
  }
  return std::make_shared<const LabelMap>(std::move(map));
}

Exercise craniumOfLabels() {
  Exercise exercise = cranium();
  exercise.tissues.tissues.back().label = 7;
  return exercise;
}

TEST(Session, CutsATissueOnlyWhereItsLabelIsAndReplaysWithThatLabelMapAlone) {
  test::TemporaryFolder folder;
  const auto labels = strips();
  auto session = Session::create(test::placed(craniumOfLabels(), smallHead(), labels),
                                 scripted(folder / "s.h5"));
  ASSERT_TRUE(session.ok()) << session.error().sentence();
  ASSERT_TRUE((*session)->freewheel(10.0).ok());
  const RunReport report = (*session)->report();
  EXPECT_GT(report.done.removed_mm3.back().second, 100.0);
  const Volume before = smallHead(), after = (*session)->grid().snapshot();
  for (std::size_t i = 0; i < before.hu.size(); ++i) {
    if (before.hu[i] == 1200 && labels->labels[i] == 8) {
      ASSERT_EQ(after.hu[i], 1200);
    }
  }

  const auto reader = *SessionReader::open(folder / "s.h5");
  const auto result = replay(*reader, smallHead(), labels.get());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << result->first_difference->field;
  EXPECT_EQ(result->volume_sha256, report.volume_sha256);

  LabelMap other = *labels;
  other.labels[0] = 9;
  for (const LabelMap* given : {static_cast<const LabelMap*>(nullptr), &std::as_const(other)}) {
    const auto refused = replay(*reader, smallHead(), given);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code.str(), "WRONG_LABELS");
  }
}

// As a file may have it: the axes in another order.
TEST(Case, FitsALabelMapToItsVoxels) {
  test::TemporaryFolder folder;
  const auto straight = strips();
  LabelMap turned = *straight;
  const GridGeometry& g = straight->geometry;
  turned.geometry.origin_mm = g.toPatient_mm(Vec3(0, 0, g.size[2] - 1));
  turned.geometry.direction[2] = -g.direction[2];
  const std::size_t slice = g.voxelCount() / std::size_t(g.size[2]);
  for (std::size_t i = 0; i < turned.labels.size(); ++i) {
    turned.labels[i] =
        straight->labels[i % slice + slice * (std::size_t(g.size[2]) - 1 - i / slice)];
  }
  const Case head = caseOf(std::make_shared<const Volume>(smallHead()));
  const auto file = [&](const char* name) {
    const Volume voxels{turned.geometry, Voxels(turned.labels.begin(), turned.labels.end())};
    EXPECT_TRUE(writeVolume(voxels, folder / name).ok());
    return (folder / name).string();
  };
  const auto labelled = withLabels(head, file("turned.mha"));
  ASSERT_TRUE(labelled.ok()) << labelled.error().sentence();
  EXPECT_EQ(labelled->structures->labels, straight->labels);
  Exercise exercise = craniumOfLabels();
  const Placement of = *place(exercise, *labelled);
  auto session = Session::create(of, scripted(folder / "s.h5"));
  ASSERT_TRUE(session.ok()) << session.error().sentence();
  ASSERT_TRUE((*session)->freewheel(0.5).ok());
  EXPECT_TRUE(replay(**SessionReader::open(folder / "s.h5"), smallHead(), &turned)->identical);
  turned.geometry.origin_mm.x += 1000.0;
  EXPECT_EQ(withLabels(head, file("elsewhere.mha")).error().code.str(), "LABELS_ELSEWHERE");
}

TEST(Session, ATissueOfALabelWithoutALabelMapIsRefused) {
  const auto refused = Session::create(test::placed(craniumOfLabels(), smallHead()), {});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code.str(), "NO_LABELS");
  EXPECT_NE(refused.error().what.find("'bone' is restricted to label 7"), std::string::npos);

  const auto session = *Session::create(test::placed(cranium(), smallHead()), {});
  EXPECT_EQ(session->setTissues(craniumOfLabels().tissues).error().code.str(), "NO_LABELS");
}

TEST(Session, SaysWhenTheCaseDoesNotFitTheExercise) {
  Volume air = smallHead();
  std::fill(air.hu.begin(), air.hu.end(), kAirHu);
  auto session = Session::create(test::placed(cranium(), air), {});
  ASSERT_FALSE(session.ok());
  EXPECT_EQ(session.error().code.str(), "TISSUE_NOT_FOUND");
}

// A column of bone beside the axis along which the vault is sought.
Case caseWithoutAVault() {
  Volume volume = smallHead();
  const GridGeometry& g = volume.geometry;
  for (std::size_t i = 0; i < volume.hu.size(); ++i) {
    const Index3 at = g.indicesOf(i);
    const auto aside = [&](double x) {
      return glm::length(glm::dvec2(at[0] - x, at[1] - 40.0)) < 4.0;
    };
    if (volume.hu[i] > kAirHu) volume.hu[i] = aside(20.0) || aside(60.0) ? 800 : 40;
  }
  return caseOf(std::make_shared<const Volume>(std::move(volume)));
}

TEST(Case, ThatShowsAnotherAnatomyIsBegunAtItsSurfaceAndSaysSo) {
  Exercise exercise = cranium();
  Case vaultless = caseWithoutAVault();
  vaultless.anatomy = Anatomy{BodyRegion::abdomen};
  const Placement of = *place(exercise, vaultless);
  ASSERT_FALSE(of.error) << of.error->sentence();
  ASSERT_EQ(of.warnings.size(), 2u);
  EXPECT_EQ(of.warnings[0].code.str(), "OTHER_ANATOMY");
  EXPECT_EQ(of.warnings[1].code.str(), "NO_LANDMARK");
  EXPECT_NE(of.warnings[1].text.find("does not meet the tissue 'bone'"), std::string::npos);
  // The ball's top, above its middle.
  ASSERT_EQ(of.landmarks.size(), 1u);
  const Vec3 top_mm = of.patient.volume->geometry.centre_mm() + Vec3(0.0, 0.0, 44.0);
  EXPECT_LT(glm::length(of.landmarks[0].frame.position_mm - top_mm), 2.0);
  EXPECT_TRUE(Session::create(of, scripted()).ok());
}

TEST(Case, WithoutTheLandmarksTissueIsNoDeadEndWhateverItShows) {
  Exercise exercise = cranium();
  Case of = caseWithoutAVault();
  for (const BodyRegion region : {BodyRegion::head, BodyRegion::not_sure}) {
    of.anatomy = Anatomy{region, true};
    const Placement placed = *place(exercise, of);
    ASSERT_FALSE(placed.error) << placed.error->sentence();
    ASSERT_EQ(placed.warnings.size(), 1u);
    EXPECT_EQ(placed.warnings[0].code.str(), "NO_LANDMARK");
    EXPECT_TRUE(Session::create(placed, scripted()).ok());
  }
}

// Of a liver's exercise the landmark is the middle of a ball of 30 mm.
TEST(Case, ThatIsTooThinForTheLandmarksBallIsBegunAtItsSurface) {
  Exercise exercise = *readExercise(resourceFolder() / "scenes" / "liver.json");
  Volume thin;
  thin.geometry.size = {100, 80, 10};
  thin.geometry.spacing_mm = {2.0, 2.0, 3.0};
  thin.hu.assign(thin.geometry.voxelCount(), kAirHu);
  for (int k = 0; k < 10; ++k) {
    for (int j = 20; j < 60; ++j) {
      for (int i = 20; i < 80; ++i) thin.hu[thin.geometry.indexOf(i, j, k)] = 200;
    }
  }
  const Placement of = *place(exercise, caseOf(std::make_shared<const Volume>(std::move(thin))));
  ASSERT_FALSE(of.error) << of.error->sentence();
  ASSERT_EQ(of.warnings.size(), 2u);
  EXPECT_EQ(of.warnings[0].code.str(), "LACKS_STRUCTURE");
  EXPECT_EQ(of.warnings[1].code.str(), "NO_LANDMARK");
  // In front, y towards the back.
  EXPECT_NEAR(of.landmarks[0].frame.position_mm.y, 39.0, 2.0);
  EXPECT_GT(-(of.landmarks[0].frame.rotation * Vec3(0, 0, 1)).y, 0.7);
}

TEST(Case, ThatIsMissingIsNamed) {
  EXPECT_EQ(readCase("").error().code.str(), "NO_CASE");
  EXPECT_EQ(readCase("phantom:foot").error().code.str(), "UNKNOWN_PHANTOM");
  const auto missing = readCase("/no/such/folder");
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().where.find("/no/such/folder"), std::string::npos);
}

TEST(Case, AMissingLabelMapIsNamedAndNoneIsNoError) {
  const Case head = caseOf(std::make_shared<const Volume>(smallHead()));
  EXPECT_EQ(withLabels(head, "")->structures, nullptr);
  const auto missing = withLabels(head, "/no/such/seg.nii");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code.str(), "MISSING_FILE");
  EXPECT_NE(missing.error().where.find("/no/such/seg.nii"), std::string::npos);
  Exercise exercise = cranium();
  exercise.labels_file = "/no/such/seg.nii";
  const Placement of = *place(exercise, head);
  ASSERT_TRUE(of.error);
  EXPECT_EQ(Session::create(of, {}).error().code.str(), "MISSING_FILE");
}

TEST(Case, ABuiltInAbdomenBringsItsLabelMapAndAnotherReplacesIt) {
  test::TemporaryFolder folder;
  Exercise exercise = *readExercise(resourceFolder() / "scenes" / "liver.json");
  const Case read = *readCase("phantom:abdomen");
  ASSERT_TRUE(read.structures);
  const Placement own = *place(exercise, read);
  EXPECT_EQ(own.labels, read.structures);
  EXPECT_FALSE(own.error) << own.error->sentence();
  // What a session recorded with them is replayed with them.
  auto session = Session::create(
      own, {folder / "s.h5", *readOperatorScript(exercise.operator_file, exercise)});
  ASSERT_TRUE(session.ok()) << session.error().sentence();
  ASSERT_TRUE((*session)->freewheel(2.0).ok());
  const auto reader = *SessionReader::open(folder / "s.h5");
  EXPECT_TRUE(replay(*reader, *read.volume, read.structures.get())->identical);

  const GridGeometry& g = read.volume->geometry;
  Volume given{g, Voxels(g.voxelCount(), std::int16_t(1))};
  ASSERT_TRUE(writeVolume(given, folder / "given.nii").ok());
  exercise.labels_file = (folder / "given.nii").string();
  const Placement other = *place(exercise, read);
  ASSERT_TRUE(other.labels);
  EXPECT_EQ(other.labels->labels.front(), 1);
  EXPECT_FALSE(other.patient.structures_built_in);
  EXPECT_EQ(place(exercise, other.patient)->labels, other.labels) << "read once";
}

TEST(Case, IsHashedOnceAndKeepsItsVoxelsWhenTheExerciseCutsThem) {
  const auto voxels = std::make_shared<const Volume>(smallHead());
  Exercise exercise = cranium();
  const Placement placed = *place(exercise, caseOf(voxels));
  const Case& of = placed.patient;
  EXPECT_EQ(of.sha256, volumeSha256(smallHead()));
  EXPECT_EQ(caseOf(voxels, "known").sha256, "known");
  auto session = *Session::create(placed, scripted());
  ASSERT_TRUE(session->freewheel(10.0).ok());
  EXPECT_EQ(session->report().volume_sha256_before, of.sha256);
  EXPECT_EQ(session->report().volume_sha256, volumeSha256(session->grid().snapshot()));
  EXPECT_NE(session->report().volume_sha256, of.sha256);
  EXPECT_EQ(voxels->hu, smallHead().hu);
}

// --- An document on a case ---

TEST(Placement, LeavesTheExerciseAsItIsAndFollowsItsEdits) {
  const Exercise liver = *readExercise(resourceFolder() / "scenes" / "liver.json");
  Exercise document = liver;
  const Placement placed = *place(document, *readCase("phantom:abdomen"));
  ASSERT_FALSE(placed.error) << placed.error->sentence();
  EXPECT_EQ(document, liver);
  EXPECT_FALSE(placed.elsewhere);
  EXPECT_FALSE(document.tissues.find("liver")->label) << "a label is the case's";
  EXPECT_EQ(placed.exercise.tissues.find("liver")->label, placed.labels->find("liver")->label);
  for (const ExerciseArm& arm : placed.exercise.arms) EXPECT_TRUE(arm.map.fixed);
  for (Tissue& tissue : document.tissues.tissues) tissue.opacity = 0.25;
  document.arms[0].map.offset_mm.z += 5.0;
  const Exercise edited = placedExercise(document, placed);
  EXPECT_EQ(edited.tissues.find("liver")->opacity, 0.25);
  EXPECT_EQ(edited.tissues.find("liver")->label, placed.exercise.tissues.find("liver")->label);
  EXPECT_NEAR(glm::length(edited.arms[0].map.fixed->centre_mm -
                          placed.exercise.arms[0].map.fixed->centre_mm),
              5.0, 1e-9);
  EXPECT_EQ(placedExercise(liver, placed), placed.exercise);
}

TEST(Placement, WithoutAStructureTheOtherSetIsInForceAndItsEditsAre) {
  const Exercise liver = *readExercise(resourceFolder() / "scenes" / "liver.json");
  Case bare = *readCase("phantom:abdomen");
  bare.structures = nullptr;
  const Placement placed = *place(liver, bare);
  ASSERT_FALSE(placed.error) << placed.error->sentence();
  EXPECT_TRUE(placed.elsewhere);
  EXPECT_EQ(placed.exercise.tissues, *liver.tissues_elsewhere);
  Exercise document = liver;
  for (Tissue& tissue : document.tissues.tissues) tissue.opacity = 0.25;
  EXPECT_EQ(placedExercise(document, placed).tissues, *liver.tissues_elsewhere);
  for (Tissue& tissue : document.tissues_elsewhere->tissues) tissue.opacity = 0.5;
  EXPECT_EQ(placedExercise(document, placed).tissues.tissues.front().opacity, 0.5);
}

TEST(Exercise, OnAnotherCaseHasNoLabelMapOfItsOwn) {
  Exercise exercise = cranium();
  exercise.case_source = "phantom:cranium";
  exercise.labels_file = "labels.nii";
  exercise = onCase(exercise, "phantom:cranium");
  EXPECT_EQ(exercise.labels_file, "labels.nii");
  exercise = onCase(exercise, "");
  EXPECT_EQ(exercise.labels_file, "");
  EXPECT_FALSE(toJson(exercise).contains("case")) << "a recording must not name another case";
  exercise.labels_file = "of the case that is given.nii";
  exercise = onCase(exercise, "head.mha");
  EXPECT_EQ(exercise.labels_file, "of the case that is given.nii");
}

}  // namespace
}  // namespace trephine
