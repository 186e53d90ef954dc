#include "exercise/exercise_edits.h"

#include <algorithm>
#include <utility>

#include "base/tr.h"

namespace trephine {

void ExerciseHistory::begin(Exercise exercise) {
  undo_.clear();
  redo_.clear();
  open_.clear();
  now_ = shared(std::move(exercise));
}

void ExerciseHistory::note(Exercise exercise, const std::string& what) {
  if (exercise == *now_) return;
  redo_.clear();
  if (open_.empty() || open_ != what || undo_.empty()) {
    undo_.push_back({std::move(now_), what});
    if (undo_.size() > kMostSteps) undo_.erase(undo_.begin());
  }
  open_ = what;
  now_ = shared(std::move(exercise));
}

const Exercise& ExerciseHistory::undo() {
  open_.clear();
  Step step = std::move(undo_.back());
  undo_.pop_back();
  redo_.push_back({std::exchange(now_, std::move(step.exercise)), std::move(step.what)});
  return *now_;
}

const Exercise& ExerciseHistory::redo() {
  open_.clear();
  Step step = std::move(redo_.back());
  redo_.pop_back();
  undo_.push_back({std::exchange(now_, std::move(step.exercise)), std::move(step.what)});
  return *now_;
}

ExerciseMap movedTo(const Exercise& exercise, std::size_t arm, const std::string& landmark,
                    const std::vector<PlacedLandmark>& landmarks) {
  ExerciseMap map = exercise.arms[arm].map;
  if (landmark.empty()) {
    map.fixed = withFixedMaps(exercise, landmarks).arms[arm].map.fixed;
    if (map.fixed) map.landmark.clear();
    return map;
  }
  map.landmark = landmark;
  if (!map.fixed) return map;
  for (const PlacedLandmark& placed : landmarks) {
    if (placed.id != landmark) continue;
    map.offset_mm =
        glm::conjugate(placed.frame.rotation) * (map.fixed->centre_mm - placed.frame.position_mm);
  }
  map.fixed.reset();
  return map;
}

NewTissues withTissues(Exercise exercise, const TissueSet& set) {
  NewTissues out{std::move(exercise), {}};
  Exercise& to = out.exercise;
  const TissueSet before = std::exchange(to.tissues, set);
  const auto solid = std::ranges::find_if(set.tissues, &Tissue::isSolid);
  const Tissue& instead = solid == set.tissues.end() ? set.tissues.front() : *solid;
  for (Landmark& landmark : to.landmarks) {
    if (set.find(landmark.tissue)) continue;
    const Tissue* was = before.find(landmark.tissue);
    out.notes.push_back(tr("The landmark '{}' was on {} and is on {} now", landmark.id,
                           (was ? was->name : landmark.tissue), instead.name));
    landmark.tissue = instead.id;
  }
  for (const Tissue& tissue : set.tissues) {
    const Tissue* was = before.find(tissue.id);
    const Tissue* inside = was ? before.find(was->within) : nullptr;
    if (!inside || !tissue.within.empty() || set.find(inside->id)) continue;
    out.notes.push_back(
        tr("{} lay inside of {} and lies inside of nothing now", tissue.name, inside->name));
  }
  if (std::erase_if(to.touch_by_points, [&](const auto& id) { return !set.find(id); }) > 0) {
    out.notes.push_back(to.touch_by_points.empty()
                            ? tr("Tools touch all tissues now, and not by their points alone")
                            : tr("Tools touch fewer tissues by their points now"));
  }
  std::erase_if(to.view.looks, [&](const auto& look) { return !set.find(look.first); });
  if (to.tissues_elsewhere) {
    for (const Landmark& landmark : to.landmarks) {
      if (to.tissues_elsewhere->find(landmark.tissue)) continue;
      to.tissues_elsewhere.reset();
      out.notes.push_back(tr("The exercise has these tissues on every case now"));
      break;
    }
  }
  return out;
}

const TissueSet& tissuesInForce(const Exercise& exercise, bool elsewhere) {
  return elsewhere && exercise.tissues_elsewhere ? *exercise.tissues_elsewhere : exercise.tissues;
}

TissueSet& tissuesInForce(Exercise& exercise, bool elsewhere) {
  return elsewhere && exercise.tissues_elsewhere ? *exercise.tissues_elsewhere : exercise.tissues;
}

NewTissues withTissuesInForce(Exercise exercise, const TissueSet& set, bool elsewhere) {
  const bool swapped = elsewhere && exercise.tissues_elsewhere;
  if (swapped) std::swap(exercise.tissues, *exercise.tissues_elsewhere);
  NewTissues out = withTissues(std::move(exercise), set);
  if (swapped && out.exercise.tissues_elsewhere) {
    std::swap(out.exercise.tissues, *out.exercise.tissues_elsewhere);
  }
  return out;
}

Exercise withLiveOf(Exercise exercise, const Exercise& other, bool elsewhere) {
  tissuesInForce(exercise, elsewhere) = tissuesInForce(other, elsewhere);
  exercise.controller = other.controller;
  return exercise;
}

namespace {

bool sameStructures(const TissueSet& a, const TissueSet& b) {
  return std::ranges::equal(a.tissues, b.tissues, [](const Tissue& one, const Tissue& other) {
    return one.id == other.id && one.structure == other.structure && one.shell == other.shell;
  });
}

}  // namespace

bool samePlaces(const Exercise& a, const Exercise& b) {
  const bool both = a.tissues_elsewhere && b.tissues_elsewhere;
  // Whether the case is one for the anatomy is said with its places.
  return a.landmarks == b.landmarks && a.structures == b.structures && a.anatomy == b.anatomy &&
         sameStructures(a.tissues, b.tissues) &&
         a.tissues_elsewhere.has_value() == b.tissues_elsewhere.has_value() &&
         (!both || sameStructures(*a.tissues_elsewhere, *b.tissues_elsewhere));
}

bool sameFiles(const Exercise& a, const Exercise& b) {
  return a.operator_file == b.operator_file &&
         std::ranges::equal(
             a.tools, b.tools, {}, [](const ExerciseTool& t) { return t.look.mesh; },
             [](const ExerciseTool& t) { return t.look.mesh; });
}

bool sameDevices(const Exercise& a, const Exercise& b) {
  return a.rate_hz == b.rate_hz &&
         std::ranges::equal(a.arms, b.arms, {}, &ExerciseArm::name, &ExerciseArm::name);
}

bool isEntry(const Landmark& landmark, const Exercise& opened) {
  const Landmark* of_file = opened.findLandmarkById(landmark.id);
  return landmark.is_place && of_file && landmark != *of_file;
}

bool isEdited(const Exercise& exercise, const Exercise& opened, bool elsewhere) {
  return withLiveOf(opened, exercise, elsewhere) != exercise;
}

Exercise forAnotherCase(Exercise exercise, const Exercise& opened) {
  for (ExerciseArm& arm : exercise.arms) {
    const auto same = std::ranges::find(opened.arms, arm.name, &ExerciseArm::name);
    if (arm.map.fixed && same != opened.arms.end()) arm.map = same->map;
  }
  for (Landmark& landmark : exercise.landmarks) {
    if (isEntry(landmark, opened)) landmark = *opened.findLandmarkById(landmark.id);
  }
  return exercise;
}

Exercise asSaved(Exercise exercise, const Exercise& saved) {
  exercise.case_source = saved.case_source;
  exercise.labels_file = saved.labels_file;
  exercise.outline = saved.outline;
  exercise.name = saved.name;
  exercise.operator_file = saved.operator_file;
  for (std::size_t i = 0; i < exercise.tools.size() && i < saved.tools.size(); ++i) {
    exercise.tools[i].look.mesh = saved.tools[i].look.mesh;
  }
  return exercise;
}

ToolDescription fitted(ToolDescription tool) {
  if (tool.kind != ToolKind::burr) {
    tool.shape = BurrShape::sphere;
    return tool;
  }
  if (tool.shape == BurrShape::cylinder) tool.head_mm = std::max(tool.head_mm, 2.0 * tool.radius_mm);
  const double head_mm =
      tool.shape == BurrShape::cylinder ? tool.head_mm : 2.0 * tool.radius_mm;
  tool.length_mm = std::max(tool.length_mm, head_mm + 1.0);
  return tool;
}

ExerciseArm withInHand(ExerciseArm arm, const std::string& tool) {
  const std::string before = std::exchange(arm.tool, tool);
  std::erase(arm.other_tools, tool);
  if (before != tool && arm.other_tools.size() + 1 < kMostTools) arm.other_tools.push_back(before);
  return arm;
}

void renameLandmark(Exercise& exercise, std::size_t landmark, const std::string& name) {
  const std::string before = std::exchange(exercise.landmarks[landmark].id, name);
  const auto rename = [&](std::string& of) {
    if (of == before) of = name;
  };
  for (ExerciseArm& arm : exercise.arms) rename(arm.map.landmark);
  rename(exercise.view.landmark);
  if (exercise.outline && exercise.outline->frame) rename(exercise.outline->frame->landmark);
}

void renameTool(Exercise& exercise, std::size_t tool, const std::string& name) {
  const std::string before = std::exchange(exercise.tools[tool].id, name);
  for (ExerciseArm& arm : exercise.arms) {
    if (arm.tool == before) arm.tool = name;
    std::ranges::replace(arm.other_tools, before, name);
  }
}

void addLandmarkLike(Exercise& exercise, std::size_t landmark) {
  Landmark more = exercise.landmarks[landmark];
  int number = 2;
  while (exercise.findLandmarkById("place-" + std::to_string(number))) ++number;
  more.id = "place-" + std::to_string(number);
  exercise.landmarks.push_back(more);
}

void addArmLike(Exercise& exercise, std::size_t arm) {
  ExerciseArm more = exercise.arms[arm];
  const auto named = [&](const std::string& name) {
    return std::ranges::find(exercise.arms, name, &ExerciseArm::name) != exercise.arms.end();
  };
  more.name = !named("left") ? "left" : !named("right") ? "right" : "arm-3";
  for (int n = 3; named(more.name); ++n) more.name = "arm-" + std::to_string(n);
  exercise.arms.push_back(more);
}

void findByRay(Landmark& landmark) {
  landmark.is_place = false;
  landmark.bulk_radius_mm = 0.0;
  if (landmark.from != landmark.towards) return;
  landmark.from = Vec3(0.5, 0.5, 1.5);
  landmark.towards = Vec3(0.5, 0.5, 0.5);
}

void findByBulk(Landmark& landmark) {
  constexpr double kUsual_mm = 20.0;
  landmark.is_place = false;
  landmark.bulk_radius_mm = kUsual_mm;
  if (!(glm::length(landmark.outward) > 0.0)) landmark.outward = Vec3(0.0, 0.0, 1.0);
}

}  // namespace trephine
