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
#include "ui/common/preferences.h"
#include "ui/common/settings.h"
#include "ui/common/stall_meter.h"
#include "ui/common/words.h"
#include "ui/frame/main_window.h"
#include "ui/frame/start_up.h"
#include "volume/phantom_file.h"
#include "volume/volume_files.h"

namespace trephine::test {

// As a person would in the dialog of settings.
inline void prefer(const std::function<void(Preferences&)>& change) {
  Preferences wanted = preferences();
  change(wanted);
  keepPreferences(wanted);
}

// Every so many voxels of the cranium, on each axis: the tests are about the window.
inline Volume coarseCranium(int factor) {
  const Volume whole = openPhantom("cranium")->volume;
  Volume coarse{whole.geometry, {}};
  for (int axis = 0; axis < 3; ++axis) {
    coarse.geometry.size[std::size_t(axis)] /= factor;
    coarse.geometry.spacing_mm[axis] *= double(factor);
  }
  const Index3& size = coarse.geometry.size;
  coarse.hu.reserve(coarse.geometry.voxelCount());
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        coarse.hu.push_back(whole.at(factor * i, factor * j, factor * k));
      }
    }
  }
  return coarse;
}

// An exercise of the built-in cranium's kind on that case; both are written into the folder.
inline std::filesystem::path exerciseOn(const Volume& volume, const std::filesystem::path& folder,
                                        const std::string& name) {
  const std::filesystem::path exercises = resourceFolder() / "scenes",
                              of = folder / (name + ".mha");
  Json exercise = *readJsonFile(exercises / "cranium.json");
  const auto makeAbsolute = [&](Json& path) {
    path = (exercises / path.get<std::string>()).lexically_normal().string();
  };
  exercise["case"] = of.string();
  makeAbsolute(exercise["tissues"]);
  makeAbsolute(exercise["operator"]);
  for (Json& tool : exercise["tools"]) makeAbsolute(tool["file"]);
  const std::filesystem::path file = folder / (name + ".json");
  if (!writeVolume(volume, of) || !writeTextFile(file, exercise.dump())) {
    qFatal("%s cannot be written", file.c_str());
  }
  return file;
}

// A test of one window, with a folder of its own. Exercises run on the test's clock, never late:
// their time passes in pass(), and by 20 ms with each beat of a timer, so that whatever waits for
// them goes on. Nothing here waits for a time; see rest() and Qt's QTRY macros.
class WindowTest : public QObject {
 public:
  WindowTest() {
    constexpr int kBeat_ms = 10;
    constexpr double kBeat_s = 0.02;
    connect(&beat_, &QTimer::timeout, this, [this] { advance(kBeat_s); });
    beat_.start(kBeat_ms);
  }

 protected:
  static constexpr int kLong_ms = 120000;

  Workstation& workstation() { return window_->workstation(); }
  template <class Widget>
  Widget* find(const QString& name) {
    auto* widget = window_->findChild<Widget*>(name);
    if (!widget) qFatal("the window has no %s", qPrintable(name));
    return widget;
  }

  // All windows of a test come from here.
  template <class... Arguments>
  std::unique_ptr<MainWindow> newWindow(Arguments&&... arguments) {
    auto window = std::make_unique<MainWindow>(std::forward<Arguments>(arguments)...);
    window->workstation().setStepped(!real_time_);
    return window;
  }
  // So many seconds of the exercise. The window sees ten states a second of it.
  void pass(double seconds) {
    constexpr double kSeen_s = 0.1;
    for (double left_s = seconds; left_s > 1e-6; left_s -= kSeen_s) {
      advance(std::min(kSeen_s, left_s));
      showFrame();
      QCoreApplication::processEvents();
    }
  }
  // The same, of which the window sees nothing until showFrame().
  void advance(double seconds) {
    Session* session = window_ && !real_time_ ? workstation().session() : nullptr;
    if (session) session->advance(seconds);
  }
  void showFrame() { window_->showExercise(); }
  // Until the window has done what it was asked: what is queued, also by that, and its 3-D picture.
  // What comes by a timer of its own or from another thread is to be waited for by what it does.
  static void rest() { turns(5); }
  // So many turns of the event loop.
  static void turns(int count) {
    for (int turn = 0; turn < count; ++turn) {
      QCoreApplication::sendPostedEvents();
      QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
      QCoreApplication::processEvents();
    }
  }
  // What is painted counts a moment later.
  void untilStructuresAreTaken() {
    rest();
    QTRY_VERIFY_WITH_TIMEOUT(!find<QTimer>("structuresSettled")->isActive(), kLong_ms);
    rest();
  }
  void restRefined() {
    rest();
    if (!window_->view().isVisible() || !window_->view().canDraw()) return;
    QTRY_VERIFY_WITH_TIMEOUT(window_->view().isComplete(), kLong_ms);
  }
  // The pointer comes to a place of the view, without the X server's detour.
  void pointAt(QPoint place) { moveTo(window_->view(), place); }
  static void moveTo(QWidget& widget, QPoint place, Qt::MouseButtons buttons = Qt::NoButton) {
    QMouseEvent event(QEvent::MouseMove, place, widget.mapToGlobal(QPointF(place)), Qt::NoButton,
                      buttons, Qt::NoModifier);
    QCoreApplication::sendEvent(&widget, &event);
  }

