#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>

#include "app/answer.h"
#include "app/lab_commands.h"
#include "base/codes.h"
#include "base/file.h"
#include "base/log.h"
#include "base/utf8.h"
#include "case/case.h"
#include "imaging/codes.h"
#include "imaging/dicom/seg_writer.h"
#include "imaging/report/answers.h"
#include "imaging/source_uids.h"
#include "imaging/structure_importer.h"
#include "library/name_words.h"
#include "structures/compare.h"
#include "structures/grow.h"
#include "structures/surface.h"
#include "volume/codes.h"
#include "volume/segmentation.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

// In a column so many bytes wide.
std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text;
}

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
      return Error{code::kBadArgument, "It is written " + form + ", not '" + text + "'", option,
                   ""};
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

// What the box of voxels holds beyond that of mm, on a grid that is turned against the patient;
// null: nothing.
std::shared_ptr<const LabelMap> outsideOf(const std::vector<double>& mm, const GridGeometry& g) {
  bool turned = false;
  for (int axis = 0; axis < 3; ++axis) {
    for (int p = 0; p < 3; ++p) {
      const double along = std::abs(g.direction[axis][p]);
      turned = turned || (along > 1e-6 && along < 1.0 - 1e-6);
    }
  }
  if (!turned) return nullptr;
  auto outside = std::make_shared<LabelMap>(LabelMap{g, std::vector<std::uint8_t>(g.voxelCount())});
  std::size_t voxel = 0;
  for (int k = 0; k < g.size[2]; ++k) {
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i, ++voxel) {
        const Vec3 at = g.toPatient_mm(Vec3(i, j, k));
        for (int p = 0; p < 3; ++p) {
          const auto [low, high] = std::minmax(mm[std::size_t(2 * p)], mm[std::size_t(2 * p + 1)]);
          if (at[p] < low || at[p] > high) outside->labels[voxel] = 1;
        }
      }
    }
  }
  return outside;
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

// Nothing is written over, least of all the patient's own scan.
Status checkStructureTarget(const std::string& target, const std::string& case_source) {
  if (!target.ends_with(".nrrd") && !checkVolumeFileName(target)) {
    return Error{code::kUnknownFormat, "Label maps are written as .nrrd, .mha, .nii or .nii.gz",
                 target, "Choose one of these endings"};
  }
  if (Status kept = keepsCase(structuresFile(target), case_source); !kept) return kept;
  if (Status kept = keepsCase(target, case_source); !kept) return kept;
  if (Status free = checkNewFile(target, "--write"); !free) return free;
  if (target.ends_with(".nrrd")) return {};  // which holds the names itself
  return checkNewFile(structuresFile(target), "--write");
}

// Whether the case's file has its slices the other way round, so that what goes beside it has too.
bool reversedSlicesOf(const std::string& case_source, const Case& of) {
  if (!isVolumeFile(case_source)) return false;
  const auto header = readVolumeFileHeader(case_source);
  return header && header->geometry.size == of.volume->geometry.size && header->reversed_slices;
}

}  // namespace

