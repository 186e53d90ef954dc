#include "imaging/dicom/detail/frame_stack.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/codes.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"

namespace trephine {

namespace {

constexpr double kUnit = 1e-3;          // lengths and the product of an orientation's two vectors
constexpr double kSameAxes = 1e-4;      // cosines of two frames
constexpr double kSameSpacing = 1e-3;   // as a share
constexpr double kSamePlace_mm = 0.01;  // along the normal
constexpr double kStraight_mm = 0.05;   // beside it, or a tenth of a pixel
constexpr double kFarthest_mm = 1e6;
constexpr double kFinest_mm = 1e-3, kCoarsest_mm = 1e3;  // of a pixel
constexpr double kEven = 0.01, kNearlyEven = 0.1;        // of a step
constexpr double kMostSlices = 8192;

Error framesDiffer(const std::string& what) {
  return Error{code::kFramesDiffer, what, "",
               tr("Export it on the grid of the CT that it was made from")};
}

bool isSensible(double spacing_mm) {
  return spacing_mm >= kFinest_mm && spacing_mm <= kCoarsest_mm;  // false for NaN
}

std::optional<Mat3> axesOf(const std::array<double, 6>& o) {
  const Vec3 row(o[0], o[1], o[2]), column(o[3], o[4], o[5]);
  const bool unit = std::abs(glm::length(row) - 1.0) <= kUnit &&
                    std::abs(glm::length(column) - 1.0) <= kUnit &&
                    std::abs(glm::dot(row, column)) <= kUnit;  // false for NaN
  if (!unit) return std::nullopt;
  const Vec3 i = glm::normalize(row), k = glm::normalize(glm::cross(row, column));
  return Mat3(i, glm::cross(k, i), k);
}

std::string frameName(std::size_t n) {
  return tr("Frame {}", n + 1);
}

Status checkAlike(const std::vector<FramePlane>& frames) {
  const FramePlane& first = frames.front();
  for (std::size_t n = 0; n < frames.size(); ++n) {
    const FramePlane& frame = frames[n];
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(frame.position_mm[axis]) <= kFarthest_mm)) {
        return noGeometry(tr("{} lies nowhere near a patient", frameName(n)));
      }
    }
    for (std::size_t i = 0; i < frame.orientation.size(); ++i) {
      if (!(std::abs(frame.orientation[i] - first.orientation[i]) <= kSameAxes)) {
        return framesDiffer(tr("{} is turned against the first", frameName(n)));
      }
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const double ratio = frame.pixel_spacing_mm[i] / first.pixel_spacing_mm[i];
      if (!(std::abs(ratio - 1.0) <= kSameSpacing)) {
        return framesDiffer(tr("{} has pixels of another size than the first", frameName(n)));
      }
    }
  }
  return {};
}

// Whole steps from each place to the next; nothing where one is off by more than a share of a step.
std::optional<std::vector<int>> stepsOf(const std::vector<double>& gaps_mm, double step_mm,
                                        double share = kNearlyEven) {
  std::vector<int> steps;
  for (const double gap : gaps_mm) {
    const double whole = std::round(gap / step_mm);
    if (!(whole >= 1.0) || whole > kMostSlices ||
        std::abs(gap - whole * step_mm) > std::max(share * step_mm, kSamePlace_mm)) {
      return std::nullopt;
    }
    steps.push_back(int(whole));
  }
  return steps;
}

// The step that explains all gaps. A stated one that fits well does, be it finer than any gap: all
// other slices may be without frames. Else the gaps that are next to the smallest are single steps,
// or two, or three.
std::optional<double> stepOf(const std::vector<double>& gaps_mm, std::optional<double> between_mm,
                             std::optional<double> thickness_mm) {
  const double smallest = std::ranges::min(gaps_mm);
  const auto stated = [&](std::optional<double> step) {
    return step && isSensible(*step) && stepsOf(gaps_mm, *step, kEven);
  };
  if (stated(between_mm)) return between_mm;
  std::vector<double> single;
  for (const double gap : gaps_mm) {
    if (gap < 1.5 * smallest) single.push_back(gap);
  }
  std::ranges::nth_element(single, single.begin() + std::ptrdiff_t(single.size() / 2));
  const double median = single[single.size() / 2];
  if (stepsOf(gaps_mm, median)) return median;
  if (stated(thickness_mm)) return thickness_mm;
  for (const double parts : {2.0, 3.0}) {
    if (stepsOf(gaps_mm, median / parts, kEven)) return median / parts;
  }
  return std::nullopt;
}

