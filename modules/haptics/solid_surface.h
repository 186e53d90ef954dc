// The surface of solid tissue near a tool, as pieces that the tool must stay outside of.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "haptics/swept_solid.h"
#include "haptics/tissue_bricks.h"
#include "haptics/tissue_lookup.h"
#include "haptics/tool.h"
#include "volume/grid.h"

namespace trephine {

// A disk on the surface of a voxel of solid tissue that borders on what is not solid, placed within
// the voxel by partial volume, or a small ball where the voxel has no clear side (a plate as thin as
// a voxel). Disks of neighbours overlap, so that nothing slips between them.
struct SurfacePiece {
  Vec3 at_mm{0.0};         // patient
  Vec3 normal{0.0};        // out of the tissue; zero: a ball
  double size_mm = 0.0;    // radius of the disk or ball
  std::int32_t part = 0;   // of the tool's body, that is near
  std::uint32_t voxel = 0;
  std::int8_t tissue_class = 0;
  bool cuttable = false;   // by this part
  // The solver's: with what it held the tool back last time, how near the tool was when it was last
  // looked at, and how far the tool had travelled then.
  double load = 0.0, gap_mm = 0.0, travelled_mm = 0.0;
};

// Where a part of the body touches a piece, or would.
struct Touch {
  double gap_mm = 0.0;      // below 0: inside
  Vec3 normal{0.0};         // from the piece to the tool
  Vec3 lever_mm{0.0};       // from the tool's tip to where it touches
};

// A tool's body at a pose, patient axes.
struct PlacedBody {
  static constexpr std::size_t kMost = 4;
  struct Part {
    Vec3 from_mm{0.0}, along_mm{0.0};
    double per_length2 = 0.0;  // 1 / |along|^2, 0 for a ball
    double radius_mm = 0.0;
  };
  std::array<Part, kMost> parts;
  std::size_t count = 0;
  Vec3 tip_mm{0.0};
};

Touch touchOf(const SurfacePiece& piece, const PlacedBody& body);

// Whether a tool removes what it may, by hand or driven by its motor.
enum class Cutting { nothing, by_hand, driven };

// Gathers the pieces near a tool. Of those that a part of the tool meets from the same side one is
// enough, the nearest; what another sees first after the tool has moved by `margin_mm` is then off by
// a fraction of that.
class SolidSurface {
 public:
  SolidSurface(const Tool& tool, const GridGeometry& geometry);

  PlacedBody place(const Pose& pose_mm) const;
  // Whether there may be solid tissue near the body on its straight way between two poses.
  bool mayMeet(const TissueBricks& bricks, const PlacedBody& from, const PlacedBody& to) const;
  // All pieces that the body meets within `margin_mm` of where it is. A driven part meets tissue that
  // it may cut at the centres of its voxels: as they go whole, it takes as many as its volume holds.
  // No allocation.
  void gather(const Grid& grid, const TissueBricks& bricks, const TissueLookup& lookup,
              const TissueTable& tissues, const PlacedBody& body, Cutting cutting);
  // Forgets the pieces that are solid no more.
  void drop(const Grid& grid, const TissueLookup& lookup) {
    std::erase_if(pieces_, [&](const SurfacePiece& piece) {
      return !lookup.isSolid(lookup.classAt(grid, piece.voxel));
    });
  }
  std::span<SurfacePiece> pieces() { return pieces_; }

  double margin_mm() const { return margin_mm_; }
  double voxel_mm() const { return voxel_mm_; }  // the smallest edge
  double reach_mm() const { return reach_mm_; }  // of the body, from the tip

 private:
  struct Cells {
    int along = 1, directions = 2, first = 0;  // of a part
  };
  struct View {
    const Grid& grid;
    const TissueLookup& lookup;
    const TissueTable& tissues;
  };
  // A stretch of a part's axis, in the grid's own axes, millimetres.
  struct Stretch {
    Capsule axis;
    Vec3 along{0.0};
    double per_length2 = 0.0;
    double from = 0.0, share = 1.0;  // where on the part's axis it begins, how much of it it is
    std::size_t part = 0;
  };
  // The nearest solid voxel of a cell.
  struct Found {
    Index3 voxel{0, 0, 0};
    std::size_t part = 0;
    Vec3 away_mm{0.0};  // from the part's axis, in the grid's own axes
    double distance2_mm2 = 0.0;
  };
  void searchAround(const View& view, const TissueBricks& bricks, const Stretch& stretch);
  void find(const Index3& voxel, const Stretch& stretch);
  void smooth();
  void addPiece(const View& view, const Found& found, Cutting cutting);
  Index3 rowsApart(double radius_mm) const;

  GridGeometry geometry_;
  Mat4 patient_to_voxel_;
  std::vector<BodyPart> parts_mm_;  // tool frame
  std::vector<Cells> cells_;
  Vec3 spacing_mm_;
  double voxel_mm_, half_diagonal_mm_, margin_mm_, reach_mm_;
  std::vector<SurfacePiece> pieces_, rough_;
  std::vector<Found> found_;
  std::vector<std::int32_t> cell_;    // of each cell: which of the found it has
  std::vector<std::uint32_t> stamp_;   // of each cell, when it was last filled
  std::uint32_t turn_ = 0;
};

}  // namespace trephine
