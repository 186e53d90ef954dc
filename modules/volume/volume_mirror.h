// The window's one copy of a grid's voxels and labels, from which every view draws.
//
// Once a frame it takes what the grid's writer changed (Grid::copyChanges) and puts the boxes into
// the queue of each reader: a view reads when it draws, so that one which is hidden costs nothing.
// One thread, the window's.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "volume/grid.h"
#include "volume/voxel_slabs.h"

namespace trephine {

class VolumeMirror {
 public:
  VolumeMirror() = default;
  VolumeMirror(const VolumeMirror&) = delete;
  VolumeMirror& operator=(const VolumeMirror&) = delete;

  // These voxels from now on, and those labels of theirs (null: none). Everything is new. `whole`
  // is what they were before anything was cut, while its owner keeps it; null: nobody knows.
  void show(Volume copy, std::shared_ptr<const LabelMap> labels,
            const std::shared_ptr<const Volume>& whole = nullptr);
  // All voxels again, from others of the same geometry; others are left alone. Allocates none.
  void refill(const VoxelSlabs& voxels, std::shared_ptr<const LabelMap> labels,
              const std::shared_ptr<const Volume>& whole = nullptr);
  // Other labels of the same voxels.
  void setLabels(std::shared_ptr<const LabelMap> labels);
  // Who changes them in place says where.
  void labelsChanged(const VoxelBox& box);
  // Copies what was changed since the last call. True where anything was. A grid of another
  // geometry is left alone.
  bool pull(Grid& grid);

  bool empty() const { return volume_.hu.empty(); }
  const Volume& volume() const { return volume_; }
  // For who draws in place with a library that asks for more than it needs, and for measurements.
  Volume& mutableVolume() { return volume_; }
  const std::shared_ptr<const LabelMap>& labels() const { return labels_; }

  // With touched(): what was cut, for views that show it. Null where it is not known.
  std::shared_ptr<const Volume> whole() const;
  // A box of all that pull() took since show() or refill(); empty: nothing.
  const VoxelBox& touched() const { return touched_; }

  // What a reader has not seen yet.
  struct News {
    bool all = true;  // everything, the geometry perhaps too; then there are no boxes
    std::vector<VoxelBox> boxes;
    bool other_labels = false;  // a whole map of them; then there are no boxes of labels
    std::vector<VoxelBox> label_boxes{};
    bool any() const { return all || other_labels || !boxes.empty() || !label_boxes.empty(); }
  };

  // A view's place in the changes. Everything is new to it at first.
  class Reader {
   public:
    explicit Reader(std::shared_ptr<VolumeMirror> mirror);
    ~Reader();
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
    // The queue, which is empty afterwards.
    News take();

   private:
    friend class VolumeMirror;
    // A reader that has not read for so many boxes gets one that holds them all.
    static constexpr std::size_t kMostBoxes = 4096;
    void add(const std::vector<VoxelBox>& boxes);
    void addLabels(const VoxelBox& box);
    std::shared_ptr<VolumeMirror> mirror_;
    News news_;
  };

 private:
  void renew();
  void renewAll(const std::shared_ptr<const Volume>& whole);

  Volume volume_;
  std::shared_ptr<const LabelMap> labels_;
  std::weak_ptr<const Volume> whole_;
  VoxelBox touched_;
  std::vector<Reader*> readers_;
  std::vector<VoxelBox> pulled_;
};

}  // namespace trephine
