// Where the slices of one stack lie: order, spacing, tilt, and how a volume with right angles and
// even spacing comes of them. Pure: positions in, plan out. Thresholds: README.md of this room.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "imaging/report/report.h"

namespace trephine {

struct StackInput {
  int rows = 0, columns = 0;
  std::array<double, 2> pixel_spacing_mm{0.0, 0.0};  // as in DICOM: between rows, between columns
  std::array<double, 6> orientation{};               // row's cosines, then column's, in LPS
  std::vector<Vec3> positions_mm;                    // ImagePositionPatient of each slice
  std::vector<bool> usable;  // false: the place is known, the pixels are lost; empty: all usable
  std::string lost_text;     // which pixels are lost and why: ends the sentence on missing slices
  // As headers say it beside the positions; none: they do not.
  std::optional<double> spacing_between_mm{}, thickness_mm{};
  bool numbered_on = false;  // instance numbers run on without a break as the slices lie
};

// A slice of the volume: a mixture of two slices of the stack, mostly one of them alone.
struct SliceMixture {
  std::size_t lower = 0, upper = 0;  // in Stack::order
  double upper_share = 0.0;          // 0: lower alone
};

struct Stack {
  // Axes i = row direction, j = column direction, k = i x j, so it is always right-handed. Where
  // the stack is refused it is the geometry of the slices as they are, missing ones left out; one
  // slice has spacing 0 along k.
  GridGeometry geometry;
  std::vector<std::size_t> order;  // of the input's usable slices, in increasing place along k
  std::vector<double> places_mm;   // of the ordered slices along k
  // What each ordered slice is moved by along i and j, in voxels of the volume, none negative: all
  // zero but for sheared stacks.
  std::vector<std::array<double, 2>> shifts;
  std::vector<SliceMixture> slices;  // of the volume
  double tilt_deg = 0.0;             // between the line of positions and k
  // NOT_ORTHONORMAL, ONE_LOCATION, MISSING_SLICES, UNEVEN_SPACING, RESAMPLED_SPACING,
  // ROUNDED_POSITIONS, GANTRY_TILT, SHIFTED_SLICES
  std::vector<Finding> findings;
  std::vector<Choice> choices;

  bool sheared() const;
  bool oneToOne() const;  // slice k of the volume is the k-th of `order` alone
};

// The normal of an orientation, or nothing where it is not two perpendicular unit vectors.
std::optional<Mat3> axesOf(const std::array<double, 6>& orientation);

// Slices nearer to each other than this lie at one place.
constexpr double kSamePlace_mm = 0.01;

// "102.50 mm"
std::string placeText(double mm);
// A step or a thickness: "1.25 mm", "0.625 mm".
std::string lengthText(double mm);

// Adds the choice and says what was answered; its first option where nothing (or nonsense) was.
std::string ask(Choice choice, const Answers& answers, std::vector<Choice>& choices);

// The result is the same for any order of the input's positions. Of several slices at one place
// the first counts. All numbers must be finite and the spacings positive.
Stack stackSlices(const StackInput& input, const Answers& answers = {});

}  // namespace trephine
