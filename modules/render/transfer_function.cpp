#include "render/transfer_function.h"

#include <algorithm>
#include <limits>
#include <set>

namespace trephine {

namespace {

// A stretch of HU with one look: [low, high), in half-HU edges.
struct Segment {
  double low;
  double high;
  const Tissue* tissue;  // null: free space

  double opacity() const { return tissue ? std::min(tissue->opacity, kMaxOpacity) : 0.0; }
  bool visible() const { return opacity() > 0.0; }
};

// The tissues of voxels with a label, those that go before others first.
std::vector<const Tissue*> tissuesOf(const TissueSet& set, int label) {
  std::vector<const Tissue*> result;
  for (const Tissue& tissue : set.tissues) {
    if (tissue.label && *tissue.label == label) result.push_back(&tissue);
  }
  for (const Tissue& tissue : set.tissues) {
    if (tissue.isAnywhere()) result.push_back(&tissue);
  }
  return result;
}

std::vector<Segment> segments(const std::vector<const Tissue*>& tissues) {
  constexpr double removed_low = kRemovedHu - kRampHalfWidth_HU,
                   removed_high = kRemovedHu + kRampHalfWidth_HU;
  std::set<double> edges;
  bool holds_removed = false;
  for (const Tissue* tissue : tissues) {
    edges.insert(tissue->hu_min - 0.5);
    edges.insert(tissue->hu_max + 0.5);
    holds_removed |= tissue->hu_min <= kRemovedHu && tissue->hu_max >= kRemovedHu;
  }
  if (holds_removed) edges.insert({removed_low, removed_high});
  std::vector<Segment> result;
  if (edges.empty()) return result;
  const auto at = [&](double low, double high) {
    if (holds_removed && low >= removed_low && high <= removed_high) {
      return static_cast<const Tissue*>(nullptr);
    }
    for (const Tissue* tissue : tissues) {
      if (low > tissue->hu_min - 1.0 && high < tissue->hu_max + 1.0) return tissue;
    }
    return static_cast<const Tissue*>(nullptr);
  };
  constexpr double far = std::numeric_limits<double>::infinity();
  result.push_back({-far, *edges.begin(), nullptr});
  for (auto low = edges.begin(), high = std::next(low); high != edges.end(); low = high++) {
    const Tissue* tissue = at(*low, *high);
    if (result.back().tissue == tissue) {
      result.back().high = *high;
    } else {
      result.push_back({*low, *high, tissue});
    }
  }
  result.push_back({*edges.rbegin(), far, nullptr});
  return result;
}

// The colour that a segment shows at the ramp towards `neighbour`.
Vec3 colourTowards(const Segment& segment, const Segment& neighbour) {
  if (segment.visible() || !neighbour.visible()) {
    return segment.tissue ? segment.tissue->colour : Vec3(0.0);
  }
  return neighbour.tissue->colour;
}

}  // namespace

std::vector<TransferPoint> transferFunction(const TissueSet& set, int label) {
  const std::vector<Segment> parts = segments(tissuesOf(set, label));
  std::vector<TransferPoint> points;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const Segment& before = parts[i - 1];
    const Segment& after = parts[i];
    // A quarter leaves half of the narrower range at its own value.
    const double narrower = std::min(before.high - before.low, after.high - after.low);
    const double half = std::min(kRampHalfWidth_HU, narrower / 4.0);
    // One that begins right above removed voxels shows none of them. The ramp moves instead of
    // getting steeper: a table of limited size cannot tell a steep one.
    double low = after.low - half;
    if (after.low > kRemovedHu) low = std::max<double>(low, kRemovedHu);
    points.push_back({low, colourTowards(before, after), before.opacity()});
    points.push_back({low + 2.0 * half, colourTowards(after, before), after.opacity()});
  }
  return points;
}

double sideBySide_HU(double hu, std::size_t function, std::size_t count, double low_HU,
                     double high_HU) {
  const double within = (hu - low_HU) / (high_HU - low_HU);
  const double share = double(function) + kSideMargin + (1.0 - 2.0 * kSideMargin) * within;
  return low_HU + (high_HU - low_HU) * share / double(count);
}

std::vector<TransferPoint> sideBySide(const std::vector<std::vector<TransferPoint>>& functions,
                                      double low_HU, double high_HU) {
  std::vector<TransferPoint> all;
  for (std::size_t n = 0; n < functions.size(); ++n) {
    const auto add = [&](TransferPoint point) {
      point.hu = sideBySide_HU(point.hu, n, functions.size(), low_HU, high_HU);
      all.push_back(point);
    };
    const auto end = [&](double hu) {
      TransferPoint point = evaluate(functions[n], hu);
      point.hu = hu;
      add(point);
    };
    end(low_HU);
    for (const TransferPoint& point : functions[n]) {
      if (point.hu > low_HU && point.hu < high_HU) add(point);
    }
    end(high_HU);
  }
  return all;
}

TransferPoint evaluate(const std::vector<TransferPoint>& points, double hu) {
  if (points.empty()) return {hu, Vec3(0.0), 0.0};
  const auto next = std::upper_bound(points.begin(), points.end(), hu,
                                     [](double v, const TransferPoint& p) { return v < p.hu; });
  if (next == points.begin()) return {hu, next->colour, next->opacity};
  const TransferPoint& a = *std::prev(next);
  if (next == points.end()) return {hu, a.colour, a.opacity};
  const double t = (hu - a.hu) / (next->hu - a.hu);
  return {hu, glm::mix(a.colour, next->colour, t), glm::mix(a.opacity, next->opacity, t)};
}

std::vector<HuInterval> visibleIntervals(const std::vector<TransferPoint>& points) {
  constexpr double far = std::numeric_limits<double>::infinity();
  std::vector<HuInterval> intervals;
  const auto add = [&](double low, double high) {
    if (!intervals.empty() && intervals.back().high >= low) {
      intervals.back().high = high;
    } else {
      intervals.push_back({low, high});
    }
  };
  if (points.empty()) return intervals;
  if (points.front().opacity > 0.0) add(-far, points.front().hu);
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i - 1].opacity > 0.0 || points[i].opacity > 0.0) add(points[i - 1].hu, points[i].hu);
  }
  if (points.back().opacity > 0.0) add(points.back().hu, far);
  return intervals;
}

}  // namespace trephine
