#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "base/rt/event_ring.h"
#include "base/rt/latest_value.h"

namespace trephine::rt {
namespace {

// Wide enough that a torn copy shows: every element must hold the same number.
struct Wide {
  std::array<std::uint64_t, 32> number{};
};

Wide wide(std::uint64_t number) {
  Wide value;
  value.number.fill(number);
  return value;
}

bool isWhole(const Wide& value) {
  for (std::uint64_t number : value.number) {
    if (number != value.number[0]) return false;
  }
  return true;
}

TEST(LatestValue, HoldsADefaultBeforeTheFirstWrite) {
  LatestValue<int> latest;
  EXPECT_FALSE(latest.refresh());
  EXPECT_EQ(latest.value(), 0);
}

TEST(LatestValue, ChangesForTheReaderOnlyWhenItRefreshes) {
  LatestValue<int> latest;
  latest.write(1);
  EXPECT_EQ(latest.value(), 0);
  EXPECT_TRUE(latest.refresh());
  EXPECT_EQ(latest.value(), 1);
}

TEST(LatestValue, SaysWhenNothingNewCameAndKeepsTheOldValue) {
  LatestValue<int> latest;
  latest.write(5);
  ASSERT_TRUE(latest.refresh());
  EXPECT_FALSE(latest.refresh());
  EXPECT_EQ(latest.value(), 5);
}

TEST(LatestValue, SkipsToTheNewest) {
  LatestValue<int> latest;
  for (int i = 1; i <= 10; ++i) latest.write(i);
  ASSERT_TRUE(latest.refresh());
  EXPECT_EQ(latest.value(), 10);
}

TEST(LatestValue, GivesEachOfManyTurnsItsOwnValue) {
  LatestValue<int> latest;
  for (int i = 1; i <= 100; ++i) {
    latest.writeSlot() = i;
    latest.publish();
    ASSERT_TRUE(latest.refresh());
    ASSERT_EQ(latest.value(), i);
  }
}

TEST(LatestValue, NeverTearsNorGoesBackBetweenTwoThreads) {
  constexpr std::uint64_t kWrites = 200000;
  LatestValue<Wide> latest;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kWrites; ++i) latest.write(wide(i));
  });
  std::uint64_t last = 0, torn = 0, backwards = 0;
  while (last < kWrites) {
    if (!latest.refresh()) continue;
    const Wide& value = latest.value();
    torn += isWhole(value) ? 0 : 1;
    backwards += value.number[0] <= last ? 1 : 0;
    last = value.number[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
}

TEST(EventRing, GivesItemsInTheOrderTheyCame) {
  EventRing<int> ring(4);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(ring.push(i));
  EXPECT_EQ(ring.size(), 3u);
  int item = -1;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(ring.pop(item));
    EXPECT_EQ(item, i);
  }
  EXPECT_EQ(ring.size(), 0u);
}

TEST(EventRing, LeavesTheItemAloneWhenItIsEmpty) {
  EventRing<int> ring(2);
  int item = 42;
  EXPECT_FALSE(ring.pop(item));
  EXPECT_EQ(item, 42);
}

TEST(EventRing, RoundsItsCapacityUpToAPowerOfTwo) {
  EXPECT_EQ(EventRing<int>(5).capacity(), 8u);
  EXPECT_EQ(EventRing<int>(8).capacity(), 8u);
  EXPECT_EQ(EventRing<int>(0).capacity(), 1u);
}

TEST(EventRing, DropsTheNewItemAndCountsItWhenFull) {
  EventRing<int> ring(2);
  EXPECT_TRUE(ring.push(1));
  EXPECT_TRUE(ring.push(2));
  EXPECT_FALSE(ring.push(3));
  EXPECT_FALSE(ring.push(4));
  EXPECT_EQ(ring.dropped(), 2u);
  int item = 0;
  ASSERT_TRUE(ring.pop(item));
  EXPECT_EQ(item, 1);
  EXPECT_TRUE(ring.push(5));
  ASSERT_TRUE(ring.pop(item));
  EXPECT_EQ(item, 2);
  ASSERT_TRUE(ring.pop(item));
  EXPECT_EQ(item, 5);
}

TEST(EventRing, KeepsItsOrderWhenItWrapsRound) {
  EventRing<int> ring(4);
  int next = 0, item = -1;
  for (int turn = 0; turn < 50; ++turn) {
    ASSERT_TRUE(ring.push(2 * turn));
    ASSERT_TRUE(ring.push(2 * turn + 1));
    for (int i = 0; i < 2; ++i) {
      ASSERT_TRUE(ring.pop(item));
      ASSERT_EQ(item, next++);
    }
  }
  EXPECT_EQ(ring.dropped(), 0u);
}

TEST(EventRing, LosesNothingBetweenTwoThreadsButWhatItCounts) {
  constexpr std::uint64_t kItems = 200000;
  EventRing<Wide> ring(64);
  std::atomic<bool> done{false};
  std::thread producer([&] {
    for (std::uint64_t i = 1; i <= kItems; ++i) ring.push(wide(i));
    done.store(true, std::memory_order_release);
  });
  std::uint64_t received = 0, torn = 0, backwards = 0, last = 0;
  Wide item;
  for (;;) {
    const bool was_done = done.load(std::memory_order_acquire);
    if (ring.pop(item)) {
      ++received;
      torn += isWhole(item) ? 0 : 1;
      backwards += item.number[0] <= last ? 1 : 0;
      last = item.number[0];
    } else if (was_done) {
      break;
    }
  }
  producer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
  EXPECT_EQ(received + ring.dropped(), kItems);
}

}  // namespace
}  // namespace trephine::rt
