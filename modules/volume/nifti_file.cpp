// NIfTI (.nii, .nii.gz), versions 1 and 2. What the header's fields mean: nifti1.h, nifti2.h.
// A header is 348 bytes, so both ways are ours; what they were compared with: README.md.
//
// NIfTI is RAS, we are LPS: x and y change sign here and nowhere else. The sform counts where there
// is one, else the qform; where they contradict one another, or the sform the pixdim, a person
// chooses. Its unit of length, slope and intercept are honoured.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>

#include "base/codes.h"
#include "base/purpose.h"
#include "base/tr.h"
#include "volume/file_format.h"
#include "volume/grid_place.h"
#include "volume/gzip_writer.h"
#include "volume/voxel_reader.h"

namespace trephine::file_format {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kVoxelsFrom = 352;        // in a file that is written
constexpr std::int32_t kMostAlongEdge = 32767;  // an int16 in the header

const Mat4 kFlipXy{{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

// The numbers of a header of either version, by where they lie in version 1 and in version 2.
class Header {
 public:
  // Nothing where `bytes` are no header of a NIfTI image in one file.
  static std::optional<Header> from(const std::string& bytes) {
    for (const bool big : {false, true}) {
      Header h(bytes, big);
      if (bytes.size() >= 348 && h.at<std::int32_t>(0) == 348 &&
          bytes.compare(344, 3, "n+1") == 0) {
        return h;
      }
      h.second_ = true;
      if (bytes.size() >= 540 && h.at<std::int32_t>(0) == 540 && bytes.compare(4, 3, "n+2") == 0) {
        return h;
      }
    }
    return std::nullopt;
  }

  bool bigEndian() const { return big_; }
  std::uint64_t length() const { return second_ ? 540 : 348; }
  double dim(std::size_t i) const {
    return second_ ? double(at<std::int64_t>(16 + 8 * i)) : at<std::int16_t>(40 + 2 * i);
  }
  int type() const { return at<std::int16_t>(second_ ? 12 : 70); }
  double pixdim(std::size_t i) const { return real(76 + 4 * i, 104 + 8 * i); }
  double voxelOffset() const {
    return second_ ? double(at<std::int64_t>(168)) : double(at<float>(108));
  }
  double slope() const { return real(112, 176); }
  double intercept() const { return real(116, 184); }
  int units() const { return second_ ? at<std::int32_t>(500) : std::uint8_t(bytes_[123]); }
  int qform() const { return second_ ? at<std::int32_t>(344) : at<std::int16_t>(252); }
  int sform() const { return second_ ? at<std::int32_t>(348) : at<std::int16_t>(254); }
  double quaternion(std::size_t i) const { return real(256 + 4 * i, 352 + 8 * i); }  // b, c, d
  double qoffset(std::size_t i) const { return real(268 + 4 * i, 376 + 8 * i); }
  double srow(std::size_t row, std::size_t i) const {
    return real(280 + 16 * row + 4 * i, 400 + 32 * row + 8 * i);
  }

 private:
  Header(const std::string& bytes, bool big) : bytes_(bytes), big_(big) {}
  template <class T>
  T at(std::size_t offset) const {
    char raw[sizeof(T)];
    std::memcpy(raw, bytes_.data() + offset, sizeof raw);
    if (big_) std::reverse(raw, raw + sizeof raw);
    T value;
    std::memcpy(&value, raw, sizeof value);
    return value;
  }
  double real(std::size_t first, std::size_t second) const {
    return second_ ? at<double>(second) : double(at<float>(first));
  }

  std::string bytes_;
  bool big_ = false;
  bool second_ = false;
};

// What a header says of its place: the affine of each form that it has, voxel to RAS in mm.
struct Affines {
  std::optional<Mat4> sform, qform;
  Vec3 pixdim_mm{0.0};
};

// The scalar part of the sform's rotation, where b, c and d leave it open: near a half turn the
// rounding of floats makes up to 7e-4 of it, and that a tenth of a degree.
std::optional<double> scalarPart(const Mat4& sform, const Vec3& bcd, double left) {
  constexpr double kRounding = 4e-7;  // of a * a: 2 (|b| + |c| + |d|) times half a float's last bit
  Mat3 axes(sform);
  for (int axis = 0; axis < 3; ++axis) {
    const double length = glm::length(axes[axis]);
    if (!(length > 0.0) || !std::isfinite(length)) return std::nullopt;
    axes[axis] /= length;
  }
  if (glm::determinant(axes) < 0.0) axes[2] = -axes[2];
  const Quat q = glm::quat_cast(axes);
  if (!(std::abs(q.w * q.w - left) < kRounding)) return std::nullopt;
  return glm::dot(Vec3(q.x, q.y, q.z), bcd) < 0.0 ? -q.w : q.w;
}

Result<Affines> affinesOf(const Header& h, const fs::path& file) {
  double unit_mm = 1.0;
  switch (h.units() & 7) {
    case 0:  // unknown: by custom mm
    case 2:
      break;
    case 1:
      unit_mm = 1000.0;
      break;
    case 3:
      unit_mm = 0.001;
      break;
    default:
      return badGeometry(tr("The unit of length is unknown"), file);
  }
  Affines of;
  // Steps have no sign: handedness is that of pixdim[0], or of the sform.
  of.pixdim_mm = glm::abs(Vec3(h.pixdim(1), h.pixdim(2), h.pixdim(3))) * unit_mm;
  if (h.sform() > 0) {
    Mat4& affine = of.sform.emplace(1.0);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        affine[column][row] = h.srow(std::size_t(row), std::size_t(column)) * unit_mm;
      }
    }
  }
  if (h.qform() > 0) {
    const double b = h.quaternion(0), c = h.quaternion(1), d = h.quaternion(2);
    // Below 1e-7 it is what floats leave of a half turn: libnifti takes it for none as well.
    const double left = 1.0 - b * b - c * c - d * d;
    double a = left < 1e-7 ? 0.0 : std::sqrt(left);
    if (of.sform) a = scalarPart(*of.sform, Vec3(b, c, d), left).value_or(a);
    const Quat q(a, b, c, d);
    const Mat3 rotation = glm::mat3_cast(glm::normalize(q));
    Mat4& affine = of.qform.emplace(1.0);
    for (int axis = 0; axis < 3; ++axis) {
      const double sign = axis == 2 && h.pixdim(0) < 0.0 ? -1.0 : 1.0;
      affine[axis] = glm::dvec4(rotation[axis] * (sign * of.pixdim_mm[axis]), 0.0);
    }
    affine[3] = glm::dvec4(Vec3(h.qoffset(0), h.qoffset(1), h.qoffset(2)) * unit_mm, 1.0);
  }
  if (of.sform || of.qform) return of;
  return badGeometry(
      tr("The file does not say how the image lies in the patient (no sform, no qform)"), file);
}

// The sform with the steps of the pixdim, which has to be positive.
std::optional<Mat4> withPixdim(const Mat4& sform, const Vec3& pixdim_mm) {
  Mat4 affine = sform;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(pixdim_mm[axis] > 0.0) || !std::isfinite(pixdim_mm[axis])) return std::nullopt;
    affine[axis] *= pixdim_mm[axis] / glm::length(Vec3(sform[axis]));
  }
  return affine;
}

