#include "imaging/segmentation/detail/structure_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace trephine {

namespace {

constexpr double kCell_mm = 3.5;
constexpr int kShell_cells = 2;  // around the structures, which has to differ from them
// Contrast between soft tissues decides: fat and less is one end, bone and more the other, or the
// skin would explain more than all organs.
constexpr int kLowest_HU = -150, kHighest_HU = 250;
constexpr int kAir_HU = -950;           // around the patient; as beyond the CT
constexpr double kMostBeyond = 0.1;     // of structures and shell, in another place
constexpr double kLeastVariance = 300;  // HU^2: what is alike all over explains nothing
constexpr std::size_t kLeastCells = 2500, kMostCells = 20'000;
// Of the variance, segmentations in their place would explain up to 0.08 more elsewhere (small ones
// and inaccurate ones), mirrored ones and those that are 6 mm and more off 0.14 to 0.6: README.md.
constexpr double kLeastGain = 0.1, kLeastRatio = 1.2;
// A place close by is told from inaccurate outlines only where labels explain much.
constexpr double kMuchExplained = 0.4;

struct Cells {
  Index3 step{1, 1, 1};
  Index3 size{0, 0, 0};
  std::vector<std::int16_t> hu;  // means; kAir: no tissue
  static constexpr std::int16_t kAir = std::int16_t(kLowest_HU - 1);

  std::size_t indexOf(const Index3& at) const {
    return (std::size_t(at[2]) * std::size_t(size[1]) + std::size_t(at[1])) * std::size_t(size[0]) +
           std::size_t(at[0]);
  }
};

Cells cellsOf(const Volume& ct) {
  Cells cells;
  for (std::size_t a = 0; a < 3; ++a) {
    const int n = ct.geometry.size[a];
    const long step = std::lround(kCell_mm / ct.geometry.spacing_mm[int(a)]);
    cells.step[a] = int(std::clamp(step, 1L, long(n)));
    cells.size[a] = n / cells.step[a];
  }
  const auto& [di, dj, dk] = cells.step;
  const std::size_t across = std::size_t(cells.size[0]);
  const int voxels = di * dj * dk;
  cells.hu.reserve(across * std::size_t(cells.size[1]) * std::size_t(cells.size[2]));
  std::vector<int> sums(across);
  for (int k = 0; k < cells.size[2]; ++k) {
    for (int j = 0; j < cells.size[1]; ++j) {
      std::ranges::fill(sums, 0);
      for (int line = 0; line < dj * dk; ++line) {
        const std::int16_t* hu =
            &ct.hu[ct.geometry.indexOf(0, j * dj + line % dj, k * dk + line / dj)];
        for (std::size_t i = 0; i < across; ++i) {
          for (int v = 0; v < di; ++v) sums[i] += std::clamp<int>(*hu++, -1024, 1500);
        }
      }
      for (const int sum : sums) {
        const int mean = sum / voxels;
        cells.hu.push_back(
            mean < kAir_HU ? Cells::kAir : std::int16_t(std::clamp(mean, kLowest_HU, kHighest_HU)));
      }
    }
  }
  return cells;
}

struct LabelledCell {
  Index3 at;
  std::uint8_t label;
};

// Of the structures and of a shell around them, which has label 0, each with the label of its
// middle. At most about kMostCells, evenly taken; none where the structures are small.
std::vector<LabelledCell> labelledCells(const LabelMap& map, const Cells& cells,
                                        const VoxelBox& covers) {
  const auto middle = [&](const Index3& at, std::size_t a) {
    return at[a] * cells.step[a] + cells.step[a] / 2;
  };
  std::vector<LabelledCell> found;
  std::vector<bool> taken(cells.hu.size());
  const auto take = [&](const Index3& at) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (at[a] < 0 || at[a] >= cells.size[a]) return;
      if (middle(at, a) < covers.low[a] || middle(at, a) >= covers.high[a]) return;
    }
    const std::size_t cell = cells.indexOf(at);
    if (taken[cell]) return;
    taken[cell] = true;
    found.push_back(
        {at, map.labels[map.geometry.indexOf(middle(at, 0), middle(at, 1), middle(at, 2))]});
  };
  for (int k = 0; k < cells.size[2]; ++k) {
    for (int j = 0; j < cells.size[1]; ++j) {
      for (int i = 0; i < cells.size[0]; ++i) {
        const Index3 at{i, j, k};
        if (map.labels[map.geometry.indexOf(middle(at, 0), middle(at, 1), middle(at, 2))] != 0) {
          take(at);
        }
      }
    }
  }
  if (found.size() < kLeastCells) return {};
  std::size_t from = 0;
  for (int layer = 0; layer < kShell_cells; ++layer) {
    const std::size_t to = found.size();
    for (; from < to; ++from) {
      for (std::size_t a = 0; a < 3; ++a) {
        for (const int by : {-1, 1}) {
          Index3 at = found[from].at;
          at[a] += by;
          take(at);
        }
      }
    }
  }
  const std::size_t every = found.size() / kMostCells + 1;
  std::vector<LabelledCell> some;
  for (std::size_t c = 0; c < found.size(); c += every) some.push_back(found[c]);
  return some;
}

