#include "volume/hu_histogram.h"

#include <algorithm>
#include <array>
#include <mutex>

#include "base/codes.h"
#include "volume/two_threads.h"

namespace trephine {

namespace {

constexpr int kHus = 65536;
constexpr int kFirst = -32768;
using Counts = std::vector<std::uint32_t>;  // by HU - kFirst; empty: none
using ByLabel = std::array<Counts, 256>;

void count(const std::int16_t* hu, const std::uint8_t* labels, std::size_t voxels, ByLabel& into) {
  std::array<std::uint32_t*, 256> of{};
  for (std::size_t label = 0; label < 256; ++label) {
    if (!into[label].empty()) of[label] = into[label].data() - kFirst;
  }
  for (std::size_t v = 0; v < voxels; ++v) {
    const std::size_t label = labels ? labels[v] : 0;
    if (!of[label]) {
      into[label].assign(kHus, 0);
      of[label] = into[label].data() - kFirst;
    }
    ++of[label][hu[v]];
  }
}

void add(const ByLabel& part, ByLabel& all) {
  for (std::size_t label = 0; label < 256; ++label) {
    if (part[label].empty()) continue;
    if (all[label].empty()) {
      all[label] = part[label];
      continue;
    }
    for (std::size_t h = 0; h < std::size_t(kHus); ++h) all[label][h] += part[label][h];
  }
}

HuHistogram trimmed(const ByLabel& all) {
  HuHistogram histogram;
  int low = kHus, high = -1;
  for (const Counts& counts : all) {
    for (int h = 0; h < int(counts.size()); ++h) {
      if (counts[std::size_t(h)] == 0) continue;
      low = std::min(low, h);
      high = std::max(high, h);
    }
  }
  histogram.low_hu = low + kFirst;
  histogram.high_hu = high + kFirst;
  for (std::size_t label = 0; label < 256; ++label) {
    if (all[label].empty() && label > 0) continue;
    HuHistogram::Row row{std::uint8_t(label), {}};
    row.counts.assign(std::size_t(high - low + 1), 0);
    if (!all[label].empty()) {
      std::copy(all[label].begin() + low, all[label].begin() + high + 1, row.counts.begin());
    }
    histogram.rows.push_back(std::move(row));
  }
  return histogram;
}

}  // namespace

std::vector<std::uint64_t> HuHistogram::whole() const {
  std::vector<std::uint64_t> all(std::size_t(high_hu - low_hu + 1), 0);
  for (const Row& row : rows) {
    for (std::size_t h = 0; h < row.counts.size(); ++h) all[h] += row.counts[h];
  }
  return all;
}

Result<HuHistogram> histogramOf(const Volume& volume, const LabelMap* labels,
                                const Progress& progress) {
  const std::size_t voxels = volume.hu.size();
  if (voxels == 0) return HuHistogram{};
  const std::uint8_t* label = labels && labels->labels.size() == voxels ? labels->labels.data()
                                                                         : nullptr;
  constexpr int kParts = 16;
  ByLabel all;
  std::mutex adding;
  onTwoThreads(kParts, [&](int part) {
    if (progress.cancelled()) return;
    const std::size_t from = voxels * std::size_t(part) / kParts;
    const std::size_t to = voxels * std::size_t(part + 1) / kParts;
    ByLabel counted;
    count(volume.hu.data() + from, label ? label + from : nullptr, to - from, counted);
    const std::lock_guard lock(adding);
    add(counted, all);
  });
  if (progress.cancelled()) return Error{code::kCancelled, "Cancelled", "", ""};
  HuHistogram histogram = trimmed(all);
  histogram.voxels = voxels;
  histogram.voxel_mm3 = volume.geometry.voxelVolume_mm3();
  return histogram;
}

}  // namespace trephine
