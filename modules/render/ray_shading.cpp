#include "render/ray_shading.h"

#include <vtkShaderProperty.h>
#include <vtkUniforms.h>

#include <algorithm>
#include <string>

#include "render/carve_shader.h"
#include "render/depth_shader.h"
#include "render/look_table.h"

namespace trephine {

namespace {

// The contrast over the ball around a sample from which on it lies across an edge.
constexpr double kEdge_HU = 25.0;
// Between these a labelled structure fades into the air of a cut.
constexpr double kAirEnds_HU = -950.0, kTissueBegins_HU = -100.0;

// Half-way from soft tissue to a removed voxel.
constexpr double kHalfCut_HU = -450.0;

void set(float (&to_three)[3], const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) to_three[axis] = float(v[axis]);
}

}  // namespace

void RayShading::build(vtkShaderProperty& shader) const {
  shader.ClearAllFragmentShaderReplacements();
  const auto replace = [&](const char* tag, const std::string& text) {
    shader.AddFragmentShaderReplacement(tag, true, text, false);
  };
  shader.GetFragmentCustomUniforms()->RemoveAllUniforms();
  replace("//VTK::RenderToImage::Dec", kDepthDeclarations);
  replace("//VTK::RenderToImage::Impl", kDepthSample);
  replace("//VTK::RenderToImage::Exit", kDepthOutput);
  const bool by_label = rows > 1;
  if (!leaping && !by_label && !isTrue()) return;
  std::string declarations = kLeapDeclarations + (by_label ? labelledLookUps(rows) : kPlainLookUps);
  if (by_label) declarations += isTrue() ? kLabelledCuts : kNoCuts;
  if (by_label) {
    replace("//VTK::ComputeOpacity::Dec", kLabelledOpacity);
    replace("//VTK::ComputeColor::Dec", kLabelledColour);
  }
  if (leaping || isTrue()) {
    replace("//VTK::Terminate::Init", isTrue() ? kLeapStart + kClipStart : kLeapStart);
    replace("//VTK::Base::Impl", leapTo(isTrue() ? kGoOnInRun : kStopThere));
  }
  if (isTrue()) {
    declarations += kTruthDeclarations + (by_label ? kLabelledShape : kPlainShape);
    replace("//VTK::Shading::Impl", kTruthShading);
    tellTissues(shader);
    tellView(shader);
  }
  replace("//VTK::Base::Dec", declarations);
}

bool RayShading::isTrue() const {
  return geometry && (shows != 0 || (leaping && (options.normals || options.classes)));
}

void RayShading::tellTissues(vtkShaderProperty& shader) const {
  vtkUniforms* to = shader.GetFragmentCustomUniforms();
  const auto scaled = [&](double hu) { return float((hu - low_HU) / (high_HU - low_HU)); };
  const GridGeometry& g = *geometry;

  float look_of[kMaxTissues][4]{}, colour_of[kMaxTissues][3]{}, cut_of[kMaxTissues][3]{};
  const std::vector<TissueShade> shades = tissueShades(seen, looks, high_HU);
  for (std::size_t i = 0; i < shades.size(); ++i) {
    look_of[i][0] = scaled(shades[i].low_HU);
    look_of[i][1] = scaled(shades[i].high_HU);
    look_of[i][2] = float(shades[i].row);
    look_of[i][3] =
        (options.classes && shades[i].passed ? 1.0f : 0.0f) + (shades[i].ghosted ? 2.0f : 0.0f);
    set(colour_of[i], shades[i].colour);
    set(cut_of[i], cutColour(shades[i].colour));
  }
  to->SetUniformi("in_lookCount", int(shades.size()));
  to->SetUniform4fv("in_look", kMaxTissues, look_of);
  to->SetUniform3fv("in_lookColour", kMaxTissues, colour_of);
  to->SetUniform3fv("in_cutColour", kMaxTissues, cut_of);

  float reach[3];
  set(reach, ballRadii_mm(g.spacing_mm) / g.spacing_mm / Vec3(g.size[0], g.size[1], g.size[2]));
  to->SetUniform3f("in_cutReach", reach);
  const float air[2] = {scaled(kAirEnds_HU),
                        float((kTissueBegins_HU - kAirEnds_HU) / (high_HU - low_HU))};
  to->SetUniform2f("in_air", air);
  to->SetUniformf("in_half", scaled(kHalfCut_HU));
  to->SetUniformf("in_edge", float(kEdge_HU / (high_HU - low_HU)));
  to->SetUniformi("in_shows", shows);
}

void RayShading::tellView(vtkShaderProperty& shader) const {
  if (!isTrue()) return;
  vtkUniforms* to = shader.GetFragmentCustomUniforms();
  const GridGeometry& g = *geometry;
  const Mat3 to_grid = glm::transpose(g.direction);
  float planes[SceneRenderer::kMostClipPlanes][4]{}, normals[SceneRenderer::kMostClipPlanes][3]{};
  const std::size_t count = std::min(clip.size(), SceneRenderer::kMostClipPlanes);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 normal = to_grid * clip[i].normal;
    set(normals[i], normal);
    double beyond = glm::dot(clip[i].normal, g.origin_mm - clip[i].point_mm);
    for (int axis = 0; axis < 3; ++axis) {
      const double edge_mm = g.spacing_mm[axis];
      planes[i][axis] = float(normal[axis] * edge_mm * g.size[std::size_t(axis)]);
      beyond -= 0.5 * normal[axis] * edge_mm;
    }
    planes[i][3] = float(beyond);
  }
  to->SetUniformi("in_clipCount", int(count));
  to->SetUniform4fv("in_clip", int(SceneRenderer::kMostClipPlanes), planes);
  to->SetUniform3fv("in_clipNormal", int(SceneRenderer::kMostClipPlanes), normals);

  float axes[3][3], towards_light[3];
  const Vec3 eye_axes[3] = {to_grid * eye_right, to_grid * eye_up, -(to_grid * eye_forward)};
  for (int axis = 0; axis < 3; ++axis) set(axes[axis], eye_axes[axis]);
  set(towards_light, eye_axes[0] * light.x + eye_axes[1] * light.y + eye_axes[2] * light.z);
  to->SetUniform3fv("in_eye", 3, axes);
  to->SetUniform3f("in_light", towards_light);
  constexpr double kNone = 2.0;  // no voxel is as high
  const double cut_at = cut_HU ? (*cut_HU - low_HU) / (high_HU - low_HU) : kNone;
  const float cut[2] = {float(cut_at), float(0.5 / (high_HU - low_HU))};
  to->SetUniform2f("in_cut", cut);

  const RayBall around = options.normals ? rayBall(g.spacing_mm, coarse ? kFewPlaces : kBallPlaces)
                                         : centralDifferences(g.spacing_mm);
  float ball[kBallPlaces][3]{}, weight[kBallPlaces][3]{};
  for (std::size_t i = 0; i < around.size(); ++i) {
    set(ball[i], around[i].from_mm / g.spacing_mm / Vec3(g.size[0], g.size[1], g.size[2]));
    set(weight[i], around[i].weight);
  }
  to->SetUniformi("in_ballCount", int(around.size()));
  to->SetUniform3fv("in_ball", kBallPlaces, ball);
  to->SetUniform3fv("in_ballWeight", kBallPlaces, weight);
}

}  // namespace trephine
