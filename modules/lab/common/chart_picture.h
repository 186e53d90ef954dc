// Drawings of VTK's 2-D context as pictures.
#pragma once

#include <initializer_list>

#include "render/picture.h"

class vtkAbstractContextItem;

namespace trephine {

// Items draw this many times larger than the picture, which is then averaged: VTK's own smoothing
// leaves specks below texts.
constexpr int kChartFine = 2;

// The items over one another, the first at the bottom, on white. Empty where the window gave no
// pixels. Needs a display (probeDisplay).
Picture drawItems(std::initializer_list<vtkAbstractContextItem*> items, int width, int height);

}  // namespace trephine
