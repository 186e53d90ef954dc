// A small cross of the patient's axes in the lower left corner: L R, A P, S I.
#pragma once

#include <memory>

#include "base/math.h"

class vtkRenderer;

namespace trephine {

class OrientationCue {
 public:
  explicit OrientationCue(vtkRenderer& renderer);
  ~OrientationCue();
  OrientationCue(const OrientationCue&) = delete;
  OrientationCue& operator=(const OrientationCue&) = delete;

  // The view plane's axes in the patient frame; the picture's size in pixels.
  void update(const Vec3& right, const Vec3& up, const Vec3& forward, int width, int height);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace trephine
