// Stored pixel words -> HU: mask, sign extension, padding, rescale, rounding and clamping.
//
// PS3.3 C.7.6.3 (bits stored, high bit, pixel representation), C.7.5.1.1.2 (padding value and
// range), C.11.1 (HU = slope * stored + intercept).
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "volume/volume.h"

namespace trephine {

// Not a value: marks voxels that were not scanned, until they become air. No CT holds it.
constexpr std::int16_t kLostHu = -32768;

// Of air with its noise; what is lower was not scanned.
constexpr int kLowestAir_HU = -1100;

struct StoredFormat {
  int bits_stored = 16;  // 1..16
  int high_bit = 15;     // bits_stored - 1 .. 15
  bool is_signed = false;
  double slope = 1.0;
  double intercept = 0.0;
  // Pixel Padding Value and Range Limit as the 16-bit words of the header, in either order. A value
  // that the stored bits can express is compared with stored values; one that they cannot (a -2000
  // beside 12 bits) with the whole word.
  struct Padding {
    std::uint16_t value = 0;
    std::uint16_t limit = 0;
    friend auto operator<=>(const Padding&, const Padding&) = default;
  };
  std::optional<Padding> padding = std::nullopt;

  friend auto operator<=>(const StoredFormat&, const StoredFormat&) = default;
};

struct HuCounts {
  std::uint64_t padding = 0;  // voxels set to kAirHu
  std::uint64_t rounded = 0;  // voxels whose HU were not whole
  std::uint64_t clamped = 0;  // voxels outside int16
  int hu_min = 32767;
  int hu_max = -32768;

  void add(const HuCounts& other);
};

// Turns words into HU in place. Keeps its table between slices of the same format; one object per
// thread.
class HuConverter {
 public:
  // `padding_hu` is what padding becomes: kLostHu where the words are yet to be interpolated.
  // `sample`, where given, is filled with the HU of some of the voxels that are not padding.
  HuCounts convert(std::int16_t* words, std::size_t count, const StoredFormat& format,
                   std::int16_t padding_hu = kAirHu, std::vector<std::int16_t>* sample = nullptr);

 private:
  void buildTable(const StoredFormat& format, std::int16_t padding_hu);

  std::optional<StoredFormat> table_format_;
  std::int16_t table_padding_hu_ = kAirHu;
  std::vector<std::int16_t> hu_;      // by whole word
  std::vector<std::uint8_t> events_;  // by whole word: rounded 1, clamped 2, padding 4
};

// The value of a whole word: masked, shifted, sign-extended.
int storedValue(std::uint16_t word, const StoredFormat& format);

// Whether any word has bits above the stored ones that are neither 0 nor the sign's, and is no
// padding: they are masked away.
bool hasHighBits(std::span<const std::int16_t> words, const StoredFormat& format);

// Voxels at a value that no CT has, at corners of the volume and with hardly anything else below
// air: what stands around the round field of a scanner, -3024 or -2000 as a rule.
struct UnnamedPadding {
  int hu = 0;
  std::uint64_t voxels = 0;  // 0: there is none
};

// Makes it air.
UnnamedPadding unnamedPaddingToAir(Volume& volume);

}  // namespace trephine
