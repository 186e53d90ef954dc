// In the slices of the real window: where an exercise enters, the box and the wall that growing
// keeps to, and the card of a segmentation from elsewhere. On the built-in abdomen.
#include <QApplication>
#include <QFile>
#include <QLabel>
#include <QMessageBox>
#include <QPushButton>
#include <QToolButton>
#include <QTreeWidget>
#include <QWindow>
#include <QtTest>

#include "gui_support.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "volume/segmentation.h"

using namespace trephine;

namespace {
const Vec3 kInLiver_mm(-60, -20, 20);
}  // namespace

class EntryGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  FourUp& views() { return window_->views(); }
  SliceView& axial() { return views().slice(SliceAxis::axial); }
  QWindow* handle() { return window_->windowHandle(); }
  QPoint inWindow(const Vec3& mm) {
    return axial().mapTo(window_.get(), axial().fromPatient(mm).toPoint());
  }
  void key(Qt::Key of) {
    QApplication::setActiveWindow(window_.get());
    axial().setFocus();
    QTest::keyClick(handle(), of);
  }
  void drag(const Vec3& from, const Vec3& to) {
    dragInWindow(inWindow(from), inWindow(to), Qt::LeftButton);
    rest();
  }
  void click(const Vec3& at) { QTest::mouseClick(handle(), Qt::LeftButton, {}, inWindow(at)); }
  void untilPlaced() { QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms); }
  LandmarkFrame entry() { return workstation().viewLandmark().value_or(LandmarkFrame{}); }
  Vec3 outward() { return entry().rotation * Vec3(0, 0, 1); }
  // Of the body, in front of a place: where the skin begins.
  Vec3 skinBefore(Vec3 at) {
    while (sampleHu(*workstation().currentCase()->volume, at) > -300.0) at.y -= 0.5;
    return at;
  }
  void keepGrab(const char* name) {
    restRefined();
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/%1").arg(name)));
  }

 private slots:
  void initTestCase() {
    openWindow("trephine-test-entry");
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openPhantom("abdomen");
    QVERIFY(opened.wait(kLong_ms));
    views().setLayout({ViewLayout::Kind::one_large, 1});
    views().setPoint(kInLiver_mm);
    rest();
  }
  void cleanupTestCase() { closeWindow(); }

  void aClickOnTheSkinIsWhereTheExerciseEnters() {
    const Vec3 before = entry().position_mm;
    key(Qt::Key_I);
    QVERIFY(inHand("sliceEntryTool"));
    const Vec3 skin = skinBefore(kInLiver_mm);
    click(skin);
    untilPlaced();
    QTRY_VERIFY(glm::length(entry().position_mm - skin) < 1.5);
    QVERIFY(glm::length(before - skin) > 5.0);
    QVERIFY2(outward().y < -0.7, "out of the patient's front");
    keepGrab("entry-skin.png");
    // It would go with the window, and with another patient.
    window_->close();
    QTRY_VERIFY(window_->findChild<QMessageBox*>("unsavedTissues"));
    window_->findChild<QMessageBox*>("unsavedTissues")->reject();
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("unsavedTissues"));
    QVERIFY(window_->isVisible());
  }

  void aDragSaysWhereTheInstrumentComesFrom() {
    const Vec3 at = skinBefore(kInLiver_mm);
    drag(at, at + Vec3(-30, -30, 0));
    untilPlaced();
    QTRY_VERIFY(glm::length(outward() - glm::normalize(Vec3(-1, -1, 0))) < 0.1);
    const Vec3 place = entry().position_mm;
    // It stays where structures change.
    QVERIFY(workstation().useStructures(
        std::make_shared<const LabelMap>(*workstation().currentCase()->structures)));
    untilPlaced();
    QVERIFY(glm::length(entry().position_mm - place) < 1e-9);
  }

  void anExerciseStartsThereAndHoldsItThere() {
    const Vec3 place = entry().position_mm;
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    window_->findChild<QAction*>("start")->trigger();
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
    const ExerciseArm& right = workstation().session()->exercise().arms.back();
    QVERIFY(right.map.fixed);
    QVERIFY(glm::length(right.map.fixed->centre_mm - place) < 30.0);
    take("sliceEntryTool");
    click(kInLiver_mm);
    rest();
    untilPlaced();  // what it would have done by now
    QVERIFY(glm::length(entry().position_mm - place) < 1e-9);
    workstation().stop();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    window_->show(Place::prepare);
  }

  void aClickOnWhatIsSeenIn3DPlacesItThere() {
    views().setLayout({ViewLayout::Kind::single, 0});
    restRefined();
    take("sliceWindowTool");
    QApplication::setActiveWindow(window_.get());
    window_->view().setFocus();
    QTest::keyClick(handle(), Qt::Key_I);
    QVERIFY2(inHand("sliceEntryTool"), "a letter means the same in every view");
    const QPointF middle = QRectF(window_->view().rect()).center();
    // A drag turns the view, whatever is in hand that works by clicks.
    const QPoint from = window_->view().mapTo(window_.get(), middle.toPoint());
    const Vec3 before = entry().position_mm, forward = window_->view().rayAt(middle)->direction;
    dragInWindow(from, from + QPoint(60, 0), Qt::LeftButton);
    restRefined();
    QVERIFY(entry().position_mm == before);
    QVERIFY(glm::distance(window_->view().rayAt(middle)->direction, forward) > 0.05);
    const auto seen = window_->view().pickAt(middle);
    QVERIFY(seen);
    QTest::mouseClick(handle(), Qt::LeftButton, {},
                      window_->view().mapTo(window_.get(), middle.toPoint()));
    untilPlaced();
    QTRY_VERIFY(glm::length(entry().position_mm - seen->at_mm) < 3.0);
    views().setLayout({ViewLayout::Kind::one_large, 1});
    rest();
  }

  void delGoesBackToTheExercisesOwnPlace() {
    QVERIFY(workstation().entry());
    key(Qt::Key_I);
    key(Qt::Key_Delete);
    untilPlaced();
    QVERIFY(!workstation().entry());
    key(Qt::Key_Escape);
    QVERIFY(inHand("sliceWindowTool"));
  }

  void aDragOfTheGrowToolDrawsABoxAndAButtonTakesItAway() {
    key(Qt::Key_G);
    drag(kInLiver_mm + Vec3(-25, -25, 0), kInLiver_mm + Vec3(25, 25, 0));
    auto* line = find<QLabel>("growBox");
    QTRY_VERIFY(line->isVisible());
    QVERIFY2(line->text().contains("mm"), qPrintable(line->text()));
    keepGrab("grow-box.png");
    QTest::mouseClick(find<QPushButton>("noGrowBox"), Qt::LeftButton);
    QTRY_VERIFY(!line->isVisible());
    key(Qt::Key_Escape);
  }

  void theWallIsPaintedByItsKey() {
    key(Qt::Key_L);
    QVERIFY(find<QToolButton>("structureWall")->isChecked());
    drag(kInLiver_mm + Vec3(0, -80, 0), kInLiver_mm + Vec3(30, -80, 0));
    auto* list = find<QTreeWidget>("structureList");
    QCOMPARE(list->findItems("wall", Qt::MatchExactly).size(), 1);
    untilStructuresAreTaken();
    untilPlaced();
    QVERIFY(!workstation().currentCase()->structures->find("wall"));
    key(Qt::Key_Escape);
  }

  void aFileOfStructuresShowsItsCardWithPictures() {
    LabelMap map = *workstation().currentCase()->structures;
    const auto file = toPath(temporary_.filePath("mine.nii.gz"));
    QVERIFY(writeSegmentation(map, file).ok());
    QSignalSpy changed(&workstation(), &Workstation::structuresChanged);
    workstation().useLabels(file);
    QVERIFY(changed.wait(kLong_ms));
    auto* card = window_->findChild<QDialog*>("structureReport");
    QVERIFY(card && card->isVisible());
    auto* rows = card->findChild<QTreeWidget*>("structureReportList");
    QCOMPARE(rows->topLevelItemCount(), int(map.structures.size()));
    const auto middle = [&] {
      const QImage image = rows->topLevelItem(0)->icon(0).pixmap(112, 112).toImage();
      return image.pixelColor(image.width() / 2, image.height() / 2).alpha();
    };
    QTRY_VERIFY_WITH_TIMEOUT(middle() == 255, 20000);
    rest();
    QVERIFY(card->grab().save(TREPHINE_ARTEFACTS "/structure-card.png"));
    card->close();
  }
};

int main(int argc, char** argv) {
  return test::runInWindow<EntryGuiTest>(argc, argv);
}

#include "entry_gui_test.moc"
