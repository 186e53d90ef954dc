// Segmentations as files: layers of a NRRD as 3D Slicer writes them, and label maps of any format
// with their names beside them (segmentation_names.h); folders of masks.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <set>

#include "base/codes.h"
#include "base/file.h"
#include "base/json.h"
#include "base/memory.h"
#include "base/purpose.h"
#include "base/tr.h"
#include "base/utf8.h"
#include "volume/case_memory.h"
#include "volume/codes.h"
#include "volume/file_format.h"
#include "volume/grid_place.h"
#include "volume/gzip_writer.h"
#include "volume/segmentation.h"
#include "volume/segmentation_names.h"
#include "volume/voxel_reader.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;
using namespace file_format;
using Segment = Segmentation::Segment;

Error tooMany(std::size_t count, const fs::path& file) {
  return Error{code::kTooManyStructures,
               tr("The file has {} structures, and a case holds {}", count, kMostStructures),
               file.string(), tr("Export those that the exercise needs")};
}

Error notLabels(const std::string& what, const fs::path& file) {
  return Error{code::kNotLabels, what, file.string(),
               tr("Choose a label map: a whole number for each voxel, 0 for none")};
}

// The values of a layer as a case counts: what is at most 255 stays, what is above takes what is
// left. Nothing where there are too many.
std::optional<std::map<int, std::uint8_t>> renumbered(const std::set<int>& values) {
  std::map<int, std::uint8_t> numbers{{0, 0}};
  for (const int value : values) {
    if (value <= 255) numbers[value] = std::uint8_t(value);
  }
  int next = 1;
  for (const int value : values) {
    if (value <= 255) continue;
    while (next < 256 && values.contains(next)) ++next;
    if (next > 255) return std::nullopt;
    numbers[value] = std::uint8_t(next++);
  }
  return numbers;
}

// A file's layers, and what it calls each of their values.
struct Layers {
  Segmentation of;
  std::vector<NamedLabel> named;            // by the file itself
  std::vector<std::array<int, 256>> calls;  // by layer and value: its number in the file
};

