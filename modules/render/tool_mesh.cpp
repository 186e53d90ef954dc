#include "render/tool_mesh.h"

#include <locale.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vtksys/SystemTools.hxx>

#include "base/codes.h"
#include "base/tr.h"
#include "render/codes.h"

namespace trephine {

namespace {

Error meshError(Code code, std::string what, const std::filesystem::path& file,
                std::string next = tr("Export it again as STL, in millimetres")) {
  return Error{code, std::move(what), file.string(), std::move(next)};
}

Error notStl(const std::filesystem::path& file) {
  return meshError(code::kNotStl, tr("The mesh is not an STL file, or a damaged one"), file);
}

// What VTK's reader does not ask: of a binary file that was cut short it takes what is there, and
// it sets aside room for as many triangles as the header says.
Status checkFile(const std::filesystem::path& file) {
  std::error_code ec;
  if (!std::filesystem::is_regular_file(file, ec)) {
    return meshError(code::kMissingFile, tr("There is no such mesh"), file,
                     tr("Put it beside the tool's data file"));
  }
  const std::uintmax_t size = std::filesystem::file_size(file, ec);
  std::ifstream stream(file, std::ios::binary);
  if (ec || !stream) {
    return meshError(code::kCannotRead, tr("The mesh could not be read"), file,
                     tr("Check that you may read it"));
  }
  if (size > kLargestToolMesh_bytes) {
    return meshError(code::kMeshTooLarge, tr("The mesh has {} MiB, more than 64", size >> 20), file,
                     tr("Reduce its triangles"));
  }
  using vtksys::SystemTools;  // as the reader asks
  if (SystemTools::DetectFileType(file.c_str()) == SystemTools::FileTypeText) return {};
  std::array<char, 84> header{};
  stream.read(header.data(), header.size());
  std::uintmax_t triangles = 0;
  for (int i = 83; i >= 80; --i) triangles = triangles << 8 | std::uint8_t(header[i]);
  return stream && size == header.size() + 50 * triangles ? Status{} : Status{notStl(file)};
}

}  // namespace

Result<ToolMesh> readToolMesh(const std::filesystem::path& file) {
  if (const Status status = checkFile(file); !status.ok()) return status.error();
  vtkNew<vtkSTLReader> reader;
  bool failed = false;
  vtkNew<vtkCallbackCommand> listener;  // with one, VTK neither prints nor opens a window
  listener->SetClientData(&failed);
  listener->SetCallback(
      [](vtkObject*, unsigned long, void* flag, void*) { *static_cast<bool*>(flag) = true; });
  for (const auto event : {vtkCommand::ErrorEvent, vtkCommand::WarningEvent}) {
    reader->AddObserver(event, listener);
    reader->GetExecutive()->AddObserver(event, listener);
  }
  reader->MergingOff();  // it cannot merge what is not finite
  reader->SetFileName(file.c_str());
  // It reads numbers by the thread's locale, in which 1.5 may be 1 and a rest.
  const locale_t point = newlocale(LC_NUMERIC_MASK, "C", nullptr), before = uselocale(point);
  reader->Update();
  uselocale(before);
  freelocale(point);
  if (failed) return notStl(file);

  ToolMesh mesh;
  vtkPolyData* read = reader->GetOutput();
  for (vtkIdType first = 0; first + 2 < read->GetNumberOfPoints(); first += 3) {
    const auto fault = [&](Code code, const std::string& what) {
      return meshError(code, tr("A corner of triangle {} {}", first / 3 + 1, what), file);
    };
    Vec3 corners[3];
    for (int i = 0; i < 3; ++i) {
      Vec3& p = corners[i];
      read->GetPoint(first + i, &p.x);
      if (!isFinite(p)) return fault(code::kMeshNotFinite, tr("is not finite"));
      if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kFarthestToolMesh_mm) {
        return fault(code::kMeshTooFar, tr("lies more than 10 m off"));
      }
    }
    if (glm::cross(corners[1] - corners[0], corners[2] - corners[0]) == Vec3(0.0)) continue;
    mesh.corners.insert(mesh.corners.end(), corners, corners + 3);
  }
  if (mesh.corners.empty())
    return meshError(code::kMeshEmpty, tr("The mesh has no triangles"), file);
  return mesh;
}

Status checkToolMesh(const std::filesystem::path& file) {
  const Result<ToolMesh> mesh = readToolMesh(file);
  return mesh ? Status{} : Status{mesh.error()};
}

Result<ToolMesh> inToolFrame(const ToolMesh& mesh, const Vec3& tip_mm, const Vec3& axis) {
  const double length = glm::length(axis);
  const bool near = isFinite(tip_mm) && std::abs(tip_mm.x) <= kFarthestToolMesh_mm &&
                    std::abs(tip_mm.y) <= kFarthestToolMesh_mm &&
                    std::abs(tip_mm.z) <= kFarthestToolMesh_mm;
  if (!near || !isFinite(length) || length < 1e-6) {
    return Error{code::kBadToolFrame,
                 near ? tr("The axis has no direction") : tr("The tip does not lie within 10 m"),
                 near ? "axis" : "tip_mm", tr("Correct it in the tool's data file")};
  }
  const Vec3 a = axis / length, z(0, 0, 1);
  const Quat turn =
      a.z < -1.0 + 1e-12 ? Quat(0, 0, 1, 0) : glm::normalize(Quat(1.0 + a.z, glm::cross(a, z)));
  const Mat3 to_tool = glm::mat3_cast(turn);
  ToolMesh moved;
  moved.corners.reserve(mesh.corners.size());
  for (const glm::vec3& p : mesh.corners) moved.corners.push_back(to_tool * (Vec3(p) - tip_mm));
  return moved;
}

}  // namespace trephine
