// The window as a person uses it: drop a folder of CT on it, move a threshold, cut with the mouse,
// undo, reset, save. Voxels and pixels are both looked at. The steps build on each other, in order:
// one course of one window, so they stand in one file, of over 500 lines.
#include <QApplication>
#include <QCoreApplication>
#include <QDir>
#include <QDropEvent>
#include <QFileDialog>
#include <QImage>
#include <QLineEdit>
#include <QMessageBox>
#include <QMimeData>
#include <QProgressBar>
#include <QRadioButton>
#include <QSignalSpy>
#include <QStandardPaths>
#include <QStatusBar>
#include <QToolBar>
#include <QtTest>
#include <cmath>
#include <cstdio>

#include "base/system.h"
#include "gui_support.h"
#include "imaging/dicom/ct_writer.h"
#include "render/picture.h"
#include "ui/common/words.h"
#include "volume/phantom.h"
#include "volume/volume_files.h"

using namespace trephine;

namespace {

const char* const kFolderName = "Doe^Jane_1971";  // as identifying as a folder's name can be
const char* const kDescription = "Phantom, cranium";

// Pixels that a person sees as different.
int differentPixels(const Picture& a, const Picture& b) {
  if (a.rgb.size() != b.rgb.size()) return -1;
  int count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      most = std::max(most, std::abs(int(a.rgb[i + c]) - int(b.rgb[i + c])));
    }
    count += most > 16;
  }
  return count;
}

}  // namespace

class GuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  Volume written_;
  Picture opened_;  // the case, before anything was done to it
  std::string sha_before_;

  ViewWidget& view() { return window_->view(); }

  // The view without the tools, which are elsewhere in every picture.
  Picture casePicture() {
    view().setTools({});
    Result<Picture> picture = view().picture();
    return picture ? *picture : Picture{};
  }
  std::string shownSha() {
    if (Session* session = workstation().session()) window_->views().pullChanges(session->grid());
    return volumeSha256(view().shownVolume());
  }

  void drop(const QString& path) {
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(path)});
    const QPoint at(200, 200);
    QDragEnterEvent enter(at, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(window_.get(), &enter);
    QVERIFY(enter.isAccepted());
    QDropEvent dropped(at, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(window_.get(), &dropped);
  }

  // Keys go to the active window, and without a window manager nobody makes it so after a dialog.
  void focusView() {
    if (!view().isVisible()) window_->show(Place::train);
    QApplication::setActiveWindow(window_.get());
    view().setFocus();
    QVERIFY(view().hasFocus());
  }

  void start() {
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    focusView();
    QTest::keyClick(&view(), Qt::Key_F5);
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
  }

  QMessageBox* question(const char* name) {
    return QTest::qWaitFor([&] { return window_->findChild<QMessageBox*>(name); })
               ? find<QMessageBox>(name)
               : nullptr;
  }
  void answer(const char* name, const char* button) {
    QVERIFY2(question(name), name);
    auto* chosen = question(name)->findChild<QPushButton*>(button);
    QVERIFY2(chosen, button);
    QTest::mouseClick(chosen, Qt::LeftButton);
    QTRY_VERIFY(!window_->findChild<QMessageBox*>(name));
  }
  void keepAll(const char* name) {
    QVERIFY2(question(name), name);
    QTest::keyClick(question(name), Qt::Key_Escape);
    QTRY_VERIFY(!window_->findChild<QMessageBox*>(name));
    QApplication::setActiveWindow(window_.get());
  }

  Vec3 tip_mm() { return workstation().session()->state().record.arms[1].patient_position_mm; }
  QImage pauseButton() {
    QWidget* button = window_->findChild<QToolBar*>()->widgetForAction(find<QAction>("pause"));
    return button->grab().toImage();
  }

  void enter(const char* box, const QString& value) {
    auto* spin = find<QSpinBox>(box);
    spin->setFocus();
    auto* line = spin->findChild<QLineEdit*>();
    line->selectAll();
    QTest::keyClicks(line, value);
    QTest::keyClick(line, Qt::Key_Return);
  }

  void keepGrab(const char* name) {
    restRefined();
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/") + name));
  }

 private slots:
  void initTestCase() {
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    written_ = test::coarseCranium(2);
    const QString folder = temporary_.filePath(kFolderName);
    const Status made = writeCtSeries(written_, {kDescription, "HEAD"}, toPath(folder));
    QVERIFY2(made.ok(), made.ok() ? "" : made.error().sentence().c_str());
    window_ = newWindow(toPath(temporary_.filePath("sessions")));
    window_->resize(1280, 800);
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QApplication::setActiveWindow(window_.get());
    QVERIFY(window_->minimumSizeHint().width() <= 1280);
    QVERIFY(window_->minimumSizeHint().height() <= 800);
  }

  void aMissingFolderIsSaidInWords() {
    workstation().openPath("/no/such/folder");
    QTRY_VERIFY_WITH_TIMEOUT(window_->findChild<QMessageBox*>("errorDialog"), kLong_ms);
    auto* dialog = find<QMessageBox>("errorDialog");
    QVERIFY(dialog->isVisible());
    QVERIFY2(dialog->text().length() > 10, qPrintable(dialog->text()));
    QVERIFY2(dialog->informativeText().contains("What to do"),
             qPrintable(dialog->informativeText()));
    QTest::keyClick(dialog, Qt::Key_Return);
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("errorDialog"));
  }

  void aFileThatIsNoExerciseIsSaidInWords() {
    const QString file = temporary_.filePath("scene.json");
    QFile out(file);
    QVERIFY(out.open(QIODevice::WriteOnly) && out.write("{") == 1);
    out.close();
    drop(file);
    QTRY_VERIFY_WITH_TIMEOUT(window_->findChild<QMessageBox*>("errorDialog"), kLong_ms);
    find<QMessageBox>("errorDialog")->close();
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("errorDialog"));
    QVERIFY(!find<QAction>("start")->isEnabled());
  }

  void aMessageStandsAloneInItsLine() {
    QStatusBar& line = *window_->statusBar();
    const auto* hint = find<QLabel>("hint");
    for (const Place place : {Place::prepare, Place::cases, Place::train}) {
      line.showMessage("A message", 60000);
      window_->show(place);
      QCOMPARE(line.currentMessage(), "A message");
      QVERIFY(!hint->isVisible());
      line.clearMessage();
      QCOMPARE(hint->isVisible(), place != Place::cases);
    }
    window_->show(Place::cases);
  }

  void whileAnExerciseIsOpenedItIsTheOneThatIsShown() {
    auto *exercises = find<QComboBox>("scenes"), *controller = find<QComboBox>("controller");
    const QString before = exercises->currentText();
    QCOMPARE(controller->currentText(), QString());
    workstation().openPath(resourceFolder() / "scenes" / "liver.json");
    QVERIFY(workstation().isOpening());
    QVERIFY2(exercises->currentText().contains("liver"), qPrintable(exercises->currentText()));
    QCOMPARE(controller->currentText(), controllerWord(ControllerKind::bounded));
    workstation().cancelOpening();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    QCOMPARE(exercises->currentText(), before);
    QCOMPARE(controller->currentText(), QString());
  }

  void openingCanBeCancelled() {
    QSignalSpy failed(window_.get(), &MainWindow::failed);
    QSignalSpy ended(&workstation(), &Workstation::openingEnded);
    // Opening takes half a second: the button is pressed as soon as it is there.
    auto* cancel = find<QPushButton>("cancelOpening");
    bool pressed = false;
    const auto press = [&] {
      if (pressed || !cancel->isVisible()) return;
      pressed = true;
      QTest::mouseClick(cancel, Qt::LeftButton);
    };
    const auto progress = connect(&workstation(), &Workstation::openingProgressed, this, press);
    prepareBuiltIn("cranium");
    QVERIFY(ended.count() == 1 || ended.wait(kLong_ms));
    disconnect(progress);
    QVERIFY(pressed);
    QCoreApplication::processEvents();
    QVERIFY(!cancel->isVisible());
    QVERIFY(!workstation().currentCase());
    QCOMPARE(failed.count(), 0);  // who cancels needs no dialog
  }

  void aFolderIsOpenedAndDrawn() {
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    QSignalSpy painted(&view(), &ViewWidget::framePainted);
    drop(temporary_.filePath(kFolderName));
    auto* import = find<QPushButton>("import");
    QTRY_VERIFY_WITH_TIMEOUT(import->isEnabled(), kLong_ms);
    QTest::mouseClick(import, Qt::LeftButton);
    auto* open_case = find<QPushButton>("openCase");
    QTRY_VERIFY_WITH_TIMEOUT(open_case->isVisible(), kLong_ms);
    QTest::mouseClick(find<QRadioButton>("choice_FACE_keep"), Qt::LeftButton);
    QTest::mouseClick(open_case, Qt::LeftButton);
    QVERIFY(opened.wait(kLong_ms));
    QVERIFY(!window_->findChild<QMessageBox*>("errorDialog"));
    // Until it is saved under its neutral name.
    QVERIFY(find<QLabel>("caseLabel")->text().startsWith(kDescription));
    painted.clear();
    QTRY_VERIFY_WITH_TIMEOUT(!painted.empty() && painted.back().at(1).toBool(), kLong_ms);

    QVERIFY(view().shownVolume().geometry.size == written_.geometry.size);
    QVERIFY(view().shownVolume().hu == written_.hu);

    restRefined();
    opened_ = casePicture();
    QVERIFY(opened_.width > 0);
    Picture empty = opened_;
    for (std::size_t i = 0; i < empty.rgb.size(); i += 3) {
      std::copy_n(opened_.rgb.begin(), 3, empty.rgb.begin() + std::ptrdiff_t(i));
    }
    QVERIFY2(differentPixels(opened_, empty) > opened_.width * opened_.height / 10,
             "the case is not drawn");
    QVERIFY(!window_->windowTitle().contains("Doe"));
  }

  void whileACaseOpensNothingElseCanBeStartedOrOpened() {
    for (const char* name : {"start", "open", "openFile", "openScene"}) {
      QVERIFY2(find<QAction>(name)->isEnabled(), name);
    }
    QSignalSpy ended(&workstation(), &Workstation::openingEnded);
    prepareBuiltIn("abdomen");
    for (const char* name : {"start", "open", "openFile", "openScene"}) {
      QVERIFY2(!find<QAction>(name)->isEnabled(), name);
    }
    QVERIFY(!find<QComboBox>("scenes")->isEnabled());
    QTest::keyClick(window_.get(), Qt::Key_O, Qt::ControlModifier);
    QVERIFY(!window_->findChild<QFileDialog*>());
    workstation().cancelOpening();
    QVERIFY(ended.count() == 1 || ended.wait(kLong_ms));
    QTRY_VERIFY(find<QAction>("start")->isEnabled());
    QVERIFY(find<QAction>("open")->isEnabled());
    QVERIFY(view().shownVolume().hu == written_.hu);
  }

  void spaceStartsNothing() {
    focusView();
    QTest::keyClick(&view(), Qt::Key_Space);
    rest();
    QVERIFY(workstation().phase() == Workstation::Phase::ready);
  }

  void aThresholdIsSeenAtOnce() {
    showTissues();
    window_->findChild<TissuePanel*>()->select("bone");
    QCOMPARE(find<QSpinBox>("huLow")->value(), 226);
    enter("huLow", "900");
    QCOMPARE(workstation().exercise()->tissues.find("bone")->hu_min, 900);
    const Picture denser = casePicture();
    QVERIFY2(differentPixels(denser, opened_) > 1000, "the picture did not follow the threshold");
    enter("huLow", "226");
    QCOMPARE(differentPixels(casePicture(), opened_), 0);
  }

  void anImpossibleThresholdIsSaidAndNotApplied() {
    auto* problem = find<QLabel>("tissueProblem");
    QVERIFY(!problem->isVisible());
    enter("huLow", "100");  // into the dura
    QVERIFY(problem->isVisible());
    QVERIFY2(problem->text().contains("overlap"), qPrintable(problem->text()));
    QCOMPARE(workstation().exercise()->tissues.find("bone")->hu_min, 226);
    enter("huLow", "226");
    QVERIFY(!problem->isVisible());
  }

  void whatTheArmsCannotShowIsSaidWithWhatWillBeFelt() {
    auto* felt = find<QLabel>("tissueFelt");
    QVERIFY(!felt->isVisible());
    const std::optional<Exercise>& exercise = workstation().exercise();
    const Rig& rig = workstation().rig();
    QVERIFY(rig.arms[0].dynamics.has_value());
    const double most =
        renderableOn(exercise->arms[0], rig.arms[0].dynamics, exercise->rate_hz).k_max;
    auto* box = find<QDoubleSpinBox>("stiffness");
    const double before = box->value();
    box->setValue(1e6);
    QVERIFY(felt->isVisible());
    QVERIFY2(felt->text().contains(QString::number(std::lround(most))), qPrintable(felt->text()));
    QCOMPARE(exercise->tissues.find("bone")->stiffness_N_per_m.value, 1e6);
    keepGrab("felt-1280x800.png");
    box->setValue(before);
    QVERIFY(!felt->isVisible());
  }

  void theMouseCutsWhatTheHandReaches() {
    start();
    QVERIFY(workstation().session());
    sha_before_ = shownSha();
    QCOMPARE(sha_before_, volumeSha256(written_));
    const Picture before = casePicture();
    cut({60, 0});
    const std::uint64_t removed = removedVoxels(*workstation().session());
    QVERIFY2(removed > 20, qPrintable(QString::number(removed)));
    QVERIFY(shownSha() != sha_before_);
    const Picture after = casePicture();
    QVERIFY2(differentPixels(after, before) > 30, "the cut is not seen");

    auto* undo = find<QAction>("undo");
    QTRY_VERIFY(undo->isEnabled());
    keepGrab("cut-1280x800.png");

    // A hand that rested on the way has cut several strokes.
    QApplication::setActiveWindow(window_.get());
    int strokes = 0;
    for (; undo->isEnabled() && strokes < 20; ++strokes) {
      const std::uint64_t standing = removedVoxels(*workstation().session());
      QTest::keyClick(window_.get(), Qt::Key_Z, Qt::ControlModifier);
      QTRY_VERIFY_WITH_TIMEOUT(removedVoxels(*workstation().session()) < standing, 10000);
      const LoopState& state = workstation().session()->state();
      QTRY_COMPARE(undo->isEnabled(), state.can_undo && !state.busy);
    }
    QVERIFY2(strokes >= 1 && strokes < 10, qPrintable(QString::number(strokes)));
    QTRY_COMPARE_WITH_TIMEOUT(shownSha(), sha_before_, 10000);
    QCOMPARE(differentPixels(casePicture(), before), 0);

    for (int i = 0; i < strokes; ++i) {
      QTest::keyClick(window_.get(), Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
      pass(0.2);
    }
    QTRY_COMPARE_WITH_TIMEOUT(removedVoxels(*workstation().session()), removed, 10000);
  }

  void aPauseIsSaidLargeAndNothingMovesInIt() {
    auto* notice = find<QFrame>("pauseNotice");
    QVERIFY(!notice->isVisible());
    const QImage released = pauseButton();
    takeHand(Hand::right);
    pushHand(8);  // on the bone, pressing
    pass(1);
    focusView();
    const Vec3 before_mm = tip_mm();
    const std::uint64_t removed = removedVoxels(*workstation().session());
    QTest::keyClick(&view(), Qt::Key_Space);
    QTRY_VERIFY(workstation().session()->state().paused);
    QVERIFY2(workstation().phase() == Workstation::Phase::running, "Space ends nothing");
    QTRY_VERIFY(notice->isVisible());
    QCOMPARE(find<QLabel>("pauseNoticeTitle")->text(), "PAUSED");
    QVERIFY(find<QAction>("pause")->isChecked());
    const QImage pressed = pauseButton();
    const QPoint corner(pressed.width() / 2, 4);  // beside its icon and text
    const QColor on = pressed.pixelColor(corner), off = released.pixelColor(corner);
    QVERIFY2(std::abs(on.red() - off.red()) + std::abs(on.green() - off.green()) +
                     std::abs(on.blue() - off.blue()) >
                 90,
             "the button looks as if it were not pressed");
    pass(0.3);
    const std::uint32_t second = workstation().session()->state().seconds;
    const QString clock = find<QLabel>("rewindTime")->text();
    pushHand(2);
    dragHand({0, 60});
    QTest::keyClick(&view(), Qt::Key_PageDown);
    keepGrab("paused-1280x800.png");
    QVERIFY2(glm::distance(tip_mm(), before_mm) < 1.0, "the tool moved in a pause");
    QCOMPARE(removedVoxels(*workstation().session()), removed);
    QCOMPARE(workstation().session()->state().seconds, second);
    QCOMPARE(find<QLabel>("rewindTime")->text(), clock);

    QTest::mouseClick(find<QPushButton>("goOn"), Qt::LeftButton);
    QTRY_VERIFY(!workstation().session()->state().paused);
    QTRY_VERIFY(!notice->isVisible());
    QVERIFY(view().hasFocus());
    pushHand(-20);
    QTRY_VERIFY(glm::distance(tip_mm(), before_mm) > 3.0);
    QTRY_VERIFY(workstation().session()->state().seconds > second);
    pass(0.5);  // the stroke ends
  }

  void resetPutsBackWhatBothHandsCut() {
    cut({-60, 0}, Hand::left);
    const LoopState state = workstation().session()->state();
    for (int arm : {0, 1}) {
      std::uint64_t removed = 0;
      for (std::uint64_t voxels : state.removed[arm]) removed += voxels;
      QVERIFY2(removed > 0, qPrintable(QString("arm %1 removed nothing").arg(arm)));
    }
    QTest::keyClick(window_.get(), Qt::Key_R, Qt::ControlModifier);
    keepAll("resetQuestion");
    pass(0.3);
    QVERIFY2(shownSha() != sha_before_, "put back without a yes");
    QTest::keyClick(window_.get(), Qt::Key_R, Qt::ControlModifier);
    answer("resetQuestion", "goOnAnyway");
    QTRY_COMPARE_WITH_TIMEOUT(shownSha(), sha_before_, 10000);
    QApplication::setActiveWindow(window_.get());
    QCOMPARE(removedVoxels(*workstation().session()), std::uint64_t(0));
  }

  void aRewindPutsBackTissueAndCountsAndCuttingGoesOn() {
    auto* slider = find<QSlider>("rewindSlider");
    QTRY_VERIFY(slider->isEnabled());
    pass(1.5);  // a whole second after the reset
    const std::uint32_t before_cut = workstation().session()->state().seconds;
    cut({60, 10});
    QVERIFY(removedVoxels(*workstation().session()) > 20);
    pass(1.5);
    QVERIFY(find<QAction>("undo")->isEnabled());
    QVERIFY(!find<QAction>("redo")->isEnabled());
    keepGrab("before-rewind-1280x800.png");

    QApplication::setActiveWindow(window_.get());
    slider->setFocus();
    while (slider->value() > int(before_cut)) QTest::keyClick(slider, Qt::Key_Left);
    QVERIFY(window_->grab().save(TREPHINE_ARTEFACTS "/choosing-1280x800.png"));
    const auto back = [&] { return window_->statusBar()->currentMessage().startsWith("Back at "); };
    QTRY_VERIFY_WITH_TIMEOUT(back(), 10000);
    QVERIFY2(window_->statusBar()->currentMessage().startsWith("Back at " + timeWords(before_cut)),
             qPrintable(window_->statusBar()->currentMessage()));
    QCOMPARE(removedVoxels(*workstation().session()), std::uint64_t(0));
    QCOMPARE(shownSha(), sha_before_);
    QVERIFY(!find<QAction>("redo")->isEnabled());
    QVERIFY(slider->hasFocus());
    keepGrab("rewound-1280x800.png");
    QCOMPARE(shownSha(), sha_before_);

    cut({-60, -10});
    QVERIFY(removedVoxels(*workstation().session()) > 20);
    window_->statusBar()->clearMessage();
    QTest::keyClick(window_.get(), Qt::Key_Backspace, Qt::ControlModifier);
    QTRY_VERIFY_WITH_TIMEOUT(back(), 10000);
    QTRY_VERIFY(slider->isEnabled());
  }

  void whatIsSavedIsWhatIsShown() {
    cut({-60, 20});
    QSignalSpy saved(&workstation(), &Workstation::saved);
    const QString volume_file = temporary_.filePath("carved.nii.gz");
    window_->saveVolume(volume_file);
    QVERIFY(saved.wait(kLong_ms));
    const Result<Volume> volume = readVolume(toPath(volume_file));
    QVERIFY(volume.ok());
    QVERIFY(volume->hu == view().shownVolume().hu);
    QVERIFY(volume->hu != written_.hu);

    const QString picture_file = TREPHINE_ARTEFACTS "/view-1280x800.png";
    window_->savePicture(picture_file);
    QVERIFY(saved.wait(kLong_ms));
    const QImage file = QImage(picture_file).convertToFormat(QImage::Format_RGB888);
    const Picture shown = casePicture();
    QCOMPARE(file.width(), shown.width);
    QVERIFY2(file.height() > shown.height, "below it is said what it is for");
    Picture picture{shown.width, shown.height, {}};
    for (int y = 0; y < shown.height; ++y) {
      picture.rgb.insert(picture.rgb.end(), file.constScanLine(y),
                         file.constScanLine(y) + 3 * file.width());
    }
    QVERIFY(differentPixels(picture, shown) < 0.05 * shown.width * shown.height);  // but for tools
    QVERIFY(differentPixels(picture, Picture{shown.width, shown.height,
                                             std::vector<unsigned char>(shown.rgb.size())}) >
            0.1 * shown.width * shown.height);
  }

  void aStoppedExerciseLeavesARecordingWithoutANameOfTheSource() {
    window_->resize(1920, 1080);
    keepGrab("cut-1920x1080.png");
    focusView();
    QTest::keyClick(&view(), Qt::Key_Period, Qt::ControlModifier);
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    const QStringList files = QDir(temporary_.filePath("sessions")).entryList(QDir::Files);
    QCOMPARE(files.size(), 1);
    QVERIFY2(files.front().startsWith("session-"), qPrintable(files.front()));
    QFile recording(temporary_.filePath("sessions/" + files.front()));
    QVERIFY(recording.open(QIODevice::ReadOnly));
    const QByteArray bytes = recording.readAll();
    QVERIFY(bytes.size() > 1000);
    QVERIFY(!bytes.contains(kFolderName));
    QVERIFY(!bytes.contains(temporary_.path().toUtf8()));
  }

  void cutsOfWhichAVolumeWasWantedAreNotLostWithoutAQuestion() {
    QVERIFY(shownSha() != sha_before_);  // what was cut stays on the screen
    const std::string cut_sha = shownSha();
    find<QAction>("saveVolume")->trigger();
    QTRY_VERIFY(window_->findChild<QFileDialog*>("saveDialog"));
    find<QFileDialog>("saveDialog")->reject();
    rest();
    focusView();
    QTest::keyClick(&view(), Qt::Key_F5);
    keepAll("cutsQuestion");
    QTest::keyClick(window_.get(), Qt::Key_R, Qt::ControlModifier);
    keepAll("cutsQuestion");
    window_->show(Place::cases);
    prepareBuiltIn("abdomen");
    keepAll("cutsQuestion");
    auto* exercises = find<QComboBox>("scenes");
    emit exercises->activated((exercises->currentIndex() + 1) % exercises->count());
    keepAll("cutsQuestion");
    window_->close();
    keepAll("cutsQuestion");
    QVERIFY(window_->isVisible());
    rest();
    QVERIFY(workstation().phase() == Workstation::Phase::ready && !workstation().isOpening());
    QCOMPARE(shownSha(), cut_sha);
  }

  void onceTheCutsAreSavedTheNextExerciseStartsFromTheWholeCase() {
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    const std::string cut_sha = shownSha();
    const QString file = temporary_.filePath("kept.nii.gz");
    focusView();
    QTest::keyClick(&view(), Qt::Key_F5);
    answer("cutsQuestion", "saveFirst");
    QTRY_VERIFY(window_->findChild<QFileDialog*>("saveDialog"));
    auto* dialog = find<QFileDialog>("saveDialog");
    dialog->findChild<QLineEdit*>("fileNameEdit")->setText(file);
    static_cast<QDialog*>(dialog)->accept();
    QVERIFY2(started.count() == 1 || started.wait(kLong_ms), "it goes on once they are saved");
    const Result<Volume> kept = readVolume(toPath(file));
    QVERIFY2(kept.ok(), kept.ok() ? "" : kept.error().sentence().c_str());
    QCOMPARE(volumeSha256(*kept), cut_sha);
    QVERIFY(workstation().session());
    QCOMPARE(shownSha(), sha_before_);
  }

  void closingARunningExerciseIsAskedOnce() {
    QTRY_VERIFY(!workstation().session()->state().paused);
    window_->close();
    QTRY_VERIFY2(workstation().session()->state().paused, "nobody cuts behind the question");
    keepAll("closeQuestion");
    QVERIFY(window_->isVisible());
    QVERIFY(workstation().session());
    QTRY_VERIFY(!workstation().session()->state().paused);
    window_->close();
    answer("closeQuestion", "goOnAnyway");
    QTRY_VERIFY(!window_->isVisible());
  }

  void cleanupTestCase() { window_.reset(); }
};

int main(int argc, char** argv) {
  return test::runInWindow<GuiTest>(argc, argv);
}

#include "gui_test.moc"
