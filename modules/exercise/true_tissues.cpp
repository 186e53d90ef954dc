#include "exercise/true_tissues.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace trephine {

namespace {

// Neighbours that stand for what lies on one side of a voxel, in voxels from its centre: those from
// kFar on; and nearer ones, between which the HU rise where the voxel itself lies on the edge, by
// this share of the whole. Between two edges, in a layer, they hardly do.
constexpr double kNear = 0.7, kFar = 1.3, kFarthest = 2.3, kAside = 1.2, kRise = 0.15;
constexpr int kReach = 2;
// Air: what is enclosed does not look through it at its wall.
constexpr int kOutside_HU = -300;
// A wall is looked for so far, and in each direction every so many of the finest spacing.
constexpr double kWall_mm = 160.0, kWallStep = 0.9;
constexpr int kBlock = 4;  // voxels, along each axis

// What lies within the skull of the built-in head.
bool isInSkull(PhantomTissue tissue) {
  return tissue >= PhantomTissue::dura && tissue <= PhantomTissue::ventricle;
}

// The middles of the faces, edges and corners of a cube, as unit vectors.
const std::array<Vec3, 26>& around() {
  static const std::array<Vec3, 26> directions = [] {
    std::array<Vec3, 26> made;
    std::size_t n = 0;
    for (int c = 0; c < 27; ++c) {
      if (c == 13) continue;
      made[n++] = glm::normalize(Vec3(c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1));
    }
    return made;
  }();
  return directions;
}

// Of a voxel of `hu`, by which alone it is of `own`: the tissue by its neighbours, or -1. `mean`: of
// it and the 26 next to it; `rise`: up their gradient, of any length; `huAt`: by the distance in
// voxels.
template <class HuAt>
int ofNeighbours(const TissueTable& table, double hu, int own, double mean, const Vec3& rise,
                 const HuAt& huAt) {
  constexpr double kEdge_HU = TrueTissues::kEdge_HU;
  // The mean HU on both sides, near and far.
  struct Side {
    double sum = 0.0;
    int count = 0;
    void add(double there) { sum += there, ++count; }
    double mean(double otherwise) const { return count > 0 ? sum / count : otherwise; }
  };
  Side near[2], far[2];
  if (const double steep = glm::length(rise); steep > 0.0) {
    const Vec3 up = rise / steep;
    for (int k = -kReach; k <= kReach; ++k) {
      for (int j = -kReach; j <= kReach; ++j) {
        for (int i = -kReach; i <= kReach; ++i) {
          const Vec3 to(i, j, k);
          const double along = glm::dot(to, up), off = std::abs(along);
          const Vec3 aside = to - along * up;
          if (off < kNear || off > kFarthest || glm::dot(aside, aside) > kAside * kAside) continue;
          (off < kFar ? near : far)[along > 0.0].add(huAt(i, j, k));
        }
      }
    }
  }
  // What two tissues and a mean between them make may have the HU of a third, which is then nowhere
  // about.
  const auto ifMet = [&](int tissue) {
    if (tissue < 0 || tissue == own) return tissue;
    for (int n = 0; n < 125; ++n) {
      if (classify(table, huAt(n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2)) == tissue) return tissue;
    }
    return own;
  };
  const double below = near[0].mean(hu), above = near[1].mean(hu);
  // Where the HU turn back farther on, something else begins there.
  const double low = std::min(below, far[0].mean(below)),
               high = std::max(above, far[1].mean(above));
  // Over or under both of its sides it is a layer between them: thin bone, a gap.
  const bool layer = hu > above + kEdge_HU / 2 || hu < below - kEdge_HU / 2;
  if (layer) return own;
  if (above - below >= std::max(kEdge_HU, kRise * (high - low))) {
    if (hu - low > high - hu) return ifMet(classify(table, std::round(high)));
    return own == classify(table, std::round(low)) ? own : -1;
  }
  // A wall that is thinner than its neighbourhood keeps its own.
  return std::abs(mean - hu) < kEdge_HU ? ifMet(classify(table, std::round(mean))) : own;
}

}  // namespace

TrueTissues::TrueTissues(const TissueSet& tissues, const Volume& before, const LabelMap* labels,
                         const std::string& case_source)
    : table_(tissueTable(tissues)), before_(before), labels_(labels) {
  within_.fill(-1);
  for (std::size_t t = 0; t < std::size_t(table_.count); ++t) {
    for (std::size_t by = 0; by < std::size_t(table_.count); ++by) {
      if (tissues.tissues[t].within == tissues.tissues[by].id) within_[t] = int(by);
    }
  }
  if (labels_ && labels_->labels.size() != before.hu.size()) labels_ = nullptr;
  to_mm_ = before.geometry.voxelToPatient();
  if (const auto name = phantomNamed(case_source)) {
    const auto geometry = phantomGeometry(*name);
    const auto truth = phantomTruth(*name);
    if (geometry && truth && *geometry == before.geometry) formula_ = *truth;
    is_head_ = *name == "cranium";
  }
}

int TrueTissues::at(std::size_t voxel, Enclosed* known) const {
  const int hu = before_.hu[voxel];
  if (hu == kRemovedHu) return kUnnamed;
  const int label = labels_ ? labels_->labels[voxel] : 0;
  if (const int of = ofLabel(hu, label); of >= 0) return of;
  const Index3 at = before_.geometry.indicesOf(voxel);
  return formula_ ? ofFormula(at, known) : ofHu(at, known);
}

// Of several with that label, the one whose range holds the HU or is nearest to it.
int TrueTissues::ofLabel(int hu, int label) const {
  if (label == 0) return -1;
  int nearest = -1, least = 0;
  for (int t = 0; t < table_.count; ++t) {
    const TissueClass& tissue = table_.classes[std::size_t(t)];
    if (tissue.label != label) continue;
    const int beside = std::max({0, tissue.hu_min - hu, hu - tissue.hu_max});
    if (nearest < 0 || beside < least) {
      nearest = t;
      least = beside;
    }
  }
  return nearest;
}

