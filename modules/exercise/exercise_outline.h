// A line on the tissue that shows where to work. For the eye alone: it is neither felt nor scored.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/math.h"
#include "exercise/landmark.h"

namespace trephine {

struct Exercise;
struct PlacedLandmark;

constexpr std::size_t kOutlinePoints = 256;
constexpr double kOutlineLength_mm = 2000.0;  // in all

struct ExerciseOutline {
  // The landmark by which it holds on other patients, and where that was when the points were
  // drawn.
  struct Frame {
    std::string landmark;
    LandmarkFrame at;
    bool operator==(const Frame&) const = default;
  };

  std::vector<Vec3> points_mm;  // patient frame; 2 to kOutlinePoints, joined by straight lines
  bool closed = false;          // the last is joined to the first
  double width_mm = 1.0;
  std::optional<Frame> frame;  // none: the points are of one patient
  bool operator==(const ExerciseOutline&) const = default;
};

ExerciseOutline readExerciseOutline(JsonReader outline);
Json toJson(const ExerciseOutline& outline);

// In the case in which the landmarks were placed: the points have gone with the frame's landmark,
// rigidly, and the frame is the landmark's there. The same where there is no frame; nothing where
// its landmark is not among those placed.
std::optional<ExerciseOutline> placedOutline(const ExerciseOutline& outline,
                                             const std::vector<PlacedLandmark>& landmarks);

// The exercise's outline as it is drawn on a case: points in patient mm at most kOutlineStep_mm
// apart along the line, each on the surface of the tissue that the frame's landmark names, as it is
// met from outside along the landmark's z; one below or above which there is no such surface within
// kOutlineReach_mm stays where it is, and so do all without a frame. Not closed by a point of its
// own. Empty where the exercise has none or its landmark has no place. `volume` is the case before
// it is cut, `labels` are fitted to it. Pure; a few milliseconds.
constexpr double kOutlineStep_mm = 1.0, kOutlineReach_mm = 25.0;
std::vector<Vec3> outlineOn(const Exercise& exercise, const std::vector<PlacedLandmark>& landmarks,
                            const Volume& volume, const LabelMap* labels = nullptr);

}  // namespace trephine
