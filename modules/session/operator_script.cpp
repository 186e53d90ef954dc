#include "session/operator_script.h"

#include <algorithm>
#include <cmath>

#include "base/tr.h"
#include "exercise/codes.h"
#include "exercise/names.h"

namespace trephine {

namespace {

constexpr std::array<std::pair<std::string_view, CommandKind>, 15> kCommandNames{
    {{"undo", CommandKind::undo},
     {"redo", CommandKind::redo},
     {"reset", CommandKind::reset},
     {"pause", CommandKind::pause},
     {"resume", CommandKind::resume},
     {"clear_faults", CommandKind::clear_faults},
     {"controller", CommandKind::controller},
     {"tissues", CommandKind::tissues},
     {"rewind", CommandKind::rewind},
     {"clutch_on", CommandKind::clutch_on},
     {"clutch_off", CommandKind::clutch_off},
     {"recentre", CommandKind::recentre},
     {"tool", CommandKind::tool},
     {"device_lost", CommandKind::device_lost},
     {"device_back", CommandKind::device_back}}};

constexpr std::size_t kMostWaypoints = 100'000;
constexpr std::size_t kMostCommands = 10'000;

ScriptHand readHand(JsonReader& item, const Exercise& exercise) {
  ScriptHand hand;
  hand.arm = item.text("arm");
  const bool known = std::any_of(exercise.arms.begin(), exercise.arms.end(),
                                 [&](const ExerciseArm& arm) { return arm.name == hand.arm; });
  if (!known) item.fail("arm", tr("The scene has no arm '{}'", hand.arm));
  for (JsonReader& point : item.objects("waypoints", kMostWaypoints)) {
    ScriptWaypoint waypoint{point.number("t", kScriptTime_s), point.vec3("at_mm", kWaypoint_mm)};
    if (!hand.waypoints.empty() && waypoint.time_s <= hand.waypoints.back().time_s) {
      point.fail(
          "t", tr("The time {} is not after the waypoint before it", Json(waypoint.time_s).dump()));
    }
    hand.waypoints.push_back(waypoint);
  }
  if (hand.waypoints.empty()) item.fail("waypoints", tr("A hand needs at least one waypoint"));
  return hand;
}

// A tissue change starts from what the exercise or the change before it says. A number that it
// changes no longer claims what was known of the other one.
void readTissueChange(JsonReader changes, const Json& names, TissueSet& set) {
  for (auto it = names.begin(); it != names.end(); ++it) {
    auto tissue = std::find_if(set.tissues.begin(), set.tissues.end(),
                               [&](const Tissue& t) { return t.id == it.key(); });
    JsonReader change = changes.object(it.key().c_str());
    if (tissue == set.tissues.end()) {
      changes.fail(it.key().c_str(), tr("The scene has no tissue '{}'", it.key()));
      return;
    }
    tissue->hu_min = int(change.integer("hu_min", kHuRange, tissue->hu_min));
    tissue->hu_max = int(change.integer("hu_max", kHuRange, tissue->hu_max));
    for (const TissueNumber& number : kTissueNumbers) {
      const SourcedNumber* was = number.of(*tissue);
      if (!was) continue;  // one that the tissue does not have cannot change
      const double value = change.number(number.key, number.row().range, was->value);
      if (value != was->value) number.set(*tissue, {value, kOwnSource});
    }
    tissue->cuttable = change.boolean("cuttable", tissue->cuttable);
  }
}

// Which of the arm's tools a command names.
void readTool(JsonReader& item, const Exercise& exercise, Command& command) {
  const std::string id = item.text("tool");
  if (command.arm < 0) return;
  const ExerciseArm& arm = exercise.arms[std::size_t(command.arm)];
  const auto found = std::find(arm.other_tools.begin(), arm.other_tools.end(), id);
  if (found != arm.other_tools.end()) {
    command.value = std::int32_t(1 + (found - arm.other_tools.begin()));
  } else if (id != arm.tool) {
    item.fail("tool", tr("The arm '{}' has no tool '{}'", arm.name, id));
  }
}

// A command of one arm, and where its map turns to.
void readArmCommand(JsonReader& item, const Exercise& exercise, Command& command) {
  const std::string name = item.text("arm");
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    if (exercise.arms[i].name == name) command.arm = std::int32_t(i);
  }
  if (command.arm < 0) item.fail("arm", tr("The scene has no arm '{}'", name));
  if (command.kind == CommandKind::tool) readTool(item, exercise, command);
  if (command.kind != CommandKind::clutch_off || !item.has("rotation_xyzw")) return;
  const auto q = item.numbers("rotation_xyzw", 4, {-1, 1});
  const Quat rotation(q[3], q[0], q[1], q[2]);
  constexpr double kUnit = 1e-3;
  if (std::abs(glm::length(rotation) - 1.0) > kUnit) {
    item.fail("rotation_xyzw", tr("This is no rotation: its four numbers are not of length 1"));
    return;
  }
  command.value = 1;
  command.rotation = glm::normalize(rotation);
}

ScriptCommand readCommand(JsonReader& item, const Exercise& exercise, TissueSet& tissues) {
  ScriptCommand out;
  out.time_s = item.number("t", kScriptTime_s);
  const std::string name = item.text("do");
  const auto kind = kindOf(kCommandNames, name);
  if (!kind) {
    item.fail("do", tr("Unknown command '{}'", name));
    return out;
  }
  out.command.kind = *kind;
  if (out.command.kind == CommandKind::controller) {
    const std::string wanted = item.text("controller");
    if (const auto controller = kindOf(kControllerNames, wanted)) {
      out.command.value = std::int32_t(*controller);
    } else {
      item.fail("controller", tr("Unknown controller '{}'", wanted));
    }
  }
  if (out.command.kind >= CommandKind::clutch_on) readArmCommand(item, exercise, out.command);
  if (out.command.kind == CommandKind::rewind) {
    const std::int64_t second = item.integer("to_s", {0, out.time_s, "s"});
    out.command.value = std::int32_t(second);
  }
  if (out.command.kind == CommandKind::tissues) {
    const Json& names = item.raw("tissues");
    if (names.is_object()) {
      readTissueChange(item.object("tissues"), names, tissues);
    } else {
      item.fail("tissues", tr("Expected an object of tissues"));
    }
    if (Status valid = validate(tissues, item.file()); !valid) {
      item.fail("tissues", valid.error().what + " (" + valid.error().where + ")");
    }
    out.tissues = std::make_shared<const TissueTable>(tissueTable(tissues));
    out.command.tissues = out.tissues.get();
  }
  return out;
}

}  // namespace