int TrueTissues::ofFormula(const Index3& voxel, Enclosed* known) const {
  const PhantomTissue truth =
      (*formula_)(Vec3(to_mm_ * glm::dvec4(voxel[0], voxel[1], voxel[2], 1.0)));
  if (truth == PhantomTissue::air) return kUnnamed;
  const int of = classify(table_, phantomHu(truth));
  const int by = of >= 0 ? within_[std::size_t(of)] : -1;
  if (by < 0) return of;
  // Of the built-in head's skull the formula knows the inside too.
  const int bone = phantomHu(PhantomTissue::outerTable);
  const TissueClass& wall = table_.classes[std::size_t(by)];
  const bool is_bone = truth >= PhantomTissue::outerTable && truth <= PhantomTissue::innerTable;
  const bool by_skull = is_head_ && !is_bone && bone >= wall.hu_min && bone <= wall.hu_max;
  return (by_skull ? isInSkull(truth) : isEnclosed(voxel, by, known)) ? of : kUnnamed;
}

int TrueTissues::ofHu(const Index3& voxel, Enclosed* known) const {
  const GridGeometry& g = before_.geometry;
  const double hu = before_.at(voxel[0], voxel[1], voxel[2]);
  // The scan's end goes on beyond it.
  const auto huAt = [&](int i, int j, int k) {
    return double(before_.at(std::clamp(voxel[0] + i, 0, g.size[0] - 1),
                             std::clamp(voxel[1] + j, 0, g.size[1] - 1),
                             std::clamp(voxel[2] + k, 0, g.size[2] - 1)));
  };
  Vec3 rise(0.0);
  double mean = 0.0, least = hu, most = hu;
  for (int n = 0; n < 27; ++n) {
    const int i = n % 3 - 1, j = n / 3 % 3 - 1, k = n / 9 - 1;
    const double there = huAt(i, j, k);
    mean += there / 27.0;
    least = std::min(least, there);
    most = std::max(most, there);
    if (n != 13) rise += (there - hu) / double(i * i + j * j + k * k) * Vec3(i, j, k);
  }
  const int own = classify(table_, hu);
  int of = own;
  // All about it are of one range of HU: there is nothing to tell apart.
  if (own < 0 || least < table_.classes[std::size_t(own)].hu_min ||
      most > table_.classes[std::size_t(own)].hu_max) {
    of = ofNeighbours(table_, hu, own, mean, rise, huAt);
  }
  if (of < 0) return kUnnamed;
  const int by = within_[std::size_t(of)];
  return by >= 0 && !isEnclosed(voxel, by, known) ? kUnnamed : of;
}

TrueTissues::Meets TrueTissues::meets(std::size_t voxel, int by) const {
  const TissueClass& wall = table_.classes[std::size_t(by)];
  const int hu = before_.hu[voxel];
  if (hu >= wall.hu_min && hu <= wall.hu_max &&
      (wall.label == 0 || (labels_ && labels_->labels[voxel] == wall.label))) {
    return Meets::wall;
  }
  return hu < kOutside_HU ? Meets::air : Meets::neither;
}

// Of voxels in one block from which nothing stands between, one is asked for all.
bool TrueTissues::isEnclosed(const Index3& voxel, int by, Enclosed* known) const {
  const GridGeometry& g = before_.geometry;
  Index3 middle;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    middle[axis] = std::min(g.size[axis] - 1, voxel[axis] / kBlock * kBlock + kBlock / 2);
  }
  const Vec3 from(voxel[0], voxel[1], voxel[2]), to(middle[0], middle[1], middle[2]);
  constexpr int kLooks = 2 * kBlock;
  for (int n = 1; n <= kLooks; ++n) {
    const Vec3 at = glm::round(from + double(n) / kLooks * (to - from));
    if (meets(g.indexOf(int(at.x), int(at.y), int(at.z)), by) != Meets::neither) {
      return isEnclosedAt(voxel, by);
    }
  }
  if (!known) return isEnclosedAt(middle, by);
  const std::size_t key =
      g.indexOf(middle[0], middle[1], middle[2]) * std::size_t(kMaxTissues) + std::size_t(by);
  const auto [at, fresh] = known->try_emplace(key, false);
  if (fresh) at->second = isEnclosedAt(middle, by);
  return at->second;
}

bool TrueTissues::isEnclosedAt(const Index3& voxel, int by) const {
  const GridGeometry& g = before_.geometry;
  const double step_mm = kWallStep * std::min({g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z});
  const int steps = int(kWall_mm / step_mm);
  int met = 0, missed = 0;
  for (const Vec3& direction : around()) {
    const Vec3 step = direction * step_mm / g.spacing_mm;
    Vec3 at = Vec3(voxel[0], voxel[1], voxel[2]) + 0.5;
    for (int n = 0; n < steps; ++n) {
      at += step;
      const int i = int(std::floor(at.x)), j = int(std::floor(at.y)), k = int(std::floor(at.z));
      if (!g.contains(i, j, k)) break;  // nobody knows what is there
      const Meets here = meets(g.indexOf(i, j, k), by);
      if (here == Meets::wall) {
        ++met;
        break;
      }
      if (here == Meets::air || n + 1 == steps) {
        ++missed;
        break;
      }
    }
    if (missed > int((1.0 - kEnclosed) * double(around().size()))) return false;
  }
  const bool all_known = met + missed == int(around().size());
  return all_known ? met >= kEnclosed * double(met + missed) : met >= kLeastMet && missed == 0;
}

}  // namespace trephine
