#include "haptics/watchdog.h"

#include <atomic>
#include <thread>

#include "haptics_support.h"
#include "unit/plain_api.h"

namespace trephine {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kMs = 1'000'000;

TEST(Standstill, BeginsOnceWhenACountIsTheSameForTwentyMilliseconds) {
  Standstill still;
  EXPECT_FALSE(still.begins(7, true, 100 * kMs));
  EXPECT_FALSE(still.begins(7, true, 119 * kMs));
  EXPECT_TRUE(still.begins(7, true, 120 * kMs));
  EXPECT_EQ(still.since_ns(), 100 * kMs);
  EXPECT_FALSE(still.begins(7, true, 150 * kMs)) << "said already";
  EXPECT_FALSE(still.begins(8, true, 151 * kMs)) << "goes on";
  EXPECT_EQ(still.since_ns(), 0);
  EXPECT_TRUE(still.begins(8, true, 171 * kMs)) << "again";
}

TEST(Standstill, DoesNotBeginWhileTicksComeOrNothingIsDue) {
  Standstill still;
  for (int ms = 0; ms < 1000; ++ms) EXPECT_FALSE(still.begins(std::uint64_t(ms), true, ms * kMs));
  for (int ms = 1000; ms < 2000; ++ms) EXPECT_FALSE(still.begins(1000, false, ms * kMs));
  EXPECT_FALSE(still.begins(1000, true, 2000 * kMs)) << "counts from here";
}

// A device of one arm whose reading waits while `held`, and its writing while `write_held`.
struct Watched {
  static inline std::atomic<bool> held{false}, write_held{false}, stops_wait{false};
  static inline std::atomic<int> silences{0}, reads{0}, waiting{0};
  static inline std::atomic<double> commanded_N{0.0};

  static int read(TrephineDevice*, double, TrephineArmState* states) {
    ++reads;
    waiting = 1;
    while (held) std::this_thread::sleep_for(1ms);
    waiting = 0;
    states->sequence = std::uint64_t(reads);
    states->position_m[2] = -0.004 - 1e-5 * (reads % 2);  // in bone, moving
    return TREPHINE_OK;
  }
  static int write(TrephineDevice*, const TrephineArmCommand* commands) {
    if (write_held) waiting = 1;
    while (write_held) std::this_thread::sleep_for(1ms);
    waiting = 0;
    commanded_N = commands->force_N[2];
    return TREPHINE_OK;
  }
  static const TrephineDeviceApi& api() {
    static const TrephineDeviceApi api = [] {
      TrephineDeviceApi a = test::plainApi("held");
      a.read = read;
      a.write = write;
      a.safe_stop = [](TrephineDevice*) {
        ++silences;
        while (stops_wait) std::this_thread::sleep_for(1ms);
      };
      return a;
    }();
    return api;
  }
};

// The loop and its watchdog, each on a thread.
struct Running {
  Running() : grid(test::boneSlab()), core(parameters(), *grid.takeWriter()) {
    Watched::held = Watched::write_held = false;
    Watched::silences = Watched::reads = 0;
    std::vector<LoopDevice> devices;
    devices.push_back({*Device::open(*DevicePlugin::builtIn(Watched::api()), {0}, "{}"), {0}});
    loop = std::make_unique<HapticLoop>(core, std::move(devices), nullptr);
    watchdog = std::make_unique<Watchdog>(*loop);
    EXPECT_TRUE(loop->startDevices().ok());
    watching = std::thread([this] { watchdog->run(); });
    ticking = std::thread([this] {
      HostClock clock;
      here = loop->run(clock, stop);
    });
    until([this] { return loop->ticks() > 50; });
  }
  ~Running() {
    Watched::held = Watched::write_held = false;
    stop = true;
    ticking.join();
    watchdog->end();
    watching.join();
  }
  static HapticParameters parameters() {
    HapticParameters p = test::oneArm();
    p.removal = RemovalKind::work;
    p.tissues.classes[0].cuttable = 0;
    return p;
  }
  template <class Condition>
  static bool until(Condition condition) {
    const auto deadline = std::chrono::steady_clock::now() + 20s;
    while (!condition() && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(1ms);
    }
    return condition();
  }

