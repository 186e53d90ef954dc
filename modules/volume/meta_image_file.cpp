// MetaImage: a text header, then voxels, in one file or two.
//
// VTK 9.1 neither reads nor writes `TransformMatrix` (measured), and hands out whatever was in
// memory where compressed voxels do not unpack; so both parts are ours. `TransformMatrix` holds the
// unit i, j and k axes one after another (the direction's columns), as ITK and 3D Slicer write it;
// `Offset` is the centre of the first voxel. Both are LPS.
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "base/purpose.h"
#include "base/tr.h"
#include "volume/file_format.h"

namespace trephine::file_format {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostHeader = 65536;

// The fields up to and including ElementDataFile; `length` is where the next line starts.
std::optional<std::map<std::string, std::string>> fieldsOf(const std::string& text,
                                                           std::size_t& length) {
  std::map<std::string, std::string> fields;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) return std::nullopt;
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    const auto equals = line.find('=');
    if (equals == std::string::npos) {
      if (trimmed(line).empty()) continue;
      return std::nullopt;
    }
    const std::string key = trimmed(line.substr(0, equals));
    fields[key] = trimmed(line.substr(equals + 1));
    if (key == "ElementDataFile") {
      length = at;
      return fields;
    }
  }
  return std::nullopt;
}

class Fields {
 public:
  explicit Fields(std::map<std::string, std::string> fields) : fields_(std::move(fields)) {}

  // The value of the first of these names that is there; "" where none is.
  std::string text(std::initializer_list<const char*> names) const {
    for (const char* name : names) {
      if (const auto found = fields_.find(name); found != fields_.end()) return found->second;
    }
    return "";
  }
  bool has(std::initializer_list<const char*> names) const { return !text(names).empty(); }
  bool flag(const char* name) const {
    const std::string value = text({name});
    return !value.empty() && (value[0] == 'T' || value[0] == 't' || value[0] == '1');
  }
  // Exactly `count` numbers, or nothing.
  std::optional<std::vector<double>> numbers(std::initializer_list<const char*> names,
                                             std::size_t count) const {
    auto values = numbersIn(text(names));
    if (!values || values->size() != count) return std::nullopt;
    return values;
  }

 private:
  std::map<std::string, std::string> fields_;
};

// MET_LONG is left out: how long it is depends on who wrote it.
std::optional<VoxelType> typeFrom(const std::string& name) {
  static const std::map<std::string, VoxelType> types{
      {"MET_CHAR", VoxelType::int8},       {"MET_UCHAR", VoxelType::uint8},
      {"MET_SHORT", VoxelType::int16},     {"MET_USHORT", VoxelType::uint16},
      {"MET_INT", VoxelType::int32},       {"MET_UINT", VoxelType::uint32},
      {"MET_LONG_LONG", VoxelType::int64}, {"MET_ULONG_LONG", VoxelType::uint64},
      {"MET_FLOAT", VoxelType::float32},   {"MET_DOUBLE", VoxelType::float64}};
  const auto found = types.find(name);
  return found == types.end() ? std::nullopt : std::optional(found->second);
}

Status readGeometry(const Fields& fields, const fs::path& file, GridGeometry& geometry) {
  const auto dims = fields.numbers({"NDims"}, 1);
  if (!dims || (*dims)[0] != 3.0) return unreadable(tr("The image is not three-dimensional"), file);
  const auto sizes = fields.numbers({"DimSize"}, 3);
  if (!sizes) return unreadable(tr("The header's DimSize is not three numbers"), file);
  const auto size = sizeFrom(*sizes, file);
  if (!size) return size.error();
  geometry.size = *size;

  const auto spacing = fields.numbers({"ElementSpacing", "ElementSize"}, 3);
  if (!spacing) return badGeometry(tr("The header does not say how large a voxel is"), file);
  geometry.spacing_mm = {(*spacing)[0], (*spacing)[1], (*spacing)[2]};

  // The format's defaults: axes along the patient's, the first voxel at the origin.
  if (fields.has({"Offset", "Position", "Origin"})) {
    const auto offset = fields.numbers({"Offset", "Position", "Origin"}, 3);
    if (!offset) return badGeometry(tr("The header's Offset cannot be read"), file);
    geometry.origin_mm = {(*offset)[0], (*offset)[1], (*offset)[2]};
  }
  if (fields.has({"TransformMatrix", "Rotation", "Orientation"})) {
    const auto matrix = fields.numbers({"TransformMatrix", "Rotation", "Orientation"}, 9);
    if (!matrix) return badGeometry(tr("The header's TransformMatrix cannot be read"), file);
    for (int axis = 0; axis < 3; ++axis) {
      for (int row = 0; row < 3; ++row) {
        geometry.direction[axis][row] = (*matrix)[std::size_t(axis * 3 + row)];
      }
    }
  }
  return {};
}

