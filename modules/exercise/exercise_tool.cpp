#include "exercise/exercise_tool.h"

#include "base/tr.h"
#include "exercise/exercise_fields.h"

namespace trephine {

namespace {

// What an exercise may set itself of a tool that comes from a file.
constexpr const char* kOwnFields[] = {"length_mm", "points", "radius_mm", "motor_W",
                                      "shaft_points"};

// The keys that a tool file and an exercise's own tool share.
Tool readTool(JsonReader& item) {
  constexpr FieldsOf<ToolDescription> kFields = kToolFields;
  ToolDescription d;
  readFields<ToolDescription>(item, kFields.first(1), d);  // the kind
  if (isBurr(d)) d.points = 64;
  readFields<ToolDescription>(item, kFields.subspan(1), d);
  if (!item.ok()) return {};
  Result<Tool> tool = makeTool(d);
  if (tool) return *std::move(tool);
  item.fail(tool.error().where.c_str(), tool.error().what);
  return {};
}

ToolLook readLook(JsonReader& item, const std::filesystem::path& folder) {
  ToolLook look;
  const std::string file = item.text("mesh", "");
  if (file.empty()) return look;
  look.mesh = (folder / file).lexically_normal();
  readFields(item, kLookFields, look);
  std::error_code ec;
  if (!std::filesystem::is_regular_file(look.mesh, ec)) {
    item.fail("mesh", tr("The file '{}' is not there", file), tr("Check the name"));
  }
  return look;
}

}  // namespace

ExerciseTool readExerciseTool(JsonReader& item, const std::filesystem::path& folder) {
  ExerciseTool out;
  out.id = item.text("id");
  const std::string name = item.text("file", "");
  if (name.empty()) {
    out.tool = readTool(item);
    out.look = readLook(item, folder);
    return out;
  }
  const std::filesystem::path file = (folder / name).lexically_normal();
  Result<Json> json = readJsonFile(file, Progress(), kMostWrittenBytes);
  if (!json) {
    item.fail("file", json.error().what + " (" + json.error().where + ")", json.error().next);
    return out;
  }
  for (const char* own : kOwnFields) {
    if (item.has(own) && json->is_object()) (*json)[own] = item.raw(own);
  }
  JsonReader reader(*json, file.string());
  reader.format("trephine.tool", 1);
  (void)reader.text("name");
  out.tool = readTool(reader);
  out.look = readLook(reader, file.parent_path());
  if (Status status = reader.finish(); !status) {
    const Error& error = status.error();
    const std::string wrong = error.where.substr(error.where.rfind(' ') + 1);
    for (const char* own : kOwnFields) {
      if (wrong == own && item.has(own)) item.fail(own, error.what, error.next);
    }
    item.fail("file", error.what + " (" + error.where + ")", error.next);
  }
  return out;
}

Json toJson(const ExerciseTool& tool) {
  Json json{{"id", tool.id}};
  writeFields(json, kToolFields, tool.tool.made_from);
  return json;
}

}  // namespace trephine
