#include "volume/voxel_slabs.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/sha256.h"
#include "volume/file_format.h"

namespace trephine {

bool VoxelSlabs::forEach(const std::function<bool(std::span<const std::int16_t>)>& take,
                         std::size_t most) const {
  const std::size_t count = geometry.voxelCount();
  std::vector<std::int16_t> slab(std::min(count, most));
  for (std::size_t first = 0; first < count; first += slab.size()) {
    const std::span<std::int16_t> part(slab.data(), std::min(slab.size(), count - first));
    read(first, part);
    if (!take(part)) return false;
  }
  return true;
}

VoxelSlabs slabsOf(const Volume& volume) {
  return {volume.geometry, [&volume](std::size_t first, std::span<std::int16_t> into) {
            std::copy_n(volume.hu.begin() + std::ptrdiff_t(first), into.size(), into.begin());
          }};
}

VoxelSlabs slabsOf(const Grid& grid) {
  return {grid.geometry(), [&grid](std::size_t first, std::span<std::int16_t> into) {
            for (std::size_t i = 0; i < into.size(); ++i) into[i] = grid.hu(first + i);
          }};
}

VoxelSlabs reversedSlices(VoxelSlabs slabs) {
  VoxelSlabs out;
  out.geometry = slabs.geometry;
  file_format::turnSliceAxis(out.geometry);
  out.read = [slabs = std::move(slabs)](std::size_t first, std::span<std::int16_t> into) {
    const GridGeometry& from = slabs.geometry;
    const std::size_t slice = std::size_t(from.size[0]) * std::size_t(from.size[1]);
    while (!into.empty()) {
      const std::size_t k = first / slice, at = first % slice;
      const std::size_t count = std::min(into.size(), slice - at);
      slabs.read((std::size_t(from.size[2]) - 1 - k) * slice + at, into.first(count));
      into = into.subspan(count);
      first += count;
    }
  };
  return out;
}

std::string slabsSha256(const VoxelSlabs& slabs) {
  Sha256 hash;
  slabs.forEach([&](std::span<const std::int16_t> slab) {
    hash.add(slab.data(), slab.size_bytes());
    return true;
  });
  return hash.hex();
}

}  // namespace trephine
