// `run`: an exercise with a scripted operator, and the files that it leaves.
#include <algorithm>
#include <chrono>
#include <thread>

#include "app/answer.h"
#include "app/lab_commands.h"
#include "app/out_folder.h"
#include "base/codes.h"
#include "base/file.h"
#include "base/log.h"
#include "desk/opening.h"
#include "exercise/arms_file.h"
#include "exercise/codes.h"
#include "exercise/exercise_fields.h"
#include "exercise/names.h"
#include "machine/exercise/exercise_picture.h"
#include "render/codes.h"
#include "session/arm_devices.h"
#include "session/session.h"
#include "training/tick_table.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

// A setting of the command line, where nothing keeps it as it is.
Status applySetting(const FieldOf<Exercise>& field, const std::string& text, const Locks& locks,
                    Exercise& exercise) {
  const FieldShape shape = shapeOf(field);
  const std::string option = optionOf(shape.row);
  const Result<FieldValue> value = parseField(shape, text, option);
  if (!value) return value.error();
  const auto lock = kindOf(kLockNames, shape.row.lock);
  if (lock && locks.contains(*lock) && *value != valueOf(field, exercise)) {
    return Error{code::kLocked,
                 std::string("The workstation or the exercise locks the ") + shape.row.lock, option,
                 "Leave the option away"};
  }
  setValue(field, exercise, *value);
  return {};
}

// Puts the command line's choices into the exercise.
Status applyChoices(const RunArguments& arguments, const Policy& policy, Exercise& exercise,
                    Rig& rig) {
  const Locks locks = locksOf(policy, exercise);
  for (const FieldOf<Exercise>& field : kTouchFields) {
    const auto text = arguments.settings.find(field.row.key);
    if (text == arguments.settings.end() || text->second.empty()) continue;
    if (Status s = applySetting(field, text->second, locks, exercise); !s) return s;
  }
  if (!arguments.case_source.empty()) exercise = onCase(std::move(exercise), arguments.case_source);
  if (!arguments.labels.empty()) exercise.labels_file = arguments.labels;
  if (!arguments.arms_file.empty()) {
    Result<std::vector<NamedDevice>> arms = readArmsFile(arguments.arms_file);
    if (!arms) return arms.error();
    Result<Rig> moved = rigWith(exercise, *arms, arguments.arms_file);
    if (!moved) return moved.error();
    rig = *std::move(moved);
    Rig asked = rig;  // what is not there is said before a case is opened
    if (Status there = readArmDynamics(exercise, asked); !there) return there;
  }
  return {};
}

// A run writes over nothing: what it is to save goes to names that nothing has, neither now nor by
// its own recording.
Status checkRunTargets(const RunArguments& arguments, const fs::path& recording) {
  const std::pair<const char*, const std::string&> targets[] = {
      {"--save-volume", arguments.save_volume}, {"--csv", arguments.csv}};
  std::error_code ec;
  const auto whole = [&](const fs::path& file) {
    return fs::weakly_canonical(fs::absolute(file, ec), ec);
  };
  std::vector<fs::path> taken{whole(recording)};
  for (const auto& [option, target] : targets) {
    if (target.empty()) continue;
    if (Status free = checkNewFile(target, option); !free) return free;
    const fs::path file = whole(target);
    if (std::find(taken.begin(), taken.end(), file) != taken.end()) {
      return Error{code::kCannotWrite, "The run itself writes another file of this name", target,
                   std::string("Give ") + option + " a name of its own"};
    }
    taken.push_back(file);
  }
  return {};
}

Status runRealTime(Session& session, double seconds, const Progress& progress) {
  if (Status started = session.start(seconds); !started) return started;
  while (!session.finished() && !progress.cancelled() &&
         session.standsStillFor_s() < Session::kGivenUp_s) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const bool cancelled = progress.cancelled() && !session.finished();
  if (Status stopped = session.stop(); !stopped) return stopped;
  if (cancelled) return Error{code::kCancelled, "The run was cancelled", "", ""};
  return {};
}

struct RunOutcome {
  RunReport report;
  std::optional<Error> failure;  // the recording's, or the person ended the run
};

// Who ended the run does not wait for long: what of the table is not written within this time is
// left, and that is said.
constexpr std::chrono::seconds kPatience{5};

Status saveTable(const fs::path& recording, const std::string& file, bool ended,
                 const Progress& progress) {
  const auto reader = SessionReader::open(recording);
  if (!reader) return reader.error();
  if (!ended) return writeTickTable(**reader, file, progress);
  const auto until = std::chrono::steady_clock::now() + kPatience;
  Progress* clock = nullptr;
  Progress patience([&](double fraction, const std::string& step) {
    progress.at(fraction, step);
    if (std::chrono::steady_clock::now() > until) clock->cancel();
  });
  clock = &patience;
  return writeTickTable(**reader, file, patience);
}

