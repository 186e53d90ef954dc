#include "volume/volume_mirror.h"

#include <algorithm>
#include <utility>

namespace trephine {

void VolumeMirror::show(Volume copy, std::shared_ptr<const LabelMap> labels) {
  volume_ = std::move(copy);
  labels_ = std::move(labels);
  renewAll();
}

void VolumeMirror::refill(const VoxelSlabs& voxels, std::shared_ptr<const LabelMap> labels) {
  if (empty() || !(voxels.geometry == volume_.geometry)) return;
  voxels.read(0, volume_.hu);
  labels_ = std::move(labels);
  renewAll();
}

bool VolumeMirror::pull(Grid& grid) {
  if (empty() || !(grid.geometry() == volume_.geometry)) return false;
  pulled_.clear();
  grid.copyChanges(volume_, pulled_);
  if (pulled_.empty()) return false;
  for (Reader* reader : readers_) reader->add(pulled_);
  return true;
}

void VolumeMirror::renewAll() {
  for (Reader* reader : readers_) reader->news_ = {};
}

VolumeMirror::Reader::Reader(std::shared_ptr<VolumeMirror> mirror) : mirror_(std::move(mirror)) {
  mirror_->readers_.push_back(this);
}

VolumeMirror::Reader::~Reader() {
  std::erase(mirror_->readers_, this);
}

VolumeMirror::News VolumeMirror::Reader::take() {
  return std::exchange(news_, {false, {}});
}

void VolumeMirror::Reader::add(const std::vector<VoxelBox>& boxes) {
  if (news_.all) return;
  news_.boxes.insert(news_.boxes.end(), boxes.begin(), boxes.end());
  if (news_.boxes.size() <= kMostBoxes) return;
  VoxelBox whole = news_.boxes.front();
  for (const VoxelBox& box : news_.boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      whole.low[axis] = std::min(whole.low[axis], box.low[axis]);
      whole.high[axis] = std::max(whole.high[axis], box.high[axis]);
    }
  }
  news_.boxes = {whole};
}

}  // namespace trephine
