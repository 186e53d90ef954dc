// Slices moved sideways and mixed, so that a sheared or uneven stack becomes a volume. Pure. Voxels
// of kLostHu were not scanned: they are never mixed with others.
#pragma once

#include <array>
#include <cstdint>

namespace trephine {

// Linear interpolation: target (i, j) = source (i - shift[0], j - shift[1]), kLostHu outside.
// A target beside lost voxels takes the others' mean by weight; one that is nearest to a lost voxel
// is lost. Shifts that are whole to 0.001 copy.
struct SliceSize {
  int columns = 0, rows = 0;
};
void shiftSlice(const std::int16_t* source, SliceSize source_size, std::array<double, 2> shift,
                std::int16_t* target, SliceSize target_size);

// target = lower * (1 - upper_share) + upper * upper_share; where one is lost, the nearer decides.
void mixSlices(const std::int16_t* lower, const std::int16_t* upper, double upper_share,
               std::size_t count, std::int16_t* target);

}  // namespace trephine
