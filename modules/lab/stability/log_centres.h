// Values on a logarithmic axis, put together where they are many.
#pragma once

#include <cstddef>
#include <vector>

namespace trephine {

// Ascending, each once; values within 1e-9 of one another are one.
std::vector<double> distinct(std::vector<double> values);

// Centres for values on a logarithmic axis, ascending: the values themselves where they are at most
// `most` and lie apart, otherwise `most` evenly spaced ones from the least to the greatest value.
// A value belongs to the centre nearest to its logarithm.
std::vector<double> logCentres(std::vector<double> values, std::size_t most);
std::size_t nearestCentre(const std::vector<double>& centres, double value);

}  // namespace trephine
