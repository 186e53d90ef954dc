// Arms that a person tries, outside of any exercise: where each is, its buttons, and a force to
// tell by that it works. No tissue, no controller.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "base/math.h"
#include "base/result.h"
#include "base/rt/abandonable_thread.h"
#include "base/rt/latest_value.h"
#include "device/device.h"
#include "device/find_arms.h"
#include "haptics/haptic_types.h"
#include "session/force_test.h"
#include "session/motor_encoder_check.h"

namespace trephine {

struct TriedArm {
  Pose pose_m;  // device frame
  std::uint32_t buttons = 0, flags = 0;
  double moved_m = 0.0;  // the farthest it has been from where it was first
  double force_N = 0.0;  // upward, as sent for a person to feel
  ForceTest::Phase test = ForceTest::Phase::off;
  MotorEncoderCheck::Phase answer = MotorEncoderCheck::Phase::off;
  double noise_m = 0.0;  // as MotorEncoderCheck has them
  MotorEncoderCheck::Response response;
  bool pushed = false;
  std::uint64_t samples = 0;
};
constexpr std::size_t kMostTried = 8;
using TriedArms = std::array<TriedArm, kMostTried>;

class ArmTrial {
 public:
  // Opens, calibrates and starts the first kMostTried; not on a window's thread. What one plugin
  // has is opened together, without an arm that cannot be had: that says why in problem().
  static std::unique_ptr<ArmTrial> start(const std::vector<FoundArm>& arms);
  // Zero force first. Waits for the arms at most 0.3 s; the device whose call does not return is
  // left behind, and what else takes longer goes on by itself.
  ~ArmTrial();

  std::size_t size() const;
  const std::optional<Error>& problem(std::size_t arm) const;
  const TrephineCapabilities& capabilities(std::size_t arm) const;
  // The newest; one thread. While a call of a device does not return, the force is taken away and
  // all arms are lost.
  const TriedArms& state();
  // Of the arm of this number: a force within what it can be sent for good, or `most_N`.
  void askForForce(std::size_t arm, double most_N);
  // Whether encoders and motors agree, once a hand is on it; no other force meanwhile.
  void askForAnswer(std::size_t arm, double patience_s);
  void endForce();  // at once

 private:
  struct Engine;
  ArmTrial() = default;
  std::shared_ptr<Engine> engine_;
  rt::AbandonableThread thread_, watch_thread_;
  TriedArms shown_{};
};

}  // namespace trephine