Vec3 stepsOf_mm(const Mat4& affine) {
  return {glm::length(Vec3(affine[0])), glm::length(Vec3(affine[1])), glm::length(Vec3(affine[2]))};
}

std::string stepsText(const Vec3& mm) {
  char text[96];
  std::snprintf(text, sizeof text, "%.4g x %.4g x %.4g mm", mm.x, mm.y, mm.z);
  return text;
}

// Why two forms are not one: in steps, in handedness, else in place.
std::string contradictionOf(const Mat4& sform, const char* name, const Mat4& other,
                            double apart_mm) {
  const Vec3 a = stepsOf_mm(sform), b = stepsOf_mm(other);
  const std::string both = tr("The file's sform and {} contradict one another: ", name);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(a[axis] - b[axis]) <= 1e-3 * a[axis]) continue;
    return tr("{}the one says steps of {}, the other of {}", both, stepsText(a), stepsText(b));
  }
  if (glm::determinant(Mat3(sform)) * glm::determinant(Mat3(other)) < 0.0) {
    return tr("{}the image is mirrored by the one and not by the other", both);
  }
  char text[96];
  std::snprintf(text, sizeof text, "by the one it lies up to %.4g mm from where the other puts it",
                apart_mm);
  return both + text;
}

// Numbers that are none, or an axis of no length: a form that a writer left empty.
bool saysNothing(const Mat4& affine) {
  for (int axis = 0; axis < 4; ++axis) {
    const double length = glm::length(Vec3(affine[axis]));
    if (!std::isfinite(length) || (axis < 3 && !(length > 0.0))) return true;
  }
  return false;
}

