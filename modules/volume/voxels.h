// The memory of a volume: a vector whose pages are zero because the kernel made them so.
//
// std::vector would write every zero itself, on one thread, which takes longer than reading a CT
// into it. Here pages come when they are first written, by whichever thread does so, and large ones
// where the kernel gives them. For numbers alone: no constructor runs.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#include <utility>
#include <vector>

namespace trephine {

template <class T>
struct ZeroedAllocator {
  using value_type = T;
  static constexpr std::size_t kMapped = std::size_t(1) << 20;  // bytes; smaller ones are calloc's

  ZeroedAllocator() = default;
  template <class U>
  ZeroedAllocator(const ZeroedAllocator<U>&) {}

  T* allocate(std::size_t count) {
    if (count > std::numeric_limits<std::ptrdiff_t>::max() / sizeof(T)) throw std::bad_alloc();
    const std::size_t bytes = count * sizeof(T);
    void* memory = nullptr;
    if (bytes < kMapped) {
      memory = std::calloc(count, sizeof(T));
    } else {
      memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
      if (memory == MAP_FAILED) throw std::bad_alloc();
      ::madvise(memory, bytes, MADV_HUGEPAGE);  // a hint: failing costs time only
    }
    if (!memory) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    if (count * sizeof(T) < kMapped) {
      std::free(memory);
    } else {
      ::munmap(memory, count * sizeof(T));
    }
  }

  // Nothing to do: the memory is zero. (A vector that is made smaller and larger again without a
  // value gets its old elements back.)
  template <class U>
  void construct(U*) {}
  template <class U, class... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
  }

  friend bool operator==(const ZeroedAllocator&, const ZeroedAllocator&) { return true; }
};

using Voxels = std::vector<std::int16_t, ZeroedAllocator<std::int16_t>>;

}  // namespace trephine
