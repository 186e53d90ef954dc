// The built-in cases as files. Painting one takes ten seconds of processor, so the build paints each
// once (paint_cases) and the programs open what it wrote.
//
// A file holds the noise-free voxels in eighths of HU and the labels. Noise is a hash of a voxel's
// number, which zlib cannot pack; it is added when the file is opened. Layout, whole numbers little
// endian: the eight bytes "TREPCASE", then blocks, each a 32-bit length and that many bytes of zlib:
// the voxels of kBlockSlices slices a block, then one block of labels, empty for a case without.
// A voxel is stored as its difference from what its neighbours' gradients predict, the low bytes of
// a block before the high ones.
#pragma once

#include <filesystem>
#include <string>

#include "base/progress.h"
#include "base/result.h"
#include "volume/phantom.h"

namespace trephine {

// Where the build puts them and programs find them: NAME.case in builtInFolder().
std::filesystem::path phantomFile(const std::string& name);

// Paints the case and writes its file, as one or not at all. `name` is "cranium" or "abdomen".
// Errors: UNKNOWN_PHANTOM, OUT_OF_MEMORY, CANNOT_WRITE.
Status writePhantomFile(const std::string& name, const std::filesystem::path& file);

// The case in `file`: the voxels, labels and structures that makePhantom() makes, bit for bit. On
// two threads. Errors: UNKNOWN_PHANTOM, CANNOT_READ, DAMAGED, OUT_OF_MEMORY, and CANCELLED when
// `progress` says so.
Result<Phantom> readPhantomFile(const std::string& name, const std::filesystem::path& file,
                                const Progress& progress = Progress());

// readPhantomFile() of phantomFile().
Result<Phantom> openPhantom(const std::string& name, const Progress& progress = Progress());

}  // namespace trephine