double OperatorScript::duration_s() const {
  double end_s = commands.empty() ? 0.0 : commands.back().time_s;
  for (const ScriptHand& hand : hands) end_s = std::max(end_s, hand.waypoints.back().time_s);
  return end_s;
}

Result<OperatorScript> parseOperatorScript(const Json& json, const std::string& file,
                                           const Exercise& exercise) {
  JsonReader reader(json, file);
  OperatorScript script;
  reader.format("trephine.operator", 1);
  script.name = reader.text("name");
  JsonReader hand = reader.object("hand");
  script.hand_stiffness_N_per_m = hand.number("stiffness_N_per_m", kHandStiffness_N_per_m);
  script.hand_damping_Ns_per_m = hand.number("damping_Ns_per_m", kHandDamping_Ns_per_m);
  for (JsonReader& item : reader.objects("arms", std::size_t(kMaxArms))) {
    ScriptHand hand_track = readHand(item, exercise);
    for (const ScriptHand& other : script.hands) {
      if (other.arm == hand_track.arm) item.fail("arm", tr("The arm '{}' stands twice", other.arm));
    }
    script.hands.push_back(std::move(hand_track));
  }
  TissueSet tissues = exercise.tissues;
  if (reader.has("commands")) {
    for (JsonReader& item : reader.objects("commands", kMostCommands)) {
      ScriptCommand command = readCommand(item, exercise, tissues);
      if (!script.commands.empty() && command.time_s < script.commands.back().time_s) {
        item.fail("t", tr("Commands stand in order of time"));
      }
      script.commands.push_back(command);
    }
  }
  if (Status status = reader.finish(); !status) return status.error();
  return script;
}

