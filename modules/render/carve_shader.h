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
float g_hu;       // of the visible sample that was found, as VTK scaled it
float g_opacity;
float g_row = 0.0;  // of the label there
)";

// Where in the tables of colour and opacity a HU is, as VTK scaled it, in the voxel at g_dataPos.
inline const std::string kPlainLookUps = R"(
vec3 lastBrick() { return vec3(textureSize(in_leaps, 0)) - 1.0; }
float leapsAt(vec3 brick) { return texelFetch(in_leaps, ivec3(brick), 0).r; }
float lookOf(float hu) { return hu; }
float uncut(float opacity) { return opacity; }
)";
// The same of labelled voxels where removed ones cannot be told.
inline const std::string kNoCuts = "float uncut(float opacity) { return opacity; }\n";
inline const std::string kPlainShape = "float shapeAt(vec3 place, float hu) { return 0.0; }\n";

// The same texture holds the labels first, the leaps in the slices above, and above these the row
// of each label: one texture, since only the first of all is where a shader that was just built
// looks for it. Of a voxel it holds its label, or a neighbour's where it has none, and how much of
// what surrounds it has a label: from a half on it is inside (label_shape.h).
inline std::string labelledLookUps(std::size_t rows) {
  static_assert(kSideMargin == 0.01, "written out below");
  return "const float kRows = " + std::to_string(rows) + R"(.0;
vec3 voxels() { return vec3(textureSize(in_volume[0], 0)); }
vec3 lastBrick() { return ceil(voxels() / 8.0) - 1.0; }
float leapsAt(vec3 brick)
  {
  return texelFetch(in_leaps, ivec3(brick + vec3(0.0, 0.0, voxels().z)), 0).r;
  }
float insideAt(vec3 place)
  {
  vec3 l_at = clamp(place * voxels(), vec3(0.5), voxels() - 0.5);
  return texture3D(in_leaps, l_at / vec3(textureSize(in_leaps, 0))).g;
  }
float lookOf(float hu)
  {
  g_row = 0.0;
  if (insideAt(g_dataPos) > 0.5)
    {
    vec3 l_voxel = clamp(floor(g_dataPos * voxels()), vec3(0.0), voxels() - 1.0);
    int l_label = int(texelFetch(in_leaps, ivec3(l_voxel), 0).r * 255.0 + 0.5);
    ivec3 l_size = ivec3(voxels());
    int l_slice = l_size.x * l_size.y;
    ivec3 l_at = ivec3(l_label % l_size.x, (l_label % l_slice) / l_size.x,
                       l_size.z + int(lastBrick().z) + 1 + l_label / l_slice);
    g_row = floor(texelFetch(in_leaps, l_at, 0).r * 255.0 + 0.5);
    }
  return (g_row + mix(0.01, 0.99, clamp(hu, 0.0, 1.0))) / kRows;
  }
)";
}

// A tissue that is known by its label alone may have any HU: between it and a removed voxel all are
// its own, and it ends half-way.
inline const std::string kLabelledCuts = R"(
float uncut(float opacity)
  {
  if (g_row == 0.0 || g_hu > in_half || in_cut.x > 1.5)
    {
    return opacity;
    }
  ivec3 l_last = textureSize(in_volume[0], 0) - 1;
  ivec3 l_low = ivec3(floor(g_dataPos * voxels() - 0.5));
  for (int i = 0; i < 8; ++i)
    {
    ivec3 l_voxel = clamp(l_low + ivec3(i & 1, (i >> 1) & 1, i >> 2), ivec3(0), l_last);
    float l_hu = texelFetch(in_volume[0], l_voxel, 0).r * in_volume_scale[0].r +
                 in_volume_bias[0].r;
    if (abs(l_hu - in_cut.x) < in_cut.y)
      {
      return 0.0;
      }
    }
  return opacity;
  }
)";

inline const std::string kLabelledShape = R"(
// What a labelled structure still has of its shape at a place: nothing where it was cut.
float shapeAt(vec3 place, float hu)
  {
  return insideAt(place) * clamp((hu - in_air.x) / in_air.y, 0.0, 1.0);
  }
)";

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
// `visible`: what is done at a visible sample before the search ends there.
inline std::string leapTo(const std::string& visible) {
  return R"(//VTK::Base::Impl
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
        g_hu = texture3D(in_volume[0], g_dataPos).r * in_volume_scale[0].r + in_volume_bias[0].r;
        g_opacity = texture2D(in_opacityTransferFunc_0[0], vec2(lookOf(g_hu), 0.0)).r;
        g_opacity = g_opacity > 0.0 ? uncut(g_opacity) : 0.0;
        if (g_opacity > 0.0)
          {)" +
         visible + R"(
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
}
inline const std::string kStopThere = R"(
          break;)";
