#include "app/lab_commands.h"

#include <unistd.h>

#include <cstdio>

#include "app/answer.h"
#include "app/codes.h"
#include "base/codes.h"
#include "base/file.h"
#include "base/log.h"
#include "base/system.h"
#include "base/utf8.h"
#include "case/case.h"
#include "case/codes.h"
#include "exercise/names.h"
#include "imaging/dicom/ct_writer.h"
#include "machine/exercise/explain.h"
#include "machine/trades/trades_measurement.h"
#include "training/recording_list.h"
#include "training/replay.h"
#include "volume/phantom_file.h"

namespace trephine {

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

int startMeasurements(char** words, bool json) {
  const std::string program = measureProgram().string();
  std::string name = program;
  words[0] = name.data();
  ::execv(program.c_str(), words);
  return printError(
      "measure",
      {code::kNotInstalled, "Measurements are a program of their own, trephine-measure",
       "trephine-lab measure", "Install the package trephine-researcher"},
      json);
}

int tradesCommand(const std::string& out, bool json, const Progress& progress) {
  constexpr const char* kName = "trades";
  Result<TradesMeasurement> measured = measureTrades({}, out, progress);
  if (!measured) return printError(kName, measured.error(), json);
  if (json) {
    Json answer = toJson(*measured);
    answer["table"] = (std::filesystem::path(out) / "trades.csv").string();
    printAnswer(kName, answer);
  } else {
    say("%s", toText(*measured).c_str());
  }
  return 0;
}

}  // namespace trephine
