// What soft tissue does to the place of a tool: a membrane holds its tip until it gives way, and
// tissue that is whole before its edge, or lies along its shaft, keeps it behind its arm.
//
// The tool is drawn, cuts and touches where it is held; tissue itself does not move here. What the
// arm puts in is in two springs, one from where a membrane was met to the arm, one from the tool to
// there. A tool that is let go only takes from them, so that no law of soft tissue can give out
// more than it took in.
//
// Units: places in mm, patient axes; forces in N; stiffness in N/m; work in J. One haptic thread;
// no allocation after construction.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/math.h"
#include "haptics/soft_pull.h"
#include "haptics/tissue_field.h"
#include "haptics/tool.h"

namespace trephine {

// Which of the laws of soft tissue an exercise names (haptics/laws.h).
struct SoftLaws {
  bool membrane = false, cutting = false, friction = false, relaxation = false;
  bool any() const { return membrane || cutting || friction; }
};

class SoftHold {
 public:
  SoftHold(const Tool& tool, const GridGeometry& geometry, const SoftLaws& laws, double period_s);

  // The tool is at its arm, whatever is there, and nothing holds it.
  void place(const Pose& arm_mm);
  // Nothing is stretched: the laws begin anew where the tool is.
  void forget();

  // Where the tool would be by soft tissue alone. `stopped`: solid tissue held it in the tick
  // before, or it is paused; then it goes along with its arm, as far behind it as it was.
  // `driven`: its motor runs, which pays for cutting instead of the hand.
  Pose follow(const TissueField& tissue, const Pose& arm_mm, bool stopped, bool driven);
  // Where solid tissue let it come to. Returns where it is: short of that where its tip met a
  // membrane, which it does not while `stopped`.
  Pose moved(const TissueField& tissue, const Pose& tool_mm, bool stopped);
  // Voxels came back: a membrane that is whole again has no hole.
  void restored(const TissueField& tissue);

