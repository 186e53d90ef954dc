// What the tests of the real window share: the case that they open and how they start.
#pragma once

#include <QAction>
#include <QDir>
#include <QFile>
#include <QStandardPaths>
#include <QTemporaryDir>
#include <QWheelEvent>
#include <QWindow>
#include <QtTest>
#include <cstdio>
#include <cstdlib>

#include "base/file.h"
#include "base/system.h"
#include "stalls.h"
#include "ui/common/colours.h"
#include "ui/common/settings.h"
#include "ui/common/stall_meter.h"
#include "ui/common/words.h"
#include "ui/frame/main_window.h"
#include "ui/frame/start_up.h"
#include "volume/phantom.h"
#include "volume/volume_files.h"

namespace trephine::test {

// The cranium on a grid so many times coarser: the tests are about the window.
inline Volume coarseCranium(int factor) {
  GridGeometry geometry = *phantomGeometry("cranium");
  for (int axis = 0; axis < 3; ++axis) {
    geometry.size[std::size_t(axis)] /= factor;
    geometry.spacing_mm[axis] *= double(factor);
  }
  return makePhantomOn(*phantomTruth("cranium"), geometry, kPhantomNoiseHu);
}

// A scene of the built-in cranium's kind on that case; both are written into the folder.
inline std::filesystem::path sceneOn(const Volume& volume, const std::filesystem::path& folder,
                                     const std::string& name) {
  const std::filesystem::path scenes = resourceFolder() / "scenes", of = folder / (name + ".mha");
  Json scene = *readJsonFile(scenes / "cranium.json");
  const auto makeAbsolute = [&](Json& path) {
    path = (scenes / path.get<std::string>()).lexically_normal().string();
  };
  scene["case"] = of.string();
  makeAbsolute(scene["tissues"]);
  makeAbsolute(scene["operator"]);
  for (Json& tool : scene["tools"]) makeAbsolute(tool["file"]);
  const std::filesystem::path file = folder / (name + ".json");
  if (!writeVolume(volume, of) || !writeTextFile(file, scene.dump())) {
    qFatal("%s cannot be written", file.c_str());
  }
  return file;
}

// A test of one window, with a folder of its own.
class WindowTest : public QObject {
 protected:
  Workstation& workstation() { return window_->workstation(); }
  template <class Widget>
  Widget* find(const QString& name) {
    auto* widget = window_->findChild<Widget*>(name);
    if (!widget) qFatal("the window has no %s", qPrintable(name));
    return widget;
  }

  void showTissues() {
    window_->show(Place::prepare);
    find<QTabWidget>("prepareTabs")->setCurrentIndex(PrepareWorkspace::kTissueTab);
  }
  void showStructures() {
    window_->show(Place::prepare);
    find<QTabWidget>("prepareTabs")->setCurrentIndex(PrepareWorkspace::kStructureTab);
  }

  // An empty window with settings of its own, 1280 x 800.
  void openWindow(const char* application) {
    QApplication::setApplicationName(application);
    QFile::remove(windowSettings().fileName());
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    window_ = std::make_unique<MainWindow>(toPath(temporary_.path()) / "recordings");
    window_->resize(1280, 800);
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
  }
  void closeWindow() {
    window_.reset();
    QFile::remove(windowSettings().fileName());
  }
  // As a hand does, in the window's pixels.
  void dragInWindow(const QPointF& from, const QPointF& to, Qt::MouseButton button) {
    constexpr int kSteps = 8;
    QWindow* handle = window_->windowHandle();
    QTest::mousePress(handle, button, {}, from.toPoint());
    for (int i = 1; i <= kSteps; ++i) {
      QTest::mouseMove(handle, (from + (to - from) * (double(i) / kSteps)).toPoint());
      QTest::qWait(10);
    }
    QTest::mouseRelease(handle, button, {}, to.toPoint());
  }

