// Tissues, controller and exercise as a person changes them in the window, and as a slip does not.
// The steps build on each other, in order.
#include <QtTest/qtestspontaneevent.h>

#include <QAbstractItemView>
#include <QApplication>
#include <QDialogButtonBox>
#include <QDir>
#include <QFileDialog>
#include <QLineEdit>
#include <QMessageBox>
#include <QSignalSpy>
#include <QStandardPaths>
#include <QTabBar>
#include <QtTest>

#include "gui_support.h"
#include "tissue/tissue_edits.h"
#include "ui/common/words.h"
#include "volume/phantom.h"

using namespace trephine;

class EditsGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  ViewWidget& view() { return window_->view(); }
  const Tissue& bone() { return *workstation().exercise()->tissues.find("bone"); }

  void activate() {
    QApplication::setActiveWindow(window_.get());
    view().setFocus();
    QVERIFY(view().hasFocus());
  }
  void enter(const char* box, const QString& value) {
    auto* spin = find<QAbstractSpinBox>(box);
    spin->setFocus();
    auto* line = spin->findChild<QLineEdit*>();
    line->selectAll();
    QTest::keyClicks(line, value);
    QTest::keyClick(line, Qt::Key_Return);
  }
  void wheelOver(QWidget* widget, int notches) {
    const QPointF at = QRectF(widget->rect()).center();
    for (int i = 0; i < std::abs(notches); ++i) {
      QWheelEvent event(at, widget->mapToGlobal(at), {}, {0, notches > 0 ? 120 : -120},
                        Qt::NoButton, Qt::NoModifier, Qt::NoScrollPhase, false);
      QSpontaneKeyEvent::setSpontaneous(&event);  // as from a mouse
      qApp->notify(widget, &event);
    }
  }
  // As a click in the opened list does.
  void choose(QComboBox* choices, int index) {
    choices->setCurrentIndex(index);
    QVERIFY(QMetaObject::invokeMethod(choices, "activated", Q_ARG(int, index)));
  }
  void chooseExercise(const char* file) {
    auto* exercises = find<QComboBox>("scenes");
    for (int i = 0; i < exercises->count(); ++i) {
      if (exercises->itemData(i).toString().endsWith(file)) return choose(exercises, i);
    }
    QFAIL(file);
  }
  QMessageBox* question() {
    auto* box = window_->findChild<QMessageBox*>("unsavedTissues");
    return box && box->isVisible() ? box : nullptr;
  }
  void answer(QMessageBox::StandardButton button) {
    QTRY_VERIFY(question());
    QTest::mouseClick(question()->button(button), Qt::LeftButton);
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("unsavedTissues"));
    QApplication::setActiveWindow(window_.get());
  }
  void keepGrab(const char* name) {
    restRefined();
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/") + name));
  }
  void wheelOverEverythingChangesNothing() {
    activate();
    const TissueSet tissues = workstation().exercise()->tissues;
    const auto file = workstation().exerciseFile();
    const auto volume = workstation().currentCase()->volume;
    auto* controller = find<QComboBox>("controller");
    auto* exercises = find<QComboBox>("scenes");
    const int controller_was = controller->currentIndex(), exercise_was = exercises->currentIndex();
    QWidget* tabs = find<QTabWidget>("prepareTabs")->tabBar();
    const QList<QWidget*> of_prepare{find<QWidget>("huLow"),    find<QWidget>("huHigh"),
                                     find<QWidget>("damping"),  find<QWidget>("stiffness"),
                                     find<QWidget>("friction"), find<QWidget>("opacity"),
                                     find<QWidget>("scenes"),   tabs};
    for (Place place : {Place::prepare, Place::train}) {
      window_->show(place);
      rest();
      view().setFocus();
      for (QWidget* widget :
           place == Place::prepare ? of_prepare : QList<QWidget*>{controller, exercises}) {
        QVERIFY2(widget->isVisible(), qPrintable(widget->objectName()));
        wheelOver(widget, -3);
        wheelOver(widget, 1);
        QVERIFY2(view().hasFocus(), qPrintable(widget->objectName()));
      }
    }
    showTissues();
    QVERIFY(workstation().exercise()->tissues == tissues);
    QCOMPARE(controller->currentIndex(), controller_was);
    QCOMPARE(exercises->currentIndex(), exercise_was);
    QCOMPARE(find<QTabWidget>("prepareTabs")->currentIndex(), 0);
    QVERIFY(workstation().exerciseFile() == file);
    QVERIFY(workstation().currentCase()->volume == volume);
    QVERIFY(!workstation().isOpening());
  }

 private slots:
  void initTestCase() {
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    window_ = newWindow(toPath(temporary_.filePath("sessions")));
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openImported(caseOf(std::make_shared<const Volume>(test::coarseCranium(4))));
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    showTissues();
    window_->findChild<TissuePanel*>()->select("bone");
    QCOMPARE(find<QSpinBox>("huLow")->value(), 226);
  }

  void theWheelChangesNoFieldAndThrowsNoCaseAway() { wheelOverEverythingChangesNothing(); }

  void aNumberBeyondItsRangeIsRefusedBesideItsFieldAndTheKeysGoBack() {
    const double before = bone().damping_Ns_per_m.value;
    enter("damping", "1000000");
    QVERIFY(view().hasFocus());
    QCOMPARE(bone().damping_Ns_per_m.value, before);
    auto* reason = find<QLabel>("dampingRefused");
    QVERIFY(reason->isVisible());
    QVERIFY2(reason->text().contains("1000000") && reason->text().contains("100000 "),
             qPrintable(reason->text()));
    const auto below = [&](const char* name) {
      return reason->mapToGlobal(QPoint()).y() > find<QWidget>(name)->mapToGlobal(QPoint()).y();
    };
    QVERIFY(below("damping") && !below("stiffness"));
    keepGrab("refused-1280x800.png");
    QVERIFY2(reason->height() >= reason->heightForWidth(reason->width()), "the reason is cut off");
    enter("damping", "-50");
    QCOMPARE(bone().damping_Ns_per_m.value, before);
    QVERIFY2(reason->text().contains("-50"), qPrintable(reason->text()));
    auto* box = find<QDoubleSpinBox>("damping");
    box->setFocus();
    QTest::keyClick(box, Qt::Key_Escape);
    QVERIFY(!reason->isVisible());
    QCOMPARE(box->value(), before);
    QVERIFY(view().hasFocus());

    // A narrower field: the words need three lines.
    enter("huLow", "1000000");
    auto* of_hu = find<QLabel>("huLowRefused");
    QTRY_VERIFY(of_hu->isVisible());
    QTRY_VERIFY2(of_hu->height() >= of_hu->heightForWidth(of_hu->width()), "the reason is cut off");
    auto* low = find<QSpinBox>("huLow");
    low->setFocus();
    QTest::keyClick(low, Qt::Key_Escape);
    QVERIFY(!of_hu->isVisible());
  }

  void escapeGivesTheKeysBackFromEveryControl() {
    for (const char* name : {"huLow", "opacity", "tissueList", "controller", "scenes"}) {
      auto* widget = find<QWidget>(name);
      widget->setFocus();
      QVERIFY2(widget->hasFocus(), name);
      QTest::keyClick(widget, Qt::Key_Escape);
      QVERIFY2(view().hasFocus(), name);
    }
  }

  void huWithoutATissueAreMentioned() {
    auto* gaps = find<QLabel>("tissueGaps");
    QVERIFY(!gaps->isVisible());
    enter("huLow", "3000");
    QVERIFY(gaps->isVisible());
    QVERIFY2(gaps->text().contains("226 to 2999 HU"), qPrintable(gaps->text()));
    keepGrab("gap-1280x800.png");
    enter("huLow", "226");
    QVERIFY(!gaps->isVisible());
    QVERIFY(!workstation().tissuesEdited());
  }

  void theSameExerciseOnAnotherCaseAsksNothingAndAnotherExerciseAsksOnce() {
    enter("huLow", "300");
    QVERIFY(workstation().tissuesEdited());
    prepareBuiltIn("cranium");
    QVERIFY(!question());
    QVERIFY(workstation().isOpening());
    QVERIFY(window_->place() == Place::prepare);
    workstation().cancelOpening();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    QTRY_VERIFY2(window_->place() == Place::cases, "where it was asked for");
    window_->show(Place::prepare);

    const auto file = workstation().exerciseFile();
    chooseExercise("burr-hole.json");
    answer(QMessageBox::Cancel);
    QVERIFY(!workstation().isOpening());
    QVERIFY(workstation().exerciseFile() == file);
    QCOMPARE(bone().hu_min, 300);
    QCOMPARE(find<QComboBox>("scenes")->currentData().toString(), toQt(file));

    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    chooseExercise("burr-hole.json");
    answer(QMessageBox::Discard);
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    QVERIFY(!question());
    QVERIFY(workstation().exerciseFile() != file);
    QCOMPARE(bone().hu_min, 226);
    chooseExercise("cranium.json");
    QVERIFY(opened.count() == 2 || opened.wait(kLong_ms));
    QVERIFY(!question());
  }

  void editsAreSavedBeforeTheOtherExerciseComes() {
    showTissues();
    window_->findChild<TissuePanel*>()->select("bone");
    enter("huLow", "310");
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    chooseExercise("burr-hole.json");
    answer(QMessageBox::Save);
    QTRY_VERIFY(window_->findChild<QFileDialog*>("saveDialog"));
    auto* dialog = find<QFileDialog>("saveDialog");
    const QString file = temporary_.filePath("mine.json");
    find<QLineEdit>("fileNameEdit")->setText(file);
    dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save)->click();
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    const Result<TissueSet> saved = readTissueSet(toPath(file));
    QVERIFY(saved.ok());
    QCOMPARE(saved->find("bone")->hu_min, 310);
    QCOMPARE(bone().hu_min, 226);
    QApplication::setActiveWindow(window_.get());
    chooseExercise("cranium.json");
    QVERIFY(opened.count() == 2 || opened.wait(kLong_ms));
    showTissues();
    window_->findChild<TissuePanel*>()->select("bone");
  }

  void inAnExerciseNeitherWheelNorArrowKeysChangeTheController() {
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    find<QAction>("start")->trigger();
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
    wheelOverEverythingChangesNothing();
    window_->show(Place::train);
    auto* controller = find<QComboBox>("controller");
    controller->setFocus();
    QTest::keyClick(controller, Qt::Key_PageDown);
    QTest::keyClick(controller, Qt::Key_End);
    QTest::keyClick(controller, Qt::Key_O);
    QTest::keyClick(controller, Qt::Key_Down);
    QVERIFY(controller->view()->isVisible());
    controller->hidePopup();
    QCOMPARE(controller->currentData().toInt(), int(ControllerKind::bounded));
    QTRY_VERIFY(workstation().session()->state().ticks > 0);
    QVERIFY(workstation().session()->state().controller == ControllerKind::bounded);
  }

  void afterTypingPageUpIsTheHandsAndNotTheThresholds() {
    showTissues();
    enter("huLow", "230");
    QCOMPARE(bone().hu_min, 230);
    QVERIFY(view().hasFocus());
    QSignalSpy moved(&view(), &ViewWidget::pushStepped);
    QTest::keyClick(QApplication::focusWidget(), Qt::Key_PageUp);
    QCOMPARE(moved.count(), 1);
    QCOMPARE(bone().hu_min, 230);
    enter("huLow", "226");
  }

  void thePanelFollowsTheControllerInForce() {
    auto* felt = find<QLabel>("tissueFelt");
    enter("stiffness", "1000000");
    QVERIFY(felt->isVisible());
    QVERIFY2(felt->text().contains("at most"), qPrintable(felt->text()));
    auto* controller = find<QComboBox>("controller");
    window_->show(Place::train);
    choose(controller, controller->findData(int(ControllerKind::off)));
    QVERIFY(view().hasFocus());
    showTissues();
    QTRY_VERIFY(!felt->text().contains("at most"));
    QVERIFY2(felt->text().contains("may shake"), qPrintable(felt->text()));
    keepGrab("felt-off-1280x800.png");
    // From elsewhere too: a script's controller is one that nobody chose here.
    QVERIFY(workstation().session()->setController(ControllerKind::bounded));
    QTRY_VERIFY(felt->text().contains("at most"));
    workstation().stop();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    QVERIFY2(felt->text().contains("may shake"), "the next exercise runs as was chosen");
    QCOMPARE(controller->currentData().toInt(), int(ControllerKind::off));
  }

  void closingAsksForEditsOnce() {
    QVERIFY(workstation().tissuesEdited());
    window_->close();
    answer(QMessageBox::Cancel);
    QVERIFY(window_->isVisible());
    window_->close();
    answer(QMessageBox::Discard);
    QVERIFY(!window_->isVisible());
  }

  void cleanupTestCase() { window_.reset(); }
};

int main(int argc, char** argv) {
  return test::runInWindow<EditsGuiTest>(argc, argv);
}

#include "edits_gui_test.moc"
