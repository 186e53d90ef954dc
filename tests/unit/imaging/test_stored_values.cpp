#include <gtest/gtest.h>

#include "imaging/common/detail/stored_values.h"
#include "volume/volume.h"

namespace trephine {

namespace {

std::vector<std::int16_t> wordsOf(std::initializer_list<unsigned> words) {
  std::vector<std::int16_t> result;
  for (const unsigned word : words) result.push_back(std::int16_t(std::uint16_t(word)));
  return result;
}

struct Converted {
  std::vector<std::int16_t> hu;
  HuCounts counts;
};

Converted convert(std::initializer_list<unsigned> words, const StoredFormat& format) {
  Converted result{wordsOf(words), {}};
  HuConverter converter;
  result.counts = converter.convert(result.hu.data(), result.hu.size(), format);
  return result;
}

// Slope 1 + 2^-40 takes the table's path with the same HU but for rounding.
StoredFormat throughTable(StoredFormat format) {
  format.slope = 1.0 + 1e-12;
  return format;
}

}  // namespace

TEST(StoredValues, BitsAboveTheStoredOnesAreIgnored) {
  const StoredFormat format{.bits_stored = 12, .high_bit = 11, .intercept = -1024};
  for (const StoredFormat& f : {format, throughTable(format)}) {
    EXPECT_EQ(convert({0xF000, 0x0FFF, 0xA123}, f).hu,
              (std::vector<std::int16_t>{-1024, 3071, 0x123 - 1024}));
  }
}

TEST(StoredValues, TheSignIsExtendedFromTheHighBit) {
  const StoredFormat format{.bits_stored = 12, .high_bit = 11, .is_signed = true};
  for (const StoredFormat& f : {format, throughTable(format)}) {
    EXPECT_EQ(convert({0x0800, 0x0FFF, 0x07FF, 0x5001}, f).hu,
              (std::vector<std::int16_t>{-2048, -1, 2047, 1}));
  }
}

TEST(StoredValues, BitsBelowTheStoredOnesAreShiftedOut) {
  const StoredFormat format{.bits_stored = 12, .high_bit = 15};
  for (const StoredFormat& f : {format, throughTable(format)}) {
    EXPECT_EQ(convert({0x123F, 0xFFFF}, f).hu, (std::vector<std::int16_t>{0x123, 0xFFF}));
  }
}

TEST(StoredValues, HuOutsideInt16AreClampedAndCountedNeverWrapped) {
  const StoredFormat format{.intercept = -1024};
  for (const StoredFormat& f : {format, throughTable(format)}) {
    const Converted high = convert({0, 33791, 33792, 65535}, f);
    EXPECT_EQ(high.hu, (std::vector<std::int16_t>{-1024, 32767, 32767, 32767}));
    EXPECT_EQ(high.counts.clamped, 2u);
  }
  const Converted low = convert({0x8000}, {.is_signed = true, .intercept = -1});
  EXPECT_EQ(low.hu.front(), -32768);
  EXPECT_EQ(low.counts.clamped, 1u);
}

TEST(StoredValues, AFractionalSlopeIsExactWhereItCanBe) {
  const Converted even = convert({0, 2, 4}, {.slope = 0.5, .intercept = -10.0});
  EXPECT_EQ(even.hu, (std::vector<std::int16_t>{-10, -9, -8}));
  EXPECT_EQ(even.counts.rounded, 0u);
  const Converted odd = convert({0, 1, 3}, {.slope = 0.5, .intercept = -10.0});
  EXPECT_EQ(odd.hu, (std::vector<std::int16_t>{-10, -10, -8}));  // halves to even
  EXPECT_EQ(odd.counts.rounded, 2u);
}

TEST(StoredValues, PaddingBecomesAirAndIsCounted) {
  StoredFormat format{.is_signed = true, .intercept = -1024};
  format.padding = StoredFormat::Padding{std::uint16_t(-2000), std::uint16_t(-2000)};
  const Converted one = convert({std::uint16_t(-2000), 24, std::uint16_t(-1999)}, format);
  EXPECT_EQ(one.hu, (std::vector<std::int16_t>{kAirHu, -1000, -3023}));
  EXPECT_EQ(one.counts.padding, 1u);
}

TEST(StoredValues, APaddingRangeHoldsBothEndsInEitherOrder) {
  StoredFormat format{.bits_stored = 12, .high_bit = 11};
  for (const auto& [value, limit] : {std::pair(10, 12), std::pair(12, 10)}) {
    format.padding = StoredFormat::Padding{std::uint16_t(value), std::uint16_t(limit)};
    EXPECT_EQ(convert({9, 10, 11, 12, 13}, format).hu,
              (std::vector<std::int16_t>{9, kAirHu, kAirHu, kAirHu, 13}));
  }
}

TEST(StoredValues, APaddingValueThatTheStoredBitsCannotHoldIsComparedWithTheWholeWord) {
  StoredFormat format{.bits_stored = 12, .high_bit = 11};
  format.padding = StoredFormat::Padding{0xF830, 0xF830};
  // 0x0830 has the same stored bits, and is tissue.
  EXPECT_EQ(convert({0xF830, 0x0830}, format).hu, (std::vector<std::int16_t>{kAirHu, 0x830}));
}

TEST(StoredValues, TheRangeOfHuIsReported) {
  const Converted shifted = convert({5, 900, 20}, {.intercept = -100});
  EXPECT_EQ(shifted.counts.hu_min, -95);
  EXPECT_EQ(shifted.counts.hu_max, 800);
  const Converted scaled = convert({5, 900, 20}, {.slope = 2, .intercept = -100});
  EXPECT_EQ(scaled.counts.hu_min, -90);
  EXPECT_EQ(scaled.counts.hu_max, 1700);
}

TEST(StoredValues, ATableIsNotKeptForAnotherFormat) {
  HuConverter converter;
  for (const double slope : {2.0, 3.0, 2.0}) {
    std::vector<std::int16_t> words = wordsOf({10});
    converter.convert(words.data(), 1, {.slope = slope});
    EXPECT_EQ(words.front(), 10 * slope);
  }
}

}  // namespace trephine
