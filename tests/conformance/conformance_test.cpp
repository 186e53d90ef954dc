// What every device plugin keeps to: the rules of trephine_device.h, on a device that behaves and
// on one in trouble. test_device.h is the device behind it.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <semaphore>
#include <set>
#include <thread>
#include <vector>

#include "../support.h"
#include "base/rt/alloc_guard.h"
#include "device/arm_numbers.h"
#include "test_device.h"

namespace trephine::conformance {
namespace {

using std::chrono::steady_clock;
using test::waitUntil;
constexpr double kT = 1e-3;
constexpr double kSoon_s = 0.02;

double secondsSince(steady_clock::time_point start) {
  return std::chrono::duration<double>(steady_clock::now() - start).count();
}

TrephineDeviceEntry entry() {
  static void* library = ::dlopen(pluginFile(), RTLD_NOW | RTLD_LOCAL);
  if (!library) return nullptr;
  return reinterpret_cast<TrephineDeviceEntry>(::dlsym(library, TREPHINE_DEVICE_ENTRY));
}

template <class T>
T sized() {
  T value{};
  value.size = sizeof(T);
  value.version = TREPHINE_DEVICE_ABI;
  return value;
}

// A host of its own: the calls, in the order and at the times that the haptic loop has.
class PluginConformance : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(entry()) << pluginFile() << " has no " TREPHINE_DEVICE_ENTRY;
    api = entry()(TREPHINE_DEVICE_ABI);
    ASSERT_TRUE(api) << "it does not speak version " << TREPHINE_DEVICE_ABI;
    behind = makeTestDevice();
    ASSERT_TRUE(behind);
  }
  void TearDown() override { close(); }

  // Opened and configured; false where this device cannot have that trouble.
  bool open(Trouble trouble = Trouble::none, double after_s = 0.05) {
    close();
    if (!behind->prepare(trouble, after_s)) return false;
    std::vector<std::uint32_t> places;
    for (std::uint32_t arm = 0; arm < behind->arms(); ++arm) places.push_back(arm);
    EXPECT_EQ(api->open(places.data(), behind->arms(), &handle), TREPHINE_OK)
        << api->last_error(nullptr);
    if (!handle) return false;
    EXPECT_EQ(api->configure(handle, behind->config().c_str()), TREPHINE_OK)
        << api->last_error(handle);
    states.assign(behind->arms(), sized<TrephineArmState>());
    for (TrephineArmState& state : states) state.orientation[0] = 1.0;
    commands.assign(behind->arms(), sized<TrephineArmCommand>());
    return true;
  }
  bool start() {
    for (std::uint32_t arm = 0; arm < behind->arms(); ++arm) {
      EXPECT_EQ(api->calibrate(handle, arm), TREPHINE_OK) << api->last_error(handle);
    }
    const int answer = api->start(handle);
    EXPECT_EQ(answer, TREPHINE_OK) << api->last_error(handle);
    behind->beginTicks();
    return answer == TREPHINE_OK;
  }
  void close() {
    if (!handle) return;
    api->safe_stop(handle);
    api->stop(handle);
    api->close(handle);
    handle = nullptr;
  }
  void push(const Vec3& force_N) {
    for (TrephineArmCommand& command : commands) {
      for (int axis = 0; axis < 3; ++axis) command.force_N[axis] = force_N[axis];
    }
  }
  // Waits for the next sample where the plugin has a clock, else for the host's.
  void await() {
    if (api->wait) {
      api->wait(handle, 5 * kT);
    } else {
      behind->awaitTick();
    }
  }
  // A tick; true while the arms answer and are not lost.
  bool tick() {
    await();
    bool well = api->read(handle, kT, states.data()) == TREPHINE_OK;
    for (const TrephineArmState& state : states) well = well && !(state.flags & TREPHINE_ARM_LOST);
    return api->write(handle, commands.data()) == TREPHINE_OK && well;
  }
  // Ticks for so many seconds of samples.
  int ticks(double seconds) {
    int well = 0;
    for (int i = 0; i < int(seconds / kT); ++i) well += tick();
    return well;
  }
  void expectForce(const Vec3& wanted_N, const char* when) {
    for (std::uint32_t arm = 0; arm < behind->arms(); ++arm) {
      const Vec3 has_N = behind->force_N(arm, states[arm]);
      EXPECT_LE(glm::distance(has_N, wanted_N), behind->tolerance_N())
          << when << ", arm " << arm << ": " << has_N.x << ", " << has_N.y << ", " << has_N.z;
    }
  }

