// The surface of solid tissue near a tool, as pieces that the tool must stay outside of.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "haptics/near_pieces.h"
#include "haptics/surface_fit.h"
#include "haptics/swept_solid.h"
#include "haptics/tool.h"
#include "haptics/touch_version.h"

namespace trephine {

// A tool's body at a pose, patient axes.
struct PlacedBody {
  static constexpr std::size_t kMost = 4;
  struct Part {
    Vec3 from_mm{0.0}, along_mm{0.0};
    double per_length2 = 0.0;  // 1 / |along|^2, 0 for a sphere
    double radius_mm = 0.0;
  };
  std::array<Part, kMost> parts;
  std::size_t count = 0;
  Vec3 tip_mm{0.0};
};

// A disk on the surface of a voxel of solid tissue that borders on what is not solid, placed within
// the voxel by partial volume, or a small sphere where the voxel has no clear side (a plate as thin
// as a voxel). Disks of neighbours overlap, so that nothing slips between them.
struct SurfacePiece {
  static constexpr std::uint32_t kGone = std::numeric_limits<std::uint32_t>::max();

  Vec3 at_mm{0.0};         // patient
  Vec3 normal{0.0};        // out of the tissue; zero: a sphere
  double size_mm = 0.0;    // radius of the disk or sphere
  std::int32_t part = 0;   // of the tool's body, to which it is near
  std::uint32_t voxel = 0;  // kGone: it went, and no other took its place
  Index3 at{0, 0, 0};       // the voxel
  // Of a piece that is one voxel of a row along x: to where its place goes on once it is cut away,
  // by steps of 1 or -1; 0: of no row.
  std::int32_t row_end = 0;
  std::int8_t row_step = 0;
  std::int8_t tissue_class = 0;
  bool cuttable = false;   // by this part
  bool flat = false;       // the surface around it is a plane

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.at_mm, self.normal, self.size_mm);
    archive.within(self.part, 0, std::int64_t(PlacedBody::kMost));
    archive(self.voxel, self.at, self.row_end);
    archive.within(self.row_step, -1, 2);
    archive.within(self.tissue_class, 0, kMaxTissues);
    archive(self.cuttable, self.flat);
  }
};

// The least box of some voxels, bounds included; of none it is empty.
struct VoxelBounds {
  Index3 low{kFar, kFar, kFar}, high{-1, -1, -1};

  void add(const Index3& voxel) { join({voxel, voxel}); }
  void join(const VoxelBounds& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], other.low[axis]);
      high[axis] = std::max(high[axis], other.high[axis]);
    }
  }
  // Whether the two come so near each other; an empty one comes near none.
  bool meets(const VoxelBounds& other, const Index3& within = {0, 0, 0}) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (other.high[axis] + within[axis] < low[axis]) return false;
      if (other.low[axis] - within[axis] > high[axis]) return false;
    }
    return true;
  }
  static constexpr int kFar = 1 << 30;

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.low, self.high);
  }
};

// Where a part of the body touches a piece, or would.
struct Touch {
  double gap_mm = 0.0;      // below 0: inside
  Vec3 normal{0.0};         // from the piece to the tool
  Vec3 lever_mm{0.0};       // from the tool's tip to where it touches
};

// Whether a tool removes what it may, by hand or driven by its motor.
enum class Cutting { nothing, by_hand, driven };

// Gathers the pieces near a tool. Of those that a part of the tool meets from the same direction
// only the nearest is kept: after the tool has moved by `margin_mm` another may be nearer, by a
// fraction of that. No allocation after it is made.
//
// What a driven part cuts is kept row by row: of each row of voxels that is looked at, the first on
// either side of the part. Once it is cut away the next of its row takes its place, so that the
// surface holds while the tool eats its way into it. A disk whose voxel went, or one near it,
// belongs to a surface that is another now: that is `stale`.
class SolidSurface {
 public:
  // `touch_version`: before 11 every tissue is kept by direction, and whatever goes makes all of it
  // stale; before 10 a driven tool thinner than a voxel's diagonal meets spheres between which
  // nothing slips, whatever its thickness.
  SolidSurface(const Tool& tool, const GridGeometry& geometry, int touch_version = kTouchVersion);

