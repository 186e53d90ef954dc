#include "imaging/series/detail/series_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "imaging/series/detail/series_steps.h"

namespace trephine {

namespace {

constexpr double kOrthonormal = 1e-3;  // headers round cosines to as few as four digits
constexpr double kWidestShift = 1.0;   // of the slice's own width: more is no sheared stack

// Slices that lie aside of the normal through the first: moved to where they belong.
void planSideways(const StackInput& input, const Mat3& axes, Stack& stack) {
  const Vec3 normal = axes[2];
  const Vec3 first = input.positions_mm[stack.order.front()];
  const Vec3 last = input.positions_mm[stack.order.back()];
  const auto sideways = [&](const Vec3& p) { return p - normal * glm::dot(p, normal); };
  const double length = glm::dot(last - first, normal);
  const Vec3 drift = length > 0.0 ? sideways(last - first) / length : Vec3(0.0);  // mm per mm
  stack.tilt_deg = std::atan(glm::length(drift)) * 180.0 / std::numbers::pi;

  const Vec3 spacing = stack.geometry.spacing_mm;
  const double tolerance_mm = std::max(0.05, 0.1 * std::min(spacing.x, spacing.y));
  double worst = 0.0, worst_off_line = 0.0;
  std::array<double, 2> low{0.0, 0.0}, high{0.0, 0.0};
  stack.shifts.clear();
  for (const std::size_t n : stack.order) {
    const Vec3 aside = sideways(input.positions_mm[n] - first);
    const double along = glm::dot(input.positions_mm[n] - first, normal);
    worst = std::max(worst, glm::length(aside));
    worst_off_line = std::max(worst_off_line, glm::length(aside - drift * along));
    stack.shifts.push_back(
        {glm::dot(aside, axes[0]) / spacing.x, glm::dot(aside, axes[1]) / spacing.y});
    for (std::size_t axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], stack.shifts.back()[axis]);
      high[axis] = std::max(high[axis], stack.shifts.back()[axis]);
    }
  }
  if (worst <= tolerance_mm) {
    stack.shifts.assign(stack.order.size(), {0.0, 0.0});
    return;
  }
  const bool on_a_line = worst_off_line <= tolerance_mm;
  // A gantry tilts about the images' rows: its shear runs along their columns.
  const bool tilted = std::abs(glm::dot(drift, axes[0])) <= 0.1 * glm::length(drift);
  const std::string angle = fixedText(stack.tilt_deg, 1) + " degrees";
  const std::string text =
      !on_a_line
          ? tr("Slices lie up to {} mm aside of the stack's line", fixedText(worst_off_line, 2))
      : tilted ? tr("The slices are sheared: the gantry was tilted by {}", angle)
               : tr("The slices are sheared sideways, by {}, as no gantry tilts", angle);
  Code code = !on_a_line ? code::kShiftedSlices
              : tilted   ? code::kGantryTilt
                         : code::kShearedSideways;
  const double widest =
      std::max((high[0] - low[0]) / input.columns, (high[1] - low[1]) / input.rows);
  if (!(widest <= kWidestShift)) {
    stack.shifts.assign(stack.order.size(), {0.0, 0.0});
    stack.findings.push_back({code,
                              Severity::refusal,
                              text,
                              {},
                              tr("The slices lie farther apart sideways than they are wide: use "
                                 "another series")});
    return;
  }
  // The volume grows by whole voxels, so that the first slice stays on its own grid.
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double before = std::floor(low[axis] + 1e-6), after = std::ceil(high[axis] - 1e-6);
    for (auto& shift : stack.shifts) shift[axis] -= before;
    stack.geometry.size[axis] += std::int32_t(after - before);
    stack.geometry.origin_mm += axes[int(axis)] * (before * spacing[int(axis)]);
  }
  stack.findings.push_back(
      {code,
       Severity::repair,
       text,
       {},
       tr("{}, each slice shifted as its position says; new corners are air, and fine detail is "
          "slightly blurred within slices",
          on_a_line ? tr("They were straightened") : tr("They were moved to where they belong"))});
}

}  // namespace

bool Stack::sheared() const {
  return std::ranges::any_of(shifts, [](const auto& s) { return s[0] != 0.0 || s[1] != 0.0; });
}

