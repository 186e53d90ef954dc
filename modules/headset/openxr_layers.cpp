#include "headset/openxr_layers.h"

#include <cmath>

namespace trephine {

namespace {

Pose poseOf(const XrPosef& of) {
  return {{of.position.x, of.position.y, of.position.z},
          Quat(of.orientation.w, of.orientation.x, of.orientation.y, of.orientation.z)};
}

XrPosef poseOf(const Pose& of) {
  const Quat& q = of.orientation;
  const Vec3& p = of.position;
  return {{float(q.x), float(q.y), float(q.z), float(q.w)}, {float(p.x), float(p.y), float(p.z)}};
}

XrFovf fovOf(const FieldOfView& of) {
  return {float(std::atan(of.left)), float(std::atan(of.right)), float(std::atan(of.up)),
          float(std::atan(of.down))};
}

}  // namespace

EyeView viewOf(const XrView& of) {
  return {poseOf(of.pose),
          {std::tan(of.fov.angleLeft), std::tan(of.fov.angleRight), std::tan(of.fov.angleDown),
           std::tan(of.fov.angleUp)}};
}

void OpenXrLayers::addPair(const Eyes& drawn_for_m, const Images& images) {
  for (std::size_t eye = 0; eye < 2; ++eye) {
    XrCompositionLayerProjectionView& view = views_[eye];
    view.type = XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW;
    view.pose = poseOf(drawn_for_m[eye].pose);
    view.fov = fovOf(drawn_for_m[eye].sees);
    view.subImage = images[eye];
  }
  pair_.space = room_;
  pair_.viewCount = 2;
  pair_.views = views_;
  add(pair_);
}

void OpenXrLayers::addStanding(const Eyes& drawn_for_m, double away_m, const Images& images) {
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const EyeView& of_eye = drawn_for_m[eye];
    const FieldOfView& sees = of_eye.sees;
    const Vec3 middle(0.5 * (sees.left + sees.right), 0.5 * (sees.down + sees.up), -1.0);
    XrCompositionLayerQuad& quad = quads_[eye];
    quad.space = room_;
    quad.eyeVisibility = eye == 0 ? XR_EYE_VISIBILITY_LEFT : XR_EYE_VISIBILITY_RIGHT;
    quad.subImage = images[eye];
    quad.pose = poseOf(Pose{of_eye.pose.position + of_eye.pose.orientation * (away_m * middle),
                            of_eye.pose.orientation});
    quad.size = {float(away_m * (sees.right - sees.left)), float(away_m * (sees.up - sees.down))};
    add(quad);
  }
}

void OpenXrLayers::addScreen(const Pose& at_m, double width_m, double height_m,
                             const XrSwapchainSubImage& image) {
  XrCompositionLayerQuad& quad = quads_[0];
  quad.space = room_;
  quad.eyeVisibility = XR_EYE_VISIBILITY_BOTH;
  quad.subImage = image;
  quad.pose = poseOf(at_m);
  quad.size = {float(width_m), float(height_m)};
  add(quad);
}

}  // namespace trephine
