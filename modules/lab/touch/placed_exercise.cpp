#include "lab/touch/placed_exercise.h"

#include <cmath>
#include <utility>

#include "base/system.h"
#include "case/codes.h"
#include "case/placement.h"
#include "exercise/arm_limits.h"
#include "session/arm_devices.h"

namespace trephine {

std::vector<std::string> shippedExercises() {
  return {"burr-hole", "cranium", "cranium-one-arm", "liver", "liver-one-arm"};
}

Result<PlacedExercise> placeExercise(const std::string& name, const std::string& case_source,
                                     const Progress& progress) {
  Result<Exercise> exercise = readExercise(resourceFolder() / "scenes" / (name + ".json"));
  if (!exercise) return exercise.error();
  Rig rig = simulatedRig(*exercise);
  if (Status asked = readArmDynamics(*exercise, rig); !asked) return asked.error();
  for (std::size_t i = 0; i < exercise->arms.size(); ++i) {
    exercise->arms[i].max_force_N = mostForce_N(exercise->arms[i], rig.arms[i].dynamics);
  }
  if (!case_source.empty()) exercise = onCase(*std::move(exercise), case_source);
  const Result<Placement> of = openCase(*exercise, progress);
  if (!of) return of.error();
  if (of->error) return *of->error;
  for (const Warning& warning : of->warnings) {
    if (warning.code != code::kNoLandmark) continue;  // a figure would be of another place
    return Error{warning.code, warning.text, "scene '" + name + "'",
                 "Choose a case of the scene's anatomy"};
  }
  return PlacedExercise{of->exercise, std::move(rig), of->patient.volume, of->labels,
                        armFrames(of->exercise, of->landmarks)};
}

Tool withoutMotor(const Tool& tool) {
  Tool off = tool;
  off.made_from.motor_W = 0.0;
  return off;
}

HapticParameters withoutMotors(HapticParameters parameters) {
  for (ArmParameters& arm : parameters.arms) arm.tool = withoutMotor(arm.tool);
  parameters.journal_voxels = 1 << 20;
  parameters.journal_seconds = 4096;
  return parameters;
}

RigArm rigArmOf(const ArmDynamics& dynamics, const Impedance& hand) {
  RigArm arm;
  arm.mass_kg = dynamics.apparent_mass_kg;
  arm.encoder_m = dynamics.encoder_step_m;
  arm.hand = hand;
  return arm;
}

std::optional<double> depthOf(const Volume& volume, const TissueTable& tissues, int tissue_class,
                              const Vec3& from_mm, const Vec3& along, double reach_mm,
                              const LabelMap* labels) {
  constexpr double kStep_mm = 0.1, kRun_mm = 1.0;
  const Mat4 to_voxel = volume.geometry.patientToVoxel();
  double run_mm = 0.0, solid_mm = 0.0;
  for (double way_mm = 0.0; way_mm < reach_mm; way_mm += kStep_mm) {
    const Vec3 v = glm::round(Vec3(to_voxel * glm::dvec4(from_mm + way_mm * along, 1.0)));
    const int i = int(v.x), j = int(v.y), k = int(v.z);
    int c = -1;
    if (volume.geometry.contains(i, j, k)) {
      const std::uint8_t label = labels ? labels->labels[volume.geometry.indexOf(i, j, k)] : 0;
      c = classify(tissues, volume.at(i, j, k), label);
    }
    run_mm = c == tissue_class ? run_mm + kStep_mm : 0.0;
    if (run_mm >= kRun_mm) return way_mm - run_mm + kStep_mm;
    const bool solid = c >= 0 && tissues.classes[std::size_t(c)].solid;
    solid_mm = solid ? solid_mm + kStep_mm : 0.0;
    if (solid_mm >= kRun_mm && c != tissue_class) return {};
  }
  return {};
}

}  // namespace trephine