bool Stack::oneToOne() const {
  if (slices.size() != order.size()) return false;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    if (slices[k].lower != k || slices[k].upper != k) return false;
  }
  return true;
}

std::string placeText(double mm) {
  return fixedText(mm, 2) + " mm";
}

std::string lengthText(double mm) {
  const bool hundredths = std::abs(100.0 * mm - std::round(100.0 * mm)) < 0.05;
  return fixedText(mm, hundredths ? 2 : 3) + " mm";
}

std::string ask(Choice choice, const Answers& answers, std::vector<Choice>& choices) {
  std::string answer = choice.options.front();
  const auto given = answers.find(choice.code);
  if (given != answers.end() &&
      std::ranges::find(choice.options, given->second) != choice.options.end()) {
    answer = given->second;
  }
  choices.push_back(std::move(choice));
  return answer;
}

std::optional<Mat3> axesOf(const std::array<double, 6>& cosines) {
  const Vec3 row(cosines[0], cosines[1], cosines[2]), column(cosines[3], cosines[4], cosines[5]);
  if (!(std::abs(glm::length(row) - 1.0) <= kOrthonormal) ||
      !(std::abs(glm::length(column) - 1.0) <= kOrthonormal) ||
      !(std::abs(glm::dot(row, column)) <= kOrthonormal)) {
    return std::nullopt;
  }
  const Vec3 i_axis = glm::normalize(row);
  const Vec3 j_axis = glm::normalize(column - i_axis * glm::dot(i_axis, column));
  return Mat3(i_axis, j_axis, glm::cross(i_axis, j_axis));
}

Stack stackSlices(const StackInput& input, const Answers& answers) {
  Stack stack;
  const std::size_t count = input.positions_mm.size();
  GridGeometry& geometry = stack.geometry;
  geometry.size = {input.columns, input.rows, static_cast<std::int32_t>(count)};
  geometry.spacing_mm = {input.pixel_spacing_mm[1], input.pixel_spacing_mm[0], 0.0};
  stack.order.resize(count);
  std::iota(stack.order.begin(), stack.order.end(), std::size_t{0});

  const auto axes = axesOf(input.orientation);
  if (!axes) {
    stack.findings.push_back({code::kNotOrthonormal,
                              Severity::refusal,
                              tr("The image orientation is not two perpendicular unit vectors"),
                              {},
                              tr("Export the series again; its orientation is damaged")});
    return stack;
  }
  geometry.direction = *axes;
  if (count == 0) return stack;

  Slices slices;
  for (std::size_t n = 0; n < count; ++n) {
    slices.push_back(
        {n, glm::dot(input.positions_mm[n], (*axes)[2]), input.usable.empty() || input.usable[n]});
  }
  std::ranges::stable_sort(slices, {}, &Slice::place_mm);
  // The first of several at one place, but a usable one where there is one.
  Slices places;
  double previous = 0.0;
  for (const Slice& slice : slices) {
    if (places.empty() || slice.place_mm - previous > kSamePlace_mm) {
      places.push_back(slice);
    } else if (!places.back().usable && slice.usable) {
      places.back() = slice;
    }
    previous = slice.place_mm;
  }
  geometry.origin_mm = input.positions_mm[places.front().input];
  if (places.size() == 1) {
    geometry.size[2] = 1;
    if (!places.front().usable) {
      stack.findings.push_back({code::kMissingSlices,
                                Severity::refusal,
                                tr("The slice is missing{}", input.lost_text),
                                {},
                                tr("Copy the file again from its source")});
    }
    stack.places_mm.assign(count, places.front().place_mm);
    stack.findings.push_back(
        {code::kOneLocation,
         Severity::refusal,
         count == 1 ? tr("A single slice is not a volume")
                    : tr("All {} slices lie at one place: not a volume", count),
         {placeText(places.front().place_mm)},
         count == 1 ? tr("Choose a series that covers the anatomy; if other slices lie beside this "
                         "file, open their folder")
                    : tr("Choose a series that covers the anatomy")});
    return stack;
  }
  planAlongNormal(places, input, (*axes)[2], answers, stack);
  if (stack.order.empty()) return stack;
  geometry.origin_mm = input.positions_mm[stack.order.front()];
  planSideways(input, *axes, stack);
  return stack;
}

}  // namespace trephine
