// Whether the workstation is fit, in the window: measured with progress, cancelled, saved to be
// printed, and one line at each start.
#include <QFileDialog>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QTextBrowser>

#include "base/system.h"
#include "gui_support.h"
#include "machine/commission/start_check.h"
#include "ui/commission/commission_page.h"
#include "ui/commission/fitness_line.h"

using namespace trephine;

class CommissionGuiTest : public test::WindowTest {
  Q_OBJECT

  CommissionPage* page() { return window_->findChild<CommissionPage*>(); }
  template <class Widget>
  Widget* of(const char* name) {
    return page()->findChild<Widget*>(name);
  }
  void picture(const char* name, QWidget& of) {
    QVERIFY(of.grab().save(QString(TREPHINE_ARTEFACTS "/%1.png").arg(name)));
  }
  QString line() {
    auto* line = find<FitnessLine>("fitness");
    QSignalSpy looked(line, &FitnessLine::looked);
    line->look();
    if (!looked.wait(15000)) return "never";
    return line->text();
  }
  void keep(const Commissioning& made) {
    const auto folder = *stateFolder();
    QVERIFY(makeFolder(folder));
    QVERIFY(writeTextFile(folder / "commission.json", toJson(made).dump()));
  }

 private slots:
  void initTestCase() {
    ::setenv("XDG_STATE_HOME", (temporary_.path() + "/state").toUtf8(), 1);
    ::setenv("XDG_CONFIG_HOME", (temporary_.path() + "/config").toUtf8(), 1);
    openWindow("trephine-test-commission");
  }
  void cleanupTestCase() { closeWindow(); }

  void aWorkstationThatWasNeverCommissionedSaysSo() {
    const QString said = line();
    QVERIFY2(said.contains("not been commissioned"), qPrintable(said));
    QVERIFY(find<QLabel>("fitness")->isVisible());
    window_->show(Place::train);
    QVERIFY2(!find<QLabel>("fitness")->isVisible(), "there the line is of mouse and keys");
    window_->show(Place::cases);
  }

  void escCancelsAtOnceAndLeavesThePage() {
    find<QAction>("commission")->trigger();
    QVERIFY(page() && page()->isVisible());
    QVERIFY(!of<QPushButton>("saveCommission")->isEnabled());
    picture("commission_begin", *page());
    of<QPushButton>("beginCommission")->click();
    QTRY_VERIFY_WITH_TIMEOUT(of<QProgressBar>("commissionProgress")->value() > 0, 20000);
    QVERIFY(!of<QLabel>("commissionStep")->text().isEmpty());
    picture("commission_runs", *page());
    QTest::keyClick(page(), Qt::Key_Escape);
    QTRY_VERIFY_WITH_TIMEOUT(of<QPushButton>("beginCommission")->isEnabled(), 10000);
    QVERIFY(page()->isVisible());
    QVERIFY2(of<QLabel>("commissionStep")->text().contains("Cancelled"),
             qPrintable(of<QLabel>("commissionStep")->text()));
    QVERIFY(!std::filesystem::exists(*stateFolder() / "commission.json"));
  }

  void itMeasuresToItsEndAndSaysWhatToDo() {
    page()->begin(0.3);
    QTRY_VERIFY_WITH_TIMEOUT(of<QPushButton>("beginCommission")->isEnabled(), kLong_ms);
    const QString said = of<QTextBrowser>("commissionResult")->toPlainText();
    for (const char* part : {"Commissioning of this workstation", "Real-time priority",
                             "Room on the screen", "Arms that are plugged in", "at least 2"}) {
      QVERIFY2(said.contains(part), part);
    }
    picture("commission_result", *page());
    QVERIFY(std::filesystem::exists(*stateFolder() / "commission.json"));
    QVERIFY(
        std::filesystem::exists(toPath(temporary_.path() + "/config/trephine/recommended.json")));
  }

  void itIsSavedToBePrinted() {
    for (const char* name : {"page.pdf", "page.html"}) {
      of<QPushButton>("saveCommission")->click();
      QFileDialog* dialog = nullptr;
      QTRY_VERIFY(dialog = page()->findChild<QFileDialog*>("saveDialog"));
      const QString file = temporary_.filePath(name);
      emit dialog->fileSelected(file);
      dialog->close();
      QTRY_VERIFY(!page()->findChild<QFileDialog*>("saveDialog"));
      QFile saved(file);
      QVERIFY2(saved.open(QIODevice::ReadOnly), name);
      const QByteArray bytes = saved.readAll();
      QVERIFY(QString(name).endsWith("pdf") ? bytes.startsWith("%PDF")
                                            : bytes.contains("Real-time priority"));
    }
    QVERIFY(page()->save("/proc/none.pdf").ok() == false);
    QTest::keyClick(page(), Qt::Key_Escape);
    QTRY_VERIFY(!page());
    // The last one stands there the next time.
    find<QAction>("commission")->trigger();
    QVERIFY(of<QTextBrowser>("commissionResult")->toPlainText().contains("Real-time priority"));
    page()->close();
    QTRY_VERIFY(!page());
  }

  void atEachStartOneLineIsGreenOrSaysWhatHasChanged() {
    const auto made = readCommissioning(*stateFolder() / "commission.json");
    QVERIFY(made);
    Commissioning like = *made;
    // These depend on what else the machine does now.
    std::erase_if(like.checks, [](const auto& c) {
      return c.name.starts_with("lateness") || c.name == "disk_write" || c.verdict == Fitness::fail;
    });
    line();  // what looked at the commissioning that was made
    // It looks already, at one that was not fit.
    Commissioning unfit = like;
    unfit.checks.push_back(judged("frame_time", 1000.0));
    keep(unfit);
    find<FitnessLine>("fitness")->look();
    rest();
    keep(like);
    const QString same = line();
    QVERIFY2(same.startsWith("As commissioned on"), qPrintable(same));
    window_->grab().save(TREPHINE_ARTEFACTS "/fitness_green.png");
    for (CommissionCheck& check : like.checks) {
      if (check.name == "arms") check = judged("arms", 2.0);
    }
    keep(like);
    const QString changed = line();
    QVERIFY2(changed.contains("Arms that are plugged in, now 0"), qPrintable(changed));
    QVERIFY2(changed.contains("Plug them in"), qPrintable(changed));
    window_->grab().save(TREPHINE_ARTEFACTS "/fitness_changed.png");
  }

  void whatIsAskedBeforeAnExerciseIsLookedAtAfterIt() {
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openPhantom("abdomen");
    QVERIFY(opened.count() == 1 || opened.wait(60000));
    auto* line = find<FitnessLine>("fitness");
    Commissioning unfit = *readCommissioning(*stateFolder() / "commission.json");
    unfit.checks = {judged("frame_time", 1000.0)};
    keep(unfit);
    QSignalSpy looked(line, &FitnessLine::looked);
    line->look();
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    window_->show(Place::train);
    find<QAction>("start")->trigger();
    QVERIFY(started.count() == 1 || started.wait(60000));
    QTRY_VERIFY(workstation().session()->state().ticks > 2000);
    QCOMPARE(looked.count(), 0);
    find<QAction>("stop")->trigger();
    QVERIFY(looked.wait(60000));
    QVERIFY(workstation().phase() == Workstation::Phase::ready);
    QVERIFY2(line->text().contains("not fit"), qPrintable(line->text()));
  }
};

int main(int argc, char** argv) {
  return test::runInWindow<CommissionGuiTest>(argc, argv);
}

#include "commission_gui_test.moc"
