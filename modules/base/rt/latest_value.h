// Values that cross threads where only the newest counts. Neither side ever waits.
#pragma once

#include <atomic>
#include <cstdint>
#include <type_traits>

namespace trephine::rt {

// One writer thread, one reader thread, three slots: one being written, one being read, one in
// the middle. Publishing swaps the written slot into the middle; reading swaps the middle out.
template <class T>
class LatestValue {
  static_assert(std::is_trivially_copyable_v<T>, "values that cross threads are plain data");

 public:
  // Writer: the slot to fill before publish(). Its content is stale, not the last one written.
  T& writeSlot() { return slots_[write_]; }
  void publish() { write_ = middle_.exchange(write_ | kFresh, std::memory_order_acq_rel) & kIndex; }
  void write(const T& value) {
    writeSlot() = value;
    publish();
  }

  // Reader: takes the newest value if one came since the last call.
  bool refresh() {
    if (!(middle_.load(std::memory_order_relaxed) & kFresh)) return false;
    read_ = middle_.exchange(read_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  // Reader: the value last taken (a default one before the first).
  const T& value() const { return slots_[read_]; }

 private:
  static constexpr std::uint32_t kIndex = 3, kFresh = 4;
  T slots_[3]{};
  alignas(64) std::atomic<std::uint32_t> middle_{1};
  alignas(64) std::uint32_t write_ = 0;
  alignas(64) std::uint32_t read_ = 2;
};

// Parameters that a slow thread changes and the tick reads: the same exchange, named for its use.
template <class T>
using ParameterSet = LatestValue<T>;

}  // namespace trephine::rt
