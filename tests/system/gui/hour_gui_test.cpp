// A teaching hour: twelve exercises on three cases, with pauses, undo, changes of case and saving.
// Nothing may pile up on the way. In real time, since threads are what could pile up. An exercise
// lasts TREPHINE_EXERCISE_SECONDS, 4 where that is not set (300 make an hour of it).
#include <QFileDialog>
#include <QLineEdit>
#include <QListWidget>
#include <QMessageBox>
#include <QPushButton>
#include <QRadioButton>
#include <QSignalSpy>
#include <QtTest>
#include <algorithm>

#include "base/memory.h"
#include "gui_support.h"
#include "imaging/dicom/ct_writer.h"
#include "training/replay.h"
#include "training/session_reader.h"
#include "ui/common/words.h"

using namespace trephine;

namespace {

constexpr double kMostGrown_mb = 50.0;
// The first two and the last are on one case, so that they can be compared.
constexpr std::array kCases{0, 0, 1, 2, 0, 1, 2, 1, 0, 2, 1, 0};
constexpr std::array kBuiltIn{"cranium", "abdomen"};

double exerciseSeconds() {
  const int wanted = qEnvironmentVariableIntValue("TREPHINE_EXERCISE_SECONDS");
  return wanted > 0 ? double(wanted) : 4.0;
}

std::size_t entriesOf(const char* folder) {
  std::error_code ec;
  std::size_t n = 0;
  for (std::filesystem::directory_iterator it(folder, ec), end; !ec && it != end;
       it.increment(ec)) {
    ++n;
  }
  return n;
}

// Over and over, each time a little beside, so that there is always something to cut.
OperatorScript repeated(OperatorScript script, double seconds) {
  constexpr double kAside_mm = 1.5;
  const double once_s = script.duration_s();
  for (ScriptHand& hand : script.hands) {
    const std::vector<ScriptWaypoint> one = hand.waypoints;
    for (int n = 1; n * once_s < seconds; ++n) {
      for (ScriptWaypoint at : one) {
        at.time_s += n * once_s;
        at.at_mm.y += kAside_mm * (n % 5);
        if (at.time_s > hand.waypoints.back().time_s) hand.waypoints.push_back(at);
      }
    }
  }
  return script;
}

struct After {
  double memory_mb = 0.0, frames_per_s = 0.0, on_time_percent = 0.0, p99_late_us = 0.0;
  double most_late_ms = 0.0, recording_mb = 0.0, volume_mb = 0.0;
  std::size_t descriptors = 0, threads = 0;
  std::filesystem::path recording;
};

}  // namespace

class HourGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  std::string mine_;  // the case that was imported
  std::vector<After> after_;

  std::string caseOf(int which) const { return which < 2 ? kBuiltIn[std::size_t(which)] : mine_; }

  void importOne() {
    const QString folder = temporary_.filePath("ct");
    const Status made =
        writeCtSeries(test::coarseCranium(2), {"head", "HEAD", "NOBODY", "1"}, toPath(folder));
    QVERIFY(made.ok());
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openPath(toPath(folder));
    QTRY_VERIFY_WITH_TIMEOUT(find<QPushButton>("import")->isEnabled(), kLong_ms);
    QTest::mouseClick(find<QPushButton>("import"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(find<QPushButton>("openCase")->isVisible(), kLong_ms);
    QTest::mouseClick(find<QRadioButton>("choice_FACE_keep"), Qt::LeftButton);
    QTest::mouseClick(find<QPushButton>("openCase"), Qt::LeftButton);
    QVERIFY(opened.count() > 0 || opened.wait(kLong_ms));
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().currentCase()->stored.empty(), kLong_ms);
    mine_ = workstation().currentCase()->stored;
  }

  // By its card. What was cut on the case before was saved, or is given up.
  void openCase(const std::string& id) {
    window_->show(Place::cases);
    auto* cards = find<QListWidget>("cases");
    const auto row = [&] {
      for (int i = 0; i < cards->count(); ++i) {
        if (cards->item(i)->data(Qt::UserRole).toString().toStdString() == id) return i;
      }
      return -1;
    };
    QTRY_VERIFY_WITH_TIMEOUT(row() >= 0, kLong_ms);
    cards->setCurrentRow(row());
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    QTest::mouseClick(find<QPushButton>("trainOnCase"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(opened.count() > 0 || workstation().isOpening() || isAsked(),
                             kLong_ms);
    goOn();
    QTRY_VERIFY_WITH_TIMEOUT(window_->place() == Place::train && !workstation().isOpening() &&
                                 workstation().phase() == Workstation::Phase::ready,
                             kLong_ms);
  }
  bool isAsked() const {
    return std::ranges::any_of(window_->findChildren<QMessageBox*>(),
                               [](const QMessageBox* box) { return box->isVisible(); });
  }
  // As many as there are once nothing is on its way any more.
  static std::size_t threadsAtRest() {
    std::size_t threads = 0;
    int same = 0;
    (void)QTest::qWaitFor(
        [&] {
          const std::size_t now = entriesOf("/proc/self/task");
          same = now == threads ? same + 1 : 0;
          threads = now;
          return same == 20;
        },
        kLong_ms);
    return threads;
  }
  // Past questions about what is not saved.
  void goOn() {
    for (QMessageBox* box : window_->findChildren<QMessageBox*>()) {
      if (!box->isVisible()) continue;
      for (QAbstractButton* button : box->buttons()) {
        if (box->buttonRole(button) == QMessageBox::DestructiveRole) return button->click();
      }
    }
  }
  void saveVolume(After& after) {
    const QString file = temporary_.filePath("cut.mha");
    QSignalSpy saved(&workstation(), &Workstation::saved);
    find<QAction>("saveVolume")->trigger();
    QTRY_VERIFY(window_->findChild<QFileDialog*>("saveDialog"));
    auto* dialog = find<QFileDialog>("saveDialog");
    dialog->findChild<QLineEdit*>("fileNameEdit")->setText(file);
    static_cast<QDialog*>(dialog)->accept();
    QVERIFY(saved.count() > 0 || saved.wait(kLong_ms));
    after.volume_mb = double(QFileInfo(file).size()) / 1e6;
    QVERIFY(QFile::remove(file));
  }

  void train(double seconds, After& after) {
    const Result<OperatorScript> script =
        readOperatorScript(workstation().exercise()->operator_file, *workstation().exercise());
    QVERIFY(script.ok());
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    RunReport report;
    int frames = 0;
    QObject ears;  // gone with what it hears for
    connect(&workstation(), &Workstation::exerciseReported, &ears,
            [&](const RunReport& of) { report = of; });
    constexpr double kMore_s = 60.0;  // for what comes after the first half
    window_->startExercise(repeated(*script, seconds + kMore_s));
    QTRY_VERIFY_WITH_TIMEOUT(started.count() > 0 || isAsked(), kLong_ms);
    goOn();
    QVERIFY(started.count() > 0 || started.wait(kLong_ms));
    connect(&window_->view(), &ViewWidget::framePainted, &ears, [&] { ++frames; });
    // The first half is left alone and measured; then what else happens in an exercise.
    const double measured_s = 0.5 * seconds;
    QTest::qWait(int(1000.0 * measured_s));  // pictures are counted in this time
    after.frames_per_s = frames / measured_s;
    const auto state = [&] { return workstation().session()->state(); };
    find<QAction>("pause")->trigger();
    QTRY_VERIFY(state().paused);
    find<QAction>("pause")->trigger();
    QTRY_VERIFY(!state().paused);
    QTRY_VERIFY(find<QAction>("undo")->isEnabled());
    // The script cuts on meanwhile, which takes the redo away again.
    const std::uint64_t asked = state().ticks;
    find<QAction>("undo")->trigger();
    QTRY_VERIFY(state().ticks > asked + Session::kAnswerTicks && !state().busy);
    find<QAction>("redo")->trigger();
    saveVolume(after);
    QTRY_VERIFY_WITH_TIMEOUT(double(state().seconds) >= seconds, int(1000.0 * seconds) + kLong_ms);
    workstation().stop();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    after.recording = report.recording;
    QVERIFY(!after.recording.empty());
  }

  void readRecording(After& after) {
    const auto reader = SessionReader::open(after.recording);
    QVERIFY(reader.ok());
    std::vector<std::int64_t> late_ns;
    constexpr std::uint64_t kAtOnce = 5000;
    for (std::uint64_t from = 0; from < (*reader)->tickCount(); from += kAtOnce) {
      const auto ticks = (*reader)->ticks(from, std::min(kAtOnce, (*reader)->tickCount() - from));
      QVERIFY(ticks.ok());
      for (const TickRecord& tick : *ticks) late_ns.push_back(tick.late_ns);
    }
    QVERIFY(!late_ns.empty());
    std::sort(late_ns.begin(), late_ns.end());
    const auto on_time =
        std::upper_bound(late_ns.begin(), late_ns.end(), 500'000) - late_ns.begin();
    after.on_time_percent = 100.0 * double(on_time) / double(late_ns.size());
    after.p99_late_us = double(late_ns[late_ns.size() * 99 / 100]) * 1e-3;
    after.most_late_ms = double(late_ns.back()) * 1e-6;
    std::error_code ec;
    after.recording_mb = double(std::filesystem::file_size(after.recording, ec)) / 1e6;
  }

 private slots:
  void initTestCase() {
    real_time_ = true;
    openWindow("trephine-test-hour");
    importOne();
  }
  void cleanupTestCase() { closeWindow(); }

  void twelveExercisesLeaveNothingBehind() {
    const double seconds = exerciseSeconds();
    std::printf("%-3s %-28s %9s %5s %7s %8s %9s %9s %9s %8s\n", "", "case", "memory", "files",
                "threads", "frames/s", "on time", "late p99", "late most", "record");
    for (std::size_t i = 0; i < kCases.size(); ++i) {
      const std::string id = caseOf(kCases[i]);
      After after;
      openCase(id);
      train(seconds, after);
      if (QTest::currentTestFailed()) return;
      readRecording(after);
      if (QTest::currentTestFailed()) return;
      after.threads = threadsAtRest();
      after.memory_mb = residentMb();
      after.descriptors = entriesOf("/proc/self/fd");
      std::printf("%-3zu %-28s %6.0f MB %5zu %7zu %8.1f %7.3f %% %6.0f us %6.2f ms %5.1f MB\n",
                  i + 1, id.c_str(), after.memory_mb, after.descriptors, after.threads,
                  after.frames_per_s, after.on_time_percent, after.p99_late_us, after.most_late_ms,
                  after.recording_mb);
      std::fflush(stdout);
      after_.push_back(after);
    }
    double recordings_mb = 0.0, volumes_mb = 0.0;
    for (const After& after : after_) {
      recordings_mb += after.recording_mb;
      volumes_mb += after.volume_mb;
    }
    const After &first = after_.front(), &second = after_[1], &last = after_.back();
    std::printf(
        "recordings %.0f MB an hour, %zu saved volumes %.0f MB; memory %+.0f MB since the "
        "second exercise\n",
        recordings_mb * 3600.0 / (seconds * double(kCases.size())), kCases.size(), volumes_mb,
        last.memory_mb - second.memory_mb);
    QVERIFY2(last.memory_mb <= second.memory_mb + kMostGrown_mb, "memory piles up");
    QCOMPARE(last.descriptors, second.descriptors);
    QCOMPARE(last.threads, second.threads);
    // Of some seconds they say too little to judge by.
    constexpr double kTelling_s = 60.0;
    if (seconds < kTelling_s) return;
    QVERIFY2(last.frames_per_s >= 0.9 * first.frames_per_s, "pictures become slower");
    // A tick's lateness is some us of noise: what is below a twentieth of a tick counts as none.
    QVERIFY2(last.p99_late_us <= 1.1 * std::max(first.p99_late_us, 50.0), "ticks become later");
    QVERIFY(last.on_time_percent >= 0.999 * first.on_time_percent);
  }

  void allTwelveReplay() {
    QCOMPARE(after_.size(), kCases.size());
    for (int which : {0, 1, 2}) {
      openCase(caseOf(which));
      const Case of = *workstation().currentCase();
      for (std::size_t i = 0; i < kCases.size(); ++i) {
        if (kCases[i] != which) continue;
        const auto recording = SessionReader::open(after_[i].recording);
        QVERIFY(recording.ok());
        const auto replayed =
            replay(**recording, *of.volume, of.structures.get(), Progress(), of.sha256);
        QVERIFY2(replayed.ok(), replayed.ok() ? "" : replayed.error().sentence().c_str());
        QVERIFY2(replayed->identical && !replayed->cut_short, qPrintable(QString::number(i + 1)));
      }
    }
  }
};

int main(int argc, char** argv) {
  qputenv("QTEST_FUNCTION_TIMEOUT", "10000000");  // ms; Qt gives a function five minutes
  return test::runInWindow<HourGuiTest>(argc, argv);
}

#include "hour_gui_test.moc"
