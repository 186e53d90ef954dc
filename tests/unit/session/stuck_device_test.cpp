// In a program of its own: a device that was left behind is not offered again while it runs.
#include <chrono>
#include <fstream>

#include "base/file.h"
#include "base/system.h"
#include "cases.h"
#include "session/session.h"
#include "shells.h"
#include "support.h"
#include "training/replay.h"

namespace trephine {
namespace {

Volume block() {
  return test::shells(64, 1.5, {{40, 1200}});
}

Exercise cranium() {
  return *readExercise(resourceFolder() / "scenes" / "cranium.json");
}

// Arms whose reading blocks at 0.3 s for `block_s`.
Rig blocking(const std::filesystem::path& folder, double block_s) {
  Json json = *readJsonFile(resourceFolder() / "devices" / "omni.json");
  json.update({{"block_after_s", 0.3}, {"block_for_s", block_s}});
  std::ofstream(folder / "arms.json") << json.dump();
  Rig rig = simulatedRig(cranium());
  for (Rig::Arm& arm : rig.arms) arm.device.config = (folder / "arms.json").string();
  return rig;
}

TEST(StuckDevice, IsLeftBehindByStopAndNotOfferedAgain) {
  test::TemporaryFolder folder;
  constexpr double kBlock_s = 3.0;
  const Exercise exercise = cranium();
  SessionOptions options{folder / "s.h5", *readOperatorScript(exercise.operator_file, exercise)};
  options.rig = blocking(folder.path(), kBlock_s);
  auto made = Session::create(test::placed(exercise, block()), options);
  ASSERT_TRUE(made.ok()) << made.error().sentence();
  auto session = *std::move(made);
  ASSERT_TRUE(session->start(60.0).ok());
  ASSERT_TRUE(test::waitUntil(
      [&] { return session->standsStillFor_s() >= 0.05 && session->state().ticks >= 300; }));

  const auto stopping = std::chrono::steady_clock::now();
  EXPECT_TRUE(session->stop().ok()) << "the recording is whole";
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - stopping;
  EXPECT_LT(took.count(), 2.0) << "stop answers while the call still blocks";
  std::printf("stop took %.3f s while a device blocked\n", took.count());
  ASSERT_TRUE(session->leftBehind());
  EXPECT_EQ(session->leftBehind()->code.str(), "DEVICE_STUCK");
  EXPECT_NE(session->leftBehind()->what.find("'left'"), std::string::npos);

  SessionOptions without;
  without.rig = blocking(folder.path(), 0.0);
  const auto again = Session::create(test::placed(exercise, block()), without);
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().code.str(), "DEVICE_STUCK");
  EXPECT_EQ(test::threadsNamed("haptic").size(), 1u) << "the call still blocks";

  const RunReport report = session->report();
  EXPECT_EQ(report.done.ticks, 300u);
  ASSERT_GE(report.done.faults.size(), 2u);
  EXPECT_EQ(toJson(report)["faults"].back()["fault"], "stuck");
  const std::string voxels = volumeSha256(session->grid().snapshot());

  const auto reader = SessionReader::open(folder / "s.h5");
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  ASSERT_TRUE((*reader)->end()) << "ended, not cut short";
  EXPECT_EQ((*reader)->tickCount(), 300u);
  const auto events = *(*reader)->events();
  ASSERT_GE(events.size(), 3u);
  EXPECT_EQ(events[events.size() - 3].kind, EventKind::silenced) << "the watchdog's";
  EXPECT_EQ(events.back().value, std::uint32_t(kFaultStuck));
  const auto result = replay(**reader, block());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << result->first_difference->field;
  EXPECT_EQ(result->metrics.faults, report.done.faults) << "also the one of no tick";

  // It wakes after the session is gone, and ends without a trace: the voxels stay.
  const std::shared_ptr<const Grid> carved = session->carved();
  session.reset();
  EXPECT_TRUE(test::waitUntil([] { return test::threadsNamed("haptic").empty(); }));
  EXPECT_EQ(volumeSha256(carved->snapshot()), voxels);
}

}  // namespace
}  // namespace trephine
