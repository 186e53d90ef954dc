// A loop whose clock is a device's own samples: their times, a device that stops, one that lies.
#include <cmath>

#include "device/device.h"
#include "haptics/haptic_loop.h"
#include "haptics_support.h"
#include "unit/plain_api.h"

namespace trephine {
namespace {

constexpr std::int64_t kT = 1'000'000;

struct FakeClock : LoopClock {
  std::int64_t time_ns = 7'000'000'000;
  std::int64_t now_ns() override { return time_ns; }
  void sleepUntil(std::int64_t until_ns) override { time_ns = std::max(time_ns, until_ns); }
};

TEST(SampleSchedule, TicksWithTheSamplesAndFollowsTheirClock) {
  FakeClock clock;
  SampleSchedule schedule(kT);
  const auto sampleIn = [&](std::int64_t ns) {
    return [&clock, ns](double) {
      clock.time_ns += ns;
      return true;
    };
  };
  EXPECT_EQ(schedule.waitForTick(clock, sampleIn(600'000)), 0) << "the first is due when it comes";
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(schedule.waitForTick(clock, sampleIn(1'001'000)), 1000);
  EXPECT_EQ(schedule.missed(), 0u);
  EXPECT_EQ(schedule.waitForTick(clock, sampleIn(1'600'000)), 600'000);
  EXPECT_EQ(schedule.missed(), 1u);
  // A sample that comes in a heap with the one before waits.
  const std::int64_t before_ns = clock.time_ns;
  EXPECT_EQ(schedule.waitForTick(clock, sampleIn(0)), 0);
  EXPECT_EQ(clock.time_ns - before_ns, kT / 2);
}

TEST(SampleSchedule, TheHostsClockTakesThePlaceOfSamplesThatDoNotCome) {
  FakeClock clock;
  SampleSchedule schedule(kT);
  double asked_s = 0.0;
  const auto nothing = [&](double seconds) {
    asked_s = seconds;
    clock.time_ns += std::int64_t(seconds * 1e9 + 0.5);
    return false;
  };
  const auto atOnce = [](double) { return false; };
  schedule.waitForTick(clock, [](double) { return true; });
  const std::int64_t last_ns = clock.time_ns;
  EXPECT_EQ(schedule.waitForTick(clock, nothing), SampleSchedule::kPatience_ns);
  EXPECT_NEAR(asked_s, 5e-3, 1e-9);
  EXPECT_LT(clock.time_ns - last_ns, 20 * kT) << "replaced within 20 ms";
  const std::int64_t from_ns = clock.time_ns;
  for (int i = 0; i < 50; ++i) EXPECT_EQ(schedule.waitForTick(clock, nothing), 0);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(schedule.waitForTick(clock, atOnce), 0) << "no spinning";
  EXPECT_EQ(clock.time_ns - from_ns, 100 * kT);
  // And they take it back.
  clock.time_ns += 300'000;
  schedule.waitForTick(clock, [&](double) {
    clock.time_ns += 500'000;
    return true;
  });
  EXPECT_EQ(schedule.waitForTick(clock, nothing), SampleSchedule::kPatience_ns);
}

// One arm with a clock of its own.
struct Paced {
  static inline FakeClock clock;
  static inline std::int64_t last_ns = 0;
  static inline std::uint64_t sequence = 0;
  static inline bool silent = false, frozen = false;
  static inline double commanded_N = 0.0;

  static int wait(TrephineDevice*, double timeout_s) {
    const std::int64_t next_ns = last_ns + kT;
    const std::int64_t until_ns = clock.time_ns + std::int64_t(timeout_s * 1e9);
    if (silent || next_ns > until_ns) {
      clock.sleepUntil(until_ns);
      return TREPHINE_ERROR_TIMEOUT;
    }
    clock.sleepUntil(next_ns);
    last_ns = next_ns;
    return TREPHINE_OK;
  }
  static int read(TrephineDevice*, double, TrephineArmState* states) {
    if (!frozen && !silent) ++sequence;
    states->sequence = sequence;
    states->time_ns = last_ns;
    states->flags = TREPHINE_ARM_CALIBRATED;
    states->position_m[2] = -0.004 - 1e-5 * double(sequence % 2);
    return TREPHINE_OK;
  }
  static int write(TrephineDevice*, const TrephineArmCommand* commands) {
    const double* f = commands->force_N;
    commanded_N = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    return TREPHINE_OK;
  }
  static const TrephineDeviceApi& api() {
    static const TrephineDeviceApi api = [] {
      TrephineDeviceApi a = test::plainApi("paced");
      a.read = read;
      a.write = write;
      a.wait = wait;
      return a;
    }();
    return api;
  }

  Paced() : grid(test::boneSlab()), core(parameters(), *grid.takeWriter()) {
    clock = FakeClock();
    last_ns = clock.time_ns;
    sequence = 0;
    silent = frozen = false;
    commanded_N = 0.0;
    auto device = Device::open(*DevicePlugin::builtIn(api()), {0}, "{}");
    EXPECT_TRUE((*device)->hasClock());
    std::vector<LoopDevice> devices;
    devices.push_back({*std::move(device), {0}, true});
    loop = std::make_unique<HapticLoop>(core, std::move(devices), nullptr);
    EXPECT_TRUE(loop->startDevices().ok());
  }
  static HapticParameters parameters() {
    HapticParameters p = test::oneArm();
    p.tissues.classes[0].cuttable = 0;
    return p;
  }
  void run(std::uint64_t ticks) { loop->run(clock, stop, loop->ticks() + ticks); }
  TickRecord last() {
    TickRecord record;
    while (loop->records().pop(record)) {
    }
    return record;
  }

  Grid grid;
  HapticCore core;
  std::unique_ptr<HapticLoop> loop;
  std::atomic<bool> stop{false};
};

TEST(HapticLoop, ADevicesOwnSamplesAreItsClock) {
  Paced arm;
  const std::int64_t from_ns = Paced::clock.time_ns;
  arm.run(1000);
  EXPECT_EQ(Paced::clock.time_ns - from_ns, 1000 * kT);
  EXPECT_EQ(Paced::sequence, 1000u) << "each sample once";
  EXPECT_EQ(arm.loop->missed(), 0u);
  EXPECT_GT(Paced::commanded_N, 0.04);
  EXPECT_EQ(arm.last().arms[0].faults, 0u);
}

TEST(HapticLoop, ADeviceThatStopsSamplingLosesItsForceWithinTwentyMilliseconds) {
  Paced arm;
  arm.run(500);
  ASSERT_GT(Paced::commanded_N, 0.04);
  Paced::silent = true;
  const std::int64_t from_ns = Paced::clock.time_ns;
  arm.run(15);
  EXPECT_LT(Paced::clock.time_ns - from_ns, 20 * kT);
  EXPECT_EQ(arm.last().arms[0].faults, std::uint32_t(kFaultDeviceLost));
  EXPECT_EQ(Paced::commanded_N, 0.0);
  const std::uint64_t ticks = arm.loop->ticks();
  const std::int64_t then_ns = Paced::clock.time_ns;
  arm.run(200);
  EXPECT_EQ(arm.loop->ticks() - ticks, 200u) << "the loop goes on, by the host's clock";
  EXPECT_NEAR(double(Paced::clock.time_ns - then_ns), 200.0 * kT, 5.0 * kT);
}

TEST(HapticLoop, ASampleThatStaysTheSameIsALostArmWhateverThePluginSays) {
  Paced arm;
  arm.run(500);
  Paced::frozen = true;
  arm.run(14);
  EXPECT_EQ(arm.last().arms[0].faults, 0u);
  arm.run(1);
  EXPECT_EQ(arm.last().arms[0].faults, std::uint32_t(kFaultDeviceLost));
  EXPECT_EQ(Paced::commanded_N, 0.0);
}

}  // namespace
}  // namespace trephine
