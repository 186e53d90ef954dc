// What the tests of Train share: a window of their own, and an exercise that runs in it.
#pragma once

#include <QSignalSpy>

#include "gui_support.h"

namespace trephine::test {

class TrainTest : public WindowTest {
 protected:
  ViewWidget& view() { return window_->view(); }
  void open(const Policy& policy = {}) {
    QFile::remove(windowSettings().fileName());
    window_ = newWindow(toPath(temporary_.filePath("storage/sessions")), policy);
    window_->resize(1280, 800);
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QApplication::setActiveWindow(window_.get());
  }
  void openExercise(const std::filesystem::path& file) {
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    window_->open(file);
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    QTRY_VERIFY(view().isVisible());
  }
  // To whatever has the focus.
  void key(int which, Qt::KeyboardModifiers modifiers = Qt::NoModifier, int times = 1) {
    for (int i = 0; i < times; ++i) {
      QWidget* to = QApplication::focusWidget();
      QTest::keyClick(to ? to : window_.get(), Qt::Key(which), modifiers);
      rest();
    }
  }
  void startTraining() {
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    window_->startExercise();
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
  }
  void stop() {
    workstation().stop();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
  }
  // An exercise in which something was cut has ended, and its result is shown.
  void showResultOf(const std::filesystem::path& exercise) {
    openExercise(exercise);
    startTraining();
    cut({30, 0});
    stop();
    QTRY_VERIFY_WITH_TIMEOUT(find<QWidget>("resultPage")->isVisible(), kLong_ms);
  }
  ArmRecord arm(std::size_t which) { return workstation().session()->state().record.arms[which]; }
};

}  // namespace trephine::test
