// Segmentations as files: layers of a NRRD as 3D Slicer writes them, and label maps of any format
// with their names beside them. Names in a NRRD follow 3D Slicer's keys (Segment0_Name,
// Segment0_Color, Segment0_Layer, Segment0_LabelValue), and a tissue is one of its tags
// (Segment0_Tags, "key:value|"), which it keeps; ITK-SNAP's text of labels has a line of
// number, red, green, blue, opacity, two marks and a quoted name for each.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <new>
#include <optional>
#include <sstream>

#include "base/file.h"
#include "base/json.h"
#include "base/memory.h"
#include "base/purpose.h"
#include "base/utf8.h"
#include "volume/case_memory.h"
#include "volume/file_format.h"
#include "volume/gzip_writer.h"
#include "volume/segmentation.h"
#include "volume/voxel_reader.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;
using namespace file_format;
using Segment = Segmentation::Segment;

constexpr Range kLabels{1, 255}, kShares{0, 1};
constexpr std::string_view kTissueTag = "Trephine.Tissue:";
constexpr std::size_t kMostText = std::size_t(1) << 20;

Error tooMany(std::size_t count, const fs::path& file) {
  return Error{"TOO_MANY_STRUCTURES",
               "The file has " + std::to_string(count) + " structures, and a case holds " +
                   std::to_string(kMostStructures),
               file.string(), "Export those that the exercise needs"};
}

Error notLabels(const std::string& what, const fs::path& file) {
  return Error{"NOT_LABELS", what, file.string(),
               "Choose a label map: a whole number from 0 to 255 for each voxel, 0 for none"};
}

// "liver" of "liver.nii.gz" and of "liver.seg.nrrd".
fs::path withoutEndings(const fs::path& file) {
  std::string name = file.filename().string();
  for (const char* ending : {".gz", ".nii", ".nrrd", ".nhdr", ".mha", ".mhd", ".raw", ".seg"}) {
    if (endsWith(name, ending)) name.resize(name.size() - std::string(ending).size());
  }
  return file.parent_path() / name;
}

// What a number stands for, where a file beside the label map says so.
struct NamedLabel {
  int label = 0;
  Segment segment;
};

Result<std::vector<NamedLabel>> readSegmentNames(const fs::path& file) {
  const Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  JsonReader reader(*json, file.string());
  reader.format("trephine.structures", 1);
  std::vector<NamedLabel> labels;
  for (JsonReader& item : reader.objects("structures", kMostStructures)) {
    NamedLabel named;
    named.label = int(item.integer("label", kLabels));
    named.segment.name = structureName(item.text("name"));
    named.segment.colour = item.vec3("colour", kShares, labelColour(named.label));
    named.segment.tissue = item.text("tissue", "");
    if (named.segment.name.empty()) {
      item.fail("name", "The name is blank", "Give each structure a name");
    }
    for (const NamedLabel& other : labels) {
      if (other.label == named.label || sameName(other.segment.name, named.segment.name)) {
        item.fail("label", "The label or the name stands twice in the list",
                  "Give each structure a label and a name of its own");
      }
    }
    labels.push_back(std::move(named));
  }
  if (Status status = reader.finish(); !status) return status.error();
  return labels;
}

// Nothing where the text is none of ITK-SNAP's.
std::optional<std::vector<NamedLabel>> labelsIn(const std::string& text) {
  std::vector<NamedLabel> labels;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    line = trimmed(line);
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    double number = 0, red = 0, green = 0, blue = 0, opacity = 0, visible = 0, mesh = 0;
    if (!(words >> number >> red >> green >> blue >> opacity >> visible >> mesh)) return {};
    std::string name;
    std::getline(words, name);
    name = trimmed(name);
    if (name.size() < 2 || name.front() != '"' || name.back() != '"') return {};
    if (number == 0.0) continue;  // "Clear Label"
    if (!kLabels.holds(number) || number != std::floor(number)) continue;
    NamedLabel named;
    named.label = int(number);
    named.segment.name = structureName(name.substr(1, name.size() - 2));
    named.segment.colour = glm::clamp(Vec3(red, green, blue) / 255.0, Vec3(0.0), Vec3(1.0));
    labels.push_back(std::move(named));
  }
  return labels.empty() ? std::nullopt : std::optional(std::move(labels));
}

