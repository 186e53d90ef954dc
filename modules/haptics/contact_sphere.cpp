#include "haptics/contact_sphere.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "haptics/spiral.h"

namespace trephine {

namespace {

// Where a ray is sampled, in radii. The last part is the shell of the surface term; the radius ends
// in its middle.
constexpr int kParts = 4;
constexpr double kRadii[kParts] = {1.0 / 3.0, 2.0 / 3.0, 5.0 / 6.0, 7.0 / 6.0};
constexpr double kShare[kParts] = {1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0};
// The integral of s ds over each part, up to the radius.
constexpr double kMoment[kParts] = {1.0 / 18.0, 3.0 / 18.0, 9.0 / 72.0, 11.0 / 72.0};
constexpr std::size_t kMostRays = 128;
constexpr double kSame = 1e-3;  // HU

double mix(double a, double b, double t) {
  return a + t * (b - a);
}

// The lowest of the eight voxels around a place within the grid.
std::size_t cornerOf(const Vec3& v, std::size_t row, std::size_t slice) {
  return std::size_t(int(v.z)) * slice + std::size_t(int(v.y)) * row + std::size_t(int(v.x));
}

// Trilinear, all eight voxels in the grid.
double sampleInside(const TissueField& tissue, std::size_t row, std::size_t slice, const Vec3& v) {
  const int i = int(v.x), j = int(v.y), k = int(v.z);  // none is negative
  const double tx = v.x - i, ty = v.y - j, tz = v.z - k;
  const std::size_t at = std::size_t(k) * slice + std::size_t(j) * row + std::size_t(i);
  const auto edge = [&](std::size_t n) { return mix(tissue.hu(n), tissue.hu(n + 1), tx); };
  return mix(mix(edge(at), edge(at + row), ty), mix(edge(at + slice), edge(at + slice + row), ty),
             tz);
}

// Trilinear anywhere: beyond the grid lies air.
double sampleAnywhere(const TissueField& tissue, const Vec3& v) {
  const auto below = [](double x) { return int(x) - (x < int(x) ? 1 : 0); };
  const int i = below(v.x), j = below(v.y), k = below(v.z);
  const Vec3 t = v - Vec3(i, j, k);
  double c[8];
  for (int n = 0; n < 8; ++n) c[n] = tissue.hu(i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
  return mix(mix(mix(c[0], c[1], t.x), mix(c[2], c[3], t.x), t.y),
             mix(mix(c[4], c[5], t.x), mix(c[6], c[7], t.x), t.y), t.z);
}

// What the sum asks of the tissue around the sphere. A sample is HU (and labels) at a place.
struct FieldOfHu {
  using Sample = double;
  using Stiffness = StiffnessOfHu;

  Sample sample(const Vec3& v) const {
    return inside ? sampleInside(tissue, row, slice, v) : sampleAnywhere(tissue, v);
  }
  bool isAir(Sample hu) const { return stiffness.isAir(hu); }
  double at(Sample hu) const { return stiffness.at(hu); }
  double mean(Sample a, Sample b) const { return stiffness.mean(a, b); }

  const TissueField& tissue;
  const Stiffness& stiffness;
  std::size_t row, slice;
  bool inside;  // all places that will be asked for lie within the grid
};

struct FieldOfLabels {
  // HU, and the share of each row of labels, over the voxels that hold anything.
  struct Sample {
    double hu = kAirHu;
    int count = 0;
    std::array<std::uint8_t, 8> row;
    std::array<double, 8> share;
  };
  using Stiffness = StiffnessByLabel;

  Sample sample(const Vec3& v) const {
    const auto below = [](double x) { return int(x) - (x < int(x) ? 1 : 0); };
    const int i = below(v.x), j = below(v.y), k = below(v.z);
    const Vec3 t = v - Vec3(i, j, k);
    Sample out;
    double sum = 0.0, held = 0.0;
    for (int n = 0; n < 8; ++n) {
      const int a = n & 1, b = n >> 1 & 1, c = n >> 2;
      if (!inside && !tissue.geometry().contains(i + a, j + b, k + c)) continue;
      const std::size_t voxel = tissue.geometry().indexOf(i + a, j + b, k + c);
      const std::int16_t hu = tissue.hu(voxel);
      const double share = (a ? t.x : 1.0 - t.x) * (b ? t.y : 1.0 - t.y) * (c ? t.z : 1.0 - t.z);
      if (hu == kAirHu || !(share > 0.0)) continue;
      sum += share * hu;
      held += share;
      const std::uint8_t label_row = stiffness.rowOf(tissue.label(voxel));
      int at = 0;
      while (at < out.count && out.row[std::size_t(at)] != label_row) ++at;
      if (at == out.count) {
        out.row[std::size_t(out.count)] = label_row;
        out.share[std::size_t(out.count++)] = 0.0;
      }
      out.share[std::size_t(at)] += share;
    }
    if (out.count > 0) out.hu = sum / held;
    return out;
  }
  bool isAir(const Sample& s) const {
    for (int n = 0; n < s.count; ++n) {
      if (!stiffness.ofRow(s.row[std::size_t(n)]).isAir(s.hu)) return false;
    }
    return true;
  }
  double at(const Sample& s) const {
    double sum = 0.0;
    for (int n = 0; n < s.count; ++n) {
      sum += s.share[std::size_t(n)] * stiffness.ofRow(s.row[std::size_t(n)]).at(s.hu);
    }
    return sum;
  }
  // Shares, too, run evenly from one place to the other.
  double mean(const Sample& a, const Sample& b) const {
    const double hu_a = a.count > 0 ? a.hu : b.hu, hu_b = b.count > 0 ? b.hu : a.hu;
    double sum = 0.0;
    for (const Sample* s : {&a, &b}) {
      for (int n = 0; n < s->count; ++n) {
        sum += s->share[std::size_t(n)] * stiffness.ofRow(s->row[std::size_t(n)]).mean(hu_a, hu_b);
      }
    }
    return 0.5 * sum;
  }

  const TissueField& tissue;
  const Stiffness& stiffness;
  std::size_t row, slice;
  bool inside;
};

// Evenly spread opposite pairs: a spiral of equal areas over the upper half, then 300 steps in
// which the directions repel each other as equal charges on a sphere do, since the spiral is denser
// along its axis.
std::vector<Vec3> oppositePairs(int count) {
  const int half = (count + 1) / 2;
  std::vector<Vec3> pairs;
  GoldenTurn turn;
  for (int i = 0; i < half; ++i, turn.next()) {
    const double z = (i + 0.5) / half, flat = std::sqrt(1.0 - z * z);
    pairs.push_back({flat * turn.cosine, flat * turn.sine, z});
  }
  constexpr int kSteps = 300;
  for (int step = 0; step < kSteps; ++step) {
    std::vector<Vec3> moved = pairs;
    for (int i = 0; i < half; ++i) {
      Vec3 push(0.0);
      for (int j = 0; j < half; ++j) {
        if (i == j) continue;
        for (double sign : {1.0, -1.0}) {
          const Vec3 away = pairs[std::size_t(i)] - sign * pairs[std::size_t(j)];
          const double d2 = glm::dot(away, away);
          push += away / (d2 * std::sqrt(d2));
        }
      }
      moved[std::size_t(i)] =
          glm::normalize(pairs[std::size_t(i)] + 0.5 / (half * std::sqrt(half)) * push);
    }
    pairs = moved;
  }
  std::vector<Vec3> out;
  for (const Vec3& d : pairs) {
    out.push_back(d);
    out.push_back(-d);
  }
  return out;
}

}  // namespace

void StiffnessOfHu::set(const TissueTable& tissues, int label) {
  double sum = 0.0;
  first_ = kLowest + kCount;
  for (int n = 0; n < kCount; ++n) {
    integral_[std::size_t(n)] = sum;
    const int found = classify(tissues, kLowest + n, label);
    if (found < 0) continue;
    first_ = std::min(first_, kLowest + n - 0.5);
    sum += tissues.classes[std::size_t(found)].stiffness_N_per_m;
  }
  integral_[kCount] = sum;
}

double StiffnessOfHu::at(double hu) const {
  const int n = int(std::clamp(hu - kLowest + 0.5, 0.0, double(kCount - 1)));
  return integral_[std::size_t(n) + 1] - integral_[std::size_t(n)];
}

double StiffnessOfHu::integral(double hu) const {
  const double x = std::clamp(hu - kLowest + 0.5, 0.0, double(kCount) - 1e-9);
  const int n = int(x);
  const double at = integral_[std::size_t(n)];
  return at + (x - n) * (integral_[std::size_t(n) + 1] - at);
}

double StiffnessOfHu::mean(double hu_a, double hu_b) const {
  if (hu_a < first_ && hu_b < first_) return 0.0;
  if (std::abs(hu_a - hu_b) < kSame) return at(hu_a);
  return (integral(hu_a) - integral(hu_b)) / (hu_a - hu_b);
}

ContactSphere::ContactSphere(const GridGeometry& geometry, double radius_mm, int directions)
    : patient_to_voxel_(geometry.patientToVoxel()), radius_m_(radius_mm / 1000.0), reach_(0.0) {
  for (const Vec3& d : oppositePairs(std::min(directions, int(kMostRays)))) {
    const Vec3 reach = d * radius_mm / geometry.spacing_mm;
    rays_.push_back({geometry.direction * d, reach});
    reach_ = glm::max(reach_, glm::abs(reach) * kRadii[kParts - 1]);
  }
}

ElasticPush ContactSphere::push(const TissueField& tissue,
                                const StiffnessOfHu& stiffness, const Vec3& centre_mm) const {
  return pushIn<FieldOfHu>(tissue, stiffness, centre_mm);
}

ElasticPush ContactSphere::push(const TissueField& tissue,
                                const StiffnessByLabel& stiffness, const Vec3& centre_mm) const {
  if (stiffness.oneForAll()) return push(tissue, stiffness.ofRow(0), centre_mm);
  return pushIn<FieldOfLabels>(tissue, stiffness, centre_mm);
}

template <class Field, class Stiffness>
ElasticPush ContactSphere::pushIn(const TissueField& tissue,
                                  const Stiffness& stiffness, const Vec3& centre_mm) const {
  ElasticPush out;
  const GridGeometry& g = tissue.geometry();
  const Vec3 centre = Vec3(patient_to_voxel_ * glm::dvec4(centre_mm, 1.0));
  const Vec3 low = centre - reach_, high = centre + reach_;
  if (!tissue.mayHold(low, high)) return out;
  const Vec3 size(g.size[0], g.size[1], g.size[2]);
  const bool inside = low.x >= 0.0 && low.y >= 0.0 && low.z >= 0.0 && high.x < size.x - 1.0 &&
                      high.y < size.y - 1.0 && high.z < size.z - 1.0;

  const auto row = std::size_t(g.size[0]);
  const std::size_t slice = row * std::size_t(g.size[1]);
  const Field field{tissue, stiffness, row, slice, inside};
  const auto at_centre = field.sample(centre);
  out.at_centre = field.at(at_centre);
  Vec3 sum(0.0);
  double energy = 0.0;
  const bool air_at_centre = field.isAir(at_centre);
  // In three rounds without branches among the look-ups, so that the loads of many rays overlap.
  std::array<std::array<typename Field::Sample, kParts>, kMostRays> met;
  if (inside) {
    for (const Ray& ray : rays_) {
      tissue.prefetch(cornerOf(centre + kRadii[3] * ray.reach, row, slice), row, slice);
      tissue.prefetch(cornerOf(centre + kRadii[1] * ray.reach, row, slice), row, slice);
    }
  }
  for (std::size_t n = 0; n < rays_.size(); ++n) {
    met[n][3] = field.sample(centre + kRadii[3] * rays_[n].reach);
    met[n][1] = field.sample(centre + kRadii[1] * rays_[n].reach);
  }
  std::array<std::uint8_t, kMostRays> meeting;
  std::size_t count = 0;
  for (std::size_t n = 0; n < rays_.size(); ++n) {
    // Air at the centre, at 2/3 and at 7/6 of the radius: such a ray is left out, though thinner
    // tissue may lie between.
    const bool air = air_at_centre && field.isAir(met[n][3]) && field.isAir(met[n][1]);
    meeting[count] = std::uint8_t(n);
    count += air ? 0 : 1;
  }
  for (std::size_t m = 0; m < count; ++m) {
    const std::size_t n = meeting[m];
    met[n][0] = field.sample(centre + kRadii[0] * rays_[n].reach);
    met[n][2] = field.sample(centre + kRadii[2] * rays_[n].reach);
  }
  for (std::size_t m = 0; m < count; ++m) {
    const std::size_t n = meeting[m];
    const auto* before = &at_centre;
    double along = 0.0, moment = 0.0, mean = 0.0;
    for (int part = 0; part < kParts; ++part) {
      mean = field.mean(*before, met[n][std::size_t(part)]);
      before = &met[n][std::size_t(part)];
      along += mean * kShare[part];
      moment += mean * kMoment[part];
      out.stiffness = std::max(out.stiffness, mean);
    }
    sum += rays_[n].direction * (along + mean);
    energy += moment;
  }
  out.stored_J = energy * 2.0 * radius_m_ * radius_m_ / double(rays_.size());
  out.force_N = sum * (-2.0 * radius_m_ / double(rays_.size()));
  return out;
}

}  // namespace trephine
