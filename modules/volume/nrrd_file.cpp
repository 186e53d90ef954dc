// NRRD: a text header, then voxels, in one file (.nrrd) or two (.nhdr). The format:
// http://teem.sourceforge.net/nrrd/format.html; where that leaves a question, Teem's own reader was
// asked.
//
// VTK 9.1's reader is not used. Measured: it drops the directions of the axes, does not turn the
// bytes of big-endian gzip, takes a first axis of up to nine voxels for a vector, refuses a byte
// skip, and gives out a file that is cut short.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <set>

#include "base/tr.h"
#include "volume/file_format.h"
#include "volume/label_map.h"

namespace trephine::file_format {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostNrrdHeader = std::size_t{1} << 20;

// The format's fields, without blanks. Any other is refused: what it changes is not known.
constexpr std::string_view kFields =
    " axismaxs axismins blocksize byteskip centerings centers content datafile dimension encoding "
    "endian kinds labels lineskip max measurementframe min number oldmax oldmin sampleunits sizes "
    "space spacedimension spacedirections spaceorigin spaceunits spacings thicknesses type units ";

// The format's names of each type.
const std::pair<VoxelType, std::set<std::string>> kTypes[] = {
    {VoxelType::int8, {"signed char", "int8", "int8_t"}},
    {VoxelType::uint8, {"uchar", "unsigned char", "uint8", "uint8_t"}},
    {VoxelType::int16,
     {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
    {VoxelType::uint16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
    {VoxelType::int32, {"int", "signed int", "int32", "int32_t"}},
    {VoxelType::uint32, {"uint", "unsigned int", "uint32", "uint32_t"}},
    {VoxelType::int64,
     {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64",
      "int64_t"}},
    {VoxelType::uint64,
     {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}},
    {VoxelType::float32, {"float"}},
    {VoxelType::float64, {"double"}}};

// The signs that lead from a space to LPS.
const std::map<std::string, Vec3> kSpaces{
    {"left-posterior-superior", {1, 1, 1}},   {"lps", {1, 1, 1}},
    {"right-anterior-superior", {-1, -1, 1}}, {"ras", {-1, -1, 1}},
    {"left-anterior-superior", {1, -1, 1}},   {"las", {1, -1, 1}}};

const std::map<std::string, double> kUnits_mm{
    {"mm", 1.0},   {"millimeter", 1.0}, {"millimeters", 1.0}, {"cm", 10.0}, {"m", 1000.0},
    {"um", 0.001}, {"", 1.0},           {"???", 1.0}};

struct NrrdFields {
  std::map<std::string, std::string> values;  // by a name of kFields
  std::map<std::string, std::string> segments;  // key:=value, as 3D Slicer names segments
  std::size_t length = 0;                     // of the header, with the blank line that ends it
  bool ended = false;                         // there is such a line

  bool has(const std::string& name) const { return values.contains(name); }
  std::string text(const std::string& name) const {
    const auto found = values.find(name);
    return found == values.end() ? "" : found->second;
  }
  std::string word(const std::string& name) const { return lowerCase(text(name)); }
};

// A value of anyone's own, in which a line's end and a backslash are written with one.
std::string unescaped(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool escape = text[at] == '\\' && at + 1 < text.size();
    if (escape) ++at;
    out += escape && text[at] == 'n' ? '\n' : text[at];
  }
  return out;
}

Result<NrrdFields> nrrdFieldsOf(const std::string& text, const fs::path& file) {
  if (!text.starts_with("NRRD000")) return unreadable(tr("The file is not a NRRD file"), file);
  NrrdFields fields;
  for (std::size_t at = std::min(text.find('\n'), text.size() - 1) + 1; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    at = end + 1;
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty()) {
      fields.ended = true;
      fields.length = at;
      break;
    }
    // "field: what it is", or "key:=value", which is anyone's own and left alone.
    const std::size_t colon = std::min(line.find(": "), line.find(":="));
    if (line[0] == '#') continue;
    if (colon < line.size() && line[colon + 1] == '=') {
      const std::string key = line.substr(0, colon);
      if (key.starts_with("Segment")) fields.segments[key] = unescaped(line.substr(colon + 2));
      continue;
    }
    if (colon > line.size()) {
      return unreadable(tr("A line of the header is not understood: {}", shown(line)), file);
    }
    std::string name = lowerCase(line.substr(0, colon));
    std::erase(name, ' ');
    if (kFields.find(" " + name + " ") == kFields.npos) {
      return unreadable(
          tr("The header has a field that NRRD does not know: {}", shown(line.substr(0, colon))),
          file);
    }
    const std::string value = trimmed(line.substr(colon + 2));
    if (!fields.values.emplace(name, value).second) {
      return unreadable(tr("The header has the field {} twice", shown(name)), file);
    }
    if (name == "datafile" && value.starts_with("LIST")) break;  // file names follow
  }
  if (!fields.ended && text.size() == kMostNrrdHeader) {
    return unreadable(tr("The file's header does not end"), file);
  }
  return fields;
}

// "(1,0,0) (0,1,0) none": a vector each, nothing for "none". Nothing at all where it is none of
// that.
std::optional<std::vector<std::optional<Vec3>>> vectorsIn(std::string_view text) {
  std::vector<std::optional<Vec3>> vectors;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    if (text.empty()) return vectors;
    if (lowerCase(text.substr(0, 4)) == "none") {
      vectors.emplace_back();
      text.remove_prefix(4);
      continue;
    }
    const std::size_t close = text.find(')');
    if (text[0] != '(' || close == std::string_view::npos) return std::nullopt;
    std::string inside(text.substr(1, close - 1));
    if (std::count(inside.begin(), inside.end(), ',') != 2) return std::nullopt;
    std::replace(inside.begin(), inside.end(), ',', ' ');
    const auto numbers = numbersIn(inside);
    if (!numbers || numbers->size() != 3) return std::nullopt;
    vectors.emplace_back(Vec3((*numbers)[0], (*numbers)[1], (*numbers)[2]));
    text.remove_prefix(close + 1);
  }
}

// The words of a list such as `"mm" "mm" "mm"` or `domain domain domain`, in lower case.
std::vector<std::string> wordsIn(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t at = text.find_first_not_of(" \t"); at < text.size();
       at = text.find_first_not_of(" \t", at)) {
    const bool quotes = text[at] == '"';
    const std::size_t start = at + quotes;
    const std::size_t end = std::min(text.find_first_of(quotes ? "\"" : " \t", start), text.size());
    words.push_back(lowerCase(trimmed(text.substr(start, end - start))));
    at = end + quotes;
  }
  return words;
}

