// The work that the operator's hand did on a tool, in the model's units: what can pay for cutting.
#pragma once

#include <algorithm>

#include "base/math.h"

namespace trephine {

// An arm shows a share of what the model demands, over a map that scales force by g and motion by
// s. Work at the device, divided by (g / s) and by that share, is the work that the same motion
// does against the model itself: it does not depend on the arm. What of it the springs hold comes
// back; what went into the tissue,
//   D = sum -F(n-1).dx(n) / (g/s) / share(n-1) + motor - stored,
// pays for cutting, and only where D exceeds its maximum so far: what came back is not paid twice.
// The hand's part is at most the work that the model itself takes from the same motion, with the
// mean of its own force at both ends of each period: what a controller damps away, at an arm that
// shows a hundredth of the model, is no work on tissue.
class HandWork {
 public:
  // Of the period in which `sent_N` acted (device), the arm moving by `moved_m`; turning does not
  // count. `device_per_model`: g / s. Called in periods without force too.
  void addDeviceWork(const Vec3& sent_N, const Vec3& moved_m, double device_per_model) {
    if (device_per_model > 0.0) done_J_ -= glm::dot(sent_N, moved_m) / (device_per_model * share_);
    shown_ = sent_N != Vec3(0.0);
  }
  // What the model takes from the same motion, in its own units; once addDeviceWork() was called.
  void addModelWork(double model_J) {
    if (shown_) taken_J_ += model_J;
  }
  // What the springs hold now [J], the share of the model that is rendered in the next period, and
  // the motor's work in this one. Returns by how much D now exceeds its maximum so far, or 0. What
  // an arm gave out, or a spring came to hold without work of the hand, comes off the motor's work
  // too.
  double endTick(double stored_J, double share, double motor_J = 0.0) {
    // After forget(): what the springs hold then is no work of the hand.
    if (!started_) done_J_ = taken_J_ = most_lost_J_ - motor_J_ + stored_J;
    started_ = true;
    stored_J_ = stored_J;
    motor_J_ += motor_J;
    share_ = share > kLeastShare ? share : kLeastShare;
    const double more_J = std::max(0.0, lost_J() - most_lost_J_);
    most_lost_J_ += more_J;
    return more_J;
  }
  // D; it falls where an arm gives out energy.
  double lost_J() const { return std::min(done_J_, taken_J_) + motor_J_ - stored_J_; }
  // Law states were forgotten: the springs begin anew. Called before the endTick() that sees them
  // empty, else what they held would pay for cutting.
  void forget() { started_ = false; }

  double done_J() const { return done_J_; }
  double taken_J() const { return taken_J_; }
  double motor_J() const { return motor_J_; }
  double stored_J() const { return stored_J_; }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.done_J_, self.taken_J_, self.motor_J_, self.stored_J_, self.most_lost_J_);
    archive(self.share_, self.started_);
  }

 private:
  static constexpr double kLeastShare = 1e-6;
  double done_J_ = 0.0, taken_J_ = 0.0, motor_J_ = 0.0, stored_J_ = 0.0, most_lost_J_ = 0.0;
  double share_ = 1.0;
  bool started_ = true, shown_ = false;
};

}  // namespace trephine
