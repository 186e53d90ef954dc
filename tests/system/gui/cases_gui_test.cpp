// Cases as a clinician makes them: a folder that names its patient becomes a case without a name,
// saved by itself; it is renamed, practised on, closed, opened again and deleted. Every file that
// was written on the way is looked at.
#include <spdlog/sinks/basic_file_sink.h>

#include <QBuffer>
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
#include <QToolButton>
#include <QtTest>

#include "base/log.h"
#include "base/purpose.h"
#include "exchange/exercise_folder.h"
#include "gui_support.h"
#include "imaging/dicom/ct_writer.h"
#include "library/case_folders.h"
#include "packed_words.h"
#include "ui/common/words.h"

using namespace trephine;

namespace {

const char* const kFolderName = "DOE^JANE";
const char* const kId = "4711-SECRET";
const char* const kFileWord = "JDOE1970";
const CtSeriesText kText{"Head of Jane Doe", "HEAD", kFolderName, kId};

}  // namespace

class CasesGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  QString storage() { return temporary_.filePath("storage"); }
  void open() {
    window_ = newWindow(toPath(storage() + "/sessions"));
    window_->resize(1280, 800);
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QApplication::setActiveWindow(window_.get());
  }
  QString exports() { return temporary_.filePath("exports"); }
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
    if (!QTest::qWaitFor([&] { return window_->findChild<QMessageBox*>("errorDialog"); },
                         kLong_ms)) {
      return {};
    }
    auto* dialog = find<QMessageBox>("errorDialog");
    const QString words = dialog->text() + ' ' + dialog->informativeText();
    dialog->close();
    rest();
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
    rest();
  }

 private slots:
  void initTestCase() {
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    const Status made =
        writeCtSeries(test::coarseCranium(2), kText, toPath(temporary_.filePath(kFolderName)));
    QVERIFY2(made.ok(), made.ok() ? "" : made.error().sentence().c_str());
    QDir source(temporary_.filePath(kFolderName));
    for (const QString& name : source.entryList(QDir::Files)) {
      QVERIFY(source.rename(name, kFileWord + ('-' + name)));
    }
    auto log = spdlog::basic_logger_mt("log", temporary_.filePath("log.txt").toStdString());
    log->set_level(spdlog::level::trace);
    spdlog::set_default_logger(log);
    log->info("The log of this test");
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
    QVERIFY(QDir().mkpath(exports()));
    for (const char* name : {"report.html", "report.pdf"}) {
      QSignalSpy saved(&workstation(), &Workstation::saved);
      QTest::mouseClick(find<QPushButton>("saveReport"), Qt::LeftButton);
      QTRY_VERIFY(window_->findChild<QFileDialog*>("saveDialog"));
      emit find<QFileDialog>("saveDialog")->fileSelected(exports() + '/' + name);
      find<QFileDialog>("saveDialog")->close();
      QVERIFY(saved.count() > 0 || saved.wait(kLong_ms));
      rest();
    }
    QTest::mouseClick(import, Qt::LeftButton);
    auto* open_case = find<QPushButton>("openCase");
    QTRY_VERIFY_WITH_TIMEOUT(open_case->isVisible(), kLong_ms);
    QTest::mouseClick(find<QRadioButton>("choice_FACE_keep"), Qt::LeftButton);
    QTest::mouseClick(open_case, Qt::LeftButton);
    QVERIFY(opened.wait(kLong_ms));
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().currentCase()->stored.empty(), kLong_ms);
    QVERIFY2(window_->statusBar()->currentMessage().contains("not needed any more"),
             qPrintable(window_->statusBar()->currentMessage()));
    window_->show(Place::cases);
    QTRY_COMPARE_WITH_TIMEOUT(ids().size(), 3, kLong_ms);
    QVERIFY2(idOfMine().startsWith("head-"), qPrintable(idOfMine()));
    QVERIFY(find<QLabel>("nextStepTitle")->text().contains("not needed any more"));
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
      // What was typed is there to be changed, once that is closed.
      QTRY_VERIFY(window_->findChild<QInputDialog*>("renameDialog"));
      auto* again = window_->findChild<QInputDialog*>("renameDialog");
      QVERIFY(again);
      QCOMPARE(again->textValue(), QString(name));
      again->reject();
      QTRY_VERIFY(!window_->findChild<QInputDialog*>("renameDialog"));
      QCOMPARE(find<QLabel>("caseName")->text(), before);
    }
  }

  void anotherNameIsTaken() {
    choose(idOfMine());
    rename("Teaching head");
    QTRY_COMPARE_WITH_TIMEOUT(find<QLabel>("caseName")->text(), QString("Teaching head"), kLong_ms);
    QVERIFY2(window_->windowTitle().contains("Teaching head"), qPrintable(window_->windowTitle()));
  }

  void itIsPractisedOnAndTheExerciseIsOfTheCase() {
    choose(idOfMine());
    QTest::mouseClick(find<QPushButton>("trainOnCase"), Qt::LeftButton);
    QTRY_VERIFY(window_->place() == Place::train);
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    QTest::mouseClick(find<QPushButton>("startCardStart"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(started.count() == 1, kLong_ms);
    cut({60, 0});
    save("saveVolume", exports() + "/running.mha");
    save("savePicture", exports() + "/running.png");
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
    write(settings::kWorkspace, QString("prepare"));
    open();
    QVERIFY2(window_->place() == Place::cases, "without a case nothing can be prepared");
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

  void whatWasMadeOnItIsPractisedOnItAfterAnotherStart() {
    const std::string id = workstation().currentCase()->stored;
    Exercise made = *workstation().exercise();
    made.name = "Made here";
    made.case_source = (toPath(storage()) / "cases" / id / case_folders::kVolumeFile).string();
    const auto folder = freshExercise(toPath(storage()), made.name);
    QVERIFY(saveExercise(made, folder, toPath(storage()), Progress()).ok());
    for (const bool there : {true, false}) {
      window_.reset();
      if (!there) std::filesystem::remove_all(folder);
      open();
      QTRY_COMPARE_WITH_TIMEOUT(ids().size(), 3, kLong_ms);
      choose(idOfMine());
      QSignalSpy opened(&workstation(), &Workstation::caseOpened);
      QTest::mouseClick(find<QPushButton>("trainOnCase"), Qt::LeftButton);
      QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
      QCOMPARE(workstation().currentCase()->stored, id);
      QCOMPARE(workstation().exercise()->name == "Made here", there);
    }
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
    QCOMPARE(workstation().exercise()->tissues.find("bone")->damping_Ns_per_m.value, before + 1.0);
    QVERIFY(!workstation().tissuesEdited());

    // It brings its own: tissues that were changed elsewhere are asked about before they go.
    prepareBuiltIn("cranium");
    QTRY_VERIFY_WITH_TIMEOUT(workstation().currentCase()->built_in && !workstation().isOpening(),
                             kLong_ms);
    showTissues();
    window_->findChild<TissuePanel*>()->select("bone");
    damping->setValue(before + 2.0);
    QVERIFY(workstation().tissuesEdited());
    for (const auto answer : {QMessageBox::Cancel, QMessageBox::Discard}) {
      window_->show(Place::cases);
      choose(idOfMine());
      QTest::mouseClick(find<QPushButton>("prepareCase"), Qt::LeftButton);
      QTRY_VERIFY(window_->findChild<QMessageBox*>("unsavedTissues"));
      QVERIFY(workstation().currentCase()->built_in);
      find<QMessageBox>("unsavedTissues")->button(answer)->click();
      QTRY_VERIFY(!window_->findChild<QMessageBox*>("unsavedTissues"));
    }
    QTRY_VERIFY_WITH_TIMEOUT(
        !workstation().currentCase()->stored.empty() && !workstation().isOpening(), kLong_ms);
    QCOMPARE(workstation().exercise()->tissues.find("bone")->damping_Ns_per_m.value, before + 1.0);
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
    QTRY_COMPARE_WITH_TIMEOUT(idOfMine(), id + "-moved", kLong_ms);
    QVERIFY(QDir(storage() + "/cases").rename(id + "-moved", id));
    window_->show(Place::prepare);
    window_->show(Place::cases);
    QTRY_COMPARE_WITH_TIMEOUT(idOfMine(), id, kLong_ms);
  }

  // All that the window gives to others, of the case that the library has.
  void itIsExportedInEveryWayThereIs() {
    window_->show(Place::cases);
    choose(idOfMine());
    QTest::mouseClick(find<QPushButton>("prepareCase"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(
        !workstation().currentCase()->stored.empty() && !workstation().isOpening(), kLong_ms);
    showStructures();
    QTRY_VERIFY_WITH_TIMEOUT(find<QToolButton>("structureSkull")->isEnabled(), kLong_ms);
    QTest::mouseClick(find<QToolButton>("structureSkull"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(find<QPushButton>("saveStructures")->isEnabled(), kLong_ms);
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    QVERIFY(!find<QAction>("saveForSource")->isEnabled());  // its source is not known any more
    save("saveLabelMap", exports() + "/structures.nii.gz");
    save("saveLabelMap", exports() + "/structures.seg.nrrd");
    save("saveSurface", exports() + "/skull.stl");
    QSignalSpy saved(&workstation(), &Workstation::saved);
    find<QAction>("saveDicom")->trigger();
    QTRY_VERIFY(window_->findChild<QFileDialog*>("dicomDialog"));
    emit find<QFileDialog>("dicomDialog")->fileSelected(exports() + "/dicom");
    find<QFileDialog>("dicomDialog")->close();
    QVERIFY(saved.count() > 0 || saved.wait(kLong_ms));
    for (const char* name : {"carved.mha", "carved.nii", "carved.nii.gz"}) {
      save("saveVolume", exports() + '/' + name);
    }
    save("savePicture", exports() + "/picture.png");
    saved.clear();
    workstation().saveTissues(toPath(exports() + "/tissues.json"), [] {});
    QVERIFY(saved.count() > 0 || saved.wait(kLong_ms));
    // What is in a file is not in the case yet.
    const auto inCase = [&] {
      for (const ListedCase& one : CaseLibrary(toPath(storage())).list()) {
        if (one.id == workstation().currentCase()->stored) return one.record.structures.size();
      }
      return std::size_t(0);
    };
    QCOMPARE(inCase(), std::size_t(0));
    find<QAction>("saveInCase")->trigger();
    QVERIFY(saved.wait(kLong_ms));
    QVERIFY(inCase() > 0);
    saved.clear();
    find<QAction>("saveInCase")->trigger();
    QVERIFY(window_->statusBar()->currentMessage().startsWith("Nothing of it has changed"));
    QCOMPARE(saved.count(), 0);
  }

  void everyExportSaysOnceWhatItIsFor() {
    int files = 0;
    QDirIterator it(exports(), QDir::Files, QDirIterator::Subdirectories);
    while (it.hasNext()) {
      const QString path = it.next();
      if (path.endsWith(".pdf")) continue;  // has no letters but pictures of them
      const int count = test::countIn(test::bytesOfFile(toPath(path)), kPurpose);
      QVERIFY2(count == 1, qPrintable(QString("%1: %2 times").arg(path).arg(count)));
      ++files;
    }
    QVERIFY2(files >= 10, qPrintable(QString::number(files)));
    const QDir sessions(storage() + "/sessions");
    for (const QString& name : sessions.entryList({"*.h5"})) {
      QCOMPARE(test::countIn(test::bytesOfFile(toPath(sessions.filePath(name))), kPurpose), 1);
    }
    // And to be seen: below the picture is a strip with it.
    const QImage saved(exports() + "/picture.png");
    const Result<Picture> seen = window_->view().picture();
    QVERIFY(seen);
    QCOMPARE(saved.width(), seen->width);
    QVERIFY2(saved.height() >= seen->height + 10, qPrintable(QString::number(saved.height())));
  }

  void everyWorkspaceSaysOnceWhatItIsFor() {
    for (const Place place : {Place::cases, Place::prepare, Place::train, Place::review}) {
      window_->show(place);
      int count = 0;
      for (const QLabel* label : window_->findChildren<QLabel*>()) {
        count += label->isVisible() && label->text().contains(purposeText());
      }
      QCOMPARE(count, 1);
    }
  }

  void theSearchFindsANameHoweverItIsPacked() {
    const std::vector<std::string> words{"SECRET", "JANE"};
    const QByteArray text("It is of Secret.");
    QByteArray zlib = qCompress(text);
    zlib.remove(0, 4);  // Qt's own head
    const QByteArray noise("\x01\x00\x02", 3);
    QCOMPARE(test::wordIn((noise + zlib + noise).toStdString(), words), std::string("SECRET"));
    QImage picture(4, 4, QImage::Format_RGB888);
    picture.fill(Qt::black);
    picture.setText("Comment", QString(200, 'x') + "secret");  // long ones are packed
    QByteArray png;
    QBuffer buffer(&png);
    buffer.open(QIODevice::WriteOnly);
    QVERIFY(picture.save(&buffer, "PNG"));
    QVERIFY(!png.contains("secret"));
    QCOMPARE(test::wordIn(png.toStdString(), words), std::string("SECRET"));
    const QString wide("a secret");
    const QByteArray utf16(reinterpret_cast<const char*>(wide.utf16()), 2 * wide.size());
    QCOMPARE(test::wordIn(utf16.toStdString(), words), std::string("SECRET"));
    QCOMPARE(test::wordIn("of jane", words), std::string("JANE"));
    QCOMPARE(test::wordIn("of nobody", words), std::string());
  }

  // Its own folder of DICOM is the source, and is left out.
  void noFileThatWasWrittenNamesThePatient() {
    window_.reset();  // settings are written
    std::vector<std::string> words{"DOE^JANE", "DOE JANE", "JANE DOE", "JANE^DOE", "DOE, JANE",
                                   "DOE_JANE", "JANE_DOE", "DOE-JANE", "JANEDOE",  "DOEJANE",
                                   kId,        "SECRET",   kFileWord,  "DOE",      "JANE"};
    const CtSeriesUids uids = ctSeriesUids(test::coarseCranium(2), kText);
    for (const std::string& uid : {uids.study, uids.series, uids.frame_of_reference}) {
      words.push_back(uid);
    }
    words.insert(words.end(), uids.slices.begin(), uids.slices.end());
    int files = 0;
    for (const QString& root : {storage(), exports(), temporary_.filePath("log.txt"),
                                QFileInfo(windowSettings().fileName()).absolutePath()}) {
      QStringList paths;
      if (QFileInfo(root).isFile()) paths << root;
      QDirIterator it(root, QDir::Files | QDir::Hidden, QDirIterator::Subdirectories);
      while (it.hasNext()) paths << it.next();
      for (const QString& path : paths) {
        ++files;
        const std::string found = test::wordIn(test::bytesOfFile(toPath(path)), words);
        QVERIFY2(found.empty(), qPrintable(path + " has " + toQt(found)));
        const std::string name = path.mid(temporary_.path().size()).toStdString();
        QVERIFY2(test::wordIn(name, words).empty(), qPrintable(path));
      }
    }
    QVERIFY2(files >= 100, qPrintable(QString::number(files)));
    open();
  }

  void deletingAsksOnceAndTakesAllOfIt() {
    window_->show(Place::cases);
    QTRY_COMPARE_WITH_TIMEOUT(ids().size(), 3, kLong_ms);
    const QString id = idOfMine();
    choose(id);
    QTest::mouseClick(find<QPushButton>("prepareCase"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(window_->place() == Place::prepare, kLong_ms);
    QTRY_VERIFY_WITH_TIMEOUT(workstation().currentCase() && !workstation().isOpening(), kLong_ms);
    QVERIFY(workstation().currentCase()->stored == id.toStdString());
    window_->show(Place::cases);
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
    // It was open, and is not offered to be saved again: what its names may not tell went with it.
    QVERIFY(find<QLabel>("nextStepTitle")->text().contains("is deleted"));
    QVERIFY(!find<QPushButton>("saveCase")->isVisible());
    QVERIFY(!window_->windowTitle().contains("Teaching head"));
  }

  void cleanupTestCase() {
    window_.reset();
    spdlog::drop_all();
  }
};

int main(int argc, char** argv) {
  return test::runInWindow<CasesGuiTest>(argc, argv);
}

#include "cases_gui_test.moc"
