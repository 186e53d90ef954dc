// A label map: which structure of a segmentation each voxel belongs to. A plain value.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "volume/volume.h"

namespace trephine {

struct LabelMap {
  GridGeometry geometry;
  std::vector<std::uint8_t> labels;  // i fastest, then j, then k; 0: none
};

// Any volume file. Errors: those of readVolumeFile, and NOT_LABELS where a voxel is no whole number
// from 0 to 255.
Result<LabelMap> readLabelMap(const std::filesystem::path& file);

// A byte a voxel, .mha, .nii or .nii.gz. `reversed_slices`: of the CT's file that it goes beside
// (VolumeFileHeader), so that both are alike voxel by voxel. Errors: those of writeVolume.
Status writeLabelMap(const LabelMap& map, const std::filesystem::path& file,
                     bool reversed_slices = false, const Progress& progress = Progress());

// The label of each voxel of a CT: that of the label map's voxel which its centre lies in, by their
// places in the patient. So a grid that is the same but for flipped or permuted axes comes out
// exactly, another is resampled by nearest neighbour, and what it does not reach has no label.
// Errors: LABELS_ELSEWHERE where it reaches no voxel of the CT.
Result<LabelMap> fitTo(const LabelMap& map, const GridGeometry& ct);

// SHA-256 over the labels, a byte each, i fastest. Geometry is not part of it.
std::string labelsSha256(const LabelMap& map);

}  // namespace trephine
