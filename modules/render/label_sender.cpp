// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <algorithm>
#include <chrono>
#include <utility>

#include "render/dirty_boxes.h"
#include "render/label_sender.h"
#include "render/send_box.h"

namespace trephine {

namespace {

constexpr std::size_t kMostBoxes = 16;

}  // namespace

void LabelSender::start(std::shared_ptr<const LabelMap> labels) {
  labels_ = std::move(labels);
  boxes_.clear();
  shapes_.reset();
  if (!labels_) return;
  const Index3& size = labels_->geometry.size;
  if (bricks_.voxels() != size) bricks_ = BrickLabels(size);
  boxes_.push_back({{0, 0, 0}, size});
}

// A label shapes its neighbours too.
void LabelSender::add(const VoxelBox& box) {
  if (!labels_ || voxelCount(box) == 0) return;
  VoxelBox grown;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grown.low[axis] = std::max(0, box.low[axis] - 1);
    grown.high[axis] = std::min(labels_->geometry.size[axis], box.high[axis] + 1);
  }
  boxes_.push_back(grown);
  if (boxes_.size() <= kMostBoxes) return;
  std::vector<VoxelBox> waiting(boxes_.begin() + 1, boxes_.end());
  boxes_.resize(1);
  for (const VoxelBox& merged : mergeBoxes(waiting, kMostBoxes / 2)) boxes_.push_back(merged);
}

std::vector<VoxelBox> LabelSender::send(vtkTextureObject& into, double budget_ms) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double, std::milli>(budget_ms);
  std::vector<VoxelBox> sent;
  while (!done()) {
    const VoxelBox& box = boxes_.front();
    if (!shapes_) shapes_.emplace(*labels_, box);
    const int k = shapes_->slice();
    const VoxelBox slice{{box.low[0], box.low[1], k}, {box.high[0], box.high[1], k + 1}};
    sendSlice(into, shapes_->next().data(), slice);
    if (shapes_->done() || (k + 1) % kLeapEdge == 0) {
      VoxelBox slab = slice;
      slab.low[2] = std::max(box.low[2], k / kLeapEdge * kLeapEdge);
      bricks_.update(*labels_, slab);
    }
    if (shapes_->done()) {
      sent.push_back(box);
      shapes_.reset();
      boxes_.erase(boxes_.begin());
    }
    if (Clock::now() >= end) break;
  }
  return sent;
}

}  // namespace trephine
