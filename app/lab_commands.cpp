#include "app/lab_commands.h"

#include <cstdio>

#include "app/answer.h"
#include "base/codes.h"
#include "base/file.h"
#include "base/log.h"
#include "base/system.h"
#include "base/utf8.h"
#include "case/case.h"
#include "case/codes.h"
#include "exercise/names.h"
#include "imaging/dicom/ct_writer.h"
#include "lab/devices/device_measurement.h"
#include "machine/exercise/explain.h"
#include "lab/headset/headset_measurement.h"
#include "lab/import/import_measurement.h"
#include "lab/import/read_floor.h"
#include "machine/ticks/jitter_measurement.h"
#include "lab/render/upload_measurement.h"
#include "lab/render/render_measurement.h"
#include "lab/stability/stability_measurement.h"
#include "lab/stability/stability_pictures.h"
#include "lab/stability/stability_sets.h"
#include "lab/touch/extremes_measurement.h"
#include "lab/touch/haptics_measurement.h"
#include "lab/touch/rest_measurement.h"
#include "lab/trades/trade_charts.h"
#include "machine/trades/trades_measurement.h"
#include "exercise/names.h"
#include "case/case.h"
#include "plot/codes.h"
#include "training/recording_list.h"
#include "training/replay.h"
#include "volume/phantom_file.h"