// How well labels explain HU: between-label variance of all variance, 0 to 1 (eta squared).
class Explaining {
 public:
  Explaining(const Cells& cells, const std::vector<LabelledCell>& labelled)
      : cells_(cells), labelled_(labelled) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto [low, high] =
          std::ranges::minmax(labelled, {}, [a](const LabelledCell& cell) { return cell.at[a]; });
      ends_[a] = low.at[a] + high.at[a];
    }
  }

  // Moved by so many cells, having been mirrored along an axis about its own middle, or not (-1).
  // 0 where too much of them is beyond the patient, unless `anywhere`.
  double at(const Index3& moved, int mirrored = -1, bool anywhere = false) const {
    struct Sum {
      double hu = 0.0, cells = 0.0;
    };
    std::array<Sum, 256> of{};
    double squares = 0.0;
    std::size_t beyond = 0;
    const double allowed = anywhere ? 1e30 : kMostBeyond * double(labelled_.size());
    for (const LabelledCell& cell : labelled_) {
      Index3 at = cell.at;
      bool inside = true;
      for (std::size_t a = 0; a < 3; ++a) {
        at[a] = (int(a) == mirrored ? ends_[a] - at[a] : at[a]) + moved[a];
        inside = inside && at[a] >= 0 && at[a] < cells_.size[a];
      }
      const std::int16_t hu = inside ? cells_.hu[cells_.indexOf(at)] : Cells::kAir;
      if (hu == Cells::kAir) {
        ++beyond;
        if (double(beyond) > allowed) return 0.0;
        continue;
      }
      of[cell.label].hu += hu;
      of[cell.label].cells += 1.0;
      squares += double(hu) * hu;
    }
    double all = 0.0, cells = 0.0, between = 0.0;
    for (const Sum& sum : of) {
      if (sum.cells == 0.0) continue;
      all += sum.hu;
      cells += sum.cells;
      between += sum.hu * sum.hu / sum.cells;
    }
    if (cells == 0.0) return 0.0;
    const double variance = squares - all * all / cells;
    if (variance < kLeastVariance * cells) return 0.0;
    return (between - all * all / cells) / variance;
  }

 private:
  const Cells& cells_;
  const std::vector<LabelledCell>& labelled_;
  Index3 ends_{0, 0, 0};
};

}  // namespace

std::optional<BetterPlace> betterPlace(const LabelMap& map, const Volume& ct,
                                       const VoxelBox& covers, double slack_mm) {
  const Cells cells = cellsOf(ct);
  const std::vector<LabelledCell> labelled = labelledCells(map, cells, covers);
  if (labelled.empty()) return {};
  const Explaining explained(cells, labelled);
  Index3 slack;
  for (std::size_t a = 0; a < 3; ++a) {
    const double cell_mm = cells.step[a] * ct.geometry.spacing_mm[int(a)];
    slack[a] = int(std::clamp(std::ceil(slack_mm / cell_mm - 0.01), 1.0, 3.0));
  }
  double here = 0.0;
  for (int k = -slack[2]; k <= slack[2]; ++k) {
    for (int j = -slack[1]; j <= slack[1]; ++j) {
      for (int i = -slack[0]; i <= slack[0]; ++i) {
        here = std::max(here, explained.at({i, j, k}, -1, true));
      }
    }
  }
  double most = std::max(here + kLeastGain, here * kLeastRatio);
  std::optional<BetterPlace> better;
  for (std::size_t a = 0; a < 3; ++a) {
    for (int by = -cells.size[a]; by <= cells.size[a]; ++by) {
      Index3 moved{0, 0, 0};
      moved[a] = by;
      for (const int mirrored : {-1, int(a)}) {
        if (mirrored < 0 && std::abs(by) <= slack[a]) continue;
        const double there = explained.at(moved, mirrored);
        if (there <= most) continue;
        if (mirrored < 0 && std::abs(by) <= 3 * slack[a] && there < kMuchExplained) continue;
        most = there;
        better = {mirrored >= 0, int(a), by * cells.step[a]};
      }
    }
  }
  return better;
}

}  // namespace trephine
