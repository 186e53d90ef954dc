// Pictures of an exercise that reach the screen: the shipped exercises in the real window, their
// scripts over and over, both arms cutting. A number that counts up is drawn into each picture of
// the 3-D view and read off the screen. Needs a screen (Xvfb will do) as large as the largest
// window.
//
//   bench_screen [EXERCISE.json [SECONDS [WIDTHxHEIGHT]]]
//
// Without an exercise: each that ships, 20 s, at 1280x800 and 1920x1080. The first second of an
// exercise does not count.
#include <sys/resource.h>
#include <unistd.h>

#include <QOpenGLContext>
#include <QOpenGLFunctions>
#include <QStandardPaths>
#include <QTimer>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>

#include "base/system.h"
#include "bench/repeated_exercise.h"
#include "bench/screen_reader.h"
#include "ui/common/colours.h"
#include "ui/common/words.h"
#include "ui/frame/exercise.h"
#include "ui/frame/main_window.h"
#include "ui/frame/start_up.h"

namespace trephine::bench {
namespace {

using Clock = ScreenReader::Clock;
constexpr double kUncounted_s = 1.0;

long faultsOfThisThread() {
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt;
}

double cpuOfThisThread_ms() {
  timespec at{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &at);
  return double(at.tv_sec) * 1e3 + double(at.tv_nsec) * 1e-6;
}

// Into the framebuffer that is bound, at its left edge half way up.
void draw(std::uint32_t number, int height) {
  QOpenGLFunctions& gl = *QOpenGLContext::currentContext()->functions();
  gl.glEnable(GL_SCISSOR_TEST);
  for (int square = 0; square < kNumberBits + 2; ++square) {
    gl.glScissor(square * kSquare_pixels, height / 2 - kSquare_pixels / 2, kSquare_pixels,
                 kSquare_pixels);
    const float bit = square > 0 ? float(number >> (square - 1) & 1) : 0.0F;
    if (square == 0) {
      gl.glClearColor(1.0F, 0.0F, 1.0F, 1.0F);
    } else if (square == kNumberBits + 1) {
      gl.glClearColor(0.0F, 1.0F, 1.0F, 1.0F);
    } else {
      gl.glClearColor(bit, bit, bit, 1.0F);
    }
    gl.glClear(GL_COLOR_BUFFER_BIT);
  }
  gl.glDisable(GL_SCISSOR_TEST);
}

// What is counted of one window while its exercise runs.
class Counter : public QObject {
 public:
  explicit Counter(MainWindow& window) : view_(window.view()) {
    QObject::connect(&window.workstation(), &Workstation::sessionStarted, this, [this] {
      QTimer::singleShot(int(1e3 * kUncounted_s), this, [this] { begin(); });
    });
    QObject::connect(&view_, &ViewWidget::framePainted, this, [this](double ms) { painted(ms); });
    qApp->installEventFilter(this);
  }
  struct Counts {
    double seconds = 0.0;
    int painted = 0, shown = 0;
    double faults_a_frame = 0.0, cpu_ms_a_frame = 0.0, paint_ms_a_frame = 0.0;
    double to_screen_median_ms = 0.0, longest_gap_ms = 0.0;
  };
  void end() {
    ended_ = Clock::now();
    counts_.faults_a_frame = double(faultsOfThisThread() - faults_) / std::max(1, counts_.painted);
    counts_.cpu_ms_a_frame = (cpuOfThisThread_ms() - cpu_ms_) / std::max(1, counts_.painted);
    counts_.paint_ms_a_frame /= std::max(1, counts_.painted);
    counting_ = false;
  }
  Counts counts() {
    counts_.seconds = std::chrono::duration<double>(ended_ - began_).count();
    std::vector<double> to_screen_ms;
    std::optional<Clock::time_point> last;
    for (const auto& [number, at] : reader_ ? reader_->seen() : decltype(reader_->seen()){}) {
      const auto painted = painted_.find(number);
      if (painted == painted_.end() || at > ended_) continue;
      ++counts_.shown;
      to_screen_ms.push_back(
          std::chrono::duration<double, std::milli>(at - painted->second).count());
      const std::chrono::duration<double, std::milli> gap = at - last.value_or(at);
      counts_.longest_gap_ms = std::max(counts_.longest_gap_ms, gap.count());
      last = at;
    }
    counts_.to_screen_median_ms = percentile(to_screen_ms, 0.5);
    return counts_;
  }
  // How often each widget but the view was painted, the most first.
  std::vector<std::pair<double, QString>> paints() const {
    const double seconds = std::chrono::duration<double>(ended_ - began_).count();
    std::vector<std::pair<double, QString>> most;
    for (const auto& [name, times] : paints_) most.emplace_back(times / seconds, name);
    std::ranges::sort(most, std::greater());
    return most;
  }

 private:
  bool eventFilter(QObject* watched, QEvent* event) override {
    if (counting_ && event->type() == QEvent::Paint && watched != &view_) {
      const QString name = watched->objectName();
      ++paints_[watched->metaObject()->className() + (name.isEmpty() ? name : " " + name)];
    }
    return false;
  }
  void begin() {
    const QPoint at = view_.mapToGlobal(QPoint(0, view_.height() - view_.height() / 2 - 1));
    reader_ = std::make_unique<ScreenReader>(at.x(), at.y());
    faults_ = faultsOfThisThread();
    cpu_ms_ = cpuOfThisThread_ms();
    began_ = Clock::now();
    counting_ = true;
  }
  void painted(double ms) {
    if (!counting_) return;
    counts_.paint_ms_a_frame += ms;
    ++counts_.painted;
    number_ = (number_ + 1) & ((1U << kNumberBits) - 1);
    painted_[number_] = Clock::now();
    draw(number_, view_.height());
  }

