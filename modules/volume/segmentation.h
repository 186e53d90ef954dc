// A segmentation as a file has it: structures that may overlap, on a grid of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "volume/label_map.h"
#include "volume/volume.h"

namespace trephine {

struct Segmentation {
  struct Segment {
    std::string name;  // UTF-8; may be empty or given twice
    Vec3 colour{1.0};  // r, g, b in [0, 1]
    std::string tissue{};
    std::size_t layer = 0;   // its voxels are those of this layer
    std::uint8_t value = 1;  // that have this value
  };
  std::string format;                             // "NRRD", "NIfTI", "DICOM SEG", ...
  GridGeometry geometry;                          // right-handed, as that of a volume
  std::vector<std::vector<std::uint8_t>> layers;  // i fastest, then j, then k; 0: none
  std::vector<Segment> segments;                  // in the file's order
  std::vector<std::string> notes{};               // what the file leaves unsaid, sentences
  bool named = true;                              // names are the file's, not numbers alone
};

// Two segments that share voxels.
struct Overlap {
  std::size_t a = 0, b = 0;  // by their places in `segments`, a < b
  std::size_t voxels = 0;
};
std::vector<Overlap> overlaps(const Segmentation& segmentation);

// One label a voxel: where segments share voxels, the one that stands first in `order` (places in
// `segments`, each once) has them. A segment keeps its value as its label where no other has taken
// it; empty names become "label 7", and a name that stands twice becomes "liver 2".
LabelMap merged(const Segmentation& segmentation, const std::vector<std::size_t>& order);
// The smaller over the larger: a vessel over the liver that it runs in.
std::vector<std::size_t> smallerFirst(const Segmentation& segmentation);

// Any volume file whose voxels are whole numbers; .nrrd and .seg.nrrd with the layers, names and
// colours that 3D Slicer gives them; .nii with those of a table of labels in its header. Names of
// other files, and of those without: a sidecar "liver.structures.json" beside "liver.nii.gz"
// (resources/schemas/structures.md), or ITK-SNAP's text of labels, "liver.txt" or "liver.label".
// Numbers above 255 become others that are free, and are named by what they were. A folder: each
// volume file in it is the mask of a structure that is called as the file is. `form`: of a NIfTI
// whose forms contradict one another (volume_files.h). Errors: those of readVolumeFile, NOT_LABELS,
// OTHER_GRID (masks of one folder), TOO_MANY_STRUCTURES (over kMostStructures), BAD_JSON and
// BAD_FIELD (the sidecar), BAD_NAMES (a text of labels).
Result<Segmentation> readSegmentation(const std::filesystem::path& file,
                                      const Progress& progress = Progress(),
                                      const std::string& form = "");

// Its names, colours and tissues are kept: in .nrrd (as 3D Slicer reads them) within, else in a
// sidecar beside it. `reversed_slices`: writeLabelMap(). Errors: those of writeVolume.
Status writeSegmentation(const LabelMap& map, const std::filesystem::path& file,
                         bool reversed_slices = false, const Progress& progress = Progress());
// "liver.structures.json" for "liver.nii.gz".
std::filesystem::path structuresFile(const std::filesystem::path& label_map_file);

}  // namespace trephine