Status findVoxels(const Fields& fields, const fs::path& file, std::size_t header_length,
                  VolumeFileHeader& header) {
  std::optional<std::uint64_t> offset = header_length;
  header.data.file = file;
  const std::string name = fields.text({"ElementDataFile"});
  if (name == "LIST" || name.find('%') != std::string::npos) {
    return unknownFormat(tr("A MetaImage whose slices are separate files is not read"), file,
                         tr("Export it as one .mha file"));
  }
  if (lowerCase(name) != "local") {
    const auto data = fileBeside(file, name);
    if (!data) return data.error();
    header.data.file = *data;
    offset = 0;
  }
  const std::uint64_t earliest = offset.value_or(0);
  if (fields.has({"HeaderSize"})) {
    const auto more = fields.numbers({"HeaderSize"}, 1);
    if (!more || !((*more)[0] >= -1.0 && (*more)[0] <= 1e15)) {
      return unreadable(tr("The header's HeaderSize cannot be read"), file);
    }
    if ((*more)[0] >= 0.0) {
      *offset += std::uint64_t((*more)[0]);
    } else if (!header.data.packed) {
      offset.reset();  // the voxels are the end of the file, whatever comes before
    }
  }
  if (auto status = placeVoxels(header, offset, file, earliest); !status) return status;
  if (header.data.packed && fields.has({"CompressedDataSize"})) {
    const auto packed = fields.numbers({"CompressedDataSize"}, 1);
    if (!packed || !((*packed)[0] >= 0.0 && (*packed)[0] <= double(header.data.bytes))) {
      return unreadable(tr("The file is cut short: its compressed voxels are not all there"), file);
    }
    header.data.bytes = std::uint64_t((*packed)[0]);
  }
  return {};
}

std::string exact(double value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string exact(const Vec3& v) {
  return exact(v.x) + " " + exact(v.y) + " " + exact(v.z);
}

// Numbers keep all their digits.
std::string headerText(const GridGeometry& g, VoxelType type) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << "ObjectType = Image\nNDims = 3\nComment = " << kPurpose
      << "\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      << "CompressedData = False\nTransformMatrix = " << exact(g.direction[0]) << " "
      << exact(g.direction[1]) << " " << exact(g.direction[2])
      << "\nOffset = " << exact(g.origin_mm) << "\nCenterOfRotation = 0 0 0\n"
      << "ElementSpacing = " << exact(g.spacing_mm) << "\nDimSize = " << g.size[0] << " "
      << g.size[1] << " " << g.size[2]
      << "\nElementType = " << (type == VoxelType::uint8 ? "MET_UCHAR" : "MET_SHORT")
      << "\nElementDataFile = LOCAL\n";
  return out.str();
}

}  // namespace

Result<VolumeFileHeader> readMetaImageHeader(const fs::path& file) {
  const auto text = readStart(file, kMostHeader);
  if (!text) return text.error();
  std::size_t length = 0;
  auto found = fieldsOf(*text, length);
  if (!found) return unreadable(tr("The file is not a MetaImage: it has no header"), file);
  const Fields fields(std::move(*found));

  VolumeFileHeader header;
  header.format = "MetaImage";
  if (auto status = readGeometry(fields, file, header.geometry); !status) return status.error();
  const auto type = typeFrom(fields.text({"ElementType"}));
  const auto channels = fields.numbers({"ElementNumberOfChannels"}, 1);
  const bool one = !fields.has({"ElementNumberOfChannels"}) || (channels && (*channels)[0] == 1.0);
  if (!type || !one) return notHu(tr("The voxels are not one number each"), file);
  header.type = *type;
  if (fields.has({"BinaryData"}) && !fields.flag("BinaryData")) {
    return unknownFormat(tr("A MetaImage with its voxels as text is not read"), file,
                         tr("Export it with binary data"));
  }
  for (auto [name, value] : {std::pair("ElementToIntensityFunctionSlope", &header.slope),
                             std::pair("ElementToIntensityFunctionOffset", &header.intercept)}) {
    if (!fields.has({name})) continue;
    const auto number = fields.numbers({name}, 1);
    if (!number || !std::isfinite((*number)[0])) {
      return unreadable(tr("The header's {} is no number", name), file);
    }
    *value = (*number)[0];
  }
  header.big_endian = fields.flag("BinaryDataByteOrderMSB") || fields.flag("ElementByteOrderMSB");
  header.data.packed = fields.flag("CompressedData");
  if (auto status = findVoxels(fields, file, length, header); !status) return status.error();
  if (auto status = settle(header, file); !status) return status.error();
  return header;
}

Status writeMetaImage(const VoxelSlabs& voxels, VoxelType type, const fs::path& temporary,
                      const fs::path& target, const Progress& progress) {
  std::ofstream out(temporary, std::ios::binary);
  out << headerText(voxels.geometry, type);
  std::vector<std::byte> narrow;
  voxels.forEach([&](std::span<const std::int16_t> slab) {
    const std::span<const std::byte> stored = storedAs(type, slab, narrow);
    out.write(reinterpret_cast<const char*>(stored.data()), std::streamsize(stored.size()));
    return bool(out) && !progress.cancelled();
  });
  out.close();
  if (!out) return cannotWrite(target);
  return {};
}

}  // namespace trephine::file_format
