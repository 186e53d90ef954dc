// Inside: how the tools of shape_tools.h make their edits.
#pragma once

#include "base/memory.h"
#include "structures/shape_tools.h"

namespace trephine {

Status checkMap(const LabelMap& map, int label);
Status checkMm(double mm, double least, double most, const std::string& what);

// Whether a voxel may become `own`: it is of nothing, or of a structure that may be taken over.
inline bool isFree(std::uint8_t before, std::uint8_t own, const Labels& over) {
  return before != own && (before == 0 || over[before]);
}

// Voxels one after another, in rising order, as runs.
class EditMaker {
 public:
  explicit EditMaker(const LabelMap& map) : map_(map), row_(std::size_t(map.geometry.size[0])) {}
  void put(std::size_t at, std::uint8_t after) {
    const std::uint8_t before = map_.labels[at];
    if (!edit_.runs.empty()) {
      LabelEdit::Run& last = edit_.runs.back();
      if (last.first + last.count == at && last.before == before && last.after == after &&
          at % row_ != 0) {
        ++last.count;
        return;
      }
    }
    edit_.runs.push_back({at, 1, before, after});
  }
  LabelEdit take();

 private:
  const LabelMap& map_;
  std::size_t row_;
  LabelEdit edit_;
};

// What makes the structure be where wanted(i, j, k) says, within `box`. Two threads.
template <class Wanted>
LabelEdit editTo(const LabelMap& map, int label, const VoxelBox& box, const Labels& over,
                 const Wanted& wanted);
// Edits of boxes that lie one above another, as one.
LabelEdit joined(std::vector<LabelEdit> edits);

template <class Wanted>
LabelEdit editTo(const LabelMap& map, int label, const VoxelBox& box, const Labels& over,
                 const Wanted& wanted) {
  const std::uint8_t own = std::uint8_t(label);
  std::vector<LabelEdit> layers(std::size_t(std::max(0, box.high[2] - box.low[2])));
  onTwoThreadsOrThrow(int(layers.size()), [&](int layer) {
    const int k = box.low[2] + layer;
    EditMaker edit(map);
    for (int j = box.low[1]; j < box.high[1]; ++j) {
      std::size_t at = map.geometry.indexOf(box.low[0], j, k);
      for (int i = box.low[0]; i < box.high[0]; ++i, ++at) {
        const std::uint8_t before = map.labels[at];
        const bool is = before == own, is_wanted = wanted(i, j, k);
        if (is == is_wanted || (is_wanted && !isFree(before, own, over))) continue;
        edit.put(at, is_wanted ? own : 0);
      }
    }
    layers[std::size_t(layer)] = edit.take();
  });
  return joined(std::move(layers));
}

}  // namespace trephine