int growCommand(const GrowArguments& arguments, bool json, const Progress& progress) {
  const char* kName = "structures_grow";
  const auto failed = [&](const Error& error) { return printError(kName, error, json); };
  const auto seed = numbersOf(arguments.seed, 3, "--seed", "X,Y,Z in mm");
  if (!seed) return failed(seed.error());
  if (Status target = checkStructureTarget(arguments.write, arguments.case_source); !target) {
    return failed(target.error());
  }
  // What is asked for wrongly is said before a CT is read.
  const std::string name = structureName(arguments.name);
  if (name.empty()) {
    return failed({code::kBadArgument, "A structure needs a name that can be seen", "--name", ""});
  }
  std::vector<double> box_mm;
  auto options = optionsOf(arguments, box_mm);
  if (!options) return failed(options.error());

  const Result<Case> of = readCase(arguments.case_source, Progress(progress, 0.0, 0.5));
  if (!of) return failed(of.error());
  const GridGeometry& g = of->volume->geometry;
  if (!box_mm.empty()) {
    options->box = boxOf(box_mm, g);
    options->others = outsideOf(box_mm, g);
  }
  const auto start = std::chrono::steady_clock::now();
  Result<Growth> growth = grow(*of->volume, Vec3((*seed)[0], (*seed)[1], (*seed)[2]), *options,
                               Progress(progress, 0.5, 0.9));
  if (!growth) return failed(growth.error());
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  growth->mask.structures = {{1, name, labelColour(1)}};
  const Status written = writeSegmentation(growth->mask, arguments.write,
                                           reversedSlicesOf(arguments.case_source, *of), progress);
  if (!written) return failed(written.error());

  if (growth->seed_off_mm > 0.0) {
    spdlog::warn("the seed itself is not in what was grown: it lies {:.1f} mm beside it",
                 growth->seed_off_mm);
  }
  if (json) {
    printAnswer(kName, {{"name", name},
                        {"voxels", growth->voxels},
                        {"ml", growth->ml},
                        {"seconds", seconds},
                        {"leaked", growth->leaked},
                        {"hu", {growth->hu.low, growth->hu.high}},
                        {"steps", growth->steps}});
    return 0;
  }
  say("%s: %.1f mL, %zu voxels of about %.0f to %.0f HU, in %.2f s\n", name.c_str(), growth->ml,
      growth->voxels, growth->hu.low, growth->hu.high, seconds);
  if (growth->leaked) {
    say("It reaches the border of the scan or fills much of it: look whether it is %s alone. "
        "--box, --hu or a larger --open hold it back.\n",
        name.c_str());
  }
  return 0;
}

namespace {

// Which label of each of two maps is one structure: by name, and by number where one of them has no
// names.
struct Pair {
  std::string name;
  std::uint8_t a = 0, b = 0;  // 0: it is not there
};

std::vector<Pair> pairsOf(const LabelMap& a, const LabelMap& b) {
  const auto unnamed = [](const Structure& s) {
    return s.name == "label " + std::to_string(s.label);
  };
  std::vector<Pair> pairs;
  std::set<int> taken;
  for (const Structure& s : a.structures) {
    const Structure* other = b.find(s.name);
    const Structure* numbered = b.find(s.label);
    if (!other && numbered && !a.find(numbered->name) && (unnamed(s) || unnamed(*numbered))) {
      other = numbered;
    }
    const std::string& name = other && unnamed(s) ? other->name : s.name;
    pairs.push_back({name, std::uint8_t(s.label), std::uint8_t(other ? other->label : 0)});
    if (other) taken.insert(other->label);
  }
  for (const Structure& s : b.structures) {
    if (!taken.contains(s.label)) pairs.push_back({s.name, 0, std::uint8_t(s.label)});
  }
  return pairs;
}

}  // namespace

int compareCommand(const std::string& a, const std::string& b, bool json, const Progress&) {
  const char* kName = "structures_compare";
  const Result<LabelMap> map_a = readLabelMap(a), map_b = map_a ? readLabelMap(b) : map_a;
  if (!map_b) return printError(kName, map_b.error(), json);
  Json rows = Json::array();
  std::string text;
  for (const Pair& pair : pairsOf(*map_a, *map_b)) {
    const Result<Likeness> of =
        likeness(*map_a, pair.a ? pair.a : std::uint8_t(unusedLabel(*map_a)), *map_b,
                 pair.b ? pair.b : std::uint8_t(unusedLabel(*map_b)));
    if (!of) return printError(kName, of.error(), json);
    const bool both = std::isfinite(of->hd95_mm);
    rows.push_back({{"name", pair.name},
                    {"dice", of->dice},
                    {"hd95_mm", both ? Json(of->hd95_mm) : Json()},
                    {"ml", {of->ml_a, of->ml_b}}});
    char figures[128];
    std::snprintf(figures, sizeof figures, " Dice %.4f, hd95 %s, %.1f and %.1f mL\n", of->dice,
                  both ? (std::to_string(of->hd95_mm) + " mm").c_str() : "none", of->ml_a,
                  of->ml_b);
    text += padded(pair.name, 10) + figures;
  }
  if (rows.empty()) text = "Neither label map has a label\n";
  return printOutcome(kName, {{"rows", rows}}, text, std::nullopt, json);
}

