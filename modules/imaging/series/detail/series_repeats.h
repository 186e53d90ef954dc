// Several slices at one place: copies, phases, or a question.
#pragma once

#include <vector>

#include "imaging/series/detail/series.h"

namespace trephine {

// Drops all but one of the slices that lie at one place and hold the same pixels, with a notice.
// Opens files. Where every place holds as many different slices, they are phases: left alone.
void dropEqualRepeats(Series& series, const Progress& progress);

// Of slices sorted by place (`places_mm` along the normal): those that one volume is made of, in
// that order. Adds PHASES or DUPLICATE_POSITIONS and what is to choose to `report`; while that is
// open the first of each place are taken. `all` is Series::slices, in which they lie.
std::vector<std::size_t> chooseRepeats(const std::vector<const DicomHeader*>& slices,
                                       const std::vector<double>& places_mm, const Answers& answers,
                                       const std::vector<DicomHeader>& all, SeriesReport& report);

}  // namespace trephine
