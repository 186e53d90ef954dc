#include "base/pin.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

// From another implementation, Python's: hashlib.pbkdf2_hmac("sha256", b"Leber2026",
// bytes(range(16)), 10000).
Pin known() {
  return {10'000, "000102030405060708090a0b0c0d0e0f",
          "b9ecef58906c9fa5ed4efd0e42a16d5fd68150d0c229af32613885712c2d1133"};
}

Result<Pin> read(const Json& json) {
  const Json file{{"pin", json}};
  JsonReader reader(file, "settings.json");
  const Pin pin = readPin(reader.object("pin"));
  if (Status status = reader.finish(); !status) return status.error();
  return pin;
}

TEST(Pin, IsMatchedByItsTextAlone) {
  EXPECT_TRUE(pinMatches(known(), "Leber2026"));
  for (const char* wrong : {"leber2026", "Leber2025", "Leber202", "Leber20266", "Leber2026 ", ""}) {
    EXPECT_FALSE(pinMatches(known(), wrong)) << "'" << wrong << "'";
  }
}

TEST(Pin, ThatIsMadeIsMatchedAfterItWentThroughAFile) {
  const Result<Pin> made = makePin("1234");
  ASSERT_TRUE(made) << made.error().sentence();
  const Result<Pin> copy = read(toJson(*made));
  ASSERT_TRUE(copy) << copy.error().sentence();
  EXPECT_TRUE(pinMatches(*copy, "1234"));
  EXPECT_FALSE(pinMatches(*copy, "1235"));
  EXPECT_EQ(toJson(*made).dump().find("1234\""), std::string::npos) << "the PIN itself is not kept";
}

TEST(Pin, HasASaltOfItsOwn) {
  EXPECT_NE(makePin("1234")->hash_hex, makePin("1234")->hash_hex);
}

TEST(Pin, HasFourToTwelveDigitsOrLetters) {
  for (const char* wrong : {"", "123", "1234567890123", "12 34", "12-34",
                            "\xC3\xA4"
                            "bcd"}) {
    const Result<Pin> made = makePin(wrong);
    ASSERT_FALSE(made) << wrong;
    EXPECT_EQ(made.error().code.str(), "BAD_PIN");
    EXPECT_EQ(made.error().sentence().find("12 34"), std::string::npos) << "it is not repeated";
  }
  EXPECT_TRUE(makePin("aZ09"));
  EXPECT_TRUE(makePin("123456789012"));
}

TEST(Pin, OfAFileThatCannotBeIsRefusedByField) {
  const std::pair<const char*, Json> wrong[] = {{"algorithm", "md5"},
                                                {"iterations", 1},
                                                {"iterations", 1e12},
                                                {"salt_hex", "00"},
                                                {"salt_hex", 5},
                                                {"hash_hex", "beef"},
                                                {"hash_hex", std::string(64, 'g')}};
  for (const auto& [key, value] : wrong) {
    Json json = toJson(known());
    json[key] = value;
    const Result<Pin> pin = read(json);
    ASSERT_FALSE(pin) << key << " " << value;
    EXPECT_NE(pin.error().where.find(std::string("pin.") + key), std::string::npos)
        << pin.error().sentence();
  }
  Json json = toJson(known());
  json["plain"] = "1234";
  EXPECT_FALSE(read(json)) << "unknown keys are refused";
}

// A value that no file gave is no way in either.
TEST(Pin, ThatIsEmptyIsMatchedByNothing) {
  EXPECT_FALSE(pinMatches(Pin{}, "1234"));
  Pin weak = known();
  weak.iterations = 0;
  EXPECT_FALSE(pinMatches(weak, "Leber2026"));
}

}  // namespace
}  // namespace trephine
