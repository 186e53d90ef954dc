// The lines of pictures.json: what is drawn, of which case, from where.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "base/json.h"
#include "render/view_camera.h"
#include "tissue/tissue_look.h"
#include "ui/views/slice_image.h"

namespace trephine::test {

enum class CaseGrid { exercise, oblique, tilted };

struct GoldenLine {
  std::string name;      // of the PNG
  std::string exercise;  // of resources/exercises
  CaseGrid grid = CaseGrid::exercise;
  std::string shows;  // the tissue without which it is another picture
  double ssim = 0.0;  // at least, between a picture and its golden one
  double zoom = 1.0;

  // In 3-D.
  std::optional<ViewPreset> preset;  // none: the looks of the exercise
  std::optional<StandardView> side;  // none: the exercise's own view
  std::vector<double> orbit_deg;     // from there to the right and up
  bool outline = false;              // the exercise's
  std::vector<double> carved_mm;  // radius and depth of a hole at the view's landmark; none: {0, 0}

  // A slice.
  std::optional<SliceAxis> slice;
  Vec3 at_mm{0.0};
  std::size_t window = 0;  // of kWindowPresets
  Overlay overlay = Overlay::none;
};

inline void PrintTo(const GoldenLine& line, std::ostream* out) {
  *out << line.name;
}

namespace golden {

// The value of a word in a list of pairs or names; the reader is told where it is none of them.
template <class Value>
std::optional<Value> chosen(JsonReader& reader, const char* key,
                            const std::vector<std::pair<std::string, Value>>& choices) {
  const std::string word = reader.text(key, "");
  if (word.empty()) return std::nullopt;
  std::string known;
  for (const auto& [name, value] : choices) {
    if (name == word) return value;
    known += (known.empty() ? "" : ", ") + name;
  }
  reader.fail(key, "is '" + word + "'", "Choose one of: " + known);
  return std::nullopt;
}

inline GoldenLine lineOf(JsonReader reader) {
  GoldenLine line;
  line.name = reader.text("name");
  line.exercise = reader.text("scene");
  line.grid = chosen<CaseGrid>(reader, "grid",
                               {{"oblique", CaseGrid::oblique}, {"tilted", CaseGrid::tilted}})
                  .value_or(CaseGrid::exercise);
  line.shows = reader.text("shows");
  line.ssim = reader.number("ssim", {0.5, 1.0});
  line.zoom = reader.number("zoom", {0.1, 10.0}, 1.0);
  line.slice = chosen<SliceAxis>(reader, "slice",
                                 {{"axial", SliceAxis::axial},
                                  {"coronal", SliceAxis::coronal},
                                  {"sagittal", SliceAxis::sagittal}});
  if (line.slice) {
    std::vector<std::pair<std::string, std::size_t>> windows;
    for (std::size_t i = 0; i < kWindowPresets.size(); ++i) {
      windows.emplace_back(kWindowPresets[i].name, i);
    }
    line.at_mm = reader.vec3("at_mm", {-1000.0, 1000.0, "mm"});
    line.window = chosen(reader, "window", windows).value_or(kFirstPreset);
    line.overlay = chosen<Overlay>(reader, "overlay",
                                   {{"tissues", Overlay::tissues}, {"labels", Overlay::labels}})
                       .value_or(Overlay::none);
    return line;
  }
  line.preset = chosen<ViewPreset>(reader, "preset",
                                   {{"bone", ViewPreset::bone},
                                    {"skin", ViewPreset::skin},
                                    {"soft tissue", ViewPreset::soft_tissue},
                                    {"liver", ViewPreset::liver}});
  line.side = chosen<StandardView>(reader, "side",
                                   {{"anterior", StandardView::anterior},
                                    {"posterior", StandardView::posterior},
                                    {"left", StandardView::left},
                                    {"right", StandardView::right},
                                    {"superior", StandardView::superior},
                                    {"inferior", StandardView::inferior}});
  line.orbit_deg = {0.0, 0.0};
  if (reader.has("orbit_deg")) line.orbit_deg = reader.numbers("orbit_deg", 2, {-180.0, 180.0});
  line.outline = reader.boolean("outline", false);
  line.carved_mm = {0.0, 0.0};
  if (reader.has("carved_mm")) line.carved_mm = reader.numbers("carved_mm", 2, {0.0, 100.0, "mm"});
  return line;
}

}  // namespace golden

inline Result<std::vector<GoldenLine>> readGoldenLines(const std::filesystem::path& file) {
  const Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  JsonReader reader(*json, file.string());
  std::vector<GoldenLine> lines;
  for (JsonReader& line : reader.objects("pictures", 200)) lines.push_back(golden::lineOf(line));
  if (Status read = reader.finish(); !read) return read.error();
  return lines;
}

}  // namespace trephine::test
