// The volume, halved until the graphics card takes it, or refused.
//
// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <algorithm>

#include "base/log.h"
#include "base/tr.h"
#include "render/codes.h"
#include "render/scene_parts.h"
#include "render/seen_box.h"

namespace trephine {

const VoxelBox& SceneRenderer::Parts::seenBox() {
  if (!seen_box) seen_box = trephine::seenBox(voxels(), mirror->labels().get(), seen_tissues);
  return *seen_box;
}

void SceneRenderer::Parts::show() {
  reduced.reset();
  reduced_labels.reset();
  reduction = {1, 1, 1};
  fitted = refused = false;
  refusal = {};
  panel.pictures.startAnew();
  eye.pictures.startAnew();
  volume.show(mirror->mutableVolume(), mirror->labels(), *mirror, reduction, *renderer);
}

void SceneRenderer::Parts::showReduced() {
  volume.remove(*renderer);
  reduced.emplace(voxels(), reduction);
  const LabelMap* labels = mirror->labels().get();
  reduced_labels = labels ? reduced->labels(*labels) : nullptr;
  volume.show(reduced->volume(), reduced_labels, *mirror, reduction, *renderer);
}

void SceneRenderer::Parts::otherLabels() {
  seen_box.reset();
  const std::shared_ptr<const LabelMap> labels = mirror->labels();
  reduced_labels = reduced && labels ? reduced->labels(*labels) : nullptr;
  volume.setLabels(reduced ? reduced_labels : labels);
  labels_held = true;
  may_need_more = labels != nullptr;
  if (volume.labelsSent()) spoilLooks();  // there are none any more
}

void SceneRenderer::Parts::labelsChanged(const VoxelBox& box) {
  if (!mirror->labels()) return;
  volume.labelsChanged(reduced ? reduced->updateLabels(*mirror->labels(), box, *reduced_labels)
                               : box);
}

void SceneRenderer::Parts::changed(const VoxelBox& box) {
  volume.changed(reduced ? reduced->update(voxels(), box) : box);
  panel.cut(box);
}

bool SceneRenderer::Parts::reduceAsNeeded() {
  GLint most = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
  if (most_edge > 0) most = std::min(most, most_edge);
  const Index3 before = reduction;
  const Index3 needed = reductionFor(voxels().geometry.size, most, mirror->labels() != nullptr);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    reduction[axis] = std::max(reduction[axis], needed[axis]);
  }
  return reduction != before;
}

void SceneRenderer::Parts::fit() {
  may_need_more = false;
  // Labels that came later need slices of their own.
  if (!reduceAsNeeded() && fitted) return;
  if (fitted) spoil();
  fitted = true;
  constexpr int kMost = 16;  // beyond it there is too little left to see
  for (;;) {
    if (reduction != Index3{1, 1, 1}) showReduced();
    handToVtk(panel.width, panel.height);
    volume.sendChanges(*renderer);  // takes the first texture unit before VTK does
    if (volume.sendAll(*renderer) && most_edge >= 0) {
      constexpr double kNoEnd_ms = 1e9;
      volume.sendLabels(*renderer, kNoEnd_ms);
      return;
    }
    if (*std::max_element(reduction.begin(), reduction.end()) >= kMost) break;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (voxels().geometry.size[axis] > 2 * reduction[axis]) reduction[axis] *= 2;
    }
  }
  refused = true;
  refusal = Error{code::kVolumeRefused, tr("The graphics card cannot show this volume"), "3-D view",
                  tr("Close other programs, or import the case with a part or fewer voxels")};
  spdlog::warn("The graphics card refused a volume: {}", volume.complaint());
}

}  // namespace trephine
