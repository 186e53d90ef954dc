// Where a tool can be: a pose that follows the arm's and never enters solid tissue (god-object:
// Zilles and Salisbury 1995; in six degrees of freedom: Ortega, Redon and Coquillart 2007).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "haptics/nearest_motion.h"
#include "haptics/solid_surface.h"

namespace trephine {

// What holds a tool back, patient axes.
struct Pull {
  Vec3 shift_mm{0.0};  // from the arm's tip to the proxy's
  Vec3 turn{0.0};      // from the arm's orientation to the proxy's: 2 sin(angle / 2) along its axis
  double turn_mm2 = 0.0;        // |turn|^2 times this counts as much as |shift|^2
  double stiffness = 0.0;       // N/m, of the tissue that holds; 0: nothing does
  bool drags = false;           // the tissue's dry friction is in it: the tool stays behind its arm
};

class Proxy {
 public:
  // `touch_version`: as SolidSurface has it; before 11 the way that a tool went counts, and not how
  // far it came.
  Proxy(const Tool& tool, const GridGeometry& geometry, int touch_version = kTouchVersion);

  // At the arm, whatever is there.
  void place(const Pose& pose_mm);
  // One tick towards the arm: as near to it as the solid tissue on the way allows, in steps of less
  // than half a voxel, kMostSteps of them. Voxels changed since the last tick only where changed()
  // or removed() said so.
  // `friction_N`: the dry friction of the solid tissue that it touches. Where that bears load the
  // tool does not slide before the pull along the surface is more, and then stays behind its arm by
  // so much pull: of what the arm does nothing is stored but in that one pull. `by_push`: of that
  // tissue, its coefficient times the force with which the tool is pressed on it, beside that.
  void follow(const TissueField& tissue, const Pose& arm_mm, Cutting cutting,
              double friction_N = 0.0, bool by_push = false);
  // Back to where it was before follow(). The tissue that held it in the last step of that still
  // pulls; where none did, nothing pulls.
  void hold(const Pose& pose_mm);
  // At the arm, whatever is there. True where its body is in solid tissue.
  bool standsInSolid(const TissueField& tissue, const Pose& arm_mm);
  // Multiplies the stiffness of the pull in this tick.
  void fade(double share) { pull_.stiffness *= share; }
  // Voxels around it came back, or mean other tissue.
  void changed() {
    gathered_ = false;
    surface_.giveUp();
  }
  // Voxels of solid tissue went, all of them in `box`.
  void removed(const TissueField& tissue, std::span<const std::uint32_t> voxels,
               const VoxelBounds& box);

  const Pose& pose_mm() const { return pose_; }
  const Pull& pull() const { return pull_; }
  bool held() const { return held_by_ >= 0; }
  // The class of the tissue that bears most of the load, -1 where nothing holds it.
  std::int8_t heldBy() const { return held_by_; }
  // The pieces of tissue that hold it back and that this tool may cut.
  struct Blocker {
    std::uint32_t voxel = 0;
    std::int8_t tissue_class = 0;
  };
  std::span<const Blocker> blockers() const { return {blockers_.data(), blocker_count_}; }
  // The pose moved towards the arm by at most so far, at its farthest point: what it would enter.
  Pose ahead_mm(double by_mm) const;

  static constexpr int kMostSteps = 8;

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.surface_, self.pose_, self.cutting_);
    archive(self.gathered_, self.stale_, self.next_stale_, self.gone_);
    archive(self.from_, self.next_from_);
    archive(self.travelled_, self.next_travelled_, self.last_step_mm_);
    archive(self.stiffness_);
    archive.within(self.held_by_, -1, kMaxTissues);
  }

 private:
  // Upper bounds of how far the body went: by shifts, and by turns at a distance from the tip.
  struct Travel {
    double shift_mm = 0.0, turn = 0.0;
    double of_mm(double reach_mm) const { return shift_mm + reach_mm * turn; }
    void add(const SmallMotion& motion) {
      shift_mm += glm::length(motion.shift_mm);
      turn += glm::length(motion.turn);
    }

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.shift_mm, self.turn);
    }
  };
  // A tick's way towards the arm.
  struct Way {
    PlacedBody body;
    double step_mm = 0.0;            // at most, in the next step
    double friction_N = 0.0;
    bool by_push = false;
    // Of the touches in the last step: the sum of loads, that of load times stiffness and times the
    // coefficient of friction, the greatest load and the class of its tissue.
    double load = 0.0, stiff = 0.0, rough = 0.0, most = 0.0;
    std::int8_t tissue_class = -1;
    double least_mm = 0.0;  // gap that the next pose must have at least
    bool inside = false;    // deeper than kInside: it is put outside first
  };
  // A piece that is near, before flat ones are merged.
  struct Near {
    Touch touch;
    std::size_t piece = 0;  // its number
    bool flat = false, merged = false;
  };
  void pullBack();
  // Upper bound of how far the points near tissue moved, or a quarter of how far the others did, if
  // that is more: the gathered surface holds for so much of its margin.
  double usedUp_mm(const Travel& travel) const;
  double way_mm(const SmallMotion& motion) const;
  double cost(const SmallMotion& motion) const;
  double travelled_mm() const { return travelled_.of_mm(surface_.near_reach_mm()); }
  void look(const TissueField& tissue, const PlacedBody& body, double step_mm, double speed,
            bool ahead);
  double went_mm() const;
  double worn(double step_mm) const;
  std::size_t nearPieces(const PlacedBody& body, double within_mm, double moved_mm);
  std::size_t merge(std::size_t first, std::size_t count);
  double touches(const PlacedBody& body, double within_mm, double moved_mm, double clear_mm);
  SmallMotion dragged(const SmallMotion& motion, const SmallMotion& wanted, const Way& way) const;
  void move(const Pose& to, const PlacedBody& body, Way& way);
  bool goFreely(Way& way);
  bool slide(const TissueField& tissue, Way& way);
  bool putBack(const SmallMotion& motion, double least_mm, Pose& there, PlacedBody& body,
               bool& bent);

  SolidSurface surface_;
  Pose pose_, arm_;
  Pull pull_;
  double turn_mm2_;
  bool gathered_ = false;                    // the surface's pieces are of around here
  bool stale_ = false, next_stale_ = false;  // voxels went since that search, since the next began
  bool gone_ = false;      // before version 11: some of the pieces may be of voxels that went
  Pose from_, next_from_;  // where it was as that search began, as the next did
  Cutting cutting_ = Cutting::nothing;
  Travel travelled_, next_travelled_;  // since that search, since the next began
  double last_step_mm_ = 0.0;          // in the last tick
  bool loaded_ = false;                // something held it in the last step
  // Of the tissue that held it last, until it is at the arm.
  double stiffness_ = 0.0;  // N/m, the mean by load
  std::int8_t held_by_ = -1;
  std::array<NearTouch, kMostTouches> touches_;
  std::array<std::size_t, kMostTouches> touched_;  // piece, by each of them
  std::array<Near, kMostTouches> near_;
  std::size_t touch_count_ = 0;
  std::array<Blocker, kMostTouches> blockers_;
  std::size_t blocker_count_ = 0;
};

}  // namespace trephine
