#include <algorithm>
#include <set>

#include "base/codes.h"
#include "base/tr.h"
#include "exercise/arms_file.h"
#include "exercise/exercise_fields.h"
#include "exercise/names.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostInAList = 64;

ExerciseMap readMap(JsonReader map) {
  ExerciseMap out;
  if (!map.has("centre_mm")) {
    readFields(map, kExerciseMapFields, out);
    return out;
  }
  WorkspaceMap fixed;
  readFields(map, kWorkspaceMapFields, fixed);
  fixed.rotation = readRotation(map);
  out.motion_scale = fixed.motion_scale;
  out.force_scale = fixed.force_scale;
  out.fixed = fixed;
  return out;
}

ExerciseArm readArm(JsonReader& item) {
  ExerciseArm arm;
  arm.map = readMap(item.object("map"));
  readFields(item, kArmFields, arm);
  return arm;
}

// What moved an arm, of a recording.
Rig::Arm readRigArm(JsonReader& item, const fs::path& folder) {
  Rig::Arm arm;
  JsonReader device = item.object("device");
  arm.device = readDevice(device, folder);
  if (item.has("dynamics")) {
    JsonReader dynamics = item.object("dynamics");
    readFields(dynamics, kArmDynamicsFields, arm.dynamics.emplace());
  }
  return arm;
}

Landmark readLandmark(JsonReader& item) {
  Landmark landmark;
  landmark.is_place = item.has("at_mm");
  if (item.has("bulk_radius_mm")) landmark.bulk_radius_mm = kBulkRadius_mm.low;
  readFields(item, kLandmarkFields, landmark);
  if (item.ok() && isRay(landmark) && landmark.from == landmark.towards) {
    item.fail("towards", tr("The ray of the landmark '{}' goes nowhere", landmark.id),
              tr("Let it go to another place than it begins at"));
  }
  return landmark;
}

// By tissue id.
TissueLooks readLooks(JsonReader& view, const TissueSet& tissues) {
  TissueLooks looks;
  JsonReader named = view.object("looks");
  for (const Tissue& tissue : tissues.tissues) {
    const char* id = tissue.id.c_str();
    if (!named.has(id)) continue;
    const std::string look = named.text(id);
    if (const auto kind = kindOf(kTissueLookNames, look)) {
      looks[tissue.id] = *kind;
    } else {
      named.fail(id, tr("Unknown look '{}'", look), choices(kTissueLookNames));
    }
  }
  const Json& all = view.raw("looks");
  for (auto item = all.begin(); all.is_object() && item != all.end(); ++item) {
    if (tissues.find(item.key())) continue;
    named.fail(item.key().c_str(), tr("The view names the unknown tissue '{}'", item.key()),
               tr("Use the ids of the scene's tissues"));
  }
  return looks;
}

// Names by which others refer to an element are there once.
template <class Items, class NameOf>
void checkNamesDiffer(JsonReader& reader, const char* list, const Items& items, NameOf name_of) {
  std::set<std::string> seen;
  for (const auto& item : items) {
    const std::string name = name_of(item);
    if (!seen.insert(name).second) {
      reader.fail(list, tr("'{}' stands twice in the list", name),
                  tr("Give each a name of its own"));
    }
  }
}

void checkToolsOf(JsonReader& reader, const Exercise& exercise, const ExerciseArm& arm) {
  std::set<std::string> seen{arm.tool};
  for (const std::string& id : arm.other_tools) {
    if (seen.insert(id).second) continue;
    reader.fail("arms", tr("The arm '{}' names the tool '{}' twice", arm.name, id));
  }
  for (const std::string& id : seen) {
    if (exercise.findTool(id)) continue;
    reader.fail("arms", tr("The arm '{}' names the unknown tool '{}'", arm.name, id));
  }
}

// Of a recording: a device moves one arm, and its delay is one that the loop knows.
void checkRig(JsonReader& reader, const Exercise& exercise, const Rig& rig) {
  std::set<std::string> devices;
  for (std::size_t i = 0; i < rig.arms.size(); ++i) {
    const auto& [device, dynamics] = rig.arms[i];
    const std::string& name = exercise.arms[i].name;
    if (!devices.insert(device.plugin + "/" + std::to_string(device.place)).second) {
      reader.fail("arms", tr("The arm '{}' uses a device that another arm uses", name));
    }
    if (!dynamics || kDelaySamples.holds(delaySamples(*dynamics, 1.0 / exercise.rate_hz))) continue;
    reader.fail("arms", tr("The delay of the arm '{}' is longer than {} periods of the rate", name,
                           kMaxDelayTicks));
  }
}

