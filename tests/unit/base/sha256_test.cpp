#include "base/sha256.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace trephine {
namespace {

std::string ofText(const std::string& text) {
  return sha256Hex(text.data(), text.size());
}

// The examples of FIPS 180-4.
TEST(Sha256, GivesTheStandardsExamples) {
  EXPECT_EQ(ofText(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(ofText("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(ofText("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(ofText(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnThePiecesThatItIsFed) {
  const std::string text(10000, 'q');
  Sha256 sha;
  for (std::size_t at = 0, step = 1; at < text.size(); at += step, step = step * 2 + 1) {
    step = std::min(step, text.size() - at);
    sha.add(text.data() + at, step);
  }
  EXPECT_EQ(sha.hex(), ofText(text));
}

TEST(Sha256, TellsOneChangedBit) {
  EXPECT_NE(ofText("trephine"), ofText("trephind"));
}

}  // namespace
}  // namespace trephine
