// An opened device: starting, stopping, failing, and what a tick may not do.
#include <unistd.h>

#include <cmath>
#include <limits>
#include <thread>

#include "base/rt/alloc_guard.h"
#include "device_support.h"
#include "support.h"

namespace trephine {
namespace {

using test::Bench;
using test::exactOmni;
using test::kTick_s;
using test::omni;

TEST(Device, AnExchangeBeforeStartOrAfterStopIsLost) {
  Bench bench(omni());
  ASSERT_TRUE(bench.device);
  EXPECT_FALSE(bench.tick());
  EXPECT_TRUE(bench.states[0].flags & TREPHINE_ARM_LOST);
  EXPECT_EQ(bench.states[0].orientation[0], 1.0);
  ASSERT_TRUE(bench.start());
  EXPECT_TRUE(bench.tick());
  EXPECT_FALSE(bench.states[0].flags & TREPHINE_ARM_LOST);
  bench.device->stop();
  EXPECT_FALSE(bench.tick());
  EXPECT_TRUE(bench.states[0].flags & TREPHINE_ARM_LOST);
}

TEST(Device, StartingTwiceIsRefusedInAPlainSentence) {
  Bench bench(omni());
  ASSERT_TRUE(bench.device && bench.start());
  const Status again = bench.device->start();
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code.str(), "DEVICE_NOT_STARTED");
  EXPECT_EQ(again.error().what, "The arms are already running");
  bench.device->stop();
  EXPECT_TRUE(bench.device->start());
}

TEST(Device, StartsWhereTheHandHoldsIt) {
  Bench bench(exactOmni());
  ASSERT_TRUE(bench.device);
  bench.hold({0.03, 0.9, -0.01}, 300.0, 2.0);
  ASSERT_TRUE(bench.start());
  ASSERT_TRUE(bench.tick());
  EXPECT_EQ(bench.position(), Vec3(0.03, 0.060, -0.01));  // y at the workspace's edge
}

TEST(Device, TakesTargetsOnlyWhereArmsAreSimulated) {
  Bench bench(omni());
  ASSERT_TRUE(bench.device);
  EXPECT_TRUE(bench.device->takesTargets());
  auto plugin = DevicePlugin::load("greedy", TREPHINE_TEST_ODD_PLUGIN_DIR);
  ASSERT_TRUE(plugin) << plugin.error().sentence();
  auto real = Device::open(*plugin, {0}, "");
  ASSERT_TRUE(real) << real.error().sentence();
  EXPECT_FALSE((*real)->takesTargets());
  (*real)->setTarget(0, Pose{}, 1.0, 1.0);  // and asking all the same does nothing
}

TEST(Device, CapabilitiesThatNoArmHasAreRefused) {
  auto plugin = DevicePlugin::load("impossible", TREPHINE_TEST_ODD_PLUGIN_DIR);
  ASSERT_TRUE(plugin) << plugin.error().sentence();
  auto device = Device::open(*plugin, {0}, "");
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().code.str(), "BAD_PLUGIN");
  EXPECT_NE(device.error().what.find("peak_force_N"), std::string::npos);
}

TEST(Device, ADeviceThatGoesAwayIsLostAtItsLastPose) {
  Json json = omni();
  json["vanish_after_s"] = 0.05;
  Bench bench(json, 2);
  ASSERT_TRUE(bench.device && bench.start());
  bench.hold({0.02, 0.0, 0.0}, 300.0, 2.0);
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(bench.tick()) << i;
  const Vec3 last = bench.position();
  ASSERT_GT(last.x, 0.01);
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(bench.tick());
    for (std::size_t arm = 0; arm < 2; ++arm) {
      EXPECT_TRUE(bench.states[arm].flags & TREPHINE_ARM_LOST);
      EXPECT_EQ(bench.states[arm].sequence, 50u);
      EXPECT_EQ(bench.states[arm].time_ns, 50'000'000);
    }
    EXPECT_EQ(bench.position(), last);
  }
  bench.device->stop();
  EXPECT_FALSE(bench.device->start());
}

TEST(Device, ANonFiniteForceFailsTheExchangeAndPushesNobody) {
  for (double wrong : {std::nan(""), double(INFINITY), -double(INFINITY)}) {
    Bench bench(exactOmni());
    ASSERT_TRUE(bench.device && bench.start());
    bench.push({1.0, wrong, 0.0});
    for (int i = 0; i < 10; ++i) {
      EXPECT_FALSE(bench.tick());
      EXPECT_TRUE(bench.states[0].flags & TREPHINE_ARM_LOST);
    }
    bench.push(Vec3(0.0));
    ASSERT_TRUE(bench.tick());
    EXPECT_EQ(bench.position(), Vec3(0.0));
  }
}

TEST(Device, AnImpossibleTimeStepIsRefusedAndPassesNoTime) {
  Bench bench(omni());
  ASSERT_TRUE(bench.device && bench.start());
  for (double dt : {0.0, -0.001, 0.2, std::nan(""), double(INFINITY)}) EXPECT_FALSE(bench.tick(dt));
  ASSERT_TRUE(bench.tick());
  EXPECT_EQ(bench.states[0].time_ns, 1'000'000);
  EXPECT_EQ(bench.states[0].sequence, 1u);
}

TEST(Device, ASafeStopFromAnotherThreadSilencesTheArmUntilTheNextStart) {
  Bench bench(exactOmni());
  ASSERT_TRUE(bench.device && bench.start());
  bench.push({1.0, 0.0, 0.0});
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(bench.tick());
  ASSERT_GT(bench.position().x, 0.001);
  std::thread([&] { bench.device->safeStop(); }).join();
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_NEAR(bench.position().x, 0.0, 1e-9);
  bench.device->stop();
  ASSERT_TRUE(bench.start());
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_GT(bench.position().x, 0.001);
}

