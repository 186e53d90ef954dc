#include "imaging/steps/anatomy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>
#include <vector>

#include "base/tr.h"

namespace trephine {

namespace {

constexpr double kCell_mm = 4.0;
constexpr int kBody_HU = -300, kBone_HU = 226;
// Of a cell's voxels that are bone, from which on it counts as a wall: a table of 2 mm is a third.
constexpr double kWall = 0.15;
// A cavity in one slice: from that of a small child's vault near its top to a large head's.
constexpr double kCavityLeast_cm2 = 35.0, kCavityMost_cm2 = 380.0;
constexpr double kCavityRun_mm = 24.0;     // over so many mm of slices
constexpr double kCavityLeast_ml = 130.0;  // of a head that is cut through
// Beside the rings of a pelvis, whose cavity is a small part of the body.
constexpr double kCavityOfBody = 0.1;
constexpr int kOrganLow_HU = 15, kOrganHigh_HU = 190;
constexpr double kOrganBall_mm = 25.0, kOrganLeast_ml = 60.0;
constexpr double kWideBody_mm = 190.0, kMostBone = 0.2;

struct Cells {
  Index3 size{0, 0, 0}, step{1, 1, 1};  // step: voxels in one
  Vec3 mm{1.0};
  std::vector<float> mean;
  std::vector<std::uint8_t> wall, body;

