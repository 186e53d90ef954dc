// A line that is drawn on the tissue: a flat colour with a dark rim, seen on bone and on liver, and
// through which a cut along it is seen (kOutlineOpacity in scene_tools.cpp).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "base/math.h"
#include "render/view_camera.h"

class vtkRenderer;

namespace trephine {

class OutlineDrawing {
 public:
  OutlineDrawing();
  ~OutlineDrawing();
  OutlineDrawing(const OutlineDrawing&) = delete;
  OutlineDrawing& operator=(const OutlineDrawing&) = delete;

  // This line and no other; none for fewer than two different points, a width that is not above 0
  // or anything that is not finite.
  void show(const std::vector<Vec3>& points_mm, bool closed, double width_mm,
            vtkRenderer& renderer);
  // Before it is drawn: brings it nearer to this eye by about kLift_mm, so that the surface on
  // which it lies does not hide it. Where it is seen stays the same.
  static constexpr double kLift_mm = 1.5;
  void lift(const ViewCamera& camera);
  // The corners of a box around it, patient frame; nothing while there is no line.
  std::optional<std::array<Vec3, 8>> box() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace trephine
