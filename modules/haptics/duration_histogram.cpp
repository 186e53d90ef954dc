#include "haptics/duration_histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace trephine {

// By its highest 11 bits.
std::size_t DurationHistogram::binOf(std::uint64_t ns) {
  ns = std::min(ns, (std::uint64_t(1) << kMostBits) - 1);
  const int shift = std::max(0, int(std::bit_width(ns)) - (kFineBits + 1));
  return std::size_t(shift) * kFine + std::size_t(ns >> shift);
}

double DurationHistogram::upperEdge_ns(std::size_t bin) {
  const std::size_t shift = bin < 2 * kFine ? 0 : bin / kFine - 1;
  return double((std::uint64_t(bin - shift * kFine) + 1) << shift);
}

void DurationHistogram::add(std::int64_t ns) {
  ++bins_[binOf(std::uint64_t(std::max<std::int64_t>(ns, 0)))];
  ++count_;
  max_ns_ = std::max(max_ns_, ns);
}

DurationSummary DurationHistogram::summary() const {
  const auto quantile = [this](double q) {
    const auto wanted = std::uint64_t(std::ceil(q * double(count_)));
    std::uint64_t seen = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      seen += bins_[bin];
      if (seen >= wanted) return std::min(upperEdge_ns(bin), double(max_ns_));
    }
    return double(max_ns_);
  };
  if (count_ == 0) return {};
  return {quantile(0.5), quantile(0.99), quantile(0.999), double(max_ns_)};
}

}  // namespace trephine
