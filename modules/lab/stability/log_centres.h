// Values on a logarithmic axis, put together where they are many.
#pragma once

#include <cstddef>
#include <vector>

namespace trephine {

// Ascending, each once; values that differ by at most 1e-9 of the greater one are one.
std::vector<double> distinct(std::vector<double> values);

// Centres for values above 0 on a logarithmic axis, ascending: the values themselves where they are
// at most `most` (2 or more) and none lie closer together than evenly spaced ones would; otherwise
// `most` ones from the least to the greatest value, evenly spaced on that axis. None for no values.
// A value belongs to the centre nearest to its logarithm; nearestCentre() returns its index.
std::vector<double> logCentres(std::vector<double> values, std::size_t most);
std::size_t nearestCentre(const std::vector<double>& centres, double value);

}  // namespace trephine
