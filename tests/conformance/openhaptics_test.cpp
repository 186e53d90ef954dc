// What is OpenHaptics' own: its library that is missing or of another version, calibration, names,
// and each error of an arm while it cuts.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <thread>

#include "../support.h"
#include "device/codes.h"
#include "device/device.h"
#include "haptics/haptic_loop.h"
#include "haptics_support.h"
#include "hd_test.h"

namespace trephine {
namespace {

using test::HdTest;
using test::waitUntil;

std::shared_ptr<const DevicePlugin> plugin() {
  auto loaded = DevicePlugin::load("openhaptics", TREPHINE_TEST_PLUGIN_DIR);
  if (!loaded) ADD_FAILURE() << loaded.error().sentence();
  return loaded ? *loaded : nullptr;
}

std::string config(const std::string& names) {
  return R"({"format": "trephine.device", "version": 1, "model": "arms", "names": )" + names + "}";
}
const std::string kBoth = R"(["Left Device", "Right Device"])";

// ---- Run with another libHD.so, or none, in the loader's path.

TEST(OpenHapticsMissing, ItSaysWhatToInstallAndThatThereAreNoArms) {
  const auto without = plugin();
  ASSERT_TRUE(without);
  EXPECT_EQ(without->enumerate().size(), 0u);
  const auto device = Device::open(without, {0}, config(kBoth));
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().code.str(), "NO_DEVICE");
  EXPECT_NE(device.error().what.find("install OpenHaptics"), std::string::npos);
}

TEST(OpenHapticsLacking, ItNamesTheFunctionThatALibraryOfAnotherVersionLacks) {
  const auto lacking = plugin();
  ASSERT_TRUE(lacking);
  const auto device = Device::open(lacking, {0}, config(kBoth));
  ASSERT_FALSE(device);
  EXPECT_NE(device.error().what.find("'hdScheduleAsynchronous'"), std::string::npos)
      << device.error().what;
}

// ---- With the tests' own libHD.so.

class OpenHaptics : public ::testing::Test {
 protected:
  void SetUp() override {
    void* library = ::dlopen("libHD.so", RTLD_NOW | RTLD_LOCAL);
    auto entry = library ? reinterpret_cast<test::HdTestEntry>(::dlsym(library, test::kHdTestEntry))
                         : nullptr;
    ASSERT_TRUE(entry) << "the libHD.so that was found is not the tests' own";
    hd = entry();
    hd->reset();
    openhaptics = plugin();
    ASSERT_TRUE(openhaptics);
  }
  HdTest* hd = nullptr;
  std::shared_ptr<const DevicePlugin> openhaptics;
};

TEST_F(OpenHaptics, AnArmOfAnUnknownNameOrOneThatIsNotThereIsNamed) {
  const auto unknown = Device::open(openhaptics, {0, 1}, config(R"(["Left Device", "Nobody"])"));
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().what.find("'Nobody'"), std::string::npos) << unknown.error().what;
  const auto few = Device::open(openhaptics, {0, 1}, config(R"(["Left Device"])"));
  ASSERT_FALSE(few);
  EXPECT_NE(few.error().what.find("names of 2 arms"), std::string::npos) << few.error().what;
  hd->arms[1].there = false;
  const auto gone = Device::open(openhaptics, {0, 1}, config(kBoth));
  ASSERT_FALSE(gone);
  EXPECT_NE(gone.error().what.find("'Right Device' does not answer"), std::string::npos)
      << gone.error().what;
  EXPECT_NE(gone.error().what.find("communication error"), std::string::npos);
}

TEST_F(OpenHaptics, AnArmThatCanCalibrateItselfIsAndOneThatCannotIsSaid) {
  hd->arms[0].calibration = 0x5001;
  hd->arms[1].calibration = 0x5002;
  auto device = Device::open(openhaptics, {0, 1}, config(kBoth));
  ASSERT_TRUE(device) << device.error().sentence();
  const Status started = (*device)->start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, code::kNotCalibrated);
  EXPECT_NE(started.error().what.find("'Right Device' is not calibrated"), std::string::npos)
      << started.error().what;
  EXPECT_EQ(hd->arms[0].calibration, 0x5000u);
  hd->arms[1].calibration = 0x5000;
  EXPECT_TRUE((*device)->start().ok());
  (*device)->stop();
  EXPECT_EQ(hd->misuses, 0);
}

