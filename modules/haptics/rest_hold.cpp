#include "haptics/rest_hold.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

constexpr double kRest_s = 0.12;    // within one count, before the force is held
constexpr double kFading_s = 0.02;  // time constant of the jump as a hold ends
// A force rests while it turns by no more than 5 degrees (sine 0.09) or, where that is more, than
// the stiffness times 1.75 counts turn it: the diagonal of a count's cube.
constexpr double kTurned = 0.09;
constexpr double kTurnedCounts = 1.75;
constexpr double kSlope = 2.0;  // the slope of a tissue's force may be so many times its stiffness
constexpr double kRounding = 1.01;
// A count's cube, seen across some direction, is at most this wide along an axis, in counts.
constexpr double kAcross = 1.37;

}  // namespace

template <class Rests>
Vec3 RestHold::follow(Window& window, const Vec3& sample, const Vec3& force_N, double count_N,
                      const Rests& rests) const {
  window.fading_N /= 1.0 + T_ / kFading_s;
  window.low = glm::min(window.low, sample);
  window.high = glm::max(window.high, sample);
  if (window.ticks == 0 || !rests(window.high - window.low)) {
    if (window.holding) {
      const Vec3 jump_N = window.sum_N - force_N;
      const double size_N = glm::length(jump_N);
      window.fading_N = size_N > count_N ? jump_N * (1.0 - count_N / size_N) : Vec3(0.0);
    }
    window.low = window.high = sample;
    window.sum_N = force_N;
    window.ticks = 1;
    window.holding = false;
    return force_N + window.fading_N;
  }
  if (window.holding) return window.sum_N;
  window.sum_N += force_N;
  ++window.ticks;
  if (window.ticks * T_ < kRest_s) return force_N + window.fading_N;
  window.holding = true;
  window.sum_N /= double(window.ticks);
  return window.sum_N;
}

Vec3 RestHold::hold(const Vec3& elastic_N, double stiffness, const Vec3& position_m,
                    const Vec3& force_N) {
  const double size_N = glm::length(elastic_N);
  if (!(step_m_ > 0.0) || !(stiffness > 0.0) || !(size_N > 0.0)) {
    forget();
    return force_N;
  }
  const double along_N = glm::dot(elastic_N, direction_);
  const double aside_N = glm::length(elastic_N - along_N * direction_);
  if (along_.ticks == 0 || along_N < 0.0 ||
      aside_N > std::max(kTurned * size_N, kTurnedCounts * step_m_ * stiffness)) {
    direction_ = elastic_N / size_N;
    forget();
  }
  const Vec3 n = direction_;
  const double count_m = kRounding * step_m_ * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
  const Vec3 pushing_N = glm::dot(force_N, n) * n;
  const Vec3 sliding_m = position_m - glm::dot(position_m, n) * n;
  const double count_N = stiffness * count_m, across_m = kRounding * kAcross * step_m_;
  const Vec3 along(glm::dot(elastic_N, n), glm::dot(position_m, n), 0.0);
  return follow(along_, along, pushing_N, count_N,
                [=](const Vec3& wide) {
                  return wide.x <= count_N || (wide.x <= kSlope * count_N && wide.y <= count_m);
                }) +
         follow(across_, sliding_m, force_N - pushing_N, count_N, [=](const Vec3& wide) {
           return wide.x <= across_m && wide.y <= across_m && wide.z <= across_m;
         });
}

}  // namespace trephine
