// Triangles of a tool, read by VTK from an STL file, binary or ASCII, in millimetres.
#pragma once

#include <filesystem>
#include <vector>

#include "base/math.h"
#include "base/result.h"

namespace trephine {

struct ToolMesh {
  std::vector<glm::vec3> corners;  // three a triangle, anticlockwise seen from outside
};

constexpr std::uintmax_t kLargestToolMesh_bytes = std::uintmax_t(64) << 20;
constexpr double kFarthestToolMesh_mm = 10000.0;  // a corner's place along an axis, or the tip's

// Triangles without area are left out. Errors: MISSING_FILE, CANNOT_READ, MESH_TOO_LARGE, NOT_STL
// (nor where it is damaged), MESH_EMPTY, MESH_NOT_FINITE, MESH_TOO_FAR (kFarthestToolMesh_mm). The
// order of corners is the file's; a file has no unit, and millimetres are taken.
Result<ToolMesh> readToolMesh(const std::filesystem::path& file);

// What readToolMesh would say of the file: for importers.
Status checkToolMesh(const std::filesystem::path& file);

// Moves the tip to the origin and turns `axis`, which points from the tip to the handle, to +z by
// the shortest way; an axis of -z turns about y. So a mesh along +x keeps its y. Errors:
// BAD_TOOL_FRAME where the tip is not finite or too far off, or the axis has no direction.
Result<ToolMesh> inToolFrame(const ToolMesh& mesh, const Vec3& tip_mm, const Vec3& axis);

}  // namespace trephine
