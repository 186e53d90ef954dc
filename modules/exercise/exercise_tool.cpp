#include "exercise/exercise_tool.h"

#include "exercise/exercise_numbers.h"

namespace trephine {

namespace {

// What an exercise may set itself of a tool that comes from a file.
constexpr std::span<const NumberOf<ToolDescription>> kOwnNumbers[] = {kToolNumbers, kBurrNumbers};

template <class Kind, std::size_t N>
Kind readKind(JsonReader& item, const char* key, const std::string& text,
              const Names<Kind, N>& names, const char* what) {
  if (const auto kind = kindOf(names, text)) return *kind;
  item.fail(key, "Unknown " + std::string(what) + " '" + text + "'", choices(names));
  return names[0].second;
}

// The keys that a tool file and an exercise's own tool share.
Tool readTool(JsonReader& item) {
  ToolDescription d;
  d.kind = readKind(item, "kind", item.text("kind"), kToolNames, "tool");
  const bool burr = d.kind == ToolKind::burr;
  if (burr) d.points = 64;
  readNumbers(item, kToolNumbers, d);
  if (burr) {
    readNumbers(item, kBurrNumbers, d);
    d.shape = readKind(item, "shape", item.text("shape", "sphere"), kShapeNames, "shape");
    if (d.shape == BurrShape::cylinder) readNumbers(item, kCylinderNumbers, d);
  }
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
  readNumbers(item, kLookNumbers, look);
  look.axis = item.direction("axis", Vec3(0.0, 0.0, 1.0));
  std::error_code ec;
  if (!std::filesystem::is_regular_file(look.mesh, ec)) {
    item.fail("mesh", "The file '" + file + "' is not there", "Check the name");
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
  const auto each_own = [&](auto&& what) {
    for (const auto& rows : kOwnNumbers) {
      for (const NumberOf<ToolDescription>& own : rows) {
        if (item.has(own.row.key)) what(own.row.key);
      }
    }
  };
  each_own([&](const char* own) {
    if (json->is_object()) (*json)[own] = item.raw(own);
  });
  JsonReader reader(*json, file.string());
  reader.format("trephine.tool", 1);
  (void)reader.text("name");
  out.tool = readTool(reader);
  out.look = readLook(reader, file.parent_path());
  if (Status status = reader.finish(); !status) {
    const Error& error = status.error();
    const std::string wrong = error.where.substr(error.where.rfind(' ') + 1);
    each_own([&](const char* own) {
      if (wrong == own) item.fail(own, error.what, error.next);
    });
    item.fail("file", error.what + " (" + error.where + ")", error.next);
  }
  return out;
}

Json toJson(const ExerciseTool& tool) {
  const ToolDescription& d = tool.tool.made_from;
  Json json = {{"id", tool.id}, {"kind", nameOf(kToolNames, d.kind)}};
  writeNumbers(json, kToolNumbers, d);
  if (d.kind != ToolKind::burr) return json;
  json["shape"] = nameOf(kShapeNames, d.shape);
  writeNumbers(json, kBurrNumbers, d);
  if (d.shape == BurrShape::cylinder) writeNumbers(json, kCylinderNumbers, d);
  return json;
}

}  // namespace trephine
