// Labels on their way to the graphics card: of a whole map or of the boxes that changed, slice by
// slice, so that no frame waits for all of them.
//
// One thread, that of the OpenGL context; send() needs it to be current.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/empty_space.h"
#include "render/label_shape.h"
#include "volume/label_map.h"

class vtkTextureObject;

namespace trephine {

class LabelSender {
 public:
  // All of this map, from below; null: nothing. It may be changed in place, with add() of each box.
  void start(std::shared_ptr<const LabelMap> labels);
  void add(const VoxelBox& box);
  bool done() const { return boxes_.empty(); }

  // Sends slices until about so much time has gone, at least one. The boxes that are there as a
  // whole from now on.
  std::vector<VoxelBox> send(vtkTextureObject& into, double budget_ms);
  // Of what was sent.
  const BrickLabels& bricks() const { return bricks_; }

 private:
  std::shared_ptr<const LabelMap> labels_;
  std::vector<VoxelBox> boxes_;  // the first is on its way
  std::optional<LabelShapes> shapes_;
  BrickLabels bricks_;
};

}  // namespace trephine