  PlacedBody place(const Pose& pose_mm) const;
  // Whether there may be solid tissue near the body on its straight way between two poses.
  bool mayMeet(const TissueField& tissue, const PlacedBody& from, const PlacedBody& to) const;
  // Begins to look for all pieces that the body meets within `margin_mm` of where it is. A driven
  // part meets tissue that it may cut at the centres of its voxels: as they go whole, it takes as
  // many as its volume holds.
  void begin(const TissueField& tissue, const PlacedBody& body, Cutting cutting);
  // Goes on with it, about a row of voxels for each of `work`. True when it is done and pieces()
  // are the new ones.
  bool goOn(const TissueField& tissue, int work);
  static constexpr int kAll = 1 << 30;
  bool underWay() const { return under_way_; }
  // The pieces were stale already when they were done.
  bool cameStale() const { return lost_; }
  void giveUp() { under_way_ = false; }
  int work() const { return work_; }  // of the last search, about in rows of voxels

  // Voxels of solid tissue went, all of them in `box`. From now on the pieces are stale, or those
  // of the search under way will be.
  struct Stale {
    bool now = false, next = false;
  };
  Stale removed(const TissueField& tissue, std::span<const std::uint32_t> voxels,
                const VoxelBounds& box);
  // Before version 11: forgets the pieces that are solid no more.
  void drop(const TissueField& tissue);

  std::span<const SurfacePiece> pieces() const { return pieces_; }
  // The numbers of all pieces that may be within a distance once the tool has travelled so far, by
  // what note() had of them, and of some others, in order. Until the pieces change.
  std::span<const std::uint32_t> awake(double within_mm, double travelled_mm);
  // A piece is no nearer than this.
  double leastGap_mm(std::size_t piece, double travelled_mm) const {
    return due_mm_[piece] - travelled_mm;
  }
  void note(std::size_t piece, double gap_mm, double travelled_mm) {
    due_mm_[piece] = gap_mm + travelled_mm;
  }
  // Where the body touches a piece, if within a distance. `gap_mm`: at least so far it is.
  std::optional<Touch> touchWithin(std::size_t piece, const PlacedBody& body, double within_mm,
                                   double& gap_mm) const;
  // A touch of a flat piece on the common plane of the pieces around its place, by weights that
  // fall with distance: a single piece is off by a degree or two.
  Touch blended(const Touch& touch, std::size_t piece, const PlacedBody& body);

  // Touch version 11 and later.
  bool byRows() const { return by_rows_; }
  // Whether the centre of a piece's voxel is in the body.
  bool centreIn(const PlacedBody& body) const;