// Frames beside the normal through the lowest: all on a line from it to the highest, as a tilted
// gantry leaves them, or FRAMES_DIFFER. `offsets_mm` of each, along the axes of the grid.
Status planSideways(const std::vector<Vec3>& offsets_mm, const Vec3& lowest_mm,
                    const Vec3& highest_mm, FrameStack& stack) {
  GridGeometry& grid = stack.geometry;
  stack.shifts.assign(offsets_mm.size(), {0, 0});
  const double height_mm = highest_mm.z - lowest_mm.z;
  bool straight = true, on_line = true;
  std::size_t farthest = 0;
  double most_mm = 0.0;
  for (std::size_t n = 0; n < offsets_mm.size(); ++n) {
    const Vec3 aside = offsets_mm[n] - lowest_mm;
    const double share = height_mm > 0.0 ? aside.z / height_mm : 0.0;
    for (int axis = 0; axis < 2; ++axis) {
      const double most = std::max(kStraight_mm, 0.1 * grid.spacing_mm[axis]);
      straight &= std::abs(aside[axis]) <= most;
      on_line &= std::abs(aside[axis] - share * (highest_mm - lowest_mm)[axis]) <= most;
      if (std::abs(aside[axis]) <= most_mm) continue;
      most_mm = std::abs(aside[axis]);
      farthest = n;
    }
  }
  if (straight) return {};
  const Vec3 width_mm(grid.size[0] * grid.spacing_mm.x, grid.size[1] * grid.spacing_mm.y, 0.0);
  const Vec3 drift_mm = glm::abs(highest_mm - lowest_mm);
  if (!on_line || drift_mm.x > width_mm.x || drift_mm.y > width_mm.y) {
    return framesDiffer(tr("{} is shifted aside of the first by {} mm", frameName(farthest),
                           fixedText(most_mm, 2)));
  }
  for (int axis = 0; axis < 2; ++axis) {
    const auto at = std::size_t(axis);
    int least = 0, most = 0;
    for (std::size_t n = 0; n < offsets_mm.size(); ++n) {
      const double pixels = (offsets_mm[n] - lowest_mm)[axis] / grid.spacing_mm[axis];
      stack.shifts[n][at] = int(std::round(pixels));
      least = std::min(least, stack.shifts[n][at]);
      most = std::max(most, stack.shifts[n][at]);
    }
    for (auto& shift : stack.shifts) shift[at] -= least;
    grid.size[at] += most - least;
    grid.origin_mm += grid.direction[axis] * (double(least) * grid.spacing_mm[axis]);
  }
  stack.notes.push_back(
      tr("The frames lie along the axis of a tilted gantry: each was moved by whole pixels."));
  return {};
}

}  // namespace

Result<FrameStack> stackFrames(const std::vector<FramePlane>& frames, int columns, int rows,
                               std::optional<double> between_mm,
                               std::optional<double> thickness_mm) {
  const FramePlane& first = frames.front();
  const std::optional<Mat3> axes = axesOf(first.orientation);
  if (!axes) return noGeometry(tr("The frames' orientation is not two perpendicular unit vectors"));
  for (const double spacing : first.pixel_spacing_mm) {
    if (!isSensible(spacing)) return noGeometry(tr("The pixel spacing of the frames is no length"));
  }
  if (const Status alike = checkAlike(frames); !alike) return alike.error();

  // Places along the normal, and what lies beside it.
  const Vec3 pixel_mm(first.pixel_spacing_mm[1], first.pixel_spacing_mm[0], 0.0);
  std::vector<double> places(frames.size());
  std::vector<Vec3> offsets(frames.size());
  for (std::size_t n = 0; n < frames.size(); ++n) {
    offsets[n] = glm::transpose(*axes) * (frames[n].position_mm - first.position_mm);
    places[n] = offsets[n].z;
  }

  std::vector<std::size_t> order(frames.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::ranges::stable_sort(order, {}, [&](std::size_t n) { return places[n]; });
  std::vector<std::size_t> place_of(frames.size());  // the number of its place, from the lowest
  std::vector<double> unlike{places[order.front()]};
  for (const std::size_t n : order) {
    if (places[n] - unlike.back() > kSamePlace_mm) unlike.push_back(places[n]);
    place_of[n] = unlike.size() - 1;
  }

  FrameStack stack;
  stack.slices.assign(frames.size(), 0);
  double step = 0.0;
  int last = 0;
  if (unlike.size() == 1) {
    const bool between = between_mm && isSensible(*between_mm);
    const bool thick = thickness_mm && isSensible(*thickness_mm);
    if (!between && !thick) {
      return noGeometry(tr("All frames lie at one place, and none says how thick it is"));
    }
    step = between ? *between_mm : *thickness_mm;
  } else {
    std::vector<double> gaps;
    for (std::size_t n = 1; n < unlike.size(); ++n) gaps.push_back(unlike[n] - unlike[n - 1]);
    const auto around = stepOf(gaps, between_mm, thickness_mm);
    const auto steps = around ? stepsOf(gaps, *around) : std::nullopt;
    std::vector<int> slice_of{0};
    double total = 0.0;
    if (steps) {
      for (const int whole : *steps) {
        total += whole;
        slice_of.push_back(int(std::min(total, kMostSlices)));
      }
      if (total >= kMostSlices) {
        return Error{code::kTooLarge, tr("The frames span more than 8192 slices"), "", ""};
      }
      last = slice_of.back();
      step = (unlike.back() - unlike.front()) / last;
    }
    double worst = 0.0;
    for (std::size_t n = 0; steps && n < unlike.size(); ++n) {
      worst = std::max(worst, std::abs(unlike[n] - unlike.front() - slice_of[n] * step));
    }
    if (!steps || worst > kNearlyEven * step) {
      return Error{code::kUnevenSpacing, tr("The frames do not lie at even steps"), "",
                   tr("Export it on the grid of the CT that it was made from")};
    }
    if (worst > std::max(kSamePlace_mm, kEven * step)) {
      stack.notes.push_back(tr("Slices lie up to {} mm beside even steps, and were put on them.",
                               fixedText(worst, 2)));
    }
    for (std::size_t n = 0; n < frames.size(); ++n) stack.slices[n] = slice_of[place_of[n]];
  }
  stack.geometry = {{columns, rows, last + 1},
                    {pixel_mm.x, pixel_mm.y, step},
                    frames[order.front()].position_mm,
                    *axes};
  if (Status aside = planSideways(offsets, offsets[order.front()], offsets[order.back()], stack);
      !aside) {
    return aside.error();
  }
  if (const Status size = checkSize(stack.geometry.size, ""); !size) {
    return Error{code::kTooLarge, size.error().what, "", ""};
  }
  return stack;
}

Error noGeometry(const std::string& what) {
  return Error{code::kNoGeometry, what, "",
               tr("Export the segmentation anew from the program that made it")};
}

}  // namespace trephine