// Names from a file beside the label map; none where there is none.
Result<std::vector<NamedLabel>> namesBeside(const fs::path& file) {
  std::error_code ec;
  if (const fs::path sidecar = structuresFile(file); fs::exists(sidecar, ec)) {
    return readSegmentNames(sidecar);
  }
  for (const char* ending : {".label", ".txt"}) {
    const fs::path text_file = withoutEndings(file).string() + ending;
    if (!fs::is_regular_file(text_file, ec)) continue;
    const auto text = readStart(text_file, kMostText);
    const auto labels = text ? labelsIn(*text) : std::nullopt;
    if (labels) return *labels;
    if (std::string(ending) == ".label" || (text && text->find("ITK-SnAP") != text->npos)) {
      return Error{"BAD_NAMES", "The text beside the label map is no list of labels of ITK-SNAP",
                   text_file.string(), "Export it again, or take it away"};
    }
  }
  return std::vector<NamedLabel>();
}

// 3D Slicer's own words on each segment, in the order of their numbers.
std::vector<Segment> slicerSegments(const VolumeFileHeader& header) {
  std::vector<Segment> segments;
  for (int n = 0;; ++n) {
    const auto text = [&](const char* key) -> std::optional<std::string> {
      const auto found = header.segments.find("Segment" + std::to_string(n) + "_" + key);
      if (found == header.segments.end()) return {};
      return trimmed(found->second);
    };
    if (!text("ID") && !text("Name")) return segments;
    const auto number = [&](const char* key, double otherwise, double most) {
      const auto given = numberIn(text(key).value_or(""));
      return given && *given >= 0.0 && *given <= most ? *given : otherwise;
    };
    Segment segment;
    segment.name = structureName(text("Name").value_or(text("ID").value_or("")));
    const auto colour = numbersIn(text("Color").value_or(""));
    segment.colour = colour && colour->size() == 3
                         ? glm::clamp(Vec3((*colour)[0], (*colour)[1], (*colour)[2]), 0.0, 1.0)
                         : labelColour(n + 1);
    const std::string tags = text("Tags").value_or("");
    if (const std::size_t at = tags.find(kTissueTag); at != tags.npos) {
      const std::size_t from = at + kTissueTag.size();
      segment.tissue = cleanUtf8(tags.substr(from, tags.find('|', from) - from));
    }
    // Before there were values and layers, each had a layer of its own, of 0 and 1.
    const bool old = !text("LabelValue");
    segment.layer = std::size_t(number("Layer", old && header.layers > 1 ? n : 0, 255.0));
    segment.value = std::uint8_t(number("LabelValue", header.layers > 1 ? 1 : n + 1, 255.0));
    segments.push_back(std::move(segment));
    if (n > 4096) return segments;
  }
}

// The layers of a file: its values in turn.
Result<Segmentation> layersOf(const fs::path& file, const Progress& progress) {
  auto header = readVolumeFileHeader(file);
  if (!header && header.error().code == "NOT_HU") return notLabels(header.error().what, file);
  if (!header && header.error().code == "UNKNOWN_FORMAT") {
    Error error = header.error();
    error.next = "Choose a DICOM SEG, a .seg.nrrd, or a label map as .nrrd, .mha, .nii or .nii.gz";
    return error;
  }
  if (!header) return header.error();
  const auto layers = std::size_t(header->layers);
  const std::size_t voxels = header->geometry.voxelCount();
  if (Status enough = enoughMemory(labelsMb(voxels * layers) + voxelsMb(voxels * layers),
                                   "The label map", file.string());
      !enough) {
    return enough.error();
  }
  Segmentation of;
  of.format = header->format;
  of.geometry = header->geometry;
  of.notes = header->notes;
  of.segments = slicerSegments(*header);
  // Read as a volume whose rows hold the layers of each voxel one after another.
  if (double(header->geometry.size[0]) * double(layers) > 2e9) {
    return unreadable("The image's rows and layers are too many", file);
  }
  VolumeFileHeader wide = *std::move(header);
  wide.geometry.size[0] *= wide.layers;
  wide.layers = 1;
  auto read = readVoxels(std::move(wide), file, progress);
  if (!read) {
    return read.error().code == "NOT_HU" ? notLabels(read.error().what, file) : read.error();
  }
  if (read->rounded + read->not_numbers > 0) {
    return notLabels(
        std::to_string(read->rounded + read->not_numbers) + " of the voxels are not whole numbers",
        file);
  }
  if (read->hu_min < 0.0 || read->hu_max > 255.0) {
    constexpr double kMost = 1e15;  // that the number below holds
    const double value =
        std::clamp(read->hu_min < 0.0 ? read->hu_min : read->hu_max, -kMost, kMost);
    return notLabels("The value " + std::to_string(std::int64_t(value)) + " is no label", file);
  }
  const Voxels& values = read->volume.hu;
  of.layers.assign(layers, std::vector<std::uint8_t>(voxels));
  for (std::size_t l = 0; l < layers; ++l) {
    for (std::size_t v = 0; v < voxels; ++v) of.layers[l][v] = std::uint8_t(values[v * layers + l]);
  }
  return of;
}