  const TrephineDeviceApi* api = nullptr;
  std::unique_ptr<TestDevice> behind;
  TrephineDevice* handle = nullptr;
  std::vector<TrephineArmState> states;
  std::vector<TrephineArmCommand> commands;
};

TEST_F(PluginConformance, SpeaksThisVersionToItsHostAndNoOtherToAnOlderOrANewerOne) {
  EXPECT_EQ(api->version, TREPHINE_DEVICE_ABI);
  EXPECT_GE(api->size, sizeof(TrephineDeviceApi));
  EXPECT_TRUE(api->name && *api->name);
  for (std::uint32_t other :
       {0u, TREPHINE_DEVICE_ABI - 1, TREPHINE_DEVICE_ABI + 1, 4'000'000'000u}) {
    EXPECT_EQ(entry()(other), nullptr) << other;
  }
  EXPECT_TRUE(api->enumerate && api->open && api->configure && api->capabilities &&
              api->calibrate && api->start && api->read && api->write && api->stop &&
              api->safe_stop && api->last_error && api->close);
}

TEST_F(PluginConformance, CountsItsArmsAndTellsThemApart) {
  ASSERT_TRUE(behind->prepare(Trouble::none, 0.0));
  const std::uint32_t count = api->enumerate(nullptr, 0);
  ASSERT_GE(count, behind->arms());
  std::vector<TrephineArmInfo> infos(count + 1, sized<TrephineArmInfo>());
  EXPECT_EQ(api->enumerate(infos.data(), 1), count);
  EXPECT_EQ(infos[1].bus_path[0], '\0') << "wrote beyond the room that it was given";
  EXPECT_EQ(api->enumerate(infos.data(), count + 1), count);
  std::set<std::string> paths;
  for (std::uint32_t i = 0; i < count; ++i) {
    EXPECT_NE(infos[i].model[0], '\0') << i;
    paths.insert(infos[i].bus_path);
  }
  EXPECT_EQ(paths.size(), count);
}

TEST_F(PluginConformance, RefusesArmsThatAreNotThereInOneSentence) {
  ASSERT_TRUE(behind->prepare(Trouble::none, 0.0));
  TrephineDevice* none = nullptr;
  for (const std::vector<std::uint32_t>& places :
       {std::vector<std::uint32_t>{1000}, {0, 0}, {0, 1, 2, 3, 4, 5, 6, 7}}) {
    EXPECT_NE(api->open(places.data(), std::uint32_t(places.size()), &none), TREPHINE_OK);
    EXPECT_EQ(none, nullptr);
    EXPECT_GT(std::string(api->last_error(nullptr)).size(), 10u);
  }
  EXPECT_NE(api->open(nullptr, 0, &none), TREPHINE_OK);
  EXPECT_EQ(none, nullptr);
}

TEST_F(PluginConformance, SaysWhatItsArmsCanDoWithinSense) {
  ASSERT_TRUE(open());
  for (std::uint32_t arm = 0; arm < behind->arms(); ++arm) {
    auto able = sized<TrephineCapabilities>();
    ASSERT_EQ(api->capabilities(handle, arm, &able), TREPHINE_OK) << api->last_error(handle);
    EXPECT_EQ(impossibleCapability(able), "");
    EXPECT_LE(able.continuous_force_N, able.peak_force_N);
    EXPECT_EQ(able.size, sizeof(able)) << "what the host wrote stays";
  }
  auto able = sized<TrephineCapabilities>();
  EXPECT_EQ(api->capabilities(handle, 1000, &able), TREPHINE_ERROR_ARGUMENT);
  able.size = 8;
  EXPECT_EQ(api->capabilities(handle, 0, &able), TREPHINE_ERROR_ARGUMENT);
}

TEST_F(PluginConformance, RefusesAConfigurationThatIsNoneAndKeepsRunningOnTheOneBefore) {
  ASSERT_TRUE(open());
  for (const char* wrong : {"", "{", "[1]", "{\"format\": 3}", "\xff\xfe"}) {
    EXPECT_EQ(api->configure(handle, wrong), TREPHINE_ERROR_ARGUMENT) << wrong;
    EXPECT_GT(std::string(api->last_error(handle)).size(), 10u) << wrong;
  }
  EXPECT_EQ(api->configure(handle, nullptr), TREPHINE_ERROR_ARGUMENT);
  ASSERT_TRUE(start());
  EXPECT_GT(ticks(0.1), 90);
}

TEST_F(PluginConformance, StartsAndStopsAHundredTimes) {
  ASSERT_TRUE(open());
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(start()) << i;
    ASSERT_TRUE(ticks(0.01) >= 8) << i << ": " << api->last_error(handle);
    ASSERT_EQ(api->stop(handle), TREPHINE_OK) << i;
    ASSERT_EQ(api->read(handle, kT, states.data()), TREPHINE_ERROR_STATE) << i;
    ASSERT_EQ(api->write(handle, commands.data()), TREPHINE_ERROR_STATE) << i;
  }
  EXPECT_EQ(api->stop(handle), TREPHINE_OK) << "what is stopped stays so";
}

