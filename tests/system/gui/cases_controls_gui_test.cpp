// Controls of Cases, each by what it does to the case, the picture or the disk: those that no other
// test goes through on its way. The whole list is in tests/README.md.
#include <QDropEvent>
#include <QFileDialog>
#include <QInputDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMessageBox>
#include <QMimeData>
#include <QPushButton>
#include <QRadioButton>
#include <QScrollBar>
#include <QSignalSpy>
#include <QSpinBox>
#include <QTextBrowser>
#include <QToolButton>
#include <QTreeWidget>
#include <QtTest>

#include "base/crash_report.h"
#include "gui_support.h"
#include "imaging/dicom/ct_writer.h"

using namespace trephine;

namespace {

constexpr Index3 kSize{64, 48, 40};

// Bone in air; each voxel of it has its own HU, so that a part of it is known again.
Volume block() {
  Volume volume;
  volume.geometry.size = kSize;
  volume.geometry.spacing_mm = {2.0, 2.0, 3.0};
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  for (int k = 4; k < kSize[2] - 4; ++k) {
    for (int j = 4; j < kSize[1] - 4; ++j) {
      for (int i = 4; i < kSize[0] - 4; ++i) {
        volume.hu[volume.geometry.indexOf(i, j, k)] = std::int16_t(400 + i + 7 * j + 5 * k);
      }
    }
  }
  return volume;
}

}  // namespace

class CasesControlsGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  QString storage() { return temporary_.filePath("storage"); }
  QString ct() { return temporary_.filePath("ct"); }
  QListWidget* cards() { return find<QListWidget>("cases"); }
  SeriesList* series() { return find<SeriesList>("seriesList"); }
  SliceCanvas* canvas() { return find<SliceCanvas>("sliceCanvas"); }
  void click(const char* button) {
    auto* wanted = find<QAbstractButton>(button);
    const bool ready =
        QTest::qWaitFor([&] { return wanted->isVisible() && wanted->isEnabled(); }, kLong_ms);
    QVERIFY2(ready, button);
    QTest::mouseClick(find<QAbstractButton>(button), Qt::LeftButton);
  }
  // A case that lacks what the exercise looks for is said; that is not what is tested here.
  void closeErrors() {
    rest();
    for (auto* error : window_->findChildren<QMessageBox*>("errorDialog")) error->close();
    rest();
  }
  int rowOf(const std::string& id) {
    for (int i = 0; i < cards()->count(); ++i) {
      if (cards()->item(i)->data(Qt::UserRole).toString().toStdString() == id) return i;
    }
    return -1;
  }
  std::string mine() {
    for (const ListedCase& one : CaseLibrary(toPath(storage())).list()) return one.id;
    return {};
  }
  void chooseMine() {
    window_->show(Place::cases);
    QTRY_VERIFY_WITH_TIMEOUT(rowOf(mine()) >= 0, kLong_ms);
    cards()->setCurrentRow(rowOf(mine()));
  }
  // The series is listed, from that dialog of files.
  void choose(const char* dialog, const QString& path) {
    QTRY_VERIFY(window_->findChild<QFileDialog*>(dialog));
    auto* files = find<QFileDialog>(dialog);
    emit files->fileSelected(path);
    files->close();
    QTRY_VERIFY(!window_->findChild<QFileDialog*>(dialog));
  }
  void waitForSeries() {
    QTRY_VERIFY_WITH_TIMEOUT(find<ImportPage>("importPage")->isVisible(), kLong_ms);
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().import().isWorking() && series()->count() == 1,
                             kLong_ms);
  }
  // What the import makes of the series, once the case is open and saved.
  void import() {
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    click("import");
    QVERIFY(QTest::qWaitFor(
        [&] { return opened.count() == 1 || find<QPushButton>("openCase")->isVisible(); },
        kLong_ms));
    if (opened.isEmpty()) {
      for (QRadioButton* keep : window_->findChildren<QRadioButton*>()) {
        if (keep->objectName().endsWith("_keep") && keep->isVisible()) keep->click();
      }
      click("openCase");
      QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    }
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().currentCase()->stored.empty(), kLong_ms);
    closeErrors();
  }
  static Volume partOf(const Volume& whole, const Index3& from, const Index3& to) {
    Volume part;
    for (int axis = 0; axis < 3; ++axis) part.geometry.size[axis] = to[axis] - from[axis];
    for (int k = from[2]; k < to[2]; ++k) {
      for (int j = from[1]; j < to[1]; ++j) {
        for (int i = from[0]; i < to[0]; ++i) part.hu.push_back(whole.at(i, j, k));
      }
    }
    return part;
  }
  bool opensAs(const Volume& wanted) {
    const Volume& is = *workstation().currentCase()->volume;
    return is.geometry.size == wanted.geometry.size && is.hu == wanted.hu;
  }

 private slots:
  void initTestCase() {
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    const Status made = writeCtSeries(block(), {"Block", "HEAD"}, toPath(ct()));
    QVERIFY2(made.ok(), made.ok() ? "" : made.error().sentence().c_str());
    window_ = newWindow(toPath(storage() + "/sessions"));
    window_->resize(1280, 800);
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QApplication::setActiveWindow(window_.get());
  }

  void everyWayToAFolderListsItsSeries() {
    const auto back = [&] {
      waitForSeries();
      click("closeImport");
      QTRY_VERIFY(cards()->isVisible());
    };
    click("openFolder");
    choose("folderDialog", ct());
    back();
    QVERIFY(workstation().phase() == Workstation::Phase::empty);  // closing opens nothing
    find<QAction>("open")->trigger();
    choose("folderDialog", ct());
    back();
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(ct())});
    QDragEnterEvent enter({100, 100}, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(window_.get(), &enter);
    QVERIFY(enter.isAccepted());
    QDropEvent drop(QPointF(100, 100), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(window_.get(), &drop);
    waitForSeries();
    click("importFolder");  // from the importer itself
    choose("folderDialog", ct());
    waitForSeries();
  }

  void aWindowOfHuChangesThePictureOfTheSeries() {
    QTRY_VERIFY_WITH_TIMEOUT(!canvas()->image().isNull(), kLong_ms);
    QImage before;
    for (const char* name : {"window1", "window2", "window3"}) {
      find<QToolButton>(name)->click();
      QTRY_VERIFY_WITH_TIMEOUT(canvas()->image() != before, kLong_ms);
      before = canvas()->image();
    }
  }

  void aBoxThatIsDrawnOrTypedIsWhatTheCaseIs() {
    const Volume whole = block();
    // Typed: from 9 to 24 of the first axis, counted from one.
    find<QSpinBox>("cropFrom0")->setValue(9);
    find<QSpinBox>("cropTo0")->setValue(24);
    find<QSpinBox>("cropTo2")->setValue(30);
    import();
    QVERIFY(opensAs(partOf(whole, {8, 0, 0}, {24, 48, 30})));
    // Drawn, over the slice.
    window_->show(Place::cases);
    click("anotherSeries");
    waitForSeries();
    QTRY_VERIFY_WITH_TIMEOUT(!canvas()->image().isNull(), kLong_ms);
    const QRect all = canvas()->rect();
    const QPoint from = all.center() - QPoint(40, 30), to = all.center() + QPoint(40, 30);
    const auto drag = [&] {
      QTest::mousePress(canvas(), Qt::LeftButton, {}, from);
      moveTo(*canvas(), (from + to) / 2, Qt::LeftButton);
      moveTo(*canvas(), to, Qt::LeftButton);
      QTest::mouseRelease(canvas(), Qt::LeftButton, {}, to);
    };
    drag();
    QCOMPARE(find<QSpinBox>("cropTo0")->value(), kSize[0]);  // it set the window alone
    click("cropTool");
    drag();
    Index3 low{}, high{};
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = find<QSpinBox>(QString("cropFrom%1").arg(axis))->value() - 1;
      high[axis] = find<QSpinBox>(QString("cropTo%1").arg(axis))->value();
    }
    QVERIFY(low[0] > 0 && high[0] < kSize[0] && low[1] > 0 && high[1] < kSize[1]);
    import();
    QVERIFY(opensAs(partOf(whole, low, high)));
    // And all of it again.
    window_->show(Place::cases);
    click("anotherSeries");
    waitForSeries();
    find<QSpinBox>("cropTo1")->setValue(10);
    click("cropReset");
    import();
    QVERIFY(opensAs(whole));
  }

  void theReportOfACaseIsThatOfItsImport() {
    chooseMine();
    click("caseReport");
    QTRY_VERIFY(window_->findChild<QDialog*>("reportDialog"));
    auto* dialog = find<QDialog>("reportDialog");
    const QString words = dialog->findChild<QTextBrowser*>()->toPlainText();
    QFile page(toQt(toPath(storage()) / "cases" / mine() / "report.html"));
    QVERIFY(page.open(QIODevice::ReadOnly));
    QTextDocument kept;
    kept.setHtml(QString::fromUtf8(page.readAll()));
    QCOMPARE(words, kept.toPlainText());
    QVERIFY(words.contains("64") && words.contains(purposeText()));
    QTest::keyClick(dialog, Qt::Key_Escape);
    QTRY_VERIFY(!window_->findChild<QDialog*>("reportDialog"));
  }

  void aNewNameIsOnTheDiskByButtonAndByKey() {
    const auto nameOnDisk = [&] {
      for (const ListedCase& one : CaseLibrary(toPath(storage())).list()) {
        if (one.id == mine()) return toQt(one.record.name);
      }
      return QString();
    };
    chooseMine();
    for (const char* name : {"By button", "By key"}) {
      cards()->setFocus();
      if (QString(name) == "By key") {
        QTest::keyClick(cards(), Qt::Key_F2);
      } else {
        click("renameCase");
      }
      QTRY_VERIFY(window_->findChild<QInputDialog*>("renameDialog"));
      auto* dialog = find<QInputDialog>("renameDialog");
      dialog->setTextValue(name);
      dialog->accept();
      QTRY_COMPARE_WITH_TIMEOUT(find<QLabel>("caseName")->text(), QString(name), kLong_ms);
      QCOMPARE(nameOnDisk(), QString(name));
      QTRY_VERIFY(!window_->findChild<QInputDialog*>("renameDialog"));
    }
  }

  void trainOfTheNextStepPractisesOnTheOpenCaseAndItsExercisesAreListed() {
    window_->show(Place::cases);
    const std::string sha = workstation().currentCase()->sha256;
    click("nextTrain");
    QTRY_VERIFY(window_->place() == Place::train);
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    find<QAction>("start")->trigger();
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
    pass(0.3);
    find<QAction>("stop")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    QCOMPARE(workstation().currentCase()->sha256, sha);
    closeErrors();
    const QStringList recorded = QDir(storage() + "/sessions").entryList({"*.h5"});
    QCOMPARE(recorded.size(), 1);
    // Of the case that is open, whichever of the cards that is.
    window_->show(Place::cases);
    const std::string id = workstation().currentCase()->stored;
    QTRY_VERIFY_WITH_TIMEOUT(rowOf(id) >= 0, kLong_ms);
    cards()->setCurrentRow(rowOf(id));
    QTRY_VERIFY_WITH_TIMEOUT(find<QPushButton>("caseRecordings")->isEnabled(), kLong_ms);
    click("caseRecordings");
    QVERIFY(window_->place() == Place::review);
    QTRY_COMPARE_WITH_TIMEOUT(find<QTreeWidget>("recordings")->topLevelItemCount(), 1, kLong_ms);
    QCOMPARE(find<QTreeWidget>("recordings")->topLevelItem(0)->text(2),
             toQt(workstation().currentCase()->name));
    click("replay");
    QTRY_VERIFY_WITH_TIMEOUT(find<QLabel>("replayOutcome")->text().contains("bit for bit"),
                             kLong_ms);
    // With another case open, too: its own is kept.
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openPhantom("abdomen");
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    window_->show(Place::cases);
    window_->show(Place::review);
    QTRY_VERIFY_WITH_TIMEOUT(find<QLabel>("replayOutcome")->text().isEmpty(), kLong_ms);
    for (int i = 0; i < 2; ++i) {
      QVERIFY(find<QPushButton>("replay")->isEnabled());
      click("replay");
      QVERIFY(find<QLabel>("replayOutcome")->text().isEmpty());
      QTRY_VERIFY_WITH_TIMEOUT(find<QLabel>("replayOutcome")->text().contains("bit for bit"),
                               kLong_ms);
    }
  }

  void helpOpensAtThePageOfWhatIsBeforeAPersonAndItsLinksLead() {
    const auto shown = [this](Place place) {
      window_->show(place);
      find<QAction>("help")->trigger();
      return find<QTextBrowser>("helpText")->source().fileName();
    };
    QCOMPARE(shown(Place::cases), QString("first-case.md"));
    QVERIFY(find<QTextBrowser>("helpText")->toPlainText().contains("report card"));
    QCOMPARE(shown(Place::train), QString("first-cut.md"));
    QCOMPARE(shown(Place::review), QString("review.md"));
    QVERIFY(shown(Place::prepare).endsWith(".md"));
    auto* text = find<QTextBrowser>("helpText");
    QTest::mouseClick(find<QPushButton>("helpContents"), Qt::LeftButton);
    QCOMPARE(text->source().fileName(), QString("index.md"));
    text->setSource(QUrl("headset.md"));  // as a link does
    QVERIFY2(text->toPlainText().contains("OpenXR"), qPrintable(text->toPlainText().left(80)));
    QTest::keyClick(find<QWidget>("helpPage"), Qt::Key_Escape);
    QTRY_VERIFY(!window_->findChild<QWidget*>("helpPage"));
  }

  void helpOpensInADialogTooAndTakesItsKeys() {
    const std::pair<const char*, const char*> pages[] = {{"devices", "devices.md"},
                                                         {"commission", "commission.md"},
                                                         {"settings", "settings.md"},
                                                         {"headsetSettings", "headset.md"}};
    for (const auto& [action, file] : pages) {
      find<QAction>(action)->trigger();
      QWidget* dialog = nullptr;
      QTRY_VERIFY((dialog = QApplication::activeModalWidget()));
      QTRY_VERIFY(dialog->isActiveWindow());
      QTest::keyClick(dialog, Qt::Key_F1);
      auto* help = find<QWidget>("helpPage");
      QCOMPARE(find<QTextBrowser>("helpText")->source().fileName(), QString(file));
      QTest::keyClick(help, Qt::Key_Escape);
      QTRY_VERIFY(!window_->findChild<QWidget*>("helpPage"));
      QVERIFY2(dialog->isVisible(), action);
      QTest::keyClick(dialog, Qt::Key_Escape);
      QTRY_VERIFY(!QApplication::activeModalWidget());
    }
  }

  void picturesOfHelpAreNoWiderThanTheirWindow() {
    find<QAction>("help")->trigger();
    auto* page = find<QWidget>("helpPage");
    auto* text = find<QTextBrowser>("helpText");
    for (const int width : {860, 500, 1100}) {
      page->resize(width, 600);
      QTRY_COMPARE(page->width(), width);
      rest();
      QVERIFY2(text->toHtml().contains("<img"), "the page has a picture");
      QCOMPARE(text->horizontalScrollBar()->maximum(), 0);
    }
    page->close();
  }

  // As a file manager opens one; and what a crash leaves is offered likewise.
  void aRecordingIsOpenedInReviewWhereverItLies() {
    const auto chosen = [this] {
      const auto* list = find<QTreeWidget>("recordings");
      return list->currentItem() ? list->indexOfTopLevelItem(list->currentItem()) : -1;
    };
    const QString own =
        storage() + "/sessions/" + QDir(storage() + "/sessions").entryList({"*.h5"}).front();
    const QString elsewhere = temporary_.filePath("session-of-another.h5");
    QVERIFY(QFile::copy(own, elsewhere));
    window_->show(Place::cases);
    window_->open(toPath(elsewhere));
    QVERIFY(window_->place() == Place::review);
    QTRY_COMPARE_WITH_TIMEOUT(find<QTreeWidget>("recordings")->topLevelItemCount(), 2, kLong_ms);
    QTRY_COMPARE(chosen(), 0);
    window_->open(toPath(own));  // there already
    QTRY_COMPARE_WITH_TIMEOUT(find<QTreeWidget>("recordings")->topLevelItemCount(), 1, kLong_ms);
    QTRY_COMPARE(chosen(), 0);

    window_->show(Place::cases);
    const QString report = temporary_.filePath("crash-1-2.txt");
    QFile file(report);
    QVERIFY(file.open(QIODevice::WriteOnly));
    file.write("Trephine ended unexpectedly.");
    file.close();
    window_->offerLeftBehind({toPath(report), toPath(elsewhere)});
    auto* box = find<QMessageBox>("leftBehindDialog");
    QVERIFY(box->text().contains("ended unexpectedly"));
    QVERIFY(box->informativeText().contains("nothing was sent"));
    QCOMPARE(box->detailedText(), QString("Trephine ended unexpectedly."));
    QTest::mouseClick(box->findChild<QPushButton*>("openLeftBehind"), Qt::LeftButton);
    QTRY_VERIFY(window_->place() == Place::review);
    QTRY_COMPARE_WITH_TIMEOUT(find<QTreeWidget>("recordings")->topLevelItemCount(), 2, kLong_ms);
    // Nothing to show, nothing said.
    window_->offerLeftBehind({{}, "/nowhere/session.h5"});
    QVERIFY(!window_->findChild<QMessageBox*>("leftBehindDialog"));
  }

  void aDoubleClickOnACardTrainsOnIt() {
    window_->show(Place::cases);
    QTRY_VERIFY_WITH_TIMEOUT(rowOf("abdomen") >= 0, kLong_ms);
    const QPoint at = cards()->visualItemRect(cards()->item(rowOf("abdomen"))).center();
    QTest::mouseClick(cards()->viewport(), Qt::LeftButton, {}, at);
    QTest::mouseDClick(cards()->viewport(), Qt::LeftButton, {}, at);
    QTRY_VERIFY_WITH_TIMEOUT(workstation().currentCase()->built_in && !workstation().isOpening(),
                             kLong_ms);
    QCOMPARE(workstation().exercise()->anatomy, std::string("abdomen"));
    QVERIFY(window_->place() == Place::train);
  }

  void anExerciseAndAFileOfVoxelsAreOpenedByTheirMenus() {
    const std::filesystem::path exercise =
        test::exerciseOn(test::coarseCranium(4), toPath(temporary_.path()), "small");
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    find<QAction>("openScene")->trigger();
    choose("sceneDialog", toQt(exercise));
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    QCOMPARE(workstation().exerciseFile(), exercise);
    QVERIFY(window_->place() == Place::train);
    closeErrors();
    find<QAction>("openFile")->trigger();
    choose("fileDialog", temporary_.filePath("small.mha"));
    waitForSeries();
    import();
    QCOMPARE(workstation().currentCase()->volume->hu.size(), test::coarseCranium(4).hu.size());
  }

  void cleanupTestCase() { window_.reset(); }
};

int main(int argc, char** argv) {
  return test::runInWindow<CasesControlsGuiTest>(argc, argv);
}

#include "cases_controls_gui_test.moc"
