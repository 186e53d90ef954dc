// Built-in cases: anatomical phantoms from formulas, so that every voxel has a known truth.
//
// A phantom is a function from patient mm to tissue; the volume is that function seen through a
// scanner's point spread, plus Gaussian noise from a fixed seed. The same bits everywhere.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

enum class PhantomTissue : std::uint8_t {
  air,
  scalp,
  outerTable,
  diploe,
  innerTable,
  dura,
  csf,
  greyMatter,
  whiteMatter,
  ventricle,
  eye,
  facialBone,
  skin,
  fat,
  muscle,
  bone,
  marrow,
  capsule,
  liver,
  vessel,
  kidney,
  spleen
};

// Noise-free HU of each tissue, and its name in lower case.
std::int16_t phantomHu(PhantomTissue tissue);
const char* phantomTissueName(PhantomTissue tissue);

// The truth at a point, exact and without noise. `name` is "cranium" or "abdomen".
using PhantomTruth = PhantomTissue (*)(const Vec3& patient_mm);
Result<PhantomTruth> phantomTruth(const std::string& name);
Result<GridGeometry> phantomGeometry(const std::string& name);

// Standard deviation of the noise added to every voxel, HU.
constexpr double kPhantomNoiseHu = 8.0;

// Standard deviation of the Gaussian point spread: on each axis of the grid that many mm, or that
// many voxels where those are coarser (a scanner's slices are as wide as they are far apart).
constexpr double kPhantomSpread_mm = 0.6;
constexpr double kPhantomSpread_voxels = 0.4;

// "cranium" of "phantom:cranium", as exercises, commands and recordings name a built-in case;
// nothing of what is none.
std::optional<std::string> phantomNamed(const std::string& case_source);
std::string phantomSource(const std::string& name);
// "cranium", "abdomen".
std::vector<std::string> phantomNames();

// What voxels and labels of a built-in case hang on: its grid, and the structures of its label map,
// none where it has none. Errors: UNKNOWN_PHANTOM.
struct PhantomFrame {
  GridGeometry geometry;
  bool labelled = false;
  std::vector<Structure> structures;
};
Result<PhantomFrame> phantomFrame(const std::string& name);

// The label of a tissue in a phantom's label map; 0: none. README.md lists them.
std::uint8_t phantomLabel(PhantomTissue tissue);

struct Phantom {
  Volume volume;
  std::optional<LabelMap> labels;  // of the same geometry; none of the cranium
};

// A built-in case's voxels before noise: int16 eighths of HU in `hu`; and its labels.
// Ten seconds of processor, on two threads: programs open what the build painted (phantom_file.h).
// Errors: UNKNOWN_PHANTOM; OUT_OF_MEMORY.
Result<Phantom> paintNoiseFree(const std::string& name);
// The same with noise, in HU.
Result<Phantom> makePhantom(const std::string& name);

// Eighths of HU become HU: noise of that standard deviation is added to each voxel, by the hash of
// its index, and what a scanner cannot store is clamped. On two threads; the same bits everywhere.
void addNoise(Volume& eighths, double noise_hu);

// The same truth on any other grid (coarser, finer, oblique): tests and measurements.
Volume makePhantomOn(PhantomTruth truth, const GridGeometry& geometry, double noise_hu);
// Its labels at the voxels' centres. The capsule is a closed layer instead, since a membrane of a
// millimetre misses many centres: wherever liver has a neighbour, of its 26, that is neither liver
// nor capsule nor vessel, it is capsule as well.
LabelMap phantomLabelsOn(PhantomTruth truth, const GridGeometry& geometry);

}  // namespace trephine
