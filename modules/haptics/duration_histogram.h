// Durations of ticks, counted without allocation: bins of a thousandth of the duration, up to a
// minute.
#pragma once

#include <array>
#include <cstdint>

namespace trephine {

struct DurationSummary {
  double median_ns = 0.0, p99_ns = 0.0, p999_ns = 0.0, max_ns = 0.0;
};

class DurationHistogram {
 public:
  // A negative one counts as 0. No lock.
  void add(std::int64_t ns);
  DurationSummary summary() const;  // upper edges of bins, the largest exact; 0 of none
  std::uint64_t count() const { return count_; }

 private:
  // Up to 2 * kFine ns a bin is 1 ns wide; from there on each doubling has kFine bins.
  static constexpr int kFineBits = 10;
  static constexpr std::uint64_t kFine = 1u << kFineBits;
  static constexpr int kMostBits = 36;  // 2^36 ns are 69 s: what is longer is counted as that
  static constexpr std::size_t kBins = (kMostBits - kFineBits + 1) * kFine;
  static std::size_t binOf(std::uint64_t ns);
  static double upperEdge_ns(std::size_t bin);

  std::array<std::uint32_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  std::int64_t max_ns_ = 0;
};

}  // namespace trephine
