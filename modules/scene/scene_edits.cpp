#include "scene/scene_edits.h"

#include <algorithm>
#include <utility>

namespace trephine {

void SceneHistory::begin(Scene scene) {
  undo_.clear();
  redo_.clear();
  open_.clear();
  now_ = shared(std::move(scene));
}

void SceneHistory::note(Scene scene, const std::string& what) {
  if (scene == *now_) return;
  redo_.clear();
  if (open_.empty() || open_ != what || undo_.empty()) {
    undo_.push_back({std::move(now_), what});
    if (undo_.size() > kMostSteps) undo_.erase(undo_.begin());
  }
  open_ = what;
  now_ = shared(std::move(scene));
}

const Scene& SceneHistory::undo() {
  open_.clear();
  Step step = std::move(undo_.back());
  undo_.pop_back();
  redo_.push_back({std::exchange(now_, std::move(step.scene)), std::move(step.what)});
  return *now_;
}

const Scene& SceneHistory::redo() {
  open_.clear();
  Step step = std::move(redo_.back());
  redo_.pop_back();
  undo_.push_back({std::exchange(now_, std::move(step.scene)), std::move(step.what)});
  return *now_;
}

SceneMap movedTo(const Scene& scene, std::size_t arm, const std::string& landmark,
                 const std::vector<PlacedLandmark>& landmarks) {
  SceneMap map = scene.arms[arm].map;
  if (landmark.empty()) {
    map.fixed = withFixedMaps(scene, landmarks).arms[arm].map.fixed;
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

NewTissues withTissues(Scene scene, const TissueSet& set) {
  NewTissues out{std::move(scene), {}};
  Scene& to = out.scene;
  const TissueSet before = std::exchange(to.tissues, set);
  const auto solid = std::ranges::find_if(set.tissues, &Tissue::isSolid);
  const Tissue& instead = solid == set.tissues.end() ? set.tissues.front() : *solid;
  for (Landmark& landmark : to.landmarks) {
    if (set.find(landmark.tissue)) continue;
    const Tissue* was = before.find(landmark.tissue);
    out.notes.push_back("The landmark '" + landmark.id + "' was on " +
                        (was ? was->name : landmark.tissue) + " and is on " + instead.name +
                        " now");
    landmark.tissue = instead.id;
  }
  std::erase_if(to.view.looks, [&](const auto& look) { return !set.find(look.first); });
  if (to.tissues_elsewhere) {
    for (const Landmark& landmark : to.landmarks) {
      if (to.tissues_elsewhere->find(landmark.tissue)) continue;
      to.tissues_elsewhere.reset();
      out.notes.push_back("The exercise has these tissues on every case now");
      break;
    }
  }
  return out;
}

}  // namespace trephine
