#include "volume/meta_image_header.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>

namespace trephine {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostHeader = 65536;

Error headerError(const std::string& what, const fs::path& file) {
  return Error{"UNREADABLE", what, file.string(), "Copy or export the file again"};
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

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
    std::istringstream in(text(names));
    in.imbue(std::locale::classic());
    std::vector<double> values;
    for (double value; in >> value;) values.push_back(value);
    if (!in.eof() || values.size() != count) return std::nullopt;
    return values;
  }

 private:
  std::map<std::string, std::string> fields_;
};

// Bytes of a whole-number type, 0 for any other.
int bytesOf(const std::string& type) {
  if (type == "MET_CHAR" || type == "MET_UCHAR") return 1;
  if (type == "MET_SHORT" || type == "MET_USHORT") return 2;
  return type == "MET_INT" || type == "MET_UINT" ? 4 : 0;
}

Status readGeometry(const Fields& fields, const fs::path& file, GridGeometry& geometry) {
  const auto dims = fields.numbers({"NDims"}, 1);
  if (!dims || (*dims)[0] != 3.0) return headerError("The image is not three-dimensional", file);
  const auto size = fields.numbers({"DimSize"}, 3);
  if (!size) return headerError("The header's DimSize is not three numbers", file);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double n = (*size)[axis];
    if (!(n >= 1.0) || n != std::floor(n)) {
      return headerError("The header's DimSize is not three positive whole numbers", file);
    }
    geometry.size[axis] =
        std::int32_t(std::min(n, double(std::numeric_limits<std::int32_t>::max())));
  }
  if (auto status = checkSize(geometry.size, file.string()); !status) return status;

  const auto spacing = fields.numbers({"ElementSpacing", "ElementSize"}, 3);
  if (!spacing) {
    return Error{"BAD_GEOMETRY", "The header does not say how large a voxel is", file.string(),
                 "Export it again with ElementSpacing"};
  }
  geometry.spacing_mm = {(*spacing)[0], (*spacing)[1], (*spacing)[2]};

  const auto badNumbers = [&](const char* name) {
    return Error{"BAD_GEOMETRY", std::string("The header's ") + name + " cannot be read",
                 file.string(), "Export it again with its orientation and position"};
  };
  // The format's defaults: axes along the patient's, the first voxel at the origin.
  if (fields.has({"Offset", "Position", "Origin"})) {
    const auto offset = fields.numbers({"Offset", "Position", "Origin"}, 3);
    if (!offset) return badNumbers("Offset");
    geometry.origin_mm = {(*offset)[0], (*offset)[1], (*offset)[2]};
  }
  if (fields.has({"TransformMatrix", "Rotation", "Orientation"})) {
    const auto matrix = fields.numbers({"TransformMatrix", "Rotation", "Orientation"}, 9);
    if (!matrix) return badNumbers("TransformMatrix");
    for (int axis = 0; axis < 3; ++axis) {
      for (int row = 0; row < 3; ++row) {
        geometry.direction[axis][row] = (*matrix)[std::size_t(axis * 3 + row)];
      }
    }
  }
  return {};
}

