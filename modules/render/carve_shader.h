// What the ray caster's fragment shader is told beside VTK's own: leaps over what is not visible, and
// looks by label. GLSL for VTK's replacement of tags; each text begins with its tag, so that VTK's
// own part is kept before it, or takes its place.
#pragma once

#include <string>

#include "render/empty_space.h"
#include "render/transfer_function.h"

namespace trephine {

static_assert(kLeapEdge == 8, "the shader below counts in bricks of 8");
inline const std::string kLeapDeclarations = R"(//VTK::Base::Dec
uniform sampler3D in_leaps;  // bricks to the nearest visible one, as a byte
vec3 g_bricks;               // bricks per texture coordinate
vec3 g_start;
vec3 g_forward;
vec3 g_stepsPerBrick;
float g_lastT;
)";

// Where in the tables of colour and opacity a HU is, as VTK scaled it, in the voxel at g_dataPos.
inline const std::string kPlainLookUps = R"(
vec3 lastBrick() { return vec3(textureSize(in_leaps, 0)) - 1.0; }
float leapsAt(vec3 brick) { return texelFetch(in_leaps, ivec3(brick), 0).r; }
float lookOf(float hu) { return hu; }
)";

// The same texture holds the row of each voxel's label first and the leaps in the slices above: one
// texture, since only the first of all is where a shader that was just built looks for it.
inline std::string labelledLookUps(std::size_t rows) {
  static_assert(kSideMargin == 0.01, "written out below");
  return "const float kRows = " + std::to_string(rows) + R"(.0;
vec3 voxels() { return vec3(textureSize(in_volume[0], 0)); }
vec3 lastBrick() { return ceil(voxels() / 8.0) - 1.0; }
float leapsAt(vec3 brick)
  {
  return texelFetch(in_leaps, ivec3(brick + vec3(0.0, 0.0, voxels().z)), 0).r;
  }
float lookOf(float hu)
  {
  vec3 l_voxel = clamp(floor(g_dataPos * voxels()), vec3(0.0), voxels() - 1.0);
  float l_row = floor(texelFetch(in_leaps, ivec3(l_voxel), 0).r * 255.0 + 0.5);
  return (l_row + mix(0.01, 0.99, clamp(hu, 0.0, 1.0))) / kRows;
  }
)";
}

// In VTK's place, with its tables.
inline const std::string kLabelledOpacity = R"(
uniform sampler2D in_opacityTransferFunc_0[1];
float computeOpacity(vec4 scalar)
  {
  return texture2D(in_opacityTransferFunc_0[0], vec2(lookOf(scalar.w), 0.0)).r;
  }
)";

inline const std::string kLabelledColour = R"(
uniform sampler2D in_colorTransferFunc_0[1];
vec4 computeColor(vec4 scalar, float opacity)
  {
  vec3 l_colour = texture2D(in_colorTransferFunc_0[0], vec2(lookOf(scalar.w), 0.0)).xyz;
  return clamp(computeLighting(vec4(l_colour, opacity), 0, 0.0), 0.0, 1.0);
  }
)";

// Where the ray leaves the box, in steps; the sample that VTK takes past the depth buffer stays in.
inline const std::string kLeapStart = R"(//VTK::Terminate::Init
  g_bricks = vec3(textureSize(in_volume[0], 0)) / 8.0;
  g_start = g_dataPos;
  g_forward = step(vec3(0.0), g_dirStep);
  vec3 l_step = mix(min(g_dirStep, vec3(-1e-9)), max(g_dirStep, vec3(1e-9)), g_forward);
  g_stepsPerBrick = 1.0 / (l_step * g_bricks);
  vec3 l_exit = (mix(in_texMin[0], in_texMax[0], g_forward) - g_start) / l_step;
  g_lastT = min(g_terminatePointMax + 1.0, min(l_exit.x, min(l_exit.y, l_exit.z)));
)";

// Goes to the next sample that is not transparent: by whole steps, so that samples are taken where
// VTK would take them. A software rasteriser pays for shading whether or not a sample needs it,
// so transparent samples are passed here too. The condition also ends a ray that is not a number.
inline const std::string kLeap = R"(//VTK::Base::Impl
    while (g_currentT <= g_lastT)
      {
      vec3 l_place = g_dataPos * g_bricks;
      vec3 l_brick = clamp(floor(l_place), vec3(0.0), lastBrick());
      float l_free = floor(leapsAt(l_brick) * 255.0 + 0.5);
      float l_steps = 1.0;
      if (l_free > 0.0)
        {
        vec3 l_face = l_brick + mix(vec3(1.0 - l_free), vec3(l_free), g_forward);
        vec3 l_t = (l_face - l_place) * g_stepsPerBrick;
        l_steps = max(1.0, ceil(min(l_t.x, min(l_t.y, l_t.z))));
        }
      else
        {
        float l_hu = texture3D(in_volume[0], g_dataPos).r;
        l_hu = l_hu * in_volume_scale[0].r + in_volume_bias[0].r;
        if (texture2D(in_opacityTransferFunc_0[0], vec2(lookOf(l_hu), 0.0)).r > 0.0)
          {
          break;
          }
        }
      g_currentT += l_steps;
      g_dataPos = g_start + g_currentT * g_dirStep;
      }
    if (!(g_currentT <= g_lastT))
      {
      break;
      }
)";

}  // namespace trephine
