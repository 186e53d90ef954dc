// Tools as exercises and tool files declare them: resources/schemas/tool.md.
#pragma once

#include <filesystem>
#include <string>

#include "base/json.h"
#include "base/math.h"
#include "haptics/tool.h"
#include "exercise/names.h"

namespace trephine {

// How a tool looks: an STL file, and where in it the tip is and which way the handle lies. Without
// a file a plain shape is drawn. Never part of a recording.
struct ToolLook {
  std::filesystem::path mesh;
  Vec3 tip_mm{0.0};            // in the mesh's frame
  Vec3 axis{0.0, 0.0, 1.0};    // from the tip to the handle; unit
  bool operator==(const ToolLook&) const = default;
};

inline constexpr Names<ToolKind, 3> kToolNames{
    {{"needle", ToolKind::needle}, {"blade", ToolKind::blade}, {"burr", ToolKind::burr}}};
inline constexpr Names<BurrShape, 2> kShapeNames{
    {{"sphere", BurrShape::sphere}, {"cylinder", BurrShape::cylinder}}};

struct ExerciseTool {
  std::string id;
  Tool tool;
  ToolLook look;
  // A tool is what it was made from.
  bool operator==(const ExerciseTool& other) const {
    return id == other.id && tool.made_from == other.tool.made_from && look == other.look;
  }
};

// An exercise's tool: `id` and either `file`, a tool file beside the exercise, some of whose
// numbers the exercise may set itself, or the keys of one. What is wrong is told to the reader.
ExerciseTool readExerciseTool(JsonReader& item, const std::filesystem::path& folder);

// Self-contained, without the mesh: what a recording keeps.
Json toJson(const ExerciseTool& tool);

}  // namespace trephine
