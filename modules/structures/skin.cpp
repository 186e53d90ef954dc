#include "structures/skin.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/codes.h"
#include "base/formatted.h"
#include "base/memory.h"
#include "base/tr.h"
#include "structures/codes.h"
#include "structures/voxel_runs.h"
#include "structures/work_grid.h"

namespace trephine {

namespace {

constexpr double kAirBlock_mm = 2.0;

Error noBody(const std::string& what) {
  return {code::kNoBody, what, "", tr("Choose a CT that shows the body and the air at its sides")};
}

// The grid's axis that runs most along the patient.
std::size_t alongBody(const GridGeometry& g) {
  std::size_t along = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (std::abs(g.direction[int(axis)].z) > std::abs(g.direction[int(along)].z)) along = axis;
  }
  return along;
}

// For each row and slice beside a voxel, how far along the row the layer reaches.
struct Reach {
  int dj = 0, dk = 0, half = 0;
};
std::vector<Reach> reachOf(const Vec3& spacing_mm, double thickness_mm) {
  Index3 most;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    most[axis] = std::max(1, int(thickness_mm / spacing_mm[int(axis)] + 0.5));
  }
  const auto isNear = [&](int a, int b, int c) {
    const int steps = std::max({std::abs(a), std::abs(b), std::abs(c)});
    // The surface lies half a voxel before the middle of the one outside.
    return steps <= 1 ||
           glm::length(Vec3(a, b, c) * spacing_mm) * (1.0 - 0.5 / steps) < thickness_mm;
  };
  std::vector<Reach> rows;
  for (int c = -most[2]; c <= most[2]; ++c) {
    for (int b = -most[1]; b <= most[1]; ++b) {
      int half = -1;
      while (half < most[0] && isNear(half + 1, b, c)) ++half;
      if (half >= 0) rows.push_back({b, c, half});
    }
  }
  return rows;
}

class SkinMask {
 public:
  enum State : std::uint8_t { kOther, kBody, kAir };

  explicit SkinMask(const Volume& volume)
      : volume_(volume), g_(volume.geometry), mask_(g_.voxelCount()) {}

  std::size_t takeBody() {
    VoxelRuns tissue(g_.size, [&](int i, int j, int k) { return volume_.at(i, j, k) > kBody_HU; });
    tissue.join(Touching::faces);
    if (tissue.pieces().empty()) return 0;
    const std::uint32_t body = tissue.largest();
    tissue.forRuns([&](int begin, int end, int j, int k, std::uint32_t piece) {
      if (piece == body) fill(begin, end, j, k, kBody);
    });
    return tissue.pieces()[body].voxels;
  }

  // False where no air comes from the sides.
  bool takeAir() {
    const WorkGrid grid = workGridOf(g_, kAirBlock_mm);
    const BlockMask core = openAir(grid);
    if (std::find(core.begin(), core.end(), 1) == core.end()) return false;
    const BlockMask zone = dilated(core, grid, kInto_mm);
    VoxelRuns air(g_.size, [&](int i, int j, int k) {
      if (mask_[g_.indexOf(i, j, k)] == kBody) return false;
      const Index3 block = grid.blockOf({i, j, k});
      return zone[grid.indexOf(block[0], block[1], block[2])] != 0;
    });
    air.join(Touching::faces);
    std::vector<std::uint8_t> open(air.pieces().size());
    for (int k = 0; k < grid.size[2]; ++k) {
      for (int j = 0; j < grid.size[1]; ++j) {
        for (int i = 0; i < grid.size[0]; ++i) {
          if (!core[grid.indexOf(i, j, k)]) continue;
          const VoxelRuns::Run* run =
              air.at({i * grid.factor[0], j * grid.factor[1], k * grid.factor[2]});
          if (run) open[run->piece] = 1;
        }
      }
    }
    air.forRuns([&](int begin, int end, int j, int k, std::uint32_t piece) {
      if (open[piece]) fill(begin, end, j, k, kAir);
    });
    return true;
  }

  // Makes it 0 and 1; how many voxels are in the layer.
  std::size_t keepLayer(double thickness_mm) {
    const std::vector<std::vector<std::size_t>> surface = surfaceOfAir();
    const std::vector<Reach> rows = reachOf(g_.spacing_mm, thickness_mm);
    const std::size_t wide = std::size_t(g_.size[0]), slice = wide * std::size_t(g_.size[1]);
    std::vector<std::size_t> counts(std::size_t(g_.size[2]));
    onTwoThreadsOrThrow(g_.size[2], [&](int k) {
      std::vector<std::uint8_t> near(slice);
      for (const Reach& reach : rows) {
        const int from = k - reach.dk;
        if (from < 0 || from >= g_.size[2]) continue;
        for (const std::size_t at : surface[std::size_t(from)]) {
          const int i = int(at % wide), j = int(at / wide) + reach.dj;
          if (j < 0 || j >= g_.size[1]) continue;
          std::uint8_t* row = &near[std::size_t(j) * wide];
          std::fill(row + std::max(0, i - reach.half),
                    row + std::min(g_.size[0], i + reach.half + 1), std::uint8_t(1));
        }
      }
      std::uint8_t* mask = &mask_[g_.indexOf(0, 0, k)];
      for (std::size_t n = 0; n < slice; ++n) {
        mask[n] = near[n] && mask[n] == kBody;
        counts[std::size_t(k)] += mask[n];
      }
    });
    std::size_t all = 0;
    for (const std::size_t count : counts) all += count;
    return all;
  }

  std::vector<std::uint8_t> take() { return std::move(mask_); }

 private:
  void fill(int begin, int end, int j, int k, State state) {
    std::uint8_t* row = &mask_[g_.indexOf(0, j, k)];
    std::fill(row + begin, row + end, state);
  }

