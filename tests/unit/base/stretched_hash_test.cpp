#include "base/stretched_hash.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

TEST(StretchedHash, IsPbkdf2OfHmacSha256) {
  // RFC 7914, section 11, its first 16 bytes.
  EXPECT_EQ(stretchedHash("passwd", "salt", 1), "55ac046e56e3089fec1691c22544b605");
  EXPECT_EQ(stretchedHash("Password", "NaCl", 80000), "4ddcd8f60b98be21830cee5ef22701f9");
  EXPECT_EQ(stretchedHash("passwd", "salt", 1, 32),
            "55ac046e56e3089fec1691c22544b605f94185216dde0465e68b9d57c20dacbc");
}

TEST(StretchedHash, DiffersWithTheSalt) {
  EXPECT_NE(stretchedHash("doe", "a", 10), stretchedHash("doe", "b", 10));
  EXPECT_NE(stretchedHash("doe", "a", 10), stretchedHash("roe", "a", 10));
}

TEST(KeyedHash, IsHmacSha256) {
  // RFC 4231, test case 2, its first 16 bytes.
  EXPECT_EQ(keyedHash("what do ya want for nothing?", "Jefe"), "5bdcc146bf60754e6a042426089575c7");
  EXPECT_NE(keyedHash("a", "one"), keyedHash("a", "other"));
}

TEST(RandomHex, IsNeverTheSame) {
  const auto one = randomHex(16), other = randomHex(16);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->size(), 32u);
  EXPECT_NE(*one, *other);
}

}  // namespace
}  // namespace trephine
