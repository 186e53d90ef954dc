// What the viewer cuts away from the picture: a crop box along the volume's axes and a free plane,
// with the handles by which both are dragged. Pure; patient frame, mm.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "render/clip_plane.h"
#include "render/screen_lines.h"
#include "render/view_camera.h"
#include "volume/volume.h"

namespace trephine {

class ClipTools {
 public:
  enum class Grip { face, plane, normal };
  struct Handle {
    Grip grip = Grip::face;
    int face = 0;  // 2 * axis, and 1 more for its high side
    Vec3 at_mm{0.0};
  };

  // Of another volume: as reset(). Of the same place: all stays.
  void setVolume(const GridGeometry& geometry);
  void showBox(bool on) { box_on_ = on; }
  // A plane that was never placed lies in the middle and faces the eye.
  void showPlane(bool on, const ViewCamera& camera);
  // Shows the plane through a tool's tip: what lies between it and the eye goes. Along the tool's
  // axis, which the plane then contains, or, where `axis` has no length or points at the eye,
  // facing the eye.
  void planeThrough(const Vec3& tip_mm, const Vec3& axis, const ViewCamera& camera);
  // Box and plane are off, the box is whole and the plane was never placed.
  void reset();

  bool boxShown() const { return box_on_; }
  bool planeShown() const { return plane_on_; }
  bool cutsAnything() const { return box_on_ || plane_on_; }
  // What the picture leaves out: nothing where both are off.
  std::vector<ClipPlane> planes() const;

  std::vector<Handle> handles() const;
  // The handle within reach of a pixel (from the lower left corner), nearest first.
  std::optional<Handle> handleAt(const glm::dvec2& pixel, const ViewCamera& camera, int width,
                                 int height, double reach_pixels) const;
  // Drags a handle by pixels since the last call, right and up: a face or the plane follows along
  // its normal, the grip `normal` turns the plane. Then the handle is taken anew from handles().
  void drag(const Handle& handle, const glm::dvec2& pixels, const ViewCamera& camera, int width,
            int height);
  // Towards what is cut away for positive mm; at most half the volume's diagonal from its middle.
  void movePlane(double mm);

  void addLines(const ViewCamera& camera, int width, int height, ScreenLines& to) const;

 private:
  Vec3 normalOf(int face) const;
  Vec3 corner(int index) const;
  Vec3 middle() const;
  double reach_mm() const;  // of the plane's drawn square, half its edge

  GridGeometry geometry_;
  std::array<double, 6> faces_{};  // voxel coordinates: low and high of i, j, k
  Vec3 point_mm_{0.0};
  Vec3 normal_{0.0, -1.0, 0.0};
  bool placed_ = false;
  bool box_on_ = false;
  bool plane_on_ = false;
};

// Where the light comes from (right, up, towards the eye) after a drag by pixels: it follows the
// hand over the half sphere that faces the eye. `from` may have any length; the outcome is a
// unit vector.
Vec3 draggedLight(const Vec3& from, const glm::dvec2& pixels, int height);

}  // namespace trephine
