// The five shipped exercises, finished with mouse and wheel in the real window, at 60, 125 and 1000
// movements of the mouse a second of the exercise.
#include <QSignalSpy>
#include <QtTest>
#include <algorithm>
#include <vector>

#include "gui_support.h"
#include "training/session_reader.h"
#include "unit/session/pointer_exercises.h"
#include "unit/session/uncut_bone.h"

using namespace trephine;
using test::Pointed;

namespace {

constexpr double kNotch_N = 0.1;  // the pushes of the paths are whole notches
constexpr double kFrame_s = 1.0 / 60.0;
constexpr double kRates_hz[] = {60.0, 125.0, 1000.0};

glm::dvec2 at(const std::vector<Pointed>& path, double t_s) {
  std::size_t i = 0;
  while (i + 1 < path.size() && path[i + 1].t_s <= t_s) ++i;
  const glm::dvec2 from(path[i].x_mm, path[i].y_mm);
  if (i + 1 == path.size()) return from;
  const double share = (t_s - path[i].t_s) / (path[i + 1].t_s - path[i].t_s);
  return from + share * (glm::dvec2(path[i + 1].x_mm, path[i + 1].y_mm) - from);
}

struct Run {
  test::Cut cut;
  double removed_mm3 = 0.0;
  test::Inside inside;
};

}  // namespace

class PointerGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  ViewWidget& view() { return window_->view(); }

  // A place of the landmark's plane, as a pixel of the view.
  std::optional<QPoint> pixelOf(const LandmarkFrame& frame, const glm::dvec2& at_mm) {
    const double ratio = view().devicePixelRatioF();
    const std::optional<glm::dvec2> pixel =
        view().camera().pixelOf(frame.toPatient_mm({at_mm, 0.0}), int(view().width() * ratio),
                                int(view().height() * ratio));
    if (!pixel) return {};
    const QRect all = view().rect();
    return QPoint(std::clamp(qRound(pixel->x / ratio), all.left(), all.right()),
                  std::clamp(qRound(all.height() - pixel->y / ratio), all.top(), all.bottom()));
  }

  void turnWheel(const QPoint& place, int notches) {
    const QPointF here = place;
    for (int i = 0; i < std::abs(notches); ++i) {
      QWheelEvent event(here, view().mapToGlobal(here), {}, {0, notches > 0 ? 120 : -120},
                        Qt::NoButton, Qt::NoModifier, Qt::NoScrollPhase, false);
      QCoreApplication::sendEvent(&view(), &event);
    }
  }

  // One hand's path from its beginning to its end.
  void follow(std::size_t arm, const std::vector<Pointed>& path, double rate_hz, Run& run) {
    Session& session = *workstation().session();
    const LandmarkFrame frame = session.landmarks()[0].frame;
    const std::optional<QPoint> begin = pixelOf(frame, at(path, 0.0));
    QVERIFY(begin);
    takeHandOf(session.exercise().arms[arm].name == "left" ? Hand::left : Hand::right, *begin);
    const auto now_s = [&, begin_ns = session.now_ns()] {
      return 1e-9 * double(session.now_ns() - begin_ns);
    };
    std::size_t turned = 0;
    int notches = 0;
    double seen_s = 0.0;
    QPoint place = *begin;
    run.cut.deepest_mm.resize(session.exercise().arms.size(), 1e9);
    while (now_s() < path.back().t_s + 0.5) {
      while (turned < path.size() && path[turned].t_s <= now_s()) {
        const int wanted = qRound(path[turned++].push_N / kNotch_N);
        turnWheel(place, wanted - notches);
        notches = wanted;
      }
      const std::optional<QPoint> to = pixelOf(frame, at(path, now_s()));
      QVERIFY(to);
      place = *to;
      pointAt(place);
      advance(1.0 / rate_hz);
      if (now_s() >= seen_s) {
        seen_s += kFrame_s;
        showFrame();
      }
      const Vec3 tool_mm = session.state().record.arms[arm].proxy_position_mm;
      const Vec3 here_mm = glm::conjugate(frame.rotation) * (tool_mm - frame.position_mm);
      run.cut.deepest_mm[arm] = std::min(run.cut.deepest_mm[arm], here_mm.z);
    }
    pass(0.05);
  }

  // Tab, with the pointer where the path begins.
  void takeHandOf(Hand hand, const QPoint& place) {
    auto* shown = find<QLabel>("activeHand");
    const QString wanted = hand == Hand::left ? "Left hand" : "Right hand";
    pointAt(place);
    for (int n = 0; n < 2 && shown->text() != wanted; ++n) {
      QTest::keyClick(&view(), Qt::Key_Tab);
    }
    QCOMPARE(shown->text(), wanted);
    pass(0.05);
  }

  void lookInside(const Case& of, const std::filesystem::path& recording, Run& run) {
    const auto reader = SessionReader::open(recording);
    QVERIFY(reader.ok());
    const auto carves = (*reader)->carves();
    const auto ticks = (*reader)->ticks(0, (*reader)->tickCount());
    QVERIFY(carves.ok() && ticks.ok());
    Volume volume = *of.volume;
    std::size_t next = 0;
    for (const TickRecord& tick : *ticks) {
      for (; next < carves->size() && (*carves)[next].tick <= tick.tick; ++next) {
        volume.hu[(*carves)[next].voxel] = kAirHu;
      }
      if (tick.tick % 20 != 19) continue;
      for (std::size_t i = 0; i < run.cut.parameters.arms.size(); ++i) {
        const Pose drawn_mm{tick.arms[i].proxy_position_mm, tick.arms[i].proxy_orientation};
        for (const BodyPart& part : run.cut.parameters.arms[i].tool.body) {
          test::lookInside(volume, run.cut.parameters.tissues, part, drawn_mm, run.inside);
        }
      }
    }
  }

  void practise(const test::PointerTask& task, double rate_hz, Run& run) {
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    RunReport report;
    QObject ears;
    connect(&workstation(), &Workstation::exerciseReported, &ears,
            [&](const RunReport& of) { report = of; });
    window_->startExercise();
    QVERIFY(started.count() > 0 || started.wait(kLong_ms));
    pass(0.3);
    Session& session = *workstation().session();
    run.cut.frame = session.landmarks()[0].frame;
    run.cut.parameters = hapticParameters(session.exercise(), session.rig());
    const std::vector<ExerciseArm>& arms = session.exercise().arms;
    QCOMPARE(arms.size(), task.arms.size());
    for (std::size_t arm = 0; arm < arms.size(); ++arm) {
      follow(arm, task.arms[arm], rate_hz, run);
      if (QTest::currentTestFailed()) return;
    }
    workstation().stop();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    for (const auto& [tissue, mm3] : report.done.removed_mm3) {
      run.cut.of_mm3[tissue] = mm3;
      run.removed_mm3 += mm3;
    }
    for (const ArmFault& fault : report.done.faults) {
      QFAIL(qPrintable(QString("fault %1 at tick %2").arg(fault.fault).arg(fault.tick)));
    }
    run.cut.carved = workstation().carved();
    QVERIFY(run.cut.carved);
    lookInside(*workstation().currentCase(), report.recording, run);
  }

  void finishAtAnyRate(const test::PointerTask& task) {
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    window_->open(resourceFolder() / "scenes" / (task.name + ".json"));
    QVERIFY(opened.count() > 0 || opened.wait(kLong_ms));
    restRefined();
    std::vector<double> removed_mm3;
    for (const double rate_hz : kRates_hz) {
      finish(task, rate_hz, removed_mm3);
      if (QTest::currentTestFailed()) return;
    }
    const auto [least_mm3, most_mm3] = std::ranges::minmax(removed_mm3);
    std::printf("%-16s within %.1f %%\n", task.name.c_str(), 100.0 * (most_mm3 / least_mm3 - 1.0));
    QVERIFY2(most_mm3 < 1.05 * least_mm3, "not the same at any rate");
  }

  void finish(const test::PointerTask& task, double rate_hz, std::vector<double>& removed_mm3) {
    Run run;
    practise(task, rate_hz, run);
    if (QTest::currentTestFailed()) return;
    std::printf("%-16s %4.0f/s %7.1f mm3, uncut bone in a tool %.2f mm deep at most\n",
                task.name.c_str(), rate_hz, run.removed_mm3, std::max(0.0, run.inside.deepest_mm));
    std::fflush(stdout);
    for (const std::string& what : test::missing(task, run.cut)) qWarning("%s", what.c_str());
    QVERIFY2(test::missing(task, run.cut).empty(), "the exercise is not finished");
    QCOMPARE(run.inside.voxels, 0);
    removed_mm3.push_back(run.removed_mm3);
  }

 private slots:
  void init() {
    openWindow("trephine-test-pointer");
    test::prefer([](Preferences& of) { of.push_step_N = kNotch_N; });
  }
  void cleanup() { closeWindow(); }

  void theBurrHole() { finishAtAnyRate(test::kBurrHole); }
  void theWindowWithOneArm() { finishAtAnyRate(test::kWindowOneArm); }
  void theWindowWithBothArms() { finishAtAnyRate(test::kWindow); }
  void theLiverWithOneArm() { finishAtAnyRate(test::kLiverOneArm); }
  void theLiverWithBothArms() { finishAtAnyRate(test::kLiver); }
};

int main(int argc, char** argv) {
  return test::runInWindow<PointerGuiTest>(argc, argv);
}

#include "pointer_gui_test.moc"
