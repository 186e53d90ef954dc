#include "volume/phantom_file.h"

#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <new>
#include <vector>

#include "base/codes.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/system.h"
#include "base/tr.h"
#include "volume/case_memory.h"
#include "volume/codes.h"
#include "volume/two_threads.h"

namespace trephine {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr char kMagic[] = "TREPCASE";
constexpr std::size_t kMagicSize = sizeof kMagic - 1, kLengthSize = 4;
constexpr int kBlockSlices = 8;
constexpr std::size_t kMostBytes = std::size_t{64} << 20;
constexpr const char* kStep = trLater("Opening the built-in case");

Error damaged(const std::filesystem::path& file) {
  return {code::kDamaged, tr("The file of the built-in case is damaged"), file.string(),
          tr("Install Trephine again")};
}

// The slices of a block, and where its voxels are.
struct Block {
  int first_slice = 0, slices = 0;
  std::size_t first = 0, count = 0;
};
std::vector<Block> blocksOf(const GridGeometry& geometry) {
  std::vector<Block> blocks;
  for (int k = 0; k < geometry.size[2]; k += kBlockSlices) {
    const int slices = std::min(kBlockSlices, geometry.size[2] - k);
    blocks.push_back({k, slices, geometry.indexOf(0, 0, k), geometry.indexOf(0, 0, slices)});
  }
  return blocks;
}

// What the neighbours before a voxel, in its row, column and slice, predict for it by their
// gradients. `at` is the voxel; those beyond the block count as 0. Wraps around, as its use does.
struct Predictor {
  std::size_t nx, nxy;

  std::uint16_t of(const std::int16_t* at, bool i, bool j, bool k) const {
    const auto seen = [&](bool there, std::size_t back) {
      return there ? std::uint16_t(*(at - back)) : std::uint16_t(0);
    };
    return std::uint16_t(seen(i, 1) + seen(j, nx) + seen(k, nxy) - seen(i && j, 1 + nx) -
                         seen(i && k, 1 + nxy) - seen(j && k, nx + nxy) +
                         seen(i && j && k, 1 + nx + nxy));
  }
};

// Calls visit(n, prediction) for each voxel of a block, in order; `voxels` are the block's. visit
// may write voxel n.
template <class Visit>
void predicted(const GridGeometry& geometry, int slices, const std::int16_t* voxels,
               const Visit& visit) {
  const auto nx = std::size_t(geometry.size[0]), ny = std::size_t(geometry.size[1]);
  const Predictor predictor{nx, nx * ny};
  std::size_t n = 0;
  for (int k = 0; k < slices; ++k) {
    for (std::size_t j = 0; j < ny; ++j) {
      visit(n, predictor.of(voxels + n, false, j > 0, k > 0));
      ++n;
      if (j == 0 || k == 0) {
        for (std::size_t i = 1; i < nx; ++i, ++n) {
          visit(n, predictor.of(voxels + n, true, j > 0, k > 0));
        }
      } else {  // most voxels by far
        for (std::size_t i = 1; i < nx; ++i, ++n) {
          visit(n, predictor.of(voxels + n, true, true, true));
        }
      }
    }
  }
}

// Empty for want of memory.
Bytes packed(const Bytes& bytes) {
  Bytes out(compressBound(uLong(bytes.size())));
  uLongf size = uLongf(out.size());
  if (compress2(out.data(), &size, bytes.data(), uLong(bytes.size()), Z_BEST_COMPRESSION) != Z_OK) {
    return {};
  }
  out.resize(size);
  return out;
}

bool unpack(const std::uint8_t* from, std::size_t size, Bytes& into) {
  uLongf got = uLongf(into.size());
  return uncompress(into.data(), &got, from, uLong(size)) == Z_OK && got == into.size();
}

Bytes packedBlock(const GridGeometry& geometry, const Block& block, const std::int16_t* voxels) {
  Bytes bytes(2 * block.count);
  predicted(geometry, block.slices, voxels, [&](std::size_t n, std::uint16_t prediction) {
    const auto rest = std::uint16_t(std::uint16_t(voxels[n]) - prediction);
    bytes[n] = std::uint8_t(rest);
    bytes[block.count + n] = std::uint8_t(rest >> 8);
  });
  return packed(bytes);
}

bool unpackBlock(const GridGeometry& geometry, const Block& block, const std::uint8_t* from,
                 std::size_t size, std::int16_t* voxels) {
  Bytes bytes(2 * block.count);
  if (!unpack(from, size, bytes)) return false;
  predicted(geometry, block.slices, voxels, [&](std::size_t n, std::uint16_t prediction) {
    const auto rest = std::uint16_t(bytes[n] | bytes[block.count + n] << 8);
    voxels[n] = std::int16_t(std::uint16_t(prediction + rest));
  });
  return true;
}

// Where the blocks of a file are; empty unless there are `count` and nothing else.
struct Part {
  std::size_t at = 0, size = 0;
};
std::vector<Part> partsOf(const std::string& file, std::size_t count) {
  if (file.size() < kMagicSize || std::memcmp(file.data(), kMagic, kMagicSize) != 0) return {};
  std::vector<Part> parts;
  std::size_t at = kMagicSize;
  while (parts.size() < count && file.size() - at >= kLengthSize) {
    std::size_t size = 0;
    for (std::size_t n = 0; n < kLengthSize; ++n) {
      size |= std::size_t(std::uint8_t(file[at + n])) << (8 * n);
    }
    at += kLengthSize;
    if (file.size() - at < size) return {};
    parts.push_back({at, size});
    at += size;
  }
  return parts.size() == count && at == file.size() ? parts : std::vector<Part>();
}

const std::uint8_t* bytesAt(const std::string& file, std::size_t at) {
  return reinterpret_cast<const std::uint8_t*>(file.data()) + at;
}

Result<Phantom> unpacked(const PhantomFrame& frame, const std::string& bytes,
                         const std::filesystem::path& file, const std::string& name,
                         const Progress& progress) {
  const std::vector<Block> blocks = blocksOf(frame.geometry);
  const std::vector<Part> parts = partsOf(bytes, blocks.size() + 1);
  if (parts.empty()) return damaged(file);
  Phantom phantom{{frame.geometry, Voxels(frame.geometry.voxelCount())}, {}};
  std::atomic<bool> whole{true}, starved{false};
  onTwoThreads(int(blocks.size()), [&](int n) {
    if (!whole || starved || progress.cancelled()) return;
    const auto& block = blocks[std::size_t(n)];
    const Part& part = parts[std::size_t(n)];
    try {
      if (!unpackBlock(frame.geometry, block, bytesAt(bytes, part.at), part.size,
                       &phantom.volume.hu[block.first])) {
        whole = false;
      }
    } catch (const std::bad_alloc&) {
      starved = true;
    }
  });
  if (progress.cancelled()) {
    return Error{code::kCancelled, tr("Opening the built-in case was cancelled"), name, ""};
  }
  if (starved) return outOfMemory(tr("for the built-in case"), name);
  const Part& labels = parts.back();
  if (!whole || (labels.size > 0) != frame.labelled) return damaged(file);
  if (frame.labelled) {
    LabelMap map{frame.geometry, Bytes(frame.geometry.voxelCount()), frame.structures};
    if (!unpack(bytesAt(bytes, labels.at), labels.size, map.labels)) return damaged(file);
    phantom.labels = std::move(map);
  }
  progress.at(0.6, tr(kStep));
  addNoise(phantom.volume, kPhantomNoiseHu);
  return phantom;
}

}  // namespace

