// What the loop makes of what its devices say, before the core sees it: a hand that is not there, a
// pedal's buttons, a device that a script takes away.
#include <gtest/gtest.h>

#include "haptics/haptic_loop.h"
#include "haptics_support.h"
#include "unit/plain_api.h"

namespace trephine {
namespace {

// A real arm and a pedal, as the test sets them.
struct Devices {
  static inline TrephineArmState arm{}, pedal{};
  static inline int pedal_writes = 0;

  template <bool is_pedal>
  static const TrephineDeviceApi& api() {
    static const TrephineDeviceApi api = [] {
      TrephineDeviceApi a = test::plainApi(is_pedal ? "a-pedal" : "an-arm");
      if (is_pedal) {
        a.capabilities = [](TrephineDevice*, std::uint32_t, TrephineCapabilities* c) {
          c->rate_hz = 1000.0;
          return int(TREPHINE_OK);
        };
      }
      a.read = [](TrephineDevice*, double, TrephineArmState* states) {
        TrephineArmState& from = is_pedal ? pedal : arm;
        ++from.sequence;
        states->sequence = from.sequence;
        states->flags = from.flags;
        states->buttons = from.buttons;
        std::copy_n(from.position_m, 3, states->position_m);
        return int(TREPHINE_OK);
      };
      a.write = [](TrephineDevice*, const TrephineArmCommand*) {
        pedal_writes += is_pedal;
        return int(TREPHINE_OK);
      };
      return a;
    }();
    return api;
  }

  explicit Devices(bool with_pedal)
      : grid(test::boneSlab()), core(parameters(), *grid.takeWriter()) {
    arm = pedal = TrephineArmState{};
    pedal_writes = 0;
    std::vector<LoopDevice> devices;
    devices.push_back(
        {*Device::open(*DevicePlugin::builtIn(api<false>()), {0}, "{}"), {0}, false, true});
    if (with_pedal) {
      devices.push_back({*Device::open(*DevicePlugin::builtIn(api<true>()), {0}, "{}"), {}});
    }
    loop.emplace(core, std::move(devices), nullptr);
    EXPECT_TRUE(loop->startDevices());
    arm.position_m[2] = 0.005;
  }
  static HapticParameters parameters() { return test::oneArm(); }
  const ArmRecord& step(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) loop->step(0);
    loop->state().refresh();
    return loop->state().value().record.arms[0];
  }

