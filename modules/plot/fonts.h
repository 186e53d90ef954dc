#pragma once

#include "base/result.h"

namespace trephine::plot {

// Qt finds fonts through an application object. Where the program has none, this makes one on Qt's
// offscreen platform, which needs no display, and keeps it until the process ends; the locale stays
// what it was. Any thread; the first call while no other thread reads or writes texts that depend
// on the locale, and before the program makes an application of its own. Error: CANNOT_DRAW where
// the platform or every font is missing.
Status readyFonts();

}  // namespace trephine::plot
