#include "exercise/landmark.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "base/codes.h"
#include "base/tr.h"
#include "exercise/codes.h"

namespace trephine {

namespace {

struct Box {
  Vec3 low_mm{0.0}, high_mm{0.0};
  bool found = false;
};

constexpr double kBodyHu = -300.0;  // over it: half-way from air to fat and water
constexpr int kBody = -1;

// A tissue in a case, or the body (kBody): which places are of it.
struct Sought {
  const Volume& volume;
  const LabelMap* labels;
  TissueTable tissues;
  int tissue;
  const Progress& progress;

  // Called a few hundred times a landmark. False: give up.
  bool goOn(double fraction) const {
    progress.at(fraction, tr("Finding landmarks"));
    return !progress.cancelled();
  }
  bool in(double hu, std::uint8_t label) const {
    return tissue == kBody ? hu > kBodyHu : classify(tissues, hu, label) == tissue;
  }
  std::uint8_t label(int i, int j, int k) const {
    return labels ? labels->labels[volume.geometry.indexOf(i, j, k)] : 0;
  }
  // 0 outside the volume.
  std::uint8_t labelNear(const Vec3& at_mm) const {
    if (!labels) return 0;
    const GridGeometry& g = volume.geometry;
    const Vec3 v = glm::floor(Vec3(g.patientToVoxel() * glm::dvec4(at_mm, 1.0)) + 0.5);
    const bool inside = v.x >= 0.0 && v.y >= 0.0 && v.z >= 0.0 && v.x < g.size[0] &&
                        v.y < g.size[1] && v.z < g.size[2];
    return inside ? label(int(v.x), int(v.y), int(v.z)) : 0;
  }
};

// 1st to 99th percentile of the tissue's voxels along each patient axis, in bins of 1 mm. Every
// second voxel on each axis is looked at. Not found where it was cancelled.
Box tissueBox(const Sought& sought) {
  const Volume& volume = sought.volume;
  const GridGeometry& g = volume.geometry;
  const Vec3 centre_mm = g.centre_mm();
  const double half_mm = g.diagonal_mm() / 2.0 + 1.0;
  const auto bins = std::size_t(2.0 * half_mm) + 2;
  std::array<std::vector<std::uint32_t>, 3> counts;
  for (auto& axis : counts) axis.assign(bins, 0);
  const Mat4 affine = g.voxelToPatient();
  std::uint64_t total = 0;
  for (int k = 0; k < g.size[2]; k += 2) {
    if (!sought.goOn(double(k) / g.size[2])) return {};
    for (int j = 0; j < g.size[1]; j += 2) {
      for (int i = 0; i < g.size[0]; i += 2) {
        if (!sought.in(volume.at(i, j, k), sought.label(i, j, k))) continue;
        const Vec3 p = Vec3(affine * glm::dvec4(i, j, k, 1.0)) - centre_mm + half_mm;
        for (int axis = 0; axis < 3; ++axis) ++counts[std::size_t(axis)][std::size_t(p[axis])];
        ++total;
      }
    }
  }
  Box box;
  box.found = total > 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& c = counts[std::size_t(axis)];
    const std::uint64_t tail = total / 100;
    std::uint64_t seen = 0;
    std::size_t low = 0, high = bins - 1;
    while (low + 1 < bins && (seen += c[low]) <= tail) ++low;
    seen = 0;
    while (high > 0 && (seen += c[high]) <= tail) --high;
    box.low_mm[axis] = double(low) + centre_mm[axis] - half_mm;
    box.high_mm[axis] = double(high) + 1.0 + centre_mm[axis] - half_mm;
  }
  return box;
}

// The mean HU of the point and of six neighbours at `radius_mm`.
double meanHu(const Volume& volume, const Vec3& at_mm, double radius_mm) {
  double sum = sampleHu(volume, at_mm);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 step(0.0);
    step[axis] = radius_mm;
    sum += sampleHu(volume, at_mm + step) + sampleHu(volume, at_mm - step);
  }
  return sum / 7.0;
}

