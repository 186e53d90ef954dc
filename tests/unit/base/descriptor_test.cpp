// A file descriptor has one owner, and is closed once.
#include "base/descriptor.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <utility>

namespace trephine {
namespace {

bool isOpen(int fd) {
  return ::fcntl(fd, F_GETFD) >= 0;
}

Descriptor nothing() {
  return Descriptor(::open("/dev/null", O_RDONLY | O_CLOEXEC));
}

TEST(Descriptor, IsClosedWhenItsOwnerGoes) {
  int fd = -1;
  {
    const Descriptor one = nothing();
    ASSERT_TRUE(one.ok());
    fd = one.get();
    EXPECT_TRUE(isOpen(fd));
  }
  EXPECT_FALSE(isOpen(fd));
}

TEST(Descriptor, GoesToANewOwnerOpen) {
  Descriptor from = nothing();
  const int fd = from.get();
  {
    const Descriptor to = std::move(from);
    EXPECT_FALSE(from.ok());
    EXPECT_EQ(to.get(), fd);
    from.close();
    EXPECT_TRUE(isOpen(fd));
  }
  EXPECT_FALSE(isOpen(fd));
}

TEST(Descriptor, ClosesWhatItHadWhenItTakesAnother) {
  Descriptor one = nothing();
  const int before = one.get();
  Descriptor another = nothing();
  const int after = another.get();
  {
    Descriptor taken = std::move(another);
    one = std::move(taken);
  }
  EXPECT_FALSE(isOpen(before));
  EXPECT_EQ(one.get(), after);
  EXPECT_TRUE(isOpen(after));
}

TEST(Descriptor, OfWhatCouldNotBeOpenedIsNone) {
  const Descriptor none(::open("/nowhere/at/all", O_RDONLY | O_CLOEXEC));
  EXPECT_FALSE(none.ok());
  EXPECT_FALSE(Descriptor().ok());
}

}  // namespace
}  // namespace trephine
