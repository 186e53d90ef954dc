#include "structures/grow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/codes.h"
#include "base/formatted.h"
#include "base/memory.h"
#include "base/tr.h"
#include "structures/block_border.h"
#include "structures/codes.h"
#include "structures/voxel_runs.h"
#include "structures/work_grid.h"
#include "volume/codes.h"
#include "volume/two_threads.h"

namespace trephine {

namespace {

constexpr double kClickCube_mm = 21.0;
constexpr int kMostEstimates = 6;       // of the range, after the first
constexpr double kSettled_HU = 0.5;     // between two of them
constexpr double kCoreSpreads = 3.0;    // of the range, to both sides
constexpr double kLeastHalf_HU = 15.0;  // of the range
constexpr double kCrumb_ml = 1.0;       // a smaller core may be a crumb of the organ
constexpr double kFat_HU = -70.0;       // and air: below
constexpr double kBone_HU = 226.0;      // and above
constexpr double kCoreMostHalf_HU = 45.0, kMostHalf_HU = 90.0;
constexpr double kReach_mm = 6.0;   // beyond the core's ball: two blocks
constexpr double kBridge_mm = 3.5;  // narrower ones are cut off
constexpr double kNotch_mm = 4.0;   // narrower ones are closed
constexpr double kFromSeed_mm = 20.0;

struct Spread {
  double middle = 0.0, deviation = 0.0;
};

Spread spreadOf(std::vector<float> values) {
  if (values.empty()) return {};
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const float median = *middle;
  for (float& value : values) value = std::abs(value - median);
  std::nth_element(values.begin(), middle, values.end());
  return {median, 1.4826 * double(*middle)};
}

Spread spreadOf(const Blocks& blocks, const BlockMask& in) {
  std::vector<float> values;
  for (std::size_t n = 0; n < in.size(); ++n) {
    if (in[n]) values.push_back(blocks[n]);
  }
  return spreadOf(std::move(values));
}

HuSpan around(const Spread& of, double most_half) {
  const double half = std::clamp(kCoreSpreads * of.deviation, kLeastHalf_HU, most_half);
  return {of.middle - half, of.middle + half};
}

// What most of the blocks about the click are like, within kLeastHalf_HU: beside an edge or in a
// vessel a median lies between the organ and its neighbours. What is below `least_HU` does not
// count.
double commonAbout(const Blocks& blocks, const WorkGrid& grid, const Index3& at, double least_HU) {
  std::vector<float> values;
  Index3 half;
  for (int axis = 0; axis < 3; ++axis) {
    half[std::size_t(axis)] =
        std::max(1, int(std::lround(0.5 * kClickCube_mm / grid.block_mm[axis])));
  }
  for (int k = at[2] - half[2]; k <= at[2] + half[2]; ++k) {
    for (int j = at[1] - half[1]; j <= at[1] + half[1]; ++j) {
      for (int i = at[0] - half[0]; i <= at[0] + half[0]; ++i) {
        if (!grid.holds(i, j, k)) continue;
        const float value = blocks[grid.indexOf(i, j, k)];
        if (value >= least_HU) values.push_back(value);
      }
    }
  }
  double common = 0.0, most = 0.0;
  for (const float middle : values) {
    double like = 0.0;
    for (const float value : values) {
      like += std::max(0.0, kLeastHalf_HU - std::abs(double(value) - double(middle)));
    }
    if (like > most) {
      most = like;
      common = middle;
    }
  }
  return common;
}

// The piece at the click, or the one that has most about it, what is near counting more: in a
// narrow range crumbs of an organ may be nearer than the organ. 0 where none is near.
std::int32_t pieceAt(const std::vector<std::int32_t>& piece, const WorkGrid& grid,
                     const Index3& at) {
  if (const std::int32_t here = piece[grid.indexOf(at[0], at[1], at[2])]) return here;
  std::vector<double> share(std::size_t(*std::max_element(piece.begin(), piece.end())) + 1);
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        const std::int32_t here = piece[grid.indexOf(i, j, k)];
        if (here == 0) continue;
        const double away_mm = glm::length(Vec3(i - at[0], j - at[1], k - at[2]) * grid.block_mm);
        const double near = std::max(0.0, 1.0 - away_mm / kFromSeed_mm);
        share[std::size_t(here)] += near * near;
      }
    }
  }
  // The first, of what is out, has none.
  return std::int32_t(std::max_element(share.begin(), share.end()) - share.begin());
}

