#include "ui/frame/exercise.h"

#include <QEventLoop>
#include <QTimer>
#include <algorithm>
#include <cmath>

#include "base/codes.h"
#include "base/file.h"
#include "base/tr.h"
#include "device/codes.h"
#include "exercise/arms_file.h"
#include "ui/codes.h"
#include "ui/common/stall_meter.h"
#include "ui/frame/main_window.h"
#include "ui/frame/start_up.h"
#include "ui/views/saved_picture.h"

namespace trephine {

namespace {

constexpr int kCancelPoll_ms = 50;

}  // namespace

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * double(values.size()));
  return values[std::size_t(std::clamp(rank - 1.0, 0.0, double(values.size() - 1)))];
}

Result<ExerciseOutcome> runExercise(const ExerciseOptions& options, const Progress& progress) {
  Result<Exercise> exercise = readExercise(options.exercise);
  if (!exercise) return exercise.error();
  if (Status may = checkExercise(options.policy, *exercise, options.exercise); !may)
    return may.error();
  if (exercise->operator_file.empty()) {
    return Error{code::kNoOperator, trephine::tr("The scene has no script to play"),
                 options.exercise.string(), trephine::tr("Name one under 'operator' in the scene")};
  }
  Result<OperatorScript> script = readOperatorScript(exercise->operator_file, *exercise);
  if (!script) return script.error();
  if (Status may = checkLocks(*script, locksOf(options.policy, *exercise)); !may)
    return may.error();
  std::vector<NamedDevice> arms;
  if (!options.arms.empty()) {
    Result<std::vector<NamedDevice>> read = readArmsFile(options.arms);
    if (!read) return read.error();
    if (Result<Rig> rig = rigWith(*exercise, *read, options.arms); !rig) return rig.error();
    arms = *std::move(read);
  }
  if (Status made = makeFolder(options.out); !made) return made.error();
  const double seconds = options.seconds.value_or(script->duration_s());

  ExerciseOutcome outcome;
  std::optional<Error> failure;
  std::vector<double> frame_ms;
  QEventLoop loop;
  MainWindow window(options.out, options.policy);
  // As large as it is in every exercise, whatever its user is used to: it is measured.
  window.views().setLayout({ViewLayout::Kind::one_large, 0});
  window.show(Place::train);
  Workstation& workstation = window.workstation();
  workstation.setArms(std::move(arms));
  enum class Step { opening, starting, running, ending } step = Step::opening;

  QObject::connect(&window, &MainWindow::failed, &loop, [&](const Error& error) {
    if (error.code == code::kDeviceStuck && step == Step::ending) return;  // a fault in the report
    if (!failure) failure = error;
    loop.quit();
  });
  QObject::connect(
      &window.view(), &ViewWidget::framePainted, &loop, [&](double paint_ms, bool with_volume) {
        if (step == Step::running) frame_ms.push_back(paint_ms);
        if (step != Step::opening || !with_volume) return;
        outcome.start_ms = msSinceProcessStart();
        step = Step::starting;
        QTimer::singleShot(0, &window, [&] { window.startExercise(*script, seconds); });
      });
  QObject::connect(&workstation, &Workstation::sessionStarted, &loop, [&] {
    step = Step::running;
    outcome.session_ms = msSinceProcessStart();
  });
  QObject::connect(&workstation, &Workstation::sessionEnded, &loop, [&](Session& session) {
    step = Step::ending;
    outcome.report = session.report();
    QTimer::singleShot(0, &loop, &QEventLoop::quit);
  });
  QObject::connect(&workstation, &Workstation::recordingFailed, &loop,
                   [&](const Error& error) { outcome.failure = error; });
  auto* timed = dynamic_cast<TimedApplication*>(QApplication::instance());
  if (timed) {
    timed->setWatcher([&](const Stall& stall) {
      if (step == Step::running && stall.ms > outcome.longest_stall.ms)
        outcome.longest_stall = stall;
    });
  }
  QTimer cancelling;
  QObject::connect(&cancelling, &QTimer::timeout, &loop, [&] {
    if (!progress.cancelled()) return;
    if (step == Step::opening) loop.quit();
    workstation.stop();  // does nothing before it runs
  });
  // Nobody is there to stop an exercise whose arm does not come back.
  QObject::connect(&cancelling, &QTimer::timeout, &loop, [&] {
    const Session* session = workstation.session();
    if (session && session->standsStillFor_s() > Session::kGivenUp_s) workstation.stop();
  });
  cancelling.start(kCancelPoll_ms);
  window.show();
  window.open(options.exercise);
  if (!failure) loop.exec();
  if (timed) timed->setWatcher({});
  const Error cancelled{code::kCancelled, trephine::tr("The exercise was cancelled"), "", ""};
  if (step != Step::ending && progress.cancelled()) return cancelled;
  if (step != Step::ending && failure) return *failure;
  if (step != Step::ending) {
    return Error{code::kStopped, trephine::tr("The window was closed before the exercise ended"),
                 "", trephine::tr("Start it again")};
  }
  if (failure) outcome.failure = failure;
  if (progress.cancelled()) {
    outcome.failure = cancelled;
    return outcome;
  }

  Result<Picture> picture = window.view().picture();
  if (!picture) return picture.error();
  const std::filesystem::path file = freshFile(options.out, "picture", ".png");
  if (Status written = writePng(withPurpose(*picture), file); !written) return written.error();
  outcome.report.picture = file.string();
  outcome.frames = int(frame_ms.size());
  outcome.frame_median_ms = percentile(frame_ms, 0.5);
  outcome.frame_p99_ms = percentile(frame_ms, 0.99);
  return outcome;
}

Json toJson(const ExerciseOutcome& outcome) {
  Json json = toJson(outcome.report);
  json["start_ms"] = outcome.start_ms;
  json["session_ms"] = outcome.session_ms;
  json["frames"] = outcome.frames;
  json["frame_ms"] = {{"median", outcome.frame_median_ms}, {"p99", outcome.frame_p99_ms}};
  json["longest_stall_ms"] = outcome.longest_stall.ms;
  json["longest_stall"] = {{"cpu_ms", outcome.longest_stall.cpu_ms},
                           {"others_share", outcome.longest_stall.others_share},
                           {"by", outcome.longest_stall.by.toStdString()}};
  return json;
}

std::string toText(const ExerciseOutcome& outcome) {
  char line[300];
  std::snprintf(line, sizeof line,
                "Window: first picture after %.0f ms, %d pictures, median %.1f ms, p99 %.1f ms, "
                "longest stall %.0f ms (%s)\n",
                outcome.start_ms, outcome.frames, outcome.frame_median_ms, outcome.frame_p99_ms,
                outcome.longest_stall.ms, outcome.longest_stall.by.toUtf8().constData());
  return toText(outcome.report) + line;
}

}  // namespace trephine