// `header` as the first form that there is has it; where another contradicts it, all are kept.
Status place(const Affines& of, const Index3& size, const fs::path& file,
             VolumeFileHeader& header) {
  constexpr double kSame = 0.1;  // of a voxel
  const auto settled = [&](const Mat4& affine) {
    header.geometry = geometryFrom(kFlipXy * affine, size);
    return settle(header, file);
  };
  const bool sform_first = of.sform.has_value();
  const Mat4& first = sform_first ? *of.sform : *of.qform;
  const std::optional<Mat4> other = !sform_first ? std::nullopt
                                    : of.qform   ? of.qform
                                                 : withPixdim(first, of.pixdim_mm);
  if (!other) return settled(first);
  if (of.qform && saysNothing(first) != saysNothing(*other)) {
    const bool qform = saysNothing(first);
    header.notes.push_back(tr("The file's {} says no place: its {} was taken",
                              (qform ? "sform" : "qform"), (qform ? "qform" : "sform")));
    return settled(qform ? *other : first);
  }
  const double apart_mm =
      cornersApart_mm(geometryFrom(kFlipXy * first, size), geometryFrom(kFlipXy * *other, size));
  const Vec3 steps = glm::min(stepsOf_mm(first), stepsOf_mm(*other));
  if (apart_mm <= kSame * std::min({steps.x, steps.y, steps.z})) return settled(first);
  const char* name = of.qform ? "qform" : "pixdim";
  header.contradiction = contradictionOf(first, name, *other, apart_mm);
  // One of them may be none at all; then the other is what can be chosen.
  Status why;
  for (const auto& [form, affine] : {std::pair("sform", first), std::pair(name, *other)}) {
    const Status good = settled(affine);
    if (good) header.forms.push_back({form, header.geometry, header.reversed_slices});
    if (!good) why = good;
  }
  if (header.forms.empty()) return why;
  header.geometry = header.forms.front().geometry;
  header.reversed_slices = header.forms.front().reversed_slices;
  if (header.forms.size() == 1) {
    const std::string& good = header.forms.front().name;
    header.contradiction =
        tr("The file's {} is a place that is not read, and its {} contradicts it",
           (good == "sform" ? name : "sform"), good);
  }
  return {};
}

std::optional<VoxelType> niftiType(int code) {
  static const std::map<int, VoxelType> types{{256, VoxelType::int8},   {2, VoxelType::uint8},
                                              {4, VoxelType::int16},    {512, VoxelType::uint16},
                                              {8, VoxelType::int32},    {768, VoxelType::uint32},
                                              {1024, VoxelType::int64}, {1280, VoxelType::uint64},
                                              {16, VoxelType::float32}, {64, VoxelType::float64}};
  const auto found = types.find(code);
  return found == types.end() ? std::nullopt : std::optional(found->second);
}

Result<Index3> sizeOf(const Header& h, const fs::path& file) {
  if (!(h.dim(0) >= 3 && h.dim(0) <= 7)) {
    return unreadable(tr("The image is not three-dimensional"), file);
  }
  for (std::size_t d = 4; d <= std::size_t(h.dim(0)); ++d) {
    if (h.dim(d) > 1) return notHu(tr("The image has several values a voxel or a time axis"), file);
  }
  return sizeFrom({h.dim(1), h.dim(2), h.dim(3)}, file);
}

// What stands for a character of a text in XML.
std::string withoutEntities(const std::string& text) {
  constexpr std::pair<const char*, const char*> kSigns[] = {
      {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}, {"&amp;", "&"}};
  std::string plain;
  for (std::size_t at = 0; at < text.size();) {
    const auto* sign = std::ranges::find_if(kSigns, [&](const auto& one) {
      return std::string_view(text).substr(at).starts_with(one.first);
    });
    plain += sign != std::end(kSigns) ? sign->second[0] : text[at];
    at += sign != std::end(kSigns) ? std::strlen(sign->first) : 1;
  }
  return plain;
}