TEST_F(OpenHaptics, ThePoseIsInMetresFromTheMiddleOfTheWorkspaceAndTurnedAsTheStylus) {
  auto device = Device::open(openhaptics, {0}, config(kBoth));
  ASSERT_TRUE(device && (*device)->start().ok());
  EXPECT_TRUE((*device)->hasClock());
  const TrephineCapabilities& able = (*device)->capabilities(0);
  EXPECT_EQ(able.peak_force_N, 3.3);
  EXPECT_EQ(able.continuous_force_N, 0.88);
  EXPECT_EQ(able.input_dof, 6u);
  EXPECT_NEAR(able.workspace_m[0], 0.16, 1e-12);
  TrephineArmState state{};
  ASSERT_TRUE((*device)->read(1e-3, &state));
  EXPECT_NEAR(state.position_m[0], 0.005, 1e-12);
  EXPECT_NEAR(state.position_m[1], 0.010, 1e-12);
  EXPECT_NEAR(state.position_m[2], -0.003, 1e-12);
  EXPECT_NEAR(state.orientation[0], std::cos(0.15), 1e-9);
  EXPECT_NEAR(state.orientation[1], 0.0, 1e-9);
  EXPECT_NEAR(state.orientation[2], std::sin(0.15), 1e-9);
}

TEST_F(OpenHaptics, AStylusInItsHolderIsInNobodysHand) {
  auto device = Device::open(openhaptics, {0, 1}, config(kBoth));
  ASSERT_TRUE(device && (*device)->start().ok());
  const auto flags = [&](std::size_t arm) {
    const std::uint64_t next = hd->frames + 3;  // a whole one since then
    EXPECT_TRUE(waitUntil([&] { return hd->frames >= next; }));
    TrephineArmState states[2]{};
    (*device)->read(1e-3, states);
    return states[arm].flags;
  };
  EXPECT_FALSE(flags(1) & TREPHINE_ARM_NO_HAND);
  hd->arms[1].in_holder = true;
  EXPECT_TRUE(flags(1) & TREPHINE_ARM_NO_HAND);
  EXPECT_FALSE(flags(0) & TREPHINE_ARM_NO_HAND);
  hd->arms[1].in_holder = false;
  EXPECT_FALSE(flags(1) & TREPHINE_ARM_NO_HAND);
}

TEST_F(OpenHaptics, AnEncoderResetIsNeverDoneByItself) {
  hd->styles = 0b001;
  hd->arms[0].calibration = 0x5001;
  auto device = Device::open(openhaptics, {0}, config(kBoth));
  ASSERT_TRUE(device) << device.error().sentence();
  EXPECT_FALSE((*device)->start().ok());
  EXPECT_EQ(hd->style_used, 0);
  hd->styles = 0b101;
  EXPECT_TRUE((*device)->start().ok());
  EXPECT_EQ(hd->style_used, 0b100) << "the inkwell alone";
}

// Which arm is which, and that nothing is left when it stops.
TEST_F(OpenHaptics, AnArmIsThePlaceThatIsAskedForAndStoppedWithoutForce) {
  const auto push = [&](std::vector<std::uint32_t> places) {
    auto device = Device::open(openhaptics, places, config(kBoth));
    ASSERT_TRUE(device && (*device)->start().ok());
    std::vector<TrephineArmState> states(places.size());
    std::vector<TrephineArmCommand> commands(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) commands[i].force_N[0] = 0.1 + 0.1 * double(i);
    for (int i = 0; i < 50; ++i) {
      (*device)->wait(0.005);
      (*device)->read(1e-3, states.data());
      (*device)->write(commands.data());
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double wanted_N = 0.1 + 0.1 * double(i);
      EXPECT_TRUE(waitUntil([&] { return hd->arms[places[i]].force_N[0] == wanted_N; }))
          << places[i];
    }
    (*device)->stop();
    for (const test::HdArm& arm : hd->arms) EXPECT_EQ(arm.force_N[0], 0.0);
  };
  push({1});
  push({1, 0});
  push({0});
  EXPECT_EQ(hd->misuses, 0);
}

TEST_F(OpenHaptics, ItsArmsAreInUseOnce) {
  auto first = Device::open(openhaptics, {0}, config(kBoth));
  ASSERT_TRUE(first);
  const auto second = Device::open(openhaptics, {1}, config(kBoth));
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().what.find("in use already"), std::string::npos);
}

