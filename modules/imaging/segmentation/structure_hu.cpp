#include "imaging/segmentation/detail/structure_hu.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/tr.h"

namespace trephine {

namespace {

constexpr double kLeastOfKind = 0.7, kNearKind_HU = 60.0;
// Of the voxels whose names say a kind: fewer than these have it as they lie, and more than these
// would have it turned about.
constexpr double kFewHere = 0.5, kMostTurned = 0.9;
constexpr std::size_t kMostLookedAt = 5000;  // voxels of a structure, in other places

struct NamedKind {
  std::vector<const char*> words;
  HuOfKind hu;
};

// Broad: with and without contrast, whatever the scanner. A word is one of the name's own.
const std::vector<NamedKind>& kinds() {
  static const std::vector<NamedKind> all = {
      {{"lung", "lungs", "trachea", "bronchus", "airway", "sinus"},
       {trLater("lung or airway"), -1024, -300}},
      {{"fat", "adipose"}, {trLater("fat"), -200, 0}},
      {{"bone", "bones", "skull", "cranium", "mandible", "vertebra", "vertebrae", "rib", "ribs",
        "femur", "humerus", "sacrum", "hip", "pelvis", "clavicula", "scapula", "sternum", "table"},
       {trLater("bone"), 100, 3071}},
      {{"liver", "spleen", "pancreas", "kidney", "kidneys", "prostate", "thyroid"},
       {trLater("a solid organ"), -20, 300}},
      {{"tumour", "tumor", "lesion", "metastasis"}, {trLater("a tumour"), -50, 300}},
      {{"muscle", "autochthon", "iliopsoas", "gluteus", "heart", "myocardium"},
       {trLater("muscle"), -50, 300}},
      {{"vessel", "vessels", "aorta", "vein", "artery", "cava", "portal"},
       {trLater("a vessel"), -10, 700}},
      {{"brain", "cerebellum", "ventricle", "ventricles"}, {trLater("brain"), -10, 120}},
      {{"bladder", "gallbladder"}, {trLater("a bladder"), -50, 700}},
      {{"skin", "scalp", "capsule"}, {trLater("skin or a capsule"), -300, 300}}};
  return all;
}

std::vector<std::string> wordsOf(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    const bool letter = std::isalnum(static_cast<unsigned char>(c)) || (c & 0x80);
    if (letter) {
      words.back() += char(std::tolower(static_cast<unsigned char>(c)));
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  return words;
}

using Labels = std::array<bool, 256>;

Labels notOfKind(const LabelMap& map, const HuByLabel& hu) {
  Labels wrong{};
  for (const Structure& s : map.structures) {
    const auto& counts = hu[std::size_t(s.label)];
    const auto kind = huOfKind(s.name, s.tissue);
    wrong[std::size_t(s.label)] = counts && kind && !isOfKind(*counts, *kind);
  }
  return wrong;
}

// The share of voxels, of those whose names say a kind, whose structures have it; none say: 1.
double shareOfKind(const LabelMap& map, const HuByLabel& hu, const Labels& wrong) {
  double of_kind = 0.0, all = 0.0;
  for (const Structure& s : map.structures) {
    const auto& counts = hu[std::size_t(s.label)];
    if (!counts || !huOfKind(s.name, s.tissue)) continue;
    all += double(counts->total());
    if (!wrong[std::size_t(s.label)]) of_kind += double(counts->total());
  }
  return all > 0.0 ? of_kind / all : 1.0;
}

// Of the voxels as they lie moved by so many; those that leave the CT are left out.
StructureHu huOfMoved(const std::vector<Index3>& voxels, const Volume& ct, const Index3& by) {
  StructureHu counts;
  const Index3& size = ct.geometry.size;
  for (const Index3& v : voxels) {
    const int i = v[0] + by[0], j = v[1] + by[1], k = v[2] + by[2];
    if (i < 0 || j < 0 || k < 0 || i >= size[0] || j >= size[1] || k >= size[2]) continue;
    counts.add(ct.at(i, j, k));
  }
  return counts;
}

bool isOfKindNearby(const std::vector<Index3>& voxels, const Volume& ct, const HuOfKind& kind,
                    double slack_mm) {
  std::array<std::vector<int>, 3> moves;
  for (std::size_t a = 0; a < 3; ++a) {
    const int most = std::max(1, int(std::ceil(slack_mm / ct.geometry.spacing_mm[int(a)] - 0.01)));
    moves[a] = {0, -most, most};
    if (most > 1) moves[a].insert(moves[a].end(), {-most / 2, most / 2});
  }
  for (const int k : moves[2]) {
    for (const int j : moves[1]) {
      for (const int i : moves[0]) {
        const StructureHu counts = huOfMoved(voxels, ct, {i, j, k});
        if (2 * counts.total() > voxels.size() && isOfKind(counts, kind)) return true;
      }
    }
  }
  return false;
}

}  // namespace

void StructureHu::add(std::int16_t hu) {
  ++bins_[std::size_t(std::clamp(int(hu) + 1024, 0, kBins - 1))];
  ++total_;
}

double StructureHu::percentile(double share) const {
  const double wanted = share * double(total_);
  double seen = 0.0;
  for (int bin = 0; bin < kBins; ++bin) {
    seen += bins_[std::size_t(bin)];
    if (seen >= wanted && seen > 0.0) return bin - 1024.0;
  }
  return kBins - 1025.0;
}

double StructureHu::shareIn(double low, double high) const {
  double in = 0.0;
  for (int bin = 0; bin < kBins; ++bin) {
    if (bin - 1024 >= low && bin - 1024 <= high) in += bins_[std::size_t(bin)];
  }
  return in / double(total_);
}

HuByLabel huOf(const LabelMap& map, const Volume& ct) {
  HuByLabel counts;
  for (std::size_t voxel = 0; voxel < map.labels.size(); ++voxel) {
    const std::uint8_t label = map.labels[voxel];
    if (label == 0) continue;
    if (!counts[label]) counts[label].emplace();
    counts[label]->add(ct.hu[voxel]);
  }
  return counts;
}

HuByLabel huOfTurned(const LabelMap& map, const Volume& ct, int axis, const VoxelBox& box) {
  HuByLabel counts;
  const auto turned = [&](int a, int n) {
    const auto side = std::size_t(a);
    return a == axis ? box.low[side] + box.high[side] - 1 - n : n;
  };
  for (int k = box.low[2]; k < box.high[2]; ++k) {
    for (int j = box.low[1]; j < box.high[1]; ++j) {
      for (int i = box.low[0]; i < box.high[0]; ++i) {
        const std::uint8_t label = map.labels[map.geometry.indexOf(i, j, k)];
        if (label == 0) continue;
        if (!counts[label]) counts[label].emplace();
        counts[label]->add(ct.at(turned(0, i), turned(1, j), turned(2, k)));
      }
    }
  }
  return counts;
}

bool isOfKind(const StructureHu& hu, const HuOfKind& kind) {
  const double median = hu.percentile(0.5);
  return median >= kind.low && median <= kind.high &&
         hu.shareIn(kind.low - kNearKind_HU, kind.high + kNearKind_HU) >= kLeastOfKind;
}

std::array<bool, 256> notOfTheirKind(const LabelMap& map, const Volume& ct, const HuByLabel& here,
                                     double slack_mm) {
  Labels wrong = notOfKind(map, here);
  if (std::ranges::find(wrong, true) == wrong.end()) return wrong;
  std::array<std::vector<Index3>, 256> voxels;
  std::array<std::size_t, 256> seen{};
  for (std::size_t v = 0; v < map.labels.size(); ++v) {
    const std::uint8_t label = map.labels[v];
    if (!wrong[label]) continue;
    const std::size_t every = here[label]->total() / kMostLookedAt + 1;
    if (seen[label]++ % every == 0) voxels[label].push_back(map.geometry.indicesOf(v));
  }
  for (const Structure& s : map.structures) {
    const auto label = std::size_t(s.label);
    if (!wrong[label]) continue;
    wrong[label] = !isOfKindNearby(voxels[label], ct, *huOfKind(s.name, s.tissue), slack_mm);
  }
  return wrong;
}

std::optional<int> mirroredAxis(const LabelMap& map, const Volume& ct, const VoxelBox& covers,
                                const HuByLabel& here, const std::array<bool, 256>& wrong) {
  if (shareOfKind(map, here, wrong) >= kFewHere) return {};
  std::optional<int> best;
  double most = kMostTurned;
  for (int axis = 0; axis < 3; ++axis) {
    const HuByLabel turned = huOfTurned(map, ct, axis, covers);
    const double share = shareOfKind(map, turned, notOfKind(map, turned));
    if (share >= most && (!best || share > most)) {
      most = share;
      best = axis;
    }
  }
  return best;
}

std::optional<HuOfKind> huOfKind(const std::string& name, const std::string& tissue) {
  for (const std::string* text : {&name, &tissue}) {
    const std::vector<std::string> words = wordsOf(*text);
    for (const NamedKind& kind : kinds()) {
      for (const char* word : kind.words) {
        if (std::ranges::find(words, word) != words.end()) return kind.hu;
      }
    }
  }
  return {};
}

}  // namespace trephine
