// The surface of solid tissue near a tool, as pieces that the tool must stay outside of.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "haptics/surface_fit.h"
#include "haptics/swept_solid.h"
#include "haptics/tool.h"

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
  Vec3 at_mm{0.0};         // patient
  Vec3 normal{0.0};        // out of the tissue; zero: a sphere
  double size_mm = 0.0;    // radius of the disk or sphere
  std::int32_t part = 0;   // of the tool's body, to which it is near
  std::uint32_t voxel = 0;
  std::int8_t tissue_class = 0;
  bool cuttable = false;   // by this part
  bool flat = false;       // the surface around it is a plane
  // The proxy's: the gap when it was last looked at, and how far the tool had travelled then.
  double gap_mm = 0.0, travelled_mm = 0.0;

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.at_mm, self.normal, self.size_mm);
    archive.within(self.part, 0, std::int64_t(PlacedBody::kMost));
    archive(self.voxel);
    archive.within(self.tissue_class, 0, kMaxTissues);
    archive(self.cuttable, self.flat, self.gap_mm, self.travelled_mm);
  }
};

// Where a part of the body touches a piece, or would.
struct Touch {
  double gap_mm = 0.0;      // below 0: inside
  Vec3 normal{0.0};         // from the piece to the tool
  Vec3 lever_mm{0.0};       // from the tool's tip to where it touches
};

Touch touchOf(const SurfacePiece& piece, const PlacedBody& body);
// The same touch on the common plane of the flat pieces around its place, by weights that fall with
// distance: a single piece is off by a degree or two.
Touch blended(const Touch& touch, const SurfacePiece& piece, const PlacedBody& body,
              std::span<const SurfacePiece> pieces);

// Whether a tool removes what it may, by hand or driven by its motor.
enum class Cutting { nothing, by_hand, driven };

// Gathers the pieces near a tool. Of those that a part of the tool meets from the same direction
// only the nearest is kept: after the tool has moved by `margin_mm` another may be nearer, by a
// fraction of that. No allocation after it is made.
class SolidSurface {
 public:
  // `wide_spheres`: a driven tool thinner than a voxel's diagonal meets spheres between which
  // nothing slips, whatever its thickness.
  SolidSurface(const Tool& tool, const GridGeometry& geometry, bool wide_spheres = false);

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
  void giveUp() { under_way_ = false; }
  int work() const { return work_; }  // of the last search, about in rows of voxels

  // Forgets the pieces that are solid no more.
  void drop(const TissueField& tissue) {
    std::erase_if(pieces_, [&](const SurfacePiece& piece) {
      return !tissue.isSolid(tissue.classAt(piece.voxel));
    });
  }
  std::span<SurfacePiece> pieces() { return pieces_; }
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
    archive(self.near_reach_mm_, self.work_, self.under_way_);
    if (self.under_way_) {
      archive(self.cutting_, self.next_reach_mm_, self.done_, self.searched_, self.made_);
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
    std::size_t voxel = 0;
  };
  // The nearest solid voxel of a cell.
  struct Found {
    Index3 voxel{0, 0, 0};
    std::size_t part = 0;
    Vec3 away_mm{0.0};  // from the part's axis, in the grid's own axes
    double distance2_mm2 = 0.0;
    std::int32_t cell = 0;

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.voxel);
      archive.within(self.part, 0, std::int64_t(PlacedBody::kMost));
      archive(self.away_mm, self.distance2_mm2, self.cell);
    }
  };
  void addStretch(const TissueField& tissue, Stretch stretch);
  void bound(Stretch& stretch) const;
  bool takeOver();
  int searchPlane(const TissueField& tissue, Stretch& stretch);
  void searchRows(const TissueField& tissue, const Stretch& stretch, std::span<const Row> rows);
  void find(const Index3& voxel, const Stretch& stretch);
  void addPiece(const TissueField& tissue, const Found& found);
  Index3 rowsApart(double radius_mm) const;

  GridGeometry geometry_;
  Mat4 patient_to_voxel_;
  std::vector<BodyPart> parts_mm_;  // tool frame
  std::vector<Cells> cells_;
  Vec3 spacing_mm_;
  double voxel_mm_, half_diagonal_mm_, margin_mm_, reach_mm_;
  bool wide_spheres_;
  std::vector<SurfacePiece> pieces_;
  double near_reach_mm_ = 0.0;
  // The search that is under way.
  bool under_way_ = false;
  int work_ = 0, done_ = 0;  // of the last search, of this one
  Cutting cutting_ = Cutting::nothing;
  double next_reach_mm_ = 0.0;
  std::vector<Stretch> stretches_;
  std::vector<Found> found_;
  std::vector<SurfacePiece> next_;
  std::size_t searched_ = 0, made_ = 0;  // of stretches, of found
  std::vector<std::int32_t> cell_;    // of each cell: which of the found it has
  std::vector<std::uint32_t> stamp_;   // of each cell, when it was last filled
  std::uint32_t turn_ = 0;
};

}  // namespace trephine
