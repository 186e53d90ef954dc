// A slice as a picture: which HU are black and which are white, and which side is up. Looking never
// changes a volume.
#pragma once

#include <QImage>
#include <array>

#include "imaging/importer.h"

namespace trephine {

struct HuWindow {
  double centre_hu = 0.0;
  double width_hu = 2000.0;
};

// The whole of a body from air to dense bone: for thumbnails.
inline constexpr HuWindow kWideWindow{0.0, 2000.0};

struct WindowPreset {
  const char* name;  // translated in the context "HuWindow"
  HuWindow window;
};
// Usual settings of CT viewers: W 2000 L 500, W 400 L 40, W 1500 L -600.
inline constexpr std::array<WindowPreset, 4> kWindowPresets{{
    {QT_TRANSLATE_NOOP("HuWindow", "Bone"), {500.0, 2000.0}},
    {QT_TRANSLATE_NOOP("HuWindow", "Soft tissue"), {40.0, 400.0}},
    {QT_TRANSLATE_NOOP("HuWindow", "Lung"), {-600.0, 1500.0}},
    {QT_TRANSLATE_NOOP("HuWindow", "Wide"), kWideWindow},
}};

// From the lowest to the highest value of the slice: for what is no CT.
HuWindow wholeRange(const SlicePicture& slice);

// Greys of one pixel a value, black at centre - width/2 and below, white at centre + width/2 and
// above; null for an empty slice.
QImage windowed(const SlicePicture& slice, const HuWindow& window);

// How a slice is turned to be looked at as is customary: front or head up, the patient's right or
// front at the left. Columns of `direction` are the unit directions, LPS, of columns, rows and
// slices.
struct Mirroring {
  bool across = false, down = false;
};
Mirroring mirroringOf(const Mat3& direction);
// The axis (0 to 2, of LPS) along which it mostly points.
int mainAxis(const Vec3& direction);

}  // namespace trephine
