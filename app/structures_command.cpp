#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

#include "app/answer.h"
#include "app/lab_commands.h"
#include "app/out_folder.h"
#include "session/case.h"
#include "structures/compare.h"
#include "structures/grow.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

// So many numbers with commas between, and nothing else.
Result<std::vector<double>> numbersOf(const std::string& text, std::size_t count,
                                      const std::string& option, const std::string& form) {
  std::vector<double> numbers;
  const char *at = text.data(), *end = at + text.size();
  for (std::size_t n = 0; n < count; ++n) {
    double value = 0.0;
    const auto [next, failed] = std::from_chars(at, end, value);
    const bool last = n + 1 == count;
    if (failed != std::errc() || !std::isfinite(value) || (last ? next != end : next == end) ||
        (!last && *next != ',')) {
      return Error{"BAD_ARGUMENT", "It is written " + form + ", not '" + text + "'", option, ""};
    }
    numbers.push_back(value);
    at = last ? next : next + 1;
  }
  return numbers;
}

// The voxels whose middles may lie between the corners, which are in the patient.
VoxelBox boxOf(const std::vector<double>& mm, const GridGeometry& g) {
  const Mat4 to_voxel = g.patientToVoxel();
  Vec3 low(1e30), high(-1e30);
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at(mm[corner & 1 ? 1 : 0], mm[corner & 2 ? 3 : 2], mm[corner & 4 ? 5 : 4]);
    const Vec3 voxel = Vec3(to_voxel * glm::dvec4(at, 1.0));
    low = glm::min(low, voxel);
    high = glm::max(high, voxel);
  }
  VoxelBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double last = g.size[axis];
    box.low[axis] = int(std::clamp(std::ceil(low[int(axis)] - 1e-6), 0.0, last));
    box.high[axis] = int(std::clamp(std::floor(high[int(axis)] + 1e-6) + 1.0, 0.0, last));
  }
  return box;
}

// All but the box, whose voxels the case tells: its mm go to `box_mm`.
Result<GrowOptions> optionsOf(const GrowArguments& arguments, std::vector<double>& box_mm) {
  GrowOptions options;
  if (!arguments.hu.empty()) {
    const auto hu = numbersOf(arguments.hu, 2, "--hu", "A,B in HU");
    if (!hu) return hu.error();
    options.hu = HuSpan{(*hu)[0], (*hu)[1]};
  }
  if (!arguments.box.empty()) {
    auto mm = numbersOf(arguments.box, 6, "--box", "X0,X1,Y0,Y1,Z0,Z1 in mm");
    if (!mm) return mm.error();
    box_mm = *std::move(mm);
  }
  options.open_mm = arguments.open_mm.value_or(options.open_mm);
  return options;
}

// The patient's own scan is never written over.
Status checkTarget(const std::string& target, const std::string& case_source) {
  namespace fs = std::filesystem;
  if (Status name = checkVolumeFileName(target); !name) return name;
  if (Status there = checkFolderOf(target); !there) return there;
  std::error_code ec;
  if (!fs::exists(target, ec) || !fs::exists(case_source, ec)) return {};
  const fs::path to = fs::canonical(target, ec), from = fs::canonical(case_source, ec);
  const auto differs = std::mismatch(from.begin(), from.end(), to.begin(), to.end());
  if (differs.first != from.end()) return {};
  return Error{"CANNOT_WRITE", "This file is of the case that is read, and would be lost", target,
               "Choose another name"};
}

}  // namespace

int growCommand(const GrowArguments& arguments, bool json, const Progress& progress) {
  const char* kName = "structures_grow";
  const auto failed = [&](const Error& error) { return printError(kName, error, json); };
  const auto seed = numbersOf(arguments.seed, 3, "--seed", "X,Y,Z in mm");
  if (!seed) return failed(seed.error());
  if (Status target = checkTarget(arguments.write, arguments.case_source); !target) {
    return failed(target.error());
  }
  // What is asked for wrongly is said before a CT is read.
  std::vector<double> box_mm;
  auto options = optionsOf(arguments, box_mm);
  if (!options) return failed(options.error());

  const Result<Case> of = readCase(arguments.case_source, Progress(progress, 0.0, 0.5));
  if (!of) return failed(of.error());
  const GridGeometry& g = of->volume->geometry;
  if (!box_mm.empty()) options->box = boxOf(box_mm, g);
  const auto start = std::chrono::steady_clock::now();
  const Result<Growth> growth = grow(*of->volume, Vec3((*seed)[0], (*seed)[1], (*seed)[2]),
                                     *options, Progress(progress, 0.5, 0.9));
  if (!growth) return failed(growth.error());
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  bool reversed = false;
  if (isVolumeFile(arguments.case_source)) {
    const auto header = readVolumeFileHeader(arguments.case_source);
    reversed = header && header->geometry.size == g.size && header->reversed_slices;
  }
  const Status written = writeLabelMap(growth->mask, arguments.write, reversed, progress);
  if (!written) return failed(written.error());

  if (json) {
    printAnswer(kName, {{"name", arguments.name},
                        {"voxels", growth->voxels},
                        {"ml", growth->ml},
                        {"seconds", seconds},
                        {"leaked", growth->leaked},
                        {"hu", {growth->hu.low, growth->hu.high}},
                        {"steps", growth->steps}});
    return 0;
  }
  std::printf("%s: %.1f mL, %zu voxels of about %.0f to %.0f HU, in %.2f s\n",
              arguments.name.c_str(), growth->ml, growth->voxels, growth->hu.low, growth->hu.high,
              seconds);
  if (growth->leaked) {
    std::printf(
        "It reaches the border of the scan or fills much of it: look whether it is %s alone. "
        "--box, --hu or a larger --open hold it back.\n",
        arguments.name.c_str());
  }
  return 0;
}

int compareCommand(const std::string& a, const std::string& b, bool json, const Progress&) {
  const char* kName = "structures_compare";
  const Result<LabelMap> map_a = readLabelMap(a), map_b = map_a ? readLabelMap(b) : map_a;
  if (!map_b) return printError(kName, map_b.error(), json);
  std::set<std::uint8_t> labels(map_a->labels.begin(), map_a->labels.end());
  labels.insert(map_b->labels.begin(), map_b->labels.end());
  labels.erase(0);
  Json rows = Json::array();
  std::string text;
  for (const std::uint8_t label : labels) {
    const Result<Likeness> of = likeness(*map_a, label, *map_b, label);
    if (!of) return printError(kName, of.error(), json);
    const std::string name = "label " + std::to_string(label);
    const bool both = std::isfinite(of->hd95_mm);
    rows.push_back({{"name", name},
                    {"dice", of->dice},
                    {"hd95_mm", both ? Json(of->hd95_mm) : Json()},
                    {"ml", {of->ml_a, of->ml_b}}});
    char line[160];
    std::snprintf(line, sizeof line, "%-10s Dice %.4f, hd95 %s, %.1f and %.1f mL\n", name.c_str(),
                  of->dice, both ? (std::to_string(of->hd95_mm) + " mm").c_str() : "none", of->ml_a,
                  of->ml_b);
    text += line;
  }
  if (labels.empty()) text = "Neither label map has a label\n";
  return printOutcome(kName, {{"rows", rows}}, text, std::nullopt, json);
}

}  // namespace trephine
