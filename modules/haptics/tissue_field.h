// The tissue that tools move among: what touch, the proxy, the laws and removal know of it, they
// know from here.
#pragma once

#include <cstdint>

#include "haptics/tissue_bricks.h"
#include "haptics/tissue_lookup.h"
#include "volume/grid.h"

namespace trephine {

// The tissue class of a voxel and of a place, which classes are solid or firmer, and where there
// may be any. A class is an index into the tissues, -1 air. Places are in voxels of the grid, where
// a whole number is a voxel's centre. It sees the grid's voxels as they are; what its counts of
// bricks need to be told of them says removed() and changed(). One thread.
class TissueField {
 public:
  // The grid outlives it.
  TissueField(const Grid& grid, const TissueTable& tissues)
      : grid_(grid), tissues_(tissues), lookup_(tissues), bricks_(grid, lookup_) {
    rank();
  }

  // What another table of tissues changes: the numbers of the classes alone, which of them may be
  // cut, or which voxels they are in; each with those before it.
  enum class Change { numbers, cuts, voxels };
  // From now on the HU mean these. No allocation.
  Change use(const TissueTable& tissues);

  const GridGeometry& geometry() const { return grid_.geometry(); }
  const TissueTable& tissues() const { return tissues_; }
  // Of a class that is not air.
  const TissueClass& ofClass(int tissue_class) const {
    return tissues_.classes[std::size_t(tissue_class)];
  }

  std::int16_t hu(std::size_t voxel) const { return grid_.hu(voxel); }
  // Air outside the grid.
  std::int16_t hu(int i, int j, int k) const { return grid_.hu(i, j, k); }
  // Hints that a voxel, or the eight from one on, will be read.
  void prefetch(std::size_t voxel) const { grid_.prefetch(voxel); }
  void prefetch(std::size_t voxel, std::size_t row, std::size_t slice) const {
    grid_.prefetch(voxel, row, slice);
  }
  // 0: none.
  std::uint8_t label(std::size_t voxel) const { return grid_.label(voxel); }
  int classAt(std::size_t voxel) const { return lookup_.classAt(grid_, voxel); }
  // Of a voxel whose HU is known already.
  int classAt(std::size_t voxel, std::int16_t hu) const {
    return lookup_.classAt(grid_, voxel, hu);
  }
  int classAt(const Vec3& place) const {
    const std::int64_t voxel = voxelAt(geometry(), place);
    return voxel < 0 ? -1 : classAt(std::size_t(voxel));
  }
  bool isSolid(int tissue_class) const { return lookup_.isSolid(tissue_class); }
  // How much of all solid tissue tools may cut.
  enum class Cuts { none, some, all };
  Cuts cutsOfSolid() const { return cuts_of_solid_; }
  bool firmer(int a, int b) const { return trephine::firmer(tissues_, a, b); }
  // Than which none is firmer: the one such, or -1 where there are several or no tissues.
  int firmest() const { return firmest_; }

  // Whether there may be tissue, or solid tissue, between two places, those included. False for
  // places that are not numbers.
  bool mayHold(const Vec3& low, const Vec3& high) const { return bricks_.mayHold(low, high); }
  bool mayHoldSolid(const Vec3& low, const Vec3& high) const {
    return bricks_.mayHoldSolid(low, high);
  }

  // The first solid voxel of row (j, k) along x: from `from` up to `to`, to + 1 where there is
  // none; and down from `from` to `to`, to - 1 where there is none. All within the grid.
  int solidUp(int from, int to, int j, int k) const {
    if (const SolidBits* bits = bricks_.solid()) return bits->up(from, to, j, k);
    while (from <= to && !isSolidAt(from, j, k)) ++from;
    return from;
  }
  int solidDown(int from, int to, int j, int k) const {
    if (const SolidBits* bits = bricks_.solid()) return bits->down(from, to, j, k);
    while (from >= to && !isSolidAt(from, j, k)) --from;
    return from;
  }
  bool isSolidAt(int i, int j, int k) const {
    if (const SolidBits* bits = bricks_.solid()) return bits->at({i, j, k});
    return isSolid(classAt(geometry().indexOf(i, j, k)));
  }
  // Hints that a row will be searched near a voxel.
  void prefetchSolid(int i, int j, int k) const {
    if (const SolidBits* bits = bricks_.solid()) return bits->prefetch(i, j, k);
    prefetch(geometry().indexOf(i, j, k));
  }

  // A voxel of this class went.
  void removed(const Index3& voxel, int tissue_class) {
    bricks_.remove(voxel, isSolid(tissue_class));
  }
  // A voxel came back, or went again.
  void changed(std::size_t voxel) {
    bricks_.mark(grid_.brickOf(voxel));
    bricks_.setSolid(geometry().indicesOf(voxel), isSolid(classAt(voxel)));
  }
  // Counts one of the bricks that changed, a tick.
  void recount() { bricks_.recount(grid_, lookup_); }
  // After a state was read, whose tissues may be others: not for the tick.
  void findSolid() { bricks_.findSolid(grid_, lookup_); }
  std::size_t unknownBricks() const { return bricks_.unknown(); }  // of which air is not known

  // The nearest voxel to a place, or -1 outside the grid. Any value is answered, infinities and NaN
  // too.
  static std::int64_t voxelAt(const GridGeometry& geometry, const Vec3& place) {
    const Vec3 v = place + 0.5;  // written so that NaN falls out as "outside"
    const bool inside = v.x >= 0.0 && v.y >= 0.0 && v.z >= 0.0 && v.x < geometry.size[0] &&
                        v.y < geometry.size[1] && v.z < geometry.size[2];
    if (!inside) return -1;
    return std::int64_t(geometry.indexOf(int(v.x), int(v.y), int(v.z)));
  }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.bricks_);
  }

 private:
  void rank();

  const Grid& grid_;
  TissueTable tissues_;
  TissueLookup lookup_;
  TissueBricks bricks_;
  Cuts cuts_of_solid_ = Cuts::none;
  int firmest_ = -1;
};

}  // namespace trephine
