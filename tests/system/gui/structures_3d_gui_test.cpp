// Structures in the 3-D view of the real window: each in its colour, shown, ghosted and hidden; the
// tools at what is seen under the pointer. On the built-in abdomen without its labels; the steps
// build on each other, in order.
#include <QDir>
#include <QElapsedTimer>
#include <QPushButton>
#include <QSlider>
#include <QTabWidget>
#include <QToolButton>
#include <QTreeWidget>
#include <QWindow>

#include "gui_support.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "ui/views/view_strip.h"

using namespace trephine;

namespace {
const Vec3 kInLiver_mm(-60, -20, 20);
}  // namespace

class Structures3dGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  FourUp& views() { return window_->views(); }
  ViewWidget& view() { return window_->view(); }
  QWindow* handle() { return window_->windowHandle(); }
  QTreeWidget* list() { return find<QTreeWidget>("structureList"); }
  QTreeWidgetItem* row(const QString& name) {
    for (int i = 0; i < list()->topLevelItemCount(); ++i) {
      if (list()->topLevelItem(i)->text(0) == name) return list()->topLevelItem(i);
    }
    return nullptr;
  }
  double ml(const QString& name) { return row(name) ? row(name)->text(1).toDouble() : -1.0; }
  QString look(const QString& name) { return row(name) ? row(name)->text(2) : QString(); }
  QPoint inWindow(const QPointF& in_view) { return view().mapTo(window_.get(), in_view.toPoint()); }
  // Where a place of the patient is in the 3-D view.
  QPointF inView(const Vec3& mm) {
    const auto pixel = view().camera().pixelOf(mm, view().width(), view().height());
    return {pixel->x, view().height() - pixel->y};
  }
  void key(Qt::Key of) {
    QApplication::setActiveWindow(window_.get());
    view().setFocus();
    QTest::keyClick(handle(), of);
  }
  void drag(const QPointF& from, const QPointF& to, Qt::MouseButton button = Qt::LeftButton) {
    dragInWindow(inWindow(from), inWindow(to), button);
  }
  void settle() { QTRY_VERIFY_WITH_TIMEOUT(view().isComplete(), kLong_ms); }
  // Once the structures are placed and nothing moves any more.
  void wholePicture() {
    untilStructuresAreTaken();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    settle();
  }
  QColor seenAt(const QPointF& in_view) {
    const QPoint at = in_view.toPoint();
    return view().rect().contains(at) ? view().grabFramebuffer().pixelColor(at) : QColor();
  }
  void keepGrab(const char* name) {
    wholePicture();
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/%1").arg(name)));
  }

 private slots:
  void initTestCase() {
    const auto file = toPath(temporary_.filePath("abdomen.mha"));
    const auto abdomen = openPhantom("abdomen");
    QVERIFY(abdomen.ok() && writeVolume(abdomen->volume, file).ok());
    openWindow("trephine-test-structures-3d");
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openPath(file);
    auto* import = find<QPushButton>("import");
    QTRY_VERIFY_WITH_TIMEOUT(import->isEnabled(), kLong_ms);
    import->click();
    QTRY_VERIFY_WITH_TIMEOUT(opened.count() == 1, kLong_ms);
    showStructures();
    views().setLayout({ViewLayout::Kind::four, 0});
    wholePicture();
  }
  void cleanupTestCase() { closeWindow(); }

  // At the liver's surface, through the ghost of the ribs.
  void aClickInThePictureGrowsTheLiver() {
    QVERIFY(!workstation().currentCase()->structures);
    take("structureGrow");
    QCOMPARE(view().cursor().shape(), Qt::CrossCursor);
    const QPointF on_it = inView(kInLiver_mm + Vec3(-30, 0, -20));  // its near edge, seen from A
    const auto picked = view().pickAt(on_it);
    QVERIFY(picked);
    std::printf("picked %.1f %.1f %.1f, inside %.1f %.1f %.1f\n", picked->at_mm.x, picked->at_mm.y,
                picked->at_mm.z, picked->inside_mm.x, picked->inside_mm.y, picked->inside_mm.z);
    keepGrab("structures-3d-before.png");
    QTest::mouseClick(handle(), Qt::LeftButton, {}, inWindow(on_it));
    QTRY_VERIFY_WITH_TIMEOUT(find<QPushButton>("takePreview")->isVisible(), kLong_ms);
    std::printf("grown from a click in 3-D: %.0f mL\n", ml("liver"));
    QVERIFY2(ml("liver") > 800.0 && ml("liver") < 2500.0, qPrintable(QString::number(ml("liver"))));
    keepGrab("structures-3d-preview.png");
    key(Qt::Key_Return);  // as in a slice
    QTRY_VERIFY(!find<QPushButton>("takePreview")->isVisible());
    // It has the colour of the exercise's liver, not one of labels.
    const Structure* liver = nullptr;
    QTRY_VERIFY_WITH_TIMEOUT(workstation().currentCase()->structures, kLong_ms);
    liver = workstation().currentCase()->structures->find("liver");
    QCOMPARE(liver->colour.x, workstation().exercise()->tissues.find("liver")->colour.x);
  }

  // The skin hides the liver, shows it as a ghost, and is gone.
  void aStructureThatNoTissueIsOfIsSeenShownGhostedAndHidden() {
    take("sliceWindowTool");
    list()->setCurrentItem(row("liver"));
    wholePicture();
    const QPointF at = inView(kInLiver_mm);
    const QColor liver = seenAt(at);
    QVERIFY2(liver.red() > liver.blue() + 30, qPrintable(liver.name()));
    QTest::mouseClick(find<QToolButton>("structureSkin"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(row("skin"), kLong_ms);
    QTRY_COMPARE_WITH_TIMEOUT(look("skin"), QString("shown"), kLong_ms);
    wholePicture();
    const QColor shown = seenAt(at);
    QVERIFY2(shown.green() > liver.green() + 30, qPrintable(liver.name() + " " + shown.name()));
    keepGrab("structures-3d-skin.png");
    key(Qt::Key_V);
    QTRY_COMPARE(look("skin"), QString("ghost"));
    wholePicture();
    const QColor ghost = seenAt(at);
    QVERIFY2(ghost.green() < shown.green() - 20, qPrintable(ghost.name() + " " + shown.name()));
    keepGrab("structures-3d-skin-ghost.png");
    key(Qt::Key_V);
    QTRY_COMPARE(look("skin"), QString("hidden"));
    wholePicture();
    QCOMPARE(seenAt(at), liver);
    QVERIFY(!workstation().tissuesEdited());
    for (const Tissue& tissue : workstation().exercise()->tissues.tissues) {
      QVERIFY2(!tissue.id.starts_with("structure:"), tissue.id.c_str());
    }
    list()->setCurrentItem(row("liver"));
  }

  void theLiverIsErasedWhereTheStrokeGoesInThePictureAndSeenAtOnce() {
    wholePicture();
    const double before = ml("liver");
    take("structureEraser");
    const QPointF at = inView(kInLiver_mm);
    const Vec3 eye = view().camera().eye(), focus = view().camera().focus();
    const QImage was = view().grabFramebuffer();
    drag(at, at + QPointF(25, 0));
    QElapsedTimer clock;
    clock.start();
    QVERIFY(QTest::qWaitFor([&] { return view().grabFramebuffer() != was; }, 5000));
    const qint64 ms = clock.elapsed();
    std::printf("seen %lld ms after the stroke: %.1f mL less\n", static_cast<long long>(ms),
                before - ml("liver"));
    QVERIFY(ms < 500);
    QVERIFY2(ml("liver") < before - 0.5, qPrintable(QString::number(ml("liver"))));
    QCOMPARE(view().camera().eye().x, eye.x);
    QCOMPARE(view().camera().focus().x, focus.x);
    keepGrab("structures-3d-erased.png");
    // Brushed back from the same places.
    window_->findChild<QAction*>("undo")->trigger();
    QCOMPARE(ml("liver"), before);
    take("structureBrush");
    drag(at, at + QPointF(25, 0));
    QVERIFY2(ml("liver") > before, "the brush adds what is free around the surface");
    window_->findChild<QAction*>("undo")->trigger();
  }

  void theRightButtonTurnsTheCameraWithAToolInHand() {
    take("structureEraser");
    const double before = ml("liver");
    const Vec3 eye = view().camera().eye();
    drag(inView(kInLiver_mm), inView(kInLiver_mm) + QPointF(40, 10), Qt::RightButton);
    QVERIFY(glm::distance(view().camera().eye(), eye) > 1.0);
    QCOMPARE(ml("liver"), before);
  }

  void aBrushIsARingAsWideAsItPaintsThere() {
    take("structureBrush");
    const QPointF at = inView(kInLiver_mm);
    QTest::mouseMove(handle(), inWindow(at));
    QTRY_COMPARE(view().cursor().shape(), Qt::BitmapCursor);
    const auto radius = [&] {
      const QPixmap ring = view().cursor().pixmap();
      return (ring.width() / ring.devicePixelRatio() - 5.0) / 2.0;
    };
    const Vec3 seen = view().pickAt(at)->at_mm;
    const Vec3 forward = view().camera().focus() - view().camera().eye();
    const Vec3 beside = glm::normalize(glm::cross(forward, Vec3(0.0, 0.0, 1.0)));
    const QPointF to = inView(seen + 6.0 * beside) - inView(seen);  // as its field begins
    const double before = radius();
    QVERIFY2(std::abs(before - std::hypot(to.x(), to.y())) < 1.5,
             qPrintable(QString::number(before)));
    key(Qt::Key_BracketRight);
    QTRY_VERIFY(radius() > before);
    key(Qt::Key_BracketLeft);
    QTRY_COMPARE(radius(), before);
    QTest::mouseMove(handle(), inWindow(QPointF(20, 200)));  // air
    QTRY_COMPARE(view().cursor().shape(), Qt::CrossCursor);
  }

  void escLeavesTheTool() {
    take("structureBrush");
    QVERIFY(view().cursor().shape() != Qt::ArrowCursor);
    key(Qt::Key_Escape);
    QVERIFY(inHand("sliceWindowTool"));
    QCOMPARE(view().cursor().shape(), Qt::ArrowCursor);
    const Vec3 eye = view().camera().eye();
    drag(inView(kInLiver_mm), inView(kInLiver_mm) + QPointF(-40, -10));
    QVERIFY(glm::distance(view().camera().eye(), eye) > 1.0);
  }

  void theKeyVShowsGhostsAndHidesTheChosenOne() {
    list()->setCurrentItem(row("liver"));
    wholePicture();
    const QImage shown = view().grabFramebuffer();
    key(Qt::Key_V);
    QTRY_COMPARE(look("liver"), QString("ghost"));
    // One mechanism: the exercise's tissue of it has that look, in its own panel too.
    QCOMPARE(workstation().looks().at("liver"), TissueLook::ghosted);
    wholePicture();
    const QImage ghost = view().grabFramebuffer();
    QVERIFY(ghost != shown);
    key(Qt::Key_V);
    QTRY_COMPARE(look("liver"), QString("hidden"));
    wholePicture();
    QVERIFY(view().grabFramebuffer() != ghost);
    key(Qt::Key_V);
    QTRY_COMPARE(look("liver"), QString("shown"));
    wholePicture();
    QVERIFY(view().grabFramebuffer() == shown);
    QVERIFY(!workstation().tissuesEdited());
  }

  void theOpacityOfTheChosenOneIsOfTheViewAlone() {
    wholePicture();
    const QImage shown = view().grabFramebuffer();
    const double own = workstation().exercise()->tissues.find("liver")->opacity;
    auto* opacity = find<QSlider>("structureOpacity");
    opacity->setFocus();
    for (int n = 0; n < 8; ++n) QTest::keyClick(opacity, Qt::Key_PageDown);
    wholePicture();
    QVERIFY(view().grabFramebuffer() != shown);
    QCOMPARE(workstation().exercise()->tissues.find("liver")->opacity, own);
    QVERIFY(!workstation().tissuesEdited());
    keepGrab("structures-3d-opacity.png");
  }

  void theExerciseRunsOnItsOwnTissues() {
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    window_->startExercise();
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
    QVERIFY(views().mirror().labels() == workstation().placed()->labels);
    for (const Tissue& tissue : workstation().session()->exercise().tissues.tissues) {
      QVERIFY2(!tissue.id.starts_with("structure:"), tissue.id.c_str());
    }
    // A hand's, not a tool's.
    const double before = ml("liver");
    take("structureEraser");
    drag(inView(kInLiver_mm), inView(kInLiver_mm) + QPointF(20, 0));
    QCOMPARE(ml("liver"), before);
    workstation().stop();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    take("sliceWindowTool");
  }
};

int main(int argc, char** argv) {
  return test::runInWindow<Structures3dGuiTest>(argc, argv);
}

#include "structures_3d_gui_test.moc"