BlockMask only(const std::vector<std::int32_t>& piece, std::int32_t which) {
  BlockMask in(piece.size());
  for (std::size_t n = 0; n < piece.size(); ++n) in[n] = piece[n] == which;
  return in;
}

// Blocks that hold a voxel with a label; empty without others.
BlockMask blocksOf(const LabelMap* others, const WorkGrid& grid) {
  if (!others) return {};
  const GridGeometry& g = others->geometry;
  BlockMask taken(grid.count());
  onTwoThreads(grid.size[2], [&](int layer) {
    const int end = std::min((layer + 1) * grid.factor[2], g.size[2]);
    for (int k = layer * grid.factor[2]; k < end; ++k) {
      for (int j = 0; j < g.size[1]; ++j) {
        const std::uint8_t* row = &others->labels[g.indexOf(0, j, k)];
        for (int i = 0; i < g.size[0]; ++i) {
          if (row[i]) taken[grid.indexOf(i / grid.factor[0], j / grid.factor[1], layer)] = 1;
        }
      }
    }
  });
  return taken;
}

void keepFree(BlockMask& in, const BlockMask& taken) {
  for (std::size_t n = 0; n < taken.size(); ++n) in[n] = in[n] && !taken[n];
}

// What others have goes, and with it what they cut off: beyond a wall the border's blocks reach on.
// std::bad_alloc.
void leaveToOthers(LabelMap& mask, const LabelMap& others) {
  const GridGeometry& g = mask.geometry;
  VoxelRuns runs(g.size, [&](int i, int j, int k) {
    const std::size_t at = g.indexOf(i, j, k);
    return mask.labels[at] && !others.labels[at];
  });
  std::ranges::fill(mask.labels, std::uint8_t(0));
  runs.join(Touching::faces);
  if (runs.pieces().empty()) return;
  const std::uint32_t largest = runs.largest();
  runs.forRuns([&](int begin, int end, int j, int k, std::uint32_t piece) {
    if (piece != largest) return;
    std::fill_n(&mask.labels[g.indexOf(begin, j, k)], end - begin, std::uint8_t(1));
  });
}

void keepInside(BlockMask& in, const WorkGrid& grid, const std::optional<VoxelBox>& box) {
  if (!box) return;
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        const Index3 low{i * grid.factor[0], j * grid.factor[1], k * grid.factor[2]};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (low[axis] + grid.factor[axis] <= box->low[axis] || low[axis] >= box->high[axis]) {
            in[grid.indexOf(i, j, k)] = 0;
          }
        }
      }
    }
  }
}

// The piece that shares most with `core`; 0 where none does.
std::int32_t pieceSharing(const BlockMask& core, const std::vector<std::int32_t>& piece) {
  std::vector<std::size_t> shared(std::size_t(*std::max_element(piece.begin(), piece.end())) + 1);
  for (std::size_t n = 0; n < core.size(); ++n) {
    if (core[n] && piece[n]) ++shared[std::size_t(piece[n])];
  }
  const auto most = std::max_element(shared.begin(), shared.end());
  return *most ? std::int32_t(most - shared.begin()) : 0;
}

bool reachesBorder(const LabelMap& mask) {
  const GridGeometry& g = mask.geometry;
  const auto any = [&](std::size_t axis, int at) {
    Index3 low{0, 0, 0}, high = g.size;
    low[axis] = at;
    high[axis] = at + 1;
    for (int k = low[2]; k < high[2]; ++k) {
      for (int j = low[1]; j < high[1]; ++j) {
        for (int i = low[0]; i < high[0]; ++i) {
          if (mask.labels[g.indexOf(i, j, k)]) return true;
        }
      }
    }
    return false;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // A scan of one slice has nothing but a border there.
    if (g.size[axis] > 1 && (any(axis, 0) || any(axis, g.size[axis] - 1))) return true;
  }
  return false;
}

