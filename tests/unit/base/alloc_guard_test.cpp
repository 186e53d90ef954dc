#include "base/rt/alloc_guard.h"

#include <gtest/gtest.h>

#include <new>
#include <semaphore>
#include <thread>
#include <vector>

#include "support.h"

namespace trephine::rt {
namespace {

// Calls the operators themselves: a compiler may leave out a new that is deleted at once.
void allocateAndRelease() {
  ::operator delete(::operator new(64));
}

// What `work` allocates and releases under a guard.
template <class Work>
std::uint64_t counted(Work&& work) {
  const std::uint64_t before = guardedAllocations();
  {
    NoAllocation guard;
    work();
  }
  return guardedAllocations() - before;
}

TEST(AllocationGuard, CountsAllocationAndRelease) {
  EXPECT_EQ(counted(allocateAndRelease), 2u);
}

TEST(AllocationGuard, CountsAGrowingVector) {
  std::vector<int> values(4);
  EXPECT_GE(counted([&] { values.resize(4096); }), 1u);
}

TEST(AllocationGuard, CountsOverAlignedMemory) {
  EXPECT_EQ(counted([] {
              ::operator delete (::operator new (256, std::align_val_t{128}),
                                 std::align_val_t{128});
            }),
            2u);
}

TEST(AllocationGuard, CountsWhatDoesNotThrow) {
  EXPECT_EQ(counted([] {
              ::operator delete(::operator new(64, std::nothrow));
              ::operator delete (::operator new (256, std::align_val_t{128}, std::nothrow),
                                 std::align_val_t{128});
            }),
            4u);
}

TEST(AllocationGuard, WhatDoesNotThrowIsNothingWhereThereIsNoRoom) {
  if (test::kSanitized) GTEST_SKIP() << "A sanitizer ends a program that asks for so much";
  EXPECT_EQ(::operator new(std::size_t(1) << 62, std::nothrow), nullptr);
}

TEST(AllocationGuard, CountsNothingForWorkInPlace) {
  std::vector<int> values(64, 1);
  int sum = 0;
  EXPECT_EQ(counted([&] {
              for (int v : values) sum += v;
            }),
            0u);
  EXPECT_EQ(sum, 64);
}

TEST(AllocationGuard, CountsNothingOnceItHasGone) {
  const std::uint64_t before = guardedAllocations();
  { NoAllocation guard; }
  allocateAndRelease();
  EXPECT_EQ(guardedAllocations(), before);
}

TEST(AllocationGuard, StandsUntilTheOuterOneOfTwoGoes) {
  EXPECT_EQ(counted([] {
              { NoAllocation inner; }
              allocateAndRelease();
            }),
            2u);
}

TEST(AllocationGuard, WatchesItsOwnThreadOnly) {
  std::binary_semaphore ready(0), begin(0), done(0), end(0);
  std::thread other([&] {  // its own set-up allocates, so it stands ready before the guard does
    ready.release();
    begin.acquire();
    for (int i = 0; i < 100; ++i) allocateAndRelease();
    done.release();
    end.acquire();
  });
  ready.acquire();
  EXPECT_EQ(counted([&] {
              begin.release();
              done.acquire();
            }),
            0u);
  end.release();
  other.join();
}

TEST(AllocationGuard, CountsOnAnyThread) {
  std::uint64_t during = 0;
  std::thread guarded([&] { during = counted(allocateAndRelease); });
  guarded.join();
  EXPECT_EQ(during, 2u);
}

TEST(AllocationGuard, GivesAlignedMemory) {
  for (std::size_t alignment : {32u, 64u, 4096u}) {
    void* memory = ::operator new (100, std::align_val_t{alignment});
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % alignment, 0u);
    ::operator delete (memory, std::align_val_t{alignment});
  }
}

}  // namespace
}  // namespace trephine::rt