// The centre of the ball that holds most of the tissue: cells of a third of the radius, each judged
// by its mean HU and the label in its middle, then counted in boxes of the ball's size. Nothing
// where it was cancelled.
std::optional<Vec3> bulkOf(const Sought& sought, double radius_mm) {
  const Volume& volume = sought.volume;
  const GridGeometry& g = volume.geometry;
  Index3 stride{}, cells{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = std::size_t(axis);
    const double wide = std::min(radius_mm / 3.0 / g.spacing_mm[axis], double(g.size[a]));
    stride[a] = std::max(1, int(wide));
    cells[a] = g.size[a] / stride[a];
  }
  const auto cell = [&](int i, int j, int k) {
    return (std::size_t(k) * std::size_t(cells[1]) + std::size_t(j)) * std::size_t(cells[0]) +
           std::size_t(i);
  };
  std::vector<std::uint8_t> inside(std::size_t(cells[0]) * std::size_t(cells[1]) *
                                   std::size_t(cells[2]));
  for (int k = 0; k < cells[2]; ++k) {
    if (!sought.goOn(0.5 * k / cells[2])) return {};
    for (int j = 0; j < cells[1]; ++j) {
      for (int i = 0; i < cells[0]; ++i) {
        std::int64_t sum = 0;
        for (int c = 0; c < stride[2]; ++c) {
          for (int b = 0; b < stride[1]; ++b) {
            for (int a = 0; a < stride[0]; ++a) {
              sum += volume.at(i * stride[0] + a, j * stride[1] + b, k * stride[2] + c);
            }
          }
        }
        const double mean = double(sum) / (double(stride[0]) * stride[1] * stride[2]);
        const std::uint8_t label =
            sought.label(i * stride[0] + stride[0] / 2, j * stride[1] + stride[1] / 2,
                         k * stride[2] + stride[2] / 2);
        inside[cell(i, j, k)] = sought.in(mean, label);
      }
    }
  }
  constexpr int kReach = 3;  // cells; the radius
  int most = 0;
  std::optional<Vec3> centre;
  for (int k = kReach; k < cells[2] - kReach; ++k) {
    if (!sought.goOn(0.5 + 0.5 * k / cells[2])) return {};
    for (int j = kReach; j < cells[1] - kReach; ++j) {
      for (int i = kReach; i < cells[0] - kReach; ++i) {
        int count = 0;
        for (int c = -kReach; c <= kReach; ++c) {
          for (int b = -kReach; b <= kReach; ++b) {
            const std::uint8_t* row = &inside[cell(i - kReach, j + b, k + c)];
            for (int a = 0; a <= 2 * kReach; ++a) count += row[a];
          }
        }
        if (count <= most) continue;
        most = count;
        centre = g.toPatient_mm((Vec3(i, j, k) + 0.5) * Vec3(stride[0], stride[1], stride[2]) - 0.5);
      }
    }
  }
  return centre;
}

struct Ray {
  Vec3 from_mm, towards_mm;
  double run_mm;  // that it must stay in the tissue
};

std::string nameOf(const Landmark& landmark) {
  return landmark.tissue.empty() ? "a body" : tr("the tissue '{}'", landmark.tissue);
}

Result<Ray> rayOf(const Landmark& landmark, const Sought& sought) {
  const GridGeometry& g = sought.volume.geometry;
  const Error none{code::kTissueNotFound, tr("The case has no voxel of {}", nameOf(landmark)),
                   tr("landmark '{}'", landmark.id),
                   tr("Check the HU range and label, or choose a case of the scene's anatomy")};
  if (landmark.bulk_radius_mm > 0.0) {
    // A scan of a few slices has no room for the whole ball.
    for (const double part : {1.0, 0.5, 0.25}) {
      const std::optional<Vec3> centre = bulkOf(sought, part * landmark.bulk_radius_mm);
      if (centre) {
        return Ray{*centre + landmark.outward * g.diagonal_mm() / 2.0, *centre,
                   part * landmark.run_mm};
      }
      if (sought.progress.cancelled()) break;
    }
    return none;
  }
  const Box box = tissueBox(sought);
  if (!box.found) return none;
  const Vec3 extent_mm = box.high_mm - box.low_mm;
  return Ray{box.low_mm + landmark.from * extent_mm, box.low_mm + landmark.towards * extent_mm,
             landmark.run_mm};
}

constexpr double kMostAround_mm = 3.0;  // HU are averaged over no more

// The part of a ray near the volume, in mm from its start: beyond is air, however far the ray goes.
// Empty (begin > end) where it passes the volume by.
struct Stretch {
  double begin_mm, end_mm;
};
Stretch stretchOf(const GridGeometry& g, const Vec3& from_mm, const Vec3& along, double length_mm) {
  const double reach_mm = g.diagonal_mm() / 2.0 + glm::length(g.spacing_mm) + kMostAround_mm;
  const Vec3 to_centre_mm = g.centre_mm() - from_mm;
  const double nearest_mm = glm::dot(to_centre_mm, along);
  const double aside_mm = glm::length(to_centre_mm - nearest_mm * along);
  if (!(aside_mm <= reach_mm)) return {1.0, 0.0};
  const double half_mm = std::sqrt(reach_mm * reach_mm - aside_mm * aside_mm);
  return {std::max(0.0, nearest_mm - half_mm), std::min(length_mm, nearest_mm + half_mm)};
}

// The height from +reach down to -reach at which `inside` begins and lasts; what is inside from the
// very beginning has no surface there.
template <class Inside>
std::optional<double> surfaceHeight_mm(const Inside& inside, double reach_mm, double least_run_mm) {
  constexpr double kStep_mm = 0.25, kExact_mm = 0.02;
  double height_mm = reach_mm;
  while (height_mm > -reach_mm && inside(height_mm)) height_mm -= kStep_mm;
  double out_mm = height_mm, run_mm = 0.0;
  for (; height_mm >= -reach_mm; height_mm -= kStep_mm) {
    if (!inside(height_mm)) {
      out_mm = height_mm;
      run_mm = 0.0;
    } else if ((run_mm += kStep_mm) >= least_run_mm) {
      double in_mm = out_mm - kStep_mm;
      while (out_mm - in_mm > kExact_mm) {
        const double middle_mm = 0.5 * (in_mm + out_mm);
        (inside(middle_mm) ? in_mm : out_mm) = middle_mm;
      }
      return in_mm;
    }
  }
  return {};
}

}  // namespace

