// The structures of a case while they are made and mended: the label map, which changes in place,
// how much each of them has, every step, what is tried before it counts, and a wall that holds
// growing back and is of no file.
//
// Of one thread; others may read map() meanwhile, as long as nothing is changed. What changes it
// may be called once isOwn(), with labels that have a row.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "structures/edit_history.h"
#include "structures/shape_tools.h"
#include "volume/label_map.h"

namespace trephine {

class EditedStructures {
 public:
  // Those of another case; null: it has none. What was done to the ones before is forgotten.
  void start(std::shared_ptr<const LabelMap> given);
  // As it was given until makeOwn(), which copies it, or makes an empty one of the grid where there
  // is none. Error: OUT_OF_MEMORY.
  std::shared_ptr<const LabelMap> map() const { return own_ ? own_ : given_; }
  bool isOwn() const { return own_ != nullptr; }
  Status makeOwn(const GridGeometry& grid);
  // Stands for what they are now: another number with every change but of the wall alone, of
  // whatever case, and the same again where undo or redo leads back to it.
  std::uint64_t version() const { return history_.version(); }
  // A copy without the wall; null where nothing else has a row. Error: OUT_OF_MEMORY.
  Result<std::shared_ptr<LabelMap>> withoutWall() const;

  // --- Rows. One without voxels is there for undo alone: it gives its name away. ---
  const Structure* find(int label) const;
  const Structure* find(const std::string& name) const;
  double millilitres(int label) const { return ml_[std::size_t(label)]; }
  bool hasVoxels(int label) const { return millilitres(label) > 0.0; }
  bool anyVoxels() const;  // of any label
  int labelAt(const Index3& voxel) const;
  // The first that has voxels and is no wall; 0: none.
  int first() const;
  // `name`, with a number where another that has voxels is called so; or any other is.
  std::string freeName(const std::string& name) const;
  std::string spareName(const std::string& name) const;
  // For one more row. Error: TOO_MANY_STRUCTURES.
  Result<int> freeLabel() const;
  void addRow(const Structure& row) { own_->structures.push_back(row); }
  // As steps of that name. False: another that has voxels is called `name`.
  bool rename(const std::string& step, int label, const std::string& name);
  void recolour(const std::string& step, int label, const Vec3& colour);

  // --- Voxels ---
  // As a step, or part of the last one. How many of the first steps were forgotten for it.
  std::size_t put(const std::string& step, const LabelEdit& edit, bool joins = false);
  // `layer` was made of `of`, and goes back to it when it is removed.
  void noteLayer(int layer, int of) { layer_of_[layer] = of; }
  int layerOf(int layer) const;  // 0: of none that is there
  Result<LabelEdit> removalOf(int label) const;
  // What would be taken back or done again; null: nothing. Boxes as EditHistory's.
  const std::string* toUndo() const { return history_.toUndo(); }
  const std::string* toRedo() const { return history_.toRedo(); }
  std::optional<VoxelBox> undo() { return stepped(history_.undo(*own_)); }
  std::optional<VoxelBox> redo() { return stepped(history_.redo(*own_)); }

  // An edit that does not count until it is taken. `row`: the label of a row that was made for it
  // and goes with it, else 0. Nothing else is changed meanwhile.
  void tryOut(const LabelEdit& edit, int row);
  void takeTried(const std::string& step);
  VoxelBox leaveTried();  // where it was

  // --- The wall ---
  int wall() const { return wall_; }  // its label; 0: none was made
  // Its row, which is made where there is none. Error: TOO_MANY_STRUCTURES.
  Result<int> makeWall(const std::string& name, const Vec3& colour);
  Labels overWall() const;  // what is made takes its voxels: they are of nothing

 private:
  Structure* row(int label);
  void count(const LabelEdit& edit, bool added);
  bool isOfWallAlone(const LabelEdit& edit) const;
  void countAll();
  std::optional<VoxelBox> stepped(const std::optional<VoxelBox>& box);

  struct Tried {
    LabelEdit edit;
    int row = 0;
  };
  std::shared_ptr<const LabelMap> given_;
  std::shared_ptr<LabelMap> own_;
  std::array<double, 256> ml_{};
  EditHistory history_;
  Tried tried_;
  int wall_ = 0;
  std::map<int, int> layer_of_;
};

}  // namespace trephine