// One length for all three axes, in mm.
Result<double> unitOf(const NrrdFields& fields, const fs::path& file) {
  const std::vector<std::string> units = wordsIn(fields.text("spaceunits"));
  if (units.empty()) return 1.0;  // by custom
  const auto found = kUnits_mm.find(units[0]);
  const bool same = std::all_of(units.begin(), units.end(), [&](auto& u) { return u == units[0]; });
  if (found == kUnits_mm.end() || !same) {
    return badGeometry(tr("The unit of length is unknown: {}", shown(fields.text("spaceunits"))),
                       file);
  }
  return found->second;
}

// 3D Slicer keeps segments that overlap in layers: a first axis that is a list, no space.
bool isLayered(const NrrdFields& fields) {
  const std::vector<std::string> kinds = wordsIn(fields.text("kinds"));
  return !fields.segments.empty() && numberIn(fields.text("dimension")) == 4.0 && !kinds.empty() &&
         kinds[0] == "list";
}

Result<GridGeometry> nrrdGeometry(const NrrdFields& fields, VolumeFileHeader& header,
                                  const fs::path& file) {
  auto sizes = numbersIn(fields.text("sizes"));
  if (!sizes) return unreadable(tr("The header's sizes are not numbers"), file);
  if (isLayered(fields)) {
    if (sizes->size() != 4) return unreadable(tr("The image's size is not four numbers"), file);
    const double layers = sizes->front();
    if (!(layers >= 1.0 && layers <= kMostStructures) || layers != std::floor(layers)) {
      return unreadable(tr("The header's number of layers is not from 1 to {}", kMostStructures),
                        file);
    }
    header.layers = int(layers);
    sizes->erase(sizes->begin());
  }
  const auto size = sizeFrom(*sizes, file);
  if (!size) return size.error();
  if (!fields.has("space") || !fields.has("spacedirections")) {
    return badGeometry(
        fields.has("spacings")
            ? tr("The header has the voxel size but not how the image lies in the "
                 "patient (no space, no space directions)")
            : tr("The header does not say how the image lies in the patient (no space, "
                 "no space directions)"),
        file);
  }
  const auto space = kSpaces.find(fields.word("space"));
  if (space == kSpaces.end()) {
    return badGeometry(tr("The space {} does not say where the patient's left, back and head are",
                          shown(fields.text("space"))),
                       file);
  }
  const auto unit_mm = unitOf(fields, file);
  if (!unit_mm) return unit_mm.error();
  auto axes = vectorsIn(fields.text("spacedirections"));
  if (isLayered(fields) && axes && axes->size() == 4 && !axes->front()) axes->erase(axes->begin());
  if (!axes || axes->size() != 3) {
    return badGeometry(tr("The header's space directions are not three vectors"), file);
  }
  Mat4 affine(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(*axes)[std::size_t(axis)]) {
      return notHu(tr("One of the image's axes is no direction in space (none)"), file);
    }
    affine[axis] = glm::dvec4(*(*axes)[std::size_t(axis)] * space->second * *unit_mm, 0.0);
  }
  if (!fields.has("spaceorigin")) {
    header.notes.push_back(
        tr("The header gives no space origin: the first voxel is put at 0, 0, 0"));
  } else {
    const auto origin = vectorsIn(fields.text("spaceorigin"));
    if (!origin || origin->size() != 1 || !(*origin)[0]) {
      return badGeometry(tr("The header's space origin is not a vector"), file);
    }
    affine[3] = glm::dvec4(*(*origin)[0] * space->second * *unit_mm, 1.0);
  }
  return geometryFrom(affine, *size);
}

