// The workstation: `trephine [FOLDER|SCENE]`, and `trephine --exercise SCENE` for a scripted run.
#include <CLI/CLI.hpp>
#include <QApplication>
#include <QTimer>
#include <cerrno>
#include <cstdlib>

#include "app/answer.h"
#include "app/codes.h"
#include "app/out_folder.h"
#include "app/signals.h"
#include "base/crash_report.h"
#include "base/file.h"
#include "base/log.h"
#include "base/system.h"
#include "render/codes.h"
#include "ui/common/colours.h"
#include "ui/common/error_dialog.h"
#include "ui/common/preferences.h"
#include "ui/common/translations.h"
#include "ui/common/words.h"
#include "ui/frame/exercise.h"
#include "ui/frame/main_window.h"
#include "ui/frame/start_up.h"

namespace {

using namespace trephine;

constexpr double kLongest_s = 24.0 * 3600.0;
constexpr int kSignalPoll_ms = 50;

Progress progress;  // cancelled by a signal

void reportCrashes(const std::filesystem::path& folder) {
  const Status begun = reportCrashesTo(folder);
  if (!begun) spdlog::warn("A crash would leave no report: {}", begun.error().code.str());
}

int playExercise(const ExerciseOptions& options, bool json) {
  const OutFolder folder(options.out);
  Result<ExerciseOutcome> outcome = runExercise(options, progress);
  if (!outcome) return printError("exercise", outcome.error(), json);
  return printOutcome("exercise", toJson(*outcome), toText(*outcome), outcome->failure, json);
}

int run(int argc, char** argv) {
  const Policy policy = policyAtStart();
  std::string path, exercise, out, arms;
  double seconds = 0.0;
  bool json = false;
  CLI::App cli("Trephine: practise cutting on a CT, with both hands. " +
               purposeText().toStdString() + ".");
  cli.set_version_flag("--version", buildName());
  auto* path_option =
      cli.add_option("path", path, "A folder of CT, a scene (.json) or a recording (.h5)");
  auto* exercise_option =
      cli.add_option("--exercise", exercise, "Play this scene's script in the window, then end");
  cli.add_option("--seconds", seconds, "How long; as long as the script where absent")
      ->check(CLI::Range(0.001, kLongest_s))
      ->needs(exercise_option);
  cli.add_option("--arms", arms, "Which devices move its arms, a file (resources/schemas/arms.md)")
      ->needs(exercise_option);
  cli.add_option("--out", out, "Folder for its recording and picture")->needs(exercise_option);
  cli.add_flag("--json", json, "Answer in JSON")->needs(exercise_option);
  exercise_option->excludes(path_option);
  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return cli.exit(error);
    return printError("exercise", {code::kBadUse, error.what(), "", "See trephine --help"},
                      wantsJson(argc, argv));
  }

  setUpLog(!exercise.empty());
  if (policy.problem) spdlog::warn("{}", policy.problem->sentence());
  const auto crashes = stateFolder();
  if (crashes) reportCrashes(*crashes);
  prepareMemory();
  const Status display = prepareDisplay();
  const bool can_say = exercise.empty() && !display && display.error().code != code::kNoDisplay;
  if (!display) printError("exercise", display.error(), json);
  if (!display && !can_say) return 1;
  std::unique_ptr<QApplication> application;
  if (exercise.empty()) {
    application = std::make_unique<QApplication>(argc, argv);
  } else {
    application = std::make_unique<TimedApplication>(argc, argv);
  }
  QApplication::setApplicationName("trephine");
  QApplication::setApplicationDisplayName("Trephine");
  installTranslations(*application, resourceFolder() / "translations", QLocale());
  const Preferences wanted = preferences();
  colours::applyTheme(*application, wanted.theme, wanted.text_percent);
  if (!exercise.empty()) {
    ExerciseOptions options{exercise, arms, {}, out, policy};
    if (seconds > 0.0) options.seconds = seconds;
    if (out.empty()) {
      const Result<std::filesystem::path> temporary = temporaryFolder();
      if (!temporary) return printError("exercise", temporary.error(), json);
      std::string folder = (*temporary / "trephine-exercise-XXXXXX").string();
      if (!::mkdtemp(folder.data())) return printError("exercise", writeError(folder, errno), json);
      options.out = folder;
    }
    return playExercise(options, json);
  }
  QTimer poll;
  QObject::connect(&poll, &QTimer::timeout, [] {
    if (progress.cancelled()) QApplication::exit();  // asks nobody; the session ends in order
  });
  poll.start(kSignalPoll_ms);
  if (!display) {
    showError(nullptr, display.error());
    QApplication::exec();
    return 1;
  }
  MainWindow window({}, policy);
  QObject::connect(&window, &MainWindow::usable, [] {
    spdlog::info("The window is usable, {:.0f} ms after the start of the program",
                 msSinceProcessStart());
  });
  QObject::connect(&window, &MainWindow::usable, &window, [&] {
    window.sayProblem();
    window.checkAtStart();
    if (!crashes) return;
    if (const auto left = takeLeftBehind(*crashes)) window.offerLeftBehind(*left);
  });
  if (!path.empty()) window.openOnceShown(path);
  window.show();
  return QApplication::exec();
}

}  // namespace

int main(int argc, char** argv) {
  keepMemoryPrivate();
  cancelOnSignals(progress);
  return guarded("exercise", wantsJson(argc, argv), [&] { return run(argc, argv); });
}
