// How far a notch of the wheel or a key goes in every view.
#pragma once

namespace trephine {

constexpr double kZoomStep = 1.1;      // a notch, or a key
constexpr double kWheelNotch = 120.0;  // Qt: eighths of a degree
constexpr int kPageOfSlices = 10;      // Page Up and Page Down

}  // namespace trephine