// One number a voxel, in three dimensions, as it was measured.
Status checkKind(const NrrdFields& fields, const fs::path& file) {
  const auto dimension = numberIn(fields.text("dimension"));
  if (!dimension || *dimension < 3.0) {
    return unreadable(tr("The image is not three-dimensional"), file);
  }
  const bool layered = isLayered(fields);
  if (*dimension != 3.0 && !layered) {
    return notHu(tr("The image has {} dimensions: colour, vectors and time are not read",
                    fields.text("dimension").substr(0, 8)),
                 file);
  }
  std::vector<std::string> kinds = wordsIn(fields.text("kinds"));
  if (layered) kinds.erase(kinds.begin());
  for (const std::string& kind : kinds) {
    if (kind != "domain" && kind != "space" && kind != "???" && kind != "none") {
      return notHu(tr("An axis of the image is of the kind {}, not space", shown(kind)), file);
    }
  }
  if (fields.has("oldmin") || fields.has("oldmax")) {
    return notHu(tr("The values were squeezed from another range (old min, old max)"), file);
  }
  return {};
}

// Where the line after the next `lines` lines starts.
std::optional<std::uint64_t> afterLines(const fs::path& file, std::uint64_t at, double lines) {
  constexpr std::streamsize kMostBytes = std::streamsize(1) << 24;  // of text before voxels
  std::ifstream in(file, std::ios::binary);
  in.seekg(std::streamoff(at));
  for (std::streamsize left = kMostBytes; lines > 0.0; --lines) {
    in.ignore(left, '\n');
    left -= in.gcount();
    if (!in || in.eof() || left <= 0) return std::nullopt;
  }
  return std::uint64_t(in.tellg());
}

