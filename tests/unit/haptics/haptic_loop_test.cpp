#include "haptics/haptic_loop.h"

#include <fstream>
#include <sstream>

#include "base/rt/alloc_guard.h"
#include "base/system.h"
#include "haptics_support.h"

namespace trephine {
namespace {

// Pushes the arms into the bone and out again, once a second.
struct Pusher : Operator {
  void setPoints(std::uint64_t tick, OperatorSetPoint* of_arms, std::size_t arms) override {
    const double t = double(tick % 1000) / 1000.0;
    const double z_mm = t < 0.5 ? 8 - 30 * t : -7 + 30 * (t - 0.5);
    for (std::size_t i = 0; i < arms; ++i) {
      of_arms[i] = {Pose{Vec3(0.004 * double(i), 0, z_mm / 1000.0), Quat(1, 0, 0, 0)}, 800.0, 8.0};
    }
  }
  bool command(std::uint64_t tick, Command& out) override {
    if (tick < 1200 || given) return false;
    given = true;
    out = {CommandKind::undo, 0, {}};
    return true;
  }
  bool given = false;
};

// Time that stands still but for the sleeps asked for.
struct FakeClock : LoopClock {
  std::int64_t time_ns = 0;
  std::int64_t now_ns() override { return time_ns; }
  void sleepUntil(std::int64_t until_ns) override { time_ns = until_ns; }
};

struct TwoArms {
  TwoArms() : grid(test::boneSlab()), core(parameters(), *grid.takeWriter()) {
    auto plugin = DevicePlugin::load("simulated", pluginFolder());
    std::ifstream in(resourceFolder() / "devices" / "omni.json");
    std::stringstream config;
    config << in.rdbuf();
    auto device = Device::open(*plugin, {0, 1}, config.str());
    std::vector<LoopDevice> devices;
    devices.push_back({*std::move(device), {0, 1}});
    loop = std::make_unique<HapticLoop>(core, std::move(devices), &pusher);
    EXPECT_TRUE(loop->startDevices().ok());
  }
  static HapticParameters parameters() {
    HapticParameters p = test::oneArm();
    p.arms.push_back(p.arms[0]);
    return p;
  }
  Grid grid;
  HapticCore core;
  Pusher pusher;
  std::unique_ptr<HapticLoop> loop;
};

std::vector<TickRecord> drain(HapticLoop& loop) {
  std::vector<TickRecord> records;
  TickRecord record;
  while (loop.records().pop(record)) records.push_back(record);
  return records;
}

TEST(HapticLoop, FreewheelsToTheSameResultAsAClockedRun) {
  TwoArms free, clocked;
  for (int i = 0; i < 2500; ++i) free.loop->step(0);
  FakeClock clock;
  std::atomic<bool> stop{false};
  clocked.loop->run(clock, stop, 2500);
  EXPECT_EQ(clock.time_ns, 2499 * 1'000'000ll);
  const auto a = drain(*free.loop), b = drain(*clocked.loop);
  ASSERT_EQ(a.size(), 2500u);
  ASSERT_EQ(b.size(), 2500u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t arm = 0; arm < 2; ++arm) {
      ASSERT_EQ(a[i].arms[arm].sent_N, b[i].arms[arm].sent_N) << i;
      ASSERT_EQ(a[i].arms[arm].device_position_m, b[i].arms[arm].device_position_m) << i;
    }
  }
  EXPECT_EQ(volumeSha256(free.grid.snapshot()), volumeSha256(clocked.grid.snapshot()));
}

TEST(HapticLoop, MovesBothArmsAndRemovesBoneWithinTheForceLimit) {
  TwoArms two;
  for (int i = 0; i < 1000; ++i) two.loop->step(0);
  EXPECT_GT(two.core.journal().removed(0, 0), 2u);
  EXPECT_GT(two.core.journal().removed(1, 0), 2u);
  double largest = 0.0;
  for (const TickRecord& r : drain(*two.loop)) {
    for (const ArmRecord& arm : r.arms) largest = std::max(largest, glm::length(arm.sent_N));
  }
  EXPECT_GT(largest, 1.0);
  EXPECT_LE(largest, 3.3);
}

TEST(HapticLoop, TheOperatorsCommandIsGivenOnceAndRecordedWithItsTick) {
  TwoArms two;
  for (int i = 0; i < 1500; ++i) two.loop->step(0);
  Event event;
  int commands = 0;
  while (two.loop->events().pop(event)) {
    if (event.kind != EventKind::command) continue;
    ++commands;
    EXPECT_EQ(event.tick, 1200u);
    EXPECT_EQ(event.command.kind, CommandKind::undo);
  }
  EXPECT_EQ(commands, 1);
}

TEST(HapticLoop, AWholeTickAllocatesNothing) {
  TwoArms two;
  const std::uint64_t before = rt::guardedAllocations();
  for (int i = 0; i < 3000; ++i) two.loop->step(0);
  EXPECT_EQ(rt::guardedAllocations(), before);
}

TEST(HapticLoop, AFullRingDropsAndCountsInsteadOfWaiting) {
  TwoArms two;
  for (int i = 0; i < 9000; ++i) two.loop->step(0);
  EXPECT_EQ(two.loop->dropped(), 9000u - two.loop->records().capacity());
}

TEST(HapticLoop, PublishesTheNewestState) {
  TwoArms two;
  for (int i = 0; i < 700; ++i) two.loop->step(0);
  ASSERT_TRUE(two.loop->state().refresh());
  const LoopState& state = two.loop->state().value();
  EXPECT_EQ(state.ticks, 700u);
  EXPECT_EQ(state.record.tick, 699u);
  EXPECT_TRUE(state.can_undo);
  EXPECT_GT(state.removed[0][0], 0u);
}

}  // namespace
}  // namespace trephine
