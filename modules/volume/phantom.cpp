#include "volume/phantom.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "base/memory.h"
#include "base/tr.h"
#include "volume/case_memory.h"
#include "volume/codes.h"
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
  return Error{code::kUnknownPhantom, tr("There is no built-in case named '{}'", name), "phantom",
               tr("Use cranium or abdomen")};
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

Result<PhantomFrame> phantomFrame(const std::string& name) {
  const auto found = findPhantom(name);
  if (!found) return found.error();
  PhantomFrame frame{geometryOf(*found.value()), found.value()->labelled, {}};
  if (!frame.labelled) return frame;
  for (const LabelRow& row : kLabels) {
    const std::string tissue = phantomTissueName(row.tissue);
    frame.structures.push_back({row.label, tissue, labelColour(row.label), tissue});
  }
  return frame;
}

Result<Phantom> paintNoiseFree(const std::string& name) {
  const auto frame = phantomFrame(name);
  if (!frame) return frame.error();
  const PhantomTruth truth = *phantomTruth(name);
  const std::size_t count = frame->geometry.voxelCount();
  const double needed_mb = voxelsMb(count) + 2.0 * labelsMb(count);
  if (Status enough = enoughMemory(needed_mb, tr("Painting the built-in case"), name); !enough) {
    return enough.error();
  }
  const std::vector<PhantomTissue> centres = truthAtCentres(truth, frame->geometry);
  Phantom phantom{{frame->geometry, Voxels(count)}, {}};
  paintPhantom(truth, centres, phantom.volume);
  if (frame->labelled) {
    phantom.labels = labelsOf(centres, frame->geometry);
    phantom.labels->structures = frame->structures;
  }
  return phantom;
}

Result<Phantom> makePhantom(const std::string& name) {
  Result<Phantom> made = paintNoiseFree(name);
  if (made) addNoise(made->volume, kPhantomNoiseHu);
  return made;
}

Volume makePhantomOn(PhantomTruth truth, const GridGeometry& geometry, double noise_hu) {
  Volume volume{geometry, Voxels(geometry.voxelCount())};
  paintPhantom(truth, truthAtCentres(truth, geometry), volume);
  addNoise(volume, noise_hu);
  return volume;
}

LabelMap phantomLabelsOn(PhantomTruth truth, const GridGeometry& geometry) {
  return labelsOf(truthAtCentres(truth, geometry), geometry);
}

}  // namespace trephine
