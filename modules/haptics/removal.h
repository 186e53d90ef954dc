// Removal of tissue from the solid that a tool sweeps, paid with the work that the tool did.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "haptics/swept_solid.h"
#include "haptics/tissue_bricks.h"
#include "haptics/tissue_lookup.h"
#include "haptics/tool.h"
#include "volume/grid.h"

namespace trephine {

// work: a tool removes V = W / u, W its work on tissue and u the tissue's specific cutting energy.
// instant: whatever the tool's solid meets goes at once (the seed paper's rule, without its gaps).
enum class RemovalKind : std::int32_t { work, instant };
inline constexpr std::array<std::pair<std::string_view, RemovalKind>, 2> kRemovalNames{
    {{"work", RemovalKind::work}, {"instant", RemovalKind::instant}}};

// A voxel that an arm takes, and what it paid.
struct Bite {
  Index3 voxel{0, 0, 0};
  std::int32_t tissue_class = 0;
  double cost_J = 0.0;
};

// One tool's removal. It sweeps in passes over the rows of voxels that the solid crosses, a bounded
// number a tick, so that a tick costs the same on a fine grid as on a coarse one; on the finest a
// pass takes a few ticks. A pass looks only at what the last one did not clear.
//
// Where work is short, the nearest to the tool's axis goes first: a pass reaches at most one layer
// beyond what is clear, up to the tool's radius, so that what is cut is a smaller channel, not a
// sponge.
class Removal {
 public:
  // Along an axis of the grid the solid is never thinner than a voxel, or it would slip between
  // their centres: thick slices are cut one at a time, thin tools still thinly within them.
  Removal(const Tool& tool, const GridGeometry& geometry, RemovalKind kind, double period_s);

  // Every tick: the work that the tool did in it on tissue that may be cut, or 0; never less. What
  // is not spent within 50 ms or so is heat: the credit is capped by the work of that time and of
  // two voxels. `lost_J` is all that has ever gone into tissue: no more than that is spent, though
  // an arm may have given out since it was earned.
  void earn(double work_J, double lost_J, const TissueTable& tissues);
  // Goes on with the sweep to this pose; appends what the tool takes, which the caller removes in
  // this tick, to `bites` (room for kMostBites). No allocation.
  void sweep(const Grid& grid, const TissueBricks& bricks, const TissueLookup& lookup,
             const TissueTable& tissues, const Pose& pose_mm, std::vector<Bite>& bites);
  // Takes this one voxel, which holds the tool back, if the credit pays for it.
  void take(const Index3& voxel, int tissue_class, const TissueTable& tissues,
            std::vector<Bite>& bites);
  // A voxel was shared with another tool, or could not be removed.
  void refund(double work_J) { spend(-work_J); }
  // Tissue came back, or another is meant by a HU: nothing is known to be clear.
  void forget() {
    known_ = false;
    passing_ = false;
  }

  double credit_J() const { return credit_J_; }
  // As it was before an undo's stroke, or after a redo's: what that stroke spent was not spent, or
  // was. It fades from there as if just earned.
  void setCredit(double credit_J) {
    spend(credit_J_ - credit_J);
    recent_J_ = credit_J;
  }

  static constexpr std::size_t kMostBites = 512;  // a tick
  // No hand is as fast: a pose that jumps sweeps nothing between and does no work.
  static constexpr double kFastest_m_s = 5.0;

 private:
  void spend(double price_J) {
    credit_J_ -= price_J;
    spent_J_ += price_J;
  }
  bool affords(double price_J) const {
    return kind_ == RemovalKind::instant || (price_J <= credit_J_ && spent_J_ + price_J <= lost_J_);
  }
  void begin(const Capsule& now);
  void end(const Capsule& now);
  bool mayMeetTissue(const TissueBricks& bricks, const Capsule& now) const;
  Capsule capsuleAt(const Pose& pose_mm) const;

  Tool tool_;
  GridGeometry geometry_;
  Mat4 patient_to_voxel_;
  RemovalKind kind_;
  Vec3 per_spacing_;  // 1 / mm
  Vec3 spacing_mm_;  // as the sweep sees it: an axis of thick voxels is shrunk to the tool
  double radius_mm_;
  double layer_mm_;
  double still_mm_;
  int looks_;  // a tick
  double fading_;          // of recent_J_, a tick
  double recent_J_ = 0.0;  // work of the last 50 ms, fading
  double credit_J_ = 0.0;
  double lost_J_ = 0.0, spent_J_ = 0.0;

  bool known_ = false;  // `clear_` holds: all within it that can be taken has been
  Capsule clear_;
  bool passing_ = false;
  bool paid_ = true;    // every voxel of this pass so far
  bool backwards_ = false;  // every other pass, so that no side is favoured when work is short
  Capsule goal_;
  std::optional<Capsule> last_;  // in the tick before
  double farthest_mm_;           // that a tool can go in a tick
  SweptSolid solid_;
  CapsuleRows cleared_;
  std::int32_t slice_ = 0, slice_end_ = 0;  // counted from the pass's first
  std::int32_t row_ = 0;
  Index3 low_{0, 0, 0}, high_{0, 0, 0};  // bounds of the pass
};

}  // namespace trephine
