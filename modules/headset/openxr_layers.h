// What a runtime is to show in one frame, as it wants it said. Pure. Frames: the room's, in metres.
#pragma once

#include <array>

#include "base/eye_view.h"
#include "headset/openxr_functions.h"

namespace trephine {

EyeView viewOf(const XrView& of);

// One for each frame, on which one of the three functions is called once: it has room for two
// layers. It points into itself, and so stays where it was made.
class OpenXrLayers {
 public:
  using Images = std::array<XrSwapchainSubImage, 2>;  // left, right

  explicit OpenXrLayers(XrSpace room) : room_(room) {}
  OpenXrLayers(const OpenXrLayers&) = delete;

  // Pictures that were drawn for these eyes; the runtime moves them to where the eyes are.
  void addPair(const Eyes& drawn_for_m, const Images& images);
  // The same as two flat pictures that stand in the room, one before each eye, `away_m` off.
  void addStanding(const Eyes& drawn_for_m, double away_m, const Images& images);
  // One for both eyes, about the middle of it.
  void addScreen(const Pose& at_m, double width_m, double height_m,
                 const XrSwapchainSubImage& image);

  std::uint32_t count() const { return count_; }
  const XrCompositionLayerBaseHeader* const* all() const { return count_ > 0 ? all_ : nullptr; }

 private:
  template <class Layer>
  void add(const Layer& layer) {
    all_[count_++] = reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer);
  }

  XrSpace room_;
  XrCompositionLayerProjectionView views_[2] = {};
  XrCompositionLayerProjection pair_ =
      typed<XrCompositionLayerProjection>(XR_TYPE_COMPOSITION_LAYER_PROJECTION);
  XrCompositionLayerQuad quads_[2] = {
      typed<XrCompositionLayerQuad>(XR_TYPE_COMPOSITION_LAYER_QUAD),
      typed<XrCompositionLayerQuad>(XR_TYPE_COMPOSITION_LAYER_QUAD)};
  const XrCompositionLayerBaseHeader* all_[2] = {};
  std::uint32_t count_ = 0;
};

}  // namespace trephine
