// JPEG 2000 codestreams as OpenJPEG itself writes them.
#pragma once

#include <cstdint>
#include <vector>

namespace trephine::test {

using Bytes = std::vector<std::uint8_t>;

struct Picture {
  int columns = 61, rows = 47;  // odd, so that edges of tiles and wavelet levels are not whole
  int bits = 12;
  bool is_signed = false;
  std::vector<int> samples = {};
};

struct Coding {
  int tile = 0;  // columns and rows of a tile; 0: one tile
  bool irreversible = false;
  float ratio = 0;  // of compression; 0: lossless
  int layers = 1;
  int precinct = 0;  // columns and rows of a precinct; 0: one a resolution
  bool jp2 = false;
  int channels = 1;
};

Bytes encode(const Picture& picture, const Coding& coding = {});

}  // namespace trephine::test
