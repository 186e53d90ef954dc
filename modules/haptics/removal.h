// Removal of tissue from the solid that a tool sweeps, paid with the work that the tool did.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "haptics/swept_solid.h"
#include "haptics/tissue_field.h"
#include "haptics/tool.h"

namespace trephine {

// work: a tool removes V = W / u, W its work on tissue and u the tissue's specific cutting energy.
// instant: whatever the tool's solid meets goes at once (the seed paper's rule, without its gaps).
enum class RemovalKind : std::int32_t { work, instant };
inline constexpr std::array<std::pair<std::string_view, RemovalKind>, 2> kRemovalNames{
    {{"work", RemovalKind::work}, {"instant", RemovalKind::instant}}};

// A voxel that a tool takes, and what it paid.
struct RemovedVoxel {
  Index3 voxel{0, 0, 0};
  std::int32_t tissue_class = 0;
  double cost_J = 0.0;
};

// One tool's removal. It sweeps in passes over the rows of voxels that the solid crosses, a bounded
// number a tick, so that a tick costs the same on a fine grid as on a coarse one; on the finest a
// pass takes a few ticks. A pass looks only at what the one before did not clear.
//
// Where work is short, the nearest to the tool's axis goes first: a pass reaches at most one layer
// beyond what is clear, up to the tool's radius, so that what is cut is a smaller channel, not a
// sponge.
class Removal {
 public:
  // Along an axis of the grid the solid is never thinner than a voxel, or it would slip between
  // their centres: thick slices are cut one at a time, thin tools still thinly within them.
  Removal(const Tool& tool, const GridGeometry& geometry, RemovalKind kind, double period_s);

  // Every tick: the cutting work [J, 0 or more] that the tool did in it on tissue that may be cut.
  // The credit is capped by the work of the last 50 ms (fading with that time constant) and of two
  // voxels; the rest is heat. `lost_J` is all work that has gone into tissue so far, less what an
  // arm has given out: no more than that is ever spent.
  void giveWork(double work_J, double lost_J, const TissueField& tissue);
  // Goes on with the sweep to this pose; appends what the tool takes, which the caller removes in
  // this tick, to `removed` (room for kMostVoxels). No allocation.
  void sweep(const TissueField& tissue, const Pose& pose_mm, std::vector<RemovedVoxel>& removed);
  // From the next sweep on, voxels of these classes, a bit each, are left ahead of the tip: their
  // membrane is whole. Called every tick.
  void spareAhead(std::uint32_t classes) {
    if (classes == spared_) return;
    spared_ = classes;
    forget();
  }
  // A membrane gave way at `from_mm`: the tool has gone on at once from there, and sweeps its way.
  void goOnFrom(const Pose& from_mm);
  // Takes this one voxel, which holds the tool back, if the credit pays for it.
  void take(const TissueField& tissue, const Index3& voxel, int tissue_class,
            std::vector<RemovedVoxel>& removed);
  // By points alone (contact.h): the voxels of the points that touch, where the tool cuts.
  void takeTouched(const TissueField& tissue, std::span<const std::int64_t> voxels,
                   std::span<const std::int8_t> classes, std::vector<RemovedVoxel>& removed);
  // Work that was paid for a voxel, which was shared with another tool or could not be removed.
  void returnWork(double work_J) { spend(-work_J); }
  // Tissue came back, or another is meant by a HU: nothing is known to be clear.
  void forget() {
    known_ = false;
    passing_ = false;
  }

  // The arm had another tool until now: what that spent is spent, and what it had left is heat.
  void follow(const Removal& before) {
    credit_J_ = recent_J_ = 0.0;
    lost_J_ = before.lost_J_;
    spent_J_ = before.spent_J_;
    last_.reset();
    forget();
  }

  double credit_J() const { return credit_J_; }
  double spent_J() const { return spent_J_; }  // on voxels so far, less what was returned
  // After an undo the credit before the stroke, after a redo no more than before the undo. It fades
  // from there as if just given.
  void setCredit(double credit_J) {
    spend(credit_J_ - credit_J);
    recent_J_ = credit_J;
  }

