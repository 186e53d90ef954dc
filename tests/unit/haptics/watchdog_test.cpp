#include "haptics/watchdog.h"

#include <atomic>
#include <thread>

#include "haptics_support.h"
#include "support.h"
#include "unit/plain_api.h"

namespace trephine {
namespace {

using namespace std::chrono_literals;
using test::waitUntil;

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

// Holds whoever comes to it while it is closed.
class Gate {
 public:
  void close() { closed_ = true; }
  void open() {
    closed_ = false;
    closed_.notify_all();
  }
  bool isClosed() const { return closed_; }
  void pass() const { closed_.wait(true); }

 private:
  std::atomic<bool> closed_{false};
};

// A device of one arm whose calls wait at their gates.
struct Watched {
  static inline Gate reading, writing, stopping;
  static inline std::atomic<int> silences{0}, reads{0}, waiting{0};
  static inline std::atomic<double> commanded_N{0.0};

  static int read(TrephineDevice*, double, TrephineArmState* states) {
    ++reads;
    waiting = 1;
    reading.pass();
    waiting = 0;
    states->sequence = std::uint64_t(reads);
    states->position_m[2] = -0.004 - 1e-5 * (reads % 2);  // in bone, moving
    return TREPHINE_OK;
  }
  static int write(TrephineDevice*, const TrephineArmCommand* commands) {
    if (writing.isClosed()) waiting = 1;
    writing.pass();
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
        stopping.pass();
      };
      return a;
    }();
    return api;
  }
};

// The loop and its watchdog, each on a thread.
struct Running {
  Running() : grid(test::boneSlab()), core(parameters(), *grid.takeWriter()) {
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
    EXPECT_TRUE(waitUntil([this] { return loop->ticks() > 50; }));
  }
  ~Running() {
    Watched::reading.open();
    Watched::writing.open();
    Watched::stopping.open();
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
  Watched::reading.close();
  ASSERT_TRUE(waitUntil([] { return Watched::silences > 0; }));
  EXPECT_TRUE(waitUntil([&] { return running.watchdog->stillFor_s() > 0.02; }));
  const std::uint64_t tick = running.loop->ticks();
  Watched::reading.open();
  ASSERT_TRUE(waitUntil([&] { return running.loop->ticks() > tick + 20; }));
  Event event;
  bool silenced = false, late = false;
  while (running.loop->events().pop(event)) {
    silenced |= event.kind == EventKind::silenced && event.tick >= tick;
    late |= event.kind == EventKind::fault && event.value == kFaultLate && event.tick >= tick;
  }
  EXPECT_TRUE(silenced);
  EXPECT_TRUE(late);
  EXPECT_EQ(Watched::commanded_N, 0.0) << "by the rule of lateness";
  EXPECT_TRUE(waitUntil([&] { return running.watchdog->stillFor_s() == 0.0; }));
}

TEST(Watchdog, SilencesAtOnceWhenAskedEvenWhileADeviceBlocks) {
  Running running;
  Watched::reading.close();
  ASSERT_TRUE(waitUntil([] { return Watched::waiting == 1; }));
  const int before = Watched::silences;
  EXPECT_TRUE(running.watchdog->silence(20s));
  EXPECT_GT(Watched::silences, before);
}

// Its safe_stop waits until the device lets go, as one that needs the same mutex.
TEST(Watchdog, SaysThatTicksStandStillThoughSafeStopDoesNotReturnAndCountsThemOnce) {
  Running running;
  Watched::stopping.close();
  Watched::reading.close();
  EXPECT_TRUE(waitUntil([&] { return running.watchdog->stillFor_s() > 0.05; }));
  EXPECT_TRUE(running.loop->silenceIsPending());
  Watched::reading.open();
  Watched::stopping.open();
  EXPECT_TRUE(waitUntil([&] { return running.watchdog->stillFor_s() == 0.0; }));
}

TEST(HapticLoop, AThreadThatADeviceHoldsIsLeftBehindAndTouchesNoVoxelsLater) {
  Running running;
  Watched::reading.close();
  ASSERT_TRUE(waitUntil([] { return Watched::waiting == 1; }));
  const std::uint64_t ticks = running.loop->ticks();
  ASSERT_EQ(running.loop->leaveBehind(), std::size_t(0));
  Watched::reading.open();
  EXPECT_TRUE(waitUntil([&] { return !running.loop->running(); })) << "it ends by itself";
  EXPECT_EQ(running.loop->ticks(), ticks) << "without the tick that it was in";
  EXPECT_TRUE(waitUntil([&] { return !running.here; }));
}

TEST(Watchdog, TakesTheForceAwayWhileADeviceDoesNotTakeItsForce) {
  Running running;
  Watched::silences = 0;
  Watched::writing.close();
  EXPECT_TRUE(waitUntil([] { return Watched::silences > 0; }));
  EXPECT_TRUE(waitUntil([&] { return running.watchdog->stillFor_s() > 0.02; }));
}

TEST(HapticLoop, AThreadThatADeviceHoldsInWritingIsLeftBehindWithAWholeRecord) {
  Running running;
  Watched::writing.close();
  ASSERT_TRUE(waitUntil([] { return Watched::waiting == 1; }));
  const std::uint64_t ticks = running.loop->ticks();
  ASSERT_EQ(running.loop->leaveBehind(), std::size_t(0));
  Watched::writing.open();
  EXPECT_TRUE(waitUntil([&] { return !running.loop->running(); })) << "it ends by itself";
  EXPECT_EQ(running.loop->ticks(), ticks);
  std::uint64_t recorded = 0;
  for (TickRecord record; running.loop->records().pop(record);) ++recorded;
  EXPECT_EQ(recorded, ticks);
}

TEST(HapticLoop, SendsTheForceOfATickInThatTick) {
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