// Samples of a run that was begun (kTruthShading) are all of one colour: they need no more than
// this.
inline const std::string kGoOnInRun = R"(
          if (!g_sure || g_currentT - g_lastSeen > 1.5 || g_row != g_runRow ||
              g_hu < g_runRange.x || g_hu > g_runRange.y)
            {
            break;
            }
          g_lastSeen = g_currentT;
          float l_alpha = g_opacity * g_runGain;
          g_fragColor += (1.0 - g_fragColor.a) * l_alpha * vec4(g_runColour, 1.0);
          keepDepth();
          l_steps = g_fragColor.a > g_opacityThreshold ? g_lastT + 1.0 : 1.0;)";

// Planes that clip: the ray begins at the last that it enters by and ends at the first that it
// leaves by. After kLeapStart.
inline const std::string kClipStart = R"(
  for (int i = 0; i < in_clipCount; ++i)
    {
    float l_at = dot(in_clip[i].xyz, g_start) + in_clip[i].w;
    float l_per_step = dot(in_clip[i].xyz, g_dirStep);
    if (abs(l_per_step) < 1e-6)  // along the plane: all of the ray is on one side
      {
      g_lastT = l_at > 0.0 ? -1.0 : g_lastT;
      continue;
      }
    float l_t = -l_at / l_per_step;
    if (l_per_step > 0.0)
      {
      g_lastT = min(g_lastT, l_t);
      }
    else if (l_t > g_currentT)
      {
      g_currentT = g_faceT = l_t;
      g_faceNormal = in_clipNormal[i];
      }
    }
  g_dataPos = g_start + g_currentT * g_dirStep;
)";

// What a visible sample is told beside its HU: each tissue's range, look and colour, the light, and
// the ball of places around a sample from which its normal and its neighbourhood are taken.
inline const std::string kTruthDeclarations = R"(
float g_faceT = -1.0;  // of the sample on a face that a plane cuts
vec3 g_faceNormal = vec3(0.0);
// The run of visible samples of one tissue that the ray is in.
float g_lastSeen = -10.0;
bool g_sure = false;  // it was found twice in a row, or needs no second time
int g_runTissue = -1;
float g_runRow = 0.0;
vec2 g_runRange = vec2(0.0);
vec3 g_runNormal = vec3(0.0);
vec3 g_runColour = vec3(0.0);
float g_runGain = 0.0;      // factor on the opacity of samples after the first
bool g_runCut = false;      // it begins at the wall of a cut
// Whether a removed voxel lies before a surface: they have a HU of their own, in_cut, give or take
// the half of one.
bool facesCut(vec3 normal)
  {
  if (in_cut.x > 1.5)
    {
    return false;
    }
  vec3 l_size = vec3(textureSize(in_volume[0], 0));
  for (int i = 1; i <= 2; ++i)
    {
    vec3 l_at = (g_dataPos + normal * in_cutReach * (0.5 * float(i))) * l_size;
    ivec3 l_voxel = ivec3(clamp(floor(l_at), vec3(0.0), l_size - 1.0));
    float l_hu = texelFetch(in_volume[0], l_voxel, 0).r * in_volume_scale[0].r +
                 in_volume_bias[0].r;
    if (abs(l_hu - in_cut.x) < in_cut.y)
      {
      return true;
      }
    }
  return false;
  }
)";

