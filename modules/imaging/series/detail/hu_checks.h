// What a look at the voxels says of a series, whatever kind of file it comes from.
#pragma once

#include "imaging/common/detail/hu_sanity_check.h"
#include "imaging/common/detail/stored_values.h"
#include "imaging/report/report.h"

namespace trephine {

// Asks IMPLAUSIBLE_HU where the values can hardly be HU, a refusal unless answered; else notes
// NO_AIR. `report` holds the range of the HU.
void checkHu(const HuSanityCheck& look, const Answers& answers, SeriesReport& report);
// Notes PADDING_TO_AIR, where there was any.
void sayPadding(const UnnamedPadding& padding, SeriesReport& report);
// Whether it was asked when the series was read, and these answers do not agree.
bool refusedByHu(const SeriesReport& report, const Answers& answers);

}  // namespace trephine
