#include "app/measure_commands.h"

#include "app/answer.h"
#include "base/codes.h"
#include "base/file.h"
#include "base/log.h"
#include "base/system.h"
#include "lab/devices/device_measurement.h"
#include "lab/headset/headset_measurement.h"
#include "lab/import/import_measurement.h"
#include "lab/import/read_floor.h"
#include "lab/render/render_measurement.h"
#include "lab/render/upload_measurement.h"
#include "lab/stability/stability_measurement.h"
#include "lab/stability/stability_pictures.h"
#include "lab/stability/stability_sets.h"
#include "lab/touch/extremes_measurement.h"
#include "lab/touch/haptics_measurement.h"
#include "lab/touch/rest_measurement.h"
#include "lab/touch/tissue_measurement.h"
#include "lab/trades/trade_charts.h"
#include "machine/ticks/jitter_measurement.h"
#include "machine/trades/trades_measurement.h"
#include "plot/codes.h"
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
      Result<Json> grid = measureStabilityGrid(all, arguments.seconds.value_or(kCellDuration_s),
                                               arguments.out, text, part);
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

int measureTissueCommand(const std::string& out, bool json, const Progress& progress) {
  constexpr const char* kName = "measure.tissue";
  if (Status made = makeFolder(out); !made) return printError(kName, made.error(), json);
  Result<TissueMeasurement> measured = measureTissue(progress);
  if (!measured) return printError(kName, measured.error(), json);
  if (Status written = writeTissueTables(*measured, out); !written) {
    return printError(kName, written.error(), json);
  }
  const Result<Json> plots = drawnFiles("plots", [&] { return drawTissue(*measured, out); });
  if (!plots) return printError(kName, plots.error(), json);
  if (json) {
    Json answer = toJson(*measured);
    answer["table"] = (std::filesystem::path(out) / "tissue.csv").string();
    answer["plots"] = *plots;
    printAnswer(kName, answer);
  } else {
    say("%s", toText(*measured).c_str());
  }
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
  const Result<Json> charts =
      drawnFiles("charts", [&] { return writeTradeCharts(measured->rows, out, progress); });
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
  Result<ImportMeasurement> measured = measureImport(options, ownSubjects({}), out, progress);
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