  double margin_mm() const { return margin_mm_; }
  double voxel_mm() const { return voxel_mm_; }  // the smallest edge
  // Of the body, from the tip; and of what of it had solid tissue within kFar margins.
  double reach_mm() const { return reach_mm_; }
  double near_reach_mm() const { return near_reach_mm_; }
  static constexpr double kFar = 4.0;

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive.grown(self.pieces_);
    archive.grown(self.due_mm_);
    archive(self.disks_, self.near_reach_mm_, self.work_, self.under_way_);
    if (self.under_way_) {
      archive(self.cutting_, self.next_reach_mm_, self.done_, self.searched_, self.made_);
      archive(self.next_disks_, self.some_went_, self.lost_);
      archive.grown(self.stretches_);
      archive.grown(self.found_);
      archive.grown(self.next_);
    }
    if constexpr (Archive::kReads) {
      if (!self.takeOver()) archive.refuse();
    }
  }

 private:
  struct Cells {
    int along = 1, directions = 2, first = 0;  // of a part
    Index3 apart{1, 1, 1};                     // voxels from one row that is looked at to the next
  };
  // A stretch of a part's axis, in the grid's own axes, millimetres.
  struct Stretch {
    Capsule axis;
    Vec3 along{0.0};
    double per_length2 = 0.0;
    double from = 0.0, share = 1.0;  // where on the part's axis it begins, how much of it it is
    std::size_t part = 0;
    // Solid tissue is looked for between the two, which follow from the axis.
    CapsuleRows around, within;
    bool hollow = false;
    int plane = 0, last_plane = -1;  // the next to be looked at

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.axis, self.along, self.per_length2, self.from, self.share);
      archive.within(self.part, 0, std::int64_t(PlacedBody::kMost));
      archive(self.plane, self.last_plane);
    }
  };
  // A row of voxels; where right > left, what is between them is not looked at.
  struct Row {
    int from = 0, left = 0, right = 0, to = 0, j = 0, k = 0;
  };
  // The nearest solid voxel of a cell, or the first of a row.
  struct Found {
    Index3 voxel{0, 0, 0};
    std::size_t part = 0;
    Vec3 away_mm{0.0};  // from the part's axis, in the grid's own axes
    double distance2_mm2 = 0.0;
    std::int32_t cell = 0;  // kNoCell: of a row
    std::int32_t row_end = 0;
    std::int8_t row_step = 0;

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.voxel);
      archive.within(self.part, 0, std::int64_t(PlacedBody::kMost));
      archive(self.away_mm, self.distance2_mm2, self.cell, self.row_end);
      archive.within(self.row_step, -1, 2);
    }
  };
  void addStretch(const TissueField& tissue, Stretch stretch);
  void bound(Stretch& stretch) const;
  bool takeOver();
  int searchPlane(const TissueField& tissue, Stretch& stretch);
  void searchRows(const TissueField& tissue, const Stretch& stretch, std::span<const Row> rows);
  void searchRowParts(const TissueField& tissue, const Stretch& stretch, const Row& row);
  void find(const TissueField& tissue, const Index3& voxel, const Stretch& stretch,
            int row_step = 0, int row_end = 0);
  void addPiece(const TissueField& tissue, const Found& found);
  void finish(const TissueField& tissue);
  bool cutsRows(std::size_t part) const {
    return by_rows_ && cutting_ == Cutting::driven && parts_mm_[part].cuts;
  }
  bool mayCut(const TissueField& tissue, const Index3& voxel) const;
  bool goOnAlongRow(const TissueField& tissue, SurfacePiece& piece) const;
  std::size_t rowsAround(const Cells& of, double length_mm, double around_mm) const;
  void wake(std::size_t piece);
  void forgetAwake();
  void index();
  void index(std::size_t piece);
  std::size_t slotOf(std::uint32_t voxel) const;
  Index3 rowsApart(double radius_mm) const;

  GridGeometry geometry_;
  Mat4 patient_to_voxel_;
  std::vector<BodyPart> parts_mm_;  // tool frame
  std::vector<Cells> cells_;
  Vec3 spacing_mm_;
  double voxel_mm_, half_diagonal_mm_, margin_mm_, reach_mm_;
  bool wide_spheres_, by_rows_;
  Index3 fit_reach_{0, 0, 0};  // voxels around a disk's that its place follows from
  std::vector<SurfacePiece> pieces_;
  // By piece: the tool is not at it before it has travelled so far.
  std::vector<double> due_mm_;
  std::vector<std::uint32_t> awake_;  // those that are due until awake_until_mm_, in order
  double awake_until_mm_ = 0.0;
  VoxelBounds disks_;  // of pieces that are not of rows
  VoxelBounds rows_;   // where those of rows are, or may come
  double near_reach_mm_ = 0.0;
  // The search that is under way.
  bool under_way_ = false;
  int work_ = 0, done_ = 0;  // of the last search, of this one
  Cutting cutting_ = Cutting::nothing;
  double next_reach_mm_ = 0.0;
  std::vector<Stretch> stretches_;
  std::vector<Found> found_;
  std::vector<SurfacePiece> next_;
  VoxelBounds next_disks_;
  bool some_went_ = false;               // voxels since it began
  bool lost_ = false;                    // what stands behind one that went is not known
  std::size_t searched_ = 0, made_ = 0;  // of stretches, of found
  std::vector<std::int32_t> cell_;    // of each cell: which of the found it has
  std::vector<std::uint32_t> stamp_;   // of each cell, when it was last filled
  std::uint32_t turn_ = 0;
  // What follows from the pieces: by voxel, open addressing, a piece's number and one; and disks by
  // their places, made when they are asked for.
  std::vector<std::uint32_t> slots_;
  std::size_t slot_mask_ = 0, filled_ = 0;
  NearPieces near_{0};
  bool near_known_ = false;
  static constexpr std::int32_t kNoCell = -1;
  static constexpr double kPlate = 0.45;  // voxels: half the thickness of a plate as thin as one
  static constexpr double kStretch_mm =
      8.0;  // a longer part is searched in stretches of this length
  // One voxel at most is found in each part of a row, of this length or a voxel.
  static constexpr double kRowPart_mm = 0.4;
  // Where on an axis the nearest place to a point is, as a share of it.
  static double nearestOn(const Vec3& from, const Vec3& along, double per_length2, const Vec3& to) {
    return std::clamp(glm::dot(to - from, along) * per_length2, 0.0, 1.0);
  }
};

}  // namespace trephine
