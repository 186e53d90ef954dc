#include "imaging/common/detail/hu_sanity_check.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "base/tr.h"
#include "imaging/common/detail/stored_values.h"
#include "volume/volume.h"

namespace trephine {

namespace {

constexpr int kLowest = std::numeric_limits<std::int16_t>::min();
constexpr int kHighest = std::numeric_limits<std::int16_t>::max();
// Air with noise and undershoot lies between this and kLowestAir_HU.
constexpr int kHighestOfAir = -300;
constexpr int kNear = 20;          // HU to either side of a mode
constexpr int kNotAScale = -3339;  // below what 12 bits reach with any usual intercept (-3072)

// A value around which no third of a patient lies. `most_air` is the share that may lie where air
// does all the same: inverted bone lies there.
struct Mode {
  int hu;
  double most_air;
  const char* words;
};
constexpr const char* kStored =
    trLater("stored values without their intercept, or a background that was set to 0");
constexpr Mode kModes[] = {
    {0, 0.001, kStored},
    {1000, 0.1, trLater("values that are inverted or shifted by 1000")},
    {1024, 0.1, trLater("values that are inverted or shifted by 1024")},
    {kHighest, 0.1, trLater("values that did not fit their range")},
};
// Where air lies without the usual intercept of -1024. Brain lies there, too, but is not cut at 0.
constexpr int kStoredAir[] = {24, 32, 40};
constexpr double kClampedShare = 0.001;  // share of voxels at 0 where values were cut there

std::string percent(double share) {
  return std::to_string(int(100.0 * share)) + " %";
}

}  // namespace

void HuSanityCheck::add(std::span<const std::int16_t> hu) {
  for (const std::int16_t value : hu) ++counts_[std::size_t(value - kLowest)];
}

void HuSanityCheck::addSampleOf(std::span<const std::int16_t> hu, std::uint64_t not_numbers) {
  visitSample(hu.size(), [&](std::size_t n) { ++counts_[std::size_t(hu[n] - kLowest)]; });
  if (not_numbers == 0) return;
  const auto air = std::uint64_t(std::ranges::count(hu, kAirHu));
  std::uint32_t& count = counts_[std::size_t(kAirHu - kLowest)];
  count -= std::uint32_t(count * not_numbers / std::max(air, not_numbers));
}

std::uint64_t HuSanityCheck::count(int from, int to) const {
  std::uint64_t sum = 0;
  for (int hu = std::max(from, kLowest); hu <= std::min(to, kHighest); ++hu) {
    sum += counts_[std::size_t(hu - kLowest)];
  }
  return sum;
}

bool HuSanityCheck::hasAir() const {
  return count(kLowestAir_HU, kHighestOfAir - 1) > 0;
}

std::vector<std::string> HuSanityCheck::doubts(int lowest, int highest) const {
  if (!found_elsewhere_.empty()) return found_elsewhere_;
  if (lowest == highest && highest <= kAirHu) {
    return {tr("all of it is padding, or one and the same air")};
  }
  std::vector<std::string> doubts;
  if (lowest == kNotAScale || counts_[std::size_t(kNotAScale - kLowest)] > 0) {
    doubts.push_back(tr("values down to {} are below any scale", kNotAScale));
  }
  const auto scanned = double(count(kLowestAir_HU, kHighest));
  if (scanned == 0.0) return doubts;
  const auto share = [&](int from, int to) { return double(count(from, to)) / scanned; };
  const double air = share(kLowestAir_HU, kHighestOfAir - 1);
  // The corners beyond the field of view are padding that no file names: of one value, at an end.
  int first = kLowestAir_HU, last = kHighest;
  while (count(first, first) == 0) ++first;
  while (count(last, last) == 0) --last;
  const auto around = [&](int hu) {
    double most = share(hu - kNear, hu + kNear);
    for (const int end : {first, last}) {
      const double corners = share(end, end);
      const double inside = std::abs(end - hu) <= kNear ? corners : 0.0;
      if (corners < 1.0) {
        most = std::max(most, (share(hu - kNear, hu + kNear) - inside) / (1.0 - corners));
      }
    }
    return most;
  };
  // Tissue that lies beside a mode reaches into what is near it, but has its peak elsewhere.
  const auto peaksAt = [&](int hu) {
    constexpr int kWide = 5, kAside = 12;
    std::uint64_t inside = 0, outside = 0;
    for (int at = hu - 2 * kNear; at <= std::min(hu + 2 * kNear, kHighest); ++at) {
      std::uint64_t& most = std::abs(at - hu) <= kAside ? inside : outside;
      most = std::max(most, count(at - kWide, at + kWide));
    }
    return inside >= outside;
  };
  const auto said = [&](int hu, const char* words) {
    doubts.push_back(tr("{} of the voxels lie near {} HU and hardly any where air does, as of {}",
                        percent(around(hu)), hu, tr(words)));
  };
  for (const Mode& mode : kModes) {
    if (air > mode.most_air || 3.0 * around(mode.hu) <= 1.0) continue;
    if (!peaksAt(mode.hu)) continue;
    said(mode.hu, mode.words);
    return doubts;
  }
  if (first == 0 && share(0, 0) > kClampedShare && air <= kModes[0].most_air) {
    for (const int hu : kStoredAir) {
      if (3.0 * around(hu) <= 1.0) continue;
      said(hu, kStored);
      return doubts;
    }
  }
  constexpr double kEnough = 300.0;  // voxels, to tell by how they are spread
  if (scanned < kEnough) return doubts;
  // Most of a patient is soft tissue, and what lies below air is padding, of one value.
  constexpr double kLeastTissue = 0.01, kLittleTissue = 0.05, kBelow = 0.1;
  const double tissue = share(-200, 200);
  std::uint64_t padding = 0;
  for (int hu = kLowest; hu < kLowestAir_HU; ++hu) padding = std::max(padding, count(hu, hu));
  const double below = double(count(kLowest, kLowestAir_HU - 1) - padding) / scanned;
  // A dry skull is bone and air.
  if ((share(-200, kHighest) < kLeastTissue && share(kLowestAir_HU, -800) > 0.5) ||
      (tissue < kLittleTissue && below > kBelow)) {
    doubts.push_back(
        tr("hardly any of the voxels ({}) lie where tissue does, as of an intercept that was "
           "applied twice",
           percent(tissue)));
    return doubts;
  }
  constexpr int kWater = -20;  // with its noise
  if (highest < kWater && share(kLowestAir_HU, -800) > 0.3) {
    doubts.push_back(
        tr("none lies above {}, and tissue lies near 0: as of an intercept that was applied twice",
           highest));
    return doubts;
  }
  // Stored values without their intercept of -1024 have their tissue there, and no wide bone.
  const double stored_tissue = share(850, 1150);
  if (first >= 0 && share(0, 100) > 0.05 && stored_tissue > 0.15 &&
      stored_tissue > 0.6 * share(500, 2500)) {
    doubts.push_back(
        tr("none lies below 0, and {} of the voxels lie between 850 and 1150, as of {}",
           percent(stored_tissue), tr(kStored)));
    return doubts;
  }
  // Both ends heaped up, within what tissue reaches, and all between them filled.
  const auto heaped = [&](int end, int beside) {
    return share(end, end) > 0.002 && count(end, end) > 5 * count(beside, beside);
  };
  int filled = 0;
  for (int hu = first; hu <= last; ++hu) filled += count(hu, hu) > 0 ? 1 : 0;
  if (first > -900 && last < 1000 && 8 * filled > last - first && last - first >= 100 &&
      heaped(first, first + 1) && heaped(last, last - 1)) {
    doubts.push_back(
        tr("they end at {} and {}, where many lie: a window was burnt in, and air and bone are cut "
           "off",
           first, last));
  }
  return doubts;
}

}  // namespace trephine
