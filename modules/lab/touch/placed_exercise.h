// Shipped exercises as measurements use them: placed in a case, with the arms that would move them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "lab/touch/touch_rig.h"
#include "exercise/exercise.h"

namespace trephine {

// The files' stems, without the two that are the seed paper's.
std::vector<std::string> shippedExercises();

struct PlacedExercise {
  Exercise exercise;  // maps fixed
  Rig rig;      // simulated arms, with their dynamics
  std::shared_ptr<const Volume> volume;
  std::shared_ptr<const LabelMap> labels;  // null: none
  std::vector<LandmarkFrame> frames;  // by arm: its landmark
};
// `case_source`: empty for the exercise's own. Errors: those of the exercise's files, case and
// devices.
Result<PlacedExercise> placeExercise(const std::string& name, const std::string& case_source,
                               const Progress& progress);

// Every tool's motor switched off, with a small journal.
HapticParameters withoutMotors(HapticParameters parameters);
Tool withoutMotor(const Tool& tool);

// The arm that a claim describes, held by a hand.
RigArm rigArmOf(const ArmDynamics& dynamics, const Impedance& hand);

// How far along a ray a tissue first runs for a millimetre, before any solid one but itself;
// nothing where it does not within `reach_mm`.
std::optional<double> depthOf(const Volume& volume, const TissueTable& tissues, int tissue_class,
                              const Vec3& from_mm, const Vec3& along, double reach_mm,
                              const LabelMap* labels = nullptr);

}  // namespace trephine