// The table of labels that Connectome Workbench and TotalSegmentator write into a header's
// extension (CaretExtension: elements Label with Key, Red, Green and Blue), by the keys that 3D
// Slicer uses in a NRRD.
std::map<std::string, std::string> labelTable(const std::string& extension) {
  constexpr std::string_view kBegin = "<Label ", kEnd = "</Label>", kText = "<![CDATA[",
                             kTextEnd = "]]>";
  constexpr int kMost = 4096;
  std::map<std::string, std::string> segments;
  int n = 0;
  for (std::size_t at = 0; n < kMost && (at = extension.find(kBegin, at)) != extension.npos;) {
    const std::size_t head_end = extension.find('>', at);
    const std::size_t end = extension.find(kEnd, at);
    if (head_end == extension.npos || end == extension.npos || end < head_end) break;
    const std::string head = extension.substr(at, head_end - at);
    const auto attribute = [&](const std::string& name) -> std::string {
      const std::size_t from = head.find(" " + name + "=\"");
      if (from == head.npos) return "";
      const std::size_t value = from + name.size() + 3;
      return head.substr(value, head.find('"', value) - value);
    };
    std::string name = extension.substr(head_end + 1, end - head_end - 1);
    if (const std::size_t text = name.find(kText); text != name.npos) {
      name = name.substr(text + kText.size());
      name = name.substr(0, name.find(kTextEnd));
    } else {
      name = withoutEntities(name);
    }
    at = end;
    const auto key = numberIn(attribute("Key"));
    if (!key || *key < 1.0 || trimmed(name).empty()) continue;  // 0: what is no structure
    const std::string segment = "Segment" + std::to_string(n++) + "_";
    segments[segment + "Name"] = trimmed(name);
    segments[segment + "LabelValue"] = attribute("Key");
    segments[segment + "Color"] =
        attribute("Red") + " " + attribute("Green") + " " + attribute("Blue");
  }
  return segments;
}

// The 348 bytes of a version 1 header and the four that say that no extension follows, for HU as
// int16 or labels as uint8. What is not put is 0: no slope, no time, no intent.
std::string headerFor(const GridGeometry& g, VoxelType type) {
  std::string bytes(kVoxelsFrom, '\0');
  const auto put = [&bytes](std::size_t at, const auto& value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
  };
  const Mat4 ras = kFlipXy * g.voxelToPatient();
  // The right-handed axes' rotation; of a quaternion and its negative, the one without a < 0.
  Mat3 axes = Mat3(kFlipXy) * g.direction;
  const bool left_handed = glm::determinant(axes) < 0.0;
  if (left_handed) axes[2] = -axes[2];
  Quat q = glm::quat_cast(axes);
  if (q.w < 0.0) q = -q;
  put(0, std::int32_t(348));
  put(40, std::array<std::int16_t, 8>{3, std::int16_t(g.size[0]), std::int16_t(g.size[1]),
                                      std::int16_t(g.size[2]), 1, 1, 1, 1});
  const bool bytes_only = type == VoxelType::uint8;
  put(70, std::array<std::int16_t, 2>{std::int16_t(bytes_only ? 2 : 4),  // uint8 or int16, in bits
                                      std::int16_t(bytes_only ? 8 : 16)});
  put(76, std::array<float, 8>{left_handed ? -1.0f : 1.0f, float(g.spacing_mm.x),
                               float(g.spacing_mm.y), float(g.spacing_mm.z), 1, 1, 1, 1});
  put(108, float(kVoxelsFrom));
  put(123, std::uint8_t(2));                                      // mm
  const std::string made = std::string("Trephine: ") + kPurpose;  // of 80 characters
  std::copy_n(made.data(), std::min<std::size_t>(made.size(), 79), bytes.data() + 148);
  put(252, std::array<std::int16_t, 2>{1, 2});  // a scanner's place by qform, an aligned by sform
  put(256, std::array<float, 6>{float(q.x), float(q.y), float(q.z), float(ras[3].x),
                                float(ras[3].y), float(ras[3].z)});
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      put(std::size_t(280 + 16 * row + 4 * column), float(ras[column][row]));
    }
  }
  put(344, std::array{'n', '+', '1'});
  return bytes;
}

}  // namespace

