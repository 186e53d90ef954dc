#include "volume/segmentation.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include "base/tr.h"

namespace trephine {

namespace {

// By layer and value: the segment there, or none.
std::vector<std::array<std::int16_t, 256>> segmentsByValue(const Segmentation& of) {
  std::vector<std::array<std::int16_t, 256>> rows(of.layers.size());
  for (auto& row : rows) row.fill(-1);
  for (std::size_t s = 0; s < of.segments.size(); ++s) {
    rows[of.segments[s].layer][of.segments[s].value] = std::int16_t(s);
  }
  return rows;
}

}  // namespace

std::vector<Overlap> overlaps(const Segmentation& of) {
  std::vector<Overlap> found;
  if (of.layers.size() < 2) return found;
  const auto rows = segmentsByValue(of);
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> counts;
  for (std::size_t voxel = 0; voxel < of.layers[0].size(); ++voxel) {
    for (std::size_t l = 0; l < of.layers.size(); ++l) {
      const int a = rows[l][of.layers[l][voxel]];
      if (a < 0) continue;
      for (std::size_t m = l + 1; m < of.layers.size(); ++m) {
        const int b = rows[m][of.layers[m][voxel]];
        if (b >= 0) ++counts[std::minmax(std::size_t(a), std::size_t(b))];
      }
    }
  }
  for (const auto& [pair, voxels] : counts) found.push_back({pair.first, pair.second, voxels});
  return found;
}

std::vector<std::size_t> smallerFirst(const Segmentation& of) {
  std::vector<std::array<std::size_t, 256>> counts(of.layers.size());
  for (std::size_t l = 0; l < of.layers.size(); ++l) {
    counts[l].fill(0);
    for (const std::uint8_t value : of.layers[l]) ++counts[l][value];
  }
  std::vector<std::size_t> order(of.segments.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto size = [&](std::size_t s) {
      return counts[of.segments[s].layer][of.segments[s].value];
    };
    return size(a) < size(b);
  });
  return order;
}

LabelMap merged(const Segmentation& of, const std::vector<std::size_t>& order) {
  LabelMap map{of.geometry, std::vector<std::uint8_t>(of.geometry.voxelCount()), {}};
  // Labels: the segment's own value where it is free.
  std::array<bool, 256> taken{};
  for (std::size_t s = 0; s < of.segments.size(); ++s) {
    const Segmentation::Segment& segment = of.segments[s];
    int label = segment.value;
    if (taken[std::size_t(label)]) {
      for (label = 1; label < 255 && taken[std::size_t(label)];) ++label;
    }
    taken[std::size_t(label)] = true;
    std::string name = structureName(segment.name);
    if (name.empty()) name = "label " + std::to_string(label);
    const std::string once = name;
    for (int n = 2; map.find(name); ++n) name = once + " " + std::to_string(n);
    map.structures.push_back({label, name, segment.colour, segment.tissue});
  }
  const auto rows = segmentsByValue(of);
  std::vector<std::size_t> rank(of.segments.size(), 0);
  for (std::size_t place = 0; place < order.size(); ++place) rank[order[place]] = place;
  for (std::size_t voxel = 0; voxel < map.labels.size(); ++voxel) {
    int best = -1;
    for (std::size_t l = 0; l < of.layers.size(); ++l) {
      const int s = rows[l][of.layers[l][voxel]];
      if (s >= 0 && (best < 0 || rank[std::size_t(s)] < rank[std::size_t(best)])) best = s;
    }
    if (best >= 0) map.labels[voxel] = std::uint8_t(map.structures[std::size_t(best)].label);
  }
  return map;
}

}  // namespace trephine
