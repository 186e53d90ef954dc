#include "imaging/series_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "imaging/text.h"

namespace trephine {

namespace {

constexpr double kSamePlace_mm = 0.01;
constexpr double kOrthonormal = 1e-3;  // headers round cosines to as few as four digits

double stepTolerance_mm(double step) {
  return std::max(0.01, 0.01 * step);
}

std::string placeText(double mm) {
  return fixedText(mm, 2) + " mm";
}

// Places along k, one per location, and how many slices lie at each.
struct Locations {
  std::vector<double> places_mm;
  std::vector<int> slices;
};

Locations locationsOf(const std::vector<double>& places) {
  Locations locations;
  double previous = 0.0;
  for (const double place : places) {
    if (locations.places_mm.empty() || place - previous > kSamePlace_mm) {
      locations.places_mm.push_back(place);
      locations.slices.push_back(0);
    }
    ++locations.slices.back();
    previous = place;
  }
  return locations;
}

void checkRepeats(const Locations& locations, std::vector<Finding>& findings) {
  const auto [least, most] = std::ranges::minmax(locations.slices);
  if (most == 1) return;
  Finding finding;
  finding.severity = "refusal";
  if (least == most) {
    finding.code = "PHASES";
    finding.text = "Every place holds " + std::to_string(most) +
                   " slices: phases or repeated acquisitions in one series";
    finding.action = "Export one phase as a series of its own";
  } else {
    finding.code = "DUPLICATE_POSITIONS";
    for (std::size_t i = 0; i < locations.slices.size(); ++i) {
      if (locations.slices[i] > 1) finding.slices.push_back(placeText(locations.places_mm[i]));
    }
    finding.text =
        std::to_string(finding.slices.size()) + " places hold more than one slice, others one";
    finding.action = "Remove the slices that do not belong to the scan";
  }
  findings.push_back(std::move(finding));
}

// Steps between locations against their median. Sets the geometry's spacing along k.
void checkSteps(const std::vector<double>& places, Stack& stack) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < places.size(); ++i) steps.push_back(places[i] - places[i - 1]);
  std::vector<double> sorted = steps;
  std::ranges::sort(sorted);
  const double median = sorted[(sorted.size() - 1) / 2];  // of two, the smaller: never a gap
  const auto off = [&](double step) { return std::abs(step - median); };
  if (std::ranges::all_of(steps, [&](double s) { return off(s) <= stepTolerance_mm(median); })) {
    stack.geometry.spacing_mm.z = (places.back() - places.front()) / double(steps.size());
    return;
  }
  stack.geometry.spacing_mm.z = median;

  Finding finding;
  finding.severity = "refusal";
  std::int64_t missing = 0;
  bool whole_multiples = true;
  for (std::size_t i = 0; i < steps.size() && whole_multiples; ++i) {
    const double multiple = std::max(1.0, std::round(steps[i] / median));
    const double tolerance = std::min(multiple * stepTolerance_mm(median), 0.1 * median);
    whole_multiples = std::abs(steps[i] - multiple * median) <= tolerance;
    if (!whole_multiples || multiple < 1.5) continue;
    const auto gap = static_cast<std::int64_t>(multiple) - 1;
    missing += gap;
    std::string text = placeText(places[i] + steps[i] / multiple);
    if (gap > 1) {
      text += " to " + placeText(places[i + 1] - steps[i] / multiple) + " (" + std::to_string(gap) +
              " slices)";
    }
    finding.slices.push_back(std::move(text));
  }
  if (whole_multiples) {
    finding.code = "MISSING_SLICES";
    finding.text = std::to_string(missing) + (missing == 1 ? " slice is" : " slices are") +
                   " missing from a stack with a step of " + placeText(median);
    finding.action = "Copy or export the series again; a gap is not filled without being asked";
  } else {
    finding.code = "UNEVEN_SPACING";
    finding.slices.clear();
    finding.text = "The steps between slices vary from " + fixedText(sorted.front(), 3) + " to " +
                   fixedText(sorted.back(), 3) + " mm (median " + fixedText(median, 3) + " mm)";
    finding.action = "Export the series with even spacing; resampling is not offered yet";
  }
  stack.findings.push_back(std::move(finding));
}