  ViewWidget& view_;
  std::unique_ptr<ScreenReader> reader_;
  std::map<std::uint32_t, Clock::time_point> painted_;
  Clock::time_point began_, ended_;
  std::uint32_t number_ = 0;
  long faults_ = 0;
  std::map<QString, int> paints_;
  double cpu_ms_ = 0.0;
  Counts counts_;
  bool counting_ = false;
};

bool run(const std::filesystem::path& file, double seconds, const QSize& size,
         const std::filesystem::path& folder) {
  const double all_s = seconds + kUncounted_s;
  ExerciseOptions options;
  options.exercise = repeated(file, all_s, folder);
  options.seconds = all_s;
  options.out = folder / "out";
  std::unique_ptr<Counter> counter;
  QTimer finding;
  QObject::connect(&finding, &QTimer::timeout, [&] {
    for (QWidget* widget : QApplication::topLevelWidgets()) {
      auto* window = qobject_cast<MainWindow*>(widget);
      if (!window) continue;
      finding.stop();
      window->setGeometry(QRect({0, 0}, size));
      counter = std::make_unique<Counter>(*window);
      QObject::connect(&window->workstation(), &Workstation::sessionEnded, &finding,
                       [&] { counter->end(); });
    }
  });
  finding.start(1);
  const Result<ExerciseOutcome> outcome = runExercise(options);
  std::error_code ec;
  std::filesystem::remove_all(options.out, ec);
  if (!outcome || !counter) {
    std::printf("%s\n", outcome ? "no window" : outcome.error().sentence().c_str());
    return false;
  }
  const Counter::Counts counts = counter->counts();
  const auto& machine = outcome->report.machine;
  std::printf("%-20s %4dx%-4d %7.1f %8.1f %8.1f %8.1f %8.1f %8.1f %8.0f %8.0f %9.3f %8.0f\n",
              file.stem().c_str(), size.width(), size.height(), counts.shown / counts.seconds,
              counts.painted / counts.seconds, counts.faults_a_frame, counts.paint_ms_a_frame,
              counts.cpu_ms_a_frame, counts.to_screen_median_ms, counts.longest_gap_ms,
              outcome->longest_stall.ms,
              100.0 * double(machine.missed_deadlines) / double(outcome->report.done.ticks),
              outcome->start_ms);
  std::printf("    paints a second beside the view:");
  constexpr std::size_t kNamed = 8;
  const auto paints = counter->paints();
  for (std::size_t i = 0; i < std::min(kNamed, paints.size()); ++i) {
    std::printf("%s %.1f %s", i == 0 ? "" : ",", paints[i].first, qPrintable(paints[i].second));
  }
  std::printf("\n");
  std::fflush(stdout);
  return true;
}

int runAll(int argc, char** argv) {
  std::vector<std::filesystem::path> exercises;
  std::vector<QSize> sizes{{1280, 800}, {1920, 1080}};
  const double seconds = argc > 2 ? std::atof(argv[2]) : 20.0;
  if (argc > 1) {
    exercises.emplace_back(argv[1]);
  } else {
    for (const auto& file : std::filesystem::directory_iterator(resourceFolder() / "scenes")) {
      if (file.path().extension() == ".json") exercises.push_back(file.path());
    }
    std::ranges::sort(exercises);
  }
  int wide = 0, high = 0;
  if (argc > 3 && std::sscanf(argv[3], "%dx%d", &wide, &high) == 2) sizes = {{wide, high}};
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("bench-screen-" + std::to_string(::getpid()));
  std::error_code ec;
  std::filesystem::create_directories(folder, ec);
  std::printf("%-20s %-9s %7s %8s %8s %8s %8s %8s %8s %8s %9s %8s\n", "exercise", "window",
              "shown/s", "painted/s", "faults", "paint ms", "cpu ms", "screen", "gap ms",
              "stall ms", "missed %", "start ms");
  bool all = true;
  for (const auto& exercise : exercises) {
    for (const QSize& size : sizes) all = run(exercise, seconds, size, folder) && all;
  }
  std::filesystem::remove_all(folder, ec);
  std::printf(
      "shown: pictures that were read off the screen; faults: minor page faults of the window's "
      "thread a picture; cpu: of that thread a picture; screen: from a painted picture until it is "
      "read, median; gap: longest between two that were read\n");
  return all ? 0 : 1;
}

}  // namespace
}  // namespace trephine::bench

int main(int argc, char** argv) {
  using namespace trephine;
  prepareMemory();
  if (Status display = prepareDisplay(); !display) {
    std::printf("%s\n", display.error().sentence().c_str());
    return 77;
  }
  TimedApplication application(argc, argv);
  QApplication::setApplicationName("trephine-bench");
  QStandardPaths::setTestModeEnabled(true);
  colours::applyTheme(application);
  return bench::runAll(argc, argv);
}
