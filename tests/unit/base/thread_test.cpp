#include "base/rt/thread.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "support.h"

namespace trephine::rt {
namespace {

// Of /proc/self/status, kB.
long heldKb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "VmLck:") continue;
    long kb = 0;
    status >> kb;
    return kb;
  }
  return -1;
}

TEST(LockedMemory, SaysTheLimitThatKeptItFromHolding) {
  if (test::kSanitized) GTEST_SKIP() << "A sanitizer holds no memory";
  const auto tryIt = [] {
    const rlimit limit{65536, 65536};
    setrlimit(RLIMIT_MEMLOCK, &limit);
    if (getuid() == 0 && setuid(65534) != 0) std::_Exit(2);  // root has no limit
    const LockedMemory memory;
    const bool said = memory.reason().find("64 KiB") != std::string::npos;
    std::_Exit(!memory.whole() && said && heldKb() == 0 ? 0 : 1);
  };
  EXPECT_EXIT(tryIt(), testing::ExitedWithCode(0), "");
}

TEST(LockedMemory, HoldsAllUntilItIsReleased) {
  if (test::kSanitized) GTEST_SKIP() << "A sanitizer holds no memory";
  const std::vector<char> much(std::size_t(64) << 20, 1);
  ASSERT_EQ(heldKb(), 0);
  LockedMemory memory;
  if (!memory.whole()) GTEST_SKIP() << "This account may hold no memory: " << memory.reason();
  EXPECT_GT(heldKb(), 64 * 1024);
  memory.release();
  EXPECT_EQ(heldKb(), 0);
  EXPECT_EQ(much.back(), 1);
}

}  // namespace
}  // namespace trephine::rt
