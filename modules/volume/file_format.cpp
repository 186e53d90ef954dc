#include "volume/file_format.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <system_error>

#include "base/codes.h"
#include "base/descriptor.h"
#include "base/formatted.h"
#include "base/tr.h"
#include "volume/codes.h"

namespace trephine::file_format {

namespace fs = std::filesystem;

namespace {

// zlib and gzip cannot shrink data further than this, so a small file with a huge size is a lie.
constexpr double kMostCompression = 1040.0;

// From 5 micrometres (a scan of a specimen) to a metre; beyond, a unit was mistaken.
constexpr double kSmallestVoxel_mm = 5e-3, kLargestVoxel_mm = 1e3, kFarthest_mm = 1e6;

constexpr std::string_view kBlanks = " \t\r\n";

}  // namespace

std::span<const std::byte> storedAs(VoxelType type, std::span<const std::int16_t> slab,
                                    std::vector<std::byte>& narrow) {
  if (type != VoxelType::uint8) return std::as_bytes(slab);
  narrow.resize(slab.size());
  std::transform(slab.begin(), slab.end(), narrow.begin(),
                 [](std::int16_t value) { return std::byte(value); });
  return narrow;
}

Error unreadable(const std::string& what, const fs::path& file) {
  return Error{code::kUnreadable, what, file.string(), tr("Copy or export the file again")};
}

Error badGeometry(const std::string& what, const fs::path& file) {
  return Error{code::kBadGeometry, what, file.string(),
               tr("Export it again with its orientation, position and voxel size")};
}

Error notHu(const std::string& what, const fs::path& file) {
  return Error{code::kNotHu, what, file.string(),
               tr("Export the CT as 16-bit whole numbers in HU")};
}

Error unknownFormat(const std::string& what, const fs::path& file, const std::string& next) {
  return Error{code::kUnknownFormat, what, file.string(), next};
}

Error cannotWrite(const fs::path& file) {
  return Error{code::kCannotWrite, tr("The volume could not be written"), file.string(),
               tr("Check free space and that you may write there; nothing that was there is lost")};
}

Result<Index3> sizeFrom(const std::vector<double>& sizes, const fs::path& file) {
  Index3 size{};
  if (sizes.size() != size.size())
    return unreadable(tr("The image's size is not three numbers"), file);
  for (std::size_t axis = 0; axis < size.size(); ++axis) {
    const double n = sizes[axis];
    if (!(n >= 1.0) || n != std::floor(n)) {
      return unreadable(tr("The image's size is not three positive whole numbers"), file);
    }
    size[axis] = std::int32_t(std::min(n, double(std::numeric_limits<std::int32_t>::max())));
  }
  if (auto status = checkSize(size, file.string()); !status) return status.error();
  return size;
}

GridGeometry geometryFrom(const Mat4& affine, const Index3& size) {
  GridGeometry geometry;
  geometry.size = size;
  geometry.origin_mm = Vec3(affine[3]);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 column(affine[axis]);
    geometry.spacing_mm[axis] = glm::length(column);
    geometry.direction[axis] = column / geometry.spacing_mm[axis];
  }
  return geometry;
}

Status checkGeometry(const GridGeometry& geometry, const fs::path& file) {
  const Mat3& d = geometry.direction;
  for (int axis = 0; axis < 3; ++axis) {
    const double spacing = geometry.spacing_mm[axis];
    if (!(spacing >= kSmallestVoxel_mm && spacing <= kLargestVoxel_mm)) {
      return badGeometry(tr("A voxel size of {} mm is not possible", formatted("%g", spacing)),
                         file);
    }
    const double length = glm::length(d[axis]), dot = glm::dot(d[axis], d[(axis + 1) % 3]);
    // Also false for anything not finite.
    if (!(std::abs(length - 1.0) < 1e-3 && std::abs(dot) < 1e-3)) {
      return badGeometry(tr("The image's axes are not at right angles or not of unit length"),
                         file);
    }
  }
  if (!isFinite(geometry.origin_mm))
    return badGeometry(tr("The image's position is no number"), file);
  if (glm::length(geometry.origin_mm) > kFarthest_mm) {
    return badGeometry(tr("The image lies over a kilometre from the scanner's middle"), file);
  }
  return {};
}

bool leftHanded(const GridGeometry& geometry) {
  return glm::determinant(geometry.direction) < 0.0;
}

void turnSliceAxis(GridGeometry& geometry) {
  geometry.origin_mm = geometry.toPatient_mm({0, 0, geometry.size[2] - 1});
  geometry.direction[2] = -geometry.direction[2];
}

void reverseSlices(Volume& volume) {
  const Index3& size = volume.geometry.size;
  const auto slice = std::ptrdiff_t(size[0]) * size[1];
  for (int low = 0, high = size[2] - 1; low < high; ++low, --high) {
    std::swap_ranges(volume.hu.begin() + low * slice, volume.hu.begin() + (low + 1) * slice,
                     volume.hu.begin() + high * slice);
  }
}