// Both arms swing through bone, on the maker's scheduler as the clock.
class OpenHapticsCutting : public OpenHaptics {
 protected:
  void SetUp() override {
    OpenHaptics::SetUp();
    hd->swing_mm = 3.0;
    HapticParameters parameters = test::oneArm();
    parameters.tissues.classes[0].cuttable = 0;
    parameters.arms.push_back(parameters.arms[0]);
    grid = std::make_unique<Grid>(test::boneSlab());
    core = std::make_unique<HapticCore>(parameters, *grid->takeWriter());
    auto device = Device::open(openhaptics, {0, 1}, config(kBoth));
    ASSERT_TRUE(device) << device.error().sentence();
    std::vector<LoopDevice> devices;
    devices.push_back({*std::move(device), {0, 1}, true});
    loop = std::make_unique<HapticLoop>(*core, std::move(devices), nullptr);
    ASSERT_TRUE(loop->startDevices().ok());
    ticking = std::thread([this] {
      HostClock clock;
      loop->run(clock, stop);
      loop->stopDevices();
    });
    pass_s(0.5);  // what it looks back on is of this test
    ASSERT_TRUE(hasForce(0) && hasForce(1));
  }
  void TearDown() override {
    stop = true;
    if (ticking.joinable()) ticking.join();
  }
  void pass_s(double seconds) {
    const std::uint64_t until = hd->frames + std::uint64_t(1000.0 * seconds);
    EXPECT_TRUE(waitUntil([&] {
      read();  // a full ring keeps the oldest
      return hd->frames >= until;
    }));
  }
  void read() {
    TickRecord record;
    while (loop->records().pop(record)) last = record;
  }
  // Of the frames that have just passed.
  double mostForce_N(std::size_t arm, double seconds) const {
    double most = 0.0;
    const std::uint64_t now = hd->frames;
    for (std::uint64_t i = 1; i <= std::uint64_t(1000.0 * seconds); ++i) {
      most = std::max(most, hd->arms[arm].sent_N[(now - i) % test::HdArm::kFrames].load());
    }
    return most;
  }
  void report(std::size_t arm, std::uint32_t error, std::uint32_t frames) {
    hd->arms[arm].error = error;
    hd->arms[arm].errors = frames;
  }
  std::uint32_t faults(std::size_t arm) {
    read();
    return last.arms[arm].faults & ~(kFaultLate | kFaultStalled);  // those are the computer's
  }
  // At once, or after a stall of the computer.
  bool hasForce(std::size_t arm) {
    for (int i = 0; i < 20 && mostForce_N(arm, 0.4) <= 0.1; ++i) pass_s(0.2);
    return mostForce_N(arm, 0.4) > 0.1;
  }

  std::unique_ptr<Grid> grid;
  std::unique_ptr<HapticCore> core;
  std::unique_ptr<HapticLoop> loop;
  std::atomic<bool> stop{false};
  std::thread ticking;
  TickRecord last;
};

TEST_F(OpenHapticsCutting, AnErrorThatPassesIsNoForceInItsFrameAndComesBackAfterASecond) {
  // In turns: no arm has a third within ten seconds.
  for (std::uint32_t error : {0x0201u, 0x0202u, 0x0204u}) {
    const std::size_t arm = error == 0x0202u ? 1 : 0, other = 1 - arm;
    report(arm, error, 1);
    pass_s(0.5);
    EXPECT_EQ(faults(arm), std::uint32_t(kFaultDevice));
    EXPECT_EQ(faults(other), 0u) << "the other arm goes on";
    EXPECT_TRUE(hasForce(other));
    pass_s(0.4);
    const std::uint64_t at = hd->arms[arm].error_frame;
    for (std::uint64_t i = 1; i < 800; ++i) {
      ASSERT_EQ(hd->arms[arm].sent_N[(at + i) % test::HdArm::kFrames], 0.0)
          << std::hex << error << " +" << std::dec << i;
    }
    pass_s(1.2);
    EXPECT_EQ(faults(arm), 0u);
    EXPECT_TRUE(hasForce(arm));
  }
}

TEST_F(OpenHapticsCutting, TheThirdWithinTenSecondsStays) {
  for (int i = 0; i < 3; ++i) {
    report(1, 0x0203, 1);
    pass_s(1.4);
  }
  EXPECT_TRUE(faults(1) & kFaultDeviceOften);
  pass_s(1.5);
  EXPECT_EQ(mostForce_N(1, 1.0), 0.0);
  EXPECT_EQ(faults(0), 0u);
  Command ask;
  ask.kind = CommandKind::clear_faults;
  loop->commands().push(ask);
  pass_s(1.5);
  EXPECT_EQ(faults(1), 0u);
  EXPECT_TRUE(hasForce(1));
}

TEST_F(OpenHapticsCutting, WarmMotorsAreSentHalfAndAllOfItWhenTheyHaveCooled) {
  report(0, 0x0200, 2600);
  pass_s(2.5);
  EXPECT_TRUE(last.arms[0].tool_state & kToolArmWarm);
  EXPECT_FALSE(last.arms[1].tool_state & kToolArmWarm);
  EXPECT_EQ(faults(0), 0u);
  pass_s(2.8);
  EXPECT_FALSE(last.arms[0].tool_state & kToolArmWarm);
}

TEST_F(OpenHapticsCutting, AFaultOfTheDeviceIsALostArmAndTheOtherGoesOn) {
  for (std::uint32_t error : {0x0300u, 0x0302u, 0x0304u}) {
    report(0, error, 1);
    pass_s(0.1);
    EXPECT_TRUE(faults(0) & kFaultDeviceLost) << std::hex << error;
    pass_s(1.0);
    EXPECT_EQ(mostForce_N(0, 1.0), 0.0);
    EXPECT_EQ(faults(1), 0u);
    EXPECT_TRUE(hasForce(1));
  }
  EXPECT_EQ(hd->misuses, 0);
}

}  // namespace
}  // namespace trephine
