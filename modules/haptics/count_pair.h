// The position of an arm whose samples alternate between two neighbouring counts of an encoder: the
// middle of the two. A tool that creeps over a firm wall alternates so at every count that it
// passes; taken sample by sample each alternation looks like a loss of k q^2 (stiffness k, step q).
#pragma once

#include <array>
#include <cmath>

#include "base/math.h"

namespace trephine {

class CountPair {
 public:
  CountPair(double encoder_step_m, double period_s) : step_m_(encoder_step_m), T_(period_s) {}

  // Every tick. On each axis the sample itself; for 0.1 s after a step back to the count before,
  // the middle of the two.
  Vec3 look(const Vec3& sample_m) {
    Vec3 at_m = sample_m;
    if (!(step_m_ > 0.0)) return at_m;
    for (int i = 0; i < 3; ++i) {
      Axis& axis = axes_[std::size_t(i)];
      const double moved_m = std::abs(sample_m[i] - axis.now_m);
      axis.since_s += T_;
      if (moved_m > 0.5 * step_m_) {
        axis.back = moved_m < 1.5 * step_m_ && axis.since_s < kSoon_s &&
                    std::abs(sample_m[i] - axis.before_m) < 0.5 * step_m_;
        axis.before_m = axis.now_m;
        axis.now_m = sample_m[i];
        axis.since_s = 0.0;
      }
      if (axis.back && axis.since_s < kSoon_s) at_m[i] = 0.5 * (axis.now_m + axis.before_m);
    }
    return at_m;
  }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.axes_);
  }

 private:
  static constexpr double kSoon_s = 0.1;
  struct Axis {
    double now_m = 0.0, before_m = 0.0;  // the last two counts
    double since_s = 1e9;
    bool back = false;

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.now_m, self.before_m, self.since_s, self.back);
    }
  };
  double step_m_, T_;
  std::array<Axis, 3> axes_{};
};

}  // namespace trephine
