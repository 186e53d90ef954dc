// The files that a person writes for an exercise, and recordings, as inputs: a byte for the kind,
// then the file's contents. And what stands in for a case when they are used.
#pragma once

#include <cstdint>

#include "exercise/exercise.h"
#include "session/operator_script.h"
#include "shells.h"
#include "volume/volume.h"

namespace trephine::fuzz {

enum Kind : std::uint8_t {
  kExercise,
  kTool,
  kTissues,
  kDevice,
  kOperator,
  kRecording,
  kList,        // exercise.json of an exported folder
  kCase,        // case.json
  kProvenance,  // provenance.json
  kKinds
};
// Of resources, each with files of its kind; recordings are made.
constexpr const char* kFolders[kRecording] = {"scenes", "tools", "tissues", "devices", "operators"};

constexpr std::uint64_t kTicks = 200;

// Shells of what the shipped tissue sets call scalp, bone and brain or fat, bone and liver, 48^3
// voxels: every shipped exercise finds its landmarks there.
inline Volume smallHead() {
  return test::shells(48, 2.0, {{46, -80}, {44, 1200}, {40, 45}});
}

// Every arm of the exercise begins in tissue and moves on through it.
inline Result<OperatorScript> dive(const Exercise& exercise) {
  Json arms = Json::array();
  for (const ExerciseArm& arm : exercise.arms) {
    arms.push_back(
        {{"arm", arm.name},
         {"waypoints", {{{"t", 0}, {"at_mm", {0, 0, -1}}}, {{"t", 0.1}, {"at_mm", {2, 1, -6}}}}}});
  }
  const Json script = {{"format", "trephine.operator"},
                       {"version", 1},
                       {"name", "dive"},
                       {"hand", {{"stiffness_N_per_m", 1000}, {"damping_Ns_per_m", 10}}},
                       {"arms", arms}};
  return parseOperatorScript(script, "dive", exercise);
}

}  // namespace trephine::fuzz