  std::size_t at(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(size[1]) + std::size_t(j)) * std::size_t(size[0]) +
           std::size_t(i);
  }
  std::size_t count() const { return mean.size(); }
  double ml() const { return mm.x * mm.y * mm.z / 1000.0; }
};

Cells cellsOf(const Volume& volume) {
  const GridGeometry& g = volume.geometry;
  Cells cells;
  for (std::size_t a = 0; a < 3; ++a) {
    cells.step[a] = std::clamp(int(std::lround(kCell_mm / g.spacing_mm[int(a)])), 1, g.size[a]);
    cells.size[a] = (g.size[a] + cells.step[a] - 1) / cells.step[a];
    cells.mm[int(a)] = cells.step[a] * g.spacing_mm[int(a)];
  }
  const auto count =
      std::size_t(cells.size[0]) * std::size_t(cells.size[1]) * std::size_t(cells.size[2]);
  cells.mean.resize(count);
  cells.wall.resize(count);
  cells.body.resize(count);
  const auto fill = [&](int first, int last) {
    for (int k = first; k < last; ++k) {
      for (int j = 0; j < cells.size[1]; ++j) {
        for (int i = 0; i < cells.size[0]; ++i) {
          double sum = 0.0;
          int voxels = 0, bone = 0;
          for (int c = k * cells.step[2]; c < std::min((k + 1) * cells.step[2], g.size[2]); ++c) {
            for (int b = j * cells.step[1]; b < std::min((j + 1) * cells.step[1], g.size[1]); ++b) {
              for (int a = i * cells.step[0]; a < std::min((i + 1) * cells.step[0], g.size[0]);
                   ++a) {
                const int hu = volume.at(a, b, c);
                sum += std::clamp(hu, -1024, 3071);
                bone += hu > kBone_HU;
                ++voxels;
              }
            }
          }
          const std::size_t at = cells.at(i, j, k);
          cells.mean[at] = float(sum / voxels);
          cells.wall[at] = bone > kWall * voxels;
          cells.body[at] = cells.mean[at] > kBody_HU || cells.wall[at];
        }
      }
    }
  };
  std::thread half(fill, 0, cells.size[2] / 2);
  fill(cells.size[2] / 2, cells.size[2]);
  half.join();
  return cells;
}

// The largest piece by faces, alone.
std::size_t keepLargest(const Cells& cells, std::vector<std::uint8_t>& in) {
  std::vector<std::uint32_t> piece(in.size(), 0);
  std::vector<std::size_t> front;
  std::uint32_t number = 0, largest = 0;
  std::size_t most = 0;
  const std::array<Index3, 6> kFaces{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
  for (std::size_t start = 0; start < in.size(); ++start) {
    if (!in[start] || piece[start]) continue;
    piece[start] = ++number;
    front.assign(1, start);
    std::size_t count = 0;
    while (!front.empty()) {
      const std::size_t at = front.back();
      front.pop_back();
      ++count;
      const int i = int(at % std::size_t(cells.size[0]));
      const int j = int(at / std::size_t(cells.size[0]) % std::size_t(cells.size[1]));
      const int k = int(at / (std::size_t(cells.size[0]) * std::size_t(cells.size[1])));
      for (const Index3& f : kFaces) {
        const int a = i + f[0], b = j + f[1], c = k + f[2];
        if (a < 0 || b < 0 || c < 0 || a >= cells.size[0] || b >= cells.size[1] ||
            c >= cells.size[2]) {
          continue;
        }
        const std::size_t next = cells.at(a, b, c);
        if (!in[next] || piece[next]) continue;
        piece[next] = number;
        front.push_back(next);
      }
    }
    if (count > most) {
      most = count;
      largest = number;
    }
  }
  for (std::size_t at = 0; at < in.size(); ++at) in[at] = largest > 0 && piece[at] == largest;
  return most;
}

// Slices across one axis: of each, the area that walls enclose, cm2. Gaps of two cells in a wall
// (sutures, openings of nerves) are closed.
std::vector<double> cavities_cm2(const Cells& cells, std::size_t axis) {
  const std::size_t u_axis = axis == 0 ? 1 : 0, v_axis = axis == 2 ? 1 : 2;
  const int nu = cells.size[u_axis], nv = cells.size[v_axis];
  const double cell_cm2 = cells.mm[int(u_axis)] * cells.mm[int(v_axis)] / 100.0;
  std::vector<double> areas;
  for (int s = 0; s < cells.size[axis]; ++s) {
    const auto wallAt = [&](int u, int v) {
      Index3 at;
      at[axis] = s;
      at[u_axis] = u;
      at[v_axis] = v;
      return cells.wall[cells.at(at[0], at[1], at[2])] != 0;
    };
    const auto of = [&](int u, int v) { return std::size_t(v) * std::size_t(nu) + std::size_t(u); };
    std::vector<std::uint8_t> closed(std::size_t(nu) * std::size_t(nv));
    for (int v = 0; v < nv; ++v) {
      for (int u = 0; u < nu; ++u) {
        if (!wallAt(u, v)) continue;
        for (int b = std::max(v - 1, 0); b <= std::min(v + 1, nv - 1); ++b) {
          for (int a = std::max(u - 1, 0); a <= std::min(u + 1, nu - 1); ++a) closed[of(a, b)] = 1;
        }
      }
    }
    // What is reached from the border of the slice.
    std::vector<std::pair<int, int>> front;
    const auto reach = [&](int u, int v) {
      if (u < 0 || v < 0 || u >= nu || v >= nv || closed[of(u, v)]) return;
      closed[of(u, v)] = 2;
      front.emplace_back(u, v);
    };
    for (int u = 0; u < nu; ++u) reach(u, 0), reach(u, nv - 1);
    for (int v = 0; v < nv; ++v) reach(0, v), reach(nu - 1, v);
    while (!front.empty()) {
      const auto [u, v] = front.back();
      front.pop_back();
      reach(u + 1, v), reach(u - 1, v), reach(u, v + 1), reach(u, v - 1);
    }
    areas.push_back(cell_cm2 * double(std::count(closed.begin(), closed.end(), 0)));
  }
  return areas;
}

bool isCavity(double area_cm2) {
  return area_cm2 >= kCavityLeast_cm2 && area_cm2 <= kCavityMost_cm2;
}

// The longest row of slices with a cavity.
struct CavityRun {
  int first = 0, count = 0;
  double mm = 0.0, ml = 0.0;
};

CavityRun longestRun(const std::vector<double>& areas_cm2, double slice_mm) {
  CavityRun best, run;
  for (int s = 0; s < int(areas_cm2.size()); ++s) {
    if (!isCavity(areas_cm2[std::size_t(s)])) {
      run = {};
      continue;
    }
    if (run.count++ == 0) run.first = s;
    run.mm = run.count * slice_mm;
    run.ml += areas_cm2[std::size_t(s)] * slice_mm / 10.0;
    if (run.ml > best.ml) best = run;
  }
  return best;
}

// Every second cell each way.
Cells everySecond(const Cells& from) {
  Cells cells;
  for (std::size_t a = 0; a < 3; ++a) {
    cells.size[a] = (from.size[a] + 1) / 2;
    cells.mm[int(a)] = 2.0 * from.mm[int(a)];
  }
  for (int k = 0; k < from.size[2]; k += 2) {
    for (int j = 0; j < from.size[1]; j += 2) {
      for (int i = 0; i < from.size[0]; i += 2) {
        const std::size_t at = from.at(i, j, k);
        cells.mean.push_back(from.mean[at]);
        cells.wall.push_back(from.wall[at]);
        cells.body.push_back(from.body[at]);
      }
    }
  }
  return cells;
}

// Of the largest piece of organ tissue into which the ball goes: what the ball covers of it, mL.
double organ_ml(const Cells& cells) {
  std::vector<std::uint8_t> tissue(cells.count());
  for (std::size_t at = 0; at < tissue.size(); ++at) {
    tissue[at] = cells.body[at] && !cells.wall[at] && cells.mean[at] >= kOrganLow_HU &&
                 cells.mean[at] <= kOrganHigh_HU;
  }
  // Cells from whose middle the ball stays within: a cell in eight of ten that it covers may be a
  // vessel or noise.
  std::vector<Index3> ball;
  Index3 reach;
  for (std::size_t a = 0; a < 3; ++a) reach[a] = int(kOrganBall_mm / cells.mm[int(a)]);
  for (int c = -reach[2]; c <= reach[2]; ++c) {
    for (int b = -reach[1]; b <= reach[1]; ++b) {
      for (int a = -reach[0]; a <= reach[0]; ++a) {
        if (glm::length(Vec3(a, b, c) * cells.mm) <= kOrganBall_mm) ball.push_back({a, b, c});
      }
    }
  }
  std::vector<std::uint8_t> deep(cells.count());
  for (int k = 0; k < cells.size[2]; ++k) {
    for (int j = 0; j < cells.size[1]; ++j) {
      for (int i = 0; i < cells.size[0]; ++i) {
        if (!tissue[cells.at(i, j, k)]) continue;
        int inside = 0, outside = 0;
        const int most = int(ball.size()) / 10;
        for (const Index3& d : ball) {
          const int a = i + d[0], b = j + d[1], c = k + d[2];
          // Beyond the scan nothing is known.
          if (a < 0 || b < 0 || c < 0 || a >= cells.size[0] || b >= cells.size[1] ||
              c >= cells.size[2]) {
            continue;
          }
          (tissue[cells.at(a, b, c)] ? inside : outside) += 1;
          if (outside > most) break;
        }
        deep[cells.at(i, j, k)] = outside <= most && inside > int(ball.size()) / 2;
      }
    }
  }
  const std::size_t count = keepLargest(cells, deep);
  return double(count) * cells.ml();
}

}  // namespace

const char* bodyRegionName(BodyRegion part) {
  static const char* const kNames[] = {"not sure", "head", "abdomen"};
  return kNames[std::size_t(part)];
}

Anatomy anatomyOf(const Volume& volume, const Progress& progress) {
  Anatomy found;
  progress.at(0.0, tr("Looking at what the CT shows"));
  Cells cells = cellsOf(volume);
  if (progress.cancelled()) return found;
  found.body_ml = double(keepLargest(cells, cells.body)) * cells.ml();
  std::size_t bone = 0;
  Index3 low = cells.size, high{-1, -1, -1};
  for (int k = 0; k < cells.size[2]; ++k) {
    for (int j = 0; j < cells.size[1]; ++j) {
      for (int i = 0; i < cells.size[0]; ++i) {
        const std::size_t at = cells.at(i, j, k);
        cells.wall[at] = cells.wall[at] && cells.body[at];
        if (!cells.body[at]) continue;
        bone += cells.wall[at];
        const Index3 cell{i, j, k};
        for (std::size_t a = 0; a < 3; ++a) {
          low[a] = std::min(low[a], cell[a]);
          high[a] = std::max(high[a], cell[a]);
        }
      }
    }
  }
  if (found.body_ml <= 0.0) return found;
  found.bone_percent = 100.0 * double(bone) * cells.ml() / found.body_ml;
  std::array<double, 3> extents{};
  for (std::size_t a = 0; a < 3; ++a) extents[a] = (high[a] - low[a] + 1) * cells.mm[int(a)];
  std::sort(extents.begin(), extents.end());
  found.width_mm = extents[1];
  progress.at(0.4, tr("Looking at what the CT shows"));

  CavityRun best;
  for (std::size_t axis = 0; axis < 3 && !progress.cancelled(); ++axis) {
    const CavityRun run = longestRun(cavities_cm2(cells, axis), cells.mm[int(axis)]);
    if (run.ml > best.ml) best = run;
  }
  found.cavity_mm = best.mm;
  found.cavity_ml = best.ml;
  progress.at(0.7, tr("Looking at what the CT shows"));
  if (progress.cancelled()) return {};
  if (best.mm >= kCavityRun_mm && best.ml >= kCavityLeast_ml &&
      best.ml >= kCavityOfBody * found.body_ml) {
    found.region = BodyRegion::head;
    // Towards the crown, in the axis that runs there most: the cavity ends before the scan does.
    std::size_t up = 0;
    for (std::size_t a = 1; a < 3; ++a) {
      if (std::abs(volume.geometry.direction[int(a)].z) >
          std::abs(volume.geometry.direction[int(up)].z)) {
        up = a;
      }
    }
    const bool rises = volume.geometry.direction[int(up)].z > 0.0;
    const std::vector<double> areas = cavities_cm2(cells, up);
    const double top = rises ? areas.back() : areas.front();
    const CavityRun run = longestRun(areas, cells.mm[int(up)]);
    found.vault = run.count > 0 && top < kCavityLeast_cm2;
    return found;
  }
  found.organ_ml = organ_ml(everySecond(cells));
  if (progress.cancelled()) return {};
  const bool wide = found.width_mm >= kWideBody_mm;
  if (wide && found.bone_percent < 100.0 * kMostBone && found.organ_ml >= kOrganLeast_ml &&
      best.ml < kCavityOfBody * found.body_ml) {
    found.region = BodyRegion::abdomen;
  }
  progress.at(1.0, tr("Looking at what the CT shows"));
  return found;
}

}  // namespace trephine
