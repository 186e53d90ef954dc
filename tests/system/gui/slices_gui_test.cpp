// The slices in the real window, by mouse and keys: each tool is judged by the pixels of the view
// or by HU. The steps build on each other, in order.
#include <QApplication>
#include <QComboBox>
#include <QDir>
#include <QElapsedTimer>
#include <QFile>
#include <QFileDialog>
#include <QLineEdit>
#include <QMessageBox>
#include <QPushButton>
#include <QToolButton>
#include <QWindow>
#include <QtTest>

#include "base/file.h"
#include "base/system.h"
#include "gui_support.h"
#include "session/operator_script.h"
#include "shells.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "ui/views/slice_marks.h"
#include "volume/volume_files.h"

using namespace trephine;

namespace {

constexpr int kSkin = -20, kBone = 1200, kBrain = 35;

// A ball of bone around brain in a box of 200 mm.
Volume head() {
  constexpr int kEdge = 128;
  return test::shells(kEdge, 200.0 / kEdge, {{90, kSkin}, {80, kBone}, {70, kBrain}});
}

bool near(const QColor& a, const QColor& b, int by = 40) {
  return std::abs(a.red() - b.red()) <= by && std::abs(a.green() - b.green()) <= by &&
         std::abs(a.blue() - b.blue()) <= by;
}

}  // namespace

class SlicesGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  std::filesystem::path exercise_;

  FourUp& views() { return window_->views(); }
  SliceView& axial() { return views().slice(SliceAxis::axial); }
  SliceView& coronal() { return views().slice(SliceAxis::coronal); }
  SliceView& sagittal() { return views().slice(SliceAxis::sagittal); }

  void open() {
    window_ = newWindow(toPath(temporary_.path()) / "recordings");
    window_->resize(1280, 800);
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openPath(exercise_);
    QVERIFY(opened.wait(kLong_ms));
    QApplication::setActiveWindow(window_.get());
  }

  // The mouse goes through the window, as the system sends it.
  QPoint inWindow(SliceView& view, const QPointF& at) {
    return view.mapTo(window_.get(), at.toPoint());
  }
  QWindow* handle() { return window_->windowHandle(); }
  void hover(SliceView& view, const QPointF& at) {
    QTest::mouseMove(handle(), inWindow(view, at));
    rest();
  }
  void click(SliceView& view, const QPointF& at, Qt::KeyboardModifiers modifiers = {}) {
    QTest::mouseClick(handle(), Qt::LeftButton, modifiers, inWindow(view, at));
    rest();
  }
  void doubleClick(SliceView& view) {
    QTest::mouseDClick(handle(), Qt::LeftButton, {}, inWindow(view, QRectF(view.rect()).center()));
    rest();
  }
  void drag(SliceView& view, const QPointF& from, const QPointF& to,
            Qt::MouseButton button = Qt::LeftButton) {
    QTest::mousePress(handle(), button, {}, inWindow(view, from));
    for (int i = 1; i <= 8; ++i) {
      QTest::mouseMove(handle(), inWindow(view, from + (to - from) * i / 8.0));
      rest();
    }
    QTest::mouseRelease(handle(), button, {}, inWindow(view, to));
    rest();
  }
  void wheel(SliceView& view, int notches, Qt::KeyboardModifiers modifiers = {}) {
    const QPointF at = QRectF(view.rect()).center();
    QWheelEvent event(at, view.mapToGlobal(at), {}, {0, 120 * notches}, Qt::NoButton, modifiers,
                      Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(&view, &event);
    rest();
  }
  void key(QWidget& widget, Qt::Key key) {
    QApplication::setActiveWindow(window_.get());
    widget.setFocus();
    QTest::keyClick(handle(), key);
    rest();
  }

  QColor colourAt(SliceView& view, const QPointF& at) {
    return view.grab().toImage().pixelColor(at.toPoint());
  }
  // What is drawn of a place away from the lines through the common point.
  QColor colourOfPlace(SliceView& view, const Vec3& mm) {
    return colourAt(view, view.fromPatient(mm));
  }
  int greyOf(int hu) { return views().colours().greyOf(std::int16_t(hu)); }
  QString readoutAt(SliceView& view, const Vec3& mm) {
    hover(view, view.fromPatient(mm));
    return view.readout();
  }
  int storedHu(const Vec3& mm) {
    const Volume& volume = views().mirror().volume();
    const Index3 v = *voxelAt(volume.geometry, mm);
    return volume.at(v[0], v[1], v[2]);
  }
  void keepGrab(const char* name) {
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/%1").arg(name)));
  }

 private slots:
  void initTestCase() {
    // Its own settings: what it leaves there is no other test's layout.
    QApplication::setApplicationName("trephine-test-slices");
    QFile::remove(windowSettings().fileName());
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    exercise_ = test::exerciseOn(head(), toPath(temporary_.path()), "head");
    open();
  }
  void cleanupTestCase() {
    window_.reset();
    QFile::remove(windowSettings().fileName());
  }

  void aKeyBringsFourViewsInTrueProportions() {
    key(window_->view(), Qt::Key_F6);
    for (SliceAxis axis : kSliceAxes) {
      SliceView& view = views().slice(axis);
      QVERIFY(view.isVisible());
      // The ball is round, as wide as it is high, and 160 mm of bone across.
      views().setPoint(Vec3(0.0));
      rest();
      const QImage image = view.grab().toImage();
      const QPointF middle = view.fromPatient(Vec3(0.0));
      const auto reach = [&](QPointF step) {
        int n = 20;
        for (QPointF at = middle + step * n; view.rect().contains(at.toPoint()); at += step, ++n) {
          if (qGray(image.pixel(at.toPoint())) > 180) break;
        }
        return n;
      };
      const double diagonal = std::sqrt(0.5);
      const int across = reach({diagonal, diagonal}), down = reach({diagonal, -diagonal});
      QVERIFY(std::abs(across - down) <= 2);
      QVERIFY(std::abs(across / view.pixelsPerMm() - 70.0) < 2.0);
    }
    QVERIFY(window_->view().isVisible());
    keepGrab("slices-four.png");
  }

  void wheelAndKeysGoThroughTheSlices() {
    const Vec3 place(40, 45, 0);
    QCOMPARE(readoutAt(axial(), place), QString("%1 HU \u00b7 Brain and CSF").arg(kBrain));
    const int before = axial().slice();
    QElapsedTimer longest;
    double stall_ms = 0.0;
    for (int n = 0; n < 24; ++n) {
      longest.start();
      wheel(axial(), -1);
      stall_ms = std::max(stall_ms, double(longest.nsecsElapsed()) * 1e-6);
    }
    std::printf("longest turn of the event loop while scrolling: %.0f ms\n", stall_ms);
    QCOMPARE(axial().slice(), before + 24);  // 37.5 mm up
    hover(axial(), axial().fromPatient(place));
    const QString bone = axial().readout();
    QVERIFY2(bone.startsWith(QString("%1 HU").arg(kBone)), qPrintable(bone));
    QVERIFY(std::abs(colourOfPlace(axial(), place).red() - greyOf(kBone)) <= 4);
    key(axial(), Qt::Key_PageUp);
    QCOMPARE(axial().slice(), before + 34);
    key(axial(), Qt::Key_Home);
    QCOMPARE(axial().slice(), 0);
    QVERIFY(colourOfPlace(axial(), place).red() < 5);
    key(axial(), Qt::Key_End);
    QCOMPARE(axial().slice(), axial().slices() - 1);
    auto* slider = find<QSlider>("axialSlider");
    slider->setValue(before);
    QCOMPARE(axial().slice(), before);
  }

  void aKeyAndADragChangeTheWindowOfAllSlices() {
    const Vec3 place(30, 30, 0);
    for (std::size_t i = 0; i < kWindowPresets.size(); ++i) {
      key(axial(), Qt::Key(Qt::Key_1 + int(i)));
      QCOMPARE(views().colours().window().width_hu, kWindowPresets[i].window.width_hu);
      QCOMPARE(find<QComboBox>("sliceWindow")->currentIndex(), int(i));
      QVERIFY(std::abs(colourOfPlace(axial(), place).red() - greyOf(storedHu(place))) <= 3);
    }
    key(axial(), Qt::Key_3);
    const int grey = colourOfPlace(coronal(), Vec3(30, 0, 30)).red();
    drag(axial(), axial().fromPatient(place), axial().fromPatient(place) + QPointF(0, -60));
    const int brighter = colourOfPlace(coronal(), Vec3(30, 0, 30)).red();
    QVERIFY(brighter > grey + 25);
    QCOMPARE(find<QComboBox>("sliceWindow")->currentIndex(), -1);
    key(axial(), Qt::Key_2);
  }

  void theSlicesZoomAndShift() {
    const double scale = axial().pixelsPerMm();
    wheel(axial(), 5, Qt::ControlModifier);
    QVERIFY(axial().pixelsPerMm() > 1.5 * scale);
    const QPointF centre = QRectF(axial().rect()).center();
    const QPointF before = axial().fromPatient(Vec3(0.0));
    drag(axial(), centre, centre + QPointF(-40, 30), Qt::MiddleButton);
    QVERIFY((axial().fromPatient(Vec3(0.0)) - before - QPointF(-40, 30)).manhattanLength() < 2.0);
    // Bone where its place is now.
    const Vec3 bone(75.0 * std::sqrt(0.5), 75.0 * std::sqrt(0.5), 0.0);
    if (axial().rect().contains(axial().fromPatient(bone).toPoint())) {
      QVERIFY(std::abs(colourOfPlace(axial(), bone).red() - greyOf(kBone)) <= 6);
    }
    key(axial(), Qt::Key_0);
    QVERIFY(std::abs(axial().pixelsPerMm() - scale) < 1e-9);
  }

  void theHuUnderThePointerIsTheStoredOneWithItsTissue() {
    for (SliceAxis axis : kSliceAxes) {
      SliceView& view = views().slice(axis);
      for (int n = 0; n < 12; ++n) {
        const QPointF at(30.0 + n * (view.width() - 60.0) / 12.0, view.height() / 2.0 + 3 * n);
        hover(view, at);
        const Vec3 mm = view.toPatient_mm(at.toPoint());
        if (!voxelAt(views().mirror().volume().geometry, mm)) continue;
        QVERIFY2(view.readout().startsWith(QString("%1 HU").arg(storedHu(mm))),
                 qPrintable(view.readout()));
      }
    }
    // And it is written in the picture.
    hover(axial(), axial().fromPatient(Vec3(0.0)));
    const QRect corner(4, axial().height() - 30, 120, 26);
    const QImage with = axial().grab(corner).toImage();
    hover(coronal(), coronal().fromPatient(Vec3(0.0)));
    QVERIFY(axial().grab(corner).toImage() != with);
  }

  void aPointChosenInOneViewIsShownByTheOthersAndDrawnAsLines() {
    const Vec3 place(31.0, -22.0, views().point_mm().z);
    click(axial(), axial().fromPatient(place), Qt::ShiftModifier);
    QVERIFY(glm::distance(views().point_mm(), place) < 1.0);
    const auto sliceOf = [](SliceView& view, const Vec3& mm) {
      return int(std::lround(toVoxel(view.stack(), mm).z));
    };
    QCOMPARE(coronal().slice(), sliceOf(coronal(), views().point_mm()));
    QCOMPARE(sagittal().slice(), sliceOf(sagittal(), views().point_mm()));
    const QPointF at = axial().fromPatient(views().point_mm());
    const QImage image = axial().grab().toImage();
    const auto lineAt = [&](const QPointF& where, SliceAxis of) {
      for (int off = -1; off <= 1; ++off) {
        const QPoint p = where.toPoint();
        for (const QPoint& q : {p + QPoint(off, 0), p + QPoint(0, off)}) {
          if (near(image.pixelColor(q), colourOf(of), 70)) return true;
        }
      }
      return false;
    };
    QVERIFY(lineAt({at.x(), 40.0}, SliceAxis::sagittal));
    QVERIFY(lineAt({at.x() + 60.0, at.y()}, SliceAxis::coronal));
    // With its own tool, by dragging.
    key(coronal(), Qt::Key_X);
    drag(coronal(), coronal().fromPatient(Vec3(0.0)), coronal().fromPatient(Vec3(-20, 0, 25)));
    const Vec3 shared = views().point_mm();
    QVERIFY(std::hypot(shared.x + 20.0, shared.z - 25.0) < 1.0);
    QCOMPARE(axial().slice(), sliceOf(axial(), shared));
    QCOMPARE(sagittal().slice(), sliceOf(sagittal(), shared));
    key(coronal(), Qt::Key_Escape);
    views().setPoint(Vec3(0.0));
  }

  void aLineIsDraggedToAnotherSliceOfItsView() {
    views().setPoint(Vec3(0.0));
    const HuWindow window = views().colours().window();
    const Vec3 at_line(0, 50, 0);  // on the line of the sagittal view, away from the others
    hover(axial(), axial().fromPatient(at_line) + QPointF(3, 0));
    QCOMPARE(axial().cursor().shape(), Qt::SplitHCursor);
    hover(axial(), axial().fromPatient(at_line) + QPointF(9, 0));
    QCOMPARE(axial().cursor().shape(), Qt::ArrowCursor);
    const auto lineOfSagittal = [&](double x) {
      const QImage image = axial().grab().toImage();
      const QPoint p = axial().fromPatient(Vec3(x, 50, 0)).toPoint();
      for (int off = -1; off <= 1; ++off) {
        if (near(image.pixelColor(p + QPoint(off, 0)), colourOf(SliceAxis::sagittal), 70)) {
          return true;
        }
      }
      return false;
    };
    QVERIFY(lineOfSagittal(0.0) && !lineOfSagittal(75.0));
    // Through the middle brain lies there, 75 mm to the left bone alone.
    const Vec3 place(0, 8, 20);  // beside the other views' lines
    QVERIFY(readoutAt(sagittal(), place).startsWith(QString("%1 HU").arg(kBrain)));
    const int grey = colourOfPlace(sagittal(), place).red();
    drag(axial(), axial().fromPatient(at_line), axial().fromPatient(Vec3(75, 30, 0)));
    QVERIFY(lineOfSagittal(75.0) && !lineOfSagittal(0.0));
    QVERIFY(std::abs(views().point_mm().x - 75.0) < 1.0);
    QCOMPARE(readoutAt(sagittal(), place).section(' ', 0, 0), QString::number(kBone));
    QVERIFY(std::abs(colourOfPlace(sagittal(), place).red() - greyOf(kBone)) <= 4);
    QVERIFY(greyOf(kBone) > grey + 25);
    QCOMPARE(views().point_mm().y, 0.0);
    QCOMPARE(views().colours().window(), window);
    // The keys of the other view do the same.
    views().setPoint(Vec3(0.0));
    for (int n = 0; n < 5; ++n) key(sagittal(), Qt::Key_PageDown);
    QVERIFY(views().point_mm().x > 70.0);
    views().setPoint(Vec3(0.0));
  }

  void aDoubleClickEnlargesAndBringsBack() {
    doubleClick(axial());
    QVERIFY(axial().isVisible() && !coronal().isVisible() && !window_->view().isVisible());
    QVERIFY(axial().width() > views().width() - 40);
    keepGrab("slices-single.png");
    doubleClick(axial());
    QVERIFY(coronal().isVisible() && window_->view().isVisible());
  }

  void aRulerSaysALengthToHalfAVoxelAndAnAngleToHalfADegree() {
    doubleClick(axial());
    key(axial(), Qt::Key_M);
    const double z = axial().stack().toPatient_mm(Vec3(0, 0, axial().slice())).z;
    const Vec3 a(-55, -20, z), b(40, 35, z), c(-30, 60, z);
    drag(axial(), axial().fromPatient(a), axial().fromPatient(b));
    QCOMPARE(axial().measures().size(), std::size_t(1));
    const double voxel_mm = axial().stack().spacing_mm.x;
    QVERIFY(std::abs(length_mm(axial().measures()[0]) - glm::distance(a, b)) <= 0.5 * voxel_mm);
    const auto drawn = [&](const Vec3& at) {
      int found = 0;
      const QImage image = axial().grab().toImage();
      const QPoint p = axial().fromPatient(at).toPoint();
      for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
          found += near(image.pixelColor(p + QPoint(x, y)), colours::kCaution, 60);
        }
      }
      return found > 0;
    };
    QVERIFY(drawn(0.7 * a + 0.3 * b));

    key(axial(), Qt::Key_N);
    for (const Vec3& at : {a, b, c}) click(axial(), axial().fromPatient(at));
    QCOMPARE(axial().measures().size(), std::size_t(2));
    const Vec3 u = glm::normalize(a - b), v = glm::normalize(c - b);
    const double truth = std::acos(glm::dot(u, v)) * 180.0 / M_PI;
    QVERIFY(std::abs(angle_deg(axial().measures()[1]) - truth) <= 0.5);
    QVERIFY(drawn(0.3 * c + 0.7 * b));
    keepGrab("slices-measures.png");
    // They go with the window: each is named first.
    window_->close();
    QTRY_VERIFY(window_->findChild<QMessageBox*>("measuresQuestion"));
    auto* question = window_->findChild<QMessageBox*>("measuresQuestion");
    QVERIFY(question->informativeText().contains("Ruler"));
    QVERIFY(question->informativeText().contains("Angle"));
    QTest::mouseClick(question->findChild<QPushButton*>("saveMeasures"), Qt::LeftButton);
    QTRY_VERIFY(window_->findChild<QFileDialog*>("saveDialog"));
    auto* dialog = window_->findChild<QFileDialog*>("saveDialog");
    dialog->close();
    QTRY_VERIFY(!window_->findChild<QFileDialog*>("saveDialog"));
    QVERIFY2(window_->isVisible(), "nothing was chosen, so all stays");

    key(axial(), Qt::Key_Delete);
    QVERIFY(!drawn(0.3 * c + 0.7 * b));
    key(axial(), Qt::Key_Delete);
    QVERIFY(!drawn(0.7 * a + 0.3 * b));

    // An angle that was begun is gone when one goes on elsewhere.
    for (const Vec3& at : {a, b}) click(axial(), axial().fromPatient(at));
    QVERIFY(drawn(0.7 * a + 0.3 * b));
    axial().clearFocus();
    QVERIFY(!drawn(0.7 * a + 0.3 * b));
    key(axial(), Qt::Key_Escape);
    doubleClick(axial());
  }

  void tissuesAreColouredAsMuchAsTheSliderSays() {
    const Vec3 bone(75.0 * std::sqrt(0.5), 75.0 * std::sqrt(0.5), 0.0);
    const QColor plain = colourOfPlace(axial(), bone);
    QCOMPARE(plain.red(), plain.blue());
    key(axial(), Qt::Key_O);
    QCOMPARE(find<QComboBox>("sliceOverlay")->currentIndex(), 1);
    find<QSlider>("sliceOpacity")->setValue(100);
    const TissueSet& set = views().colours().tissues();
    const Tissue& of = set.tissues[std::size_t(classify(tissueTable(set), kBone))];
    const QColor full = colourOfPlace(axial(), bone);
    QVERIFY(near(full, QColor::fromRgbF(float(of.colour.x), float(of.colour.y), float(of.colour.z)),
                 8));
    keepGrab("slices-tissues.png");
    find<QSlider>("sliceOpacity")->setValue(0);
    QVERIFY(near(colourOfPlace(axial(), bone), plain, 3));
    find<QSlider>("sliceOpacity")->setValue(35);
    key(axial(), Qt::Key_O);  // there are no labels
    QCOMPARE(find<QComboBox>("sliceOverlay")->currentIndex(), 0);
    QVERIFY(near(colourOfPlace(axial(), bone), plain, 3));
  }

  void theColoursFollowTheLooksAndThresholdsOfTheTissuesAtOnce() {
    const Vec3 bone(75.0 * std::sqrt(0.5), 75.0 * std::sqrt(0.5), 0.0);
    const TissueSet set = views().colours().tissues();
    const Tissue& tissue = set.tissues[std::size_t(classify(tissueTable(set), kBone))];
    auto* looks = find<QComboBox>(qPrintable("look:" + toQt(tissue.id)));
    const QColor plain = colourOfPlace(axial(), bone);
    key(axial(), Qt::Key_O);
    find<QSlider>("sliceOpacity")->setValue(100);
    const auto seen = [&](TissueLook look) {
      looks->setCurrentIndex(int(look));
      emit looks->activated(int(look));  // as by a person
      return colourOfPlace(axial(), bone);
    };
    const QColor full =
        QColor::fromRgbF(float(tissue.colour.x), float(tissue.colour.y), float(tissue.colour.z));
    const QColor half((full.red() + plain.red()) / 2, (full.green() + plain.green()) / 2,
                      (full.blue() + plain.blue()) / 2);
    QVERIFY(near(seen(TissueLook::shown), full, 8));
    QVERIFY(near(seen(TissueLook::ghosted), half, 8));
    keepGrab("slices-ghost.png");
    QVERIFY(near(seen(TissueLook::hidden), plain, 3));
    QVERIFY(near(seen(TissueLook::shown), full, 8));
    // A threshold above the bone takes its colour away.
    window_->findChild<TissuePanel*>()->select(tissue.id);
    const auto from = [&](int hu) {
      auto* line = find<QAbstractSpinBox>("huLow")->findChild<QLineEdit*>();
      line->selectAll();
      QTest::keyClicks(line, QString::number(hu));
      QTest::keyClick(line, Qt::Key_Return);
    };
    from(kBone + 100);
    QVERIFY(near(colourOfPlace(axial(), bone), plain, 3));
    from(tissue.hu_min);
    QVERIFY(near(colourOfPlace(axial(), bone), full, 8));
    find<QSlider>("sliceOpacity")->setValue(35);
    key(axial(), Qt::Key_O);
  }

  void anExerciseShowsItsToolsAndItsCutsInTheSlices() {
    const Exercise& exercise = *workstation().exercise();
    window_->startExercise(*readOperatorScript(exercise.operator_file, exercise));
    QTRY_VERIFY_WITH_TIMEOUT(workstation().session(), kLong_ms);
    // The views follow the tool until its mark is seen; from there on nobody touches them.
    constexpr double kLook_s = 0.04, kLongest_s = 60.0;
    bool marked = false, cut = false;
    for (double at_s = 0.0; !(marked && cut) && at_s < kLongest_s; at_s += kLook_s) {
      if (!workstation().session()) break;
      const LoopState& state = workstation().session()->state();
      std::uint64_t removed = 0;
      for (const auto& arm : state.removed) {
        for (std::uint64_t voxels : arm) removed += voxels;
      }
      cut = removed > 40;
      pass(kLook_s);
      if (marked) continue;
      const Vec3 tip = state.record.arms[0].proxy_position_mm;
      if (isFinite(tip)) views().setPoint(tip);
      rest();
      const QImage image = coronal().grab().toImage();
      const QPoint at = coronal().fromPatient(views().point_mm()).toPoint();
      int coloured = 0;
      for (int y = -30; y <= 30; ++y) {
        for (int x = -30; x <= 30; ++x) {
          const QPoint p = at + QPoint(x, y);
          if (!image.valid(p)) continue;
          coloured += near(image.pixelColor(p), colours::ofArm(exercise.arms[0], 0), 30);
        }
      }
      marked = coloured > 15 && removed > 0;
    }
    keepGrab("slices-exercise.png");
    QVERIFY(marked);
    QVERIFY(cut);
    QSignalSpy ended(&workstation(), &Workstation::sessionEnded);
    workstation().stop();
    QVERIFY(ended.wait(kLong_ms));
    QTRY_VERIFY(find<QWidget>("resultPage")->isVisible());
    find<QPushButton>("resultLook")->click();
    rest();

    const Volume& before = *workstation().currentCase()->volume;
    const Volume& now = views().mirror().volume();
    const GridGeometry& g = now.geometry;
    std::size_t removed = 0, place = 0, shown = 0, bright = 0;
    int most_around = -1;  // the place is in the middle of the cut, where nothing of bone shines in
    const auto cutAround = [&](const Index3& at) {
      int around = 0;
      for (int axis = 0; axis < 3; ++axis) {
        for (int step : {-1, 1}) {
          Index3 beside = at;
          beside[std::size_t(axis)] += step;
          if (!g.contains(beside[0], beside[1], beside[2])) continue;
          const std::size_t n = g.indexOf(beside[0], beside[1], beside[2]);
          around += now.hu[n] != before.hu[n];
        }
      }
      return around;
    };
    const QImage image = coronal().grab().toImage();
    for (std::size_t i = 0; i < now.hu.size(); ++i) {
      if (now.hu[i] == before.hu[i]) continue;
      ++removed;
      const Index3 at = g.indicesOf(i);
      if (const int around = cutAround(at); around > most_around) {
        most_around = around;
        place = i;
      }
      const Vec3 mm = g.toPatient_mm(Vec3(at[0], at[1], at[2]));
      if (std::lround(toVoxel(coronal().stack(), mm).z) != coronal().slice()) continue;
      const QPointF off = coronal().fromPatient(mm) - coronal().fromPatient(views().point_mm());
      if (std::abs(off.x()) < 3.0 || std::abs(off.y()) < 3.0) continue;  // the other views' lines
      ++shown;
      bright += qGray(image.pixel(coronal().fromPatient(mm).toPoint())) > 110;
    }
    QVERIFY(removed > 0);
    QVERIFY(shown > 0);
    // Into a voxel at the rim of the cut its neighbours shine.
    QVERIFY2(4 * bright < shown,
             qPrintable(QString("%1 of %2 are bone still").arg(bright).arg(shown)));
    const Index3 v = g.indicesOf(place);
    const Vec3 mm = g.toPatient_mm(Vec3(v[0], v[1], v[2]));
    views().setLayout({ViewLayout::Kind::four, 0});
    restRefined();
    views().setPoint(mm);
    for (SliceAxis axis : kSliceAxes) {
      SliceView& view = views().slice(axis);
      hover(view, view.fromPatient(mm));
      QCOMPARE(view.readout(), QString("-1000 HU"));
      // Magnified, so that a voxel has pixels of its own between the lines.
      for (int n = 0; n < 4; ++n) {
        const QPointF at = view.fromPatient(mm);
        QWheelEvent event(at, view.mapToGlobal(at), {}, {0, 960}, Qt::NoButton, Qt::ControlModifier,
                          Qt::NoScrollPhase, false);
        QCoreApplication::sendEvent(&view, &event);
      }
      rest();
      hover(views().slice(axis == SliceAxis::axial ? SliceAxis::coronal : SliceAxis::axial),
            {5, 5});
      QVERIFY(colourOfPlace(view, mm).red() < 12);
    }
    keepGrab("slices-cut.png");
    for (SliceAxis axis : kSliceAxes) key(views().slice(axis), Qt::Key_0);
  }

  void theLayoutIsRememberedAndNothingElse() {
    window_->show(Place::prepare);
    rest();
    key(coronal(), Qt::Key_F6);
    key(coronal(), Qt::Key_F7);
    QVERIFY(coronal().width() > 2 * axial().width());
    keepGrab("slices-one-large.png");
    QFile file(windowSettings().fileName());
    QVERIFY(file.open(QIODevice::ReadOnly));
    const QString kept = QString::fromUtf8(file.readAll()).trimmed();
    QVERIFY2(kept.contains("prepare\\large=coronal") && kept.contains("prepare\\layout=oneLarge"),
             qPrintable(kept));
    for (const QString& line : kept.split('\n')) {  // layouts and columns alone
      QVERIFY2(line.startsWith('[') || line.isEmpty() || line.startsWith("prepare\\") ||
                   line.startsWith("train\\") || line.startsWith("columns\\"),
               qPrintable(line));
    }
    window_.reset();
    open();
    QTRY_VERIFY_WITH_TIMEOUT(coronal().isVisible(), kLong_ms);
    QTRY_VERIFY(coronal().width() > 2 * axial().width());
    key(coronal(), Qt::Key_F8);
    QVERIFY(coronal().isVisible() && !window_->view().isVisible());
    // Even so an exercise starts, and one key brings the large 3-D view.
    for (int n = 0; n < 2; ++n) QTest::keyClick(handle(), Qt::Key_F8);
    QTRY_VERIFY(window_->view().isVisible() && !coronal().isVisible());
  }
};

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  return test::runInWindow<SlicesGuiTest>(argc, argv);
}

#include "slices_gui_test.moc"
