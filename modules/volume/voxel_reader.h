// Stored voxels -> HU, for every format: bytes as they lie in the file or packed by zlib, of any
// type and byte order. For this room's .cpp files only.
#pragma once

#include "volume/volume_files.h"

namespace trephine::file_format {

// The first bytes, at most `most`, of a file or of what it unpacks to.
std::string unpackedStart(const std::filesystem::path& file, bool packed, std::size_t most);

// `file` is what errors name. Errors: readVolumeFile's own.
Result<VolumeFileReading> readVoxels(VolumeFileHeader header, const std::filesystem::path& file,
                                     const Progress& progress);

}  // namespace trephine::file_format
