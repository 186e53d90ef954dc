// What the left button does in the slices; the entry point, the outline and those for structures
// work in the 3-D view too.
#pragma once

namespace trephine {

enum class SliceTool {
  window,
  point,
  ruler,
  angle,
  entry,
  outline,
  grow,
  brush,
  eraser,
  piece,
  wall
};
// Of those by which structures are made.
constexpr bool isForStructures(SliceTool tool) {
  return tool >= SliceTool::grow;
}
constexpr bool isBrush(SliceTool tool) {
  return tool == SliceTool::brush || tool == SliceTool::eraser || tool == SliceTool::wall;
}

}  // namespace trephine