// The seed paper's rule of touch names tissues that are there, and nothing that it does not know.
void checkTouchByPoints(JsonReader& reader, const Exercise& exercise) {
  constexpr const char* kKey = "touch_by_points";
  if (!reader.has(kKey)) return;
  if (exercise.touch_by_points.empty()) {
    reader.fail(kKey, tr("The list [] names no tissue"),
                tr("Name the tissues that push, or take `{}` out", kKey));
  }
  checkNamesDiffer(reader, kKey, exercise.touch_by_points, [](const auto& id) { return id; });
  for (const std::string& id : exercise.touch_by_points) {
    if (!exercise.tissues.find(id)) {
      reader.fail(kKey, tr("It names the unknown tissue '{}'", id),
                  tr("Use the ids of the scene's tissues"));
    } else if (exercise.tissues_elsewhere && !exercise.tissues_elsewhere->find(id)) {
      reader.fail(kKey, tr("The set for other cases lacks the tissue '{}'", id),
                  tr("Name a tissue of both sets, or give that set one of this id"));
    }
  }
  const std::string what =
      contradictsTouchByPoints(exercise.laws, exercise.force_at, exercise.removal);
  if (!what.empty()) reader.fail(kKey, what, besideTouchByPoints());
}

// What one field cannot say: names that must exist, things that must be there once.
void checkReferences(JsonReader& reader, const Exercise& exercise) {
  for (const Landmark& landmark : exercise.landmarks) {
    if (!exercise.tissues.find(landmark.tissue)) {
      reader.fail("landmarks", tr("The landmark '{}' names the unknown tissue '{}'", landmark.id,
                                  landmark.tissue));
    }
    if (exercise.tissues_elsewhere && !exercise.tissues_elsewhere->find(landmark.tissue)) {
      reader.fail("tissues",
                  tr("The set for other cases lacks the tissue '{}' of the landmark '{}'",
                     landmark.tissue, landmark.id));
    }
  }
  if (exercise.arms.empty() || exercise.arms.size() > std::size_t(kMaxArms)) {
    reader.fail("arms", tr("A scene has 1 to 4 arms, this one has {}", exercise.arms.size()));
  }
  checkNamesDiffer(reader, "landmarks", exercise.landmarks, [](const auto& l) { return l.id; });
  checkNamesDiffer(reader, "tools", exercise.tools, [](const auto& t) { return t.id; });
  checkNamesDiffer(reader, "arms", exercise.arms, [](const auto& a) { return a.name; });
  for (const ExerciseArm& arm : exercise.arms) {
    checkToolsOf(reader, exercise, arm);
    if (!arm.map.fixed && !exercise.findLandmarkById(arm.map.landmark)) {
      reader.fail("arms",
                  tr("The arm '{}' names the unknown landmark '{}'", arm.name, arm.map.landmark));
    }
  }
  if (!exercise.view.landmark.empty() && !exercise.findLandmarkById(exercise.view.landmark)) {
    reader.fail("view", tr("The view names the unknown landmark '{}'", exercise.view.landmark));
  }
  if (!exercise.outline || !exercise.outline->frame) return;
  const std::string& of = exercise.outline->frame->landmark;
  if (!exercise.findLandmarkById(of)) {
    reader.fail("outline", tr("Its frame names the unknown landmark '{}'", of));
  }
}

Result<TissueSet> readTissues(const Json& value, const fs::path& folder, const std::string& file) {
  if (value.is_string()) return readTissueSet((folder / value.get<std::string>()).lexically_normal());
  Result<TissueSet> set = parseTissueSet(value, file + ": tissues");
  if (set && !set->elsewhere_file.empty()) {
    set->elsewhere_file = (folder / set->elsewhere_file).lexically_normal().string();
  }
  return set;
}

// Two laws that are two forms of one would give its force twice.
void checkLaws(JsonReader& reader, const std::vector<LawKind>& laws) {
  for (const auto& [form, other] : {std::pair(LawKind::membrane, LawKind::rupture),
                                    std::pair(LawKind::friction, LawKind::coulomb)}) {
    if (!names(laws, form) || !names(laws, other)) continue;
    reader.fail("laws", tr("`{}` and `{}` are two forms of one law: name one of them",
                           wordsOf(form).id, wordsOf(other).id));
  }
}

