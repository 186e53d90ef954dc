#include "volume/phantom.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "base/memory.h"
#include "volume/case_memory.h"
#include "volume/phantom_painter.h"
#include "volume/phantom_shapes.h"
#include "volume/two_threads.h"

namespace trephine {

namespace {

struct TissueRow {
  PhantomTissue tissue;
  std::int16_t hu;
  const char* name;
};

// In the order of the enum. Where each number comes from: README.md.
constexpr std::array<TissueRow, 22> kTissues{{
    {PhantomTissue::air, -1000, "air"},
    {PhantomTissue::scalp, -20, "scalp"},
    {PhantomTissue::outerTable, 1400, "outer table"},
    {PhantomTissue::diploe, 600, "diploe"},
    {PhantomTissue::innerTable, 1400, "inner table"},
    {PhantomTissue::dura, 70, "dura"},
    {PhantomTissue::csf, 8, "csf"},
    {PhantomTissue::greyMatter, 38, "grey matter"},
    {PhantomTissue::whiteMatter, 28, "white matter"},
    {PhantomTissue::ventricle, 6, "ventricle"},
    {PhantomTissue::eye, 15, "eye"},
    {PhantomTissue::facialBone, 900, "facial bone"},
    {PhantomTissue::skin, -20, "skin"},
    {PhantomTissue::fat, -100, "fat"},
    {PhantomTissue::muscle, 72, "muscle"},
    {PhantomTissue::bone, 900, "bone"},
    {PhantomTissue::marrow, 250, "marrow"},
    {PhantomTissue::capsule, 95, "capsule"},
    {PhantomTissue::liver, 50, "liver"},
    {PhantomTissue::vessel, 150, "vessel"},
    {PhantomTissue::kidney, 120, "kidney"},
    {PhantomTissue::spleen, 120, "spleen"},
}};

constexpr bool inEnumOrder() {
  for (std::size_t i = 0; i < kTissues.size(); ++i) {
    if (kTissues[i].tissue != PhantomTissue(i)) return false;
  }
  return true;
}
static_assert(inEnumOrder());

struct BuiltIn {
  const char* name;
  PhantomTruth truth;
  Index3 size;
  Vec3 spacing_mm;
  double middle_mm;  // of the scan along the body; the head's reaches further below its brain
  bool labelled;
};

constexpr std::string_view kPrefix = "phantom:";
const std::array<BuiltIn, 2> kPhantoms{{
    {"cranium", craniumTissue, {256, 256, 180}, {0.8, 0.8, 1.0}, -5.0, false},
    {"abdomen", abdomenTissue, {256, 256, 160}, {1.4, 1.4, 1.5}, 0.0, true},
}};

Result<const BuiltIn*> findPhantom(const std::string& name) {
  for (const BuiltIn& phantom : kPhantoms) {
    if (name == phantom.name) return &phantom;
  }
  return Error{"UNKNOWN_PHANTOM", "There is no built-in case named '" + name + "'", "phantom",
               "Use cranium or abdomen"};
}

GridGeometry geometryOf(const BuiltIn& phantom) {
  GridGeometry geometry;
  geometry.size = phantom.size;
  geometry.spacing_mm = phantom.spacing_mm;
  for (int axis = 0; axis < 3; ++axis) {
    geometry.origin_mm[axis] = -0.5 * (phantom.size[axis] - 1) * phantom.spacing_mm[axis];
  }
  geometry.origin_mm.z += phantom.middle_mm;
  return geometry;
}

// By tissue; the other tissues have none.
struct LabelRow {
  PhantomTissue tissue;
  std::uint8_t label;
};
constexpr std::array<LabelRow, 5> kLabels{{{PhantomTissue::liver, 1},
                                           {PhantomTissue::capsule, 2},
                                           {PhantomTissue::vessel, 3},
                                           {PhantomTissue::kidney, 4},
                                           {PhantomTissue::spleen, 5}}};

bool isOfTheLiver(PhantomTissue tissue) {
  return tissue == PhantomTissue::liver || tissue == PhantomTissue::capsule ||
         tissue == PhantomTissue::vessel;
}

LabelMap labelsOf(const std::vector<PhantomTissue>& centres, const GridGeometry& geometry) {
  LabelMap map{geometry, std::vector<std::uint8_t>(centres.size())};
  const Index3& size = geometry.size;
  const auto atBorder = [&](int i, int j, int k) {
    for (int c = std::max(k - 1, 0); c <= std::min(k + 1, size[2] - 1); ++c) {
      for (int b = std::max(j - 1, 0); b <= std::min(j + 1, size[1] - 1); ++b) {
        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, size[0] - 1); ++a) {
          if (!isOfTheLiver(centres[geometry.indexOf(a, b, c)])) return true;
        }
      }
    }
    return false;
  };
  onTwoThreads(size[2], [&](int k) {
    std::size_t index = geometry.indexOf(0, 0, k);
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i, ++index) {
        const bool border = centres[index] == PhantomTissue::liver && atBorder(i, j, k);
        map.labels[index] = phantomLabel(border ? PhantomTissue::capsule : centres[index]);
      }
    }
  });
  return map;
}

}  // namespace