namespace {

// To what the segmentation asks, and to what its CT does.
struct GivenAnswers {
  Answers structures, ct;
};

// "CODE=OPTION" each.
Result<GivenAnswers> answersOf(const std::vector<std::string>& choices) {
  GivenAnswers answers;
  for (const std::string& choice : choices) {
    const std::size_t equals = choice.find('=');
    if (equals == std::string::npos || equals == 0) {
      return Error{code::kBadArgument, "It is written CODE=OPTION, not '" + choice + "'",
                   "--choice", ""};
    }
    const Code code = Code::named(choice.substr(0, equals));
    static const std::set<Code> kCodes{code::kOverlap,    code::kHuNotTissue, code::kMirrored,
                                       code::kOtherFrame, code::kNoAffine,    code::kFormsDiffer};
    const bool of_structures = kCodes.contains(code), of_ct = isChoice(code);
    if (!of_structures && !of_ct) {
      return Error{code::kBadChoice, "There is no choice '" + choice.substr(0, equals) + "'",
                   "--choice",
                   "Choose OVERLAP, HU_NOT_TISSUE, MIRRORED, OTHER_FRAME, NO_AFFINE, FORMS_DIFFER, "
                   "or one that 'import' asks of the CT"};
    }
    if (of_structures) answers.structures[code] = choice.substr(equals + 1);
    if (of_ct) answers.ct[code] = choice.substr(equals + 1);
  }
  return answers;
}

// Where the case's CT asks something: how it is answered here.
Error withWay(Error error, const std::string& case_source) {
  if (!isChoice(error.code)) return error;
  error.next = "Answer with --choice " + error.code.str() + "=OPTION: 'trephine-lab import " +
               case_source + "' lists the options";
  return error;
}

StructureRequest request(const std::optional<double>& threshold, const Answers& answers,
                         const Case& of) {
  StructureRequest made = requestOf(of, hideNamesOf);
  made.answers = answers;
  made.threshold = threshold.value_or(made.threshold);
  return made;
}

// Also where the file turns out to have no shares: a slip of the pen is said.
Status checkThreshold(const std::optional<double>& threshold) {
  if (!threshold || (*threshold >= 0.0 && *threshold <= 1.0)) return {};
  return Error{code::kBadThreshold,
               "The threshold of a fractional segmentation is a share of 0 to 1", "--threshold",
               "Give one, such as 0.5"};
}

void print(const StructureFit& fit) {
  for (const StructureCard& card : fit.structures) {
    say("%-24s %9.1f mL", card.name.c_str(), card.ml);
    if (card.hu) say("  %5.0f HU (%.0f to %.0f)", (*card.hu)[1], (*card.hu)[0], (*card.hu)[2]);
    say("\n");
    for (const Finding& f : card.findings) {
      say("    %s: %s\n", f.code.c_str(), sentencesOf(f).c_str());
    }
  }
  for (const Finding& f : fit.findings) {
    say("%s: %s\n", f.code.c_str(), sentencesOf(f).c_str());
  }
}

}  // namespace