// In VTK's place, at each visible sample that does not just go on in its run. A run of visible
// samples of one tissue is shaded with the normal at its beginning: the sum of HU times direction
// over a ball, which follows a surface where differences of neighbours follow the voxels. Inside of
// a tissue that lets light through there is no surface, only noise.
// A tissue whose range has others above and below is not shown where the ball reaches beyond its
// upper end and either beyond its lower end too or across an edge of which the sample is on the
// lower side: there the HU are passing by (partial volume). One sample alone may be noise: such a
// tissue shows from the second in a row on.
inline const std::string kTruthShading = R"(
    int l_tissue = -1;
    vec4 l_look = vec4(0.0);
    for (int i = 0; i < in_lookCount; ++i)
      {
      vec4 l_other = in_look[i];
      if (g_hu >= l_other.x && g_hu <= l_other.y && (l_other.z == g_row || l_other.z == 0.0))
        {
        l_tissue = i;
        l_look = l_other;
        }
      }
    bool l_between = mod(l_look.w, 2.0) == 1.0;
    bool l_ghost = l_look.w >= 2.0;
    bool l_enters = g_currentT - g_lastSeen > 1.5;  // from where nothing is seen
    bool l_fresh = l_enters || l_tissue != g_runTissue;
    bool l_seen = l_tissue >= 0;
    vec3 l_sum = vec3(0.0);
    vec3 l_shape = vec3(0.0);
    float l_low = g_hu;
    float l_high = g_hu;
    for (int i = 0; i < in_ballCount; ++i)
      {
      float l_there = texture3D(in_volume[0], g_dataPos + in_ball[i]).r;
      l_there = l_there * in_volume_scale[0].r + in_volume_bias[0].r;
      l_low = min(l_low, l_there);
      l_high = max(l_high, l_there);
      l_sum -= (l_there - g_hu) * in_ballWeight[i];  // nothing where all are alike
      l_shape -= shapeAt(g_dataPos + in_ball[i], l_there) * in_ballWeight[i];
      }
    if (l_between)
      {
      l_seen = !(l_high > l_look.y &&
                 (l_low < l_look.x ||
                  (l_high - l_low > in_edge && g_hu - l_low < l_high - g_hu)));
      }
    // A label's border has the voxels' steps. Where the HU change across it, in about its
    // direction, they know the surface better; where they do not, only the label does. Where
    // neither changes there is no surface, and a ray that was in tissue before keeps the normal
    // by which it entered.
    bool l_label_ends = l_look.z > 0.0 && length(l_shape) > 0.25;
    if (l_label_ends)
      {
      float l_along = dot(l_sum, l_shape) / (length(l_shape) * max(length(l_sum), 1e-9));
      l_sum = length(l_sum) > in_edge && abs(l_along) > 0.8 ? l_sum * sign(l_along) : l_shape;
      }
    bool l_begins = l_fresh || !g_sure;
    if (l_begins && (l_enters || l_label_ends || length(l_sum) > 0.5 * in_edge))
      {
      g_runNormal = length(l_sum) > 1e-4 ? normalize(l_sum) : g_vdir[0];
      g_runCut = facesCut(g_runNormal);
      }
    if (g_faceT == g_currentT)
      {
      g_runNormal = g_faceNormal;
      g_runCut = false;
      l_seen = l_tissue >= 0;
      }
    if (l_seen)
      {
      g_sure = !l_between || !l_fresh || g_faceT == g_currentT;
      g_lastSeen = g_currentT;
      g_runTissue = l_tissue;
      g_runRow = g_row;
      g_runRange = l_look.xy;
      float l_towards = dot(g_runNormal, g_vdir[0]);
      vec3 l_normal = l_towards < 0.0 ? -g_runNormal : g_runNormal;
      float l_lit = max(dot(l_normal, in_light), 0.0);
      float l_shine = max(dot(l_normal, normalize(in_light + g_vdir[0])), 0.0);
      vec3 l_own = g_runCut ? in_cutColour[l_tissue] : in_lookColour[l_tissue];
      g_runColour = l_own * (in_ambient[0] + in_diffuse[0] * l_lit) +
                    in_specular[0] * pow(l_shine, in_shininess[0]);
      float l_alpha = g_sure ? g_opacity : 0.0;
      g_runGain = 1.0;
      if (l_ghost)
        {
        l_alpha = l_begins && g_sure ? 0.05 + 0.5 * pow(1.0 - abs(l_towards), 2.5) : 0.0;
        g_runGain = 0.0;
        }
      if (in_shows != 0 && g_sure)
        {
        l_alpha = 1.0;
        g_runColour = in_shows == 1
                          ? in_lookColour[l_tissue]
                          : 0.5 + 0.5 * vec3(dot(g_runNormal, in_eye[0]), dot(g_runNormal, in_eye[1]),
                                             dot(g_runNormal, in_eye[2]));
        }
      g_fragColor += (1.0 - g_fragColor.a) * l_alpha * vec4(g_runColour, 1.0);
      }
    else
      {
      g_runTissue = -1;
      g_sure = false;
      }
)";

}  // namespace trephine
