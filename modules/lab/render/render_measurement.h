// What does a picture of the ray caster cost, and how true is it, beside VTK's own ("stock") in the
// same run?
//
// Stock is the same object with everything of ours switched off (stockRay): what it then hands to
// the driver is VTK's shader as VTK writes it, so no second mapper is needed to compare with.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "machine/drawing/drawing_parts.h"

namespace trephine {

struct RenderRow {
  std::string of_case;  // "phantom:cranium"; "case" for a person's own, whose path is not repeated
  std::string preset;   // bone, skin, liver
  int width = 0, height = 0;
  std::string mode;    // still; rotate: the camera turns; cut: an exercise runs, its own view
  std::string mapper;  // stock, trephine
  double sample_distance_voxels = 0.0;    // at full quality, in the smallest edge of a voxel
  double level = 1.0;                     // pixels between rays, each way
  double ms_median = 0.0;                 // of a picture, truths of surface and class on
  std::optional<double> ms_plain_median;  // with both off
  // Against 0.25 voxels by the same mapper. 100 dB stand for equal pictures.
  std::optional<double> psnr_dB, ssim;
  std::optional<double> psnr_to_stock_dB;  // of the picture with both off, without labels
};

struct SurfaceRow {
  std::string mapper;
  ShellSurface of;
};

// Of the pixels in which truth or picture show a tissue, those that show another.
struct ClassRow {
  std::string of_case, mapper;
  double percent = 0.0;
};

// How long full quality takes after a camera that turned comes to rest.
struct RefineRow {
  std::string of_case, preset;
  double first_ms = 0.0;  // to the first refined picture
  double full_ms = 0.0;
};

struct RenderMeasurement {
  std::vector<RenderRow> rows;
  std::vector<RefineRow> rests;
  std::vector<SurfaceRow> surface;
  std::vector<ClassRow> wrong_class, wrong_class_hu_only;
  double removal_median_ms = 0.0, removal_max_ms = 0.0;  // removal to pixel
  double hand_median_ms = 0.0, hand_p99_ms = 0.0;        // hand to the tool's new pixel
  double missed_ticks_percent = 0.0;                     // of the exercises meanwhile
  double first_picture_ms = 0.0;
  std::string renderer;
};

// The defaults are what the bars are about; tests take less.
struct RenderOptions {
  std::string case_source;  // beside the built-in cases; empty: none
  std::array<int, 2> still{800, 600};
  std::array<int, 2> moving{1280, 800};
  // The first is timed most often, and beside truths that are off.
  std::vector<double> sample_distances{SceneRenderer::kSampleDistance, 0.25, 1.0};
  std::vector<double> levels{2.0, 3.0, 4.0};
  int repeats = 3;  // of the first distance; one of the others
  double rotate_s = 4.0;
  double cut_s = 10.0;
  int truth_edge = kTruthEdge;
  int truth_step = 3;  // every so many pixels
  int surface_edge = kSurfaceEdge;
  std::array<int, 3> import_size{512, 512, 300};
};

struct RenderBar {
  std::string name;
  double value = 0.0;
  double limit = 0.0;
  bool at_least = false;  // else at most
  bool pass() const { return at_least ? value >= limit : value <= limit; }
};
// Those whose rows were measured.
std::vector<RenderBar> renderBars(const RenderMeasurement& measurement);

// Writes render.csv and the pictures of the still rows into `out`. Errors: BAD_ARGUMENT,
// NO_DISPLAY, NO_OPENGL, CANNOT_WRITE, CANCELLED, those of the case.
Result<RenderMeasurement> measureRender(const RenderOptions& options,
                                        const std::filesystem::path& out,
                                        const Progress& progress = Progress());

// {rows:[{case, preset, size:[w,h], mode, mapper, sample_distance_voxels, level, ms_median,
//  ms_plain_median, psnr_db, ssim, psnr_to_stock_db}], surface:[{mapper, normal_error_deg:{median,
//  p99}, luminance_error_percent}], wrong_class_percent:[{case, mapper, value}],
//  wrong_class_hu_only_percent, removal_to_pixel_ms:{median, max}, hand_to_tool_pixel_ms:{median,
//  p99}, first_picture_ms, renderer, bars:[{name, value, limit, pass}]}; null: not measured
Json toJson(const RenderMeasurement& measurement);
std::string toText(const RenderMeasurement& measurement);
std::string toCsv(const RenderMeasurement& measurement);

}  // namespace trephine