  Grid grid;
  HapticCore core;
  std::optional<HapticLoop> loop;
};

TEST(LoopDevices, ARealArmIsInNobodysHandUntilItWasMovedOrAButtonWasPressed) {
  Devices devices(false);
  EXPECT_TRUE(devices.step(100).flags & TREPHINE_ARM_NO_HAND);
  Devices::arm.position_m[0] += 0.006;
  EXPECT_FALSE(devices.step().flags & TREPHINE_ARM_NO_HAND);
  Devices::arm.flags = TREPHINE_ARM_LOST;
  devices.step();
  Devices::arm.flags = 0;
  EXPECT_TRUE(devices.step().flags & TREPHINE_ARM_NO_HAND) << "it was away";
  Devices::arm.buttons = 1;
  EXPECT_FALSE(devices.step().flags & TREPHINE_ARM_NO_HAND);
  Devices::arm.flags = TREPHINE_ARM_NO_HAND;
  EXPECT_TRUE(devices.step().flags & TREPHINE_ARM_NO_HAND) << "it says so itself";
}

TEST(LoopDevices, APedalsButtonsStandBesideTheArmsOwnAndItIsNeverSentAForce) {
  Devices devices(true);
  Devices::arm.buttons = 0x103;  // more than an arm may have
  EXPECT_EQ(devices.step().buttons, 3u | kPedalThere);
  Devices::pedal.buttons = 0b110;
  EXPECT_EQ(devices.step().buttons, 3u | kPedalThere | kPedalMiddle | kPedalRight);
  Devices::pedal.flags = TREPHINE_ARM_LOST;
  EXPECT_EQ(devices.step().buttons, 3u | kPedalThere | kPedalLost) << "one that is gone is up";
  EXPECT_EQ(Devices::pedal_writes, 0);

  Devices without(false);
  EXPECT_EQ(without.step().buttons, 0u);
}

TEST(LoopDevices, OneGoesOnWithoutALostPedalWhenItIsAskedForAndWithItOnceItIsBack) {
  Devices devices(true);
  Devices::pedal.buttons = 0b010;
  Command go_on;
  go_on.kind = CommandKind::clear_faults;
  devices.loop->commands().push(go_on);
  EXPECT_EQ(devices.step().buttons, kPedalThere | kPedalMiddle) << "it is not lost";
  Devices::pedal.flags = TREPHINE_ARM_LOST;
  EXPECT_EQ(devices.step(5).buttons, kPedalThere | kPedalLost) << "nobody has asked since";
  devices.loop->commands().push(go_on);
  EXPECT_EQ(devices.step(5).buttons, 0u);
  Devices::pedal.flags = 0;
  EXPECT_EQ(devices.step().buttons, kPedalThere | kPedalMiddle);
  Devices::pedal.flags = TREPHINE_ARM_LOST;
  EXPECT_EQ(devices.step().buttons, kPedalThere | kPedalLost) << "lost again";
  // What is asked for an arm does not start motors.
  Devices::arm.flags = TREPHINE_ARM_LOST;
  EXPECT_TRUE(devices.step(5).faults & kFaultDeviceLost);
  Devices::arm.flags = 0;
  devices.loop->commands().push(go_on);
  EXPECT_EQ(devices.step(5).faults, 0u);
  EXPECT_EQ(devices.step().buttons, kPedalThere | kPedalLost);
  devices.loop->commands().push(go_on);
  EXPECT_EQ(devices.step(5).buttons, 0u) << "asked for once more";
}

TEST(LoopDevices, AScriptTakesADeviceAwayAndGivesItBack) {
  Devices devices(false);
  Devices::arm.buttons = 1;
  EXPECT_FALSE(devices.step(10).flags & TREPHINE_ARM_LOST);
  Command lost;
  lost.kind = CommandKind::device_lost;
  lost.arm = 0;
  devices.loop->commands().push(lost);
  EXPECT_TRUE(devices.step(1).flags & TREPHINE_ARM_LOST) << "in that tick";
  EXPECT_TRUE(devices.step(5).faults & kFaultDeviceLost);
  lost.kind = CommandKind::device_back;
  devices.loop->commands().push(lost);
  EXPECT_FALSE(devices.step(1).flags & TREPHINE_ARM_LOST);
  EXPECT_TRUE(devices.step(5).faults & kFaultDeviceLost) << "until it is asked for";
}

// A burr on bone, with the pedal up and down.
TEST(HapticCore, AMotorRunsWhileThePedalIsDownAndAlwaysWithoutOne) {
  const auto removed = [](std::uint32_t buttons) {
    HapticParameters p = test::oneArm();
    p.arms[0].tool = *makeTool({ToolKind::burr, 30.0, 64, 3.0, 8, BurrShape::sphere, 0.0, 6.0});
    p.removal = RemovalKind::work;
    test::Bench bench(p);
    int voxels = 0;
    for (int i = 0; i < 2000; ++i) {
      TickInput input;
      input.tick = bench.tick++;
      input.journal = bench.core.journalState();
      input.arms[0].position_m = Vec3(0, 0, 0.005 - 6e-6 * std::min(i, 1500));
      input.arms[0].buttons = buttons;
      bench.core.tick(input, nullptr, 0, bench.record);
      voxels += bench.record.arms[0].removed_voxels;
    }
    EXPECT_EQ(bool(bench.record.arms[0].tool_state & kToolOff),
              (buttons & kPedalThere) && !(buttons & kPedalMiddle));
    return voxels;
  };
  const int always = removed(0);
  EXPECT_GT(always, 10);
  EXPECT_EQ(removed(kPedalThere), 0);
  EXPECT_EQ(removed(kPedalThere | kPedalRight), 0);
  EXPECT_EQ(removed(kPedalThere | kPedalMiddle), always);
}

}  // namespace
}  // namespace trephine
