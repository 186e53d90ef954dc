#include "base/rt/abandonable_thread.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <latch>
#include <memory>
#include <optional>

namespace trephine::rt {
namespace {

using std::chrono_literals::operator""h;
using std::chrono_literals::operator""ms;

// What a thread owns: the call that holds it, until it is let return.
struct Owned {
  std::latch returns{1};
};

TEST(AbandonableThread, ThatEndsIsWaitedForAndNothingOfItIsLeft) {
  for (int i = 0; i < 100; ++i) {  // one that were not joined would be gone most of the time
    auto owned = std::make_shared<Owned>();
    const std::weak_ptr<Owned> seen = owned;
    AbandonableThread thread([owned = std::move(owned)] {});
    EXPECT_FALSE(thread.end(1h, [] { return true; }));
    EXPECT_TRUE(seen.expired()) << i;
  }
}

TEST(AbandonableThread, ThatACallHoldsIsLeftBehindWithWhatItOwns) {
  auto owned = std::make_shared<Owned>();
  const std::weak_ptr<Owned> seen = owned;
  AbandonableThread thread([mine = owned] { mine->returns.wait(); });
  EXPECT_TRUE(thread.end(0ms, [] { return true; }));
  owned->returns.count_down();
  owned.reset();
  while (!seen.expired()) std::this_thread::yield();  // it comes back, and lets go
}

TEST(AbandonableThread, ThatNoCallHoldsIsWaitedForHoweverLongItTakes) {
  auto owned = std::make_shared<Owned>();
  AbandonableThread thread([mine = owned] { mine->returns.wait(); });
  int asked = 0;
  const bool left = thread.end(0ms, [&] {
    if (++asked == 3) owned->returns.count_down();
    return false;
  });
  EXPECT_FALSE(left);
  EXPECT_GE(asked, 3);
  EXPECT_EQ(owned.use_count(), 1);
}

TEST(AbandonableThread, ThatIsLeftBehindAnswersWithWhatHoldsIt) {
  auto owned = std::make_shared<Owned>();
  AbandonableThread thread([mine = owned] { mine->returns.wait(); });
  EXPECT_EQ(thread.end(0ms, [] { return std::optional<std::size_t>(0); }), 0u);
  owned->returns.count_down();
}

TEST(AbandonableThread, ThatNeverBeganHasEnded) {
  EXPECT_FALSE(AbandonableThread().end(1h, [] { return true; }));
}

}  // namespace
}  // namespace trephine::rt
