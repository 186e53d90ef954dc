// What a ray leaves beside its colour, so that tools can be drawn into the picture later: how far
// from the eye's plane it met the first visible sample and where it became opaque by half, and the
// colour of what lies before that. GLSL at tags that VTK leaves empty; keepDepth() reads
// g_fragColor and g_dataPos after each sample.
#pragma once

namespace trephine {

inline constexpr const char* kDepthDeclarations = R"(//VTK::RenderToImage::Dec
vec3 g_firstPos = vec3(-9.0);
vec3 g_solidPos = vec3(-9.0);
vec4 g_front = vec4(0.0);
float depth_mm(vec3 place)
  {
  if (place.x < -8.0) return 1.0e9;
  return -(in_modelViewMatrix * in_volumeMatrix[0] * in_textureDatasetMatrix[0] *
           vec4(place, 1.0)).z;
  }
void keepDepth()
  {
  if (g_solidPos.x < -8.0 && g_fragColor.a > 0.0)
    {
    if (g_firstPos.x < -8.0) g_firstPos = g_dataPos;
    if (g_fragColor.a >= 0.5) g_solidPos = g_dataPos;
    else g_front = g_fragColor;
    }
  }
)";

inline constexpr const char* kDepthSample = R"(//VTK::RenderToImage::Impl
    keepDepth();
)";

inline constexpr const char* kDepthOutput = R"(//VTK::RenderToImage::Exit
  gl_FragData[1] = vec4(depth_mm(g_firstPos), depth_mm(g_solidPos), 0.0, 1.0);
  gl_FragData[2] = g_front;
)";

}  // namespace trephine
