// WoodenHaptics behind the C ABI: states, and what is counts there and metres here. The board is
// board.h, the arm kinematics.h.
#include "../common/plugin.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "../common/config.h"
#include "board.h"
#include "kinematics.h"

using namespace trephine::woodenhaptics;
using namespace trephine::plugin;

namespace {

// USB carries a report a millisecond each way; the rest is two threads that take over.
constexpr double kLatency_s = 0.0022;
// Where a link is by a report older than this, nobody knows: it is not carried.
constexpr std::int64_t kFresh_ns = 15'000'000;

struct Arm {
  explicit Arm(const Silence& silence) : board(silence) {}
  Board board;
  Report last;
  Vector angles{};
};

// The arm's x towards the user, y right, z up; the host's x right, y up, z towards the user.
Vector toHost(const Vector& arm) {
  return {arm[1], arm[2], arm[0]};
}
Vector toArm(const double host[3]) {
  return {host[2], host[0], host[1]};
}

void report(Arm& arm, TrephineArmState& state) {
  arm.last = arm.board.latest();
  Vector counts{};
  for (std::size_t i = 0; i < 3; ++i) counts[i] = arm.last.counts[i];
  arm.angles = jointAngles(counts);
  const Vector position = toHost(tip(arm.angles));
  state.sequence = arm.last.number;
  state.time_ns = arm.last.time_ns;
  std::copy(position.begin(), position.end(), state.position_m);
  const double straight[] = {1.0, 0.0, 0.0, 0.0};
  std::copy_n(straight, 4, state.orientation);
  state.buttons = 0;
  state.flags = TREPHINE_ARM_CALIBRATED;
}

}  // namespace

struct TrephineDevice : Opened {
  static constexpr const char *kName = "woodenhaptics", *kArm = "WoodenHaptics arm";
  static constexpr std::uint32_t kMostArms = 4;

  std::vector<std::unique_ptr<Arm>> arms;
  bool gravity = false;
  double latency_s = kLatency_s;

  static std::vector<Found> find() { return findBoards(); }
  static void describe(const Found& board, TrephineArmInfo& info) {
    copyText(info.bus_path, "usb-" + board.port);
    copyText(info.serial, board.serial);
    copyText(info.model, "WoodenHaptics");
  }
  explicit TrephineDevice(const std::vector<Found>& boards) {
    for (const Found& board : boards) {
      arms.push_back(std::make_unique<Arm>(silence));
      std::string why = arms.back()->board.open(board);
      if (!why.empty()) throw Refused{TREPHINE_ERROR_NO_DEVICE, std::move(why)};
    }
  }
  std::size_t size() const { return arms.size(); }

  // "gravity" and "latency_s" may be absent.
  void configure(const char* json) {
    const Json root = parseConfig(json, {"gravity", "latency_s"});
    const bool holds_itself = checkBool(root.value("gravity", Json(false)), "gravity");
    latency_s = checkNumber(root.value("latency_s", Json(kLatency_s)), "latency_s", 0.0, 0.1);
    gravity = holds_itself;
  }
  void capabilities(std::size_t, TrephineCapabilities& out) const;
  // The encoders count from where the board was switched on, which has to be the rest of the arm.
  void calibrate(std::size_t) {}
  void start() {
    for (const auto& arm : arms) {
      std::string why = arm->board.start();
      if (!why.empty()) throw Refused{TREPHINE_ERROR_NO_DEVICE, std::move(why)};
    }
    for (const auto& arm : arms) arm->last = Report{};
  }
  void stop() {
    for (const auto& arm : arms) arm->board.stop();
  }

  int read(double, TrephineArmState* states);
  int command(const Forces& forces_N);
  bool waitForOther(double timeout_s) {
    const auto arm = std::find_if(arms.begin(), arms.end(),
                                  [](const auto& each) { return !each->board.lost(); });
    return arm != arms.end() && (*arm)->board.waitForOther((*arm)->last.number, timeout_s);
  }
  void sendNow() {
    for (const auto& arm : arms) arm->board.sendNow();
  }
};

void TrephineDevice::capabilities(std::size_t, TrephineCapabilities& out) const {
  out.input_dof = 3;  // its last joints have no encoders
  // A box within reach of the links, and the mass of the links as its tip feels them: estimates,
  // not measured on an arm (README.md).
  const double box_m[] = {0.20, 0.16, 0.12};
  std::copy_n(box_m, 3, out.workspace_m);
  out.peak_force_N = out.continuous_force_N = kPeak_N;
  out.thermal_s = 0.0;
  out.apparent_mass_kg = 0.15;
  out.encoder_step_m = 6.5e-5;  // the coarsest count within the box
  out.rate_hz = 1000.0;
  out.latency_s = latency_s;
  out.friction_N = 0.0;  // nobody has measured it
}

int TrephineDevice::read(double, TrephineArmState* states) {
  for (std::size_t i = 0; i < arms.size(); ++i) {
    TrephineArmState& state = *element(states, i);
    report(*arms[i], state);
    if (!arms[i]->board.lost()) continue;
    // The other arm goes on, so it is the arm that is lost and not the reading.
    state.flags |= TREPHINE_ARM_LOST;
    error = "A WoodenHaptics arm went away: check its plug and try again.";
  }
  return TREPHINE_OK;
}

int TrephineDevice::command(const Forces& forces_N) {
  for (std::size_t i = 0; i < arms.size(); ++i) {
    Arm& arm = *arms[i];
    std::array<std::int16_t, 3> milliamps{};
    if (forces_N[i]) {
      Vector torques = jointTorques(arm.angles, toArm(forces_N[i]));
      if (gravity && now_ns() - arm.last.time_ns < kFresh_ns) {
        const Vector up = gravityTorques(arm.angles);
        for (std::size_t joint = 0; joint < 3; ++joint) torques[joint] += up[joint];
      }
      const Vector amps = currents(torques);
      for (std::size_t joint = 0; joint < 3; ++joint) {
        milliamps[joint] = std::int16_t(std::lround(1000.0 * amps[joint]));
      }
    }
    arm.board.command(milliamps);
  }
  return TREPHINE_OK;
}

extern "C" __attribute__((visibility("default"))) const TrephineDeviceApi* trephine_device_plugin(
    std::uint32_t host_abi) {
  return trephine::plugin::Plugin<TrephineDevice>::table(host_abi);
}