TEST_F(PluginConformance, RefusesCallsOutOfTheirOrder) {
  ASSERT_TRUE(open());
  EXPECT_EQ(api->read(handle, kT, states.data()), TREPHINE_ERROR_STATE);
  ASSERT_TRUE(start());
  EXPECT_EQ(api->start(handle), TREPHINE_ERROR_STATE) << "it runs";
  EXPECT_GT(std::string(api->last_error(handle)).size(), 10u);
  EXPECT_EQ(api->configure(handle, behind->config().c_str()), TREPHINE_ERROR_STATE);
  EXPECT_GT(ticks(0.05), 40) << "and runs on";
  EXPECT_EQ(api->read(handle, kT, nullptr), TREPHINE_ERROR_ARGUMENT);
  EXPECT_EQ(api->write(handle, nullptr), TREPHINE_ERROR_ARGUMENT);
  EXPECT_EQ(api->read(nullptr, kT, states.data()), TREPHINE_ERROR_ARGUMENT);
  api->safe_stop(nullptr);
  api->close(nullptr);
}

TEST_F(PluginConformance, SamplesCountOnAndAreWhole) {
  ASSERT_TRUE(open());
  ASSERT_TRUE(start());
  ASSERT_TRUE(ticks(0.05) > 40);
  const std::vector<TrephineArmState> before = states;
  ticks(0.5);
  for (std::size_t arm = 0; arm < states.size(); ++arm) {
    const TrephineArmState& state = states[arm];
    EXPECT_NEAR(double(state.sequence - before[arm].sequence), 500.0, 50.0) << arm;
    EXPECT_GT(state.time_ns, before[arm].time_ns) << arm;
    EXPECT_TRUE(state.flags & TREPHINE_ARM_CALIBRATED);
    double norm = 0.0;
    for (int i = 0; i < 4; ++i) norm += state.orientation[i] * state.orientation[i];
    EXPECT_NEAR(norm, 1.0, 1e-6);
    for (double along : state.position_m) EXPECT_LT(std::abs(along), 10.0);
  }
}

TEST_F(PluginConformance, TheForceThatIsWrittenIsTheForceThatIsSent) {
  ASSERT_TRUE(open());
  auto able = sized<TrephineCapabilities>();
  ASSERT_EQ(api->capabilities(handle, 0, &able), TREPHINE_OK);
  ASSERT_TRUE(start());
  const double F = 0.5 * able.continuous_force_N;
  for (const Vec3& force_N :
       {Vec3(F, 0, 0), Vec3(0, -F, 0), Vec3(0, 0, F), F * Vec3(-0.5, 0.5, 0.5), Vec3(0.0)}) {
    push(force_N);
    ticks(0.6);
    expectForce(force_N, "as written");
  }
}

TEST_F(PluginConformance, AForceThatIsNoNumberIsNoneAndIsRefused) {
  ASSERT_TRUE(open());
  ASSERT_TRUE(start());
  for (double wrong : {std::nan(""), double(INFINITY), -double(INFINITY)}) {
    push({0.3, 0, 0});
    ticks(0.3);
    push({0.3, wrong, 0});
    await();
    api->read(handle, kT, states.data());
    EXPECT_EQ(api->write(handle, commands.data()), TREPHINE_ERROR_ARGUMENT);
    ticks(0.6);
    expectForce(Vec3(0.0), "no number");
  }
  push(Vec3(0.0));
  EXPECT_TRUE(tick() || tick()) << "and goes on";
}

