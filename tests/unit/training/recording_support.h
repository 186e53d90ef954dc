// A recording to read: one arm that cuts in a slab of bone.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "haptics/haptic_core.h"
#include "exercise/exercise.h"
#include "training/session_recorder.h"

namespace trephine::test {

inline Volume slab() {
  Volume v;
  v.geometry.size = {24, 24, 24};
  v.geometry.origin_mm = Vec3(-12.0);
  v.hu.assign(v.geometry.voxelCount(), kAirHu);
  for (std::size_t i = 0; i < v.hu.size() / 2; ++i) v.hu[i] = 900;
  return v;
}

inline Exercise exerciseWithOneArm() {
  Exercise exercise;
  exercise.name = "test";
  exercise.anatomy = "cranium";
  Tissue bone;
  bone.id = bone.name = "bone";
  bone.hu_min = 226;
  bone.hu_max = 3071;
  bone.hu_source = bone.damping_Ns_per_m.source = bone.stiffness_N_per_m.source =
      bone.friction_N.source = "test";
  bone.damping_Ns_per_m.value = 10;
  bone.stiffness_N_per_m.value = 800;
  bone.friction_N.value = 2;
  bone.cutting_J_per_mm3 = SourcedNumber{1e-4, "test"};
  exercise.tissues = {"test", {bone}};
  exercise.tools.push_back({"blade", makeBlade(0.008, 17), {}});
  ExerciseArm arm;
  arm.name = "right";
  arm.tool = "blade";
  arm.map.fixed = WorkspaceMap{};
  exercise.arms.push_back(arm);
  exercise.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
  return exercise;
}

// Runs the core and records it, as a session does; `ticks` of a cut with an undo in it.
inline void recordRun(const std::filesystem::path& file, std::uint64_t ticks, bool finish = true,
                      std::uint64_t dropped = 0) {
  const Exercise exercise = exerciseWithOneArm();
  Grid grid(slab());
  HapticCore core(hapticParameters(exercise), *grid.takeWriter());
  auto recorder = SessionRecorder::create(
      file, {toJson(RecordedExercise{exercise, simulatedRig(exercise)}), volumeSha256(slab()), grid.geometry(), "test"}, 1);
  ASSERT_TRUE(recorder.ok()) << recorder.error().sentence();
  for (std::uint64_t t = 0; t < ticks; ++t) {
    TickInput input;
    input.tick = t;
    input.journal = core.journalState();
    input.arms[0].position_m =
        Vec3(4e-6 * double(t % 2000) - 4e-3, 1e-3, 2e-3 - 3e-6 * double(t % 2000));
    std::vector<Command> commands;
    if (t == 2500) commands.push_back({CommandKind::undo, 0, {}});
    if (t == 2600) commands.push_back({CommandKind::controller, 0, {}});
    TickRecord record;
    core.tick(input, commands.data(), commands.size(), record);
    (*recorder)->tick(record);
    for (const CarveRecord& c : core.carves()) (*recorder)->carve(c);
    for (const Event& e : core.events()) (*recorder)->event(e);
    if (t % 500 == 499) {
      ASSERT_TRUE((*recorder)->flush().ok());
    }
  }
  if (finish) {
    ASSERT_TRUE((*recorder)->finish({ticks, dropped, 0, volumeSha256(grid.snapshot())}).ok());
  }
}

}  // namespace trephine::test
