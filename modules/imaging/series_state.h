// What stands between a series and a volume, by its report and by what was answered. Pure.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "imaging/importer.h"

namespace trephine {

// A verdict, and whether questions are open. `answered`: refused as it is, but all that it asks has
// been answered. Whether that is enough is for the reader to say. `structures`: no CT, but a
// segmentation of one.
enum class SeriesState { pass, repaired, answered, asks, structures, refused };

SeriesState seriesState(const SeriesReport& series, const Answers& answers);
bool mayBeRead(SeriesState state);

// Those given of one series, by its uid.
const Answers& answersOf(const std::map<std::string, Answers>& answers, const std::string& uid);

// Positions in `series` in the order of a list: what can be read, then what asks, then the rest; CT
// first in each, and those with more slices before others.
std::vector<std::size_t> seriesOrder(const std::vector<SeriesReport>& series,
                                     const std::map<std::string, Answers>& answers);

// Choices of `after` that nobody has answered and that were not there `before` the read.
std::vector<Choice> newChoices(const SeriesReport& before, const SeriesReport& after,
                               const Answers& answers);

}  // namespace trephine
