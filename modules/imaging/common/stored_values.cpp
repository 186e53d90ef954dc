#include "imaging/common/detail/stored_values.h"

#include <algorithm>
#include <cmath>

#include "imaging/common/detail/hu_sanity_check.h"

namespace trephine {

namespace {

constexpr double kMinHu = -32768.0, kMaxHu = 32767.0;
enum Event : std::uint8_t { kRounded = 1, kClamped = 2, kPadding = 4 };

bool isPadding(std::uint16_t word, const StoredFormat& format) {
  if (!format.padding) return false;
  const auto whole = [&](std::uint16_t w) {
    return format.is_signed ? int(std::int16_t(w)) : int(w);
  };
  const auto [low, high] =
      std::minmax({whole(format.padding->value), whole(format.padding->limit)});
  const int stored_min = format.is_signed ? -(1 << (format.bits_stored - 1)) : 0;
  const int stored_max = (1 << (format.bits_stored - (format.is_signed ? 1 : 0))) - 1;
  const bool fits = low >= stored_min && high <= stored_max;
  const int value = fits ? storedValue(word, format) : whole(word);
  return value >= low && value <= high;
}

// Slope 1, a whole intercept and no padding: the common case, in loops that vectorise.
template <bool kSigned>
HuCounts shiftValues(std::int16_t* words, std::size_t count, const StoredFormat& format) {
  using Word = std::conditional_t<kSigned, std::int16_t, std::uint16_t>;
  // Up to the top of the word and back down: masks, and extends the sign of a signed type.
  const int up = 15 - format.high_bit, down = 16 - format.bits_stored;
  Word low = std::numeric_limits<Word>::max(), high = std::numeric_limits<Word>::min();
  for (std::size_t i = 0; i < count; ++i) {
    const auto top = static_cast<Word>(static_cast<std::uint16_t>(words[i]) << up);
    const auto value = static_cast<Word>(top >> down);
    words[i] = static_cast<std::int16_t>(value);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  HuCounts counts;
  if (count == 0) return counts;
  const auto intercept = static_cast<int>(format.intercept);
  if (low + intercept >= kMinHu && high + intercept <= kMaxHu) {
    const auto add = static_cast<std::uint16_t>(intercept);
    for (std::size_t i = 0; i < count; ++i) {
      words[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(words[i]) + add);
    }
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      const int value = static_cast<Word>(words[i]) + intercept;
      const int clamped = std::clamp(value, int(kMinHu), int(kMaxHu));
      counts.clamped += clamped != value;
      words[i] = static_cast<std::int16_t>(clamped);
    }
  }
  counts.hu_min = std::clamp(low + intercept, int(kMinHu), int(kMaxHu));
  counts.hu_max = std::clamp(high + intercept, int(kMinHu), int(kMaxHu));
  return counts;
}

}  // namespace

void HuCounts::add(const HuCounts& other) {
  padding += other.padding;
  rounded += other.rounded;
  clamped += other.clamped;
  hu_min = std::min(hu_min, other.hu_min);
  hu_max = std::max(hu_max, other.hu_max);
}

int storedValue(std::uint16_t word, const StoredFormat& format) {
  const int down = 16 - format.bits_stored;
  const auto top = static_cast<std::uint16_t>(word << (15 - format.high_bit));
  return format.is_signed ? static_cast<std::int16_t>(top) >> down : top >> down;
}

bool hasHighBits(std::span<const std::int16_t> words, const StoredFormat& format) {
  const auto above = std::uint16_t(0xFFFFU << (format.high_bit + 1));
  return std::ranges::any_of(words, [&](std::int16_t signed_word) {
    const auto word = std::uint16_t(signed_word);
    const auto sign = std::uint16_t(format.is_signed ? storedValue(word, format) : 0);
    return ((word ^ sign) & word & above) != 0 && !isPadding(word, format);
  });
}

void HuConverter::buildTable(const StoredFormat& format, std::int16_t padding_hu) {
  if (table_format_ == format && table_padding_hu_ == padding_hu) return;
  hu_.resize(65536);
  events_.assign(65536, 0);
  for (unsigned word = 0; word < 65536; ++word) {
    if (isPadding(std::uint16_t(word), format)) {
      hu_[word] = padding_hu;
      events_[word] = kPadding;
      continue;
    }
    const double exact = format.slope * storedValue(std::uint16_t(word), format) + format.intercept;
    const double whole = std::nearbyint(exact);
    const double clamped = std::clamp(whole, kMinHu, kMaxHu);
    if (clamped != whole) {
      events_[word] = kClamped;
    } else if (whole != exact) {
      events_[word] = kRounded;
    }
    hu_[word] = static_cast<std::int16_t>(clamped);
  }
  table_format_ = format;
  table_padding_hu_ = padding_hu;
}

HuCounts HuConverter::convert(std::int16_t* words, std::size_t count, const StoredFormat& format,
                              std::int16_t padding_hu, std::vector<std::int16_t>* sample) {
  if (sample) sample->clear();
  const bool whole_shift = format.slope == 1.0 && std::abs(format.intercept) < 1e6 &&
                           format.intercept == std::floor(format.intercept);
  if (whole_shift && !format.padding) {
    const HuCounts counts = format.is_signed ? shiftValues<true>(words, count, format)
                                             : shiftValues<false>(words, count, format);
    if (sample) visitSample(count, [&](std::size_t i) { sample->push_back(words[i]); });
    return counts;
  }
  buildTable(format, padding_hu);
  if (sample) {
    visitSample(count, [&](std::size_t i) {
      const auto word = static_cast<std::uint16_t>(words[i]);
      if (events_[word] != kPadding) sample->push_back(hu_[word]);
    });
  }
  HuCounts counts;
  int low = 32767, high = -32768;
  for (std::size_t i = 0; i < count; ++i) {
    const auto word = static_cast<std::uint16_t>(words[i]);
    const std::int16_t hu = hu_[word];
    const std::uint8_t event = events_[word];
    words[i] = hu;
    counts.rounded += event & kRounded;
    counts.clamped += (event & kClamped) >> 1;
    counts.padding += event >> 2;
    low = std::min<int>(low, hu);
    high = std::max<int>(high, hu);
  }
  counts.hu_min = low;
  counts.hu_max = high;
  return counts;
}

UnnamedPadding unnamedPaddingToAir(Volume& volume) {
  constexpr std::uint64_t kFewest = 32;
  constexpr double kMostOthers = 0.1;
  constexpr int kLeastCorners = 2;  // of eight
  Voxels& hu = volume.hu;
  const auto [low, high] = std::ranges::minmax(hu);
  if (low >= kLowestAir_HU) return {};
  std::vector<std::uint64_t> counts(std::size_t(kLowestAir_HU - low));
  std::uint64_t below = 0;
  for (const std::int16_t voxel : hu) {
    if (voxel >= kLowestAir_HU) continue;
    ++counts[std::size_t(voxel - low)];
    ++below;
  }
  const auto most = std::ranges::max_element(counts);
  const UnnamedPadding padding{low + int(most - counts.begin()), *most};
  int corners = 0;
  const Index3& size = volume.geometry.size;
  for (int corner = 0; corner < 8; ++corner) {
    const auto end = [&](int axis) {
      return corner & (1 << axis) ? size[std::size_t(axis)] - 1 : 0;
    };
    corners += volume.at(end(0), end(1), end(2)) == padding.hu;
  }
  const bool is_padding = padding.voxels >= kFewest && corners >= kLeastCorners &&
                          double(below - padding.voxels) <= kMostOthers * double(padding.voxels);
  if (!is_padding) return {};
  std::ranges::replace(hu, std::int16_t(padding.hu), kAirHu);
  return padding;
}

}  // namespace trephine
