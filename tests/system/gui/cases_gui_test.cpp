// Cases as a clinician makes them: a folder that names its patient becomes a case without a name,
// saved by itself; it is renamed, practised on, closed, opened again and deleted. Every file that
// was written on the way is looked at.
#include <QDialog>
#include <QDirIterator>
#include <QFileDialog>
#include <QInputDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMessageBox>
#include <QPushButton>
#include <QRadioButton>
#include <QSignalSpy>
#include <QStatusBar>
#include <QtTest>

#include "gui_support.h"
#include "imaging/dicom/ct_writer.h"
#include "ui/common/words.h"

using namespace trephine;

namespace {

constexpr int kLong_ms = 120000;
const char* const kFolderName = "DOE^JANE";
const char* const kDescription = "Head of Jane Doe";

}  // namespace

class CasesGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  QString storage() { return temporary_.filePath("storage"); }
  void open() {
    window_ = std::make_unique<MainWindow>(toPath(storage() + "/sessions"));
    window_->resize(1280, 800);
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QApplication::setActiveWindow(window_.get());
  }
  QListWidget* cards() { return find<QListWidget>("cases"); }
  QStringList ids() {
    QStringList ids;
    for (int i = 0; i < cards()->count(); ++i) {
      ids << cards()->item(i)->data(Qt::UserRole).toString();
    }
    return ids;
  }
  QString idOfMine() {
    for (const QString& id : ids()) {
      if (id != "cranium" && id != "abdomen") return id;
    }
    return {};
  }
  void choose(const QString& id) {
    for (int i = 0; i < cards()->count(); ++i) {
      if (cards()->item(i)->data(Qt::UserRole).toString() == id) cards()->setCurrentRow(i);
    }
  }
  QString errorSaid() {
    if (!QTest::qWaitFor([&] { return window_->findChild<QMessageBox*>("errorDialog"); }, 20000)) {
      return {};
    }
    auto* dialog = find<QMessageBox>("errorDialog");
    const QString words = dialog->text() + ' ' + dialog->informativeText();
    dialog->close();
    QTest::qWait(50);
    return words;
  }
  void rename(const QString& name) {
    QTest::mouseClick(find<QPushButton>("renameCase"), Qt::LeftButton);
    QTRY_VERIFY(window_->findChild<QInputDialog*>("renameDialog"));
    auto* dialog = find<QInputDialog>("renameDialog");
    dialog->setTextValue(name);
    dialog->accept();
  }
  void save(const char* action, const QString& file) {
    QSignalSpy saved(&workstation(), &Workstation::saved);
    find<QAction>(action)->trigger();
    QTRY_VERIFY(window_->findChild<QFileDialog*>("saveDialog"));
    auto* dialog = find<QFileDialog>("saveDialog");
    dialog->findChild<QLineEdit*>("fileNameEdit")->setText(file);
    static_cast<QDialog*>(dialog)->accept();
    QVERIFY(saved.count() > 0 || saved.wait(kLong_ms));
    QTest::qWait(100);
  }

 private slots:
  void initTestCase() {
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    const Status made = writeCtSeries(test::coarseCranium(2), {kDescription, "HEAD", kFolderName, "4711-SECRET"},
                                      toPath(temporary_.filePath(kFolderName)));
    QVERIFY2(made.ok(), made.ok() ? "" : made.error().sentence().c_str());
    open();
  }

  void withoutACaseTheNextStepIsOffered() {
    QVERIFY(window_->place() == Place::cases);
    QVERIFY(find<QPushButton>("openFolder")->isVisible());
    QTRY_COMPARE_WITH_TIMEOUT(ids(), (QStringList{"cranium", "abdomen"}), kLong_ms);
    QVERIFY(!find<QPushButton>("nextTrain")->isVisible());
    window_->show(Place::train);
    QVERIFY(find<QPushButton>("startCardChoose")->isVisible());
    QTest::mouseClick(find<QPushButton>("startCardChoose"), Qt::LeftButton);
    QVERIFY(window_->place() == Place::cases);
  }

  void whatIsImportedIsSavedByItselfUnderANeutralName() {
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openPath(toPath(temporary_.filePath(kFolderName)));
    auto* import = find<QPushButton>("import");
    QTRY_VERIFY_WITH_TIMEOUT(import->isEnabled(), kLong_ms);
    QVERIFY(import->isVisible());
    QTest::mouseClick(import, Qt::LeftButton);
    auto* open_case = find<QPushButton>("openCase");
    QTRY_VERIFY_WITH_TIMEOUT(open_case->isVisible(), kLong_ms);
    QTest::mouseClick(find<QRadioButton>("choice_FACE_keep"), Qt::LeftButton);
    QTest::mouseClick(open_case, Qt::LeftButton);
    QVERIFY(opened.wait(kLong_ms));
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().currentCase()->stored.empty(), kLong_ms);
    QVERIFY2(window_->statusBar()->currentMessage().contains("remove the stick"),
             qPrintable(window_->statusBar()->currentMessage()));
    window_->show(Place::cases);
    QTRY_COMPARE_WITH_TIMEOUT(ids().size(), 3, kLong_ms);
    QVERIFY2(idOfMine().startsWith("head-"), qPrintable(idOfMine()));
    QVERIFY(find<QLabel>("nextStepTitle")->text().contains("remove the stick"));
    // From here on it is called by its name alone, and it is the one that is chosen.
    QVERIFY2(!find<QLabel>("caseLabel")->text().contains("Jane"),
             qPrintable(find<QLabel>("caseLabel")->text()));
    QCOMPARE(cards()->currentItem()->data(Qt::UserRole).toString(), idOfMine());
    QVERIFY(window_->grab().save(TREPHINE_ARTEFACTS "/cases-saved.png"));
  }

  void aNameThatTellsWhoItIsIsRefusedInWords() {
    choose(idOfMine());
    const QString before = find<QLabel>("caseName")->text();
    for (const char* name : {"DOE^JANE", "jane doe", "Doe, Jane 2"}) {
      rename(name);
      const QString said = errorSaid();
      QVERIFY2(!said.isEmpty(), name);
      QVERIFY2(!said.contains("DOE", Qt::CaseInsensitive), qPrintable(said));
      QCOMPARE(find<QLabel>("caseName")->text(), before);
    }
  }

  void anotherNameIsTaken() {
    choose(idOfMine());
    rename("Teaching head");
    QTRY_COMPARE_WITH_TIMEOUT(find<QLabel>("caseName")->text(), QString("Teaching head"), kLong_ms);
  }

  void itIsPractisedOnAndTheExerciseIsOfTheCase() {
    choose(idOfMine());
    QTest::mouseClick(find<QPushButton>("trainOnCase"), Qt::LeftButton);
    QTRY_VERIFY(window_->place() == Place::train);
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    QTest::mouseClick(find<QPushButton>("startCardStart"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(started.count() == 1, kLong_ms);
    cut({60, 0});
    save("saveVolume", temporary_.filePath("out-volume.mha"));
    save("savePicture", temporary_.filePath("out-picture.png"));
    find<QAction>("stop")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(find<QWidget>("resultPage")->isVisible(), kLong_ms);
    QVERIFY(find<QLabel>("resultRows")->text().contains("mm"));
    window_->show(Place::cases);
    QTRY_VERIFY_WITH_TIMEOUT(find<QLabel>("caseExercises")->text().contains("0:"), kLong_ms);
  }

  void afterAnotherStartItIsThereAndOpensAsItWas() {
    const std::string sha = workstation().currentCase()->sha256;
    const QString id = idOfMine();
    window_.reset();
    open();
    window_->show(Place::cases);
    QTRY_COMPARE_WITH_TIMEOUT(ids().size(), 3, kLong_ms);
    QVERIFY2(find<QLabel>("nextStepTitle")->text().contains("Teaching head"),
             qPrintable(find<QLabel>("nextStepTitle")->text()));
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    QTest::mouseClick(find<QPushButton>("nextPrepare"), Qt::LeftButton);
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    QCOMPARE(workstation().currentCase()->sha256, sha);
    QCOMPARE(workstation().currentCase()->stored, id.toStdString());
    QVERIFY(window_->place() == Place::prepare);
  }

  void whatIsPreparedIsKeptInTheCase() {
    showTissues();
    window_->findChild<TissuePanel*>()->select("bone");
    auto* damping = find<QDoubleSpinBox>("damping");
    const double before = damping->value();
    damping->setValue(before + 1.0);
    QVERIFY(workstation().tissuesEdited());
    QSignalSpy saved(&workstation(), &Workstation::saved);
    find<QAction>("saveInCase")->trigger();
    QVERIFY(saved.count() == 1 || saved.wait(kLong_ms));
    QVERIFY(!workstation().tissuesEdited());
    prepareBuiltIn("abdomen");
    QTRY_VERIFY_WITH_TIMEOUT(workstation().currentCase()->built_in && !workstation().isOpening(),
                             kLong_ms);
    window_->show(Place::cases);
    choose(idOfMine());
    QTest::mouseClick(find<QPushButton>("prepareCase"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().currentCase()->stored.empty(), kLong_ms);
    QCOMPARE(workstation().scene()->tissues.find("bone")->damping_Ns_per_m.value, before + 1.0);
    QVERIFY(!workstation().tissuesEdited());
  }

  void aFolderThatIsRenamedUnderneathIsSaidAndTheCaseIsFoundAgain() {
    window_->show(Place::cases);
    prepareBuiltIn("cranium");
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    window_->show(Place::cases);
    const QString id = idOfMine();
    choose(id);
    QVERIFY(QDir(storage() + "/cases").rename(id, id + "-moved"));
    QTest::mouseClick(find<QPushButton>("prepareCase"), Qt::LeftButton);
    QVERIFY(!errorSaid().isEmpty());
    window_->show(Place::prepare);
    window_->show(Place::cases);
    QTRY_COMPARE_WITH_TIMEOUT(idOfMine(), id + "-moved", kLong_ms);
    QVERIFY(QDir(storage() + "/cases").rename(id + "-moved", id));
    window_->show(Place::prepare);
    window_->show(Place::cases);
    QTRY_COMPARE_WITH_TIMEOUT(idOfMine(), id, kLong_ms);
  }

  // Its own folder of DICOM is the source, and is left out.
  void noFileThatWasWrittenNamesThePatient() {
    window_.reset();  // settings are written
    QStringList roots{storage(), QFileInfo(windowSettings().fileName()).absolutePath()};
    int files = 0;
    const auto look = [&](const QString& path) {
      QFile file(path);
      QVERIFY2(file.open(QIODevice::ReadOnly), qPrintable(path));
      ++files;
      const QByteArray bytes = file.readAll().toUpper();
      for (const char* word : {"DOE", "JANE"}) {
        QVERIFY2(!bytes.contains(word) || path.endsWith(".mha") || path.endsWith(".h5"),
                 qPrintable(path + " has " + word));
      }
      for (const char* word : {"DOE^JANE", "DOE JANE", "JANE DOE", "4711-SECRET"}) {
        QVERIFY2(!bytes.contains(word), qPrintable(path + " has " + word));
      }
      QVERIFY2(!path.mid(temporary_.path().size()).contains("DOE"), qPrintable(path));
    };
    for (const QString& root : roots) {
      QDirIterator it(root, QDir::Files | QDir::Hidden, QDirIterator::Subdirectories);
      while (it.hasNext()) look(it.next());
    }
    for (const char* name : {"out-volume.mha", "out-picture.png"}) look(temporary_.filePath(name));
    QVERIFY2(files >= 10, qPrintable(QString::number(files)));
    open();
  }

  void deletingAsksOnceAndTakesAllOfIt() {
    window_->show(Place::cases);
    QTRY_COMPARE_WITH_TIMEOUT(ids().size(), 3, kLong_ms);
    const QString id = idOfMine();
    choose(id);
    QTest::keyClick(cards(), Qt::Key_Delete);
    QTRY_VERIFY(window_->findChild<QMessageBox*>("deleteQuestion"));
    QTest::keyClick(find<QMessageBox>("deleteQuestion"), Qt::Key_Escape);
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("deleteQuestion"));
    QVERIFY(QDir(storage() + "/cases/" + id).exists());
    QTest::mouseClick(find<QPushButton>("deleteCase"), Qt::LeftButton);
    QTRY_VERIFY(window_->findChild<QMessageBox*>("deleteQuestion"));
    QTest::mouseClick(find<QMessageBox>("deleteQuestion")->findChild<QPushButton*>("goOnAnyway"),
                      Qt::LeftButton);
    QTRY_COMPARE_WITH_TIMEOUT(ids().size(), 2, kLong_ms);
    QVERIFY(!QDir(storage() + "/cases/" + id).exists());
  }

  void cleanupTestCase() { window_.reset(); }
};

int main(int argc, char** argv) { return test::runInWindow<CasesGuiTest>(argc, argv); }

#include "cases_gui_test.moc"