std::filesystem::path phantomFile(const std::string& name) {
  return builtInFolder() / (name + ".case");
}

Status writePhantomFile(const std::string& name, const std::filesystem::path& file) {
  const Result<Phantom> painted = paintNoiseFree(name);
  if (!painted) return painted.error();
  const GridGeometry& geometry = painted->volume.geometry;
  const std::vector<Block> blocks = blocksOf(geometry);
  std::vector<Bytes> parts(blocks.size() + 1);
  onTwoThreads(int(parts.size()), [&](int n) {
    if (std::size_t(n) < blocks.size()) {
      const Block& block = blocks[std::size_t(n)];
      parts[std::size_t(n)] = packedBlock(geometry, block, &painted->volume.hu[block.first]);
    } else if (painted->labels) {
      parts[std::size_t(n)] = packed(painted->labels->labels);
    }
  });
  std::string text(kMagic, kMagicSize);
  for (const Bytes& part : parts) {
    const bool none = &part == &parts.back() && !painted->labels;
    if (part.empty() && !none) return outOfMemory(tr("to pack the built-in case"), name);
    for (std::size_t n = 0; n < kLengthSize; ++n) text += char(part.size() >> (8 * n) & 0xff);
    text.append(part.begin(), part.end());
  }
  return writeTextFile(file, text);
}

Result<Phantom> readPhantomFile(const std::string& name, const std::filesystem::path& file,
                                const Progress& progress) {
  const Result<PhantomFrame> frame = phantomFrame(name);
  if (!frame) return frame.error();
  progress.at(0.0, tr(kStep));
  const std::size_t count = frame->geometry.voxelCount();
  const double needed_mb = voxelsMb(count) + (frame->labelled ? labelsMb(count) : 0.0);
  if (Status enough = enoughMemory(needed_mb, tr(kStep), name); !enough) return enough.error();
  try {
    const Result<std::string> bytes = readWholeFile(file, kMostBytes);
    if (!bytes) {
      return Error{code::kCannotRead, tr("The file of the built-in case cannot be read"),
                   file.string(), tr("Install Trephine again")};
    }
    Result<Phantom> phantom = unpacked(*frame, *bytes, file, name, progress);
    if (phantom) progress.at(1.0, tr(kStep));
    return phantom;
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the built-in case"), name);
  }
}

Result<Phantom> openPhantom(const std::string& name, const Progress& progress) {
  return readPhantomFile(name, phantomFile(name), progress);
}

}  // namespace trephine