  Grid grid;
  HapticCore core;
  std::unique_ptr<HapticLoop> loop;
  std::unique_ptr<Watchdog> watchdog;
  std::atomic<bool> stop{false};
  std::atomic<bool> here{true};  // what run() said
  std::thread ticking, watching;
};

TEST(Watchdog, TakesTheForceAwayWhileADeviceBlocksAndTheNextTickKnows) {
  Running running;
  Watched::silences = 0;  // a busy machine may have stood still before
  Watched::held = true;
  ASSERT_TRUE(Running::until([] { return Watched::silences > 0; }));
  EXPECT_TRUE(Running::until([&] { return running.watchdog->stillFor_s() > 0.02; }));
  const std::uint64_t tick = running.loop->ticks();
  Watched::held = false;
  ASSERT_TRUE(Running::until([&] { return running.loop->ticks() > tick + 20; }));
  Event event;
  bool silenced = false, late = false;
  while (running.loop->events().pop(event)) {
    silenced |= event.kind == EventKind::silenced && event.tick >= tick;
    late |= event.kind == EventKind::fault && event.value == kFaultLate && event.tick >= tick;
  }
  EXPECT_TRUE(silenced);
  EXPECT_TRUE(late);
  EXPECT_EQ(Watched::commanded_N, 0.0) << "by the rule of lateness";
  EXPECT_TRUE(Running::until([&] { return running.watchdog->stillFor_s() == 0.0; }));
}

TEST(Watchdog, SilencesAtOnceWhenAskedEvenWhileADeviceBlocks) {
  Running running;
  Watched::held = true;
  ASSERT_TRUE(Running::until([] { return Watched::waiting == 1; }));
  const int before = Watched::silences;
  EXPECT_TRUE(running.watchdog->silence(20s));
  EXPECT_GT(Watched::silences, before);
}

// Its safe_stop waits until the device lets go, as one that needs the same mutex.
TEST(Watchdog, SaysThatTicksStandStillThoughSafeStopDoesNotReturnAndCountsThemOnce) {
  Running running;
  Watched::stops_wait = true;
  Watched::held = true;
  EXPECT_TRUE(Running::until([&] { return running.watchdog->stillFor_s() > 0.05; }));
  EXPECT_TRUE(running.loop->silenceIsPending());
  Watched::held = false;
  Watched::stops_wait = false;
  EXPECT_TRUE(Running::until([&] { return running.watchdog->stillFor_s() == 0.0; }));
}

TEST(HapticLoop, AThreadThatADeviceHoldsIsLeftBehindAndTouchesNoVoxelsLater) {
  Running running;
  Watched::held = true;
  ASSERT_TRUE(Running::until([] { return Watched::waiting == 1; }));
  const std::uint64_t ticks = running.loop->ticks();
  ASSERT_EQ(running.loop->leaveBehind(), std::size_t(0));
  Watched::held = false;
  EXPECT_TRUE(Running::until([&] { return !running.loop->running(); })) << "it ends by itself";
  EXPECT_EQ(running.loop->ticks(), ticks) << "without the tick that it was in";
  EXPECT_TRUE(Running::until([&] { return !running.here; }));
}

TEST(Watchdog, TakesTheForceAwayWhileADeviceDoesNotTakeItsForce) {
  Running running;
  Watched::silences = 0;
  Watched::write_held = true;
  EXPECT_TRUE(Running::until([] { return Watched::silences > 0; }));
  EXPECT_TRUE(Running::until([&] { return running.watchdog->stillFor_s() > 0.02; }));
}

TEST(HapticLoop, AThreadThatADeviceHoldsInWritingIsLeftBehindWithAWholeRecord) {
  Running running;
  Watched::write_held = true;
  ASSERT_TRUE(Running::until([] { return Watched::waiting == 1; }));
  const std::uint64_t ticks = running.loop->ticks();
  ASSERT_EQ(running.loop->leaveBehind(), std::size_t(0));
  Watched::write_held = false;
  EXPECT_TRUE(Running::until([&] { return !running.loop->running(); })) << "it ends by itself";
  EXPECT_EQ(running.loop->ticks(), ticks);
  std::uint64_t recorded = 0;
  for (TickRecord record; running.loop->records().pop(record);) ++recorded;
  EXPECT_EQ(recorded, ticks);
}

TEST(HapticLoop, SendsTheForceOfATickInThatTick) {
  Watched::held = Watched::write_held = false;
  Watched::reads = 0;
  Grid grid(test::boneSlab());
  HapticCore core(Running::parameters(), *grid.takeWriter());
  std::vector<LoopDevice> devices;
  devices.push_back({*Device::open(*DevicePlugin::builtIn(Watched::api()), {0}, "{}"), {0}});
  HapticLoop loop(core, std::move(devices), nullptr);
  ASSERT_TRUE(loop.startDevices().ok());
  int felt = 0;
  for (int tick = 1; tick <= 200; ++tick) {
    ASSERT_TRUE(loop.step(0));
    TickRecord record;
    ASSERT_TRUE(loop.records().pop(record));
    EXPECT_EQ(Watched::reads, tick);
    EXPECT_EQ(Watched::commanded_N, record.arms[0].sent_N.z);
    felt += record.arms[0].sent_N.z != 0.0;
  }
  EXPECT_GT(felt, 100);
}

TEST(HapticLoop, AThreadThatIsInNoCallIsNotLeftBehind) {
  test::Bench unused;
  HapticLoop loop(unused.core, {}, nullptr);
  EXPECT_FALSE(loop.leaveBehind());
}

}  // namespace
}  // namespace trephine