// The layers of a file: its values in turn.
Result<Layers> layersOf(const fs::path& file, const Progress& progress, const std::string& form) {
  auto header = readVolumeFileHeader(file);
  if (header) header = inForm(*std::move(header), form, file);
  if (!header && header.error().code == code::kNotHu) return notLabels(header.error().what, file);
  if (!header && header.error().code == code::kUnknownFormat) {
    Error error = header.error();
    error.next =
        tr("Choose a DICOM SEG, a .seg.nrrd, or a label map as .nrrd, .mha, .nii or .nii.gz");
    return error;
  }
  if (!header) return header.error();
  const auto layers = std::size_t(header->layers);
  const std::size_t voxels = header->geometry.voxelCount();
  if (Status enough = enoughMemory(labelsMb(voxels * layers) + voxelsMb(voxels * layers),
                                   tr("The label map"), file.string());
      !enough) {
    return enough.error();
  }
  Layers all;
  Segmentation& of = all.of;
  of.format = header->format;
  of.geometry = header->geometry;
  of.notes = header->notes;
  all.named = segmentsNamedIn(*header);
  // Read as a volume whose rows hold the layers of each voxel one after another.
  if (double(header->geometry.size[0]) * double(layers) > 2e9) {
    return unreadable(tr("The image's rows and layers are too many"), file);
  }
  VolumeFileHeader wide = *std::move(header);
  wide.geometry.size[0] *= wide.layers;
  wide.layers = 1;
  auto read = readVoxels(std::move(wide), file, progress);
  if (!read) {
    return read.error().code == code::kNotHu ? notLabels(read.error().what, file) : read.error();
  }
  // Labels that a slope has spread over 16 bits look like anything.
  if (read->bytes_exchanged && read->header.slope == 1.0) {
    return notLabels(tr("The bytes of each voxel stand in another order than the header says"),
                     file);
  }
  if (read->rounded + read->not_numbers > 0) {
    return notLabels(
        tr("{} of the voxels are not whole numbers", read->rounded + read->not_numbers), file);
  }
  if (read->hu_min < 0.0 || read->hu_max > kLabelNumbers.high) {
    constexpr double kMost = 1e15;  // that the number below holds
    const double value =
        std::clamp(read->hu_min < 0.0 ? read->hu_min : read->hu_max, -kMost, kMost);
    return notLabels(tr("The value {} is no label: 1 to {} are read", std::int64_t(value),
                        int(kLabelNumbers.high)),
                     file);
  }
  const Voxels& values = read->volume.hu;
  of.layers.assign(layers, std::vector<std::uint8_t>(voxels));
  for (std::size_t l = 0; l < layers; ++l) {
    std::vector<bool> seen(std::size_t(kLabelNumbers.high) + 1);
    for (std::size_t v = 0; v < voxels; ++v) seen[std::size_t(values[v * layers + l])] = true;
    if (of.format == "NIfTI") {  // whose lists name all that could be there
      std::erase_if(all.named, [&](const NamedLabel& n) { return !seen[std::size_t(n.label)]; });
    }
    for (const NamedLabel& named : all.named) {
      if (named.segment.layer == l && named.label <= 255) seen[std::size_t(named.label)] = true;
    }
    std::set<int> used;
    for (std::size_t n = 1; n < seen.size(); ++n) {
      if (seen[n]) used.insert(int(n));
    }
    const auto numbers = renumbered(used);
    if (!numbers) return tooMany(used.size(), file);
    std::vector<std::uint8_t> table(seen.size());
    std::array<int, 256> calls{};
    for (const auto& [number, value] : *numbers) {
      table[std::size_t(number)] = value;
      calls[value] = number;
    }
    for (std::size_t v = 0; v < voxels; ++v) {
      of.layers[l][v] = table[std::size_t(values[v * layers + l])];
    }
    for (int value = 1; value < 256; ++value) {
      if (calls[std::size_t(value)] == 0) calls[std::size_t(value)] = value;
    }
    all.calls.push_back(calls);
    for (NamedLabel& named : all.named) {
      if (named.segment.layer == l) named.segment.value = table[std::size_t(named.label)];
    }
    if (!used.empty() && *used.rbegin() > 255) {
      of.notes.push_back(tr("Labels above 255 were given numbers that are free; the largest was {}",
                            *used.rbegin()));
    }
  }
  return all;
}

