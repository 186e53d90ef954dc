#include "ui/work/point_to_show.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ui/views/slice_plane.h"

namespace trephine {

namespace {

constexpr int kBodyHu = -300;  // fat and denser
constexpr double kShown = 1.0 / 3.0;

// Every so many voxels say enough of where something lies.
constexpr int kStep = 4;

// Across a slice, of that many voxels.
int stepOf(int voxels) {
  return std::clamp(voxels / 40, 4, 16);
}

// The voxel of the label that is nearest to the middle of all.
std::optional<Vec3> middleOf(const LabelMap& labels, int label) {
  const GridGeometry& g = labels.geometry;
  std::vector<Vec3> of_it;
  Vec3 sum(0.0);
  for (int k = 0; k < g.size[2]; k += kStep) {
    for (int j = 0; j < g.size[1]; j += kStep) {
      for (int i = 0; i < g.size[0]; i += kStep) {
        if (labels.labels[g.indexOf(i, j, k)] != label) continue;
        of_it.emplace_back(i, j, k);
        sum += of_it.back();
      }
    }
  }
  if (of_it.empty()) return {};
  const Vec3 middle = sum / double(of_it.size());
  return g.toPatient_mm(*std::ranges::min_element(of_it, {}, [&](const Vec3& at) {
    const Vec3 off = (at - middle) * g.spacing_mm;
    return glm::dot(off, off);
  }));
}

// How much of the body each slice across an axis shows.
std::vector<int> bodyBySlice(const Volume& volume, std::size_t axis) {
  const GridGeometry& g = volume.geometry;
  std::vector<int> shown(std::size_t(g.size[axis]), 0);
  Index3 step{stepOf(g.size[0]), stepOf(g.size[1]), stepOf(g.size[2])};
  step[axis] = 1;
  for (int k = 0; k < g.size[2]; k += step[2]) {
    for (int j = 0; j < g.size[1]; j += step[1]) {
      for (int i = 0; i < g.size[0]; i += step[0]) {
        if (volume.hu[g.indexOf(i, j, k)] < kBodyHu) continue;
        ++shown[std::size_t(std::array{i, j, k}[axis])];
      }
    }
  }
  return shown;
}

}  // namespace

std::optional<Vec3> pointToShow(const Placement& placed,
                                const std::optional<LandmarkFrame>& landmark) {
  const Landmark* of = placed.exercise.findLandmarkById(placed.exercise.view.landmark);
  if (landmark && of && of->is_place) return landmark->position_mm;
  bool missing = false;  // where the exercise would begin is known by nothing
  if (!placed.exercise.structures.empty()) {
    const Structure* needed =
        placed.labels ? placed.labels->find(placed.exercise.structures.front()) : nullptr;
    const auto middle = needed ? middleOf(*placed.labels, needed->label) : std::nullopt;
    if (middle) return middle;
    missing = true;
  }
  if (!landmark && !missing) return {};
  const GridGeometry& g = placed.patient.volume->geometry;
  Vec3 at = missing ? 0.5 * (Vec3(g.size[0], g.size[1], g.size[2]) - 1.0)
                    : toVoxel(g, landmark->position_mm);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<int> shown = bodyBySlice(*placed.patient.volume, axis);
    const double enough = kShown * *std::ranges::max_element(shown);
    const int last = int(shown.size()) - 1;
    const int wanted = std::clamp(int(std::lround(at[int(axis)])), 0, last);
    for (int far = 0; far <= last; ++far) {
      const auto shows = [&](int slice) {
        return slice >= 0 && slice <= last && shown[std::size_t(slice)] >= enough;
      };
      if (!shows(wanted - far) && !shows(wanted + far)) continue;
      if (far > 0) at[int(axis)] = shows(wanted - far) ? wanted - far : wanted + far;
      break;
    }
  }
  return g.toPatient_mm(at);
}

}  // namespace trephine