  static constexpr std::size_t kMostVoxels = 512;  // a tick
  // No hand is as fast: beyond this a pose has jumped, sweeps nothing on its way and does no work.
  static constexpr double kFastest_m_s = 5.0;

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.recent_J_, self.credit_J_, self.spent_J_);
    archive(self.known_, self.clear_, self.last_);
    archive(self.passing_, self.paid_, self.backwards_, self.goal_);
    archive(self.slice_, self.row_, self.spared_, self.went_on_);
    if constexpr (Archive::kReads) {
      if (!self.takeOver()) archive.refuse();
    }
  }

 private:
  void spend(double price_J) {
    credit_J_ -= price_J;
    spent_J_ += price_J;
  }
  bool affords(double price_J) const {
    return kind_ == RemovalKind::instant || (price_J <= credit_J_ && spent_J_ + price_J <= lost_J_);
  }
  // Whole voxel indices; empty where first > last.
  struct Indices {
    int first = 0, last = -1;
  };
  // A row of voxels that the solid crosses, and what of it was cleared before.
  struct Row {
    Indices all, clear;
    int j = 0, k = 0, number = 0;
    std::size_t voxel = 0;  // linear index of the grid's first in this row
  };
  // What a sweep works on in a tick, and how many more voxels it may look at.
  struct Tick {
    const TissueField& tissue;
    std::vector<RemovedVoxel>& removed;
    int looks;
  };
  static Indices indices(const Interval& mm, double per_spacing, int count);
  void begin(const Capsule& now);
  void layOut();
  void end(const Capsule& now);
  bool beginWhereNeeded(const TissueField& tissue, const Capsule& now);
  bool sweepSlices(Tick& tick);
  bool sweepSlice(Tick& tick);
  int sliceNow() const;
  void layOutSlice(int k);
  bool takeOver();
  std::size_t findRows(Tick& tick, int k, int rows, int& next, std::span<Row> batch) const;
  bool sweepRow(Tick& tick, const Row& row);
  bool mayMeetTissue(const TissueField& tissue, const Capsule& now) const;
  Capsule capsuleAt(const Pose& pose_mm) const;
  double voxelWork_J(const TissueClass& tissue) const;
  double cost_J(const TissueClass& tissue) const;
  bool isSpared(int tissue_class, int i, int j, int k) const;

  Tool tool_;
  GridGeometry geometry_;
  Mat4 patient_to_voxel_;
  Mat3 normal_to_voxel_;  // of planes
  RemovalKind kind_;
  double voxel_m2_;  // new surface that a voxel of a slot stands for
  std::uint32_t spared_ = 0;
  bool went_on_ = false;  // the pass to come is of a way that goOnFrom() began
  // Of the tool in this sweep, voxels: its tip, and the way that it points.
  Vec3 tip_{0.0}, ahead_{0.0};
  Vec3 per_spacing_;  // 1 / mm
  Vec3
      spacing_mm_;  // as the sweep sees it: at most the tool's diameter, so that none slips between
  double radius_mm_;
  double layer_mm_;  // by which a pass reaches beyond what is clear: a voxel, a tenth of the radius
  double still_mm_;  // a tool that moved less stands still: an eighth of a voxel
  int looks_;        // voxels a tick
  double fading_;    // factor on recent_J_, a tick
  double recent_J_ = 0.0;                // work given, fading with a time constant of 50 ms
  double credit_J_ = 0.0;                // given and not spent
  double lost_J_ = 0.0, spent_J_ = 0.0;  // since the start

  bool known_ = false;  // `clear_` holds: all within it that can be taken has been
  Capsule clear_;
  bool passing_ = false;    // a pass, to goal_, is not done
  bool paid_ = true;        // every voxel of this pass so far
  bool backwards_ = false;  // every other pass, so that no side is favoured when work is short
  Capsule goal_;
  std::optional<Capsule> last_;  // in the tick before
  double farthest_mm_;           // a tick at kFastest_m_s
  SweptSolid solid_;
  CapsuleRows cleared_;
  std::int32_t slice_ = 0, slice_end_ = 0;  // counted from the pass's first
  std::int32_t row_ = 0;
  Index3 low_{0, 0, 0}, high_{0, 0, 0};  // bounds of the pass
};

}  // namespace trephine
