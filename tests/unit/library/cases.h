// Small cases for the tests of this room.
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "library/case_library.h"
#include "support.h"

namespace trephine::test {

inline GridGeometry obliqueGrid(const Index3& size) {
  GridGeometry g;
  g.size = size;
  g.spacing_mm = {0.7, 1.1, 2.5};
  g.origin_mm = {-101.25, 33.5, 812.0625};
  g.direction = glm::mat3_cast(glm::angleAxis(0.7, glm::normalize(Vec3(1, -2, 0.5))));
  return g;
}

// Every voxel differs from its neighbours.
inline std::shared_ptr<const Volume> patternVolume(const Index3& size) {
  Volume volume{obliqueGrid(size), {}};
  volume.hu.resize(volume.geometry.voxelCount());
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    volume.hu[n] = std::int16_t(int(n * 7919 % 4096) - 1024);
  }
  return std::make_shared<const Volume>(std::move(volume));
}

inline std::shared_ptr<const LabelMap> twoStructures(const Volume& volume) {
  LabelMap map{volume.geometry, std::vector<std::uint8_t>(volume.hu.size()), {}};
  for (std::size_t n = 0; n < map.labels.size(); ++n) map.labels[n] = n % 4 == 0 ? 5 : n % 4 == 1;
  map.structures = {{5, "liver", Vec3(0.5, 0.25, 0.125), "liver"}, {1, "spleen", Vec3(0, 0, 1)}};
  return std::make_shared<const LabelMap>(std::move(map));
}

inline NewCase smallCase(const Index3& size = {20, 16, 12}) {
  NewCase of;
  of.volume = patternVolume(size);
  of.structures = twoStructures(*of.volume);
  of.region = BodyRegion::head;
  of.tissues = {{"format", "trephine.tissues"}, {"damping", 1.25}};
  return of;
}

inline std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::size_t entriesIn(const std::filesystem::path& folder) {
  std::error_code ec;
  std::size_t count = 0;
  for (std::filesystem::directory_iterator it(folder, ec), end; !ec && it != end; ++it) ++count;
  return count;
}

}  // namespace trephine::test
