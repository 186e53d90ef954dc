// Removal through the core: what a prescribed stroke takes, whatever the grid, the rate and the
// order of the arms.
#include "haptics/removal.h"

#include <cmath>
#include <numbers>

#include "haptics_support.h"

namespace trephine {
namespace {

using test::kBoneHu;

// A box of air and bone around the origin; bone below a plane that no grid axis lies in.
const Vec3 kSlope = glm::normalize(Vec3(0.12, -0.07, 1.0));

Volume slope(int voxels, double box_mm) {
  Volume volume;
  const double spacing = box_mm / voxels;
  volume.geometry.size = {voxels, voxels, voxels};
  volume.geometry.spacing_mm = Vec3(spacing);
  volume.geometry.origin_mm = Vec3(-0.5 * (voxels - 1) * spacing);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  for (int k = 0; k < voxels; ++k) {
    for (int j = 0; j < voxels; ++j) {
      for (int i = 0; i < voxels; ++i) {
        const Vec3 p = volume.geometry.origin_mm + spacing * Vec3(i, j, k);
        if (glm::dot(p, kSlope) < 0.0) volume.hu[volume.geometry.indexOf(i, j, k)] = kBoneHu;
      }
    }
  }
  return volume;
}

struct Stroke {
  Tool tool;
  std::vector<Vec3> way_mm;  // of the tip
  double speed_mm_per_s = 10.0;
  double cutting_J_per_mm3 = 0.06;
  double turn_rad = 0.0;     // of the tool about y, leaning
};

// Into the bone, along it and out again, by a way that turns.
Stroke burrStroke(double motor_W, double depth_mm) {
  Stroke s;
  s.tool = *makeTool({ToolKind::burr, 30.0, 64, 3.0, 8, BurrShape::sphere, 0.0, motor_W});
  s.way_mm = {{-5, -4, 3}, {-5, -4, -depth_mm}, {5, -2.5, -depth_mm - 0.4}, {4, 4.5, -depth_mm}, {4, 4.5, 4}};
  return s;
}

struct Outcome {
  double removed_mm3 = 0.0;
  std::uint64_t voxels = 0;
  Volume volume;
};

Outcome run(const Stroke& stroke, int voxels, double box_mm, double rate_hz,
            RemovalKind removal = RemovalKind::work) {
  HapticParameters p = test::oneArm();
  p.period_s = 1.0 / rate_hz;
  p.arms[0].tool = stroke.tool;
  p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
  p.removal = removal;
  p.tissues = test::boneTable(12.0, 900.0, 2.0);
  p.tissues.classes[0].cutting_J_per_mm3 = stroke.cutting_J_per_mm3;
  p.journal_voxels = 4'000'000;
  Grid grid(slope(voxels, box_mm));
  HapticCore core(p, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  const Quat turn(std::cos(stroke.turn_rad / 2), 0, std::sin(stroke.turn_rad / 2), 0);
  for (std::size_t leg = 0; leg + 1 < stroke.way_mm.size(); ++leg) {
    const Vec3 from = stroke.way_mm[leg], way = stroke.way_mm[leg + 1] - from;
    const int ticks = int(glm::length(way) / stroke.speed_mm_per_s * rate_hz);
    for (int n = 0; n < ticks; ++n) {
      input.arms[0].position_m = (from + way * (double(n) / ticks)) / 1000.0;
      input.arms[0].orientation = turn;
      input.journal = core.journalState();
      core.tick(input, nullptr, 0, record);
      ++input.tick;
    }
  }
  Outcome out;
  out.voxels = core.journal().removed(0, 0);
  out.removed_mm3 = double(out.voxels) * grid.geometry().voxelVolume_mm3();
  out.volume = grid.snapshot();
  return out;
}

// 0.19 and 0.1 mm: 256^3 and 512^3 over 49.2 mm.
constexpr double kBox_mm = 24.6;

void expectSame(const Stroke& stroke, const char* what) {
  const double reference = run(stroke, 256, kBox_mm, 1000.0).removed_mm3;
  ASSERT_GT(reference, 10.0) << what;
  for (int voxels : {128, 256}) {
    for (double rate : {500.0, 1000.0, 4000.0}) {
      const double mm3 = run(stroke, voxels, kBox_mm, rate).removed_mm3;
      EXPECT_NEAR(mm3, reference, 0.05 * reference) << what << ", " << voxels << " at " << rate;
      ::testing::Test::RecordProperty(what, std::to_string(mm3));
      if (std::getenv("SHOW")) std::printf("%s %d %g: %.2f mm3 (%.2f %%)\n", what, voxels, rate, mm3, 100*(mm3/reference-1));
    }
  }
}

TEST(Removal, AStrokeWithAStrongMotorTakesTheSameOnAnyGridAndAtAnyRate) {
  expectSame(burrStroke(40.0, 1.5), "strong");
}
TEST(Removal, AStrokeThatRunsShortOfWorkTakesTheSameOnAnyGridAndAtAnyRate) {
  expectSame(burrStroke(4.0, 1.5), "weak");
}
TEST(Removal, AStrokeByHandAloneTakesTheSameOnAnyGridAndAtAnyRate) {
  Stroke s = burrStroke(0.0, 2.5);
  s.cutting_J_per_mm3 = 0.001;
  expectSame(s, "hand");
}
TEST(Removal, ASlantedBladeTakesTheSameOnAnyGridAndAtAnyRate) {
  Stroke s;
  s.tool = *makeTool({ToolKind::blade, 16.0, 64, 0.6, 0, BurrShape::sphere, 0.0, 6.0});
  s.way_mm = {{-5, -4, 3}, {-5, -4, -4}, {5, -2.5, -4.5}, {5, -2.5, 4}};
  s.turn_rad = 0.5;
  expectSame(s, "blade");
}

}  // namespace
}  // namespace trephine
