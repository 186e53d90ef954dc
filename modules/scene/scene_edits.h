// A scene while a person edits it: what can be taken back, and what a new set of tissues does to the
// rest of the scene. Pure.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace trephine {

// The scenes before and after each step. One that a person makes of many small ones, as a drag
// does, is one step.
class SceneHistory {
 public:
  // Another scene: nothing of the one before can be taken back.
  void begin(Scene scene);
  // It is `scene` now. `what` says of what: edits of the same thing that follow one another are one
  // step until close().
  void note(Scene scene, const std::string& what);
  void close() { open_.clear(); }
  // It changed by itself, as by being saved under another name: no step.
  void settle(Scene scene) { now_ = shared(std::move(scene)); }

  bool canUndo() const { return !undo_.empty(); }
  bool canRedo() const { return !redo_.empty(); }
  std::string undoWhat() const { return canUndo() ? undo_.back().what : std::string(); }
  std::string redoWhat() const { return canRedo() ? redo_.back().what : std::string(); }
  // The scene that it would be; null where there is none.
  const Scene* before() const { return canUndo() ? undo_.back().scene.get() : nullptr; }
  const Scene* after() const { return canRedo() ? redo_.back().scene.get() : nullptr; }
  // The scene that it is then; only where it can.
  const Scene& undo();
  const Scene& redo();

 private:
  using Shared = std::shared_ptr<const Scene>;
  struct Step {
    Shared scene;  // to go back or on to
    std::string what;
  };
  static Shared shared(Scene scene) { return std::make_shared<const Scene>(std::move(scene)); }

  Shared now_ = shared({});
  std::vector<Step> undo_, redo_;
  std::string open_;  // what the last step is of, while it goes on
};
// Older steps go: a scene with everything is some 20 KB.
constexpr std::size_t kMostSteps = 500;

// The map of an arm that goes with `landmark` from now on, or with "" is fixed where it is in this
// patient. From a landmark to another it keeps its offset; from a fixed place it stays there.
SceneMap movedTo(const Scene& scene, std::size_t arm, const std::string& landmark,
                 const std::vector<PlacedLandmark>& landmarks);

// The scene with another set. Landmarks and looks that name a tissue which is no longer there: a
// landmark takes the solid tissue of the set, or its first; a look goes. What was done is said, a
// sentence each.
struct NewTissues {
  Scene scene;
  std::vector<std::string> notes;
};
NewTissues withTissues(Scene scene, const TissueSet& set);

}  // namespace trephine