  void showTissues() {
    window_->show(Place::prepare);
    find<QTabWidget>("prepareTabs")->setCurrentIndex(PrepareWorkspace::kTissueTab);
  }
  void showStructures() {
    window_->show(Place::prepare);
    find<QTabWidget>("prepareTabs")->setCurrentIndex(PrepareWorkspace::kStructureTab);
  }

  // A tool of the views, by its name.
  void take(const char* name) {
    Toolbox& toolbox = window_->views().toolbox();
    const auto named = [&](ViewTool* tool) { return tool->objectName() == name; };
    const auto tool = std::ranges::find_if(toolbox.tools(), named);
    if (tool == toolbox.tools().end()) qFatal("the views have no %s", name);
    toolbox.take(**tool);
  }
  bool inHand(const char* name) { return window_->views().toolbox().inHand().objectName() == name; }

  // An empty window with settings of its own, 1280 x 800.
  void openWindow(const char* application) {
    QApplication::setApplicationName(application);
    QFile::remove(windowSettings().fileName());
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    window_ = newWindow(toPath(temporary_.path()) / "recordings");
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
      rest();
    }
    QTest::mouseRelease(handle, button, {}, to.toPoint());
  }

  enum class Hand { left, right };
  // The mouse has this hand from here on: Tab.
  void takeHand(Hand hand) {
    auto* shown = find<QLabel>("activeHand");
    const QString wanted = hand == Hand::left ? "Left hand" : "Right hand";
    pointAt(window_->view().rect().center());
    QTRY_VERIFY(shown->isVisible());
    for (int n = 0; n < 2 && shown->text() != wanted; ++n) {
      QTest::keyClick(&window_->view(), Qt::Key_Tab);
    }
    QCOMPARE(shown->text(), wanted);
    pass(0.05);
  }
  // How hard the hand presses at the middle of the exercise's view: the wheel.
  void pushHand(int notches) {
    ViewWidget& view = window_->view();
    const QPointF at = QRectF(view.rect()).center();
    for (int i = 0; i < std::abs(notches); ++i) {
      QWheelEvent event(at, view.mapToGlobal(at), {}, {0, notches > 0 ? 120 : -120}, Qt::NoButton,
                        Qt::NoModifier, Qt::NoScrollPhase, false);
      QCoreApplication::sendEvent(&view, &event);
      advance(0.015);
    }
    pass(0.05);
  }
  // Within 0.8 s.
  void dragHand(QPoint by) {
    const QPoint from = window_->view().rect().center();
    constexpr int kSteps = 40;
    for (int i = 1; i <= kSteps; ++i) {
      pointAt(from + by * i / kSteps);
      i % 4 == 0 ? pass(0.02) : advance(0.02);
    }
  }
  static std::uint64_t removedVoxels(Session& session) {
    std::uint64_t sum = 0;
    const LoopState state = session.state();
    for (const auto& arm : state.removed) {
      for (std::uint64_t voxels : arm) sum += voxels;
    }
    return sum;
  }
  // Onto the tissue, sideways, and out of it until the stroke has ended.
  void cut(QPoint across, Hand hand = Hand::right) {
    takeHand(hand);
    pushHand(15);
    pass(1.0);
    dragHand(across);
    pushHand(-15);
    pass(1.5);
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

  // Set before the first window: exercises run on threads of their own, as a person's do.
  bool real_time_ = false;
  QTemporaryDir temporary_;
  std::unique_ptr<MainWindow> window_;

 private:
  QTimer beat_;
};

// A test program's main(): skipped, with exit code 77, where nothing can be drawn. It has settings,
// data and state of its own, which go with it: two of these programs run at once.
template <class Test>
int runInWindow(int argc, char** argv) {
  const QTemporaryDir home;
  for (const char* folder : {"CONFIG", "DATA", "STATE"}) {
    qputenv((std::string("XDG_") + folder + "_HOME").c_str(), home.filePath(folder).toUtf8());
  }
  prepareMemory();
  if (Status display = prepareDisplay(); !display) {
    std::printf("SKIP: %s\n", display.error().sentence().c_str());
    return 77;
  }
  TimedApplication application(argc, argv);
  QApplication::setApplicationName("trephine-test");
  QFile::remove(windowSettings().fileName());  // of a test before
  colours::applyTheme(application);
  Test test;
  Stalls stalls(application);
  const int failed = QTest::qExec(&test, argc, argv);
  stalls.report(test.metaObject()->className());
  return failed;
}

}  // namespace trephine::test