  // Blocks where a ball fits that comes from the sides, by their middles.
  BlockMask openAir(const WorkGrid& grid) const {
    BlockMask free(grid.count());
    const Index3& f = grid.factor;
    onTwoThreads(grid.size[2], [&](int k) {
      for (int j = 0; j < grid.size[1]; ++j) {
        for (int i = 0; i < grid.size[0]; ++i) {
          int body = 0, voxels = 0;
          for (int z = k * f[2]; z < std::min((k + 1) * f[2], g_.size[2]); ++z) {
            for (int y = j * f[1]; y < std::min((j + 1) * f[1], g_.size[1]); ++y) {
              for (int x = i * f[0]; x < std::min((i + 1) * f[0], g_.size[0]); ++x) {
                body += mask_[g_.indexOf(x, y, z)] == kBody;
                ++voxels;
              }
            }
          }
          free[grid.indexOf(i, j, k)] = 2 * body <= voxels;
        }
      }
    });
    const std::vector<std::int32_t> piece = pieces(eroded(free, grid, kOpening_mm), grid);
    std::vector<std::uint8_t> open(std::size_t(*std::max_element(piece.begin(), piece.end())) + 1);
    const std::size_t along = alongBody(g_);
    for (std::size_t n = 0; n < piece.size(); ++n) {
      if (piece[n] == 0) continue;
      const Index3 at{int(n % std::size_t(grid.size[0])),
                      int(n / std::size_t(grid.size[0]) % std::size_t(grid.size[1])),
                      int(n / std::size_t(grid.size[0]) / std::size_t(grid.size[1]))};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (axis != along && (at[axis] == 0 || at[axis] == grid.size[axis] - 1)) {
          open[std::size_t(piece[n])] = 1;
        }
      }
    }
    open[0] = 0;
    BlockMask core(piece.size());
    for (std::size_t n = 0; n < piece.size(); ++n) core[n] = open[std::size_t(piece[n])];
    return core;
  }

  // Of each slice, air with body among its 26 neighbours: indices within the slice.
  std::vector<std::vector<std::size_t>> surfaceOfAir() const {
    std::vector<std::vector<std::size_t>> slices(std::size_t(g_.size[2]));
    onTwoThreadsOrThrow(g_.size[2], [&](int k) {
      for (int j = 0; j < g_.size[1]; ++j) {
        // Of the rows about this one, whether there is body at each place.
        std::vector<std::uint8_t> body(std::size_t(g_.size[0]) + 2);
        for (int z = std::max(0, k - 1); z <= std::min(k + 1, g_.size[2] - 1); ++z) {
          for (int y = std::max(0, j - 1); y <= std::min(j + 1, g_.size[1] - 1); ++y) {
            const std::uint8_t* row = &mask_[g_.indexOf(0, y, z)];
            for (int i = 0; i < g_.size[0]; ++i) body[std::size_t(i) + 1] |= row[i] == kBody;
          }
        }
        const std::uint8_t* own = &mask_[g_.indexOf(0, j, k)];
        for (int i = 0; i < g_.size[0]; ++i) {
          const std::uint8_t* about = &body[std::size_t(i)];
          if (own[i] == kAir && (about[0] || about[1] || about[2])) {
            slices[std::size_t(k)].push_back(g_.indexOf(i, j, 0));
          }
        }
      }
    });
    return slices;
  }

  const Volume& volume_;
  const GridGeometry& g_;
  std::vector<std::uint8_t> mask_;
};

Result<Skin> madeSkin(const Volume& volume, double thickness_mm, const Progress& progress) {
  const Error cancelled{code::kCancelled, tr("Finding the skin was cancelled"), "", ""};
  const auto on = [&](double fraction, const char* step) {
    progress.at(fraction, step);
    return !progress.cancelled();
  };
  const double voxel_ml = volume.geometry.voxelVolume_mm3() / 1000.0;
  Skin skin;
  skin.mask.geometry = volume.geometry;
  if (!on(0.0, "body")) return cancelled;
  SkinMask mask(volume);
  const double body_ml = double(mask.takeBody()) * voxel_ml;
  if (body_ml < kLeastBody_ml) {
    return noBody(tr("The largest piece over {} HU has {} mL", formatted("%.0f", kBody_HU),
                     formatted("%.1f", body_ml)));
  }
  if (!on(0.3, "air")) return cancelled;
  if (!mask.takeAir()) return noBody(tr("There is no air at the sides of the scan"));
  if (!on(0.6, "layer")) return cancelled;
  skin.voxels = mask.keepLayer(thickness_mm);
  skin.ml = double(skin.voxels) * voxel_ml;
  skin.mask.labels = mask.take();
  skin.steps = {formatted("body over %.0f HU: %.0f mL", kBody_HU, body_ml),
                formatted("air where a ball of %.0f mm fits, and %.0f mm further", kOpening_mm,
                          kInto_mm - kOpening_mm),
                formatted("layer of %.1f mm: %.1f mL", thickness_mm, skin.ml)};
  return skin;
}

}  // namespace

Result<Skin> skinOf(const Volume& volume, double thickness_mm, const Progress& progress) {
  if (!(thickness_mm >= 0.1 && thickness_mm <= 20.0)) {
    return Error{code::kBadArgument, tr("The skin is from 0.1 to 20 mm thick"), "thickness", ""};
  }
  const double needed_mb = 2.0 * double(volume.geometry.voxelCount()) / (1 << 20) + 50.0;
  if (Status enough = enoughMemory(needed_mb, tr("Finding the skin"), ""); !enough) {
    return enough.error();
  }
  try {
    return madeSkin(volume, thickness_mm, progress);
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the skin"), "");
  }
}

}  // namespace trephine