Status findNrrdVoxels(const NrrdFields& fields, const fs::path& file, VolumeFileHeader& header) {
  std::uint64_t offset = fields.length;
  header.data.file = file;
  if (fields.has("datafile")) {
    const std::string name = fields.text("datafile");
    if (name.starts_with("LIST") || name.find('%') != std::string::npos) {
      return unknownFormat(tr("A NRRD header whose voxels are in several files is not read"), file,
                           tr("Export it as one .nrrd file"));
    }
    const auto data = fileBeside(file, name);
    if (!data) return data.error();
    header.data.file = *data;
    offset = 0;
  } else if (!fields.ended) {
    return unreadable(tr("The file has no voxels behind its header and names no data file"), file);
  }
  const auto lines = numberIn(fields.has("lineskip") ? fields.text("lineskip") : "0");
  const auto bytes = numberIn(fields.has("byteskip") ? fields.text("byteskip") : "0");
  if (!lines || !(*lines >= 0.0 && *lines <= 1e15) || !bytes ||
      !(*bytes >= -1.0 && *bytes <= 1e15)) {
    return unreadable(tr("The header's line skip or byte skip cannot be read"), file);
  }
  if (*bytes < 0.0) {
    if (header.data.packed) {
      return unknownFormat(tr("A byte skip of -1 in a gzip file is not read"), file,
                           tr("Export it without one"));
    }
    return placeVoxels(header, std::nullopt, file, offset);
  }
  const auto start = afterLines(header.data.file, offset, *lines);
  if (!start) return unreadable(tr("The file has fewer lines than its line skip"), file);
  // Bytes are counted in what comes out of gzip, lines in the file.
  if (header.data.packed) header.data.skip = std::uint64_t(*bytes);
  return placeVoxels(header, *start + (header.data.packed ? 0 : std::uint64_t(*bytes)), file);
}

}  // namespace

Result<VolumeFileHeader> readNrrdHeader(const fs::path& file) {
  const auto text = readStart(file, kMostNrrdHeader);
  if (!text) return text.error();
  const auto fields = nrrdFieldsOf(*text, file);
  if (!fields) return fields.error();
  for (const char* name : {"dimension", "type", "sizes", "encoding"}) {
    if (!fields->has(name)) {
      return unreadable(tr("The header has no field {}", name), file);
    }
  }
  if (auto status = checkKind(*fields, file); !status) return status.error();
  VolumeFileHeader header;
  header.format = "NRRD";
  const auto type = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const auto& row) {
    return row.second.contains(fields->word("type"));
  });
  if (type == std::end(kTypes)) {
    // Any other word could be a name.
    const bool block = fields->word("type") == "block";
    return notHu(tr("The voxels are not one number each{}", (block ? tr(" but 'block'") : "")),
                 file);
  }
  header.type = type->first;
  const std::string encoding = fields->word("encoding");
  header.data.packed = encoding == "gzip" || encoding == "gz";
  if (!header.data.packed && encoding != "raw") {
    return unknownFormat(tr("A NRRD file in the encoding {} is not read", shown(encoding)), file,
                         tr("Export it with the encoding raw or gzip"));
  }
  const std::string endian = fields->word("endian");
  if (endian != "little" && endian != "big" && !(endian.empty() && bytesOf(header.type) == 1)) {
    return unreadable(tr("The header does not say in which order bytes are (endian)"), file);
  }
  header.big_endian = endian == "big";
  const auto geometry = nrrdGeometry(*fields, header, file);
  if (!geometry) return geometry.error();
  header.geometry = *geometry;
  header.segments = fields->segments;
  if (auto status = settle(header, file); !status) return status.error();
  if (auto status = findNrrdVoxels(*fields, file, header); !status) return status.error();
  return header;
}

}  // namespace trephine::file_format