// Segments that the file speaks of and does not have, and values that it has and is silent about.
void settleSegments(const std::vector<NamedLabel>& beside, Segmentation& of) {
  const bool own = !of.segments.empty();
  std::erase_if(of.segments, [&](const Segment& s) {
    const bool gone = s.layer >= of.layers.size() || s.value == 0;
    if (gone) {
      of.notes.push_back("'" + s.name + "' stands in the list and not in the voxels");
    }
    return gone;
  });
  of.named = own || !beside.empty();
  for (std::size_t l = 0; l < of.layers.size(); ++l) {
    std::array<bool, 256> known{}, used{};
    for (const Segment& s : of.segments) {
      if (s.layer == l) known[s.value] = true;
    }
    for (const std::uint8_t value : of.layers[l]) used[value] = true;
    for (int value = 1; value < 256; ++value) {
      const auto named = std::find_if(beside.begin(), beside.end(),
                                      [&](const NamedLabel& n) { return n.label == value; });
      const bool listed = !own && l == 0 && named != beside.end();
      if (known[std::size_t(value)] || !(used[std::size_t(value)] || listed)) continue;
      Segment segment;
      segment.colour = labelColour(value);
      if (listed) segment = named->segment;
      segment.layer = l;
      segment.value = std::uint8_t(value);
      of.segments.push_back(std::move(segment));
    }
  }
}

std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  std::string out;
  for (const char c : text) out += c == '\\' ? "\\\\" : std::string(1, c);
  return out;
}

// `reversed`: the last slice comes first.
std::string nrrdHeader(const LabelMap& map, bool reversed) {
  GridGeometry g = map.geometry;
  if (reversed) {
    g.origin_mm = g.toPatient_mm(Vec3(0, 0, g.size[2] - 1));
    g.direction[2] = -g.direction[2];
  }
  char line[512];
  std::string text = std::string("NRRD0004\n# Made by Trephine: ") + kPurpose +
                     "\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\n";
  std::snprintf(line, sizeof line, "sizes: %d %d %d\n", g.size[0], g.size[1], g.size[2]);
  text += line;
  text += "space directions:";
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = g.direction[axis] * g.spacing_mm[axis];
    std::snprintf(line, sizeof line, " (%.17g,%.17g,%.17g)", step.x, step.y, step.z);
    text += line;
  }
  std::snprintf(line, sizeof line, "\nspace origin: (%.17g,%.17g,%.17g)\n", g.origin_mm.x,
                g.origin_mm.y, g.origin_mm.z);
  text += line;
  text += "kinds: domain domain domain\nencoding: gzip\n";
  text +=
      "Segmentation_ContainedRepresentationNames:=Binary labelmap|\n"
      "Segmentation_MasterRepresentation:=Binary labelmap\n"
      "Segmentation_ReferenceImageExtentOffset:=0 0 0\n";
  std::snprintf(line, sizeof line, "Extent:=0 %d 0 %d 0 %d\n", g.size[0] - 1, g.size[1] - 1,
                g.size[2] - 1);
  const std::string extent = line;
  int n = 0;
  for (const Structure& s : map.structures) {
    const std::string key = "Segment" + std::to_string(n++) + "_";
    std::snprintf(line, sizeof line, "%.6g %.6g %.6g", s.colour.x, s.colour.y, s.colour.z);
    text += key + "Color:=" + line + "\n" + key + extent + key + "ID:=Segment_" +
            std::to_string(s.label) + "\n" + key + "LabelValue:=" + std::to_string(s.label) + "\n" +
            key + "Layer:=0\n" + key + "Name:=" + oneLine(s.name) + "\n";
    if (s.tissue.empty()) continue;
    text += key + "Tags:=" + std::string(kTissueTag) + oneLine(s.tissue) + "|\n";
  }
  return text + "\n";
}

