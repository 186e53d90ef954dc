// Where a tool can be: a pose that follows the arm's and never enters solid tissue (god-object:
// Zilles and Salisbury 1995; in six degrees of freedom: Ortega, Redon and Coquillart 2007).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "haptics/solid_surface.h"

namespace trephine {

// What holds a tool back, patient axes.
struct Pull {
  Vec3 shift_mm{0.0};  // from the arm's tip to the proxy's
  Vec3 turn{0.0};      // from the arm's orientation to the proxy's: 2 sin(angle / 2) along its axis
  double turn_mm2 = 0.0;        // a turn of one costs as much as a shift of sqrt(this)
  double stiffness = 0.0;       // N/m, of the tissue that holds; 0: nothing does
};

class Proxy {
 public:
  Proxy(const Tool& tool, const GridGeometry& geometry);

  // The tissue that it moves among; voxels change between two calls only where changed() says so.
  struct Tissue {
    const Grid& grid;
    const TissueBricks& bricks;
    const TissueLookup& lookup;
    const TissueTable& classes;
  };
  // At the arm, whatever is there.
  void place(const Pose& pose_mm);
  // One tick towards the arm: as near to it as the solid tissue on the way allows, in steps of less
  // than half a voxel, kMostSteps of them.
  void follow(const Tissue& tissue, const Pose& arm_mm, Cutting cutting);
  // Stays where it was before follow().
  void hold(const Pose& pose_mm);
  // The pull is let go: this share of its stiffness is left.
  void fade(double share) { pull_.stiffness *= share; }
  // Voxels around it came back, or mean other tissue.
  void changed() { gathered_ = false; }
  // Voxels around it went.
  void removed() { stale_ = true; }

  const Pose& pose_mm() const { return pose_; }
  const Pull& pull() const { return pull_; }
  bool held() const { return pull_.stiffness > 0.0; }
  // The pieces of tissue that hold it back and that this tool may cut.
  struct Blocker {
    std::uint32_t voxel = 0;
    std::int8_t tissue_class = 0;
  };
  std::span<const Blocker> blockers() const { return {blockers_.data(), blocker_count_}; }
  // The pose moved towards the arm by at most so far, at its farthest point: what it would enter.
  Pose ahead_mm(double by_mm) const;

  static constexpr int kMostSteps = 8;

 private:
  static constexpr std::size_t kMostContacts = 64;
  struct Contact {
    Vec3 normal{0.0}, moment{0.0};
    double gap_mm = 0.0, softness = 0.0, load = 0.0;
    SurfacePiece* piece = nullptr;
  };
  struct Motion {
    Vec3 shift_mm{0.0}, turn{0.0};
  };
  Motion towards(const Pose& from, const Pose& to) const;
  double way_mm(const Motion& motion) const;
  double cost(const Motion& motion) const;
  double contacts(const PlacedBody& body, double within_mm, double moved_mm);
  void solve(Motion& motion);

  SolidSurface surface_;
  Pose pose_, arm_;
  Pull pull_;
  double turn_mm2_;
  bool gathered_ = false, stale_ = false;
  Cutting cutting_ = Cutting::nothing;
  double travelled_mm_ = 0.0;  // since the surface was gathered
  double last_step_mm_ = 0.0;
  double stiffness_ = 0.0;  // of what held it last, until it is at the arm
  std::array<Contact, kMostContacts> contacts_;
  std::size_t contact_count_ = 0;
  std::array<Blocker, kMostContacts> blockers_;
  std::size_t blocker_count_ = 0;
};

}  // namespace trephine
