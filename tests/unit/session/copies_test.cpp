// How often a case's voxels are in memory without a window, and how often they are looked at as a
// whole. A program of its own: it counts what OpenSSL hashes and how often landmarks are placed.
#include <gtest/gtest.h>

#include "base/system.h"
#include "memory_probe.h"
#include "session/session.h"
#include "shells.h"
#include "support.h"
#include "volume/case_memory.h"
#include "volume/volume_files.h"

namespace {
int placed = 0;
}

// The linker leads calls of placeLandmarks() through here.
namespace trephine {
Result<std::vector<PlacedLandmark>>
realPlaceLandmarks(const Exercise&, const Volume&, const LabelMap*, const Progress&) asm(
    "__real__ZN8trephine14placeLandmarksERKNS_8ExerciseERKNS_6VolumeEPKNS_8LabelMapERKNS_"
    "8ProgressE");
Result<std::vector<PlacedLandmark>>
wrappedPlaceLandmarks(const Exercise& exercise, const Volume& volume, const LabelMap* labels, const Progress& progress) asm(
    "__wrap__ZN8trephine14placeLandmarksERKNS_8ExerciseERKNS_6VolumeEPKNS_8LabelMapERKNS_"
    "8ProgressE");
Result<std::vector<PlacedLandmark>> wrappedPlaceLandmarks(const Exercise& exercise,
                                                          const Volume& volume,
                                                          const LabelMap* labels,
                                                          const Progress& progress) {
  ++::placed;
  return realPlaceLandmarks(exercise, volume, labels, progress);
}

namespace {

// A ball of bone in scalp, 96 mm across, on voxels of 0.3 mm: 62.5 MB.
Volume largeHead() {
  return test::shells(320, 0.3, {{44, -20}, {39, 1200}, {32, 35}});
}

TEST(Copies, AreOneOfACaseAndAnotherOfTheGridThatIsCutAndTheyAreHashedAndSearchedOnce) {
  if (test::kSanitized) GTEST_SKIP() << "A sanitizer has memory of its own";
  test::TemporaryFolder folder;
  Exercise exercise = *readExercise(resourceFolder() / "scenes" / "cranium.json");
  const std::size_t count = [&] {
    const Volume head = largeHead();
    EXPECT_TRUE(writeVolume(head, folder / "head.mha").ok());
    return head.geometry.voxelCount();
  }();
  const double copy_mb = voxelsMb(count);
  exercise = onCase(exercise, (folder / "head.mha").string());

  test::hashed_bytes = 0;
  const double before_mb = test::privateDirtyMb();
  const Result<Placement> of = openCase(exercise);
  ASSERT_TRUE(of.ok()) << of.error().sentence();
  ASSERT_FALSE(of->error) << of->error->sentence();
  const double opened_mb = test::privateDirtyMb();
  EXPECT_NEAR((opened_mb - before_mb) / copy_mb, 1.0, 0.1);
  EXPECT_EQ(of->patient.volume->hu.size(), count);
  EXPECT_EQ(test::hashed_bytes, 2 * count) << "once";

  auto session = Session::create(
      *of, {folder / "s.h5", *readOperatorScript(exercise.operator_file, exercise)});
  ASSERT_TRUE(session.ok()) << session.error().sentence();
  const double made_mb = test::privateDirtyMb() - opened_mb;
  EXPECT_GT(made_mb / copy_mb, 1.0) << "the grid";
  EXPECT_LT(made_mb, exerciseMb(count)) << "what was promised";
  EXPECT_EQ((*session)->grid().geometry().voxelCount(), count);

  ASSERT_TRUE((*session)->freewheel(1.0).ok());
  const double ran_mb = test::privateDirtyMb() - opened_mb;
  EXPECT_LT(ran_mb, exerciseMb(count));
  EXPECT_LT(ran_mb - made_mb, 0.5 * copy_mb) << "the hash at the end makes no copy";
  EXPECT_EQ(test::hashed_bytes, 2 * 2 * count) << "once more, at the end";
  EXPECT_EQ(::placed, 1);
  std::printf("a copy has %.1f MB; opened %.2f copies, the exercise %.1f MB, after it %.1f MB\n",
              copy_mb, (opened_mb - before_mb) / copy_mb, made_mb, ran_mb);
}

}  // namespace
}  // namespace trephine