// Segments that the file speaks of and does not have, and values that it has and is silent about.
// Of a label map of one layer the names may be those of a file beside it.
void settleSegments(const std::vector<NamedLabel>& beside, const Layers& all, Segmentation& of) {
  const bool own = !all.named.empty();
  for (const NamedLabel& named : all.named) {
    if (named.segment.layer < of.layers.size() && named.segment.value != 0) {
      of.segments.push_back(named.segment);
    } else {
      of.notes.push_back(tr("'{}' stands in the list and not in the voxels", named.segment.name));
    }
  }
  of.named = own || !beside.empty();
  for (std::size_t l = 0; l < of.layers.size(); ++l) {
    std::array<bool, 256> known{}, used{};
    for (const Segment& s : of.segments) {
      if (s.layer == l) known[s.value] = true;
    }
    for (const std::uint8_t value : of.layers[l]) used[value] = true;
    for (int value = 1; value < 256; ++value) {
      const int number = all.calls[l][std::size_t(value)];
      const auto named = std::find_if(beside.begin(), beside.end(),
                                      [&](const NamedLabel& n) { return n.label == number; });
      const bool listed = !own && l == 0 && named != beside.end();
      if (known[std::size_t(value)] || !(used[std::size_t(value)] || listed)) continue;
      Segment segment;
      segment.colour = labelColour(value);
      if (number != value) segment.name = "label " + std::to_string(number);
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
      progress.at(double(k) / slices, tr("Saving the structures"));
      if (progress.cancelled()) return Error{code::kCancelled, tr("Saving was cancelled"), "", ""};
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

namespace {

Result<Segmentation> readFile(const fs::path& file, const Progress& progress,
                              const std::string& form) {
  Result<Layers> all = layersOf(file, progress, form);
  if (!all) return all.error();
  Result<std::vector<NamedLabel>> beside = std::vector<NamedLabel>();
  if (all->named.empty()) beside = namesBeside(file);
  if (!beside) return beside.error();
  Segmentation of = std::move(all->of);
  settleSegments(*beside, *all, of);
  if (of.segments.size() > std::size_t(kMostStructures)) return tooMany(of.segments.size(), file);
  return of;
}

// Of one structure each: all its voxels that are not 0.
struct Mask {
  std::string name;
  std::vector<std::uint8_t> inside;  // 0 or 1
};

// Into the first layer in which it shares no voxel with another: few are needed.
Status addMask(const Mask& mask, Segmentation& of, std::vector<int>& values) {
  std::size_t layer = 0;
  for (; layer < of.layers.size(); ++layer) {
    const std::vector<std::uint8_t>& taken = of.layers[layer];
    bool free = values[layer] < 255;
    for (std::size_t v = 0; free && v < taken.size(); ++v) free = !(mask.inside[v] && taken[v]);
    if (free) break;
  }
  if (layer == of.layers.size()) {
    const std::size_t voxels = mask.inside.size();
    if (Status enough = enoughMemory(labelsMb(voxels), tr("The masks"), mask.name); !enough) {
      return enough;
    }
    of.layers.emplace_back(voxels);
    values.push_back(0);
  }
  const auto value = std::uint8_t(++values[layer]);
  for (std::size_t v = 0; v < mask.inside.size(); ++v) {
    if (mask.inside[v]) of.layers[layer][v] = value;
  }
  of.segments.push_back({mask.name, labelColour(int(of.segments.size()) + 1), "", layer, value});
  return {};
}

// A folder of masks, as TotalSegmentator writes them: a structure in each file, called after it.
Result<Segmentation> readMasks(const fs::path& folder, const Progress& progress,
                               const std::string& form) {
  std::vector<fs::path> files;
  std::error_code ec;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    const bool voxels = isVolumeFile(it->path()) && !endsWith(it->path(), ".json");
    if (voxels && it->is_regular_file(ec)) files.push_back(it->path());
  }
  if (files.empty()) {
    return notLabels(tr("The folder holds no masks: no volume file of a structure each"), folder);
  }
  if (files.size() > std::size_t(kMostStructures)) return tooMany(files.size(), folder);
  std::ranges::sort(files);
  const std::string take_out = tr("Take it out of the folder, which is to hold masks alone");
  Segmentation all;
  std::vector<int> values;
  for (std::size_t n = 0; n < files.size(); ++n) {
    const double count = double(files.size());
    const Progress part(progress, double(n) / count, double(n + 1) / count);
    Result<Segmentation> one = readFile(files[n], part, form);
    if (!one) {
      Error error = one.error();
      if (error.code != code::kCancelled) error.next = take_out;
      return error;
    }
    const std::string name = structureName(withoutEndings(files[n]).filename().string());
    if (one->layers.size() > 1 || one->segments.size() > 1) {
      return Error{
          code::kNotLabels,
          tr("Of a folder of masks each file holds one structure, and '{}' holds several", name),
          files[n].string(), take_out};
    }
    if (n == 0) all.geometry = one->geometry;
    constexpr double kSame = 0.01;  // of a voxel
    const Vec3& mm = all.geometry.spacing_mm;
    if (cornersApart_mm(one->geometry, all.geometry) > kSame * std::min({mm.x, mm.y, mm.z})) {
      return Error{code::kOtherGrid, tr("The masks of the folder do not lie on one grid"),
                   files[n].string(), tr("Export them from one CT, or open them one by one")};
    }
    for (std::uint8_t& voxel : one->layers.front()) voxel = voxel != 0;
    const Status added = addMask({name, std::move(one->layers.front())}, all, values);
    if (!added) return added.error();
  }
  all.format = "masks";
  return all;
}

}  // namespace

Result<Segmentation> readSegmentation(const fs::path& file, const Progress& progress,
                                      const std::string& form) {
  try {
    std::error_code ec;
    const bool folder = fs::is_directory(file, ec);
    return folder ? readMasks(file, progress, form) : readFile(file, progress, form);
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the label map"), file.string());
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
