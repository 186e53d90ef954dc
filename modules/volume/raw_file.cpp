// Raw voxels (NAME.raw) with a sidecar (NAME.json) that says what they are:
// resources/schemas/raw.md.
#include "base/codes.h"
#include "base/json.h"
#include "base/tr.h"
#include "volume/codes.h"
#include "volume/file_format.h"

namespace trephine::file_format {

namespace fs = std::filesystem;

namespace {

constexpr const char* kExample =
    R"({"size": [512, 512, 300], "spacing_mm": [0.5, 0.5, 0.8], "type": "int16", )"
    R"("byte_order": "little"})";

Error noSidecar(const fs::path& raw) {
  for (const char* ending : {".mhd", ".nhdr"}) {
    if (const auto header = sibling(raw, ending)) {
      return Error{code::kNoSidecar, tr("This file holds voxels alone"), raw.string(),
                   tr("Open {}, which may say what they are", header->filename().string())};
    }
  }
  return Error{code::kNoSidecar,
               tr("A .raw file holds voxels alone; a sidecar has to say what they are"),
               raw.string(),
               tr("Write {} beside it, at least {}",
                  fs::path(raw).replace_extension(".json").filename().string(), kExample)};
}

std::optional<VoxelType> typeFrom(const std::string& name) {
  for (int type = 0; type <= int(VoxelType::float64); ++type) {
    if (name == voxelTypeName(VoxelType(type))) return VoxelType(type);
  }
  return std::nullopt;
}

constexpr Range kSize{1, 1e6, "voxels"};
constexpr Range kSpacing_mm{1e-6, 1000, "mm"};
constexpr Range kOrigin_mm{-1e6, 1e6, "mm"};
constexpr Range kHeaderBytes{0, 1e12, "bytes"};
constexpr Range kScaling{-1e9, 1e9};  // what the voxels become is clamped to 16 bits

Status readSidecar(JsonReader& fields, const fs::path& file, VolumeFileHeader& header) {
  GridGeometry& g = header.geometry;
  const auto size = fields.integers("size", 3, kSize);
  g.spacing_mm = fields.vec3("spacing_mm", kSpacing_mm);
  const std::string name = fields.text("type");
  const auto type = typeFrom(name);
  if (!type)
    fields.fail("type", tr("The type {} is not known", shown(name)),
                tr("Write int16, uint16, int8, uint8, int32, uint32, float32 or float64"));
  header.type = type.value_or(VoxelType::int16);
  const std::string order =
      bytesOf(header.type) == 1 ? fields.text("byte_order", "little") : fields.text("byte_order");
  if (order != "little" && order != "big") {
    fields.fail("byte_order", tr("The byte order {} is not known", shown(order)),
                tr("Write little or big"));
  }
  header.big_endian = order == "big";
  const std::int64_t skipped = fields.integer("header_bytes", kHeaderBytes, 0);
  header.slope = fields.number("slope", kScaling, 1.0);
  header.intercept = fields.number("intercept", kScaling, 0.0);
  if (fields.has("origin_mm")) {
    g.origin_mm = fields.vec3("origin_mm", kOrigin_mm);
  } else {
    header.notes.push_back(tr("The sidecar gives no origin_mm: the first voxel is put at 0, 0, 0"));
  }
  if (fields.has("direction")) {
    // Row-major, its columns the i, j and k axes in LPS, as an import report has it.
    const auto rows = fields.numbers("direction", 9, {-1.01, 1.01});
    for (int i = 0; i < 9; ++i) g.direction[i % 3][i / 3] = rows[std::size_t(i)];
  } else {
    header.notes.push_back(tr(
        "The sidecar gives no direction: rows are taken to run to the patient's left, columns to "
        "the back and slices to the head"));
  }
  if (auto status = fields.finish(); !status) return status;
  const auto whole = sizeFrom({double(size[0]), double(size[1]), double(size[2])}, file);
  if (!whole) return whole.error();
  g.size = *whole;
  if (auto status = settle(header, file); !status) return status;
  // Nothing else in a raw file could show that size or type are wrong.
  std::error_code ec;
  const std::uint64_t all = fs::file_size(header.data.file, ec), skip = std::uint64_t(skipped);
  if (!ec && all > skip && all - skip != header.storedBytes()) {
    return unreadable(
        tr("The .raw file holds {} bytes of voxels, but its sidecar's size and type need {}",
           all - skip, header.storedBytes()),
        header.data.file);
  }
  return placeVoxels(header, skip, header.data.file);
}

}  // namespace

std::optional<fs::path> sibling(const fs::path& file, const std::string& ending) {
  std::string capitals = ending;
  for (char& c : capitals) c = c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
  for (const std::string& either : {ending, capitals}) {
    const fs::path path = fs::path(file).replace_extension(either);
    std::error_code ec;
    if (fs::is_regular_file(path, ec)) return path;
  }
  return std::nullopt;
}

Result<VolumeFileHeader> readRawHeader(const fs::path& file) {
  const bool is_sidecar = endsWith(file, ".json");
  const auto raw = is_sidecar ? sibling(file, ".raw") : file;
  if (!raw) {
    return Error{code::kMissingFile, tr("There is no .raw file of this name beside the sidecar"),
                 file.string(), tr("Put both into one folder")};
  }
  const auto sidecar = is_sidecar ? file : sibling(file, ".json");
  if (!sidecar) return noSidecar(*raw);
  const auto json = readJsonFile(*sidecar);
  if (!json) return json.error();
  VolumeFileHeader header;
  header.format = "raw";
  header.data.file = *raw;
  JsonReader fields(*json, sidecar->string());
  if (auto status = readSidecar(fields, *sidecar, header); !status) return status.error();
  return header;
}

}  // namespace trephine::file_format
