// Normals and shading against those of a sphere.
#include <algorithm>
#include <cmath>

#include "machine/common/quantile.h"
#include "machine/common/shell_phantom.h"
#include "machine/common/sphere_normals.h"
#include "machine/drawing/drawing_parts.h"

namespace trephine {

namespace {

constexpr double kRadius_mm = 40.0, kEye_mm = 400.0;

Volume boneShell() {
  EllipsoidShell shell;
  shell.half_axes_mm = Vec3(kRadius_mm);
  shell.thickness_mm = 6.0;
  shell.bone_hu = 1200;
  GridGeometry g;
  g.size = {128, 128, 104};
  g.spacing_mm = Vec3(0.8, 0.8, 1.0);
  g.origin_mm = -0.5 * Vec3(127, 127, 103) * g.spacing_mm;
  return scannedShell(shell, g, 10.0, 1);
}

TissueSet bone() {
  Tissue tissue;
  tissue.id = "bone";
  tissue.hu_min = 226;
  tissue.hu_max = 3071;
  tissue.opacity = 0.9;
  return {"shell", {tissue}};
}

Result<std::unique_ptr<SceneRenderer>> shellRenderer(int edge) {
  auto made = SceneRenderer::offscreen(edge, edge);
  if (!made) return made;
  (*made)->setTissues(bone());
  (*made)->setVolume(Grid(boneShell()));
  UploadProbe::setNormalsAsColour(**made, true);
  return made;
}

ShellSurface surfaceOf(SceneRenderer& renderer, bool plain) {
  // A picture of normals is never VTK's own, but without our normals it holds VTK's gradient.
  renderer.setShading({!plain, true});
  std::vector<double> errors_deg;
  double squares = 0.0, sum = 0.0;
  // Rings depend on how the rows of voxels lie to the eye.
  for (const Vec3& direction : {Vec3(0, 1, 0), Vec3(0, 0, -1), Vec3(0.5, 0.7, -0.4)}) {
    renderer.lookAt(Vec3(0.0), direction, Vec3(0, 0.1, 1), kEye_mm);
    for (const SphereNormal& of : sphereNormals(renderer.picture(), renderer, kRadius_mm)) {
      errors_deg.push_back(error_deg(of));
      const double lit = std::max(0.0, -glm::dot(of.shown, of.ray));
      const double own = -glm::dot(of.truth, of.ray);
      squares += (lit - own) * (lit - own);
      sum += own;
    }
  }
  std::sort(errors_deg.begin(), errors_deg.end());
  const double count = std::max<double>(1.0, double(errors_deg.size()));
  const double mean = std::max(1e-9, sum / count);
  return {quantile(errors_deg, 500), quantile(errors_deg, 990),
          100.0 * std::sqrt(squares / count) / mean};
}

}  // namespace

Result<std::vector<ShellSurface>> shellSurface(const std::vector<RaySetting>& settings, int edge,
                                               const Progress& progress) {
  progress.at(0.0, "shell");
  auto made = shellRenderer(edge);
  if (!made) return made.error();
  std::vector<ShellSurface> surfaces;
  for (const RaySetting& setting : settings) {
    if (progress.cancelled()) return drawingCancelled();
    (*made)->setSampleDistance(setting.distance_voxels);
    surfaces.push_back(surfaceOf(**made, setting.plain));
  }
  return surfaces;
}

}  // namespace trephine
