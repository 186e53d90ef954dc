// A picture as a JPEG 2000 codestream, for series to measure and test on.
#pragma once

#include <cstdint>
#include <vector>

namespace trephine::bench {

// Lossless (the reversible 5-3 wavelet), one component of unsigned words of `bits`, row by row.
// Empty where the encoder fails. Any thread.
std::vector<std::uint8_t> encodeJ2k(const std::vector<std::uint16_t>& words, int columns, int rows,
                                    int bits);

}  // namespace trephine::bench
