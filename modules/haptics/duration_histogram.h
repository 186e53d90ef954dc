// Durations of ticks, counted without allocation: 10 ns bins to 200 us, then the largest seen.
#pragma once

#include <array>
#include <cstdint>

namespace trephine {

struct DurationSummary {
  double median_ns = 0.0, p99_ns = 0.0, p999_ns = 0.0, max_ns = 0.0;
};

class DurationHistogram {
 public:
  void add(std::int64_t ns);
  DurationSummary summary() const;  // a quantile is the upper edge of its bin
  std::uint64_t count() const { return count_; }

 private:
  static constexpr std::int64_t kBin_ns = 10;
  static constexpr std::size_t kBins = 20000;
  std::array<std::uint32_t, kBins + 1> bins_{};
  std::uint64_t count_ = 0;
  std::int64_t max_ns_ = 0;
};

}  // namespace trephine
