#include "structures/surface.h"

#include <vtkCallbackCommand.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkImageGaussianSmooth.h>
#include <vtkMassProperties.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSTLWriter.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <algorithm>
#include <cerrno>
#include <new>

#include "base/codes.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/purpose.h"
#include "base/tr.h"

namespace trephine {

namespace {

constexpr int kMargin = 3;            // voxels of nothing around it, so that it is closed
constexpr double kBlur_voxels = 0.6;  // takes the steps of voxels
constexpr int kSmoothings = 15;
constexpr double kPassBand = 0.1;

VoxelBox boxOf(const LabelMap& map, int label) {
  VoxelBox box{map.geometry.size, {0, 0, 0}};
  std::size_t voxel = 0;
  for (int k = 0; k < map.geometry.size[2]; ++k) {
    for (int j = 0; j < map.geometry.size[1]; ++j) {
      for (int i = 0; i < map.geometry.size[0]; ++i, ++voxel) {
        if (map.labels[voxel] != label) continue;
        const Index3 at{i, j, k};
        for (std::size_t a = 0; a < 3; ++a) {
          box.low[a] = std::min(box.low[a], at[a]);
          box.high[a] = std::max(box.high[a], at[a] + 1);
        }
      }
    }
  }
  return box;
}

// 1 where it is, with a margin of 0.
vtkNew<vtkImageData> maskOf(const LabelMap& map, int label, const VoxelBox& box) {
  vtkNew<vtkImageData> image;
  int size[3];
  for (std::size_t a = 0; a < 3; ++a) size[a] = box.high[a] - box.low[a] + 2 * kMargin;
  image->SetDimensions(size);
  image->AllocateScalars(VTK_FLOAT, 1);
  auto* to = static_cast<float*>(image->GetScalarPointer());
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i, ++to) {
        const int a = box.low[0] + i - kMargin, b = box.low[1] + j - kMargin,
                  c = box.low[2] + k - kMargin;
        const bool in =
            map.geometry.contains(a, b, c) && map.labels[map.geometry.indexOf(a, b, c)] == label;
        *to = in ? 1.0f : 0.0f;
      }
    }
  }
  return image;
}

}  // namespace

Result<SurfaceWritten> writeSurface(const LabelMap& map, int label,
                                    const std::filesystem::path& file, const Progress& progress) {
  const Error cancelled{code::kCancelled, tr("Making the surface was cancelled"), "", ""};
  try {
    const VoxelBox box = boxOf(map, label);
    if (box.low[0] >= box.high[0]) {
      return Error{code::kEmptyStructure, tr("The structure has no voxel"), file.string(),
                   tr("Choose another structure")};
    }
    progress.at(0.0, tr("Making the surface"));
    const vtkNew<vtkImageData> mask = maskOf(map, label, box);
    vtkNew<vtkImageGaussianSmooth> blur;
    blur->SetInputData(mask);
    blur->SetStandardDeviation(kBlur_voxels);
    vtkNew<vtkFlyingEdges3D> edges;
    edges->SetInputConnection(blur->GetOutputPort());
    edges->SetValue(0, 0.5);
    edges->ComputeNormalsOff();
    edges->ComputeGradientsOff();
    edges->ComputeScalarsOff();
    edges->Update();
    if (progress.cancelled()) return cancelled;
    progress.at(0.5, tr("Making the surface"));
    vtkNew<vtkPolyData> surface;
    surface->DeepCopy(edges->GetOutput());
    vtkPoints* points = surface->GetPoints();
    for (vtkIdType n = 0; n < surface->GetNumberOfPoints(); ++n) {
      double at[3];
      points->GetPoint(n, at);
      const Vec3 voxel(box.low[0] + at[0] - kMargin, box.low[1] + at[1] - kMargin,
                       box.low[2] + at[2] - kMargin);
      const Vec3 mm = map.geometry.toPatient_mm(voxel);
      points->SetPoint(n, mm.x, mm.y, mm.z);
    }
    vtkNew<vtkWindowedSincPolyDataFilter> smooth;
    smooth->SetInputData(surface);
    smooth->SetNumberOfIterations(kSmoothings);
    smooth->SetPassBand(kPassBand);
    smooth->NonManifoldSmoothingOn();
    smooth->NormalizeCoordinatesOn();
    smooth->Update();
    if (progress.cancelled()) return cancelled;
    progress.at(0.8, tr("Making the surface"));
    vtkNew<vtkMassProperties> mass;
    mass->SetInputConnection(smooth->GetOutputPort());
    mass->Update();
    const Status written = replaceFile(file, [&](const std::filesystem::path& temporary) -> Status {
      vtkNew<vtkSTLWriter> writer;
      writer->SetInputConnection(smooth->GetOutputPort());
      writer->SetFileTypeToBinary();
      const std::string made = std::string("Trephine: ") + kPurpose;  // of 80 characters
      writer->SetHeader(made.c_str());
      writer->SetFileName(temporary.c_str());
      const vtkNew<vtkCallbackCommand> said_below;  // instead of VTK's own words on stderr
      writer->AddObserver(vtkCommand::ErrorEvent, said_below);
      errno = 0;
      if (writer->Write() == 1 && writer->GetErrorCode() == 0) return {};
      return writeError(file, errno);
    });
    if (!written) return written.error();
    progress.at(1.0, tr("Making the surface"));
    return SurfaceWritten{std::size_t(smooth->GetOutput()->GetNumberOfCells()),
                          mass->GetVolume() / 1000.0};
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the surface"), tr("the structure"));
  }
}

}  // namespace trephine