Quat frameAlong(const Vec3& outward) {
  const Vec3 z = glm::normalize(outward);
  const Vec3 superior(0, 0, 1), anterior(0, -1, 0);
  const Vec3 reference = std::abs(glm::dot(z, superior)) > 0.95 ? anterior : superior;
  const Vec3 y = glm::normalize(reference - glm::dot(reference, z) * z);
  return glm::normalize(glm::quat_cast(Mat3(glm::cross(y, z), y, z)));
}

Result<LandmarkFrame> findLandmark(const Landmark& landmark, const Volume& volume,
                                   const TissueSet& tissues, const LabelMap* labels,
                                   const Progress& progress) {
  const std::string where = tr("landmark '{}'", landmark.id);
  if (landmark.is_place) {
    const Vec3 at = Vec3(volume.geometry.patientToVoxel() * glm::dvec4(landmark.at_mm, 1.0));
    const Index3& size = volume.geometry.size;
    const Vec3 high = Vec3(size[0], size[1], size[2]) - 0.5;
    if (!glm::all(glm::greaterThanEqual(at, Vec3(-0.5))) || !glm::all(glm::lessThan(at, high))) {
      return Error{code::kNoPlace, tr("The place lies outside of the scan"), where,
                   tr("Give one inside, in the patient's frame (LPS, mm)")};
    }
    return LandmarkFrame{landmark.at_mm, frameAlong(landmark.outward)};
  }
  const Tissue* tissue = tissues.find(landmark.tissue);
  if (!tissue && !landmark.tissue.empty()) {
    return Error{code::kNoSuchTissue,
                 tr("The tissue '{}' is not in the tissue set", landmark.tissue), where,
                 tr("Name one of its tissues")};
  }
  const Sought sought{volume, labels, tissueTable(tissues),
                      tissue ? int(tissue - tissues.tissues.data()) : kBody, progress};
  const Result<Ray> ray = rayOf(landmark, sought);
  const Error cancelled{code::kCancelled, tr("Finding the landmarks was cancelled"), where, ""};
  if (progress.cancelled()) return cancelled;
  if (!ray) return ray.error();
  const auto [from_mm, towards_mm, least_run_mm] = *ray;
  const double length_mm = glm::length(towards_mm - from_mm);
  if (!(length_mm > 0.0)) {
    return Error{code::kNoSurface, tr("The ray has no direction"), where,
                 tr("Give two different points")};
  }
  const Vec3 along = (towards_mm - from_mm) / length_mm;
  constexpr double kStep_mm = 0.25;
  const double radius_mm = std::min(kMostAround_mm, least_run_mm / 4.0);
  const Stretch stretch = stretchOf(volume.geometry, from_mm, along, length_mm);
  double run_mm = 0.0;
  for (double at_mm = kStep_mm * std::floor(stretch.begin_mm / kStep_mm); at_mm <= stretch.end_mm;
       at_mm += kStep_mm) {
    if (progress.cancelled()) return cancelled;
    const Vec3 place_mm = from_mm + at_mm * along;
    const bool inside = sought.in(meanHu(volume, place_mm, radius_mm), sought.labelNear(place_mm));
    run_mm = inside ? run_mm + kStep_mm : 0.0;
    if (run_mm >= least_run_mm) {
      return LandmarkFrame{from_mm + (at_mm - run_mm + kStep_mm) * along, frameAlong(-along)};
    }
  }
  return Error{code::kNoSurface, tr("The ray does not meet {}", nameOf(landmark)), where,
               tr("Choose a case of the scene's anatomy, or another ray")};
}

std::vector<Vec3> ontoSurface(std::vector<Vec3> points_mm, const Vec3& outward, double reach_mm,
                              const Landmark& landmark, const Volume& volume,
                              const TissueSet& tissues, const LabelMap* labels) {
  const Tissue* tissue = tissues.find(landmark.tissue);
  if (!tissue) return points_mm;
  const Progress nobody;
  const Sought sought{volume, labels, tissueTable(tissues), int(tissue - tissues.tissues.data()),
                      nobody};
  const double least_run_mm = std::min(kSurfaceRun_mm, landmark.run_mm);
  const double radius_mm = std::min(kMostAround_mm, least_run_mm / 4.0);
  for (Vec3& point : points_mm) {
    const auto inside = [&](double height_mm) {
      const Vec3 at_mm = point + height_mm * outward;
      return sought.in(meanHu(volume, at_mm, radius_mm), sought.labelNear(at_mm));
    };
    if (const auto height_mm = surfaceHeight_mm(inside, reach_mm, least_run_mm)) {
      point += *height_mm * outward;
    }
  }
  return points_mm;
}

}  // namespace trephine
