// The controls of Train that no other test of the window uses: each by what it does to exercise,
// tissue or hand.
#include <QAbstractItemView>
#include <QComboBox>
#include <QLabel>
#include <QMessageBox>
#include <QPushButton>
#include <QToolButton>
#include <QtTest>

#include "base/file.h"
#include "file_size_limit.h"
#include "train_support.h"

using namespace trephine;

class TrainControlsGuiTest : public test::TrainTest {
  Q_OBJECT

  std::filesystem::path exercise_;

  void answer(const char* question, const char* button) {
    QTRY_VERIFY_WITH_TIMEOUT(window_->findChild<QMessageBox*>(question), kLong_ms);
    auto* asked = window_->findChild<QMessageBox*>(question);
    for (QPushButton* each : asked->findChildren<QPushButton*>()) {
      if (each->objectName() != button && each->text().remove('&') != button) continue;
      QTest::mouseClick(each, Qt::LeftButton);
      QTRY_VERIFY(!asked->isVisible());
      return;
    }
    QFAIL(qPrintable(QString("%1 has no %2").arg(question, button)));
  }
  double tilt(const Quat& from) {
    return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(from, arm(1).proxy_orientation))));
  }

 private slots:
  void initTestCase() {
    exercise_ = test::exerciseOn(test::coarseCranium(2), toPath(temporary_.path()), "coarse");
  }
  void init() { open(); }
  void cleanup() { window_.reset(); }

  void withoutACaseTheCardLeadsToTheCases() {
    window_->show(Place::train);
    QTRY_VERIFY(find<QPushButton>("startCardChoose")->isVisible());
    QTest::mouseClick(find<QPushButton>("startCardChoose"), Qt::LeftButton);
    QVERIFY(window_->place() == Place::cases);
  }

  void theCardStartsTheExercise() {
    openExercise(exercise_);
    QTRY_VERIFY_WITH_TIMEOUT(find<QPushButton>("startCardStart")->isEnabled(), kLong_ms);
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    QTest::mouseClick(find<QPushButton>("startCardStart"), Qt::LeftButton);
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
    QTRY_VERIFY(workstation().session()->state().ticks > 100);
    find<QAction>("stop")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
  }

  // The 3-D view is drawn anew for each size that it is given.
  void aWorkspaceGivesTheViewsTheirPlacesOnce() {
    openExercise(exercise_);
    window_->show(Place::prepare);
    restRefined();
    int sizes = 0;
    connect(&view(), &ViewWidget::resized, &view(), [&] { ++sizes; });
    for (const Place place : {Place::train, Place::prepare, Place::train}) {
      const QSize before = view().size();
      sizes = 0;
      window_->show(place);
      restRefined();
      QVERIFY(view().size() != before);
      QCOMPARE(sizes, 1);
    }
  }

  void shiftAndHomeStraightenTheTool() {
    openExercise(exercise_);
    startTraining();
    takeHand(Hand::right);
    pass(0.5);
    const Quat before = arm(1).proxy_orientation;
    view().setFocus();
    key(Qt::Key_Left, Qt::ShiftModifier, 5);
    key(Qt::Key_Up, Qt::ShiftModifier, 3);
    QTRY_VERIFY_WITH_TIMEOUT(tilt(before) > 0.1, 10000);
    key(Qt::Key_Home, Qt::ShiftModifier);
    QTRY_VERIFY_WITH_TIMEOUT(tilt(before) < 0.02, 10000);
    stop();
  }

  void anotherSizeOfTheViewLiftsTheToolWhereItIs() {
    openExercise(exercise_);
    startTraining();
    takeHand(Hand::right);
    pushHand(6);
    QTRY_VERIFY_WITH_TIMEOUT(removedVoxels(*workstation().session()) > 10, 20000);
    const QSize before = view().size();
    const Vec3 tip_mm = arm(1).proxy_position_mm;
    find<QAction>("leftPanel")->trigger();
    find<QAction>("rightPanel")->trigger();
    QTRY_VERIFY(view().width() > before.width() + 100);
    QTRY_COMPARE(workstation().session()->handPush_N(1), 0.0);
    double aside_mm = 0.0;
    const Vec3 deep = arm(1).proxy_orientation * Vec3(0, 0, 1);
    for (int n = 0; n < 100; ++n) {
      pass(0.02);
      const Vec3 moved = arm(1).proxy_position_mm - tip_mm;
      if (arm(1).tissue_class < 0) continue;
      aside_mm = std::max(aside_mm, glm::length(moved - glm::dot(moved, deep) * deep));
    }
    std::printf("aside by %.2f mm while it came out\n", aside_mm);
    QVERIFY2(aside_mm < 1.0, qPrintable(QString::number(aside_mm)));
    QVERIFY(arm(1).tissue_class < 0);
    pointAt(view().rect().center() + QPoint(60, 0));
    QTRY_VERIFY_WITH_TIMEOUT(glm::distance(arm(1).proxy_position_mm, tip_mm) > 3.0, 10000);
    stop();
  }

  void resetPutsAllTissueBackOnceItIsAgreed() {
    openExercise(exercise_);
    startTraining();
    cut({30, 0});
    QVERIFY(removedVoxels(*workstation().session()) > 0);
    find<QAction>("reset")->trigger();
    pass(0.2);
    QVERIFY2(removedVoxels(*workstation().session()) > 0, "not before it is agreed");
    answer("resetQuestion", "goOnAnyway");
    QTRY_COMPARE_WITH_TIMEOUT(removedVoxels(*workstation().session()), 0u, 10000);
    stop();
  }

  void backTakesTheLastSecondsAway() {
    openExercise(exercise_);
    startTraining();
    cut({30, 0});
    QVERIFY(removedVoxels(*workstation().session()) > 0);
    for (int n = 0; n < 5 && removedVoxels(*workstation().session()) > 0; ++n) {
      QTRY_VERIFY_WITH_TIMEOUT(find<QToolButton>("backButton")->isEnabled(), 10000);
      QTest::mouseClick(find<QToolButton>("backButton"), Qt::LeftButton);
      pass(1.5);
    }
    QCOMPARE(removedVoxels(*workstation().session()), 0u);
    stop();
  }

  void inAPauseNoPushIsSetThatWouldComeAsAStab() {
    openExercise(exercise_);
    startTraining();
    takeHand(Hand::right);
    pushHand(4);
    const double push_N = workstation().session()->handPush_N(1);
    QVERIFY(push_N > 0.5);
    find<QAction>("pause")->trigger();
    QTRY_VERIFY(workstation().session()->state().paused);
    pushHand(6);
    QCOMPARE(workstation().session()->handPush_N(1), push_N);
    pushHand(-2);
    QVERIFY(workstation().session()->handPush_N(1) < push_N);
    stop();
  }

  void afterAPauseTheToolGoesOnWhereItIsAndComesOutBeforeItFollowsThePointer() {
    openExercise(exercise_);
    startTraining();
    takeHand(Hand::right);
    pushHand(5);
    QTRY_VERIFY_WITH_TIMEOUT(arm(1).tissue_class >= 0, 10000);
    pass(0.5);
    find<QAction>("pause")->trigger();
    QTRY_VERIFY(workstation().session()->state().paused);
    const Vec3 tool_mm = arm(1).proxy_position_mm;
    const QPoint elsewhere = view().rect().center() + QPoint(120, 0);
    pointAt(elsewhere);  // to the button, say
    find<QAction>("pause")->trigger();
    QTRY_VERIFY(!workstation().session()->state().paused);
    pass(0.8);
    const Vec3 by_mm = arm(1).proxy_position_mm - tool_mm;
    const Vec3 ahead = view().camera().forward();
    const double aside_mm = glm::length(by_mm - glm::dot(by_mm, ahead) * ahead);
    QVERIFY2(aside_mm < 2.0, qPrintable(QString::number(aside_mm)));
    QVERIFY(workstation().session()->handPush_N(1) > 0.5);
    pointAt(elsewhere);
    QCOMPARE(workstation().session()->handPush_N(1), 0.0);
    QTRY_VERIFY_WITH_TIMEOUT(arm(1).tissue_class < 0, 10000);
    stop();
  }

  // Its arm's workspace has an end: Ctrl+L from there, and all of it is there again.
  void reCentredAHandReachesWhereItBegan() {
    openExercise(exercise_);
    startTraining();
    takeHand(Hand::right);
    key(Qt::Key_Right, Qt::NoModifier, 120);
    pass(0.5);
    key(Qt::Key_L, Qt::ControlModifier);
    pass(0.5);
    QCOMPARE(workstation().session()->handPush_N(1), 0.0);
    takeHand(Hand::right);
    pushHand(5);
    QTRY_VERIFY_WITH_TIMEOUT(glm::length(arm(1).sent_N) > 0.3, 10000);
    stop();
  }

  void aListThatIsOpenedByMouseLeavesTheKeysWithTheHands() {
    openExercise(exercise_);
    startTraining();
    view().setFocus();
    for (const char* name : {"rightTool", "controller"}) {
      auto* list = find<QComboBox>(name);
      QTRY_VERIFY(list->isEnabled());
      QTest::mousePress(list, Qt::LeftButton);
      QTRY_VERIFY(list->view()->isVisible());
      QTest::keyClick(list->view(), Qt::Key_Escape);
      QTRY_VERIFY(!list->view()->isVisible());
      QVERIFY2(window_->focusWidget() == &view(), name);
    }
    stop();
  }

  void fullScreenComesBackToAMaximisedWindow() {
    window_->setWindowState(Qt::WindowMaximized);
    find<QAction>("fullScreen")->trigger();
    QTRY_VERIFY(window_->isFullScreen());
    find<QAction>("fullScreen")->trigger();
    QTRY_VERIFY(!window_->isFullScreen());
    QVERIFY(window_->isMaximized());
  }

  void anotherExerciseStaysInTrainAndBeginsWithNothing() {
    openExercise(exercise_);
    startTraining();
    cut({30, 0});
    stop();
    QVERIFY(!find<QLabel>("exerciseRemoved")->text().contains("nothing"));
    auto* exercises = find<QComboBox>("scenes");
    const int other = exercises->findText("Burr hole in the vault");
    QVERIFY(other >= 0);
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    exercises->setCurrentIndex(other);
    emit exercises->activated(other);
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    QVERIFY(window_->place() == Place::train);
    QVERIFY(find<QLabel>("exerciseRemoved")->text().contains("nothing"));
    QCOMPARE(find<QLabel>("exerciseTime")->text(), "0:00");
  }

  void tryAgainStartsOnWholeTissue() {
    showResultOf(exercise_);
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    // The button says so itself: of what is recorded nothing is asked.
    QTest::mouseClick(find<QPushButton>("resultAgain"), Qt::LeftButton);
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
    QVERIFY(!find<QWidget>("resultPage")->isVisible());
    QCOMPARE(removedVoxels(*workstation().session()), 0u);
    QVERIFY(view().shownVolume().hu == workstation().currentCase()->volume->hu);
    stop();
  }

  void theCardIsPutAsideAndBroughtBack() {
    openExercise(exercise_);
    window_->show(Place::train);
    auto* card = find<QWidget>("startCard");
    QTRY_VERIFY(card->isVisible());
    QVERIFY(!find<QPushButton>("showCard")->isVisible());
    view().setFocus();
    QTest::keyClick(&view(), Qt::Key_Tab);
    QCOMPARE(window_->focusWidget(), find<QWidget>("startCardStart"));
    // Esc, wherever the keys are.
    const QList<QWidget*> places{window_->focusWidget(), &view(), find<QWidget>("controller"),
                                 find<QWidget>("axial")};
    for (QWidget* place : places) {
      place->setFocus();
      QTRY_VERIFY(place->hasFocus());
      QVERIFY(card->isVisible());
      QTest::keyClick(place, Qt::Key_Escape);
      QVERIFY2(!card->isVisible(), qPrintable(place->objectName()));
      if (place != places.last()) find<QPushButton>("showCard")->click();
    }
    window_->show(Place::prepare);
    window_->show(Place::train);
    QVERIFY2(!card->isVisible(), "aside it stays");
    QTest::mouseClick(find<QPushButton>("showCard"), Qt::LeftButton);
    QVERIFY(card->isVisible());
    QVERIFY(!find<QPushButton>("showCard")->isVisible());
    QTest::mouseClick(find<QPushButton>("startCardAside"), Qt::LeftButton);
    QVERIFY(!card->isVisible());
    startTraining();
    stop();
  }

  void theResultIsPutAsideAndBroughtBackAndIsThereAfterAWayElsewhere() {
    showResultOf(exercise_);
    auto* result = find<QWidget>("resultPage");
    view().setFocus();
    QTest::keyClick(&view(), Qt::Key_Tab);
    QCOMPARE(window_->focusWidget(), find<QWidget>("resultAgain"));
    view().setFocus();
    find<QAction>("fullScreen")->trigger();
    QTRY_VERIFY(window_->isFullScreen());
    QTest::keyClick(&view(), Qt::Key_Escape);
    QVERIFY(!result->isVisible());
    QVERIFY2(window_->isFullScreen(), "first what lies over the view");
    QTest::keyClick(&view(), Qt::Key_Escape);
    QTRY_VERIFY(!window_->isFullScreen());
    QCOMPARE(find<QPushButton>("showCard")->text(), "Show the &result");
    QTest::mouseClick(find<QPushButton>("showCard"), Qt::LeftButton);
    QVERIFY(result->isVisible());
    window_->show(Place::cases);
    QVERIFY(!result->isVisible());
    window_->show(Place::train);
    QVERIFY(result->isVisible());
    // With all tissue back the card says again what to do.
    find<QAction>("reset")->trigger();
    QTRY_VERIFY(find<QWidget>("startCard")->isVisible());
    QVERIFY(!result->isVisible());
  }

  void anExerciseForAnotherPartOfTheBodyIsChangedByItsQuestion() {
    // A head that came from a file: nobody said which exercise is for it.
    const auto head = toPath(temporary_.filePath("head.mha"));
    QVERIFY(writeVolume(test::coarseCranium(3), head));
    Json exercise =
        *readJsonFile(test::exerciseOn(test::coarseCranium(3), toPath(temporary_.path()), "third"));
    exercise["anatomy"] = "abdomen";
    const auto file = toPath(temporary_.filePath("abdomen.json"));
    QVERIFY(writeTextFile(file, exercise.dump()));
    openExercise(file);
    QVERIFY(workstation().exercise()->anatomy == "abdomen");
    find<QAction>("start")->trigger();
    answer("fitQuestion", "changeExercise");
    QTRY_VERIFY_WITH_TIMEOUT(workstation().exercise()->anatomy == "cranium", kLong_ms);
    QVERIFY(workstation().phase() != Workstation::Phase::running);
  }

  void aDiskThatIsFullAsksOnceAndTheExerciseGoesOnOrStops() {
    for (const char* button : {"Go on unrecorded", "Stop"}) {
      openExercise(exercise_);
      startTraining();
      Session& session = *workstation().session();
      {
        const test::FileSizeLimit full(64);
        answer("recordingFailed", button);
      }
      if (QString(button) == "Stop") {
        QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
      } else {
        QTRY_VERIFY(find<QLabel>("dropped")->text().contains("not recorded"));
        const auto ticks = session.state().ticks;
        QTRY_VERIFY_WITH_TIMEOUT(session.state().ticks > ticks + 500, 10000);
        stop();
      }
      QTRY_VERIFY_WITH_TIMEOUT(find<QWidget>("resultPage")->isVisible(), kLong_ms);
    }
  }
};

int main(int argc, char** argv) {
  return test::runInWindow<TrainControlsGuiTest>(argc, argv);
}

#include "train_controls_gui_test.moc"
