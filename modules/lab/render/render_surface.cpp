// Normals and shading against those of a sphere.
#include <algorithm>
#include <cmath>

#include "lab/common/quantile.h"
#include "lab/common/shell_phantom.h"
#include "lab/render/render_parts.h"

namespace trephine {

namespace {

constexpr double kRadius_mm = 40.0, kCentral = 0.6;
constexpr double kEye_mm = 400.0;

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

struct Errors {
  std::vector<double> angles_deg;
  double squares = 0.0, sum = 0.0;
};

// Each pixel of the sphere's middle: its normal in the picture beside that of the place on the
// sphere that its ray meets first.
void compare(const Picture& picture, const SceneRenderer& renderer, Errors& errors) {
  const Vec3 right = renderer.viewRight(), up = renderer.viewUp(), forward = renderer.viewForward();
  const Vec3 eye = -kEye_mm * forward;  // the focus is the sphere's middle, the origin
  const double mm = renderer.mmPerPixelAt(Vec3(0.0));
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const Vec3 at_focus = right * ((x + 0.5 - 0.5 * picture.width) * mm) -
                            up * ((y + 0.5 - 0.5 * picture.height) * mm);
      const Vec3 ray = glm::normalize(at_focus - eye);
      const double middle = -glm::dot(eye, ray);
      const double left = kRadius_mm * kRadius_mm - glm::dot(eye, eye) + middle * middle;
      if (left <= 0.0) continue;
      const Vec3 truth = glm::normalize(eye + ray * (middle - std::sqrt(left)));
      const Vec3 beside = truth - glm::dot(truth, forward) * forward;
      if (glm::length(beside) > kCentral) continue;
      const std::uint8_t* rgb =
          picture.rgb.data() + 3 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
      const auto part = [&](int channel) { return rgb[channel] / 127.5 - 1.0; };
      const Vec3 coded = right * part(0) + up * part(1) - forward * part(2);
      const Vec3 normal = coded / std::max(1e-9, glm::length(coded));
      const double cosine = std::clamp(glm::dot(normal, truth), -1.0, 1.0);
      errors.angles_deg.push_back(glm::degrees(std::acos(cosine)));
      const double lit = std::max(0.0, -glm::dot(normal, ray)), own = -glm::dot(truth, ray);
      errors.squares += (lit - own) * (lit - own);
      errors.sum += own;
    }
  }
}

Result<std::unique_ptr<SceneRenderer>> shellRenderer(int edge) {
  auto made = SceneRenderer::offscreen(edge, edge);
  if (!made) return made;
  (*made)->setTissues(bone());
  (*made)->setVolume(Grid(boneShell()));
  UploadProbe::setNormalsAsColour(**made, true);
  return made;
}

SurfaceRow surfaceOf(SceneRenderer& renderer, bool stock) {
  // A picture of normals is never VTK's own, but without our normals it holds VTK's gradient.
  renderer.setTruth({!stock, true});
  Errors errors;
  // Rings depend on how the rows of voxels lie to the eye.
  for (const Vec3& direction : {Vec3(0, 1, 0), Vec3(0, 0, -1), Vec3(0.5, 0.7, -0.4)}) {
    renderer.lookAt(Vec3(0.0), direction, Vec3(0, 0.1, 1), kEye_mm);
    compare(renderer.picture(), renderer, errors);
  }
  std::sort(errors.angles_deg.begin(), errors.angles_deg.end());
  const double count = std::max<double>(1.0, double(errors.angles_deg.size()));
  const double mean = std::max(1e-9, errors.sum / count);
  return {stock ? "stock" : "trephine", quantile(errors.angles_deg, 500),
          quantile(errors.angles_deg, 990), 100.0 * std::sqrt(errors.squares / count) / mean};
}

}  // namespace

Status measureSurface(const RenderOptions& options, const Progress& progress,
                      RenderMeasurement& result) {
  progress.at(0.0, "shell");
  auto made = shellRenderer(options.surface_edge);
  if (!made) return made.error();
  (*made)->setSampleDistance(options.sample_distances.front());
  for (const bool stock : {true, false}) {
    if (progress.cancelled()) return renderCancelled();
    result.surface.push_back(surfaceOf(**made, stock));
  }
  return {};
}

Result<std::vector<double>> shellLuminancePercent(const std::vector<RaySetting>& settings,
                                                  const RenderOptions& options,
                                                  const Progress& progress) {
  auto made = shellRenderer(options.surface_edge);
  if (!made) return made.error();
  std::vector<double> percents;
  for (const RaySetting& setting : settings) {
    if (progress.cancelled()) return renderCancelled();
    (*made)->setSampleDistance(setting.distance_voxels);
    percents.push_back(surfaceOf(**made, setting.plain).luminance_error_percent);
  }
  return percents;
}

}  // namespace trephine
