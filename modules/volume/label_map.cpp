#include "volume/label_map.h"

#include <algorithm>

#include "base/memory.h"
#include "base/sha256.h"
#include "volume/case_memory.h"
#include "volume/volume_files.h"
#include "volume/voxel_slabs.h"

namespace trephine {

namespace {

// Where a centre lies between two voxels, as it does between grids of 1 and 2 mm, rounding must not
// send one to this side and its neighbour to the other. In voxels; more than a float's place is off.
constexpr double kTie = 1e-3;

Error notLabels(const std::string& what, const std::filesystem::path& file) {
  return Error{"NOT_LABELS", what, file.string(),
               "Choose a label map: a whole number from 0 to 255 for each voxel, 0 for none"};
}

}  // namespace

Result<LabelMap> readLabelMap(const std::filesystem::path& file) {
  const Result<VolumeFileReading> read = readVolumeFile(file);
  if (!read) {
    return read.error().code == "NOT_HU" ? notLabels(read.error().what, file) : read.error();
  }
  if (read->rounded + read->not_numbers > 0) {
    return notLabels(std::to_string(read->rounded + read->not_numbers) +
                         " of the voxels are not whole numbers",
                     file);
  }
  if (read->hu_min < 0.0 || read->hu_max > 255.0) {
    constexpr double kMost = 1e15;  // that the number below holds
    const double value = std::clamp(read->hu_min < 0.0 ? read->hu_min : read->hu_max, -kMost, kMost);
    return notLabels("The value " + std::to_string(std::int64_t(value)) + " is no label", file);
  }
  const Voxels& values = read->volume.hu;
  if (Status enough = enoughMemory(labelsMb(values.size()), "The label map", file.string());
      !enough) {
    return enough.error();
  }
  return LabelMap{read->volume.geometry, {values.begin(), values.end()}};
}

Status writeLabelMap(const LabelMap& map, const std::filesystem::path& file, bool reversed_slices,
                     const Progress& progress) {
  VoxelSlabs slabs;
  slabs.geometry = map.geometry;
  slabs.read = [&](std::size_t first, std::span<std::int16_t> into) {
    const auto from = map.labels.begin() + std::ptrdiff_t(first);
    std::copy(from, from + std::ptrdiff_t(into.size()), into.begin());
  };
  return writeVolume(slabs, file, progress, {VoxelType::uint8, reversed_slices});
}

Result<LabelMap> fitTo(const LabelMap& map, const GridGeometry& ct) {
  const GridGeometry& from = map.geometry;
  const Mat4 to_map = from.patientToVoxel() * ct.voxelToPatient();
  const Vec3 step(to_map[0]), size(from.size[0], from.size[1], from.size[2]);
  if (Status enough = enoughMemory(labelsMb(ct.voxelCount()), "The label map", ""); !enough) {
    return enough.error();
  }
  LabelMap fitted{ct, std::vector<std::uint8_t>(ct.voxelCount())};
  std::uint8_t* label = fitted.labels.data();
  bool met = false;
  for (int k = 0; k < ct.size[2]; ++k) {
    for (int j = 0; j < ct.size[1]; ++j) {
      const Vec3 row = Vec3(to_map * glm::dvec4(0, j, k, 1)) + 0.5 + kTie;
      for (int i = 0; i < ct.size[0]; ++i, ++label) {
        const Vec3 v = row + double(i) * step;
        const bool inside = v.x >= 0.0 && v.y >= 0.0 && v.z >= 0.0 && v.x < size.x &&
                            v.y < size.y && v.z < size.z;
        if (!inside) continue;
        *label = map.labels[from.indexOf(int(v.x), int(v.y), int(v.z))];
        met = true;
      }
    }
  }
  if (!met) {
    return Error{"LABELS_ELSEWHERE", "The label map and the case do not overlap in the patient",
                 "the label map", "Choose the label map that was made from this CT"};
  }
  return fitted;
}

std::string labelsSha256(const LabelMap& map) {
  return sha256Hex(map.labels.data(), map.labels.size());
}

}  // namespace trephine