int importStructuresCommand(const StructureImportArguments& arguments, bool json,
                            const Progress& progress) {
  const char* kName = "structures_import";
  const auto failed = [&](const Error& error) { return printError(kName, error, json); };
  const auto answers = answersOf(arguments.choices);
  if (!answers) return failed(answers.error());
  if (Status share = checkThreshold(arguments.threshold); !share) return failed(share.error());
  if (!arguments.write.empty()) {
    if (Status target = checkStructureTarget(arguments.write, arguments.case_source); !target) {
      return failed(target.error());
    }
  }
  const Result<Case> of =
      readCase(arguments.case_source, Progress(progress, 0.0, 0.5), answers->ct);
  if (!of) return failed(withWay(of.error(), arguments.case_source));
  const auto fit = importStructures(arguments.file, *of->volume,
                                    request(arguments.threshold, answers->structures, *of),
                                    Progress(progress, 0.5, 0.9));
  if (!fit) return failed(fit.error());
  if (!arguments.write.empty()) {
    const Status written = writeSegmentation(
        fit->map, arguments.write, reversedSlicesOf(arguments.case_source, *of), progress);
    if (!written) return failed(written.error());
  }
  if (json) {
    printAnswer(kName, toJson(*fit));
  } else {
    print(*fit);
  }
  return 0;
}

namespace {

// The structures of the case: of a file where one is given, else its own.
Result<std::shared_ptr<const LabelMap>> structuresOf(const StructureExportArguments& arguments,
                                                     const Answers& answers, const Case& of,
                                                     const Progress& progress) {
  if (arguments.structures.empty()) {
    if (of.structures) return of.structures;
    return Error{code::kNoStructure, "The case brings no structures of its own", "--structures",
                 "Give a label map or a segmentation of it"};
  }
  auto fit = importStructures(arguments.structures, *of.volume,
                              request(arguments.threshold, answers, of), progress);
  if (!fit) return fit.error();
  return std::make_shared<const LabelMap>(std::move(fit->map));
}

// Those that were asked for, all unless any was.
Result<LabelMap> chosenOf(const LabelMap& map, const std::vector<std::string>& names) {
  if (names.empty()) return map;
  std::array<bool, 256> wanted{};
  for (const std::string& name : names) {
    const Structure* found = map.find(name);
    if (!found) {
      std::string all;
      for (const Structure& s : map.structures) all += (all.empty() ? "" : ", ") + s.name;
      return Error{code::kNoStructure, "The case has no structure '" + name + "'", "--name",
                   "Choose among " + all};
    }
    wanted[std::size_t(found->label)] = true;
  }
  LabelMap chosen = map;
  for (std::uint8_t& label : chosen.labels) {
    if (!wanted[label]) label = 0;
  }
  std::erase_if(chosen.structures,
                [&](const Structure& s) { return !wanted[std::size_t(s.label)]; });
  return chosen;
}

// One surface a structure: "FILE.stl" of one, "FILE-liver.stl" of several. Letters that a file
// system or another program could trip over become "_"; no two are one file, whatever the case of
// their letters.
std::string surfaceFile(const std::string& file, const std::string& name, bool several,
                        std::set<std::string>& taken) {
  if (!several) return file;
  std::string plain;
  for (const char c : name) {
    const bool good = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || (c & 0x80);
    plain += good ? c : '_';
  }
  constexpr std::size_t kMost = 80;  // bytes: a file's name has an end
  plain = cutUtf8(plain, kMost);
  const auto lower = [](std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
  };
  std::string own = plain;
  for (int n = 2; !taken.insert(lower(own)).second; ++n) own = plain + "-" + std::to_string(n);
  return file.substr(0, file.size() - 4) + "-" + own + ".stl";
}

}  // namespace