// `seed_HU`: the seed's own; of no meaning, 0, where a range was given.
Error nothingGrown(const HuSpan& hu, double open_mm, double seed_HU) {
  if (seed_HU > kBone_HU) {
    return {code::kNothingGrown,
            tr("The place is bone ({} HU), and bone has no room for a ball {} mm wide there",
               formatted("%.0f", seed_HU), formatted("%.0f", 2.0 * open_mm)),
            "seed",
            tr("For the skull's bone take Skull; else give a range of HU and a smaller ball")};
  }
  return {
      code::kNothingGrown,
      tr("There is no organ at this place: within 20 mm nothing of {} to {} HU is as wide as {} mm",
         formatted("%.0f", hu.low), formatted("%.0f", hu.high), formatted("%.0f", 2.0 * open_mm)),
      "seed", tr("Choose a place well inside, a wider range of HU or a smaller ball")};
}

// From the seed to the nearest voxel of the mask; infinity beyond kMostOff_mm.
double offFrom(const LabelMap& mask, const Vec3& seed_mm, const Index3& voxel) {
  const GridGeometry& g = mask.geometry;
  if (mask.labels[g.indexOf(voxel[0], voxel[1], voxel[2])]) return 0.0;
  Index3 low, high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int reach = int(std::ceil(kMostOff_mm / g.spacing_mm[int(axis)]));
    low[axis] = std::max(0, voxel[axis] - reach);
    high[axis] = std::min(g.size[axis] - 1, voxel[axis] + reach);
  }
  double least = std::numeric_limits<double>::infinity();
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        if (!mask.labels[g.indexOf(i, j, k)]) continue;
        least = std::min(least, glm::length(g.toPatient_mm(Vec3(i, j, k)) - seed_mm));
      }
    }
  }
  return least <= kMostOff_mm ? least : std::numeric_limits<double>::infinity();
}

// Whether a place lies apart from what was found and not in the midst of it, as a vessel does: less
// than half of the ways from there lead to it.
bool isBeside(const BlockMask& found, const WorkGrid& grid, const Index3& at) {
  int ways = 0, leading = 0;
  for (int k = -1; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        if (i == 0 && j == 0 && k == 0) continue;
        ++ways;
        const double step_mm = glm::length(Vec3(i, j, k) * grid.block_mm);
        for (int n = 0; n * step_mm <= kMostOff_mm; ++n) {
          const Index3 to{at[0] + n * i, at[1] + n * j, at[2] + n * k};
          if (!grid.holds(to[0], to[1], to[2])) break;
          if (!found[grid.indexOf(to[0], to[1], to[2])]) continue;
          // Beside it by no more than a block is its rim.
          if (n <= 1) return false;
          ++leading;
          break;
        }
      }
    }
  }
  return 2 * leading < ways;
}