namespace trephine {

namespace {

// What a measurement came to, for a program or for a person.
template <class Measurement>
void printMeasured(const char* name, const Measurement& measured, bool json) {
  if (json) {
    printAnswer(name, toJson(measured));
  } else {
    say("%s", toText(measured).c_str());
  }
}

// Whether there is such a case at all: the phantoms take their time before it is opened.
Status checkCase(const std::string& source) {
  std::error_code ec;
  if (source.empty() || phantomNamed(source) || std::filesystem::exists(source, ec)) return {};
  return Error{code::kMissingFolder, "There is no such case", source,
               "Give a folder of CT, a volume file, phantom:cranium or phantom:abdomen"};
}

// The files that `draw` makes, or null where nothing can be drawn.
template <class Draw>
Result<Json> drawnFiles(const char* what, Draw&& draw) {
  auto drawn = draw();
  if (!drawn && drawn.error().code == code::kCannotDraw) {
    spdlog::warn("No {}: {}", what, drawn.error().what);
    return Json(nullptr);
  }
  if (!drawn) return drawn.error();
  Json files = Json::array();
  for (const std::filesystem::path& file : *drawn) files.push_back(file.string());
  return files;
}

}  // namespace

int phantomCommand(const std::string& name, const std::string& out, bool json,
                   const Progress& progress) {
  Result<Phantom> phantom = openPhantom(name, progress);
  if (!phantom) return printError("phantom", phantom.error(), json);
  const Volume& volume = phantom->volume;
  const CtSeriesText text{name + " phantom", name};
  if (Status written = writeCtSeries(volume, text, out, progress); !written) {
    return printError("phantom", written.error(), json);
  }
  const GridGeometry& g = volume.geometry;
  if (json) {
    printAnswer("phantom", {{"path", out},
                            {"files", g.size[2]},
                            {"size", {g.size[0], g.size[1], g.size[2]}},
                            {"spacing_mm", {g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z}},
                            {"volume_sha256", volumeSha256(volume)}});
  } else {
    say("%d slices of the %s phantom are in %s\n", g.size[2], name.c_str(), cleanUtf8(out).c_str());
  }
  return 0;
}

int replayCommand(const std::string& file, const std::string& case_source,
                  const std::string& labels_file, bool json, const Progress& progress) {
  Result<std::unique_ptr<SessionReader>> recording = SessionReader::open(file);
  if (!recording) return printError("replay", recording.error(), json);
  const Json& exercise = (*recording)->header().exercise;
  std::string source = case_source;
  if (source.empty() && exercise.contains("case") && exercise["case"].is_string()) {
    source = exercise["case"].get<std::string>();
    // A recording opens no file: it may be a stranger's.
    if (!phantomNamed(source)) source.clear();
  }
  if (source.empty()) {
    const Error error{code::kNoCase, "The recording was made on a case of its own", "--case",
                      "Give the folder or the volume file that the session was run on"};
    return printError("replay", error, json);
  }
  Result<Case> of = readCase(source, progress);
  if (!of) return printError("replay", of.error(), json);
  std::optional<LabelMap> labels;
  if (!labels_file.empty()) {
    Result<LabelMap> read = readLabelMap(labels_file);
    if (!read) return printError("replay", read.error(), json);
    labels = *std::move(read);
  }
  Result<ReplayResult> result = replay(
      **recording, *of->volume, labels ? &*labels : of->structures.get(), progress, of->sha256);
  if (!result) return printError("replay", result.error(), json);
  if (result->cut_short) spdlog::warn("The recording was cut short; what it holds was replayed");
  Json difference = nullptr;
  if (const auto& d = result->first_difference) {
    difference = {{"tick", d->tick},
                  {"arm", d->arm},
                  {"field", d->field},
                  {"recorded", d->recorded},
                  {"replayed", d->replayed}};
  }
  if (json) {
    printAnswer("replay", {{"ticks", result->ticks},
                           {"identical", result->identical},
                           {"first_difference", difference},
                           {"structures_cut", toJson(result->structures_cut)},
                           {"volume_sha256", result->volume_sha256}});
  } else {
    say("%llu ticks replayed: %s\n", static_cast<unsigned long long>(result->ticks),
                result->identical ? "identical" : "different");
    for (const std::string& cut : linesOf(result->structures_cut)) say("%s\n", cut.c_str());
    if (!result->identical) say("first difference: %s\n", difference.dump().c_str());
  }
  return result->identical ? 0 : 3;
}

int recordingsCommand(const std::vector<std::string>& files, bool json,
                      const Progress& progress) {
  bool all = true;
  for (const std::string& file : files) {
    if (progress.cancelled()) {
      return printError("recordings", {code::kCancelled, "Not all recordings were listed", "", ""},
                        json);
    }
    const ListedRecording row = listRecording(file);
    all = all && !row.problem;
    if (json) {
      printLine("recordings", toJson(row));
    } else if (row.problem) {
      say("%s\n", row.problem->sentence().c_str());
    } else {
      say("%s: %s, %.1f s%s\n", cleanUtf8(file).c_str(), row.exercise.c_str(), row.seconds,
          row.cut_short ? ", cut short" : "");
    }
    std::fflush(stdout);
  }
  return all ? 0 : 1;
}

int explainCommand(const std::string& exercise_file, const Policy& policy, bool json,
                   const Progress& progress) {
  Result<Exercise> exercise = readExercise(exercise_file);
  if (!exercise) return printError("explain", exercise.error(), json);
  const auto recommended =
      recommendedHere(policy, configFolder().value_or(std::filesystem::path()));
  if (!recommended) return printError("explain", recommended.error(), json);
  Result<Json> answer = explainExercise(*exercise, *recommended, progress);
  if (!answer) return printError("explain", answer.error(), json);
  const Locks locked = locksOf(policy, *exercise);
  Json& locks = (*answer)["locks"] = Json::array();
  for (const auto& [name, lock] : kLockNames) {
    if (locked.contains(lock)) locks.push_back(std::string(name));
  }
  const Status may = checkExercise(policy, *exercise, exercise_file);
  (*answer)["refused"] = may ? Json() : Json(may.error().sentence());
  if (json) {
    printAnswer("explain", *answer);
  } else {
    say("%s", explanationText(*answer).c_str());
  }
  return 0;
}

int measureUploadCommand(bool json, const Progress& progress) {
  Result<UploadMeasurement> measured = measureUpload(progress);
  if (!measured) return printError("measure.upload", measured.error(), json);
  if (json) {
    printAnswer("measure.upload", toJson(*measured));
  } else {
    say("full upload %.2f ms, 48^3 box %.3f ms: 1/%.0f; pictures %s\n", measured->full_ms,
                measured->box_ms, measured->ratio, measured->pictures_equal ? "equal" : "different");
  }
  return 0;
}

namespace {

// The grid under every controller, with its table and maps in `out`.
Result<Json> measureStabilityGrid(std::vector<StabilityCell> cells, double seconds,
                                  const std::string& out, std::string& text,
                                  const Progress& progress) {
  Result<StabilityMeasurement> measured = measureStability(std::move(cells), progress, seconds);
  if (!measured) return measured.error();
  if (Status written = writeStabilityTable(*measured, out); !written) return written.error();
  const Result<Json> maps =
      drawnFiles("maps", [&] { return writeStabilityMaps(mapCells(*measured), out, progress); });
  if (!maps) return maps.error();
  Json answer = toJson(*measured);
  answer["table"] = (std::filesystem::path(out) / "stability.csv").string();
  answer["maps"] = *maps;
  text += toText(*measured) + "  table and maps: " + out + "\n";
  return answer;
}

// Every set that was asked for, in the order of their names.
Result<Json> measureStabilitySets(const StabilityArguments& arguments, std::string& text,
                                  const Progress& progress) {
  std::string names = arguments.sets;
  if (names.empty()) names = arguments.grid.empty() ? "grid,long,moving,hands,claims,rest" : "grid";
  Result<std::vector<StabilitySet>> sets = readStabilitySets(names);
  if (!sets) return sets.error();
  if (arguments.seconds && !(*arguments.seconds >= 1.0 && *arguments.seconds <= 600.0)) {
    return Error{code::kBadArgument, "The time must lie between 1 and 600 s", "--seconds", ""};
  }
  std::vector<StabilityCell> all = fullGrid(), some = representativeCells();
  if (!arguments.grid.empty()) {
    Result<std::vector<StabilityCell>> read = readGrid(arguments.grid);
    if (!read) return read.error();
    all = some = *std::move(read);
  }
  if (Status made = makeFolder(arguments.out); !made) return made.error();

  Json answer = Json::object();
  double done = 0.0;
  for (StabilitySet set : *sets) {
    const std::string name = nameOf(kStabilitySetNames, set);
    const double next = done + 1.0 / double(sets->size());
    const Progress part(progress, done, next);
    if (set == StabilitySet::grid) {
      Result<Json> grid = measureStabilityGrid(
          all, arguments.seconds.value_or(kCellDuration_s), arguments.out, text, part);
      if (!grid) return grid.error();
      answer.update(*grid);
    } else if (set == StabilitySet::rest) {
      Result<RestFigures> figures = measureRest(arguments.seconds, part);
      if (!figures) return figures.error();
      answer[name] = toJson(*figures);
      text += toText(*figures);
    } else {
      const auto& cells = set == StabilitySet::lasting ? all : some;
      Result<SetFigures> figures = measureStabilitySet(set, cells, arguments.seconds, part);
      if (!figures) return figures.error();
      answer[name] = toJson(*figures);
      text += toText(name, *figures);
    }
    done = next;
  }
  return answer;
}

}  // namespace

int measureStabilityCommand(const StabilityArguments& arguments, bool json,
                            const Progress& progress) {
  std::string text;
  const Result<Json> answer = measureStabilitySets(arguments, text, progress);
  if (!answer) return printError("measure.stability", answer.error(), json);
  if (json) {
    printAnswer("measure.stability", *answer);
  } else {
    say("%s", text.c_str());
  }
  return 0;
}

int measureExtremesCommand(const std::string& case_source, const std::string& out, bool json,
                           const Progress& progress) {
  if (Status there = checkCase(case_source); !there) {
    return printError("measure.extremes", there.error(), json);
  }
  Result<ExtremesMeasurement> measured = measureExtremes(out, progress, {true, case_source});
  if (!measured) return printError("measure.extremes", measured.error(), json);
  printMeasured("measure.extremes", *measured, json);
  return measured->all_pass() ? 0 : 3;
}

int measureHapticsCommand(const std::string& out, bool json, const Progress& progress) {
  Result<HapticsMeasurement> measured = measureHaptics({}, out, progress);
  if (!measured) return printError("measure.haptics", measured.error(), json);
  printMeasured("measure.haptics", *measured, json);
  return 0;
}

int measureRenderCommand(const std::string& case_source, const std::string& out, bool json,
                         const Progress& progress) {
  if (Status there = checkCase(case_source); !there) {
    return printError("measure.render", there.error(), json);
  }
  RenderOptions options;
  options.case_source = case_source;
  Result<RenderMeasurement> measured = measureRender(options, out, progress);
  if (!measured) return printError("measure.render", measured.error(), json);
  printMeasured("measure.render", *measured, json);
  return 0;
}

int measureTradesCommand(const std::string& out, bool json, const Progress& progress) {
  constexpr const char* kName = "measure.trades";
  Result<TradesMeasurement> measured = measureTrades({}, out, progress);
  if (!measured) return printError(kName, measured.error(), json);
  const Result<Json> charts = drawnFiles("charts", [&] { return writeTradeCharts(measured->rows, out, progress); });
  if (!charts) return printError(kName, charts.error(), json);
  if (json) {
    Json answer = toJson(*measured);
    answer["table"] = (std::filesystem::path(out) / "trades.csv").string();
    answer["charts"] = *charts;
    printAnswer(kName, answer);
  } else {
    say("%s", toText(*measured).c_str());
  }
  return 0;
}

int measureImportCommand(const ImportOptions& options, const std::string& out, bool json,
                         const Progress& progress) {
  constexpr const char* kName = "measure.import";
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) {
    return printError(kName, {code::kCannotRun, "The program does not find itself", "", ""}, json);
  }
  Result<ImportMeasurement> measured = measureImport(options, ownSubjects({self}), out, progress);
  if (!measured) {
    Error why = measured.error();
    if (why.where == "--series") why.next += std::string(". ") + kOtherPrograms;
    return printError(kName, why, json);
  }
  printMeasured(kName, *measured, json);
  return 0;
}