Result<VolumeFileHeader> readNiftiHeader(const fs::path& file) {
  VolumeFileHeader header;
  header.format = "NIfTI";
  header.data.file = file;
  const auto first = readStart(file, 2);
  if (!first) return first.error();
  header.data.packed = *first == "\x1f\x8b";  // gzip, whatever the name says
  const auto h = Header::from(unpackedStart(file, header.data.packed, 540));
  if (!h) return unreadable(tr("The file is not a NIfTI image"), file);

  const auto size = sizeOf(*h, file);
  if (!size) return size.error();
  const auto type = niftiType(h->type());
  if (!type) return notHu(tr("The voxels are not one number each"), file);
  header.type = *type;
  header.big_endian = h->bigEndian();
  const auto affines = affinesOf(*h, file);
  if (!affines) return affines.error();
  if (auto status = place(*affines, *size, file, header); !status) return status.error();
  // 0: values are as they are. So are they by custom where the slope is no number.
  if (!std::isfinite(h->slope())) {
    header.notes.push_back(tr("The rescale slope is no number: values are taken as they are"));
  } else if (h->slope() != 0.0) {
    header.slope = h->slope();
    header.intercept = h->intercept();
    if (header.slope < 0.0) {
      header.notes.push_back(tr("The rescale slope is negative: look whether bone is bright"));
    }
  }
  if (!std::isfinite(header.intercept)) {
    return notHu(tr("The rescale intercept is no number"), file);
  }
  // 0: right behind the header and the four bytes that follow it, which some writers do not count.
  const double behind = double(h->length()) + 4.0;
  double start = h->voxelOffset() == 0.0 ? behind : std::floor(h->voxelOffset());
  std::error_code ec;
  const bool uncounted = start >= double(h->length()) && start < behind && !header.data.packed &&
                         double(fs::file_size(file, ec)) == behind + double(header.storedBytes());
  if (uncounted) start = behind;
  if (!(start >= double(h->length()) && start <= 1e15)) {
    return unreadable(tr("The header's voxels start inside of it or nowhere"), file);
  }
  constexpr double kMostExtension = double(1 << 20);
  if (start > behind) {
    const std::string before =
        unpackedStart(file, header.data.packed, std::size_t(std::min(start, kMostExtension)));
    if (before.size() > h->length() && before[h->length()] != 0) {
      header.segments = labelTable(before.substr(h->length() + 4));
    }
  }
  if (header.data.packed) header.data.skip = std::uint64_t(start);
  const std::uint64_t offset = header.data.packed ? 0 : std::uint64_t(start);
  if (auto status = placeVoxels(header, offset, file); !status) return status.error();
  return header;
}

Status writeNifti(const VoxelSlabs& voxels, VoxelType type, const fs::path& temporary,
                  const fs::path& target, const Progress& progress) {
  for (const std::int32_t edge : voxels.geometry.size) {
    if (edge > kMostAlongEdge) {
      return Error{code::kCannotWrite, tr("NIfTI holds at most 32767 voxels along an edge"),
                   target.string(), tr("Save it as .mha")};
    }
  }
  // e: not for programs that are started meanwhile.
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(temporary.c_str(), "wbe"),
                                                       std::fclose);
  if (!file) return cannotWrite(target);
  std::optional<GzipWriter> gzip;
  if (endsWith(target, ".gz")) gzip.emplace(file.get());
  const auto write = [&](std::span<const std::byte> bytes) {
    return gzip ? gzip->write(bytes)
                : std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  };
  const std::string header = headerFor(voxels.geometry, type);
  std::vector<std::byte> narrow;
  const bool written = write(std::as_bytes(std::span(header))) &&
                       voxels.forEach(
                           [&](std::span<const std::int16_t> slab) {
                             return !progress.cancelled() && write(storedAs(type, slab, narrow));
                           },
                           GzipWriter::kAtOnce / sizeof(std::int16_t)) &&
                       (!gzip || gzip->finish());
  // The last bytes go out here, so a full disk may show only now.
  return std::fclose(file.release()) == 0 && written ? Status() : cannotWrite(target);
}

}  // namespace trephine::file_format
