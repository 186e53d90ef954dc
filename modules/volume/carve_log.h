// The voxels that were taken, oldest first: a log that only grows. A ring in memory holds the
// newest entries; the recorder thread saves them to disk (JournalFile) and brings old ones back.
// Without it the log ends when the ring is full.
//
// Two threads, no lock. The writer (holder of the grid's write token) appends and reads; the
// recorder saves and loads. An entry is overwritten in the ring only after it was saved, and an
// entry never changes, so what was once loaded stays right. Indices count from the first entry
// ever.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/limits.h"

namespace trephine {

struct CarveEntry {
  static constexpr int kClassBits = std::bit_width(unsigned(kMaxTissues - 1));
  static constexpr int kArmBits = std::bit_width(unsigned(kMaxArms - 1));
  static constexpr int kPayerBit = kClassBits + kArmBits;
  static_assert(kPayerBit + kMaxArms <= 16);

  std::uint32_t voxel = 0;
  std::int16_t hu = 0;    // of the tissue that was taken
  // From the lowest bit: its class, the arm that took it, a bit for every other arm that paid too.
  std::uint16_t tag = 0;

  int tissueClass() const { return tag & ((1 << kClassBits) - 1); }
  int arm() const { return (tag >> kClassBits) & ((1 << kArmBits) - 1); }
  std::uint32_t payers() const {
    return ((tag >> kPayerBit) & ((1u << kMaxArms) - 1)) | 1u << arm();
  }
  static std::uint16_t makeTag(int arm, int tissue_class, std::uint32_t sharers = 0) {
    return std::uint16_t(sharers << kPayerBit | std::uint32_t(arm << kClassBits | tissue_class));
  }
};
static_assert(sizeof(CarveEntry) == 8);

class CarveLog {
 public:
  static constexpr std::size_t kLoadEntries = 1 << 17;  // brought back in one go: 1 MiB

  // The ring's size is rounded up to a power of two. Nothing allocates afterwards.
  explicit CarveLog(std::size_t ring_entries);
  CarveLog(const CarveLog&) = delete;
  CarveLog& operator=(const CarveLog&) = delete;

  // ---- The writer's side.
  std::uint64_t size() const { return head_.load(std::memory_order_relaxed); }
  // Depends on how far the recorder has come.
  bool hasRoom(std::size_t entries) const {
    return size() + entries <= saved_.load(std::memory_order_acquire) + ring_.size();
  }
  // Only where hasRoom() said so.
  void append(const CarveEntry& entry) {
    const std::uint64_t index = size();
    ring_[index & mask_] = entry;
    head_.store(index + 1, std::memory_order_release);
  }
  // The oldest entry that the ring still holds.
  std::uint64_t ringBegin() const { return size() > ring_.size() ? size() - ring_.size() : 0; }
  // Whether at() may be called for all of [first, end).
  bool isReady(std::uint64_t first, std::uint64_t end) const;
  // Asks for [first, end), at most kLoadEntries, all older than the ring. One request at a time:
  // while another is on its way this does nothing.
  void requestLoad(std::uint64_t first, std::uint64_t end);
  const CarveEntry& at(std::uint64_t index) const {
    return index >= ringBegin() ? ring_[index & mask_] : loaded_[index - load_first_];
  }

  // ---- The recorder's side.
  // The next entries that are not saved, as far as they lie in one piece; `first` is their index.
  std::span<const CarveEntry> unsaved(std::uint64_t& first) const;
  void markSaved(std::uint64_t end) { saved_.store(end, std::memory_order_release); }
  // Where to put the entries that are asked for, and the index of the first; empty when none are.
  std::span<CarveEntry> pendingLoad(std::uint64_t& first);
  void markLoaded() {
    served_.store(asked_.load(std::memory_order_relaxed), std::memory_order_release);
  }

  std::size_t ramBytes() const { return (ring_.size() + loaded_.size()) * sizeof(CarveEntry); }

 private:
  std::vector<CarveEntry> ring_;
  std::uint64_t mask_;
  // The writer's while served_ equals asked_, the recorder's otherwise.
  std::vector<CarveEntry> loaded_;
  std::uint64_t load_first_ = 0;
  std::uint64_t load_end_ = 0;
  // On lines of their own: the writer's two, then the recorder's two.
  alignas(64) std::atomic<std::uint64_t> head_{0};
  std::atomic<std::uint32_t> asked_{0};
  alignas(64) std::atomic<std::uint64_t> saved_{0};
  std::atomic<std::uint32_t> served_{0};
};

}  // namespace trephine