Status writeNrrd(const LabelMap& map, const fs::path& target, bool reversed,
                 const Progress& progress) {
  return replaceFile(target, [&](const fs::path& temporary) -> Status {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(temporary.c_str(), "wbe"),
                                                         std::fclose);
    if (!file) return cannotWrite(target);
    const std::string header = nrrdHeader(map, reversed);
    bool good = std::fwrite(header.data(), 1, header.size(), file.get()) == header.size();
    GzipWriter gzip(file.get());
    const std::span<const std::byte> all = std::as_bytes(std::span(map.labels));
    const int slices = map.geometry.size[2];
    const std::size_t slice = all.size() / std::size_t(slices);
    for (int k = 0; good && k < slices; ++k) {
      progress.at(double(k) / slices, "Saving the structures");
      if (progress.cancelled()) return Error{"CANCELLED", "Saving was cancelled", "", ""};
      good = gzip.write(all.subspan(std::size_t(reversed ? slices - 1 - k : k) * slice, slice));
    }
    good = good && gzip.finish();
    return std::fclose(file.release()) == 0 && good ? Status() : cannotWrite(target);
  });
}

std::string sidecarText(const LabelMap& map) {
  Json rows = Json::array();
  for (const Structure& s : map.structures) {
    Json row = {
        {"label", s.label}, {"name", s.name}, {"colour", {s.colour.x, s.colour.y, s.colour.z}}};
    if (!s.tissue.empty()) row["tissue"] = s.tissue;
    rows.push_back(std::move(row));
  }
  const Json all = {{"format", "trephine.structures"},
                    {"version", 1},
                    {"purpose", kPurpose},
                    {"structures", std::move(rows)}};
  return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

fs::path structuresFile(const fs::path& label_map_file) {
  return withoutEndings(label_map_file).string() + ".structures.json";
}

Result<Segmentation> readSegmentation(const fs::path& file, const Progress& progress) {
  try {
    Result<Segmentation> of = layersOf(file, progress);
    if (!of) return of.error();
    Result<std::vector<NamedLabel>> beside = std::vector<NamedLabel>();
    if (of->segments.empty()) beside = namesBeside(file);
    if (!beside) return beside.error();
    settleSegments(*beside, *of);
    if (of->segments.size() > std::size_t(kMostStructures)) {
      return tooMany(of->segments.size(), file);
    }
    return of;
  } catch (const std::bad_alloc&) {
    return outOfMemory("for the label map", file.string());
  }
}

Status writeSegmentation(const LabelMap& map, const fs::path& file, bool reversed_slices,
                         const Progress& progress) {
  if (endsWith(file, ".nrrd")) return writeNrrd(map, file, reversed_slices, progress);
  // Map and names are both written before either takes its place, and no map is ever beside the
  // names of another: whatever ends this in between, it has none.
  const fs::path names = structuresFile(file);
  std::error_code ec;
  fs::path new_map = file, old_names = names;
  new_map.replace_filename(".new-" + file.filename().string());
  old_names.replace_filename(".old-" + names.filename().string());
  const Status written = replaceFile(names, [&](const fs::path& temporary) -> Status {
    if (Status text = writeTextFile(temporary, sidecarText(map)); !text) return text;
    if (Status voxels = writeLabelMap(map, new_map, reversed_slices, progress); !voxels) {
      Error error = voxels.error();
      error.where = file.string();
      return error;
    }
    fs::rename(names, old_names, ec);
    const bool had_names = !ec;
    if (ec && ec != std::errc::no_such_file_or_directory) return writeError(names, ec.value());
    fs::rename(new_map, file, ec);
    if (!ec) return {};
    const int error = ec.value();
    if (had_names) fs::rename(old_names, names, ec);
    return writeError(file, error);
  });
  fs::remove(written ? old_names : new_map, ec);
  return written;
}

}  // namespace trephine