  enum class Hand { left, right };
  // The mouse has this hand from here on: Tab.
  void takeHand(Hand hand) {
    auto* shown = find<QLabel>("activeHand");
    const QString wanted = hand == Hand::left ? "Left hand" : "Right hand";
    pointAt(window_->view().rect().center());
    for (int n = 0; n < 2 && shown->text() != wanted; ++n) {
      QTest::keyClick(&window_->view(), Qt::Key_Tab);
      QTest::qWait(50);
    }
    QCOMPARE(shown->text(), wanted);
  }
  void pointAt(QPoint place) {
    QTest::mouseMove(&window_->view(), place + QPoint(3, 0));  // it may rest there already
    QTest::qWait(20);
    QTest::mouseMove(&window_->view(), place);
    QTest::qWait(50);
  }
  // How hard the hand presses at the middle of the exercise's view: the wheel.
  void pushHand(int notches) {
    ViewWidget& view = window_->view();
    const QPointF at = QRectF(view.rect()).center();
    for (int i = 0; i < std::abs(notches); ++i) {
      QWheelEvent event(at, view.mapToGlobal(at), {}, {0, notches > 0 ? 120 : -120}, Qt::NoButton,
                        Qt::NoModifier, Qt::NoScrollPhase, false);
      QCoreApplication::sendEvent(&view, &event);
      QTest::qWait(15);
    }
  }
  void dragHand(QPoint by) {
    const QPoint from = window_->view().rect().center();
    constexpr int kSteps = 40;
    for (int i = 1; i <= kSteps; ++i) {
      QTest::mouseMove(&window_->view(), from + by * i / kSteps);
      QTest::qWait(20);
    }
  }
  static std::uint64_t removedVoxels(Session& session) {
    std::uint64_t sum = 0;
    for (const auto& arm : session.state().removed) {
      for (std::uint64_t voxels : arm) sum += voxels;
    }
    return sum;
  }
  // Onto the tissue, sideways, and out of it until the stroke has ended. Where the machine was so
  // busy that a step came 20 ms late the arms are without force and cut nothing: then, as a person
  // would, one waits for the force or asks for it, and makes the cut again.
  void cut(QPoint across, Hand hand = Hand::right, std::uint64_t enough = 0) {
    for (int attempt = 0; attempt < 5; ++attempt) {
      takeHand(hand);
      const std::uint64_t standing = removedVoxels(*workstation().session());
      pushHand(15);
      QTest::qWait(1000);
      dragHand(attempt % 2 == 0 ? across : -across);
      pushHand(-15);
      QTest::qWait(1500);
      // Fewer voxels: the force went in the middle of it.
      if (removedVoxels(*workstation().session()) > standing + enough) return;
      qInfo("little or nothing was cut: once more");
      for (int n = 0; n < 5 && removedVoxels(*workstation().session()) != standing; ++n) {
        find<QAction>("undo")->trigger();
        QTest::qWait(300);
      }
      QTest::qWait(1500);
      find<QAction>("forceBack")->trigger();
    }
  }

  // A built-in case, from its card.
  void prepareBuiltIn(const char* name) {
    window_->show(Place::cases);
    auto* cards = find<QListWidget>("cases");
    const auto row = [&] {
      for (int i = 0; i < cards->count(); ++i) {
        if (cards->item(i)->data(Qt::UserRole).toString() == name) return i;
      }
      return -1;
    };
    QTRY_VERIFY_WITH_TIMEOUT(row() >= 0, 30000);
    cards->setCurrentRow(row());
    QTest::mouseClick(find<QPushButton>("prepareCase"), Qt::LeftButton);
  }

  QTemporaryDir temporary_;
  std::unique_ptr<MainWindow> window_;
};

// A test program's main(): skipped, with exit code 77, where nothing can be drawn.
template <class Test>
int runInWindow(int argc, char** argv) {
  prepareMemory();
  if (Status display = prepareDisplay(); !display) {
    std::printf("SKIP: %s\n", display.error().sentence().c_str());
    return 77;
  }
  TimedApplication application(argc, argv);
  QApplication::setApplicationName("trephine-test");
  QStandardPaths::setTestModeEnabled(true);
  QFile::remove(windowSettings().fileName());  // of a test before
  colours::applyTheme(application);
  Test test;
  Stalls stalls(application);
  const int failed = QTest::qExec(&test, argc, argv);
  stalls.report(test.metaObject()->className());
  return failed;
}

}  // namespace trephine::test
