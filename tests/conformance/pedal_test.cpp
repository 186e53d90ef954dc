// What is the pedal plugin's own: switches, how a cap moves its hand, and what does harm to
// neither.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <thread>
#include <vector>

#include "device/device.h"
#include "pedal/reports.h"
#include "pedal_hid.h"

namespace trephine {
namespace {

using std::chrono::steady_clock;
using test::CapAxes;
using test::CapFirmware;

constexpr double kT_s = 1e-3;
constexpr double kStep_m = 55e-6;  // of the virtual arm's encoders
constexpr double kHand_N_per_m = 600.0, kPeak_N = 3.3;
const Vec3 kHalfWorkspace_m(0.08, 0.06, 0.035);
constexpr double kSpeed_m_s = 0.1, kTurn_rad_s = 1.5, kDeadZone = 0.05;  // without configuration

std::string config(const std::string& more = "") {
  return R"({"format": "trephine.device", "version": 1, "model": "emulated")" + more + "}";
}

// ---- Reports alone.

pedal::ReportSizes sizesOf(bool wireless) {
  return pedal::reportSizes(test::spaceMouse(wireless).report_descriptor);
}

TEST(PedalReports, ADescriptorTellsHowLongEachReportIs) {
  const pedal::ReportSizes wired = sizesOf(false), wireless = sizesOf(true);
  EXPECT_EQ(wired[1], 7u);
  EXPECT_EQ(wired[2], 7u);
  EXPECT_EQ(wired[3], 3u);
  EXPECT_EQ(wired[4], 0u) << "its light is no report in";
  EXPECT_EQ(wireless[1], 13u);
  EXPECT_EQ(wireless[2], 0u);
  EXPECT_EQ(wireless[0x17], 2u);
  EXPECT_TRUE(pedal::CapReader(wired).hasSixAxes());
  EXPECT_TRUE(pedal::CapReader(wireless).hasSixAxes());
  EXPECT_FALSE(pedal::CapReader(pedal::reportSizes({})).hasSixAxes());
  // One that ends anywhere, or declares the impossible, is read without harm.
  const auto whole = test::spaceMouse(true).report_descriptor;
  for (std::size_t end = 0; end < whole.size(); ++end) {
    pedal::reportSizes({whole.begin(), whole.begin() + std::ptrdiff_t(end)});
  }
  const auto huge =
      pedal::reportSizes({0x85, 1, 0x77, 255, 255, 255, 255, 0x97, 255, 255, 255, 255, 0x81, 2});
  EXPECT_EQ(huge[1], 0u);
}

TEST(PedalReports, AreFoundInABunchBehindGarbageAndBehindOneThatWasCut) {
  const std::vector<std::uint8_t> bunch{1, 1, 0, 2,    0,    3, 0,  // pushed (1, 2, 3)
                                        2, 3, 0, 0xFE, 0xFF, 1, 0,  // turned (3, -2, 1)
                                        3, 2, 0};                   // the second button
  const auto expectAll = [](const pedal::CapReader& reader, std::size_t before) {
    EXPECT_EQ(reader.cap().push, (std::array<std::int16_t, 3>{1, 2, 3})) << before;
    EXPECT_EQ(reader.cap().turn, (std::array<std::int16_t, 3>{3, -2, 1})) << before;
    EXPECT_EQ(reader.cap().buttons, 2u) << before;
  };
  for (std::size_t cut = 0; cut <= bunch.size(); ++cut) {
    pedal::CapReader reader(sizesOf(false));
    reader.take(bunch.data(), cut);
    EXPECT_TRUE(reader.take(bunch.data(), bunch.size()));
    expectAll(reader, cut);
  }
  std::vector<std::uint8_t> behind{0xEE, 0xEE, 1, 0xEE, 0xEE};
  behind.insert(behind.end(), bunch.begin(), bunch.end());
  pedal::CapReader reader(sizesOf(false));
  EXPECT_TRUE(reader.take(behind.data(), behind.size()));
  expectAll(reader, 5);
}

TEST(PedalReports, OneThatIsCutOrSaysWhatNoCapCanIsLeftOut) {
  pedal::CapReader reader(sizesOf(false));
  const std::vector<std::uint8_t> push{1, 40, 0, 0, 0, 0, 0}, wild{1, 0xFF, 0x7F, 0, 0, 0, 0};
  EXPECT_TRUE(reader.take(push.data(), push.size()));
  for (std::size_t bytes = 0; bytes < push.size(); ++bytes) {
    EXPECT_FALSE(reader.take(push.data(), bytes)) << bytes;
  }
  EXPECT_FALSE(reader.take(wild.data(), wild.size()));
  EXPECT_EQ(reader.cap().push, (std::array<std::int16_t, 3>{40, 0, 0}));
}

TEST(PedalReports, SwitchesAreThoseOfTheLastWholeReport) {
  const auto switches = [](std::vector<std::uint8_t> bytes) {
    return pedal::switchesOf(bytes.data(), bytes.size());
  };
  EXPECT_EQ(switches({5, 0}), 5u);
  EXPECT_EQ(switches({1, 0, 0, 0, 4, 0}), 4u);
  EXPECT_FALSE(switches({}));
  EXPECT_FALSE(switches({1}));
  EXPECT_FALSE(switches({1, 0, 2}));
  EXPECT_FALSE(switches({8, 0}));
  EXPECT_FALSE(switches({1, 1}));
}

// ---- The plugin, with devices on USB ports.

class Pedal : public ::testing::Test {
 protected:
  void SetUp() override {
    auto loaded = DevicePlugin::load("pedal", TREPHINE_TEST_PLUGIN_DIR);
    ASSERT_TRUE(loaded) << loaded.error().sentence();
    plugin = *loaded;
    test::inRealTime(50);  // as the haptic thread
  }
  void TearDown() override {
    test::inRealTime(0);
    device.reset();
    caps.clear();
  }
  int plugIn(const test::HidDescription& of, const std::string& port, int interface_number = 0) {
    const int fd = bed.plugIn(of, port, interface_number);
    EXPECT_GE(fd, 0) << "it cannot be emulated: " << bed.why();
    return fd;
  }
  CapFirmware& plugInCap(const std::string& port, bool wireless = false, int interface_number = 0) {
    fds.push_back(plugIn(test::spaceMouse(wireless), port, interface_number));
    caps.push_back(std::make_unique<CapFirmware>(fds.back(), wireless));
    return *caps.back();
  }
  void start(const std::vector<std::uint32_t>& places, const std::string& text = config()) {
    auto opened = Device::open(plugin, places, text);
    ASSERT_TRUE(opened) << opened.error().sentence();
    device = *std::move(opened);
    ASSERT_TRUE(device->start().ok());
    states.assign(places.size(), {});
    commands.assign(places.size(), {});
    ticks.begin();
  }
  void tick() {
    ticks.await();
    EXPECT_TRUE(device->read(kT_s, states.data()));
    device->write(commands.data());
  }
  void pass_s(double seconds) {
    for (int i = 0; i < int(std::lround(seconds / kT_s)); ++i) tick();
  }
  Vec3 at(std::size_t arm = 0) const {
    const double* p = states[arm].position_m;
    return {p[0], p[1], p[2]};
  }
  Quat turned(std::size_t arm = 0) const {
    const double* q = states[arm].orientation;
    return Quat(q[0], q[1], q[2], q[3]);
  }
  bool lost(std::size_t arm = 0) const { return states[arm].flags & TREPHINE_ARM_LOST; }
  void push(const Vec3& force_N) {
    for (int axis = 0; axis < 3; ++axis) commands[0].force_N[axis] = force_N[axis];
  }
  // Until the switches are so, or 0.2 s have passed.
  double secondsUntil(std::uint32_t buttons) {
    const auto from = steady_clock::now();
    for (int i = 0; i < 200; ++i) {
      tick();
      if (states[0].buttons == buttons) break;
    }
    return std::chrono::duration<double>(steady_clock::now() - from).count();
  }
  static void send(int fd, const std::vector<std::uint8_t>& bytes) {
    ASSERT_EQ(::write(fd, bytes.data(), bytes.size()), ssize_t(bytes.size()));
  }

