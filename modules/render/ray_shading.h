// What the ray caster's fragment shader is told: the texts that take the place of VTK's own, and
// the numbers of tissues, volume and view that they read.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/math.h"
#include "render/clip_plane.h"
#include "render/scene_renderer.h"
#include "tissue/tissue_look.h"
#include "tissue/tissue_set.h"
#include "volume/volume.h"

class vtkShaderProperty;

namespace trephine {

struct RayShading {
  const GridGeometry* geometry = nullptr;  // null: nothing is shown
  std::size_t rows = 1;                    // of labels that are told apart
  double low_HU = -1024.0;                 // over which VTK spreads its tables
  double high_HU = 3071.0;
  TissueSet seen;
  TissueLooks looks;

  ShadingOptions options;
  bool leaping = true;
  int shows = 0;  // 0: the picture, 1: the first tissue, 2: the normal there
  std::vector<ClipPlane> clip;
  Vec3 light = SceneRenderer::kLight;
  bool coarse = false;           // fewer samples are taken, and fewer places around each
  std::optional<double> cut_HU;  // of what was removed, on the graphics card; nothing was: none
  Vec3 eye_right{1.0, 0.0, 0.0}, eye_up{0.0, 0.0, 1.0}, eye_forward{0.0, 1.0, 0.0};

  // Anew, after anything above changed that is not of the view.
  void build(vtkShaderProperty& shader) const;
  // Numbers of the view (clip, light, cuts, eye, coarseness), which may be others at each draw: the
  // shader is not built anew for them.
  void tellView(vtkShaderProperty& shader) const;

 private:
  // Whether surfaces and classes are shown truly, or as VTK shows them.
  bool isTrue() const;
  // Numbers of the tissues and the volume, that only build() changes.
  void tellTissues(vtkShaderProperty& shader) const;
};

}  // namespace trephine