Status settle(VolumeFileHeader& header, const fs::path& file) {
  if (auto status = checkGeometry(header.geometry, file); !status) return status;
  header.reversed_slices = leftHanded(header.geometry);
  if (header.reversed_slices) turnSliceAxis(header.geometry);
  return {};
}

Result<fs::path> fileBeside(const fs::path& header, const std::string& name) {
  std::error_code ec;
  const fs::path folder = fs::canonical(fs::absolute(header, ec).parent_path(), ec);
  const fs::path found = fs::weakly_canonical(folder / name, ec);  // symbolic links followed
  if (ec || found.parent_path() != folder) {
    return Error{code::kUnreadable, tr("The header leads to voxels outside of its own folder"),
                 header.string(),
                 tr("Put both files into one folder and name the data file there")};
  }
  if (!fs::is_regular_file(found, ec)) {
    return Error{code::kMissingFile, tr("The file with the voxels is not beside the header"),
                 (header.parent_path() / name).string(),
                 tr("Keep the header and its data file together")};
  }
  return header.parent_path() / name;
}

namespace {

// A large file of which next to nothing lies on the disk: made at its full length and never filled,
// or not copied to its end. A file system that knows no holes says that all of it is data.
bool isMostlyHoles(const fs::path& file) {
  constexpr off_t kLarge = off_t(1) << 30;
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status {};
  bool holes = opened.ok() && ::fstat(opened.get(), &status) == 0 && status.st_size > kLarge;
  const off_t enough = status.st_size / 100;
  off_t held = 0;
  for (off_t at = 0; holes && held < enough;) {
    const off_t data = ::lseek(opened.get(), at, SEEK_DATA);
    if (data < 0) {
      holes = errno == ENXIO;  // none any more
      break;
    }
    at = ::lseek(opened.get(), data, SEEK_HOLE);
    if (at <= data) holes = false;
    held += at - data;
  }
  return holes && held < enough;
}

}  // namespace

Error longerThanSaid(const VolumeFileHeader& header, const std::string& by, const fs::path& file) {
  const bool beside = header.data.file != file;
  Error error =
      unreadable(tr("{}{}longer than its header says: where its voxels begin is not sure",
                    (beside ? tr("The file with the voxels is ") : tr("The file is ")), by),
                 header.data.file);
  error.next = beside ? tr("Say in the header how many bytes to skip, or export it again")
                      : tr("Export it again, or correct the size or the offset in its header");
  return error;
}

Status placeVoxels(VolumeFileHeader& header, std::optional<std::uint64_t> offset,
                   const fs::path& file, std::uint64_t earliest) {
  std::error_code ec;
  const std::uint64_t all = fs::file_size(header.data.file, ec);
  if (ec) return unreadable(tr("The file with the voxels cannot be read"), header.data.file);
  const std::uint64_t stored = header.storedBytes();
  const std::uint64_t start = offset ? *offset : all > stored ? all - stored : 0;
  const std::uint64_t bytes = all > start ? all - start : 0;
  const double most = double(bytes) * (header.data.packed ? kMostCompression : 1.0);
  if (most < double(stored) + double(header.data.skip) || start < earliest) {
    return unreadable(tr("The file is cut short: its header promises more voxels than it holds"),
                      file);
  }
  // What is too much stands in front as a rule: a header of its own, or one that is longer than it
  // says. Then every voxel would be read from another's place.
  if (offset && !header.data.packed && bytes > stored) {
    return longerThanSaid(header, tr("{} bytes ", bytes - stored), file);
  }
  if (isMostlyHoles(header.data.file)) {
    return unreadable(tr("The file is empty but for its beginning: it was not copied to its end"),
                      file);
  }
  header.data.offset = start;
  header.data.bytes = bytes;
  return {};
}

Result<std::string> readStart(const fs::path& file, std::size_t most) {
  std::error_code ec;
  const std::uint64_t all = fs::file_size(file, ec);
  std::ifstream in(file, std::ios::binary);
  if (!in || ec) return unreadable(tr("The file cannot be opened"), file);
  std::string text(std::size_t(std::min<std::uint64_t>(most, all)), '\0');
  in.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(in.gcount()));
  return text;
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(kBlanks) - first + 1));
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return lower;
}

bool endsWith(const fs::path& file, std::string_view ending) {
  return lowerCase(file.filename().string()).ends_with(ending);
}

std::optional<double> numberIn(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<std::vector<double>> numbersIn(std::string_view text) {
  std::vector<double> values;
  while (true) {
    const auto first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return values;
    text.remove_prefix(first);
    const auto length = std::min(text.find_first_of(kBlanks), text.size());
    const auto value = numberIn(text.substr(0, length));
    if (!value) return std::nullopt;
    values.push_back(*value);
    text.remove_prefix(length);
  }
}

std::string shown(std::string_view text) {
  std::string out = "'";
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (text.size() > 40 ? "...'" : "'");
}

}  // namespace trephine::file_format