// Steps 1 to 3, in blocks; what they found of the range and what they did goes to `growth`.
Result<BlockMask> growBlocks(const Volume& volume, const WorkGrid& grid, const Index3& voxel,
                             const GrowOptions& options, const Progress& progress, Growth& growth) {
  const Error cancelled{code::kCancelled, tr("Growing was cancelled"), "", ""};
  const auto on = [&](double fraction, const char* step) {
    progress.at(fraction, step);
    return !progress.cancelled();
  };
  if (!on(0.0, "blocks")) return cancelled;
  const Blocks means = blockMeans(volume, grid);
  const double noise_HU = softTissueNoise_HU(means, grid);
  // Of 20 HU a core needs no more than 2.7 mm; its border keeps its place as far as noise allows.
  const double core_mm = std::clamp(noise_HU / 20.0, 0.9, 1.3) * kBlock_mm;
  const double border_mm = std::clamp(0.03 * noise_HU - 0.3, 0.3, 0.8) * kBlock_mm;
  const Blocks smooth = smoothed(means, grid, core_mm);
  const Blocks border = smoothed(means, grid, border_mm);
  growth.steps = {formatted("noise of %.0f HU in blocks of %.1f mm", noise_HU, grid.block_mm.x),
                  formatted("smoothed by %.1f mm, its border by %.1f mm", core_mm, border_mm)};

  const BlockMask taken = blocksOf(options.others.get(), grid);
  const Index3 at = grid.blockOf(voxel);
  BlockMask core, ranged;
  // What has room for the ball within a range.
  const auto coresWithin = [&](const HuSpan& span) {
    ranged = within(smooth, span.low, span.high);
    keepInside(ranged, grid, options.box);
    keepFree(ranged, taken);
    return pieces(eroded(ranged, grid, options.open_mm), grid);
  };
  // An organ is meant where the click itself is not in fat or air, however much of them lies about.
  const double seed_HU = smooth[grid.indexOf(at[0], at[1], at[2])];
  const double least_HU = seed_HU < kFat_HU ? -std::numeric_limits<double>::infinity() : kFat_HU;
  const double common = options.hu ? 0.0 : commonAbout(smooth, grid, at, least_HU);
  // The first range is the narrowest that finds more than crumbs: from one that is too narrow the
  // estimates widen, while one that holds the neighbours too may settle on all of them.
  HuSpan hu;
  for (double half = kLeastHalf_HU; half <= kCoreMostHalf_HU; half += kLeastHalf_HU) {
    if (!on(0.1, "core")) return cancelled;
    hu = options.hu ? *options.hu : HuSpan{std::max(common - half, least_HU), common + half};
    const std::vector<std::int32_t> piece = coresWithin(hu);
    const std::int32_t here = pieceAt(piece, grid, at);
    if (here != 0) core = only(piece, here);
    const double ml = double(std::ranges::count(core, 1)) * grid.block_mm.x * grid.block_mm.y *
                      grid.block_mm.z / 1000.0;
    const bool holds_click = here != 0 && core[grid.indexOf(at[0], at[1], at[2])];
    if (options.hu || holds_click || ml >= kCrumb_ml) break;
  }
  // A thin bone is no bone any more where it was smoothed.
  const double said_HU = options.hu ? 0.0 : double(volume.at(voxel[0], voxel[1], voxel[2]));
  if (core.empty()) return nothingGrown(hu, options.open_mm, said_HU);
  for (int estimate = 1; !options.hu && estimate <= kMostEstimates; ++estimate) {
    const HuSpan next = around(spreadOf(smooth, core), kCoreMostHalf_HU);
    const double moved = std::max(std::abs(next.low - hu.low), std::abs(next.high - hu.high));
    if (moved < kSettled_HU) break;
    hu = next;
    if (!on(0.1 + 0.08 * estimate, "core")) return cancelled;
    const std::vector<std::int32_t> piece = coresWithin(hu);
    // What goes on from the last one: at the click it may be a little too dark or too bright for
    // the whole.
    std::int32_t here = pieceSharing(core, piece);
    if (here == 0) here = pieceAt(piece, grid, at);
    if (here == 0) return nothingGrown(hu, options.open_mm, said_HU);
    core = only(piece, here);
  }
  growth.steps.push_back(formatted("core within %.0f to %.0f HU", hu.low, hu.high) +
                         formatted(", opened by %.1f mm", options.open_mm));

  if (!on(0.7, "border")) return cancelled;
  const std::vector<float> from_core = distance_mm(core, grid);
  BlockMask body(core.size());
  for (std::size_t n = 0; n < body.size(); ++n) {
    body[n] = ranged[n] && from_core[n] <= options.open_mm + 0.5;
  }
  if (options.hu) {
    growth.hu = *options.hu;
  } else {
    growth.hu = around(spreadOf(border, eroded(body, grid, kBlock_mm)), kMostHalf_HU);
  }
  BlockMask wider = within(border, growth.hu.low, growth.hu.high);
  keepInside(wider, grid, options.box);
  keepFree(wider, taken);
  for (std::size_t n = 0; n < wider.size(); ++n) {
    wider[n] = body[n] || (wider[n] && from_core[n] <= options.open_mm + kReach_mm);
  }
  wider = majority(wider, grid);
  const BlockMask wide = dilated(eroded(wider, grid, kBridge_mm), grid, kBridge_mm);
  for (std::size_t n = 0; n < wider.size(); ++n) wider[n] = wider[n] && wide[n];
  const std::vector<std::int32_t> piece = pieces(wider, grid);
  const std::int32_t with_core = pieceSharing(core, piece);
  if (with_core == 0) return nothingGrown(growth.hu, options.open_mm, said_HU);
  BlockMask found = only(piece, with_core);
  const BlockMask closed = eroded(dilated(found, grid, kNotch_mm), grid, kNotch_mm);
  for (std::size_t n = 0; n < found.size(); ++n) found[n] = found[n] || closed[n];
  fillHoles(found, grid);
  keepFree(found, taken);
  growth.steps.push_back(formatted("border within %.0f to %.0f HU", growth.hu.low, growth.hu.high));
  if (!options.hu && isBeside(found, grid, at)) {
    const double far_HU = 2.0 * kLeastHalf_HU;  // beyond noise, and what a blurred edge makes
    if (seed_HU < growth.hu.low - far_HU || seed_HU > growth.hu.high + far_HU) {
      return Error{
          code::kNothingGrown,
          tr("The seed is of {} HU, and what has room near it of {} to {} HU: another thing",
             formatted("%.0f", seed_HU), formatted("%.0f", growth.hu.low),
             formatted("%.0f", growth.hu.high)),
          "seed",
          seed_HU > kBone_HU
              ? tr("For the skull's bone take Skull; else give a range of HU and a smaller ball")
              : tr("Choose a place well inside, another range of HU or a smaller ball")};
    }
  }
  return found;
}

}  // namespace

