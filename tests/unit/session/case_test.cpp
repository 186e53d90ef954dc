// A session on a case: its voxels, its label map, and what is said where they do not fit. Cases
// and placements alone are in tests/unit/case.
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

}  // namespace
}  // namespace trephine
