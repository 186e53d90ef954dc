#include "volume/volume_mirror.h"

#include <algorithm>
#include <utility>

namespace trephine {

namespace {

// Around `all` and the boxes.
VoxelBox boundsOf(const std::vector<VoxelBox>& boxes, VoxelBox all) {
  for (const VoxelBox& box : boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      all.low[axis] = std::min(all.low[axis], box.low[axis]);
      all.high[axis] = std::max(all.high[axis], box.high[axis]);
    }
  }
  return all;
}

}  // namespace

void VolumeMirror::show(Volume copy, std::shared_ptr<const LabelMap> labels,
                        const std::shared_ptr<const Volume>& whole) {
  volume_ = std::move(copy);
  labels_ = std::move(labels);
  renewAll(whole);
}

void VolumeMirror::refill(const VoxelSlabs& voxels, std::shared_ptr<const LabelMap> labels,
                          const std::shared_ptr<const Volume>& whole) {
  if (empty() || !(voxels.geometry == volume_.geometry)) return;
  voxels.read(0, volume_.hu);
  labels_ = std::move(labels);
  renewAll(whole);
}

bool VolumeMirror::pull(Grid& grid) {
  if (empty() || !(grid.geometry() == volume_.geometry)) return false;
  pulled_.clear();
  grid.copyChanges(volume_, pulled_);
  if (pulled_.empty()) return false;
  if (touched_ == VoxelBox{}) touched_ = pulled_.front();
  touched_ = boundsOf(pulled_, touched_);
  for (Reader* reader : readers_) reader->add(pulled_);
  return true;
}

std::shared_ptr<const Volume> VolumeMirror::whole() const {
  std::shared_ptr<const Volume> whole = whole_.lock();
  return whole && whole->geometry == volume_.geometry ? whole : nullptr;
}

void VolumeMirror::setLabels(std::shared_ptr<const LabelMap> labels) {
  if (std::exchange(labels_, labels) == labels) return;
  for (Reader* reader : readers_) {
    if (reader->news_.all) continue;
    reader->news_.other_labels = true;
    reader->news_.label_boxes.clear();
  }
}

void VolumeMirror::labelsChanged(const VoxelBox& box) {
  for (Reader* reader : readers_) reader->addLabels(box);
}

void VolumeMirror::renew() {
  for (Reader* reader : readers_) reader->news_ = {};
}

void VolumeMirror::renewAll(const std::shared_ptr<const Volume>& whole) {
  whole_ = whole;
  touched_ = {};
  renew();
}

VolumeMirror::Reader::Reader(std::shared_ptr<VolumeMirror> mirror) : mirror_(std::move(mirror)) {
  mirror_->readers_.push_back(this);
}

VolumeMirror::Reader::~Reader() {
  std::erase(mirror_->readers_, this);
}

VolumeMirror::News VolumeMirror::Reader::take() {
  return std::exchange(news_, {.all = false, .boxes = {}});
}

void VolumeMirror::Reader::addLabels(const VoxelBox& box) {
  if (news_.all || news_.other_labels) return;
  news_.label_boxes.push_back(box);
  if (news_.label_boxes.size() <= kMostBoxes) return;
  news_.label_boxes = {boundsOf(news_.label_boxes, box)};
}

void VolumeMirror::Reader::add(const std::vector<VoxelBox>& boxes) {
  if (news_.all) return;
  news_.boxes.insert(news_.boxes.end(), boxes.begin(), boxes.end());
  if (news_.boxes.size() <= kMostBoxes) return;
  news_.boxes = {boundsOf(news_.boxes, news_.boxes.front())};
}

}  // namespace trephine
