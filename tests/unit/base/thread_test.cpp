#include "base/rt/thread.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>

namespace trephine::rt {
namespace {

TEST(LockedMemory, SaysTheLimitThatKeptItFromHolding) {
  const auto tryIt = [] {
    const rlimit limit{65536, 65536};
    setrlimit(RLIMIT_MEMLOCK, &limit);
    if (getuid() == 0 && setuid(65534) != 0) std::_Exit(2);  // root has no limit
    const LockedMemory memory;
    const bool said = memory.reason().find("64 KiB") != std::string::npos;
    std::_Exit(!memory.whole() && said ? 0 : 1);
  };
  EXPECT_EXIT(tryIt(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace trephine::rt
