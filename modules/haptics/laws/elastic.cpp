#include "haptics/laws/elastic.h"

#include <algorithm>

namespace trephine {

namespace {
// A push below this share of K r is what is left of pushes from all sides: it gives no normal.
constexpr double kClear = 0.25;
}  // namespace

void ElasticLaw::Tissues::use(const TissueTable& tissues, std::uint32_t acts_in) {
  TissueTable pushing = tissues;
  any = false;
  for (int c = 0; c < pushing.count; ++c) {
    TissueClass& tissue = pushing.classes[std::size_t(c)];
    if (tissue.solid || !(acts_in >> c & 1u)) tissue.stiffness_N_per_m = 0.0;
    any = any || tissue.stiffness_N_per_m > 0.0;
  }
  stiffness.set(pushing);
}

ElasticLaw::Query::Query(const Tool& tool, const GridGeometry& geometry)
    : sphere(geometry, 1000.0 * tool.sphere_radius_m, sphereDirections(tool.blunt)),
      radius_m(tool.sphere_radius_m),
      blunt(tool.blunt) {}

ElasticLaw::Answer ElasticLaw::Query::ask(const Tissues& tissues, const TissueField& tissue,
                                          const Pose& tool_mm, const LawInput& in) const {
  Answer answer;
  answer.radius_m = radius_m;
  answer.sphere_m = -radius_m * in.tool_direction;
  const int c = in.tip_class >= 0 ? in.tip_class : in.tissue_class;
  answer.parts = !blunt && (c < 0 || tissue.ofClass(c).cuttable != 0);
  if (tissues.any && !in.soft.parts) {
    answer.push =
        sphere.push(tissue, tissues.stiffness, tool_mm.position + 1000.0 * answer.sphere_m);
  }
  return answer;
}

void ElasticLaw::add(const LawInput& in, const Answer& answer, ContactForce& out) {
  addSolid(in, out);
  addSoft(in, answer, out);
}

void ElasticLaw::addSolid(const LawInput& in, ContactForce& out) const {
  const double k = in.share.stiffness * in.pull.stiffness;
  if (!(k > 0.0)) return;
  const Vec3 shift_m = 0.001 * in.pull.shift_mm;
  const double turn_m2 = 1e-6 * in.pull.turn_mm2;
  out.elastic_N += k * shift_m;
  out.addElasticTorque(k * turn_m2 * in.pull.turn);
  out.solid_stiffness += k;
  out.stored_J += 0.5 * k * (glm::dot(shift_m, shift_m) +
                             turn_m2 * glm::dot(in.pull.turn, in.pull.turn));
}

void ElasticLaw::addSoft(const LawInput& in, const Answer& answer, ContactForce& out) {
  const ElasticPush& push = answer.push;
  const double size_N = glm::length(push.force_N);
  const double at_centre_N = push.at_centre * answer.radius_m;
  if (!(size_N > 0.0) && !(at_centre_N > 0.0)) {
    forget();
    return;
  }
  if (size_N > kClear * at_centre_N && stiffness == 0.0) normal = push.force_N / size_N;
  Vec3 force_N = push.force_N;
  double stored_J = push.stored_J;
  const Vec3 sphere_m = in.tip_m + answer.sphere_m;
  if (answer.parts) {
    stiffness = 0.0;
    const bool parts = at_centre_N > size_N;
    most_N = parted ? std::min(most_N, size_N) : size_N;
    parted = parted || parts;
    if (size_N > most_N) {
      force_N *= most_N / size_N;
      stored_J *= most_N / size_N;
    }
  } else if (!(at_centre_N > 0.0)) {
    stiffness = 0.0;
  } else {
    const double k = push.at_centre;
    if (stiffness == 0.0) {
      depth_m = size_N / k;
    } else {
      if (k > stiffness) depth_m *= stiffness / k;
      depth_m = std::max(0.0, depth_m - glm::dot(sphere_m - centre_m, normal));
    }
    stiffness = k;
    force_N = k * depth_m * normal;
    stored_J = 0.5 * k * depth_m * depth_m;
  }
  centre_m = sphere_m;
  force_N *= in.share.stiffness;
  out.elastic_N += force_N;
  out.stiffness += in.share.stiffness * push.stiffness;
  out.stored_J += in.share.stiffness * stored_J;
  out.addElasticTorque(glm::cross(answer.sphere_m, force_N));
}

}  // namespace trephine