  const SoftPull& pull() const { return pull_; }
  // A membrane gave way in this tick.
  bool gaveWay() const { return gave_way_; }
  const Vec3& gaveWay_mm() const { return holes_[std::size_t(hole_)].from_mm; }
  // Work of this tick that parted tissue [J].
  double cut_J() const { return cut_J_; }
  // The classes that are membranes and whole before the tip, a bit each: nothing ahead of the tip
  // is cut of them.
  std::uint32_t wholeBefore(const TissueTable& tissues) const;

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.last_, self.stretch_mm_, self.crept_mm_, self.cutting_share_);
    archive(self.tip_mm_, self.behind_mm_, self.fresh_, self.enclosed_);
    for (auto* c : {&self.held_, &self.class_, &self.passing_, &self.ahead_}) {
      archive.within(*c, -1, kMaxTissues);
    }
    archive(self.from_mm_, self.kept_mm_, self.inwards_, self.crept_travel_mm_);
    archive(self.away_mm_, self.within_mm_, self.turn_);
    archive.within(self.hole_, -1, kHoles);
    archive.within(self.next_hole_, 0, kHoles);
    archive(self.holes_);
    for (auto& one : self.shaft_) archive.within(one, -1, kMaxTissues);
    for (auto& one : self.edge_) archive.within(one, -1, kMaxTissues);
    if constexpr (Archive::kReads) self.count();
  }

 private:
  // Of a membrane that gave way to this tool: from where the tip met it to where it came in it.
  struct Hole {
    Vec3 from_mm{0.0}, to_mm{0.0};
    std::int32_t tissue_class = -1;  // -1: none

    template <class Self, class Archive>
    static void visitState(Self& self, Archive& archive) {
      archive(self.from_mm, self.to_mm);
      archive.within(self.tissue_class, -1, kMaxTissues);
    }
  };
  // What a way through tissue costs.
  struct Cost {
    double cutting_N = 0.0, friction_N = 0.0;
  };
  static constexpr std::int32_t kHoles = 32;

  Vec3 placeOf(const Vec3& patient_mm) const {
    return Vec3(patient_to_voxel_ * glm::dvec4(patient_mm, 1.0));
  }
  // The way that the tool points.
  Vec3 forwards() const { return last_.orientation * Vec3(0.0, 0.0, -1.0); }
  bool pressesOn(const TissueField& tissue) const;
  double letGo_J(const TissueField& tissue);
  void slip(const TissueField& tissue, const Vec3& target_mm, bool driven, double let_go_J);
  Cost costOf(const TissueField& tissue, const Vec3& way, int ahead, bool driven) const;
  void lookAlong(const TissueField& tissue);
  void lookBefore(const TissueField& tissue, const Vec3& way);
  int classBeside(const TissueField& tissue, const Vec3& place) const;
  int softAt(const TissueField& tissue, const Vec3& place) const;
  Vec3 beyond(const Vec3& way) const;
  void creep(const TissueField& tissue);
  void tell(const TissueField& tissue);
  bool meets(const TissueField& tissue, const Vec3& tip_mm, const Vec3& place, int c) const;
  bool isEnclosed(const TissueField& tissue, const Pose& at) const;
  bool isSheet(const TissueField& tissue, const Vec3& place, int c) const;
  std::int32_t holeAt(const Vec3& tip_mm, int c) const;
  void meet(int c, const Vec3& tip_mm);
  Vec3 wayOfTip(const Vec3& tip_mm) const;
  void count();

  SoftLaws laws_;
  Mat4 patient_to_voxel_;
  Mat3 turn_to_voxel_;
  double period_s_;
  double width_mm_;                 // of the tool
  double slot_mm_;                  // half the width of what it cuts of this grid
  double part_mm_;                  // of the shaft
  double edge_part_mm_ = 0.0;       // of the edge
  double voxel_mm_;                 // its longest edge
  double step_mm_;                  // between two looks along the way of the tip
  bool parts_tissue_;               // it is sharp
  Vec3 reach_{0.0};                 // voxels, from the axis to half a voxel beyond the slot
  std::vector<std::int8_t> shaft_;  // the tissue at each part of the shaft, from the tip on
  std::vector<std::int8_t> edge_;   // the tissue before each part of the edge
  std::array<std::int32_t, kMaxTissues> parts_{};  // of the shaft in each tissue
  std::int32_t in_tissue_ = 0;                     // parts of it in any
  std::uint32_t turn_ = 0;

  Pose last_;                   // where the tool would be by soft tissue
  Vec3 arm_mm_{0.0};            // the arm's tip, in this tick
  Vec3 stretch_mm_{0.0};        // from the tool's tip towards its arm's
  Vec3 crept_mm_{0.0};          // of that, what no longer pulls
  double cutting_share_ = 0.0;  // of the force of that
  Vec3 tip_mm_{0.0};            // the tool's tip
  Vec3 behind_mm_{0.0};         // is drawn along by the tip
  bool fresh_ = true;           // the tip was placed, and its tissue is not known
  std::int32_t class_ = -1;     // at the tip
  std::int32_t ahead_ = -1;     // before the slot that it has cut
  bool enclosed_ = false;       // and there is tissue beside the tip
  std::int32_t held_ = -1;      // of the membrane that holds the tip; -1: none does
  Vec3 from_mm_{0.0};           // where the arm was when the tip met it
  Vec3 kept_mm_{0.0};           // and the place that the tool follows meanwhile
  Vec3 inwards_{0.0};           // how the tip moved
  double crept_travel_mm_ = 0.0;
  std::int32_t passing_ = -1;  // of the membrane that the tip has gone into
  double away_mm_ = 0.0;       // way since the tip was in that tissue
  double within_mm_ = 0.0;     // way on in it since it gave way
  std::int32_t hole_ = -1;     // that the tip is in, -1: none; and the next to be written
  std::int32_t next_hole_ = 0;
  std::array<Hole, kHoles> holes_{};

  SoftPull pull_;
  bool gave_way_ = false;
  double cut_J_ = 0.0;
};

}  // namespace trephine
