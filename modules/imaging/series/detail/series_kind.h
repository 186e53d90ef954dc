// What kind of image the slices of a CT series say they are.
#pragma once

#include "imaging/series/detail/series.h"

namespace trephine {

// By Image Type or Frame Type, Volumetric Properties, Volume Based Calculation Technique, Pixel
// Presentation, Modality LUT and real-world value maps: refuses what holds no measured HU or no
// volume (NOT_HU, PROJECTION, COLOUR), asks of what was calculated from HU (DERIVED_IMAGES) or has
// another scale beside them (VALUE_MAP). DERIVED alone says nothing: archives write it of any copy.
void checkKind(Series& series, const Answers& answers);

}  // namespace trephine