int exportStructuresCommand(const StructureExportArguments& arguments, bool json,
                            const Progress& progress) {
  const char* kName = "structures_export";
  const auto failed = [&](const Error& error) { return printError(kName, error, json); };
  const auto answers = answersOf(arguments.choices);
  if (!answers) return failed(answers.error());
  if (Status share = checkThreshold(arguments.threshold); !share) return failed(share.error());
  const bool stl = arguments.write.ends_with(".stl");
  if (arguments.source_uids && arguments.dicom.empty()) {
    return failed({code::kBadArgument, "The CT's own UIDs go into DICOM alone", "--source-uids",
                   "Give --dicom FOLDER as well"});
  }
  if (arguments.write.empty() == arguments.dicom.empty()) {
    return failed({code::kBadArgument, "Where to is not said, or twice", "--write, --dicom",
                   "Give --write FILE or --dicom FOLDER"});
  }
  if (Status target = !arguments.dicom.empty() ? keepsCase(arguments.dicom, arguments.case_source)
                      : stl                    ? checkFolderOf(arguments.write, "--write")
                            : checkStructureTarget(arguments.write, arguments.case_source);
      !target) {
    return failed(target.error());
  }
  const Result<Case> of =
      readCase(arguments.case_source, Progress(progress, 0.0, 0.4), answers->ct);
  if (!of) return failed(withWay(of.error(), arguments.case_source));
  const auto all = structuresOf(arguments, answers->structures, *of, Progress(progress, 0.4, 0.6));
  if (!all) return failed(all.error());
  const Result<LabelMap> chosen = chosenOf(**all, arguments.names);
  if (!chosen) return failed(chosen.error());

  std::array<std::size_t, 256> voxels{};
  for (const std::uint8_t label : chosen->labels) ++voxels[label];
  const double voxel_ml = chosen->geometry.voxelVolume_mm3() / 1000.0;
  Json rows = Json::array(), files = Json::array();
  std::string text;
  std::set<std::string> taken;
  std::map<int, std::string> surfaces;  // by label
  for (const Structure& s : chosen->structures) {
    if (!stl || voxels[std::size_t(s.label)] == 0) continue;
    std::string file = surfaceFile(arguments.write, s.name, chosen->structures.size() > 1, taken);
    if (Status free = checkNewFile(file, "--write"); !free) return failed(free.error());
    surfaces[s.label] = std::move(file);
  }
  for (const Structure& s : chosen->structures) {
    const std::size_t count = voxels[std::size_t(s.label)];
    Json row = {{"name", s.name}, {"voxels", count}, {"ml", double(count) * voxel_ml}};
    char figures[64];
    std::snprintf(figures, sizeof figures, " %9.1f mL\n", double(count) * voxel_ml);
    text += padded(s.name, 24) + figures;
    if (const auto named = surfaces.find(s.label); named != surfaces.end()) {
      const std::string& file = named->second;
      const auto surface = writeSurface(*chosen, s.label, file, Progress(progress, 0.6, 1.0));
      if (!surface) return failed(surface.error());
      row["triangles"] = surface->triangles;
      row["surface_ml"] = surface->ml;
      files.push_back(file);
    }
    rows.push_back(std::move(row));
  }
  if (!arguments.dicom.empty()) {
    SegWriting writing;
    if (arguments.source_uids) {
      auto uids = sourceUids(arguments.case_source, of->provenance.value_or(Provenance()),
                             of->volume->geometry, Progress(progress, 0.6, 0.7));
      if (!uids) {
        Error error = uids.error();
        if (error.where.empty()) error.where = arguments.case_source;
        return failed(error);
      }
      writing.source = *std::move(uids);
    }
    const auto written = writeStructuresAsDicom(*of->volume, *chosen, arguments.dicom, writing,
                                                Progress(progress, 0.7, 1.0));
    if (!written) return failed(written.error());
    for (const std::string& note : written->notes) text += note + "\n";
    files.push_back(arguments.dicom);
    if (arguments.source_uids) {
      spdlog::warn(
          "structures.dcm names the UIDs of the patient's own CT: it finds the patient where that "
          "is "
          "kept. Give it only to whom the CT may be given");
    }
  } else if (!stl) {
    const Status written = writeSegmentation(
        *chosen, arguments.write, reversedSlicesOf(arguments.case_source, *of), progress);
    if (!written) return failed(written.error());
    files.push_back(arguments.write);
  }
  return printOutcome(
      kName, {{"structures", rows}, {"files", files}, {"names_source_uids", arguments.source_uids}},
      text, std::nullopt, json);
}

}  // namespace trephine