int measureReadCommand(const std::string& path, bool json, const Progress& progress) {
  const Result<ReadFloor> floor = readEveryByte(path, progress);
  if (!floor) return printError("measure.read", floor.error(), json);
  if (json) {
    printAnswer("measure.read", toJson(*floor));
  } else {
    say("%d files of %.1f MB: read in %.4f s, kept in memory in %.4f s\n", floor->files,
                double(floor->bytes) / 1048576.0, floor->seconds, floor->kept_seconds);
  }
  return 0;
}

int measureDevicesCommand(const DeviceArguments& arguments, const std::string& out, bool json,
                          const Progress& progress) {
  constexpr const char* kName = "measure.devices";
  if (!arguments.one.empty() && arguments.benches.size() == 1) {
    const Result<DeviceTrial> trial =
        tryDevice({arguments.benches[0], arguments.one == "unplugged", arguments.wait_s},
                  arguments.recording);
    if (!trial) return printError(kName, trial.error(), true);
    // Not to stdout, to which drivers may write as well.
    const Status told =
        writeTextFile(std::filesystem::path(out) / kTrialAnswer, toJson(*trial).dump());
    return told ? 0 : printError(kName, told.error(), true);
  }
  DeviceOptions options{{}, arguments.seconds, arguments.trials};
  for (const std::string& library : arguments.benches) options.benches.emplace_back(library);
  Result<DeviceMeasurement> measured = measureDevices(options, out, progress);
  if (!measured) return printError(kName, measured.error(), json);
  printMeasured(kName, *measured, json);
  return 0;
}

int measureHeadsetCommand(const HeadsetArguments& arguments, const std::string& out, bool json,
                          const Progress& progress) {
  const HeadsetMeasureOptions options{arguments.seconds, arguments.toggles, arguments.losses,
                                      !arguments.no_pictures};
  Result<HeadsetMeasurement> measured = measureHeadset(options, out, progress);
  if (!measured) return printError("measure.headset", measured.error(), json);
  printMeasured("measure.headset", *measured, json);
  return 0;
}

int measureJitterCommand(double seconds, const std::string& out, bool json,
                         const Progress& progress) {
  Result<JitterMeasurement> measured = measureJitter({seconds}, out, progress);
  if (!measured) return printError("measure.jitter", measured.error(), json);
  printMeasured("measure.jitter", *measured, json);
  return 0;
}

}  // namespace trephine
