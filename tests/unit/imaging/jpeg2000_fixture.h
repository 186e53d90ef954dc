// Grey pictures, JPEG 2000 made of them by OpenJPEG's own encoder, and what becomes of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "imaging/dicom/jpeg2000.h"

namespace trephine::test {

struct Picture {
  int columns = 61, rows = 47;  // odd, so that edges of tiles and wavelet levels are not whole
  int bits = 12;
  bool is_signed = false;
  std::vector<int> samples = {};
};

// Every sample differs from its neighbours; the range is that of the bits.
Picture ramp(int bits, bool is_signed, int columns = 61, int rows = 47);

struct Coding {
  int tile = 0;  // columns and rows of a tile; 0: one tile
  bool irreversible = false;
  float ratio = 0;  // of compression; 0: lossless
  int layers = 1;
  int precinct = 0;  // columns and rows of a precinct; 0: one a resolution
  bool jp2 = false;
  int channels = 1;
};

std::vector<std::uint8_t> encode(const Picture& picture, const Coding& coding = {});

// The header that would stand with the picture.
Jpeg2000Expectation expectation(const Picture& picture);

// The values of the words in the sense of `expected`; none, and the reason, after an error.
struct Decoded {
  std::vector<int> values;
  std::string error;
};

Decoded decode(const std::vector<std::uint8_t>& bytes, const Jpeg2000Expectation& expected);

}  // namespace trephine::test