  test::HidTestbed bed;
  std::vector<int> fds;
  std::vector<std::unique_ptr<CapFirmware>> caps;  // end before their ends of the bed do
  std::shared_ptr<const DevicePlugin> plugin;
  std::unique_ptr<Device> device;
  std::vector<TrephineArmState> states;
  std::vector<TrephineArmCommand> commands;
  test::HostTicks ticks;
};

// A machine that stands still for a moment makes one of several late, and not their median.
double median(std::vector<double> of) {
  std::nth_element(of.begin(), of.begin() + of.size() / 2, of.end());
  return of[of.size() / 2];
}

TEST_F(Pedal, ItsThreeSwitchesAreSeenWithin20msPressedAndReleased) {
  const int fd = plugIn(test::footSwitch(), "1-4");
  ASSERT_NO_FATAL_FAILURE(start({0}));
  push({1.0, 0, 0});  // which it drops
  pass_s(0.05);
  EXPECT_EQ(states[0].buttons, 0u);
  std::vector<double> seen_s;
  for (std::uint8_t switches : {1, 0, 2, 0, 4, 0, 1, 3, 7, 4, 0}) {
    send(fd, {switches, 0});
    seen_s.push_back(secondsUntil(switches));
    ASSERT_EQ(states[0].buttons, switches);
    pass_s(0.05);
    EXPECT_EQ(states[0].buttons, switches) << "it stays so";
    EXPECT_EQ(at(), Vec3(0.0));
    EXPECT_EQ(turned(), Quat(1.0, 0.0, 0.0, 0.0));
  }
  EXPECT_LT(median(seen_s), 0.02);
}

TEST_F(Pedal, OneThatIsLeftAloneIsThereAndOneThatIsUnpluggedIsLost) {
  const int fd = plugIn(test::footSwitch(), "1-4");
  ASSERT_NO_FATAL_FAILURE(start({0}));
  EXPECT_EQ(device->capabilities(0).input_dof, 0u);
  EXPECT_FALSE(device->hasClock());
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t before = states[0].sequence;
    tick();
    ASSERT_FALSE(lost());
    ASSERT_EQ(states[0].sequence, before + 1);
  }
  send(fd, {2, 0});
  secondsUntil(2);
  bed.unplug(fd);
  pass_s(0.1);
  EXPECT_TRUE(lost());
  EXPECT_EQ(states[0].buttons, 0u) << "nobody presses it now";
  const std::uint64_t sequence = states[0].sequence;
  pass_s(0.05);
  EXPECT_EQ(states[0].sequence, sequence);
  device->stop();
  EXPECT_FALSE(device->start().ok());
}

TEST_F(Pedal, GarbageAndHalfReportsPressNothing) {
  const int fd = plugIn(test::footSwitch(), "1-4");
  ASSERT_NO_FATAL_FAILURE(start({0}));
  for (const std::vector<std::uint8_t>& bytes : {std::vector<std::uint8_t>{1},
                                                 {0xFF, 0xFF},
                                                 {1, 2, 3},
                                                 {0, 1},
                                                 std::vector<std::uint8_t>(64, 0xA5)}) {
    send(fd, bytes);
    pass_s(0.05);
    EXPECT_EQ(states[0].buttons, 0u) << bytes.size();
    EXPECT_FALSE(lost());
  }
  send(fd, {4, 0});
  secondsUntil(4);
  EXPECT_EQ(states[0].buttons, 4u);
}

// Each axis of the cap, and where its hand goes: right, up and towards the user.
class CapOf : public Pedal, public ::testing::WithParamInterface<bool> {};

TEST_P(CapOf, SixAxesMoveAndTurnTheToolAndItStopsWhenTheyAreReleased) {
  CapFirmware& cap = plugInCap("1-1", GetParam());
  ASSERT_NO_FATAL_FAILURE(start({0}));
  EXPECT_EQ(device->capabilities(0).input_dof, 6u);
  EXPECT_EQ(device->capabilities(0).latency_s, 0.0);
  pass_s(0.05);
  const Vec3 way[] = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
  const double share = (200.0 / 350.0 - kDeadZone) / (1.0 - kDeadZone);
  for (std::size_t axis = 0; axis < 6; ++axis) {
    for (int sign : {1, -1}) {
      const Vec3 from = at();
      const Quat before = turned();
      CapAxes held{};
      held[axis] = std::int16_t(200 * sign);
      const auto began = steady_clock::now();
      cap.hold(held);
      pass_s(0.15);
      cap.release();
      const double held_s = std::chrono::duration<double>(steady_clock::now() - began).count();
      pass_s(0.15);
      const Vec3 moved = at() - from;
      // In the device's frame, so that what it was turned before comes first.
      const Quat change = turned() * glm::conjugate(before);
      const Vec3 turn = 2.0 * Vec3(change.x, change.y, change.z) * (change.w < 0.0 ? -1.0 : 1.0);
      const Vec3& along = way[axis % 3];
      const double wanted = sign * held_s * share * (axis < 3 ? kSpeed_m_s : kTurn_rad_s);
      const Vec3 has = axis < 3 ? moved : turn, none = axis < 3 ? turn : moved;
      EXPECT_NEAR(glm::dot(has, along) / wanted, 1.0, 0.3) << axis << ", " << sign;
      EXPECT_LT(glm::length(has - glm::dot(has, along) * along), 2 * kStep_m) << axis;
      EXPECT_LT(glm::length(none), 2 * kStep_m) << axis;
      EXPECT_NEAR(glm::length(turned()), 1.0, 1e-9);
      // Released: it stays, to a step of the encoders.
      const Vec3 there = at();
      const Quat so = turned();
      pass_s(0.05);
      EXPECT_LT(glm::distance(at(), there), 2 * kStep_m) << axis;
      EXPECT_EQ(turned(), so) << axis;
    }
  }
  std::vector<double> seen_s;
  for (std::uint8_t buttons : {1, 3, 2, 0}) {
    cap.press(buttons);
    seen_s.push_back(secondsUntil(buttons));
    ASSERT_EQ(states[0].buttons, buttons);
  }
  EXPECT_LT(median(seen_s), 0.02);
}
INSTANTIATE_TEST_SUITE_P(Wireless, CapOf, ::testing::Bool());

TEST_F(Pedal, ACapNearRestIsAtRest) {
  CapFirmware& cap = plugInCap("1-1");
  ASSERT_NO_FATAL_FAILURE(start({0}));
  cap.hold({12, -12, 12, -12, 12, -12});
  pass_s(0.5);
  EXPECT_EQ(at(), Vec3(0.0));
  EXPECT_EQ(turned(), Quat(1.0, 0.0, 0.0, 0.0));
}

TEST_F(Pedal, AHandStaysInTheWorkspaceAndItsTurnAUnitQuaternion) {
  CapFirmware& cap = plugInCap("1-1", true);
  ASSERT_NO_FATAL_FAILURE(start({0}, config(R"(, "speed_m_s": 0.5, "turn_rad_s": 10)")));
  cap.hold({350, 350, -350, 350, -200, 100});
  for (int i = 0; i < 1000; ++i) {
    tick();
    ASSERT_TRUE(glm::all(glm::lessThanEqual(glm::abs(at()), kHalfWorkspace_m + 0.51 * kStep_m)));
    ASSERT_NEAR(glm::length(turned()), 1.0, 1e-9);
  }
  EXPECT_LT(glm::distance(at(), kHalfWorkspace_m), 1e-3);
  EXPECT_TRUE(states[0].flags & TREPHINE_ARM_AT_LIMIT);
  EXPECT_FALSE(lost());
  push({-1.2, 0, 0});
  pass_s(0.3);
  EXPECT_NEAR(at().x, kHalfWorkspace_m.x - 1.2 / kHand_N_per_m, kStep_m)
      << "the hand is at the edge too, not beyond";
  cap.hold({-350, 0, 0, 0, 0, 0});
  pass_s(0.1);
  EXPECT_LT(at().x, 0.07) << "and it comes back at once";
}

TEST_F(Pedal, AForcePushesTheToolBackAsFarAsTheHandGivesWay) {
  plugInCap("1-1");
  ASSERT_NO_FATAL_FAILURE(start({0}));
  for (const Vec3& force_N : {Vec3(1.2, 0, 0), Vec3(0, -1.2, 0), Vec3(-0.6, 0.6, -1.0)}) {
    push(force_N);
    pass_s(0.3);
    EXPECT_LT(glm::distance(at(), force_N / kHand_N_per_m), kStep_m);
  }
  push({10.0, 0, 0});
  pass_s(0.3);
  EXPECT_LT(glm::distance(at(), Vec3(kPeak_N / kHand_N_per_m, 0, 0)), kStep_m) << "the arm's peak";
  push(Vec3(0.0));
  pass_s(0.3);
  EXPECT_LT(glm::length(at()), kStep_m);
}

// A cap that is held gives the hand a speed for ever; its pull may not grow so.
TEST_F(Pedal, WhatHoldsTheToolIsNotOvercomeByHoldingTheCapLonger) {
  CapFirmware& cap = plugInCap("1-1");
  ASSERT_NO_FATAL_FAILURE(start({0}));
  const double wall_N_per_m = 2000.0;
  const auto againstWall_s = [&](double seconds) {
    for (int i = 0; i < int(seconds / kT_s); ++i) {
      push({std::max(-kPeak_N, -wall_N_per_m * std::max(0.0, at().x)), 0, 0});
      tick();
    }
  };
  cap.hold({350, 0, 0, 0, 0, 0});
  againstWall_s(1.5);
  EXPECT_GT(at().x, 0.5 * kPeak_N / wall_N_per_m) << "it presses";
  EXPECT_LT(at().x, 1.1 * kPeak_N / wall_N_per_m);
  cap.hold({-350, 0, 0, 0, 0, 0});
  againstWall_s(0.15);
  EXPECT_LT(at().x, 0.0) << "and leaves as soon as it is asked to";
}

TEST_F(Pedal, ACapThatFallsSilentIsAtRestAndNotLost) {
  CapFirmware& cap = plugInCap("1-1");
  ASSERT_NO_FATAL_FAILURE(start({0}));
  cap.hold({350, 0, 0, 0, 0, 100});
  pass_s(0.1);
  cap.fallSilent();
  pass_s(0.45);
  const Vec3 there = at();
  EXPECT_GT(there.x, 0.02);
  EXPECT_LT(there.x, 0.05);
  for (int i = 0; i < 500; ++i) {
    const std::uint64_t before = states[0].sequence;
    tick();
    ASSERT_FALSE(lost());
    ASSERT_EQ(states[0].sequence, before + 1);
  }
  EXPECT_LT(glm::distance(at(), there), 2 * kStep_m);
}

TEST_F(Pedal, GarbageMovesNoCap) {
  // Chosen so that none of it is a report, also where the system joins it.
  const std::vector<std::uint8_t> other{0x99, 0x99, 0x41};
  const std::vector<std::uint8_t> pieces[] = {
      {1},
      other,
      {2, 0x50},
      other,
      {1, 0, 0, 0, 0, 0x7F},
      other,
      {1, 0xFF, 0x7F, 0xFF, 0x7F, 0xFF, 0x7F, 0xFF, 0x7F, 0xFF, 0x7F, 0xFF, 0x7F},
      std::vector<std::uint8_t>(64, 0x99),
      std::vector<std::uint8_t>(63, 0x41)};
  for (bool wireless : {false, true}) {
    CapFirmware& cap = plugInCap(wireless ? "1-2" : "1-1", wireless);
    ASSERT_NO_FATAL_FAILURE(start({std::uint32_t(wireless)}));
    for (const std::vector<std::uint8_t>& bytes : pieces) {
      cap.send(bytes);
      pass_s(0.05);
      EXPECT_EQ(at(), Vec3(0.0)) << bytes.size();
      EXPECT_EQ(turned(), Quat(1.0, 0.0, 0.0, 0.0));
      EXPECT_EQ(states[0].buttons, 0u);
      EXPECT_FALSE(lost());
    }
    cap.hold({200, 0, 0, 0, 0, 0});
    pass_s(0.2);
    EXPECT_GT(at().x, 0.005) << "and reports count again";
    EXPECT_LT(std::abs(at().y) + std::abs(at().z), kStep_m);
    device.reset();
  }
}

TEST_F(Pedal, PedalsAndSpaceMiceAreToldApartAndListedOnceEach) {
  // A cap that is the second of three interfaces, the first a keyboard; and others' devices.
  test::HidDescription other = test::spaceMouse(true);
  other.report_descriptor = test::plainDescriptor(0x0001, 0x0006, 8, 1);
  plugIn(other, "1-3", 0);
  CapFirmware& cap = plugInCap("1-3", true, 1);
  plugIn(test::spaceMouse(true), "1-3", 2);
  plugIn(test::footSwitch(), "1-2.4");
  other = test::spaceMouse(false);
  other.vendor = 0x046D;
  other.product = 0xC216;
  plugIn(other, "1-5");
  other.product = 0xC626;
  other.name = "SpaceNavigator";
  plugIn(other, "1-1");
  other.report_descriptor = test::plainDescriptor(0x0001, 0x0002, 8, 0);
  plugIn(other, "1-6");
  const std::vector<TrephineArmInfo> infos = plugin->enumerate();
  std::vector<std::string> found;
  for (const TrephineArmInfo& info : infos) {
    found.push_back(std::string(info.bus_path) + " " + info.model + " " + info.serial);
  }
  EXPECT_EQ(found,
            (std::vector<std::string>{"usb-1-2.4 VEC USB Footpedal ", "usb-1-1 SpaceNavigator ",
                                      "usb-1-3 SpaceMouse Wireless W1"}));
  ASSERT_NO_FATAL_FAILURE(start({2}));
  cap.hold({350, 0, 0, 0, 0, 0});
  pass_s(0.1);
  EXPECT_GT(at().x, 0.002) << "it is the cap's interface that is opened";
}

TEST_F(Pedal, ASpaceMouseWithoutSixAxesIsRefusedInOneSentence) {
  test::HidDescription of = test::spaceMouse(false);
  of.report_descriptor = test::plainDescriptor(0x0001, 0x0008, 8, 0);
  plugIn(of, "1-1");
  const auto opened = Device::open(plugin, {0}, config());
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().what.find("six axes"), std::string::npos) << opened.error().what;
}

