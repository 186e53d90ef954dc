// Undo and redo of edits to a label map, over any number of steps that fit into a cap of memory. A
// plain value; the map is its holder's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "structures/shape_tools.h"

namespace trephine {

class EditHistory {
 public:
  static constexpr std::size_t kMostBytes = std::size_t(64) << 20;
  explicit EditHistory(std::size_t most_bytes = kMostBytes) : most_bytes_(most_bytes) {}

  // An edit that was applied, as a step of that name; what could be redone is forgotten. One that
  // is empty is no step. With `joins`, it is part of the last step, as the next piece of one stroke
  // is. Where the cap is passed, the oldest steps go, the new one too where it alone passes it;
  // dropped() says how many went in all. One that does not count leaves version() as it is.
  void add(const std::string& name, LabelEdit edit, bool joins = false, bool counts = true);

  // A row of the map that was given another name or colour, as a step.
  void addRow(const std::string& name, const Structure& before, const Structure& after);

  // The name of the step that undo() would take back, or redo() do again; null: there is none.
  const std::string* toUndo() const { return done_ ? &steps_[done_ - 1].name : nullptr; }
  const std::string* toRedo() const {
    return done_ < steps_.size() ? &steps_[done_].name : nullptr;
  }
  // The box of what changed, empty where a row alone did; nothing where there is no step.
  std::optional<VoxelBox> undo(LabelMap& map);
  std::optional<VoxelBox> redo(LabelMap& map);

  // Stands for what the map is now, but for edits that do not count: another number with each edit
  // and after clear(), and the same again where undo() or redo() leads back to it.
  std::uint64_t version() const { return version_; }

  std::size_t steps() const { return steps_.size(); }
  std::size_t bytes() const { return bytes_; }
  std::size_t dropped() const { return dropped_; }
  void clear();  // for another map; dropped() as well

 private:
  struct Step {
    struct Row {
      Structure before, after;
    };
    std::string name;
    std::vector<LabelEdit> edits;
    std::size_t bytes = 0;
    std::optional<Row> row{};
    std::uint64_t before = 0, after = 0;  // versions
  };
  void forgetUndone();
  void begin(Step step);

  std::size_t most_bytes_;
  std::deque<Step> steps_;  // the first done_ are in the map, the others were undone
  std::size_t done_ = 0;
  std::size_t bytes_ = 0, dropped_ = 0;
  std::uint64_t version_ = 0, last_version_ = 0;
};

}  // namespace trephine
