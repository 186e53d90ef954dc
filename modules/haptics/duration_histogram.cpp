#include "haptics/duration_histogram.h"

#include <algorithm>
#include <cmath>

namespace trephine {

void DurationHistogram::add(std::int64_t ns) {
  const auto bin = std::size_t(std::clamp<std::int64_t>(ns / kBin_ns, 0, std::int64_t(kBins)));
  ++bins_[bin];
  ++count_;
  max_ns_ = std::max(max_ns_, ns);
}

DurationSummary DurationHistogram::summary() const {
  const auto quantile = [this](double q) {
    const auto wanted = std::uint64_t(std::ceil(q * double(count_)));
    std::uint64_t seen = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      seen += bins_[bin];
      if (seen >= wanted) return std::min(double(bin + 1) * kBin_ns, double(max_ns_));
    }
    return double(max_ns_);
  };
  if (count_ == 0) return {};
  return {quantile(0.5), quantile(0.99), quantile(0.999), double(max_ns_)};
}

}  // namespace trephine
