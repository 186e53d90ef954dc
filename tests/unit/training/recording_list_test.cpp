// What is told of a recording, for a person to choose among them.
#include "training/recording_list.h"

#include <fstream>

#include "recording_support.h"
#include "support.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;

// 200 ticks at 1 kHz, in a pause from the first of these ticks to the second of each pair.
void record(const fs::path& file, const std::vector<std::uint64_t>& pauses_and_resumes,
            const std::string& case_source = "") {
  Exercise exercise = test::exerciseWithOneArm();
  exercise.case_source = case_source;
  auto recorder = SessionRecorder::create(
      file, {toJson(RecordedExercise{exercise, simulatedRig(exercise)}), "sha of the voxels", test::slab().geometry, "test"}, 1);
  ASSERT_TRUE(recorder.ok()) << recorder.error().sentence();
  std::size_t next = 0;
  for (std::uint64_t t = 0; t < 200; ++t) {
    if (next < pauses_and_resumes.size() && pauses_and_resumes[next] == t) {
      Event event;
      event.tick = t;
      event.command.kind = next % 2 == 0 ? CommandKind::pause : CommandKind::resume;
      (*recorder)->event(event);
      ++next;
    }
    TickRecord tick;
    tick.tick = t;
    (*recorder)->tick(tick);
  }
  ASSERT_TRUE((*recorder)->finish({200, 0, 0, ""}));
}

TEST(RecordingList, SaysHowLongAnExerciseWasWithoutItsPauses) {
  const test::TemporaryFolder folder;
  record(folder / "a.h5", {});
  record(folder / "b.h5", {20, 60});
  record(folder / "c.h5", {20, 60, 150});  // it ended in a pause
  for (const std::string name : {"a.h5", "b.h5", "c.h5"}) {
    const ListedRecording row = listRecording(folder / name);
    EXPECT_FALSE(row.problem) << row.problem->sentence();
    EXPECT_NEAR(row.seconds, name == "a.h5" ? 0.2 : name == "b.h5" ? 0.16 : 0.11, 1e-9) << name;
  }
}

TEST(RecordingList, NamesACaseByItsSourceWhereItIsBuiltInElseByItsVoxels) {
  const test::TemporaryFolder folder;
  record(folder / "a.h5", {}, "phantom:cranium");
  EXPECT_EQ(listRecording(folder / "a.h5").caseKey(), "phantom:cranium");
  record(folder / "b.h5", {});
  EXPECT_EQ(listRecording(folder / "b.h5").caseKey(), "sha of the voxels");
}

TEST(RecordingList, NamesWhatIsNoRecording) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "empty.h5");
  EXPECT_TRUE(listRecording(folder / "empty.h5").problem);
}

}  // namespace
}  // namespace trephine