Result<OperatorScript> readOperatorScript(const std::filesystem::path& file, const Exercise& exercise) {
  Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  return parseOperatorScript(*json, file.string(), exercise);
}

Status checkLocks(const OperatorScript& script, const Locks& locks) {
  for (const ScriptCommand& command : script.commands) {
    const CommandKind kind = command.command.kind;
    const bool controller = kind == CommandKind::controller && locks.contains(Lock::controller);
    const bool tissues = kind == CommandKind::tissues && locks.contains(Lock::tissues);
    if (!controller && !tissues) continue;
    return Error{code::kLocked,
                 tr("The script would change the {}, which the workstation or the exercise locks",
                    (controller ? "controller" : "tissues")),
                 tr("script '{}'", script.name), tr("Choose another script, or ask an educator")};
  }
  return {};
}

ScriptOperator::ScriptOperator(const OperatorScript& script, const Exercise& exercise,
                               const std::vector<LandmarkFrame>& landmarks)
    : period_s_(1.0 / exercise.rate_hz),
      stiffness_(script.hand_stiffness_N_per_m),
      damping_(script.hand_damping_Ns_per_m),
      tracks_(exercise.arms.size()),
      commands_(script.commands) {
  for (ScriptCommand& timed : commands_) {
    Command& command = timed.command;
    if (command.kind == CommandKind::clutch_off && command.value == 1) {
      command.rotation = landmarks[std::size_t(command.arm)].rotation * command.rotation;
    }
  }
  for (const ScriptHand& hand : script.hands) {
    for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
      if (exercise.arms[i].name != hand.arm) continue;
      const WorkspaceMap map = exercise.arms[i].map.fixed.value_or(WorkspaceMap{});
      for (const ScriptWaypoint& waypoint : hand.waypoints) {
        tracks_[i].time_s.push_back(waypoint.time_s);
        tracks_[i].at_m.push_back(map.toDevice_m(landmarks[i].toPatient_mm(waypoint.at_mm)));
      }
    }
  }
}

void ScriptOperator::setPoints(std::uint64_t tick, OperatorSetPoint* hands, std::size_t arm_count) {
  const double t = double(tick) * period_s_;
  for (std::size_t arm = 0; arm < arm_count; ++arm) {
    OperatorSetPoint& hand = hands[arm];
    hand = OperatorSetPoint{Pose{}, stiffness_, damping_};
    const Track& track = tracks_[arm];
    if (track.time_s.empty()) continue;
    const auto after = std::upper_bound(track.time_s.begin(), track.time_s.end(), t);
    const auto next = std::size_t(after - track.time_s.begin());
    if (next == 0) {
      hand.pose_m.position = track.at_m.front();
    } else if (next == track.time_s.size()) {
      hand.pose_m.position = track.at_m.back();
    } else {
      const double span_s = track.time_s[next] - track.time_s[next - 1];
      const double fraction = (t - track.time_s[next - 1]) / span_s;
      hand.pose_m.position =
          track.at_m[next - 1] + fraction * (track.at_m[next] - track.at_m[next - 1]);
    }
  }
}

bool ScriptOperator::command(std::uint64_t tick, Command& out) {
  if (next_command_ == commands_.size()) return false;
  if (commands_[next_command_].time_s > double(tick) * period_s_ + 1e-9) return false;
  out = commands_[next_command_++].command;
  return true;
}

}  // namespace trephine
