#include "exercise/exercise.h"

#include <algorithm>
#include <utility>

#include "base/tr.h"
#include "exercise/codes.h"

namespace trephine {

const ExerciseTool* Exercise::findTool(const std::string& id) const {
  auto it = std::find_if(tools.begin(), tools.end(), [&](const auto& t) { return t.id == id; });
  return it == tools.end() ? nullptr : &*it;
}

const ExerciseTool* Exercise::toolOf(std::size_t arm, std::size_t number) const {
  if (number == 0) return findTool(arms[arm].tool);
  const std::vector<std::string>& others = arms[arm].other_tools;
  return number <= others.size() ? findTool(others[number - 1]) : nullptr;
}

const Landmark* Exercise::findLandmarkById(const std::string& id) const {
  auto it =
      std::find_if(landmarks.begin(), landmarks.end(), [&](const auto& l) { return l.id == id; });
  return it == landmarks.end() ? nullptr : &*it;
}

const CardText* cardFor(const Exercise& exercise, std::string_view language) {
  if (!exercise.card) return nullptr;
  const bool other = language == "zh_TW" && exercise.card->zh_TW;
  return other ? &*exercise.card->zh_TW : &exercise.card->en;
}

Exercise onCase(Exercise exercise, const std::string& case_source) {
  if (case_source == exercise.case_source) return exercise;
  if (!exercise.case_source.empty()) {
    exercise.labels_file.clear();
    if (exercise.outline && !exercise.outline->frame) exercise.outline.reset();
    const bool by_number = std::ranges::any_of(exercise.tissues.tissues, [](const Tissue& tissue) {
      return tissue.label && tissue.structure.empty();
    });
    if (exercise.tissues_elsewhere && by_number) {
      exercise.tissues = *std::exchange(exercise.tissues_elsewhere, {});
    }
  }
  exercise.case_source = case_source;
  return exercise;
}

Status checkLabels(const TissueSet& tissues, const LabelMap* labels) {
  for (const Tissue& tissue : tissues.tissues) {
    if (!tissue.label || !tissue.structure.empty() || labels) continue;
    return Error{code::kNoLabels,
                 tr("The tissue '{}' is restricted to label {}, and no label map was given",
                    tissue.id, *tissue.label),
                 tr("the label map"),
                 tr("Give the case's label map, or free the tissue from its label")};
  }
  return {};
}

Result<std::vector<PlacedLandmark>> placeLandmarks(const Exercise& exercise, const Volume& volume,
                                                   const LabelMap* labels,
                                                   const Progress& progress) {
  if (Status known = checkLabels(exercise.tissues, labels); !known) return known.error();
  std::vector<PlacedLandmark> placed;
  const double share = 1.0 / double(exercise.landmarks.size());
  for (const Landmark& landmark : exercise.landmarks) {
    const double done = share * double(placed.size());
    Result<LandmarkFrame> frame = findLandmark(landmark, volume, exercise.tissues, labels,
                                               Progress(progress, done, done + share));
    if (!frame) return frame.error();
    placed.push_back({landmark.id, *frame});
  }
  return placed;
}

Exercise withFixedMaps(const Exercise& exercise, const std::vector<PlacedLandmark>& landmarks) {
  Exercise fixed = exercise;
  for (ExerciseArm& arm : fixed.arms) {
    if (arm.map.fixed) continue;
    for (const PlacedLandmark& landmark : landmarks) {
      if (landmark.id != arm.map.landmark) continue;
      arm.map.fixed = WorkspaceMap{landmark.frame.toPatient_mm(arm.map.offset_mm),
                                   landmark.frame.rotation, arm.map.motion_scale,
                                   arm.map.force_scale};
    }
  }
  if (fixed.outline) fixed.outline = placedOutline(*fixed.outline, landmarks);
  return fixed;
}

std::vector<LandmarkFrame> armFrames(const Exercise& exercise,
                                     const std::vector<PlacedLandmark>& landmarks) {
  std::vector<LandmarkFrame> frames(exercise.arms.size());
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    for (const PlacedLandmark& landmark : landmarks) {
      if (landmark.id == exercise.arms[i].map.landmark) frames[i] = landmark.frame;
    }
  }
  return frames;
}

Renderable renderableOn(const ExerciseArm& arm, const std::optional<ArmDynamics>& known,
                        double rate_hz) {
  const ArmDynamics dynamics = known.value_or(ArmDynamics{});
  WorkspaceMap map;
  map.motion_scale = arm.map.motion_scale;
  map.force_scale = arm.map.force_scale;
  return renderable(dynamics, rate_hz, delaySamples(dynamics, 1.0 / rate_hz),
                    arm.map.fixed.value_or(map));
}

Impedance demandedOf(const Exercise& exercise, const Tissue& tissue) {
  return demandedOf(exercise.laws, tissueTable({{}, {tissue}}).classes[0]);
}

std::vector<BoundedTissue> boundedTissues(const Exercise& exercise, const Rig& rig) {
  std::vector<BoundedTissue> bounded;
  if (exercise.controller != ControllerKind::bounded) return bounded;
  for (std::size_t i = 0; i < exercise.arms.size() && i < rig.arms.size(); ++i) {
    const ExerciseArm& arm = exercise.arms[i];
    if (!rig.arms[i].dynamics) continue;
    const Renderable most = renderableOn(arm, rig.arms[i].dynamics, exercise.rate_hz);
    for (const Tissue& tissue : exercise.tissues.tissues) {
      const Impedance demanded = demandedOf(exercise, tissue);
      const Impedance felt{std::min(demanded.damping, most.b_max),
                           std::min(demanded.stiffness, most.k_max)};
      if (felt.damping < demanded.damping || felt.stiffness < demanded.stiffness) {
        bounded.push_back({arm.name, tissue.id, demanded, felt});
      }
    }
  }
  return bounded;
}

HapticParameters hapticParameters(const Exercise& exercise, const Rig& rig) {
  HapticParameters parameters;
  parameters.period_s = 1.0 / exercise.rate_hz;
  parameters.laws = exercise.laws;
  parameters.force_at = exercise.force_at;
  parameters.removal = exercise.removal;
  parameters.controller = exercise.controller;
  parameters.tissues = tissueTable(exercise.tissues);
  for (std::size_t c = 0; c < exercise.tissues.tissues.size(); ++c) {
    const bool pushes =
        std::ranges::count(exercise.touch_by_points, exercise.tissues.tissues[c].id);
    parameters.touch_by_points |= std::uint32_t(pushes) << c;
  }
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    const ExerciseArm& arm = exercise.arms[i];
    ArmDynamics dynamics =
        (i < rig.arms.size() ? rig.arms[i].dynamics : std::nullopt).value_or(ArmDynamics{});
    dynamics.peak_force_N = arm.max_force_N;
    std::vector<Tool> others;
    for (const std::string& id : arm.other_tools) others.push_back(exercise.findTool(id)->tool);
    parameters.arms.push_back({exercise.findTool(arm.tool)->tool,
                               arm.map.fixed.value_or(WorkspaceMap{}), arm.max_force_N, dynamics,
                               std::move(others)});
  }
  return parameters;
}

}  // namespace trephine
