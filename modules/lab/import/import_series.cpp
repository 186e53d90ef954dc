#include "lab/import/import_series.h"

#include <algorithm>

#include "base/codes.h"
#include "imaging/dicom/ct_writer.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

constexpr Vec3 kExtent_mm{230.0, 230.0, 180.0};
constexpr std::uint64_t kMostVoxels = std::uint64_t(1) << 28;
// The writer stores HU from here up as unsigned words, with any that is lower all as signed ones.
constexpr std::int16_t kLowestUnsigned = -1024;

// Each voxel of a phantom of half the size eight times, plus a few HU, so that no row or slice is
// like its neighbour: one out of its place is noticed.
Volume makeHead(const Index3& size) {
  const Volume half =
      makePhantomOn(*phantomTruth("cranium"),
                    headGeometry({(size[0] + 1) / 2, (size[1] + 1) / 2, (size[2] + 1) / 2}), 0.0);
  Volume head{headGeometry(size), {}};
  head.hu.resize(head.geometry.voxelCount());
  auto hu = head.hu.begin();
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        *hu++ = std::int16_t(half.at(i / 2, j / 2, k / 2) + ((7 * i + 5 * j + 3 * k) & 31));
      }
    }
  }
  return head;
}

}  // namespace

Status checkSeriesSize(const Index3& size) {
  std::uint64_t voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] < 2 || size[axis] > 2048) voxels = kMostVoxels;
    voxels *= std::uint64_t(std::clamp(size[axis], 2, 2048));
  }
  if (voxels <= kMostVoxels) return {};
  return Error{code::kBadArgument,
               "A series has 2 to 2048 voxels along an edge, and 2^28 (512 MB) in all", "size", ""};
}

GridGeometry headGeometry(const Index3& size) {
  GridGeometry g;
  g.size = size;
  for (int axis = 0; axis < 3; ++axis) {
    g.spacing_mm[axis] = kExtent_mm[axis] / size[axis];
    g.origin_mm[axis] = -0.5 * (size[axis] - 1) * g.spacing_mm[axis];
  }
  return g;
}

Result<std::vector<KnownVolume>> writeOwnSeries(const ImportSeries& series,
                                                const std::filesystem::path& folder,
                                                const Progress& progress) {
  progress.at(0.0, "Making the phantom");
  if (progress.cancelled()) return Error{code::kCancelled, "The measurement was cancelled", "", ""};
  const double parts = double(series.names.size()) + 2.0;
  double from = 1.0 / parts;
  std::vector<KnownVolume> known;
  Volume head = makeHead(series.size);
  for (const std::string& name : series.names) {
    head.hu.front() = std::int16_t(name == "int16" ? kLowestUnsigned - 1 : kLowestUnsigned);
    known.push_back({head.geometry, volumeSha256(head)});
    const Progress part(progress, from, from + 1.0 / parts);
    const Status written = writeCtSeries(head, {name, "HEAD"}, folder / name, part);
    if (!written) return written.error();
    from += 1.0 / parts;
  }
  head = makeHead({64, 64, series.scan_slices});
  for (int n = 0; n < series.scan_series; ++n) {
    const std::string name = "scan " + std::to_string(n + 1);
    const double each = (1.0 - from) / series.scan_series;
    const Progress part(progress, from + n * each, from + (n + 1) * each);
    const Status written =
        writeCtSeries(head, {name, "HEAD"}, folder / "scan" / std::to_string(n + 1), part);
    if (!written) return written.error();
  }
  return known;
}

}  // namespace trephine
