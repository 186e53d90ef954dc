// Names in a NRRD follow 3D Slicer's keys (Segment0_Name, Segment0_Color, Segment0_Layer,
// Segment0_LabelValue), and a tissue is one of its tags (Segment0_Tags, "key:value|"), which it
// keeps; ITK-SNAP's text of labels has a line of number, red, green, blue, opacity, two marks and a
// quoted name for each.
#include "volume/segmentation_names.h"

#include <cmath>
#include <optional>
#include <sstream>

#include "base/json.h"
#include "base/tr.h"
#include "base/utf8.h"
#include "volume/codes.h"
#include "volume/file_format.h"

namespace trephine::file_format {

namespace fs = std::filesystem;

namespace {

using Segment = Segmentation::Segment;

constexpr Range kShares{0, 1};
constexpr std::size_t kMostText = std::size_t(1) << 20;

Result<std::vector<NamedLabel>> readSegmentNames(const fs::path& file) {
  const Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  JsonReader reader(*json, file.string());
  reader.format("trephine.structures", 1);
  std::vector<NamedLabel> labels;
  for (JsonReader& item : reader.objects("structures", kMostStructures)) {
    NamedLabel named;
    named.label = int(item.integer("label", kLabelNumbers));
    named.segment.name = structureName(item.text("name"));
    named.segment.colour = item.vec3("colour", kShares, labelColour(named.label));
    named.segment.tissue = item.text("tissue", "");
    if (named.segment.name.empty()) {
      item.fail("name", tr("The name is blank"), tr("Give each structure a name"));
    }
    for (const NamedLabel& other : labels) {
      if (other.label == named.label || sameName(other.segment.name, named.segment.name)) {
        item.fail("label", tr("The label or the name stands twice in the list"),
                  tr("Give each structure a label and a name of its own"));
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
    if (!kLabelNumbers.holds(number) || number != std::floor(number)) continue;
    NamedLabel named;
    named.label = int(number);
    named.segment.name = structureName(name.substr(1, name.size() - 2));
    named.segment.colour = glm::clamp(Vec3(red, green, blue) / 255.0, Vec3(0.0), Vec3(1.0));
    labels.push_back(std::move(named));
  }
  return labels.empty() ? std::nullopt : std::optional(std::move(labels));
}

}  // namespace

// "liver" of "liver.nii.gz" and of "liver.seg.nrrd".
fs::path withoutEndings(const fs::path& file) {
  std::string name = file.filename().string();
  for (const char* ending : {".gz", ".nii", ".nrrd", ".nhdr", ".mha", ".mhd", ".raw", ".seg"}) {
    if (endsWith(name, ending)) name.resize(name.size() - std::string(ending).size());
  }
  return file.parent_path() / name;
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
      return Error{code::kBadNames,
                   tr("The text beside the label map is no list of labels of ITK-SNAP"),
                   text_file.string(), tr("Export it again, or take it away")};
    }
  }
  return std::vector<NamedLabel>();
}

// 3D Slicer's own words on each segment, in the order of their numbers.
std::vector<NamedLabel> segmentsNamedIn(const VolumeFileHeader& header) {
  std::vector<NamedLabel> segments;
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
    NamedLabel named;
    Segment& segment = named.segment;
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
    named.label = int(number("LabelValue", header.layers > 1 ? 1 : n + 1, kLabelNumbers.high));
    segments.push_back(std::move(named));
    if (n > 4096) return segments;
  }
}

}  // namespace trephine::file_format
