#include "haptics/laws/elastic.h"

#include <algorithm>

namespace trephine {

namespace {
// Of K r: below this the sum is the rest of pushes from all sides, and its direction means nothing.
constexpr double kClear = 0.25;
}  // namespace

void ElasticLaw::add(const LawInput& in, ContactForce& out) {
  const double size_N = glm::length(in.push.force_N);
  const double at_centre_N = in.push.at_centre * in.ball_radius_m;
  if (!(size_N > 0.0) && !(at_centre_N > 0.0)) {
    forget();
    return;
  }
  if (size_N > kClear * at_centre_N) normal = in.push.force_N / size_N;
  Vec3 force_N = in.push.force_N;
  double stored_J = in.push.stored_J;
  if (in.blunt) {
    const double deep_N = size_N + 2.0 * std::max(0.0, at_centre_N - size_N);
    force_N = deep_N * normal;
    if (deep_N > size_N) stored_J = deep_N * deep_N / (2.0 * in.push.at_centre);
  } else {
    const bool parts = at_centre_N > size_N;
    most_N = parted ? std::min(most_N, size_N) : size_N;
    parted = parted || parts;
    if (size_N > most_N) {
      force_N *= most_N / size_N;
      stored_J *= most_N / size_N;
    }
  }
  force_N *= in.share.stiffness;
  out.elastic_N += force_N;
  out.stiffness += in.share.stiffness * in.push.stiffness;
  out.stored_J += in.share.stiffness * stored_J;
  out.torque_Nm += glm::cross(in.ball_m, force_N);
}

}  // namespace trephine
