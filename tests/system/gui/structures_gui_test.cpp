// Structures in the real window, by mouse and keys, as a clinician makes them: open a CT, grow the
// liver, mend it by two strokes, start the exercise on it, cut, save it. On the real abdomen where
// it is, else on the built-in one without its labels. The steps build on each other, in order.
#include <QApplication>
#include <QComboBox>
#include <QDir>
#include <QElapsedTimer>
#include <QFile>
#include <QFileDialog>
#include <QMessageBox>
#include <QPushButton>
#include <QRadioButton>
#include <QTabWidget>
#include <QToolButton>
#include <QTreeWidget>
#include <QWindow>
#include <QtTest>

#include "gui_support.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "volume/segmentation.h"

using namespace trephine;

class StructuresGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  std::filesystem::path file_;
  Vec3 in_liver_mm_{-60, -20, 20};
  int clicks_ = 0;  // and strokes and keys, of the clinician's path
  qint64 computing_ms_ = 0;

  FourUp& views() { return window_->views(); }
  SliceView& axial() { return views().slice(SliceAxis::axial); }
  QWindow* handle() { return window_->windowHandle(); }
  QPoint inWindow(const Vec3& mm) {
    return axial().mapTo(window_.get(), axial().fromPatient(mm).toPoint());
  }
  void clickAt(const Vec3& mm) {
    QTest::mouseClick(handle(), Qt::LeftButton, {}, inWindow(mm));
    ++clicks_;
  }
  void drag(const Vec3& from, const Vec3& to) {
    dragInWindow(inWindow(from), inWindow(to), Qt::LeftButton);
    rest();
    ++clicks_;
  }
  void key(Qt::Key of) {
    QApplication::setActiveWindow(window_.get());
    axial().setFocus();
    QTest::keyClick(handle(), of);
    ++clicks_;
  }
  void press(const char* name) {
    auto* button = find<QAbstractButton>(name);
    QVERIFY2(button->isEnabled() && button->isVisible(), name);
    QTest::mouseClick(button, Qt::LeftButton);
    ++clicks_;
  }
  QTreeWidget* list() { return find<QTreeWidget>("structureList"); }
  double ml(const char* name) {
    for (int i = 0; i < list()->topLevelItemCount(); ++i) {
      if (list()->topLevelItem(i)->text(0) == name)
        return list()->topLevelItem(i)->text(1).toDouble();
    }
    return -1.0;
  }
  void keepGrab(const char* name) {
    restRefined();
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/%1").arg(name)));
  }
  QString said() { return find<QLabel>("structureSaid")->text(); }

 private slots:
  void initTestCase() {
    if (const char* data = std::getenv("TREPHINE_TEST_DATA")) {
      file_ = toPath(temporary_.filePath("ct.nii.gz"));
      std::filesystem::copy_file(
          std::filesystem::path(data) / "abdomen-ct-totalsegmentator" / "example_ct.nii.gz", file_);
      in_liver_mm_ = {-92, -161, 406};
    } else {
      file_ = toPath(temporary_.filePath("abdomen.mha"));
      const auto abdomen = openPhantom("abdomen");
      QVERIFY(abdomen.ok() && writeVolume(abdomen->volume, file_).ok());
    }
    openWindow("trephine-test-structures");
  }
  void cleanupTestCase() { closeWindow(); }

  void anAbdomenOpensUnderAnExerciseForAbdomens() {
    QElapsedTimer clock;
    clock.start();
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openPath(file_);  // 1: the folder's dialog
    ++clicks_;
    auto* import = find<QPushButton>("import");
    QTRY_VERIFY_WITH_TIMEOUT(import->isEnabled(), kLong_ms);
    press("import");
    QTRY_VERIFY_WITH_TIMEOUT(opened.count() == 1 || find<QPushButton>("openCase")->isVisible(),
                             kLong_ms);
    if (opened.isEmpty()) {
      for (QRadioButton* keep : window_->findChildren<QRadioButton*>()) {
        if (keep->objectName().endsWith("_keep") && keep->isVisible()) {
          keep->click();
          ++clicks_;
        }
      }
      press("openCase");
      QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    }
    computing_ms_ += clock.elapsed();
    QCOMPARE(QString::fromStdString(workstation().exercise()->anatomy), QString("abdomen"));
    const QString about = find<QLabel>("caseLabel")->text();
    QVERIFY2(about.contains("abdomen"), qPrintable(about));
    QVERIFY(!workstation().currentCase()->structures);
    // The liver that the exercise needs is offered to be made.
    QVERIFY2(said().contains("liver"), qPrintable(said()));
    QVERIFY(inHand("structureGrow"));
    take("sliceWindowTool");
  }

  void anExerciseThatNeedsALiverAsksAndLeadsToMakingIt() {
    window_->findChild<QAction*>("start")->trigger();
    auto* question = window_->findChild<QMessageBox*>("fitQuestion");
    QVERIFY(question);
    QVERIFY2(question->text().contains("liver"), qPrintable(question->text()));
    QVERIFY(workstation().phase() == Workstation::Phase::ready);
    auto* make = question->findChild<QPushButton*>("makeStructure");
    QVERIFY(make);
    QTest::mouseClick(make, Qt::LeftButton);
    QTRY_VERIFY(inHand("structureGrow"));
    QVERIFY(list()->topLevelItemCount() == 0);
    QCOMPARE(find<QComboBox>("structureName")->currentText(), QString("liver"));
    QVERIFY(views().viewLayout().kind == ViewLayout::Kind::four);
  }

  void aClickGrowsTheLiverAndShowsItBeforeItCounts() {
    views().setPoint(in_liver_mm_);
    rest();
    QElapsedTimer clock;
    clock.start();
    clickAt(in_liver_mm_);
    QTRY_VERIFY_WITH_TIMEOUT(find<QPushButton>("takePreview")->isVisible(), kLong_ms);
    computing_ms_ += clock.elapsed();
    QVERIFY2(ml("liver") > 800.0 && ml("liver") < 2500.0, qPrintable(QString::number(ml("liver"))));
    QVERIFY(!workstation().currentCase()->structures);
    keepGrab("structures-preview.png");
    key(Qt::Key_Escape);  // no: it goes again
    --clicks_;
    QTRY_VERIFY(!find<QPushButton>("takePreview")->isVisible());
    QCOMPARE(list()->topLevelItemCount(), 0);
    take("structureGrow");
    clickAt(in_liver_mm_);
    --clicks_;
    QTRY_VERIFY_WITH_TIMEOUT(find<QPushButton>("takePreview")->isVisible(), kLong_ms);
    key(Qt::Key_Return);
    --clicks_;  // a first stroke takes it as well
    QTRY_VERIFY(!find<QPushButton>("takePreview")->isVisible());
    QVERIFY(ml("liver") > 800.0);
    QTRY_VERIFY_WITH_TIMEOUT(workstation().currentCase()->structures, kLong_ms);
  }

  void twoStrokesMendItAndEachCanBeUndone() {
    const double before = ml("liver");
    key(Qt::Key_E);
    QVERIFY(inHand("structureEraser"));
    drag(in_liver_mm_, in_liver_mm_ + Vec3(20, 0, 0));
    const double erased = ml("liver");
    QVERIFY(erased < before - 0.5);
    key(Qt::Key_B);
    --clicks_;  // to see that it comes back; a person erases twice
    drag(in_liver_mm_, in_liver_mm_ + Vec3(20, 0, 0));
    QVERIFY(std::abs(ml("liver") - before) < 0.3 * (before - erased) + 1.0);
    auto* undo = window_->findChild<QAction*>("undo");
    QVERIFY(undo->isEnabled());
    undo->trigger();
    QCOMPARE(ml("liver"), erased);
    undo->trigger();
    QCOMPARE(ml("liver"), before);
    window_->findChild<QAction*>("redo")->trigger();
    QCOMPARE(ml("liver"), erased);
    window_->findChild<QAction*>("redo")->trigger();
    keepGrab("structures-mended.png");
  }

  // A click that gave it the keys would paint.
  void aSliceHasTheKeysOnceThePointerIsOverIt() {
    QApplication::setActiveWindow(window_.get());
    QTest::mouseMove(handle(), QPoint(5, 5));
    find<QToolButton>("structureUndo")->setFocus();
    QTest::mouseMove(handle(), inWindow(in_liver_mm_));
    QTRY_VERIFY(axial().hasFocus());
    // Not from one who types.
    QTest::mouseMove(handle(), QPoint(5, 5));
    find<QComboBox>("structureName")->setFocus();
    QTest::mouseMove(handle(), inWindow(in_liver_mm_));
    rest();
    QVERIFY(!axial().hasFocus());
  }

  // Where the brush was the slice changes at once.
  void aStrokeIsSeenAtOnce() {
    take("structureEraser");
    const QPoint at = axial().fromPatient(in_liver_mm_ + Vec3(5, 25, 0)).toPoint();
    QTest::mouseMove(handle(), axial().mapTo(window_.get(), at + QPoint(60, 0)));
    rest();
    const QColor before = axial().grab().toImage().pixelColor(at);
    QElapsedTimer clock;
    clock.start();
    const int drawn = axial().drawn();
    QTest::mousePress(handle(), Qt::LeftButton, {}, axial().mapTo(window_.get(), at));
    QVERIFY(QTest::qWaitFor([&] { return axial().drawn() != drawn; }, 5000));
    const qint64 ms = clock.elapsed();
    QTest::mouseRelease(handle(), Qt::LeftButton, {}, axial().mapTo(window_.get(), at));
    QTest::mouseMove(handle(), axial().mapTo(window_.get(), at + QPoint(60, 0)));
    rest();
    const QColor after = axial().grab().toImage().pixelColor(at);
    std::printf("a stroke's first voxels and the slice with them: %lld ms\n",
                static_cast<long long>(ms));
    QVERIFY2(before != after, qPrintable(before.name() + " " + after.name()));
    window_->findChild<QAction*>("undo")->trigger();
  }

  void theExerciseStartsOnItWithItsCapsule() {
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    QElapsedTimer clock;
    clock.start();
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    window_->findChild<QAction*>("start")->trigger();
    ++clicks_;
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
    computing_ms_ += clock.elapsed();
    QVERIFY(!window_->findChild<QMessageBox*>("fitQuestion"));
    const Placement& of = *workstation().placed();
    QVERIFY(of.warnings.empty());
    QVERIFY(of.labels->find("capsule"));
    QVERIFY(!of.patient.structures->find("capsule"));
    QCOMPARE(int(*of.exercise.tissues.find("liver")->label), of.labels->find("liver")->label);
  }

  // A wheel into the liver and one stroke.
  void aStrokeOfTheHandCutsTheLiver() {
    Session& session = *workstation().session();
    views().setLayout({ViewLayout::Kind::single, 0});
    cut({60, 0});
    ++clicks_;
    QVERIFY(removedVoxels(session) > 0);
    keepGrab("structures-cut.png");
    views().setLayout({ViewLayout::Kind::four, 0});
  }

  void whileItRunsStructuresStayAndSayWhy() {
    const double before = ml("liver");
    showStructures();
    views().setLayout({ViewLayout::Kind::four, 0});
    rest();
    take("structureBrush");
    drag(in_liver_mm_, in_liver_mm_ + Vec3(10, 0, 0));
    --clicks_;
    QCOMPARE(ml("liver"), before);
    QVERIFY2(said().contains("exercise runs"), qPrintable(said()));
    pass(0.5);
    workstation().stop();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    QTRY_VERIFY2(said().contains("liver") && said().contains("mL"), qPrintable(said()));
    // Undo is of the cuts no more, and takes no structure instead.
    QVERIFY(!window_->findChild<QAction*>("undo")->isEnabled());
    QVERIFY(find<QToolButton>("structureUndo")->isEnabled());
  }

  void itIsSavedWithItsName() {
    showStructures();
    find<QAction>("saveLabelMap")->trigger();
    ++clicks_;
    auto* dialog = window_->findChild<QFileDialog*>("saveDialog");
    QVERIFY(dialog);
    const QString file = temporary_.filePath("mine.nii.gz");
    QSignalSpy saved(&workstation(), &Workstation::saved);
    emit dialog->fileSelected(file);
    ++clicks_;
    dialog->close();
    QVERIFY(saved.count() == 1 || saved.wait(kLong_ms));
    const auto back = readLabelMap(toPath(file));
    QVERIFY(back.ok());
    QVERIFY(back->find("liver"));
    const Case& of = *workstation().currentCase();
    QCOMPARE(std::count(back->labels.begin(), back->labels.end(), back->find("liver")->label),
             std::count(of.structures->labels.begin(), of.structures->labels.end(),
                        of.structures->find("liver")->label));
  }

  void theCtItselfIsNeverSavedOver() {
    const auto size = std::filesystem::file_size(file_);
    showStructures();
    find<QAction>("saveLabelMap")->trigger();
    auto* dialog = window_->findChild<QFileDialog*>("saveDialog");
    QVERIFY(dialog);
    emit dialog->fileSelected(toQt(file_));
    dialog->close();
    QTRY_VERIFY(window_->findChild<QMessageBox*>("errorDialog"));
    auto* refused = window_->findChild<QMessageBox*>("errorDialog");
    QVERIFY2(refused->text().contains("would be lost"), qPrintable(refused->text()));
    refused->close();
    QCOMPARE(std::filesystem::file_size(file_), size);
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("errorDialog"));
  }

  void thePathIsShort() {
    std::printf("the clinician's path: %d clicks, strokes and keys, %.1f s of computing\n", clicks_,
                double(computing_ms_) / 1000.0);
    QVERIFY(clicks_ <= 12);
    QVERIFY(computing_ms_ < 30000);
  }

  void whatWasReadFromElsewhereIsListed() {
    const QString file = temporary_.filePath("mine.nii.gz");
    QSignalSpy changed(&workstation(), &Workstation::structuresChanged);
    workstation().useLabels(toPath(file));
    QVERIFY(changed.wait(kLong_ms));
    QVERIFY(ml("liver") > 800.0);
    // A liver that lies in air and fat is asked about.
    LabelMap wrong = *readLabelMap(toPath(file));
    std::fill(wrong.labels.begin(), wrong.labels.end(), std::uint8_t(0));
    for (std::size_t n = 0; n < 20000; ++n) wrong.labels[n] = 1;
    wrong.structures = {{1, "liver", Vec3(1.0)}};
    QVERIFY(writeSegmentation(wrong, toPath(temporary_.filePath("wrong.nii.gz"))).ok());
    workstation().useLabels(toPath(temporary_.filePath("wrong.nii.gz")));
    QTRY_VERIFY_WITH_TIMEOUT(window_->findChild<QMessageBox*>("structuresQuestion"), kLong_ms);
    auto* question = window_->findChild<QMessageBox*>("structuresQuestion");
    QVERIFY2(question->text().contains("HU"), qPrintable(question->text()));
    question->reject();
    QVERIFY(ml("liver") > 800.0);
  }

  void unsavedStructuresAreAskedAboutBeforeTheyGo() {
    take("structureEraser");
    drag(in_liver_mm_, in_liver_mm_ + Vec3(10, 0, 0));
    prepareBuiltIn("cranium");
    QTRY_VERIFY(window_->findChild<QMessageBox*>("structuresUnsaved"));
    window_->findChild<QMessageBox*>("structuresUnsaved")->reject();
    rest();
    QVERIFY(!workstation().isOpening() || workstation().isPlacing());
    QVERIFY(ml("liver") > 800.0);
    window_->close();
    QVERIFY(window_->isVisible());
    QTRY_VERIFY(window_->findChild<QMessageBox*>("structuresUnsaved"));
    window_->findChild<QMessageBox*>("structuresUnsaved")->reject();
  }
};

int main(int argc, char** argv) {
  return test::runInWindow<StructuresGuiTest>(argc, argv);
}

#include "structures_gui_test.moc"