// How far each slice lies aside of the normal through the first one.
void checkSideways(const StackInput& input, const Vec3& normal, Stack& stack) {
  const Vec3 first = input.positions_mm[stack.order.front()];
  const Vec3 last = input.positions_mm[stack.order.back()];
  const auto sideways = [&](const Vec3& p) { return p - normal * glm::dot(p, normal); };
  const double length = glm::dot(last - first, normal);
  const Vec3 drift = sideways(last - first) / length;  // per mm along the normal
  stack.tilt_deg = std::atan(glm::length(drift)) * 180.0 / std::numbers::pi;

  const double tolerance_mm =
      std::max(0.05, 0.1 * std::min(input.pixel_spacing_mm[0], input.pixel_spacing_mm[1]));
  double worst = 0.0, worst_off_line = 0.0;
  for (const Vec3& position : input.positions_mm) {
    const Vec3 aside = sideways(position - first);
    const double along = glm::dot(position - first, normal);
    worst = std::max(worst, glm::length(aside));
    worst_off_line = std::max(worst_off_line, glm::length(aside - drift * along));
  }
  if (worst <= tolerance_mm) return;
  if (worst_off_line <= tolerance_mm) {
    stack.findings.push_back(
        {"GANTRY_TILT",
         "refusal",
         "The slices are sheared: the gantry was tilted by " + fixedText(stack.tilt_deg, 1) +
             " degrees",
         {},
         "Use a series reconstructed without tilt; straightening is not offered yet"});
  } else {
    stack.findings.push_back(
        {"SHIFTED_SLICES",
         "refusal",
         "Slices lie up to " + fixedText(worst_off_line, 2) + " mm aside of the stack's line",
         {},
         "Export the series again with one field of view"});
  }
}

}  // namespace

Stack stackSlices(const StackInput& input) {
  Stack stack;
  const auto& cosines = input.orientation;
  const Vec3 row(cosines[0], cosines[1], cosines[2]), column(cosines[3], cosines[4], cosines[5]);
  const std::size_t count = input.positions_mm.size();
  GridGeometry& geometry = stack.geometry;
  geometry.size = {input.columns, input.rows, static_cast<std::int32_t>(count)};
  geometry.spacing_mm = {input.pixel_spacing_mm[1], input.pixel_spacing_mm[0], 0.0};
  stack.order.resize(count);
  std::iota(stack.order.begin(), stack.order.end(), std::size_t{0});

  if (std::abs(glm::length(row) - 1.0) > kOrthonormal ||
      std::abs(glm::length(column) - 1.0) > kOrthonormal ||
      std::abs(glm::dot(row, column)) > kOrthonormal) {
    stack.findings.push_back({"NOT_ORTHONORMAL",
                              "refusal",
                              "The image orientation is not two perpendicular unit vectors",
                              {},
                              "Export the series again; its orientation is damaged"});
    return stack;
  }
  const Vec3 i_axis = glm::normalize(row);
  const Vec3 j_axis = glm::normalize(column - i_axis * glm::dot(i_axis, column));
  const Vec3 k_axis = glm::cross(i_axis, j_axis);
  geometry.direction = Mat3(i_axis, j_axis, k_axis);
  if (count == 0) return stack;

  const auto place = [&](std::size_t i) { return glm::dot(input.positions_mm[i], k_axis); };
  std::ranges::stable_sort(stack.order, {}, place);
  for (const std::size_t i : stack.order) stack.places_mm.push_back(place(i));
  geometry.origin_mm = input.positions_mm[stack.order.front()];

  const Locations locations = locationsOf(stack.places_mm);
  geometry.size[2] = static_cast<std::int32_t>(locations.places_mm.size());
  if (locations.places_mm.size() == 1) {
    stack.findings.push_back(
        {"ONE_LOCATION",
         "refusal",
         count == 1 ? "A single slice is not a volume"
                    : "All " + std::to_string(count) + " slices lie at one place: not a volume",
         {placeText(stack.places_mm.front())},
         "Choose a series that covers the anatomy"});
    return stack;
  }
  checkRepeats(locations, stack.findings);
  checkSteps(locations.places_mm, stack);
  checkSideways(input, k_axis, stack);
  return stack;
}

}  // namespace trephine
