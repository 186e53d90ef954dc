// What a program has allocated, byte by byte: unlike resident memory it is the same in every run.
// Include it in one file of a program: it stands between the program and the C library (glibc).
#pragma once

#include <malloc.h>

#include <atomic>
#include <cstdlib>

namespace trephine::test {

inline std::atomic<long long> allocated_bytes{0}, most_allocated_bytes{0};

inline void countAllocated(long long bytes) {
  const long long now = allocated_bytes.fetch_add(bytes) + bytes;
  long long most = most_allocated_bytes;
  while (now > most && !most_allocated_bytes.compare_exchange_weak(most, now)) {
  }
}
inline void forgetMostAllocated() {
  most_allocated_bytes = allocated_bytes.load();
}

}  // namespace trephine::test

extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

inline void* counted(void* block) {
  if (block) trephine::test::countAllocated(static_cast<long long>(malloc_usable_size(block)));
  return block;
}

__attribute__((used)) void* malloc(std::size_t size) {
  return counted(__libc_malloc(size));
}
__attribute__((used)) void* calloc(std::size_t count, std::size_t size) {
  return counted(__libc_calloc(count, size));
}
__attribute__((used)) void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return counted(__libc_memalign(alignment, size));
}
__attribute__((used)) void free(void* block) {
  if (!block) return;
  trephine::test::countAllocated(-static_cast<long long>(malloc_usable_size(block)));
  __libc_free(block);
}
__attribute__((used)) void* realloc(void* block, std::size_t size) {
  if (block) trephine::test::countAllocated(-static_cast<long long>(malloc_usable_size(block)));
  return counted(__libc_realloc(block, size));
}

}  // extern "C"