TEST_F(Pedal, APedalGoesOnBesideASpaceMouseThatIsUnplugged) {
  const int pedal = plugIn(test::footSwitch(), "1-4");
  CapFirmware& cap = plugInCap("1-1");
  ASSERT_NO_FATAL_FAILURE(start({1, 0}));
  EXPECT_EQ(device->capabilities(0).input_dof, 6u);
  EXPECT_EQ(device->capabilities(1).input_dof, 0u);
  cap.hold({350, 0, 0, 0, 0, 0});
  pass_s(0.1);
  EXPECT_GT(at(0).x, 0.002);
  EXPECT_EQ(at(1), Vec3(0.0));
  cap.end();
  bed.unplug(fds[0]);
  pass_s(0.1);
  EXPECT_TRUE(lost(0));
  const Vec3 there = at(0);
  send(pedal, {1, 0});
  pass_s(0.1);
  EXPECT_FALSE(lost(1));
  EXPECT_EQ(states[1].buttons, 1u);
  EXPECT_EQ(at(0), there);
}

TEST_F(Pedal, AConfigurationIsReadStrictly) {
  plugIn(test::footSwitch(), "1-4");
  const auto answer = [&](const std::string& text) {
    auto opened = Device::open(plugin, {0}, text);
    return opened ? std::string("taken") : opened.error().what;
  };
  EXPECT_EQ(answer(config()), "taken");
  EXPECT_EQ(answer(config(R"(, "speed_m_s": 0.2, "turn_rad_s": 1, "dead_zone": 0)")), "taken");
  for (const char* name : {"pedal.json", "spacemouse.json"}) {
    std::ifstream file(std::string(TREPHINE_TEST_DEVICES "/") + name);
    EXPECT_EQ(answer({std::istreambuf_iterator<char>(file), {}}), "taken") << name;
  }
  const std::pair<std::string, const char*> refused[] = {
      {config(R"(, "spee": 0.2)"), "'spee'"},
      {config(R"(, "speed_m_s": 2)"), "'speed_m_s'"},
      {config(R"(, "speed_m_s": "fast")"), "'speed_m_s'"},
      {config(R"(, "turn_rad_s": 0)"), "'turn_rad_s'"},
      {config(R"(, "dead_zone": 1)"), "'dead_zone'"},
      {R"({"format": "trephine.device", "version": 2, "model": "x"})", "'version'"},
      {R"({"format": "trephine.arms", "version": 1, "model": "x"})", "'format'"},
      {R"({"format": "trephine.device", "version": 1})", "'model'"}};
  for (const auto& [text, words] : refused) {
    EXPECT_NE(answer(text).find(words), std::string::npos) << text << ": " << answer(text);
  }
}

}  // namespace
}  // namespace trephine
