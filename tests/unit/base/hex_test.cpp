#include "base/hex.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

TEST(Hex, GoesThereAndBack) {
  const std::vector<std::uint8_t> bytes{0x00, 0x7f, 0xa5, 0xff};
  EXPECT_EQ(hexOf(bytes), "007fa5ff");
  EXPECT_EQ(bytesOfHex("007fa5ff"), bytes);
  EXPECT_EQ(bytesOfHex("007FA5fF"), bytes);
  EXPECT_EQ(bytesOfHex(""), std::vector<std::uint8_t>());
}

TEST(Hex, IsAnEvenNumberOfItsDigits) {
  for (const char* wrong : {"0", "0g", "0x00", " 00", "00-"})
    EXPECT_FALSE(bytesOfHex(wrong)) << wrong;
}

}  // namespace
}  // namespace trephine