// How many bytes of voxels there are, wherever they lie.
Status findData(const Fields& fields, const fs::path& file, std::size_t header_length,
                MetaImageHeader& header) {
  std::error_code ec;
  std::uint64_t skipped = header_length;
  fs::path data = file;
  const std::string name = fields.text({"ElementDataFile"});
  if (name == "LIST" || name.find('%') != std::string::npos) {
    return Error{"UNKNOWN_FORMAT", "A MetaImage whose slices are separate files is not read",
                 file.string(), "Export it as one .mha file"};
  }
  if (name != "LOCAL" && name != "Local" && name != "local") {
    data = file.parent_path() / name;
    skipped = 0;
    if (!fs::is_regular_file(data, ec)) {
      return Error{"MISSING_FILE", "The file with the voxels is not beside the header",
                   data.string(), "Keep the .mhd and its data file together"};
    }
  }
  if (fields.has({"HeaderSize"})) {
    const auto more = fields.numbers({"HeaderSize"}, 1);
    // -1: the voxels are the end of the file, whatever comes before.
    if (!more || (*more)[0] < -1.0 || (*more)[0] > 1e15) {
      return headerError("The header's HeaderSize cannot be read", file);
    }
    if ((*more)[0] > 0.0) skipped += std::uint64_t((*more)[0]);
  }
  const std::uint64_t all = fs::file_size(data, ec);
  if (ec) return headerError("The file with the voxels cannot be read", data);
  header.data = data;
  header.data_offset = skipped;
  header.data_bytes = all > skipped ? all - skipped : 0;
  if (header.compressed && fields.has({"CompressedDataSize"})) {
    const auto packed = fields.numbers({"CompressedDataSize"}, 1);
    if (!packed || !((*packed)[0] >= 0.0 && (*packed)[0] <= double(header.data_bytes))) {
      return headerError("The file is cut short: its compressed voxels are not all there", file);
    }
    header.data_bytes = std::uint64_t((*packed)[0]);
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

}  // namespace

Result<MetaImageHeader> readMetaImageHeader(const fs::path& file) {
  std::string text(kMostHeader, '\0');
  std::ifstream in(file, std::ios::binary);
  if (!in) return headerError("The file cannot be opened", file);
  in.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(in.gcount()));

  std::size_t length = 0;
  auto found = fieldsOf(text, length);
  if (!found) return headerError("The file is not a MetaImage: it has no header", file);
  const Fields fields(std::move(*found));

  MetaImageHeader header;
  if (auto status = readGeometry(fields, file, header.geometry); !status) return status.error();
  header.bytes_per_voxel = bytesOf(fields.text({"ElementType"}));
  const auto channels = fields.numbers({"ElementNumberOfChannels"}, 1);
  const bool one = !fields.has({"ElementNumberOfChannels"}) || (channels && (*channels)[0] == 1.0);
  if (header.bytes_per_voxel == 0 || !one) {
    return Error{"NOT_HU", "The voxels are not one whole number each", file.string(),
                 "Export the CT as 16-bit whole numbers in HU"};
  }
  if (fields.has({"BinaryData"}) && !fields.flag("BinaryData")) {
    return Error{"UNKNOWN_FORMAT", "A MetaImage with its voxels as text is not read", file.string(),
                 "Export it with binary data"};
  }
  for (auto [name, value] : {std::pair("ElementToIntensityFunctionSlope", &header.slope),
                             std::pair("ElementToIntensityFunctionOffset", &header.intercept)}) {
    if (!fields.has({name})) continue;
    const auto number = fields.numbers({name}, 1);
    if (!number || !std::isfinite((*number)[0])) {
      return headerError(std::string("The header's ") + name + " is no number", file);
    }
    *value = (*number)[0];
  }
  header.compressed = fields.flag("CompressedData");
  header.big_endian = fields.flag("BinaryDataByteOrderMSB") || fields.flag("ElementByteOrderMSB");
  if (auto status = findData(fields, file, length, header); !status) return status.error();
  return header;
}

std::optional<std::uint32_t> readAdler32(const MetaImageHeader& header) {
  std::uint8_t first[2], last[4];
  std::ifstream in(header.data, std::ios::binary);
  if (header.data_bytes < 6) return std::nullopt;
  in.seekg(std::streamoff(header.data_offset));
  in.read(reinterpret_cast<char*>(first), 2);
  in.seekg(std::streamoff(header.data_offset + header.data_bytes - 4));
  in.read(reinterpret_cast<char*>(last), 4);
  // Method 8 is deflate, and the two bytes are a multiple of 31.
  if (!in || (first[0] & 15) != 8 || (first[0] * 256 + first[1]) % 31 != 0) return std::nullopt;
  return std::uint32_t(last[0]) << 24 | std::uint32_t(last[1]) << 16 | std::uint32_t(last[2]) << 8 |
         std::uint32_t(last[3]);
}

std::string metaImageHeaderText(const GridGeometry& g) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      << "CompressedData = False\nTransformMatrix = " << exact(g.direction[0]) << " "
      << exact(g.direction[1]) << " " << exact(g.direction[2])
      << "\nOffset = " << exact(g.origin_mm) << "\nCenterOfRotation = 0 0 0\n"
      << "ElementSpacing = " << exact(g.spacing_mm) << "\nDimSize = " << g.size[0] << " "
      << g.size[1] << " " << g.size[2] << "\nElementType = MET_SHORT\nElementDataFile = LOCAL\n";
  return out.str();
}

}  // namespace trephine