Result<Growth> grow(const Volume& volume, const Vec3& seed_mm, const GrowOptions& options,
                    const Progress& progress) {
  const GridGeometry& g = volume.geometry;
  if (!(options.open_mm >= 0.0 && options.open_mm <= 50.0)) {
    return Error{code::kBadArgument, tr("The opening's radius is from 0 to 50 mm"), "open", ""};
  }
  if (options.hu && !(options.hu->low <= options.hu->high)) {
    return Error{code::kBadArgument, tr("The HU range ends below where it begins"), "hu", ""};
  }
  const Vec3 place = Vec3(g.patientToVoxel() * glm::dvec4(seed_mm, 1.0)) + 0.5;
  const VoxelBox whole{{0, 0, 0}, g.size};
  const VoxelBox& inside = options.box ? *options.box : whole;
  Index3 voxel;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = place[int(axis)];
    if (!(at >= inside.low[axis] && at < inside.high[axis])) {
      return Error{code::kBadSeed,
                   options.box ? tr("The seed lies outside of the box")
                               : tr("The seed lies outside of the scan"),
                   "seed", tr("Give x, y and z in the patient's frame (LPS, mm)")};
    }
    voxel[axis] = int(at);
  }
  if (options.others && (options.others->geometry.size != g.size ||
                         options.others->labels.size() != g.voxelCount())) {
    return Error{code::kOtherGrid, tr("The other structures are of another grid than the scan"), "",
                 ""};
  }
  const double needed_mb = 1.5 * double(g.voxelCount()) / (1 << 20) + 100.0;
  if (Status enough = enoughMemory(needed_mb, tr("Growing a structure"), ""); !enough) {
    return enough.error();
  }
  Growth growth;
  growth.mask.geometry = g;
  const WorkGrid grid = workGridOf(g);
  const Result<BlockMask> found = growBlocks(volume, grid, voxel, options, progress, growth);
  if (!found) return found.error();
  progress.at(0.85, "voxels");
  try {
    growth.mask.labels = voxelsOf(*found, grid, volume, growth.hu, options.box);
    if (options.others) leaveToOthers(growth.mask, *options.others);
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the structure"), "");
  }
  for (const std::uint8_t label : growth.mask.labels) growth.voxels += label;
  growth.ml = double(growth.voxels) * g.voxelVolume_mm3() / 1000.0;
  growth.leaked =
      reachesBorder(growth.mask) || double(growth.voxels) > kMostOfScan * double(g.voxelCount());
  if (growth.voxels == 0) return nothingGrown(growth.hu, options.open_mm, 0.0);
  growth.seed_off_mm = offFrom(growth.mask, seed_mm, voxel);
  if (std::isinf(growth.seed_off_mm)) {
    return Error{code::kNothingGrown,
                 tr("The place is of no organ as wide as {}",
                    formatted("%.0f mm: what was found lies more than %.0f mm beside it",
                              2.0 * options.open_mm, kMostOff_mm)),
                 "seed", tr("Choose a place well inside, another range of HU or a smaller ball")};
  }
  if (growth.seed_off_mm > 0.0) {
    growth.steps.push_back(formatted("the seed itself lies %.1f mm beside it", growth.seed_off_mm));
  }
  return growth;
}

}  // namespace trephine
