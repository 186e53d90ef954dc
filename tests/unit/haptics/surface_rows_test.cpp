// The surface that a driven tool eats into is kept row by row: what it holds is what a search anew
// would find, however much went meanwhile.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "base/rt/alloc_guard.h"
#include "haptics/proxy.h"
#include "haptics_support.h"
#include "strokes_support.h"

namespace trephine {
namespace {

using VoxelSet = std::set<std::uint32_t>;

// A block of bone with a slab of dura on its far side, voxels of 0.25 mm, the origin in its middle.
Volume block() {
  Volume volume;
  volume.geometry.size = {70, 70, 70};
  volume.geometry.spacing_mm = {0.15, 0.3, 0.35};
  volume.geometry.origin_mm = -0.5 * volume.geometry.spacing_mm * Vec3(69.0);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  for (int k = 0; k < 45; ++k) {
    for (int j = 5; j < 65; ++j) {
      for (int i = 5; i < 65; ++i) {
        volume.hu[volume.geometry.indexOf(i, j, k)] = k < 12 ? 150 : test::kBoneHu;
      }
    }
  }
  return volume;
}

TissueTable boneOverDura() {
  TissueTable table = test::boneTable(10.0, 900.0, 0.0);
  table.classes[0].solid = table.classes[0].cuttable = 1;
  table.classes[1] = table.classes[0];
  table.classes[1].hu_min = 100;
  table.classes[1].hu_max = 225;
  table.classes[1].cuttable = 0;
  table.classes[0].hu_min = 226;
  table.count = 2;
  return table;
}

struct Bone {
  Bone() : grid(block()), writer(grid.takeWriter()), tissue(grid, boneOverDura()) {}
  const GridGeometry& geometry() const { return grid.geometry(); }
  // All that may be cut within so far of a place goes.
  SolidSurface::Stale cut(SolidSurface& surface, const Vec3& at_mm, double radius_mm) {
    std::vector<std::uint32_t> went;
    VoxelBounds box;
    for (std::size_t v = 0; v < geometry().voxelCount(); ++v) {
      const Index3 at = geometry().indicesOf(v);
      const int c = tissue.classAt(v);
      const Vec3 mm = geometry().toPatient_mm(Vec3(at[0], at[1], at[2]));
      if (c < 0 || !tissue.ofClass(c).cuttable || glm::distance(mm, at_mm) > radius_mm) continue;
      writer->store(v, kAirHu);
      tissue.removed(at, c);
      went.push_back(std::uint32_t(v));
      box.add(at);
    }
    rt::NoAllocation guard;
    return went.empty() ? SolidSurface::Stale{} : surface.removed(tissue, went, box);
  }
  Grid grid;
  std::optional<Grid::Writer> writer;
  TissueField tissue;
};

VoxelSet rowsOf(const SolidSurface& surface) {
  VoxelSet out;
  for (const SurfacePiece& piece : surface.pieces()) {
    if (piece.row_step != 0 && piece.voxel != SurfacePiece::kGone) out.insert(piece.voxel);
  }
  return out;
}

const Tool kBurr = test::tool(ToolKind::burr, 40.0, 2.0, 4.0);
const Tool kSaw = test::tool(ToolKind::blade, 6.0, 0.6, 4.0);

TEST(SurfaceRows, AreThoseOfASearchAnewHoweverMuchWent) {
  for (const Tool* tool : {&kBurr, &kSaw}) {
    Bone bone;
    std::mt19937 random(3);
    const auto in = [&](double from, double to) {
      return from + (to - from) * double(random()) / 4294967296.0;
    };
    SolidSurface surface(*tool, bone.geometry()), anew(*tool, bone.geometry());
    std::size_t most = 0;
    for (int place = 0; place < 12; ++place) {
      const Pose pose_mm{{in(-6, 6), in(-6, 6), in(1.0, 4.5)},
                         test::turned({in(-1, 1), in(-1, 1), in(-1, 1)})};
      const PlacedBody body = surface.place(pose_mm);
      bone.cut(surface, pose_mm.position, 1.5);
      surface.begin(bone.tissue, body, Cutting::driven);
      // Some of it goes while it is looked for.
      (void)surface.goOn(bone.tissue, 200);
      bone.cut(surface, pose_mm.position + Vec3(in(-2, 2), in(-2, 2), -1.0), 1.2);
      while (surface.underWay()) {
        (void)surface.goOn(bone.tissue, 100);
        bone.cut(surface, pose_mm.position + Vec3(in(-2, 2), in(-2, 2), -1.5), 0.6);
      }
      for (int n = 0; n < 6; ++n) {
        bone.cut(surface, pose_mm.position + Vec3(in(-3, 3), in(-3, 3), in(-3, 1)), 0.9);
      }
      anew.begin(bone.tissue, body, Cutting::driven);
      ASSERT_TRUE(anew.goOn(bone.tissue, SolidSurface::kAll));
      const VoxelSet kept = rowsOf(surface), found = rowsOf(anew);
      most = std::max(most, found.size());
      // What is kept may lie a little farther than a search looks.
      EXPECT_TRUE(std::ranges::includes(kept, found)) << place;
      EXPECT_LT(double(kept.size()), 1.3 * double(found.size()) + 4.0);
    }
    EXPECT_GT(most, 40u);
  }
}

TEST(SurfaceRows, AreFoundAndFollowedWithoutAllocating) {
  Bone bone;
  SolidSurface surface(kBurr, bone.geometry());
  const std::uint64_t before = rt::guardedAllocations();
  for (int n = 0; n < 10; ++n) {
    const Pose pose_mm{{0.5 * n - 2.0, 0.0, 3.0 - 0.2 * n}, test::turned({0.1 * n, 0.3, 0.0})};
    {
      rt::NoAllocation guard;
      surface.begin(bone.tissue, surface.place(pose_mm), Cutting::driven);
      ASSERT_TRUE(surface.goOn(bone.tissue, SolidSurface::kAll));
    }
    bone.cut(surface, pose_mm.position, 2.3);
  }
  EXPECT_EQ(rt::guardedAllocations(), before);
}

TEST(SurfaceRows, WhatIsNotCutIsMetWhereARowEndsAtItAndIsSearchedAnew) {
  Bone bone;
  SolidSurface surface(kBurr, bone.geometry());
  // Bone alone about it, and a way for its shaft; dura begins 8 mm below the middle.
  const Vec3 at_mm(0.0, 0.0, -5.0), ball_mm(0.0, 0.0, 2.0);
  SolidSurface::Stale stale;
  for (double z = -3.0; z < 5.0; z += 0.5) bone.cut(surface, {0.0, 0.0, z}, 2.2);
  surface.begin(bone.tissue, surface.place({at_mm, Quat(1, 0, 0, 0)}), Cutting::driven);
  ASSERT_TRUE(surface.goOn(bone.tissue, SolidSurface::kAll));
  stale = bone.cut(surface, at_mm + ball_mm, 2.5);
  EXPECT_FALSE(stale.now) << "a driven tool's own rows go on";
  // Farther down some disks of dura are among them.
  const Vec3 low_mm(0.0, 0.0, -7.6);
  for (double z = -5.6; z < 0.0; z += 0.5) bone.cut(surface, {0.0, 0.0, z}, 2.2);
  surface.begin(bone.tissue, surface.place({low_mm, Quat(1, 0, 0, 0)}), Cutting::driven);
  ASSERT_TRUE(surface.goOn(bone.tissue, SolidSurface::kAll));
  const auto disks = std::ranges::count_if(
      surface.pieces(), [](const SurfacePiece& piece) { return !piece.cuttable; });
  EXPECT_GT(disks, 0);
  stale = bone.cut(surface, low_mm + ball_mm, 2.6);
  EXPECT_TRUE(stale.now) << "the place of a disk follows from what is around it";
  EXPECT_EQ(surface.removed(bone.tissue, std::vector<std::uint32_t>{0}, {{0, 0, 0}, {1, 1, 1}}).now,
            false)
      << "far away";
}

// Held where it cannot cut, its arm deep below: no voxel's centre comes into the burr, but by what
// it may be in a step.
TEST(SurfaceRows, ADrivenToolStaysOutOfWhatItHasNotCut) {
  for (const int version : {10, kTouchVersion}) {
    HapticParameters p = test::oneArm();
    p.touch_version = version;
    p.arms[0].tool = kBurr;
    p.tissues = boneOverDura();
    p.tissues.classes[0].cutting_J_per_mm3 = 0.06;
    p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
    p.removal = RemovalKind::work;
    test::Bench bench(p, block());
    const GridGeometry g = bench.grid.geometry();
    double deepest_mm = 0.0;
    std::uint64_t removed = 0;
    for (int n = 0; n < 1500; ++n) {
      const double t = 0.001 * n;
      const Vec3 arm_mm(3.0 * std::sin(4.0 * t), 2.0 * std::sin(5.0 * t), 9.0 - 8.0 * std::min(1.0, 2.0 * t));
      const ArmRecord& arm = bench.at(arm_mm);
      removed += std::uint64_t(arm.removed_voxels);
      if (n % 10 != 0) continue;
      for (std::size_t v = 0; v < g.voxelCount(); ++v) {
        if (bench.grid.hu(v) < 226) continue;
        const Index3 at = g.indicesOf(v);
        const Vec3 mm = g.toPatient_mm(Vec3(at[0], at[1], at[2]));
        const Vec3 ball = arm.proxy_position_mm + 1000.0 * kBurr.body[0].from_m;
        deepest_mm = std::max(deepest_mm, 2.0 - glm::distance(mm, ball));
      }
    }
    EXPECT_GT(removed, 500u) << version;
    EXPECT_LT(deepest_mm, 0.45 * 0.15) << version;
    std::printf("touch version %d: %llu voxels, at most %.4f mm in uncut bone\n", version,
                static_cast<unsigned long long>(removed), deepest_mm);
  }
}

}  // namespace
}  // namespace trephine