TEST_F(PluginConformance, ASafeStopHoldsUntilItIsAnsweredWithZero) {
  ASSERT_TRUE(open());
  ASSERT_TRUE(start());
  push({0.4, 0, 0});
  ticks(0.6);
  std::thread([&] { api->safe_stop(handle); }).join();
  ticks(0.6);
  expectForce(Vec3(0.0), "written on after a safe stop");
  push(Vec3(0.0));
  ticks(0.1);
  push({0.4, 0, 0});
  ticks(0.6);
  expectForce({0.4, 0, 0}, "after the answer");
  std::thread([&] { api->safe_stop(handle); }).join();
  api->stop(handle);
  ASSERT_TRUE(start()) << "the next start is an answer too";
  ticks(0.6);
  expectForce({0.4, 0, 0}, "after the next start");
}

TEST_F(PluginConformance, ASafeStopComesFromAnyThreadInAnyState) {
  ASSERT_TRUE(behind->prepare(Trouble::none, 0.0));
  std::vector<std::uint32_t> places(1, 0);
  TrephineDevice* bare = nullptr;
  ASSERT_EQ(api->open(places.data(), 1, &bare), TREPHINE_OK);
  api->safe_stop(bare);  // not configured
  api->close(bare);
  ASSERT_TRUE(open());
  std::atomic<bool> done{false};
  std::atomic<int> stops{0};
  constexpr int kStoppers = 4;
  std::counting_semaphore<> asked(0);
  std::vector<std::thread> stoppers;
  for (int i = 0; i < kStoppers; ++i) {
    stoppers.emplace_back([&] {
      for (asked.acquire(); !done; asked.acquire()) {
        api->safe_stop(handle);
        ++stops;
      }
    });
  }
  // Each beside a call: of a start, of a stop, and of every other tick.
  const auto underStops = [&] {
    for (int i = 0; i < 100; ++i) {
      if (i % 2) asked.release();
      tick();
    }
  };
  for (int i = 0; i < 5; ++i) {
    asked.release();
    EXPECT_TRUE(start());
    push({0.4, 0, 0});
    underStops();
    push(Vec3(0.0));
    underStops();
    asked.release();
    api->stop(handle);
  }
  EXPECT_TRUE(waitUntil([&] { return stops >= 5 * (1 + 50 + 50 + 1); })) << stops;
  done = true;
  asked.release(kStoppers);
  for (std::thread& stopper : stoppers) stopper.join();
}

TEST_F(PluginConformance, TicksAllocateNothing) {
  ASSERT_TRUE(open());
  ASSERT_TRUE(start());
  push({0.1, 0, 0});
  const std::uint64_t before = rt::guardedAllocations();
  {
    rt::NoAllocation guard;
    for (int i = 0; i < 300; ++i) {
      if (api->wait) api->wait(handle, 5 * kT);
      api->read(handle, kT, states.data());
      api->write(handle, commands.data());
    }
  }
  EXPECT_EQ(rt::guardedAllocations(), before);
}

TEST_F(PluginConformance, StepsByTheSizesOfANewerHostsStructsAndRefusesLess) {
  struct WideState {
    TrephineArmState state;
    double appended[3];
  };
  struct WideCommand {
    TrephineArmCommand command;
    double appended[2];
  };
  ASSERT_TRUE(open());
  ASSERT_TRUE(start());
  std::vector<WideState> wide(behind->arms());
  std::vector<WideCommand> given(behind->arms());
  for (std::uint32_t arm = 0; arm < behind->arms(); ++arm) {
    wide[arm].state.size = sizeof(WideState);
    given[arm].command.size = sizeof(WideCommand);
    for (double& field : wide[arm].appended) field = 7.0;
  }
  int read = 0;
  for (int i = 0; i < 100; ++i) {
    await();
    read += api->read(handle, kT, &wide[0].state) == TREPHINE_OK;
    EXPECT_EQ(api->write(handle, &given[0].command), TREPHINE_OK) << api->last_error(handle);
  }
  EXPECT_GT(read, 90);
  for (const WideState& state : wide) {
    EXPECT_GT(state.state.sequence, 50u);
    for (double field : state.appended) EXPECT_EQ(field, 7.0);
  }
  wide[0].state.size = sizeof(TrephineArmState) - 8;
  EXPECT_EQ(api->read(handle, kT, &wide[0].state), TREPHINE_ERROR_ARGUMENT);
  given[0].command.size = sizeof(TrephineArmCommand) - 8;
  EXPECT_EQ(api->write(handle, &given[0].command), TREPHINE_ERROR_ARGUMENT);
}

