// The text header of a MetaImage, which VTK 9.1 reads and writes without the direction.
//
// `TransformMatrix` holds the unit i, j and k axes one after another (the direction's columns), as
// ITK and 3D Slicer write it; `Offset` is the centre of the first voxel. Both are LPS.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "base/result.h"
#include "volume/volume.h"

namespace trephine {

struct MetaImageHeader {
  GridGeometry geometry;  // as written: not yet checked for right angles
  int bytes_per_voxel = 2;
  bool big_endian = false;
  bool compressed = false;        // with zlib
  std::filesystem::path data;     // the file with the voxels: this one, or one beside it
  std::uint64_t data_offset = 0;  // where they start in it
  std::uint64_t data_bytes = 0;   // how many bytes there are
  double slope = 1.0;             // HU = slope * stored + intercept
  double intercept = 0.0;
};

// Errors: UNREADABLE, BAD_GEOMETRY (no spacing), NOT_HU (a type that is no whole number, or several
// values a voxel), TOO_LARGE, UNKNOWN_FORMAT (text voxels, a list of data files), MISSING_FILE (the
// data file).
Result<MetaImageHeader> readMetaImageHeader(const std::filesystem::path& file);

// The checksum that ends the zlib stream of a compressed image (RFC 1950), or nothing where its
// voxels do not start as such a stream does.
std::optional<std::uint32_t> readAdler32(const MetaImageHeader& header);

// The header of a .mha with little-endian int16 voxels behind it. Numbers keep all their digits.
std::string metaImageHeaderText(const GridGeometry& geometry);

}  // namespace trephine
