// What the formats' files share. For this room's .cpp files only.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "volume/volume_files.h"

namespace trephine::file_format {

// ---- The formats: a header with all but what settle() and placeVoxels() add; see volume_files.h.
Result<VolumeFileHeader> readMetaImageHeader(const std::filesystem::path& file);
Result<VolumeFileHeader> readNiftiHeader(const std::filesystem::path& file);
Result<VolumeFileHeader> readNrrdHeader(const std::filesystem::path& file);
// `file` is the .raw or its sidecar.
Result<VolumeFileHeader> readRawHeader(const std::filesystem::path& file);
// The file of that name with this ending, or with it in capitals; nothing where neither is there.
std::optional<std::filesystem::path> sibling(const std::filesystem::path& file,
                                             const std::string& ending);

// To `temporary`, for a grid that was checked; `type` is int16 or uint8; errors name `target`. What
// is cancelled ends early with any answer.
Status writeMetaImage(const VoxelSlabs& voxels, VoxelType type,
                      const std::filesystem::path& temporary, const std::filesystem::path& target,
                      const Progress& progress);
Status writeNifti(const VoxelSlabs& voxels, VoxelType type, const std::filesystem::path& temporary,
                  const std::filesystem::path& target, const Progress& progress);
// The voxels of a slab as they go to a file: `narrow` holds those that are bytes there.
std::span<const std::byte> storedAs(VoxelType type, std::span<const std::int16_t> slab,
                                    std::vector<std::byte>& narrow);

// ---- Errors, by code.
Error unreadable(const std::string& what, const std::filesystem::path& file);
Error badGeometry(const std::string& what, const std::filesystem::path& file);
Error notHu(const std::string& what, const std::filesystem::path& file);
Error unknownFormat(const std::string& what, const std::filesystem::path& file,
                    const std::string& next);
// UNREADABLE: more is there than voxels, `by` so many bytes (with a blank behind) or empty.
Error longerThanSaid(const VolumeFileHeader& header, const std::string& by,
                     const std::filesystem::path& file);
Error cannotWrite(const std::filesystem::path& file);

// ---- Geometry.
// Three sizes as a header has them; UNREADABLE or TOO_LARGE.
Result<Index3> sizeFrom(const std::vector<double>& sizes, const std::filesystem::path& file);
// Splits a voxel-to-LPS matrix into spacing, direction and origin.
GridGeometry geometryFrom(const Mat4& affine, const Index3& size);
// Positive spacings, axes at right angles and of unit length, all finite; else BAD_GEOMETRY.
Status checkGeometry(const GridGeometry& geometry, const std::filesystem::path& file);
bool leftHanded(const GridGeometry& geometry);
// The first voxel of the last slice becomes the origin; the voxels themselves are left.
void turnSliceAxis(GridGeometry& geometry);
// The same volume with its slices in the opposite order.
void reverseSlices(Volume& volume);

// ---- Where the voxels are.
// The file that a header names, which has to lie in the header's folder: a header from elsewhere
// must not lead to other files of this machine. UNREADABLE or MISSING_FILE.
Result<std::filesystem::path> fileBeside(const std::filesystem::path& header,
                                         const std::string& name);
// Completes the header: `data.file`, `data.packed`, `data.skip`, type and geometry are set. Voxels
// start at `offset`, or, with nothing there, end where the file ends, and begin at `earliest` or
// behind it. UNREADABLE where the file is too short to hold them, or longer than they are.
Status placeVoxels(VolumeFileHeader& header, std::optional<std::uint64_t> offset,
                   const std::filesystem::path& file, std::uint64_t earliest = 0);
// Checks the geometry as the file has it and makes it right-handed.
Status settle(VolumeFileHeader& header, const std::filesystem::path& file);

// ---- Text.
// The file's first bytes, at most `most`; UNREADABLE where it cannot be opened.
Result<std::string> readStart(const std::filesystem::path& file, std::size_t most);
std::string trimmed(std::string_view text);
std::string lowerCase(std::string_view text);
bool endsWith(const std::filesystem::path& file, std::string_view ending);  // in either case
// A decimal number and nothing else.
std::optional<double> numberIn(std::string_view text);
// Numbers with blanks between; nothing where any of them is none.
std::optional<std::vector<double>> numbersIn(std::string_view text);
// A few letters of what a file holds, for a sentence: nothing in it that a screen could trip over.
std::string shown(std::string_view text);

}  // namespace trephine::file_format
