// Training without arms and without a manual: the card says what to do, the keys alone are enough,
// both hands are reached, what is locked stays, and the result says what was done.
#include <QAbstractItemView>
#include <QComboBox>
#include <QFileDialog>
#include <QFontDatabase>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMessageBox>
#include <QPushButton>
#include <QRegularExpression>
#include <QSignalSpy>
#include <QStandardItemModel>
#include <QStatusBar>
#include <QTextDocument>
#include <QToolBar>
#include <QToolButton>
#include <QtTest>

#include "base/codes.h"
#include "exchange/exercise_folder.h"
#include "tissue/tissue_edits.h"
#include "train_support.h"
#include "ui/common/words.h"
#include "ui/train/trace_view.h"

using namespace trephine;

// An arm that no hand pushes holds this against tissue by its own friction, 0.26 N.
constexpr double kByFriction_N = 0.3;

class TrainGuiTest : public test::TrainTest {
  Q_OBJECT

  std::filesystem::path exercise_;

 private slots:
  void initTestCase() {
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    exercise_ = test::exerciseOn(test::coarseCranium(2), toPath(temporary_.path()), "coarse");
  }
  void init() { open(); }
  void cleanup() { window_.reset(); }

  void beforeTheStartTheCardSaysWhatToDoWithWhichHand() {
    openExercise(exercise_);
    QVERIFY(window_->place() == Place::train);
    QTRY_VERIFY(find<QWidget>("startCard")->isVisible());
    const CardText* card = cardFor(*workstation().exercise(), "en");
    QVERIFY(card);
    QCOMPARE(find<QLabel>("startCardGoal")->text(), toQt(card->goal));
    QVERIFY(find<QLabel>("startCardSteps")->text().contains(toQt(card->steps.front())));
    for (const char* list : {"startCardSteps", "exerciseSteps"}) {  // a list is read as one
      QVERIFY(!find<QLabel>(list)->text().contains('<') ||
              find<QLabel>(list)->textFormat() == Qt::RichText);
    }
    QCOMPARE(find<QLabel>("startCardHands")->text(), toQt(card->hands));
    QVERIFY(window_->grab().save(TREPHINE_ARTEFACTS "/train-card.png"));
    test::prefer([](Preferences& of) { of.language = Language::zh_TW; });
    window_->show(Place::prepare);
    QVERIFY(!find<QWidget>("startCard")->isVisible());
    window_->show(Place::train);
    QCOMPARE(find<QLabel>("startCardGoal")->text(),
             toQt(cardFor(*workstation().exercise(), "zh_TW")->goal));
    QVERIFY2(!QFontDatabase::families(QFontDatabase::TraditionalChinese).isEmpty(),
             "its characters would be boxes: fonts-droid-fallback");
    QVERIFY(window_->grab().save(TREPHINE_ARTEFACTS "/train-card-zh.png"));
  }

