// Whether the slices of a series are one scan: what they say of patient, acquisition and place
// beside their positions. Each check adds a finding, and a question where a person can decide.
#pragma once

#include <vector>

#include "imaging/series/detail/findings.h"
#include "imaging/series/detail/series_geometry.h"

namespace trephine {

using Headers = std::vector<const DicomHeader*>;

// Of a series in parts those that are wanted: all, joined, or one of them.
Headers chooseParts(const Series& series, Headers placed, const Answers& answers,
                    SeriesReport& report, Findings& findings);
// Pixel spacing and orientation of a stack that was joined: the mean, which is nearest to all.
void takeMeanOrientation(const Headers& used, StackInput& input);
// What slices of one volume must share beyond their geometry.
void checkAcquisition(const Headers& used, const Answers& answers, Findings& findings);
// Whether there are enough slices, near enough to each other, to be cut.
void checkDensity(const Headers& used, const Stack& stack, const Answers& answers,
                  Findings& findings);
// What headers say of where slices lie, beside their positions.
void checkContradictions(const Headers& in_order, const Stack& stack, const Answers& answers,
                         Findings& findings);

}  // namespace trephine
