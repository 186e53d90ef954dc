#include "case/placement.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/codes.h"
#include "base/tr.h"
#include "case/codes.h"
#include "exercise/codes.h"
#include "exercise/exercise_structures.h"

namespace trephine {

namespace {

constexpr double kReadShare = 0.9;  // of the work of opening; the rest is finding landmarks

// Where the case shows something else than the exercise is for.
std::optional<Warning> anatomyWarning(const Exercise& exercise,
                                      const std::optional<Anatomy>& anatomy) {
  if (!anatomy || anatomy->region == BodyRegion::not_sure) return {};
  if (exercise.anatomy != exerciseAnatomy(anatomy->region)) {
    const bool known = exercise.anatomy == "cranium" || exercise.anatomy == "abdomen";
    if (!known) return {};
    return Warning{code::kOtherAnatomy,
                   anatomy->region == BodyRegion::head
                       ? tr("The case shows a head, and the exercise is for the abdomen")
                       : tr("The case shows an abdomen, and the exercise is for the cranium")};
  }
  if (anatomy->region == BodyRegion::head && !anatomy->vault) {
    return Warning{
        code::kNoVault,
        tr("The case shows a head whose vault is not whole in the scan: the exercise may "
           "begin in another bone")};
  }
  return {};
}

// Where the rays of an exercise's landmarks meet the body, whatever it is of.
Result<std::vector<PlacedLandmark>> onBody(const Exercise& exercise, const Volume& volume,
                                           const Progress& progress) {
  Exercise on_body = exercise;
  for (Landmark& landmark : on_body.landmarks) landmark.tissue.clear();
  auto placed = placeLandmarks(on_body, volume, nullptr, progress);
  if (placed || placed.error().code == code::kCancelled) return placed;
  // A scan may be too thin for the ball that a landmark looks for, or be of an empty shell: towards
  // its middle, then, up to the first wall.
  constexpr double kWall_mm = 2.0;
  for (Landmark& landmark : on_body.landmarks) {
    if (landmark.bulk_radius_mm == 0.0) continue;
    landmark.bulk_radius_mm = 0.0;
    landmark.run_mm = std::min(landmark.run_mm, kWall_mm);
    landmark.towards = Vec3(0.5);
    landmark.from = landmark.towards + landmark.outward;
  }
  return placeLandmarks(on_body, volume, nullptr, progress);
}

// The exercise's landmarks. Where one has no place in the case: where their rays meet the body, and
// a warning says so, for an exercise is no dead end.
Result<std::vector<PlacedLandmark>> landmarksIn(const Exercise& exercise, Placement& of,
                                                const Progress& progress) {
  const Volume& volume = *of.patient.volume;
  auto placed = placeLandmarks(exercise, volume, of.labels.get(), progress);
  if (placed) return placed;
  const Code code = placed.error().code;
  if (code != code::kNoSurface && code != code::kTissueNotFound) return placed;
  if (std::ranges::min(volume.geometry.size) < 2) return placed;  // one slice is no body
  auto surface = onBody(exercise, volume, progress);
  if (!surface) return surface.error().code == code::kCancelled ? surface : placed;
  of.warnings.push_back({code::kNoLandmark, tr("The place where the exercise begins is not in the "
                                               "case ({}): it begins at the body's surface",
                                               placed.error().what)});
  return surface;
}

// With the tissues in force, and their labels.
Exercise withTissuesOf(Exercise exercise, const Placement& in) {
  if (in.elsewhere && exercise.tissues_elsewhere) {
    exercise.tissues = *std::exchange(exercise.tissues_elsewhere, {});
  }
  placeTissues(exercise.tissues, in.labels.get());
  return exercise;
}

}  // namespace

Exercise placedExercise(const Exercise& exercise, const Placement& in) {
  Exercise here = withTissuesOf(exercise, in);
  return in.error ? here : withFixedMaps(here, in.landmarks);
}

Result<Placement> place(const Exercise& exercise, Case patient, const Progress& progress,
                        const NameHider& hide) {
  progress.at(0.0, tr("Finding landmarks"));
  Placement placed;
  placed.patient = std::move(patient);
  placed.exercise = exercise;
  Case& of = placed.patient;
  const auto failed = [&](const Error& why) {
    placed.error = why;
    placed.exercise = placedExercise(exercise, placed);
    return std::move(placed);
  };
  if (!exercise.labels_file.empty() && (!of.structures || of.structures_built_in)) {
    Result<Case> labelled = withLabels(of, exercise.labels_file, Progress(), hide);
    if (!labelled) return failed(labelled.error());
    of = *std::move(labelled);
  }
  placed.labels = of.structures;
  auto structures = placeStructures(exercise, of.structures);
  if (!structures) return failed(structures.error());
  placed.labels = std::move(structures->labels);
  placed.elsewhere = structures->elsewhere;
  placed.warnings = of.structure_warnings;
  if (auto other = anatomyWarning(exercise, of.anatomy)) {
    placed.warnings.push_back(*std::move(other));
  }
  std::ranges::move(structures->warnings, std::back_inserter(placed.warnings));
  auto landmarks = landmarksIn(withTissuesOf(exercise, placed), placed, progress);
  if (!landmarks) {
    if (landmarks.error().code == code::kCancelled) return landmarks.error();
    return failed(landmarks.error());
  }
  placed.landmarks = *std::move(landmarks);
  placed.exercise = placedExercise(exercise, placed);
  return placed;
}

Result<Placement> openCase(const Exercise& exercise, const Progress& progress,
                           const NameHider& hide) {
  Result<Case> read = readCase(exercise.case_source, Progress(progress, 0.0, kReadShare));
  if (!read) return read.error();
  return place(exercise, *std::move(read), Progress(progress, kReadShare, 1.0), hide);
}

}  // namespace trephine