// `rig`: of a recording, which says what moved the arms; null: an exercise, which does not.
Result<Exercise> parse(const Json& json, const fs::path& file, Rig* rig) {
  const fs::path folder = file.parent_path();
  JsonReader reader(json, file.string());
  Exercise exercise;
  reader.format("trephine.scene", 1);
  readFields(reader, kExerciseFields, exercise);
  exercise.case_source = reader.text("case", "");
  if (const auto phantom = phantomNamed(exercise.case_source)) {
    const auto there = phantomGeometry(*phantom);
    if (!there) reader.fail("case", there.error().what, there.error().next);
  } else if (!exercise.case_source.empty()) {
    exercise.case_source = (folder / exercise.case_source).lexically_normal().string();
  }
  const std::string labels = reader.text("labels", "");
  if (!labels.empty()) exercise.labels_file = (folder / labels).lexically_normal().string();
  Result<TissueSet> tissues = readTissues(reader.raw("tissues"), folder, file.string());
  if (reader.ok() && !tissues) return tissues.error();
  if (tissues) exercise.tissues = *std::move(tissues);
  if (!exercise.tissues.elsewhere_file.empty()) {
    Result<TissueSet> elsewhere = readTissueSet(exercise.tissues.elsewhere_file);
    if (!elsewhere) return elsewhere.error();
    exercise.tissues_elsewhere = *std::move(elsewhere);
  } else if (reader.has("tissues_elsewhere")) {
    Result<TissueSet> elsewhere =
        parseTissueSet(reader.raw("tissues_elsewhere"), file.string() + ": tissues_elsewhere");
    if (reader.ok() && !elsewhere) return elsewhere.error();
    if (elsewhere) exercise.tissues_elsewhere = *std::move(elsewhere);
  }
  for (JsonReader& item : reader.objects("landmarks", kMostInAList))
    exercise.landmarks.push_back(readLandmark(item));
  for (JsonReader& item : reader.objects("tools", kMostInAList))
    exercise.tools.push_back(readExerciseTool(item, folder));
  for (JsonReader& item : reader.objects("arms", kMostInAList)) {
    exercise.arms.push_back(readArm(item));
    if (rig) rig->arms.push_back(readRigArm(item, folder));
  }
  readFields(reader, kTouchFields, exercise);
  readFields(reader, kPointsFields, exercise);
  const std::string script = reader.text("operator", "");
  if (!script.empty()) {
    exercise.operator_file = (folder / script).lexically_normal().string();
    std::error_code ec;
    if (!fs::is_regular_file(exercise.operator_file, ec)) {
      reader.fail("operator", tr("The file '{}' is not there", script), tr("Check the name"));
    }
  }
  if (reader.has("view")) {
    JsonReader view = reader.object("view");
    readFields(view, kViewFields, exercise.view);
    if (view.has("looks")) exercise.view.looks = readLooks(view, exercise.tissues);
  }
  if (reader.has("card")) exercise.card = readExerciseCard(reader.object("card"));
  if (reader.has("outline")) exercise.outline = readExerciseOutline(reader.object("outline"));
  readFields(reader, kLockFields, exercise);
  if (reader.ok()) checkReferences(reader, exercise);
  if (reader.ok()) checkLaws(reader, exercise.laws);
  if (reader.ok()) checkTouchByPoints(reader, exercise);
  if (rig && reader.ok()) checkRig(reader, exercise, *rig);
  if (Status status = reader.finish(); !status) return status.error();
  return exercise;
}

// The key of a text that would name a file; empty where there is none.
std::string namedFile(const Json& json) {
  const auto is_text = [](const Json& object, const char* key) {
    return object.is_object() && object.contains(key) && object[key].is_string();
  };
  for (const char* key : {"labels", "operator", "tissues"}) {
    if (is_text(json, key)) return key;
  }
  if (is_text(json, "case") && !phantomNamed(json["case"].get<std::string>())) return "case";
  if (json.contains("tissues") && is_text(json["tissues"], "elsewhere")) return "tissues.elsewhere";
  const auto list = [&](const char* key) {
    return json.contains(key) && json[key].is_array() ? json[key] : Json::array();
  };
  for (const Json& tool : list("tools")) {
    if (is_text(tool, "file")) return "tools.file";
    if (is_text(tool, "mesh")) return "tools.mesh";
  }
  for (const Json& arm : list("arms")) {
    const bool device = arm.is_object() && arm.contains("device");
    if (device && is_text(arm["device"], "config")) return "arms.device.config";
  }
  return {};
}

}  // namespace