TEST(Device, AnExchangeOfZeroForceAnswersASafeStopAndLaterForcesMoveTheArmAgain) {
  Bench bench(exactOmni());
  ASSERT_TRUE(bench.device && bench.start());
  bench.push({1.0, 0.0, 0.0});
  bench.device->safeStop();
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_NEAR(bench.position().x, 0.0, 1e-9);
  bench.push({0.0, 0.0, 0.0});
  ASSERT_TRUE(bench.tick());
  bench.push({1.0, 0.0, 0.0});
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_GT(bench.position().x, 0.001);
}

TEST(Device, WhatWasCommandedBeforeASafeStopIsNoAnswerToIt) {
  Json json = exactOmni();
  json.update({{"block_after_s", 0.01}, {"block_for_s", 0.3}});
  Bench bench(json);
  ASSERT_TRUE(bench.device && bench.start());
  bench.push({0.0, 0.0, 0.0});
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(bench.tick());
  std::thread stopper([&, ticking = ::gettid()] {
    EXPECT_TRUE(test::waitUntil([&] { return test::isWaiting(ticking); }));
    bench.device->safeStop();
  });
  ASSERT_TRUE(bench.tick());  // commands zero, and blocks
  stopper.join();
  bench.push({1.0, 0.0, 0.0});
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_NEAR(bench.position().x, 0.0, 1e-9);
}

TEST(Device, CommandsNeedNoSizeFromTheCaller) {
  Bench bench(exactOmni());
  ASSERT_TRUE(bench.device && bench.start());
  bench.commands[0] = TrephineArmCommand{};
  EXPECT_TRUE(bench.tick());
  EXPECT_EQ(bench.states[0].size, sizeof(TrephineArmState));
}

TEST(Device, ArmsStepByTheSizeOfTheHostsStructs) {
  // A later host may append fields: its arrays then have wider elements.
  struct WideState {
    TrephineArmState state;
    double appended[3];
  };
  struct WideCommand {
    TrephineArmCommand command;
    double appended[2];
  };
  auto plugin = test::simulatedPlugin();
  ASSERT_TRUE(plugin);
  const TrephineDeviceApi& api = plugin->api();
  const std::uint32_t arms[] = {0, 1};
  TrephineDevice* handle = nullptr;
  ASSERT_EQ(api.open(arms, 2, &handle), TREPHINE_OK);
  ASSERT_EQ(api.configure(handle, exactOmni().dump().c_str()), TREPHINE_OK);
  ASSERT_EQ(api.start(handle), TREPHINE_OK);
  WideState states[2] = {};
  WideCommand commands[2] = {};
  for (int i = 0; i < 2; ++i) {
    states[i].state.size = sizeof(WideState);
    for (double& field : states[i].appended) field = 7.0;
    commands[i].command.size = sizeof(WideCommand);
  }
  commands[1].command.force_N[0] = 1.0;
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(api.write(handle, &commands[0].command), TREPHINE_OK);
    ASSERT_EQ(api.read(handle, kTick_s, &states[0].state), TREPHINE_OK);
  }
  EXPECT_EQ(states[0].state.position_m[0], 0.0);
  EXPECT_GT(states[1].state.position_m[0], 0.001);
  EXPECT_LT(states[1].state.position_m[0], 0.010);
  for (const WideState& state : states) {
    EXPECT_EQ(state.state.sequence, 100u);
    for (double field : state.appended) EXPECT_EQ(field, 7.0);
  }
  states[0].state.size = sizeof(TrephineArmState) - 8;
  EXPECT_EQ(api.read(handle, kTick_s, &states[0].state), TREPHINE_ERROR_ARGUMENT);
  commands[0].command.size = sizeof(TrephineArmCommand) - 8;
  EXPECT_EQ(api.write(handle, &commands[0].command), TREPHINE_ERROR_ARGUMENT);
  api.close(handle);
}

TEST(Device, ReadingAndWritingAllocateNothing) {
  Json json = omni();
  json["vanish_after_s"] = 0.9;
  Bench bench(json, 2);
  ASSERT_TRUE(bench.device && bench.start());
  const std::uint64_t before = rt::guardedAllocations();
  int good = 0;
  {
    rt::NoAllocation guard;
    for (int i = 0; i < 1000; ++i) {
      bench.hold({0.01 * (i % 10), 0.0, 0.0}, 300.0, 2.0, i % 2);
      bench.hold({0.0, 0.0, 0.0}, -300.0, 2.0);
      bench.push({i % 7 == 0 ? std::nan("") : 5.0, 0.0, 0.0});
      good += bench.tick() ? 1 : 0;
    }
  }
  EXPECT_EQ(rt::guardedAllocations(), before);
  EXPECT_GT(good, 700);  // and the refused and lost ones allocated nothing either
  EXPECT_LT(good, 900);
}

TEST(Device, TheAllocationGuardSeesIntoAPlugin) {
  auto plugin = DevicePlugin::load("greedy", TREPHINE_TEST_ODD_PLUGIN_DIR);
  ASSERT_TRUE(plugin) << plugin.error().sentence();
  auto device = Device::open(*plugin, {0}, "");
  ASSERT_TRUE(device) << device.error().sentence();
  ASSERT_TRUE((*device)->start());
  TrephineArmState state{};
  TrephineArmCommand command{};
  const std::uint64_t before = rt::guardedAllocations();
  {
    rt::NoAllocation guard;
    (*device)->write(&command);
    (*device)->read(kTick_s, &state);
  }
  EXPECT_GE(rt::guardedAllocations(), before + 2);
}

}  // namespace
}  // namespace trephine
