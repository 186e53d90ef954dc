// How touch was when a recording was made: a replay does as it did then.
#pragma once

namespace trephine {

// Touch as it is. It goes up with every change of any bit of a force or a cut; what each version
// changed: HapticParameters::touch_version.
constexpr int kTouchVersion = 11;

}  // namespace trephine