std::int16_t phantomHu(PhantomTissue tissue) {
  return kTissues[std::size_t(tissue)].hu;
}
const char* phantomTissueName(PhantomTissue tissue) {
  return kTissues[std::size_t(tissue)].name;
}

Result<PhantomTruth> phantomTruth(const std::string& name) {
  const auto phantom = findPhantom(name);
  if (!phantom) return phantom.error();
  return phantom.value()->truth;
}

std::optional<std::string> phantomNamed(const std::string& case_source) {
  if (!case_source.starts_with(kPrefix)) return std::nullopt;
  return case_source.substr(kPrefix.size());
}

std::vector<std::string> phantomNames() {
  std::vector<std::string> names;
  for (const BuiltIn& phantom : kPhantoms) names.emplace_back(phantom.name);
  return names;
}

std::string phantomSource(const std::string& name) {
  return std::string(kPrefix) + name;
}

Result<GridGeometry> phantomGeometry(const std::string& name) {
  const auto phantom = findPhantom(name);
  if (!phantom) return phantom.error();
  return geometryOf(*phantom.value());
}

std::uint8_t phantomLabel(PhantomTissue tissue) {
  for (const LabelRow& row : kLabels) {
    if (row.tissue == tissue) return row.label;
  }
  return 0;
}

Result<Phantom> makePhantomWithLabels(const std::string& name, const Progress& progress) {
  const auto found = findPhantom(name);
  if (!found) return found.error();
  const BuiltIn& built_in = *found.value();
  Phantom phantom{{geometryOf(built_in), {}}, {}};
  Volume& volume = phantom.volume;
  const std::size_t count = volume.geometry.voxelCount();
  const double needed_mb = voxelsMb(count) + (built_in.labelled ? 2.0 : 1.0) * labelsMb(count);
  if (Status enough = enoughMemory(needed_mb, "Making the built-in case", name); !enough) {
    return enough.error();
  }
  volume.hu.resize(count);
  const auto centres = truthAtCentres(built_in.truth, volume.geometry, progress);
  if (centres.empty() ||
      !paintPhantom(built_in.truth, centres, kPhantomNoiseHu, progress, volume)) {
    return Error{"CANCELLED", "Making the built-in case was cancelled", name, ""};
  }
  if (built_in.labelled) {
    phantom.labels = labelsOf(centres, volume.geometry);
    for (const LabelRow& row : kLabels) {
      const std::string tissue = phantomTissueName(row.tissue);
      phantom.labels->structures.push_back({row.label, tissue, labelColour(row.label), tissue});
    }
  }
  progress.at(1.0, "Making the built-in case");
  return phantom;
}

Result<Volume> makePhantom(const std::string& name, const Progress& progress) {
  Result<Phantom> made = makePhantomWithLabels(name, progress);
  if (!made) return made.error();
  return std::move(made->volume);
}

Volume makePhantomOn(PhantomTruth truth, const GridGeometry& geometry, double noise_hu) {
  Volume volume{geometry, Voxels(geometry.voxelCount())};
  const Progress progress;
  paintPhantom(truth, truthAtCentres(truth, geometry, progress), noise_hu, progress, volume);
  return volume;
}

LabelMap phantomLabelsOn(PhantomTruth truth, const GridGeometry& geometry) {
  return labelsOf(truthAtCentres(truth, geometry, Progress()), geometry);
}

}  // namespace trephine
