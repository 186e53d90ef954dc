#include "volume/carve_log.h"

#include <algorithm>
#include <bit>

namespace trephine {

CarveLog::CarveLog(std::size_t ring_entries)
    : ring_(std::bit_ceil(std::max<std::size_t>(ring_entries, 1))),
      mask_(ring_.size() - 1),
      loaded_(kLoadEntries) {}

bool CarveLog::isReady(std::uint64_t first, std::uint64_t end) const {
  end = std::min(end, ringBegin());
  if (first >= end) return true;
  if (served_.load(std::memory_order_acquire) != asked_.load(std::memory_order_relaxed)) {
    return false;
  }
  return load_first_ <= first && end <= load_end_;
}

void CarveLog::requestLoad(std::uint64_t first, std::uint64_t end) {
  const std::uint32_t asked = asked_.load(std::memory_order_relaxed);
  if (served_.load(std::memory_order_acquire) != asked) return;
  load_first_ = first;
  load_end_ = end;
  asked_.store(asked + 1, std::memory_order_release);
}

std::span<const CarveEntry> CarveLog::unsaved(std::uint64_t& first) const {
  first = saved_.load(std::memory_order_relaxed);
  const std::uint64_t head = head_.load(std::memory_order_acquire);
  const std::uint64_t at = first & mask_;
  const auto count = std::size_t(std::min<std::uint64_t>(head - first, ring_.size() - at));
  return {ring_.data() + at, count};
}

std::span<CarveEntry> CarveLog::pendingLoad(std::uint64_t& first) {
  if (asked_.load(std::memory_order_acquire) == served_.load(std::memory_order_relaxed)) return {};
  first = load_first_;
  return {loaded_.data(), std::size_t(load_end_ - load_first_)};
}

}  // namespace trephine
