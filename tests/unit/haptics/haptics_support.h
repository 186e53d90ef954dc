// A slab of bone to touch, and one arm to touch it with.
#pragma once

#include <gtest/gtest.h>

#include "haptics/haptic_core.h"

namespace trephine::test {

constexpr std::int16_t kBoneHu = 1000;

// 32^3 mm of air with bone below z = 0 (patient mm); the origin is at its centre.
inline Volume boneSlab() {
  Volume volume;
  volume.geometry.size = {32, 32, 32};
  volume.geometry.origin_mm = Vec3(-16.0);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  for (int k = 0; k < 16; ++k) {
    for (int j = 0; j < 32; ++j) {
      for (int i = 0; i < 32; ++i) volume.hu[volume.geometry.indexOf(i, j, k)] = kBoneHu;
    }
  }
  return volume;
}

inline TissueTable boneTable(double damping = 10.0, double stiffness = 800.0, double friction = 2.0) {
  TissueTable table;
  table.count = 1;
  table.classes[0] = {{damping, stiffness, friction, 0.0, 0.05}, 226, 3071, 1, 0};
  return table;
}

inline HapticParameters oneArm() {
  HapticParameters p;
  p.arms.push_back({makeNeedle(0.05), WorkspaceMap{}, 3.3, ArmDynamics{}});
  p.controller = ControllerKind::off;
  p.laws = {LawKind::viscous, LawKind::coulomb};
  p.removal = RemovalKind::instant;
  p.tissues = boneTable();
  p.journal_voxels = 100000;
  p.journal_strokes = 64;
  return p;
}

// A core on a grid of its own, and a tip that is put somewhere each tick.
struct Bench {
  explicit Bench(const HapticParameters& p = oneArm(), Volume volume = boneSlab())
      : grid(std::move(volume)), core(p, *grid.takeWriter()) {}

  const ArmRecord& at(const Vec3& tip_mm, std::vector<Command> commands = {},
                      std::int64_t late_ns = 0) {
    TickInput input;
    input.tick = tick++;
    input.late_ns = late_ns;
    input.journal = core.journalState();
    input.arms[0].position_m = tip_mm / 1000.0;
    core.tick(input, commands.data(), commands.size(), record);
    return record.arms[0];
  }
  // Ticks on at the same place until an undo, redo, rewind or reset is done.
  void settle() {
    while (!core.acceptsCommands()) at(1000.0 * record.arms[0].device_position_m);
  }
  // A straight push at a constant speed; returns the largest sent force.
  double push(Vec3 from_mm, Vec3 to_mm, int ticks) {
    double largest = 0.0;
    for (int i = 0; i <= ticks; ++i) {
      largest = std::max(largest, glm::length(at(from_mm + (to_mm - from_mm) * (double(i) / ticks)).sent_N));
    }
    return largest;
  }

  Grid grid;
  HapticCore core;
  TickRecord record;
  std::uint64_t tick = 0;
};

}  // namespace trephine::test
