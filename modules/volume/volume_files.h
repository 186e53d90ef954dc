// Volumes as files, with the full voxel-to-patient affine: MetaImage, NIfTI, NRRD, raw voxels.
//
// Patients are LPS here. MetaImage is LPS; NIfTI is RAS; NRRD says which it is; a raw file's
// sidecar is LPS (resources/schemas/raw.md). Each is converted in its own file of this room and
// nowhere else. Direction comes out right-handed: the slices of a left-handed file are reversed,
// and every voxel stays where it was in the patient.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "volume/volume.h"
#include "volume/voxel_slabs.h"

namespace trephine {

enum class VoxelType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };
const char* voxelTypeName(VoxelType type);  // "int16"
int bytesOf(VoxelType type);

// What a file says of itself, without its voxels.
struct VolumeFileHeader {
  std::string format;            // "MetaImage", "NIfTI", "NRRD" or "raw"
  GridGeometry geometry;         // of the volume that comes out
  bool reversed_slices = false;  // the file is left-handed: its last slice comes out first
  VoxelType type = VoxelType::int16;
  bool big_endian = false;
  double slope = 1.0;  // HU = slope * stored + intercept
  double intercept = 0.0;
  std::vector<std::string> notes;  // what the file leaves unsaid, and what is taken instead

  // A NIfTI says in up to three ways how it lies in the patient: by its sform, its qform and its
  // pixdim. Where these contradict one another by over a tenth of a voxel at any corner: what can be
  // chosen, "sform" first, and the contradiction as a sentence. `geometry` is that of the first.
  struct Form {
    std::string name;
    GridGeometry geometry;
    bool reversed_slices = false;
  };
  std::vector<Form> forms;  // empty: there is no doubt
  std::string contradiction;
  // Of a NRRD of segments: so many values a voxel, one after another (segmentation.h reads those,
  // readVolumeFile() one alone), and what 3D Slicer says of them, by its keys ("Segment0_Name"); by
  // the same keys the table of labels of a NIfTI.
  int layers = 1;
  std::map<std::string, std::string> segments;

  // Where the voxels lie: `bytes` bytes of `file` from `offset`, unpacked by zlib if `packed`, less
  // the first `skip` of what comes out.
  struct {
    std::filesystem::path file;  // this one, or one beside it
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
    bool packed = false;
    std::uint64_t skip = 0;
  } data;

  std::uint64_t storedBytes() const {
    return geometry.voxelCount() * std::uint64_t(layers) * std::uint64_t(bytesOf(type));
  }
};

// A volume and what was done to its values. Values are HU as the file's slope and intercept give
// them, rounded to the nearest whole HU (halves up).
struct VolumeFileReading {
  VolumeFileHeader header;
  Volume volume;
  std::uint64_t rounded = 0;      // voxels that were not whole numbers
  std::uint64_t clamped = 0;      // beyond int16: set to its end
  std::uint64_t not_numbers = 0;  // NaN or infinite: set to kAirHu
  bool bytes_exchanged = false;   // two bytes each, in another order than the header says
  double hu_min = 0.0;            // of all that are numbers, before rounding and clamping
  double hu_max = 0.0;
};

// By name, in either case: .mha, .mhd, .nii, .nii.gz, .nrrd, .nhdr, .raw; and a .json beside which
// a .raw of the same name lies.
bool isVolumeFile(const std::filesystem::path& file);
// The file beside it that stands for the same volume: for a raw file's sidecar the raw file, for
// voxels without a sidecar the .mhd or .nhdr of the same name.
std::optional<std::filesystem::path> fileItBelongsTo(const std::filesystem::path& file);

// Chooses the format by name. Reads headers only. Sizes are held against the file's length, so a
// header that promises too much is refused here. Errors: MISSING_FILE, UNKNOWN_FORMAT (also a
// variant of a format that is not read, by name), UNREADABLE, BAD_GEOMETRY (no place or no axes,
// axes that are not at right angles, a spacing that is not positive), TOO_LARGE, NOT_HU (several
// values a voxel), NO_SIDECAR, BAD_JSON and BAD_FIELD (a raw file's sidecar).
Result<VolumeFileHeader> readVolumeFileHeader(const std::filesystem::path& file);

// The header as one of its forms has it. Errors: FORMS_DIFFER where there are several and `form` is
// none of them; its `next` names them.
Result<VolumeFileHeader> inForm(VolumeFileHeader header, const std::string& form,
                                const std::filesystem::path& file);

// Memory is taken as voxels arrive, not as the header promises. `form`: of a header with several.
// Errors: the header's, those of inForm(), and UNREADABLE (cut short, or packed voxels that are
// damaged), NOT_HU (over half of the voxels are beyond int16, or none is a number), CANCELLED.
Result<VolumeFileReading> readVolumeFile(const std::filesystem::path& file,
                                         const Progress& progress = Progress(),
                                         const std::string& form = "");

// The volume alone.
Result<Volume> readVolume(const std::filesystem::path& file, const Progress& progress = Progress(),
                          const std::string& form = "");

// How voxels are written: as int16, or as uint8 where all are 0 to 255; with slices in the order of
// a left-handed file, so that an image goes beside that file voxel by voxel.
struct VolumeWriting {
  VoxelType type = VoxelType::int16;
  bool reversed_slices = false;  // VolumeFileHeader's
};

// .mha (uncompressed), .nii or .nii.gz by extension; written beside the target and renamed, so a
// full disk loses nothing. NIfTI keeps the affine as float; .nii.gz is packed on two threads, the
// same bytes for the same volume. Errors: UNKNOWN_FORMAT, BAD_GEOMETRY, BAD_SIZE, TOO_LARGE,
// CANNOT_WRITE.
// checkVolumeFileName says before a long run whether the name can be written at all.
Status checkVolumeFileName(const std::filesystem::path& file);
// Cancelled in between, it ends at once and nothing was written: CANCELLED.
Status writeVolume(const VoxelSlabs& voxels, const std::filesystem::path& file,
                   const Progress& progress = Progress(), const VolumeWriting& writing = {});
Status writeVolume(const Volume& volume, const std::filesystem::path& file);

}  // namespace trephine