Result<RecordedExercise> parseRecordedExercise(const Json& json, const std::string& where) {
  if (const std::string key = json.is_object() ? namedFile(json) : ""; !key.empty()) {
    return Error{code::kBadField, tr("It names a file, which no scene of a recording does"),
                 where + ": " + key, tr("Choose a recording that this program made")};
  }
  RecordedExercise recorded;
  Result<Exercise> exercise = parse(json, where, &recorded.rig);
  if (!exercise) return exercise.error();
  recorded.exercise = *std::move(exercise);
  return recorded;
}

Result<Exercise> parseExercise(const Json& json, const fs::path& file) {
  return parse(json, file, nullptr);
}

Result<Exercise> readExercise(const fs::path& file) {
  Result<Json> json = readJsonFile(file, Progress(), kMostWrittenBytes);
  if (!json) return json.error();
  return parseExercise(*json, file);
}

Json exerciseFile(const Exercise& exercise) {
  Json json = toJson(exercise);
  const auto name = [](Json& in, const char* key, const std::string& file) {
    if (!file.empty()) in[key] = file;
  };
  name(json, "case", exercise.case_source);
  name(json, "labels", exercise.labels_file);
  name(json, "operator", exercise.operator_file);
  if (exercise.tissues_elsewhere) json["tissues_elsewhere"] = toJson(*exercise.tissues_elsewhere);
  for (std::size_t i = 0; i < exercise.tools.size(); ++i) {
    const ToolLook& look = exercise.tools[i].look;
    if (look.mesh.empty()) continue;
    Json& tool = json["tools"][i];
    tool["mesh"] = look.mesh.string();
    writeFields(tool, kLookFields, look);
  }
  if (exercise.view.distance_mm != ExerciseView{}.distance_mm || !exercise.view.landmark.empty()) {
    writeFields(json["view"], kViewFields, exercise.view);
  }
  return json;
}

Status checkEdited(const Exercise& exercise) {
  const Result<Exercise> read = parseExercise(exerciseFile(exercise), tr("the exercise"));
  if (read) return {};
  Error error = read.error();
  // Nobody wrote a file that a schema could help with.
  if (pointsToSchema(error)) error.next = tr("It stays as it was");
  return error;
}

Json toJson(const RecordedExercise& recorded) {
  Json json = toJson(recorded.exercise);
  for (std::size_t i = 0; i < recorded.rig.arms.size() && i < json["arms"].size(); ++i) {
    const auto& [device, dynamics] = recorded.rig.arms[i];
    Json& arm = json["arms"][i];
    arm["device"]["plugin"] = device.plugin;
    writeFields(arm["device"], kDeviceFields, device);
    if (dynamics) writeFields(arm["dynamics"], kArmDynamicsFields, *dynamics);
  }
  return json;
}

Json toJson(const Exercise& exercise) {
  Json landmarks = Json::array(), tools = Json::array(), arms = Json::array();
  for (const Landmark& l : exercise.landmarks) {
    Json landmark;
    writeFields(landmark, kLandmarkFields, l);
    landmarks.push_back(landmark);
  }
  for (const ExerciseTool& t : exercise.tools) tools.push_back(toJson(t));
  for (const ExerciseArm& a : exercise.arms) {
    Json map;
    if (a.map.fixed) {
      const Quat& q = a.map.fixed->rotation;
      writeFields(map, kWorkspaceMapFields, *a.map.fixed);
      map["rotation_wxyz"] = {q.w, q.x, q.y, q.z};
    } else {
      writeFields(map, kExerciseMapFields, a.map);
    }
    Json arm;
    writeFields(arm, kArmFields, a);
    arm["map"] = map;
    arms.push_back(arm);
  }
  Json json{{"format", "trephine.scene"}, {"version", 1}};
  writeFields(json, kExerciseFields, exercise);
  if (phantomNamed(exercise.case_source)) json["case"] = exercise.case_source;
  json["tissues"] = toJson(exercise.tissues);
  json["landmarks"] = landmarks;
  json["tools"] = tools;
  json["arms"] = arms;
  writeFields(json, kTouchFields, exercise);
  writeFields(json, kPointsFields, exercise);
  if (!exercise.view.landmark.empty()) writeFields(json["view"], kViewFields, exercise.view);
  for (const auto& [id, look] : exercise.view.looks) {
    json["view"]["looks"][id] = nameOf(kTissueLookNames, look);
  }
  if (exercise.card) json["card"] = toJson(*exercise.card);
  if (exercise.outline) json["outline"] = toJson(*exercise.outline);
  writeFields(json, kLockFields, exercise);
  return json;
}

}  // namespace trephine