  void theWholePathGoesByKeysAlone() {
    // Cases: the built-in cranium's card, Return.
    window_->show(Place::cases);
    auto* cards = find<QListWidget>("cases");
    QTRY_VERIFY_WITH_TIMEOUT(cards->count() >= 2, kLong_ms);
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    cards->setFocus();
    key(Qt::Key_Home);
    key(Qt::Key_Return);
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    QVERIFY(window_->place() == Place::train);
    QTRY_VERIFY_WITH_TIMEOUT(view().canDraw().ok(), kLong_ms);
    key(Qt::Key_F5);
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
    QTRY_VERIFY(find<QFrame>("readyNotice")->isVisible());
    QVERIFY(view().hasFocus());
    key(Qt::Key_Right);
    key(Qt::Key_PageDown, Qt::NoModifier, 10);
    pass(1.5);
    key(Qt::Key_Right, Qt::NoModifier, 6);
    pass(0.5);
    key(Qt::Key_PageUp, Qt::NoModifier, 15);
    pass(1.5);
    QVERIFY(!find<QFrame>("readyNotice")->isVisible());
    const std::uint64_t removed = removedVoxels(*workstation().session());
    QVERIFY2(removed > 20, qPrintable(QString::number(removed)));
    QTRY_VERIFY(find<QLabel>("exerciseRemoved")->text().contains("Bone"));
    key(Qt::Key_Z, Qt::ControlModifier);
    QTRY_VERIFY_WITH_TIMEOUT(removedVoxels(*workstation().session()) < removed, 10000);
    const auto says = [&](const char* words) {
      return window_->statusBar()->currentMessage().startsWith(words);
    };
    QTRY_VERIFY(says("Brought back: Right arm"));
    QTRY_VERIFY(find<QAction>("redo")->isEnabled());
    key(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
    QTRY_VERIFY_WITH_TIMEOUT(removedVoxels(*workstation().session()) == removed, 10000);
    QTRY_VERIFY(says("Cut again: Right arm"));
    QSignalSpy saved(&workstation(), &Workstation::saved);
    key(Qt::Key_S, Qt::ControlModifier);
    QTRY_VERIFY(window_->findChild<QFileDialog*>("saveDialog"));
    auto* name = find<QFileDialog>("saveDialog")->findChild<QLineEdit*>("fileNameEdit");
    name->selectAll();
    QTest::keyClicks(name, temporary_.filePath("by-keys.mha"));
    QTest::keyClick(name, Qt::Key_Return);
    QVERIFY(saved.count() == 1 || saved.wait(kLong_ms));
    QVERIFY(QFile::exists(temporary_.filePath("by-keys.mha")));
    QApplication::setActiveWindow(window_.get());
    view().setFocus();
    key(Qt::Key_Period, Qt::ControlModifier);
    QTRY_VERIFY_WITH_TIMEOUT(find<QWidget>("resultPage")->isVisible(), kLong_ms);
    QVERIFY(find<QLabel>("resultRows")->text().contains("Bone"));
    QCOMPARE(boneIn("exerciseRemoved"), boneIn("resultRows"));
    QVERIFY(window_->grab().save(TREPHINE_ARTEFACTS "/train-result.png"));
  }

  // How much bone a label says was removed, with its unit.
  QString boneIn(const char* label) {
    QTextDocument text;
    text.setHtml(find<QLabel>(label)->text());
    const QRegularExpression bone("Bone\\s+([0-9.]+\\s*\\S+)");
    const QString words = bone.match(text.toPlainText()).captured(1);
    return words.isEmpty() ? QString("%1 has no bone").arg(label) : words;
  }

  void whileItRunsForceAndEnergyAreTraced() {
    openExercise(exercise_);
    startTraining();
    takeHand(Hand::right);
    pushHand(8);
    auto* force = window_->findChild<TraceView*>("rightForceTrace");
    QVERIFY(force);
    const auto strongest = [&] {
      double most = 0.0;
      for (const TraceView::Sample& s : force->samples()) most = std::max(most, s.value);
      return most;
    };
    QTRY_VERIFY_WITH_TIMEOUT(strongest() > 0.5, 15000);
    QVERIFY(force->samples().back().time_s - force->samples().front().time_s <
            3.0 * TraceView::kShown_s);
    QVERIFY(window_->findChild<TraceView*>("rightEnergyTrace")->samples().size() > 10);
    QVERIFY(find<QLabel>("pushWords")->text().contains("N"));
    QVERIFY(window_->grab().save(TREPHINE_ARTEFACTS "/train-running.png"));
    // The other hand stays where it is, with no more force than the arm's own friction holds.
    takeHand(Hand::left);
    QTRY_VERIFY_WITH_TIMEOUT(
        glm::length(workstation().session()->state().record.arms[1].sent_N) < kByFriction_N, 10000);
    stop();
  }

  void aHandsToolIsChangedSeenAndCutsItsOwnHole() {
    openExercise(exercise_);
    auto* change = find<QAction>("changeTool");
    QVERIFY(!change->isEnabled());
    startTraining();
    takeHand(Hand::right);
    Session& session = *workstation().session();
    auto *named = find<QLabel>("handTool"), *waits = find<QLabel>("handToolWaits");
    auto* chosen = find<QComboBox>("rightTool");
    QTRY_COMPARE(named->text(), "blade, 16 mm");
    QCOMPARE(chosen->currentText(), "blade, 16 mm");
    const auto inHand = [&] { return session.state().tools[1]; };
    // Voxels that a press of the tool in hand takes, in one place.
    const auto hole = [&] {
      pushHand(12);
      pass(2.5);
      pushHand(-12);
      pass(1.5);
      const std::uint64_t voxels = removedVoxels(session);
      find<QAction>("undo")->trigger();
      pass(0.5);
      return voxels;
    };
    const std::uint64_t by_blade = hole();
    QTRY_COMPARE(removedVoxels(session), 0u);
    restRefined();
    const QImage with_blade = view().grabFramebuffer();
    // By its key to the last of three: the picture changes where the tool is.
    key(Qt::Key_T, Qt::ControlModifier);
    QTRY_COMPARE(inHand(), 1);
    QTRY_COMPARE(named->text(), "craniotome, 2.4 mm");
    key(Qt::Key_T, Qt::ControlModifier);
    QTRY_COMPARE(inHand(), 2);
    QTRY_COMPARE(named->text(), "burr, 6 mm");
    // Each part of the window shows it at its own pace.
    QTRY_COMPARE(chosen->currentText(), "burr, 6 mm");
    QTRY_VERIFY(find<QLabel>("exerciseTools")->text().contains("Right arm: burr, 6 mm"));
    QVERIFY(find<QLabel>("exerciseTools")->text().contains("Left arm: blade, 16 mm"));
    restRefined();
    const QImage with_burr = view().grabFramebuffer();
    QCOMPARE(with_burr.size(), with_blade.size());
    int other = 0;
    for (int y = 0; y < with_burr.height(); ++y) {
      for (int x = 0; x < with_burr.width(); ++x) {
        other += qAbs(qGray(with_burr.pixel(x, y)) - qGray(with_blade.pixel(x, y))) > 24;
      }
    }
    QVERIFY2(other > 150, qPrintable(QString::number(other)));
    const std::uint64_t by_burr = hole();
    QVERIFY2(by_blade > 0 && by_burr > by_blade + by_blade / 2,
             qPrintable(QString("blade %1, burr %2").arg(by_blade).arg(by_burr)));
    // In the tissue it waits, and says so; out of it, it comes.
    const auto touches = [&] { return session.state().record.arms[1].tissue_class >= 0; };
    pushHand(6);
    QTRY_VERIFY_WITH_TIMEOUT(removedVoxels(session) > 10, 10000);
    find<QAction>("pause")->trigger();  // it would soon be through
    QTRY_VERIFY(session.state().paused);
    QVERIFY(touches());
    // The slices show where it was cut.
    QTRY_VERIFY(glm::distance(window_->views().point_mm(),
                              session.state().record.arms[1].proxy_position_mm) < 3.0);
    QVERIFY(!waits->isVisible());
    key(Qt::Key_T, Qt::ControlModifier);
    QTRY_VERIFY(waits->isVisible());
    QVERIFY(find<QLabel>("rightToolWaits")->isVisible());
    QVERIFY(!find<QLabel>("leftToolWaits")->isVisible());
    QVERIFY(window_->grab().save(TREPHINE_ARTEFACTS "/train-tool-waits.png"));
    QCOMPARE(inHand(), 2);
    pushHand(-6);
    QCOMPARE(find<QLabel>("pushWords")->text(), "rests");
    find<QAction>("pause")->trigger();
    QTRY_COMPARE_WITH_TIMEOUT(inHand(), 0, 10000);
    QTRY_VERIFY(!waits->isVisible());
    QTRY_COMPARE(named->text(), "blade, 16 mm");
    // On the arm's card by name.
    QTRY_COMPARE(chosen->currentText(), "blade, 16 mm");
    chosen->setFocus();
    chosen->showPopup();
    QTest::keyClick(chosen->view(), Qt::Key_Down);
    QTest::keyClick(chosen->view(), Qt::Key_Return);
    QTRY_COMPARE(inHand(), 1);
    QVERIFY(window_->focusWidget() == &view());
    stop();
    QVERIFY(!change->isEnabled());
  }

  void tabGivesTheMouseTheOtherHandAndTheFirstStaysInTheTissueWithoutAHandsForce() {
    openExercise(exercise_);
    startTraining();
    const auto force_N = [&](std::size_t hand) { return glm::length(arm(hand).sent_N); };
    takeHand(Hand::right);
    pushHand(5);
    QTRY_VERIFY_WITH_TIMEOUT(arm(1).tissue_class >= 0 && force_N(1) > 0.4, 10000);
    pass(1);
    QTRY_VERIFY(find<QLabel>("handTouches")->text().startsWith("touches "));
    const Vec3 other_mm = arm(0).proxy_position_mm;
    find<QAction>("otherHand")->trigger();
    QTRY_COMPARE(find<QLabel>("activeHand")->text(), "Left hand");
    QTRY_VERIFY_WITH_TIMEOUT(force_N(1) < kByFriction_N, 10000);
    const Vec3 stays_mm = arm(1).proxy_position_mm;
    pass(0.5);
    // The one that is taken stays, too, until the pointer moves.
    QVERIFY(glm::distance(arm(0).proxy_position_mm, other_mm) < 0.5);
    pointAt(view().rect().center() + QPoint(40, 0));
    QTRY_VERIFY_WITH_TIMEOUT(glm::distance(arm(0).proxy_position_mm, other_mm) > 2.0, 10000);
    QTRY_COMPARE(find<QLabel>("handTouches")->text(), "touches nothing");
    QVERIFY(glm::distance(arm(1).proxy_position_mm, stays_mm) < 0.5);
    // Taken again it presses on where it is; led elsewhere it comes out first.
    find<QAction>("otherHand")->trigger();
    pushHand(3);
    QTRY_VERIFY_WITH_TIMEOUT(force_N(1) > 0.2, 10000);
    QVERIFY(glm::distance(arm(1).proxy_position_mm, stays_mm) < 3.0);
    pointAt(view().rect().center() + QPoint(90, 0));
    QCOMPARE(workstation().session()->handPush_N(1), 0.0);
    QTRY_VERIFY_WITH_TIMEOUT(arm(1).tissue_class < 0, 10000);
    stop();
  }

  void shiftAndArrowsTiltTheTool() {
    openExercise(exercise_);
    startTraining();
    takeHand(Hand::right);
    pass(0.5);
    const Quat before = arm(1).proxy_orientation;
    const auto turned = [&] {
      return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(before, arm(1).proxy_orientation))));
    };
    key(Qt::Key_Left, Qt::ShiftModifier, 5);
    QTRY_VERIFY_WITH_TIMEOUT(turned() > 0.1, 10000);
    key(Qt::Key_Right, Qt::ShiftModifier, 5);
    QTRY_VERIFY_WITH_TIMEOUT(turned() < 0.02, 10000);
    stop();
  }

  void aClutchTakesTheForceAwayAndLeavesTheToolsAsTheyAreHeld() {
    openExercise(exercise_);
    startTraining();
    Session& session = *workstation().session();
    auto* clutch = find<QAction>("clutch");
    takeHand(Hand::right);
    pushHand(5);
    QTRY_VERIFY_WITH_TIMEOUT(glm::length(arm(1).sent_N) > 0.4, 10000);
    find<QAction>("otherHand")->trigger();  // it rests in the tissue
    QTRY_VERIFY_WITH_TIMEOUT(glm::length(arm(1).sent_N) < kByFriction_N, 10000);
    // Its map would turn with the view.
    const Vec3 ahead = session.state().maps[1].rotation * Vec3(0, 0, -1);
    QVERIFY(glm::dot(ahead, view().camera().forward()) < 0.99);
    const std::array<ArmRecord, 2> before{arm(0), arm(1)};
    view().setFocus();
    key(Qt::Key_K, Qt::ControlModifier);
    QVERIFY(clutch->isChecked());
    QTRY_VERIFY(arm(0).tool_state & kToolClutched);
    QTRY_VERIFY(arm(1).tool_state & kToolClutched);
    QTRY_VERIFY(find<QLabel>("forceNoticeWhy")->isVisible());
    QVERIFY(find<QLabel>("forceNoticeWhy")->text().contains("Clutched"));
    key(Qt::Key_K, Qt::ControlModifier);
    QVERIFY(!clutch->isChecked());
    for (std::size_t i = 0; i < 2; ++i) {
      QTRY_VERIFY(!(arm(i).tool_state & kToolClutched));
      pass(0.5);
      const double moved_mm = glm::distance(arm(i).proxy_position_mm, before[i].proxy_position_mm);
      QVERIFY2(moved_mm < 0.3, qPrintable(QString::number(moved_mm)));
      QVERIFY(std::abs(glm::dot(arm(i).proxy_orientation, before[i].proxy_orientation)) > 0.99999);
    }
    QVERIFY(glm::length(arm(1).sent_N) < 0.05);

    takeHand(Hand::right);
    pushHand(5);
    QTRY_VERIFY_WITH_TIMEOUT(glm::length(arm(1).sent_N) > 0.3, 10000);
    view().setFocus();
    key(Qt::Key_K, Qt::ControlModifier);
    QTRY_VERIFY(glm::length(arm(1).sent_N) < 0.01);
    const Vec3 tool = arm(1).proxy_position_mm;
    pushHand(-5);
    pass(0.5);
    QVERIFY2(glm::distance(arm(1).proxy_position_mm, tool) < 0.5, "its tool stays");
    stop();
    QVERIFY(!clutch->isChecked());
  }

  void theRailStaysWhereItIsFromWorkspaceToWorkspace() {
    auto* button = find<QToolButton>("rail1");
    const auto place = [&] { return button->mapTo(window_.get(), QPoint()); };
    window_->show(Place::train);
    QVERIFY(find<QToolBar>("toolBar")->isVisible());
    rest();
    const QPoint in_train = place();
    for (Place other : {Place::cases, Place::review, Place::prepare}) {
      window_->show(other);
      rest();
      QCOMPARE(place(), in_train);
    }
    QVERIFY(find<QToolBar>("toolBar")->isVisible());
    window_->show(Place::cases);
    QVERIFY(!find<QToolBar>("toolBar")->isVisible());
  }

  void theChosenControllerIsInForceAndInTheRecording() {
    openExercise(exercise_);
    startTraining();
    auto* controller = find<QComboBox>("controller");
    controller->setCurrentIndex(controller->findData(int(ControllerKind::seed)));
    emit controller->activated(controller->currentIndex());
    QTRY_VERIFY(workstation().session()->state().controller == ControllerKind::seed);
    stop();
    QVERIFY(workstation().exercise()->controller == ControllerKind::seed);
  }

  void theBarOfSecondsMarksStrokesAndSaysWhereOneIsAfterGoingBack() {
    openExercise(exercise_);
    startTraining();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().session()->state().seconds >= 2, 20000);
    cut({40, 0});
    Session& session = *workstation().session();
    QTRY_VERIFY(!session.strokes().empty());
    QCOMPARE(session.strokes().back().arm, 1);
    const double second = session.strokes().back().second;
    QVERIFY(second >= 2.0 && second <= double(session.state().seconds) + 1.0);
    auto* slider = find<QSlider>("rewindSlider");
    const auto marked = [&] {
      const QImage picture = slider->grab().toImage();
      int pixels = 0;
      for (int y = picture.height() - 6; y < picture.height(); ++y) {
        for (int x = 0; x < picture.width(); ++x) {
          pixels += picture.pixelColor(x, y) == colours::kRightArm;
        }
      }
      return pixels;
    };
    QTRY_VERIFY(marked() > 0);
    QVERIFY(window_->grab().save(TREPHINE_ARTEFACTS "/train-strokes.png"));
    slider->setFocus();
    key(Qt::Key_Home);
    QTRY_VERIFY_WITH_TIMEOUT(removedVoxels(session) == 0, 20000);
    QTRY_VERIFY_WITH_TIMEOUT(find<QLabel>("rewindTime")->text().endsWith("tissue of 0:00"), 10000);
    QCOMPARE(marked(), 0);
    QVERIFY(window_->grab().save(TREPHINE_ARTEFACTS "/train-gone-back.png"));
    stop();
  }

  void fromTheResultOneLooksAtItTriesAgainOrSeesItReplayed() {
    showResultOf(exercise_);
    auto* result = find<QWidget>("resultPage");
    QTest::mouseClick(find<QPushButton>("resultLook"), Qt::LeftButton);
    QVERIFY(!result->isVisible());
    QVERIFY2(workstation().carved(), "the tissue stays as it was left");
    // Again: from whole tissue, without a question, as the recording has the cuts.
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    find<QAction>("start")->trigger();
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
    QCOMPARE(removedVoxels(*workstation().session()), 0u);
    stop();
    QTRY_VERIFY_WITH_TIMEOUT(result->isVisible(), kLong_ms);
    QTest::mouseClick(find<QPushButton>("resultReplay"), Qt::LeftButton);
    QVERIFY(window_->place() == Place::review);
    QTRY_VERIFY_WITH_TIMEOUT(find<QLabel>("replayOutcome")->text().contains("bit for bit"),
                             kLong_ms);
  }

  void theArmsOfThisPlaceGiveNoMoreThanTheSettingsSay() {
    openExercise(exercise_);
    test::prefer([](Preferences& of) { of.arms_most_N = 1.0; });
    startTraining();
    for (const ExerciseArm& of : workstation().session()->exercise().arms)
      QCOMPARE(of.max_force_N, 1.0);
    takeHand(Hand::right);
    pushHand(15);
    double most = 0.0;
    for (int n = 0; n < 150; ++n) {
      pass(0.02);
      most = std::max(most, glm::length(arm(1).sent_N));
    }
    QVERIFY2(most > 0.2 && most <= 1.0001, qPrintable(QString::number(most)));
    stop();
    const Exercise& exercise = *workstation().exercise();
    QCOMPARE(exercise.arms[0].max_force_N, 3.3);  // the exercise itself is as it was
    test::prefer([](Preferences& of) { of.arms_most_N = 40.0; });
  }

  void whatIsLockedStaysAndThePinUnlocksIt() {
    window_.reset();
    Policy policy;
    policy.locks = {Lock::controller, Lock::tissues, Lock::rate};
    const Result<Pin> pin = makePin("4711");
    QVERIFY(pin.ok());
    policy.pin = *pin;
    open(policy);
    QVERIFY(find<QLabel>("locked")->isVisible());
    // An exercise of one's own, by path: refused.
    QSignalSpy failed(window_.get(), &MainWindow::failed);
    window_->open(exercise_);
    QTRY_COMPARE(failed.count(), 1);
    QVERIFY(!workstation().currentCase());
    window_->findChild<QMessageBox*>("errorDialog")->close();
    rest();
    // The product's own is open to all, but not to change.
    openExercise(resourceFolder() / "scenes" / "cranium.json");
    const TissueSet tissues = workstation().exercise()->tissues;
    QVERIFY(!find<QComboBox>("controller")->isEnabled());
    showTissues();
    window_->findChild<TissuePanel*>()->select("bone");
    QVERIFY(!find<QSpinBox>("huLow")->isEnabled());
    QVERIFY(find<QLabel>("tissuesLocked")->isVisible());
    TissueSet others = tissues;
    others.tissues.back().hu_max += 10;
    workstation().setTissues(others);
    workstation().setController(ControllerKind::off);
    QVERIFY(workstation().exercise()->tissues == tissues);
    QVERIFY(workstation().exercise()->controller == ControllerKind::bounded);
    for (QMessageBox* box : window_->findChildren<QMessageBox*>("errorDialog")) box->close();
    rest();
    // The PIN: a wrong one changes nothing.
    for (const char* text : {"0000", "4711"}) {
      if (!window_->findChild<QDialog*>("unlockDialog")) find<QAction>("unlockTeaching")->trigger();
      QTRY_VERIFY(window_->findChild<QDialog*>("unlockDialog"));
      find<QLineEdit>("pin")->setText(text);
      QTest::mouseClick(find<QPushButton>("unlock"), Qt::LeftButton);
      if (std::string(text) == "0000") {
        QTRY_VERIFY_WITH_TIMEOUT(find<QLabel>("pinSaid")->text().contains("not the PIN"), 20000);
        QVERIFY(workstation().anyLocked());
      }
    }
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().anyLocked(), 20000);
    QCOMPARE(find<QLabel>("locked")->text(), "Unlocked");
    QVERIFY(find<QLabel>("locked")->isVisible());
    QVERIFY(find<QComboBox>("controller")->isEnabled());
    workstation().setController(ControllerKind::off);
    QVERIFY(workstation().exercise()->controller == ControllerKind::off);
    workstation().setTissues(others);
    QVERIFY(workstation().tissuesEdited());
    // And back, with what was changed: nothing is lost without a question.
    find<QAction>("unlockTeaching")->trigger();
    QVERIFY(!workstation().anyLocked());
    QTRY_VERIFY(window_->findChild<QMessageBox*>("unsavedTissues"));
    find<QMessageBox>("unsavedTissues")->button(QMessageBox::Discard)->click();
    QTRY_VERIFY(workstation().anyLocked());
    QVERIFY(workstation().exercise()->tissues == tissues);
    QVERIFY(workstation().exercise()->controller == ControllerKind::bounded);
    QCOMPARE(find<QLabel>("locked")->text(), "Locked");
    QVERIFY(!find<QComboBox>("controller")->isEnabled());
    workstation().setController(ControllerKind::off);
    QVERIFY(workstation().exercise()->controller == ControllerKind::bounded);
    for (QMessageBox* box : window_->findChildren<QMessageBox*>("errorDialog")) {
      QVERIFY2(box->informativeText().contains("PIN"), qPrintable(box->informativeText()));
      box->close();
    }
  }

  void aExerciseThatCameInWhileItWasUnlockedIsNotStartedOnceItIsLockedAgain() {
    window_.reset();
    Policy policy;
    policy.locks = {Lock::rate};
    policy.rate_hz = 2000.0;
    open(policy);
    workstation().setUnlocked(true);
    openExercise(exercise_);
    workstation().setUnlocked(false);
    QSignalSpy failed(window_.get(), &MainWindow::failed);
    window_->startExercise();
    QTRY_COMPARE(failed.count(), 1);
    QCOMPARE(failed[0][0].value<Error>().code.str(), std::string("LOCKED"));
    QVERIFY(workstation().phase() == Workstation::Phase::ready);
    for (auto* box : window_->findChildren<QMessageBox*>("errorDialog")) box->close();
    rest();
  }

  void anExerciseThatTheWorkstationKeepsOutCannotBeChosen() {
    window_.reset();
    const std::filesystem::path storage = toPath(temporary_.filePath("storage"));
    Exercise other = *readExercise(defaultExercise("cranium"));
    other.controller = ControllerKind::off;
    const std::filesystem::path folder = freshExercise(storage, "Without control");
    QVERIFY(saveExercise(other, folder, storage).ok());
    Policy policy;
    policy.locks = {Lock::controller};
    policy.controller = ControllerKind::bounded;
    open(policy);
    auto* exercises = find<QComboBox>("scenes");
    const auto* rows = qobject_cast<QStandardItemModel*>(exercises->model());
    QVERIFY(rows);
    int kept_out = 0;
    for (int i = 0; i < exercises->count(); ++i) {
      const Result<Exercise> exercise = readExercise(toPath(exercises->itemData(i).toString()));
      QVERIFY(exercise.ok());
      QCOMPARE(rows->item(i)->isEnabled(), exercise->controller == ControllerKind::bounded);
      if (rows->item(i)->isEnabled()) continue;
      ++kept_out;
      QVERIFY(rows->item(i)->toolTip().contains("'bounded' alone"));
    }
    QVERIFY(kept_out > 0 && kept_out < exercises->count());
    workstation().setUnlocked(true);
    for (int i = 0; i < exercises->count(); ++i) QVERIFY(rows->item(i)->isEnabled());
    std::filesystem::remove_all(folder);
  }

  void wrongSettingsOfTheWorkstationAreSaid() {
    window_.reset();
    Policy policy;
    policy.locks = {Lock::controller, Lock::tissues, Lock::rate};
    policy.problem = Error{code::kBadJson, "Everything is locked: it is no JSON", "settings.json",
                           "An administrator must correct it"};
    open(policy);
    window_->sayProblem();
    QTRY_VERIFY(window_->findChild<QMessageBox*>("errorDialog"));
    auto* said = find<QMessageBox>("errorDialog");
    QVERIFY((said->text() + said->informativeText()).contains("Everything is locked"));
    said->close();
    QVERIFY(!find<QAction>("unlockTeaching")->isEnabled());
    // Nobody is sent to an educator who has no PIN.
    QVERIFY(find<QLabel>("locked")->toolTip().contains("administrator"));
    openExercise(resourceFolder() / "scenes" / "cranium.json");
    QVERIFY(find<QComboBox>("controller")->toolTip().contains("administrator"));
  }

  void allKeysAreShownAndFound() {
    find<QAction>("keys")->trigger();
    QTRY_VERIFY(window_->findChild<QDialog*>("shortcutsPage"));
    auto* list = find<QTreeWidget>("shortcuts");
    QStringList keys;
    for (int i = 0; i < list->topLevelItemCount(); ++i) {
      for (int k = 0; k < list->topLevelItem(i)->childCount(); ++k) {
        keys << list->topLevelItem(i)->child(k)->text(1);
      }
    }
    // Every action of the window that has a key is on the page.
    for (const QAction* action : window_->findChildren<QAction*>()) {
      if (action->shortcut().isEmpty() || action->objectName().isEmpty()) continue;
      const QString key = action->shortcut().toString(QKeySequence::NativeText);
      QVERIFY2(keys.join('\n').contains(key), qPrintable(action->objectName() + ' ' + key));
    }
    for (const char* key : {"Tab", "Page Down", "Shift+Home"}) {
      QVERIFY2(keys.join('\n').contains(key), key);
    }
    for (int i = 0; i < list->topLevelItemCount(); ++i) {
      for (int k = 0; k < list->topLevelItem(i)->childCount(); ++k) {
        const QTreeWidgetItem* row = list->topLevelItem(i)->child(k);
        QVERIFY2(!(row->text(0) + row->text(2)).isEmpty(), qPrintable(row->text(1)));
      }
    }
    find<QAction>("keys")->trigger();
    QCOMPARE(window_->findChildren<QDialog*>("shortcutsPage").size(), 1);
    QTest::keyClicks(find<QLineEdit>("findKey"), "pause");
    int shown = 0;
    for (int i = 0; i < list->topLevelItemCount(); ++i) shown += !list->topLevelItem(i)->isHidden();
    QVERIFY(shown >= 1 && shown < list->topLevelItemCount());
  }

  void settingsAreKeptAndTakeEffect() {
    find<QAction>("settings")->trigger();
    QTRY_VERIFY(window_->findChild<QDialog*>("settingsDialog"));
    auto* hand = find<QComboBox>("hands/main");
    hand->setCurrentIndex(hand->findData("left"));
    emit hand->activated(hand->currentIndex());
    find<QDoubleSpinBox>("mouse/push_step_N")->setValue(0.5);
    for (const QLabel* label : find<QDialog>("settingsDialog")->findChildren<QLabel*>()) {
      QVERIFY2(!label->text().contains('&') || label->buddy(), qPrintable(label->text()));
    }
    for (QPushButton* button : find<QDialog>("settingsDialog")->findChildren<QPushButton*>()) {
      if (button->text().contains("Save")) QTest::mouseClick(button, Qt::LeftButton);
    }
    QVERIFY(preferences().main_hand == MainHand::left);
    openExercise(exercise_);
    startTraining();
    pointAt(view().rect().center());
    QTRY_COMPARE(find<QLabel>("activeHand")->text(), QString("Left hand"));
    pushHand(2);
    QCOMPARE(workstation().session()->handPush_N(0), 1.0);
    stop();
  }

  void thePlaceAndTheWorkspaceComeBack() {
    openExercise(exercise_);
    window_->resize(1100, 700);
    find<QAction>("rightPanel")->trigger();
    window_->close();
    QTRY_VERIFY(!window_->isVisible());
    window_ = newWindow(toPath(temporary_.filePath("storage/sessions")));
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QVERIFY2(window_->place() == Place::cases, "nothing is open yet");
    window_->show(Place::train);
    QCOMPARE(window_->size(), QSize(1100, 700));
    QVERIFY(!find<QAction>("rightPanel")->isChecked());
    QVERIFY2(find<QPushButton>("startCardChoose")->isVisible(), "the next step is offered");
  }
};

int main(int argc, char** argv) {
  return test::runInWindow<TrainGuiTest>(argc, argv);
}

#include "train_gui_test.moc"
