// The tools of the 3-D view, each driven by keys and the mouse as a person does, and looked at in
// its pixels.
#include <QApplication>
#include <QLabel>
#include <QLibrary>
#include <QMouseEvent>
#include <QScreen>
#include <QSignalSpy>
#include <QTemporaryDir>
#include <QVBoxLayout>
#include <QtTest>
#include <cmath>

#include "gui_support.h"
#include "render/picture.h"
#include "ui/common/words.h"
#include "ui/frame/main_window.h"
#include "ui/views/view_strip.h"

using namespace trephine;

namespace {

int differentPixels(const Picture& a, const Picture& b, int x_from = 0, int x_to = 1 << 20) {
  if (a.rgb.size() != b.rgb.size()) return -1;
  int count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = x_from; x < std::min(x_to, a.width); ++x) {
      const std::size_t at = (std::size_t(y) * std::size_t(a.width) + std::size_t(x)) * 3;
      int most = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        most = std::max(most, std::abs(int(a.rgb[at + c]) - int(b.rgb[at + c])));
      }
      count += most > 16;
    }
  }
  return count;
}

// Mean brightness (0 to 255) between two columns, within the middle half of a picture's height.
double brightness(const Picture& picture, int x_from, int x_to) {
  double sum = 0.0;
  int count = 0;
  for (int y = picture.height / 4; y < 3 * picture.height / 4; ++y) {
    for (int x = x_from; x < x_to; ++x, ++count) {
      const std::size_t at = (std::size_t(y) * std::size_t(picture.width) + std::size_t(x)) * 3;
      sum += (picture.rgb[at] + picture.rgb[at + 1] + picture.rgb[at + 2]) / 3.0;
    }
  }
  return sum / std::max(1, count);
}
// How much brighter the left of the picture's middle is than the right of it.
double brighterLeft(const Picture& picture) {
  const int middle = picture.width / 2, reach = picture.width / 6;
  return brightness(picture, middle - reach, middle) - brightness(picture, middle, middle + reach);
}

}  // namespace

class ViewToolsGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  Picture opened_;

  ViewWidget& view() { return window_->view(); }
  Picture shot() {
    const Result<Picture> picture = view().picture();
    return picture ? *picture : Picture{};
  }
  // What the window shows once it is at rest, handles and all.
  Picture seen() {
    restRefined();
    const auto label = view().findChild<QLabel*>("viewLevel");
    [&] { QTRY_VERIFY_WITH_TIMEOUT(label->text().isEmpty(), kLong_ms); }();
    const QImage image = view().grabFramebuffer().convertToFormat(QImage::Format_RGB888);
    Picture picture{image.width(), image.height(), {}};
    for (int y = 0; y < image.height(); ++y) {
      const uchar* row = image.constScanLine(y);
      picture.rgb.insert(picture.rgb.end(), row, row + image.width() * 3);
    }
    return picture;
  }
  void press(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
    QApplication::setActiveWindow(window_.get());  // no window manager may be there to do it
    view().setFocus();
    QTRY_VERIFY(view().hasFocus());
    QTest::keyClick(&view(), key, modifiers);
  }
  void move(const QPoint& to) {
    QMouseEvent event(QEvent::MouseMove, to, view().mapToGlobal(to), Qt::NoButton, Qt::LeftButton,
                      Qt::NoModifier);
    QApplication::sendEvent(&view(), &event);
  }
  void drag(const QPoint& from, const QPoint& to) {
    QTest::mousePress(&view(), Qt::LeftButton, {}, from);
    move(from + (to - from) / 2);
    move(to);
    QTest::mouseRelease(&view(), Qt::LeftButton, {}, to);
  }

 private slots:
  void initTestCase() {
    QVERIFY(temporary_.isValid());
    window_ = newWindow(toPath(temporary_.filePath("recordings")));
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    window_->workstation().openPhantom("cranium");
    QTRY_VERIFY_WITH_TIMEOUT(window_->workstation().currentCase() != nullptr, kLong_ms);
    QTRY_VERIFY_WITH_TIMEOUT(!shot().rgb.empty(), kLong_ms);
    opened_ = shot();
  }

  void theStripIsOverTheViewAndTheMenuHasTheSame() {
    QVERIFY(view().tools().isVisible());
    for (QAction* tool : view().tools().all()) {
      if (tool) QVERIFY2(tool->associatedObjects().size() >= 3, qPrintable(tool->text()));
    }
  }

  void aKeyLooksFromASide() {
    press(Qt::Key_A, Qt::ShiftModifier);
    const Picture front = shot();
    press(Qt::Key_L, Qt::ShiftModifier);
    QVERIFY(differentPixels(front, shot()) > 2000);
    press(Qt::Key_A, Qt::ShiftModifier);
    QCOMPARE(differentPixels(front, shot()), 0);
  }

  void theFirstPressShowsAllOfThePatientWhateverWasLookedAt() {
    press(Qt::Key_A, Qt::ShiftModifier);
    const Picture whole = shot();
    press(Qt::Key_L, Qt::ShiftModifier);
    for (int n = 0; n < 3; ++n) press(Qt::Key_PageDown);
    press(Qt::Key_A, Qt::ShiftModifier);
    QCOMPARE(differentPixels(whole, shot()), 0);
    const ViewCamera& camera = view().camera();
    const GridGeometry& g = window_->workstation().currentCase()->volume->geometry;
    QVERIFY(glm::distance(camera.focus(), g.centre_mm()) < 0.2 * g.diagonal_mm());
  }

  void theExercisesOwnViewIsOneOfTheViews() {
    press(Qt::Key_E, Qt::ShiftModifier);
    const LandmarkFrame landmark = *window_->workstation().viewLandmark();
    QVERIFY(glm::distance(view().camera().focus(), landmark.position_mm) < 1e-6);
    QCOMPARE(view().camera().distance_mm(), window_->workstation().exercise()->view.distance_mm);
    find<QAction>("resetView")->trigger();
    QVERIFY(glm::distance(view().camera().focus(), landmark.position_mm) > 10.0);
    QVERIFY(view().camera().distance_mm() > window_->workstation().exercise()->view.distance_mm);
  }

  void aDragTurnsAboutWhatIsSeen() {
    press(Qt::Key_A, Qt::ShiftModifier);
    const Vec3 middle = view().camera().focus();
    const QPoint from = view().rect().center() + QPoint(40, 20);
    drag(from, from + QPoint(220, 60));
    const double ratio = view().devicePixelRatioF();
    const auto at =
        view().camera().pixelOf(middle, int(view().width() * ratio), int(view().height() * ratio));
    QVERIFY(at);
    QVERIFY2(std::abs(at->x - 0.5 * view().width() * ratio) < 2.0 &&
                 std::abs(at->y - 0.5 * view().height() * ratio) < 2.0,
             "the patient stays in the middle");
    // From near it is the place under the pointer that stays.
    press(Qt::Key_E, Qt::ShiftModifier);
    for (int n = 0; n < 2; ++n) press(Qt::Key_PageDown);
    const QPoint place = view().rect().center() + QPoint(30, 10);
    const std::optional<Picked> seen = view().pickAt(place);
    QVERIFY(seen);
    drag(place, place + QPoint(30, -20));
    const auto stays = view().camera().pixelOf(seen->at_mm, int(view().width() * ratio),
                                               int(view().height() * ratio));
    QVERIFY(stays);
    QVERIFY(std::abs(stays->x - place.x() * ratio) < 3.0);
    QVERIFY(std::abs(view().height() * ratio - stays->y - place.y() * ratio) < 3.0);
    press(Qt::Key_A, Qt::ShiftModifier);
  }

  void orthographicChangesThePictureAndComesBack() {
    const Picture before = shot();
    press(Qt::Key_O, Qt::ShiftModifier);
    QVERIFY(view().tools().parallel()->isChecked());
    QVERIFY(differentPixels(before, shot()) > 500);
    press(Qt::Key_O, Qt::ShiftModifier);
    QCOMPARE(differentPixels(before, shot()), 0);
  }

  void theBoxIsShownWithItsHandlesAndAHandleIsDragged() {
    const Picture before = seen();
    press(Qt::Key_B, Qt::ShiftModifier);
    const Picture boxed = seen();
    QVERIFY(differentPixels(before, boxed) > 100);
    // The handle of the patient's left face lies at the right of the picture's middle.
    const GridGeometry& g = view().shownVolume().geometry;
    const QSignalSpy moved(&view(), &ViewWidget::pointed);
    const ViewCamera& camera = view().camera();
    const Vec3 face =
        g.toPatient_mm(Vec3(g.size[0] - 0.5, (g.size[1] - 1) / 2.0, (g.size[2] - 1) / 2.0));
    const auto pixel = camera.pixelOf(face, view().width(), view().height());
    QVERIFY(pixel);
    const QPoint from(int(pixel->x), view().height() - int(pixel->y));
    drag(from, from - QPoint(60, 0));
    QVERIFY2(differentPixels(boxed, seen()) > 100, "the handle and the box's edge went with it");
    QCOMPARE(camera.forward(), Vec3(0, 1, 0));  // the drag turned no camera
    press(Qt::Key_X, Qt::ShiftModifier);
    QVERIFY(!view().tools().box()->isChecked());
    QCOMPARE(differentPixels(before, seen()), 0);
  }

  void thePlaneComesByKeyMovesByKeyAndGoes() {
    const Picture before = seen();
    press(Qt::Key_C, Qt::ShiftModifier);
    const Picture with = seen();
    QVERIFY(differentPixels(before, with) > 100);
    for (int i = 0; i < 8; ++i) press(Qt::Key_Comma);
    QVERIFY(differentPixels(with, seen()) > 50);
    press(Qt::Key_C, Qt::ShiftModifier);
    QCOMPARE(differentPixels(before, seen()), 0);
    press(Qt::Key_X, Qt::ShiftModifier);
  }

  // The plane faces the eye, in the middle of the head: the nose and brow before it are gone, and
  // where it meets bone there is a flat face as bright as the light makes one that looks at the
  // eye.
  void thePlaneRemovesWhatLiesBeforeItAndLeavesWhatLiesBehind() {
    press(Qt::Key_A, Qt::ShiftModifier);
    const Picture whole = shot();
    press(Qt::Key_C, Qt::ShiftModifier);
    const Picture halved = shot();
    const int changed = differentPixels(whole, halved);
    QVERIFY2(changed > whole.width * whole.height / 20, qPrintable(QString::number(changed)));
    // Moved to before the head it takes nothing away, moved behind it everything.
    for (int i = 0; i < 200; ++i) press(Qt::Key_Period);
    const Picture before_all = shot();
    for (int i = 0; i < 400; ++i) press(Qt::Key_Comma);
    const Picture behind_all = shot();
    const int one = differentPixels(whole, before_all), other = differentPixels(whole, behind_all);
    QVERIFY2(std::min(one, other) == 0, qPrintable(QString("%1 %2").arg(one).arg(other)));
    QVERIFY2(std::max(one, other) > changed, qPrintable(QString("%1 %2").arg(one).arg(other)));
    press(Qt::Key_X, Qt::ShiftModifier);
    QCOMPARE(differentPixels(whole, shot()), 0);
  }

  void thePlaneThroughTheToolNeedsATool() {
    QAction* through = view().findChild<QAction*>("clipThroughTool");
    QVERIFY(through && !through->isEnabled());
    ToolView tool;
    tool.length_mm = 40.0;
    tool.pose_mm.position = view().shownVolume().geometry.centre_mm();
    const Picture before = seen();
    view().setTools({tool});
    QVERIFY(through->isEnabled());
    press(Qt::Key_T, Qt::ShiftModifier);
    QVERIFY(view().tools().plane()->isChecked());
    QVERIFY(differentPixels(before, seen()) > 100);
    view().setTools({});
    press(Qt::Key_X, Qt::ShiftModifier);
    QCOMPARE(differentPixels(before, seen()), 0);
  }

  void inTheLightsModeADragTurnsNoCamera() {
    const Picture before = seen();
    press(Qt::Key_M, Qt::ShiftModifier);
    QVERIFY(view().tools().light()->isChecked());
    QVERIFY2(differentPixels(before, seen()) > 20, "where the light is stands in the view");
    QCOMPARE(differentPixels(shot(), before), 0);  // but in no picture that is saved
    const Vec3 forward = view().camera().forward();
    const QPoint middle = view().rect().center();
    drag(middle, middle + QPoint(120, 40));
    QCOMPARE(view().camera().forward(), forward);
    press(Qt::Key_X, Qt::ShiftModifier);
    QVERIFY(!view().tools().light()->isChecked());
    drag(middle, middle + QPoint(60, 0));
    QVERIFY(view().camera().forward() != forward);
    press(Qt::Key_A, Qt::ShiftModifier);
  }

  void theLitSideFollowsTheLight() {
    press(Qt::Key_A, Qt::ShiftModifier);
    const Picture before = shot();
    const QPoint middle = view().rect().center();
    press(Qt::Key_M, Qt::ShiftModifier);
    drag(middle, middle - QPoint(300, 0));
    const double from_left = brighterLeft(shot());
    for (int i = 0; i < 2; ++i) drag(middle, middle + QPoint(300, 0));
    const double from_right = brighterLeft(shot());
    QVERIFY2(from_left > from_right + 20.0,
             qPrintable(QString("%1 %2").arg(from_left).arg(from_right)));
    press(Qt::Key_X, Qt::ShiftModifier);
    QCOMPARE(differentPixels(before, shot()), 0);
  }

  void aToolMovesOverThePictureAtOnce() {
    const auto label = view().findChild<QLabel*>("viewLevel");
    seen();  // at rest
    ToolView tool;
    tool.length_mm = 60.0;
    tool.colour = Vec3(0, 0, 1);
    const Vec3 centre = view().shownVolume().geometry.centre_mm();
    tool.pose_mm.position = centre - view().camera().forward() * 140.0;
    view().setTools({tool});
    QSignalSpy painted(&view(), &ViewWidget::framePainted);
    QTRY_VERIFY(!painted.isEmpty());
    QVERIFY2(label->text().isEmpty(), "no coarser picture of the volume was made");
    view().setTools({});
  }

  void nothingStaysOnTheScreenOfWhatWasSaidOfALevel() {
    const auto label = view().findChild<QLabel*>("viewLevel");
    press(Qt::Key_Left);
    QTRY_VERIFY(!label->text().isEmpty());
    label->repaint();  // it is on the screen
    seen();
    const QRect place(view().mapTo(window_.get(), label->pos()), label->size());
    QImage own = view().grabFramebuffer().copy(label->geometry());
    own = own.convertToFormat(QImage::Format_RGB32);
    QImage screen;
    const auto alike = [&] {
      rest();
      screen =
          window_->screen()
              ->grabWindow(window_->winId(), place.x(), place.y(), place.width(), place.height())
              .toImage()
              .convertToFormat(QImage::Format_RGB32);
      return screen == own;
    };
    QVERIFY(QTest::qWaitFor(alike, 3000));
  }

  void whatChangesOverTheViewAloneDrawsNoPicture() {
    seen();  // at rest
    QSignalSpy painted(&view(), &ViewWidget::framePainted);
    QLabel over(&view());
    over.setText("over the view");
    over.setGeometry(20, view().height() / 2, 120, 30);
    over.setAutoFillBackground(true);
    over.show();
    const QPoint place = over.mapTo(window_.get(), over.rect().topLeft());
    const auto onScreen = [&] {
      rest();
      return window_->screen()
          ->grabWindow(window_->winId(), place.x(), place.y(), over.width(), over.height())
          .toImage()
          .convertToFormat(QImage::Format_RGB32);
    };
    const auto own = [&] { return over.grab().toImage().convertToFormat(QImage::Format_RGB32); };
    QVERIFY(QTest::qWaitFor([&] { return onScreen() == own(); }, 3000));
    const QImage first = onScreen();
    over.setText("and something else");
    QVERIFY(QTest::qWaitFor([&] { return onScreen() == own() && own() != first; }, 3000));
    QCOMPARE(painted.count(), 0);
  }

  // Input that comes while a picture is drawn wants another: both are shown.
  void noPictureIsDrawnInVain() {
    if (view().way() == WayToScreen::composed) QSKIP("Qt draws as it paints");
    seen();
    int drawn = 0, painted = 0;
    QObject ears;
    struct Painted : QObject {
      explicit Painted(int& count) : count_(count) {}
      bool eventFilter(QObject*, QEvent* event) override {
        count_ += event->type() == QEvent::Paint;
        return false;
      }
      int& count_;
    } filter(painted);
    view().installEventFilter(&filter);
    constexpr int kPictures = 20;
    connect(&view(), &ViewWidget::framePainted, &ears, [&] {
      if (++drawn < kPictures) view().update();
    });
    view().update();
    QTRY_COMPARE(drawn, kPictures);
    rest();
    QVERIFY2(painted >= drawn, qPrintable(QString("%1 of %2").arg(painted).arg(drawn)));
    view().removeEventFilter(&filter);
  }

  void whatChangedWhileTheWindowWasAwayIsDrawnOnceItIsBack() {
    seen();
    // As a window manager takes it to another desktop: Qt is not asked.
    const auto onServer = [&](const char* what) {
      QLibrary x11("libX11", 6);
      const auto open = reinterpret_cast<void* (*)(const char*)>(x11.resolve("XOpenDisplay"));
      const auto ask = reinterpret_cast<int (*)(void*, unsigned long)>(x11.resolve(what));
      const auto close = reinterpret_cast<int (*)(void*)>(x11.resolve("XCloseDisplay"));
      void* display = open ? open(nullptr) : nullptr;
      if (!display || !ask || !close) qFatal("no %s", what);
      ask(display, window_->winId());
      close(display);  // which waits until it is done
    };
    onServer("XUnmapWindow");
    QTRY_VERIFY(!window_->windowHandle()->isExposed());
    QSignalSpy painted(&view(), &ViewWidget::framePainted);
    view().update();
    rest();
    QCOMPARE(painted.count(), 0);
    onServer("XMapWindow");
    QTRY_VERIFY(window_->windowHandle()->isExposed());
    QTRY_VERIFY(!painted.isEmpty());
  }

  // A card may cover all of it while others wait for a picture.
  void aViewThatIsCoveredDrawsAllTheSame() {
    seen();
    QWidget cover(view().parentWidget());
    cover.setGeometry(view().geometry());
    cover.setAutoFillBackground(true);
    cover.show();
    cover.raise();
    rest();
    QSignalSpy painted(&view(), &ViewWidget::framePainted);
    view().update();
    QTRY_VERIFY(!painted.isEmpty());
  }

  void aLostContextIsRebuilt() {
    const Picture before = shot();
    QWidget* home = view().parentWidget();
    QVERIFY(home);
    const QRect place = view().geometry();
    QWidget other;
    auto* box = new QVBoxLayout(&other);
    box->addWidget(&view());
    other.resize(700, 500);
    other.show();
    QVERIFY(QTest::qWaitForWindowExposed(&other));
    QTRY_VERIFY_WITH_TIMEOUT(!shot().rgb.empty(), kLong_ms);
    const Picture elsewhere = shot();
    int lit = 0;
    for (const std::uint8_t value : elsewhere.rgb) lit += value > 120;
    QVERIFY2(lit > 5000, "the case is seen in the other window");
    view().setParent(home);
    view().setGeometry(place);
    view().show();
    QTRY_COMPARE_WITH_TIMEOUT(shot().width, before.width, kLong_ms);
    QTRY_COMPARE_WITH_TIMEOUT(differentPixels(before, shot()), 0, kLong_ms);
  }

  void aViewOfNoSizeDoesNoHarm() {
    const QSize size = view().size(), least = view().minimumSize();
    const int width = shot().width;
    view().setMinimumSize(0, 0);
    view().resize(0, 0);
    rest();
    view().resize(1, 1);
    rest();
    view().setMinimumSize(least);
    view().resize(size);
    QTRY_COMPARE_WITH_TIMEOUT(shot().width, width, 20000);
  }

  void aToolSaysHowFarItIsFromTheSurface() {
    window_->findChild<QAction*>("resetView")->trigger();  // the focus lies on the surface
    const Picture before = seen();
    const ViewCamera& camera = view().camera();
    ToolView tool;
    tool.length_mm = 60.0;
    tool.radius_mm = 1.0;
    const Vec3 way = glm::normalize(camera.forward() + 0.6 * camera.right());
    tool.pose_mm.position = camera.focus() - 20.0 * way;
    tool.pose_mm.orientation = glm::quatLookAt(way, camera.up());  // -z points the way
    tool.contact = true;
    view().setTools({tool});
    const Picture touching = seen();
    tool.contact = false;
    view().setTools({tool});
    const Picture away = seen();
    QVERIFY(differentPixels(before, away) > 50);
    QVERIFY2(differentPixels(touching, away) > 50, "a ring at the tip, or the way with its length");
    view().grab().save(QStringLiteral(TREPHINE_ARTEFACTS "/view_guide.png"));
    view().setTools({});
  }

  void cleanupTestCase() { window_.reset(); }
};

int main(int argc, char** argv) {
  return test::runInWindow<ViewToolsGuiTest>(argc, argv);
}
#include "view_tools_gui_test.moc"