// ---- In trouble: that the host sees it, and that no call waits for it.

TEST_F(PluginConformance, SilenceIsSeenInTheSamplesAndHoldsNoCallUp) {
  if (!open(Trouble::silence)) GTEST_SKIP() << behind->whyNot(Trouble::silence);
  ASSERT_TRUE(start());
  EXPECT_GT(ticks(0.04), 30);
  ticks(0.1);
  const std::uint64_t sequence = states[0].sequence;
  const auto from = steady_clock::now();
  bool lost = false;
  for (int i = 0; i < 20; ++i) lost = !tick() || lost;
  EXPECT_TRUE(lost || states[0].sequence == sequence);
  EXPECT_LT(secondsSince(from), 20 * 6 * kT + 0.1);
}

TEST_F(PluginConformance, AnUnpluggedDeviceIsLostAndComesBackWhenItIsPluggedIn) {
  if (!open(Trouble::unplugged)) GTEST_SKIP() << behind->whyNot(Trouble::unplugged);
  ASSERT_TRUE(start());
  EXPECT_GT(ticks(0.04), 30);
  for (int i = 0; i < 500 && tick(); ++i) {
  }
  ticks(kSoon_s);  // all of its arms
  for (int i = 0; i < 50; ++i) {
    ASSERT_FALSE(tick());
    for (const TrephineArmState& state : states) {
      ASSERT_TRUE(state.flags & TREPHINE_ARM_LOST);
      for (double along : state.position_m) ASSERT_TRUE(std::isfinite(along));
    }
  }
  EXPECT_GT(std::string(api->last_error(handle)).size(), 10u);
  close();
  ASSERT_TRUE(open()) << "plugged in again";
  ASSERT_TRUE(start());
  EXPECT_GT(ticks(0.1), 80);
}

TEST_F(PluginConformance, AFaultOfTheDeviceIsSaid) {
  if (!open(Trouble::error)) GTEST_SKIP() << behind->whyNot(Trouble::error);
  ASSERT_TRUE(start());
  bool said = false;
  for (int i = 0; i < 100 && !said; ++i) {
    said = !tick() || (states[0].flags & (TREPHINE_ARM_ERROR | TREPHINE_ARM_LOST));
  }
  EXPECT_TRUE(said);
}

TEST_F(PluginConformance, WhatIsNoNumberIsHandedOnAsSuchOrLostAndDoesNotEndTheProgram) {
  if (!open(Trouble::no_numbers)) GTEST_SKIP() << behind->whyNot(Trouble::no_numbers);
  ASSERT_TRUE(start());
  ticks(0.1);
  for (const TrephineArmState& state : states) {
    bool finite = true;
    for (double along : state.position_m) finite = finite && std::isfinite(along);
    EXPECT_TRUE(!finite || (state.flags & TREPHINE_ARM_LOST) ||
                std::abs(state.position_m[0]) < 10.0);
  }
}

TEST_F(PluginConformance, ACallThatBlocksLeavesSafeStopFreeAndTheArmWithoutForce) {
  if (!open(Trouble::blocking)) GTEST_SKIP() << behind->whyNot(Trouble::blocking);
  ASSERT_TRUE(start());
  push({0.4, 0, 0});
  std::atomic<bool> done{false};
  std::atomic<int> passed{0};
  std::thread loop([&] {
    while (!done) {
      tick();
      ++passed;
    }
  });
  // Until the ticks stand still, or have gone on in spite of it.
  const auto from = steady_clock::now();
  auto last_at = from;
  int last = -1;
  waitUntil([&] {
    if (passed != last) last_at = steady_clock::now();
    last = passed;
    return secondsSince(last_at) > 0.04 || secondsSince(from) > 1.0;
  });
  const auto stopping = steady_clock::now();
  api->safe_stop(handle);
  EXPECT_LT(secondsSince(stopping), kSoon_s) << "it waited for the blocked call";
  const int then = passed;
  EXPECT_TRUE(waitUntil([&] { return passed > then + 100; })) << "it goes on";
  done = true;
  loop.join();
  ticks(0.6);
  expectForce(Vec3(0.0), "after a safe stop in a blocked call");
}

}  // namespace
}  // namespace trephine::conformance
