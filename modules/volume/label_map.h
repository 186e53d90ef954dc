// A label map: which structure of a patient each voxel belongs to. A plain value.
//
// Tissues, landmarks and exercises name a structure; the number that stands for it is of this map
// alone. A voxel is of one structure or of none.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "volume/volume.h"

namespace trephine {

struct Structure {
  int label = 0;         // 1 to 255
  std::string name;      // UTF-8, one of its own in a map: sameName()
  Vec3 colour{1.0};      // r, g, b in [0, 1]
  std::string tissue{};  // the id of what it is made of; empty: not said

  friend bool operator==(const Structure&, const Structure&) = default;
};

struct LabelMap {
  GridGeometry geometry;
  std::vector<std::uint8_t> labels;     // i fastest, then j, then k; 0: none
  std::vector<Structure> structures{};  // what labels stand for, in the order of a list

  // By its name; null: none.
  const Structure* find(const std::string& name) const;
  const Structure* find(int label) const;
};

// A map has no more, so that there is always a label that it does not use.
constexpr int kMostStructures = 250;

// Letters in either case, blanks and underscores alike: "Left_Kidney" is "left kidney". ASCII
// alone; other letters are compared as they are.
bool sameName(const std::string& a, const std::string& b);
// A name as all structures have theirs, from whatever a person or a file calls one: UTF-8 in one
// line, cut at kLongestName bytes. Empty where nothing is left that could be seen.
constexpr std::size_t kLongestName = 200;
std::string structureName(std::string_view text);
// A colour to tell a label from its neighbours, where a file gives none.
Vec3 labelColour(int label);
// The lowest label that neither a structure nor a voxel has; 0: none.
int unusedLabel(const LabelMap& map);

// Gives each label that voxels have and that has no row the name "label 7". In rising order.
void nameTheRest(LabelMap& map);

// The same voxels, without rows of structures that have none.
LabelMap withoutEmpty(LabelMap map);

// The outermost layer of a structure, as a capsule or the outer table is: its voxels whose middle
// lies within `thickness_mm` of its surface, and at least those with one neighbour, of their 26,
// outside, so that no ray passes it. The border of the scan is no surface, nor is that of a
// structure which lies within this one (more than half of whose neighbours are of it). 1 for a
// voxel of the layer.
std::vector<std::uint8_t> shellOf(const LabelMap& map, int label, double thickness_mm);

// Any file of readSegmentation() (segmentation.h), by its errors; of segments that share voxels the
// smaller has them.
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
