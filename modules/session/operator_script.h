// A scripted operator: where each hand is at which time, and timed commands. The file: JSON,
// resources/schemas/operator.md. Waypoints are in millimetres from each arm's landmark, so that one
// script fits any case of the anatomy.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "haptics/haptic_loop.h"
#include "exercise/exercise.h"

namespace trephine {

// What the numbers of a script may be: hands of people and of rigs, a day's work at most.
constexpr Range kHandStiffness_N_per_m{0, 10'000, "N/m"};
constexpr Range kHandDamping_Ns_per_m{0, 1000, "N s/m"};
constexpr Range kScriptTime_s{0, 86'400, "s"};
constexpr Range kWaypoint_mm{-1000, 1000, "mm"};

struct ScriptWaypoint {
  double time_s = 0.0;
  Vec3 at_mm{0.0};  // landmark axes
};

struct ScriptHand {
  std::string arm;  // a name of the exercise
  std::vector<ScriptWaypoint> waypoints;  // by increasing time
};

struct ScriptCommand {
  double time_s = 0.0;
  Command command;
  std::shared_ptr<const TissueTable> tissues{};  // that the command points to
};

struct OperatorScript {
  std::string name;
  double hand_stiffness_N_per_m = 0.0;
  double hand_damping_Ns_per_m = 0.0;
  std::vector<ScriptHand> hands;
  std::vector<ScriptCommand> commands;  // by increasing time

  double duration_s() const;
};

// Checked against the exercise: arms that it has, tissues that it knows. A tissue change names the
// numbers that change; the table is made here, once. Errors as in readExercise.
Result<OperatorScript> readOperatorScript(const std::filesystem::path& file, const Exercise& exercise);
Result<OperatorScript> parseOperatorScript(const Json& json, const std::string& file,
                                           const Exercise& exercise);

// LOCKED where one of its commands would change what is locked (exercise/policy.h), also a script
// of the exercise's own.
Status checkLocks(const OperatorScript& script, const Locks& locks);

// Plays a script: a pure function of the tick number. Straight lines between waypoints, at rest
// before the first and after the last; an arm without waypoints stays where its device's origin is.
class ScriptOperator : public Operator {
 public:
  // `maps[i]` is arm i's map and `landmarks[i]` the frame in which its waypoints are given.
  ScriptOperator(const OperatorScript& script, const Exercise& exercise,
                 const std::vector<LandmarkFrame>& landmarks);
  void setPoints(std::uint64_t tick, OperatorSetPoint* hands, std::size_t arm_count) override;
  bool command(std::uint64_t tick, Command& out) override;

 private:
  struct Track {
    std::vector<double> time_s;
    std::vector<Vec3> at_m;  // device frame
  };
  double period_s_;
  double stiffness_, damping_;
  std::vector<Track> tracks_;  // by arm of the exercise
  std::vector<ScriptCommand> commands_;
  std::size_t next_command_ = 0;
};

}  // namespace trephine