// What a run that did not end well has not written either is said with the reason.
void saveWhatWasAsked(const RunArguments& arguments, const fs::path& recording, Session& session,
                      const Progress& progress, RunOutcome& outcome) {
  const bool ended = progress.cancelled();
  const auto note = [&](const Status& saved, const std::string& file, const char* what,
                        std::string& written) {
    if (saved) {
      written = file;
    } else if (!outcome.failure) {
      outcome.failure = saved.error();
    } else {
      outcome.failure->what += std::string("; the ") + what + " was not written";
    }
  };
  // First of all: what was cut is kept, whatever became of the recording.
  if (!arguments.save_volume.empty()) {
    note(writeVolume(slabsOf(session.grid()), arguments.save_volume), arguments.save_volume,
         "volume (--save-volume)", outcome.report.volume);
  }
  if (!arguments.csv.empty()) {
    note(saveTable(recording, arguments.csv, ended, progress), arguments.csv, "table (--csv)",
         outcome.report.table);
  }
}

// What a machine cannot draw is no fault of the run.
bool isOfThisMachine(const Error& error) {
  return error.code == code::kNoDisplay || error.code == code::kNoOpengl ||
         error.code == code::kOutOfMemory;
}

// Runs the exercise and leaves its files in `out`. The Error is of a run that took no step.
Result<RunOutcome> runExercise(const RunArguments& arguments, const Policy& policy,
                               const Progress& progress) {
  Result<Exercise> exercise = readAllowedExercise(arguments.exercise, &policy);
  if (!exercise) return exercise.error();
  SessionOptions options;
  if (Status chosen = applyChoices(arguments, policy, *exercise, options.rig); !chosen) {
    return chosen.error();
  }
  const std::string script_file =
      arguments.operator_file.empty() ? exercise->operator_file : arguments.operator_file;
  if (!script_file.empty()) {
    Result<OperatorScript> script = readOperatorScript(script_file, *exercise);
    if (!script) return script.error();
    if (Status may = checkLocks(*script, locksOf(policy, *exercise)); !may) return may.error();
    options.script = *std::move(script);
  }
  const double seconds =
      arguments.seconds.value_or(options.script ? options.script->duration_s() : 10.0);
  if (!(seconds > 0.0 && seconds <= 86400.0)) {
    return Error{code::kBadArgument, "The time must lie above 0 and at most a day",
                 arguments.seconds ? "--seconds" : script_file,
                 arguments.seconds ? "" : "The script has no length: give --seconds"};
  }
  if (!arguments.save_volume.empty()) {
    if (Status can = checkVolumeFileName(arguments.save_volume); !can) return can.error();
  }
  const OutFolder folder(arguments.out);
  if (Status made = folder.make(); !made) return made.error();
  const fs::path out = arguments.out;
  options.recording = freshFile(out, "session", ".h5");
  if (Status can = checkRunTargets(arguments, options.recording); !can) return can.error();

  OpenRequest request{*exercise, arguments.exercise};
  request.source = exercise->case_source;
  Result<OpenOutcome> opened = openOnDesk(std::move(request), progress);
  if (!opened) return opened.error();
  const Placement of = std::get<Opened>(*std::move(opened)).placed;  // nothing is asked
  Result<std::unique_ptr<Session>> session = Session::create(of, options);
  // Another run may have taken the name meanwhile.
  std::error_code ec;
  while (!session && session.error().code == code::kCannotWrite &&
         fs::exists(options.recording, ec)) {
    options.recording = freshFile(out, "session", ".h5");
    if (Status can = checkRunTargets(arguments, options.recording); !can) return can.error();
    session = Session::create(of, options);
  }
  if (!session) return session.error();

  // A real arm keeps the clock's pace, and so does what runs with it.
  bool realtime = arguments.realtime;
  for (std::size_t i = 0; i < exercise->arms.size(); ++i) {
    realtime = realtime || !(*session)->isSimulated(i);
  }
  const Status ran = realtime ? runRealTime(**session, seconds, progress)
                              : (*session)->freewheel(seconds, progress);
  RunOutcome outcome{(*session)->report(), {}};
  if (!ran) outcome.failure = ran.error();
  if (!ran && outcome.report.done.ticks == 0) return ran.error();
  saveWhatWasAsked(arguments, options.recording, **session, progress, outcome);
  if (outcome.failure) return outcome;
  const fs::path picture = freshFile(out, "picture", ".png");
  const Status drawn = writeExercisePicture(**session, of.patient.volume, picture);
  if (drawn) {
    outcome.report.picture = picture.string();
  } else if (isOfThisMachine(drawn.error())) {
    spdlog::info("No picture is drawn: {}", drawn.error().what);
  } else {
    outcome.failure = drawn.error();
  }
  return outcome;
}

}  // namespace

int runCommand(const RunArguments& arguments, const Policy& policy, bool json,
               const Progress& progress) {
  Result<RunOutcome> outcome = runExercise(arguments, policy, progress);
  if (!outcome) {
    Error error = outcome.error();
    const bool asked = !arguments.csv.empty() || !arguments.save_volume.empty();
    if (error.code == code::kCancelled && asked)
      error.what += "; the run had not begun, nothing was saved";
    return printError("run", error, json);
  }
  const int code =
      printOutcome("run", toJson(outcome->report), toText(outcome->report), outcome->failure, json);
  constexpr int kFaulted = 4;
  return code == 0 && !outcome->report.done.faults.empty() ? kFaulted : code;
}

}  // namespace trephine
