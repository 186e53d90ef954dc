// A volume as VTK draws it, with two things that VTK's ray caster does not do: it takes changed
// boxes without sending the whole volume again, and it leaps over what is not visible.
//
// One thread, that of the OpenGL context. Methods that say so need the context to be current.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/cast_plan.h"
#include "render/scene_renderer.h"
#include "render/transfer_function.h"
#include "volume/grid.h"
#include "volume/label_map.h"
#include "volume/volume_mirror.h"

class vtkRenderer;

namespace trephine {

class CarveVolume {
 public:
  CarveVolume();
  ~CarveVolume();
  CarveVolume(const CarveVolume&) = delete;
  CarveVolume& operator=(const CarveVolume&) = delete;

  // Draws `copy`, which stays the caller's and must outlive its use here: VTK reads the voxels in
  // place. All of them are sent at the next draw.
  // `labels`, fitted to it, say where tissues of a label are; null: nowhere.
  // `mirror`, the caller's too, knows what was cut; one of the copy stands for `factors` of its.
  void show(Volume& copy, std::shared_ptr<const LabelMap> labels, const VolumeMirror& mirror,
            const Index3& factors, vtkRenderer& renderer);
  void remove(vtkRenderer& renderer);
  // Other labels of the same voxels, and a box of labels that changed in place: on their way until
  // labelsSent().
  void setLabels(std::shared_ptr<const LabelMap> labels);
  void labelsChanged(const VoxelBox& box);
  bool labelsSent() const;
  // Sends labels for about so long. The boxes that are there as a whole from now on. Context
  // current.
  std::vector<VoxelBox> sendLabels(vtkRenderer& renderer, double budget_ms);
  // As seen: asSeen().
  void setTissues(const TissueSet& seen, const TissueLooks& looks);
  void setClip(const std::vector<ClipPlane>& planes);
  void setLight(const Vec3& from);  // of length 1; right, up, towards the eye
  void setShading(const ShadingOptions& options);
  void setSampleDistance(double voxels);  // at full quality

  // Voxels in the box were changed in the copy: sent by sendChanges, or with all the others.
  void changed(const VoxelBox& box);
  // Sends the changed boxes into the texture in use. Context current; before each draw.
  void sendChanges(vtkRenderer& renderer);
  // Looks at every voxel again for what can be leapt over, where the copy changed as a whole.
  // Context current.
  void scan(vtkRenderer& renderer);
  // Sends every voxel now. Context current. False when the GPU refused.
  bool sendAll(vtkRenderer& renderer);
  // What VTK complained of since the last show(); empty: nothing.
  const std::string& complaint() const;

  // Pixels between rays (1 is full quality), and the samples' distance as a multiple of that at
  // full quality.
  void setQuality(double pixel_step, double ray_step);
  // Casts rays for these pixels only.
  void setPart(const PixelRect& part);
  // Off draws as VTK does; for comparisons.
  void setLeaping(bool on);
  // Each ray in the colour of its first visible tissue, opaque and without light.
  void setFirstTissue(bool on);
  // Each ray in the normal of its first visible sample, n/2 + 1/2: right, up, towards the eye.
  void setNormalsAsColour(bool on);
  // The view plane's axes, patient frame; before each draw.
  void lookFrom(const Vec3& right, const Vec3& up, const Vec3& forward);

  // Before the context goes. Context current.
  void releaseGraphics(vtkRenderer& renderer);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace trephine
