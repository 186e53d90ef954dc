// The window with a headset, through the real loader and a runtime that is scripted: on and off by
// a key, lost and taken off in an exercise that goes on, what is read inside, where the patient
// stands, and arms that are registered in the room.
#include <QCheckBox>
#include <QDialogButtonBox>
#include <QLabel>
#include <QMessageBox>
#include <QPushButton>
#include <QStatusBar>
#include <cmath>

#include "headset/test_runtime.h"
#include "train_support.h"
#include "ui/common/settings.h"
#include "ui/devices/room_panel.h"
#include "ui/work/arms_in_room.h"

using namespace trephine;

namespace {

constexpr int kSize = 128;

TestRuntime& runtime() {
  static TestRuntime* const loaded = [] {
    ::setenv("XR_RUNTIME_JSON", TREPHINE_XR_MANIFEST, 1);
    ::setenv("XR_LOADER_DEBUG", "none", 1);
    const Result<TestRuntime*> found = loadTestRuntime(TREPHINE_XR_RUNTIME);
    if (!found) qFatal("%s", found.error().sentence().c_str());
    return *found;
  }();
  return *loaded;
}

QImage imageOf(const TestRuntime::Shown& shown) {
  const QImage image(shown.rgba.data(), int(shown.width), int(shown.height),
                     QImage::Format_RGBX8888);
  return image.mirrored();  // its rows go up; a copy
}

// Of an eye's picture, that are neither background nor black.
int seen(int eye) {
  const QImage image = imageOf(runtime().shown(eye));
  int count = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) count += qGray(image.pixel(x, y)) > 60 ? 1 : 0;
  }
  return count;
}

}  // namespace

class HeadsetGuiTest : public test::TrainTest {
  Q_OBJECT

  std::filesystem::path exercise_;

  QString said() { return window_->statusBar()->currentMessage(); }
  QString words() { return find<QLabel>("eyes")->text(); }
  bool isOn() { return find<QAction>("headset")->isChecked(); }
  void putOn() {
    find<QAction>("headset")->trigger();
    framesGoBy(3);
  }
  void takeOff() {
    find<QAction>("headset")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(!runtime().alive().any(), 20000);
    QTRY_VERIFY(!isOn());
    QVERIFY2(runtime().violations().empty(),
             runtime().violations().empty() ? "" : runtime().violations().front().c_str());
  }
  void framesGoBy(int frames) {
    const int before = runtime().framesWithEyes();
    QTRY_VERIFY_WITH_TIMEOUT(runtime().framesWithEyes() > before + frames, 20000);
  }
  std::uint64_t ticks() { return workstation().session()->state().ticks; }
  void goesOn() {
    const std::uint64_t before = ticks();
    QTRY_VERIFY(ticks() > before + 200);
    QVERIFY(!window_->findChild<QMessageBox*>("errorDialog"));
  }

 private slots:
  void initTestCase() {
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    runtime();
    exercise_ = test::exerciseOn(test::coarseCranium(2), toPath(temporary_.path()), "coarse");
  }
  void init() {
    runtime().reset();
    runtime().setSize(kSize, kSize);
    real_time_ = true;  // the runtime has a clock of its own
    open();
  }
  void cleanup() { window_.reset(); }

  void theKeySwitchesItOnAndOffWhileTheExerciseGoesOn() {
    openExercise(exercise_);
    QTRY_VERIFY(view().canDraw().ok());
    startTraining();
    key(Qt::Key_F9);
    QTRY_VERIFY_WITH_TIMEOUT(runtime().framesWithEyes() > 3, 20000);
    QVERIFY(isOn());
    goesOn();
    QTRY_VERIFY(words().contains("both eyes") && words().contains("window"));
    for (const int eye : {0, 1}) QTRY_VERIFY(seen(eye) > kSize * kSize / 50);
    // Each eye its own.
    QVERIFY(imageOf(runtime().shown(0)) != imageOf(runtime().shown(1)));
    takeOff();
    goesOn();
    QVERIFY(words().isEmpty());
    // And in Review, where no exercise is shown.
    stop();
    window_->show(Place::review);
    runtime().reset();
    runtime().setSize(kSize, kSize);
    putOn();
    takeOff();
  }

  void oneThatIsLostLeavesTheExerciseSaysSoAndIsOfferedAgain() {
    openExercise(exercise_);
    startTraining();
    using Loss = TestRuntime::Loss;
    for (const Loss loss : {Loss::instance, Loss::session, Loss::pending, Loss::event}) {
      runtime().reset();
      runtime().setSize(kSize, kSize);
      putOn();
      runtime().lose(loss);
      QTRY_VERIFY(!isOn());
      QTRY_VERIFY2(said().contains("exercise goes on"), qPrintable(said()));
      QVERIFY(find<QAction>("headset")->isEnabled());
      goesOn();
      QVERIFY(!runtime().alive().any());
    }
    stop();
  }

  void aRefusedNumberIsReadToItsEnd() {
    find<QAction>("headsetSettings")->trigger();
    auto* dialog = find<QDialog>("headsetDialog");
    auto* below = dialog->findChild<QDoubleSpinBox*>("headset/below_m");
    below->setFocus();
    below->selectAll();
    QTest::keyClicks(below, "999");
    QTest::keyClick(below, Qt::Key_Return);
    auto* reason = dialog->findChild<QLabel*>("headset/below_mRefused");
    QTRY_VERIFY(reason->isVisible());
    rest();
    QVERIFY(dialog->grab().save(TREPHINE_ARTEFACTS "/headset-refused.png"));
    for (QLabel* each : dialog->findChildren<QLabel*>()) {
      if (!each->isVisible() || !each->wordWrap()) continue;
      QVERIFY2(each->height() >= each->heightForWidth(each->width()), qPrintable(each->text()));
    }
    // And nothing lies over it.
    const QRect room(reason->mapTo(dialog, QPoint()), reason->size());
    for (QWidget* each : dialog->findChildren<QWidget*>()) {
      if (each == reason || !each->isVisible() || each->isAncestorOf(reason)) continue;
      QVERIFY2(!QRect(each->mapTo(dialog, QPoint()), each->size()).intersects(room),
               qPrintable(each->objectName()));
    }
    dialog->close();
  }

  void aScreenForBothEyesTakesItsPlace() {
    openExercise(exercise_);
    QTRY_VERIFY(view().canDraw().ok());
    putOn();
    QTRY_VERIFY(words().contains("both eyes"));
    write(settings::kStereoScreen, window_->screen()->name());
    key(Qt::Key_F9, Qt::ShiftModifier);
    QTRY_VERIFY(!isOn());
    QTRY_VERIFY_WITH_TIMEOUT(!runtime().alive().any(), 20000);
    rest();
    QVERIFY(find<QAction>("stereo")->isChecked());
    QTRY_VERIFY2(words().contains("Both eyes on"), qPrintable(words()));
    find<QAction>("stereo")->trigger();
    write(settings::kStereoScreen, QString());
  }

  void oneThatCannotBeHadInAnExerciseIsSaidInALineThatFits() {
    openExercise(exercise_);
    startTraining();
    ::setenv("XR_RUNTIME_JSON", "/nowhere/runtime.json", 1);
    find<QAction>("headset")->trigger();
    QTRY_VERIFY(!isOn());
    QTRY_VERIFY2(said().contains("OpenXR runtime cannot be used"), qPrintable(said()));
    QVERIFY2(!said().contains("XrResult") && said().contains("Install"), qPrintable(said()));
    ::setenv("XR_RUNTIME_JSON", TREPHINE_XR_MANIFEST, 1);
    goesOn();
    stop();
  }

  void oneWhoseSoftwareHangsHoldsUpNothing() {
    openExercise(exercise_);
    startTraining();
    putOn();
    runtime().hang(2.0);
    QTRY_VERIFY2(said().contains("does not answer"), qPrintable(said()));
    goesOn();
    find<QAction>("headset")->trigger();  // off: it ends once its call returns
    goesOn();
    QTRY_VERIFY_WITH_TIMEOUT(!runtime().alive().any(), 10000);
    QTRY_VERIFY(!isOn());
    runtime().reset();
    runtime().setSize(kSize, kSize);
    putOn();
    takeOff();
    stop();
  }

  void oneThatIsTakenOffIsSaidAndGoesOnWhenItIsPutOnAgain() {
    openExercise(exercise_);
    startTraining();
    putOn();
    runtime().setWorn(false);
    QTRY_VERIFY2(said().contains("taken off"), qPrintable(said()));
    goesOn();
    QVERIFY(isOn());
    const int before = runtime().framesWithEyes();
    runtime().setWorn(true);
    QTRY_VERIFY(runtime().framesWithEyes() > before + 3);
    takeOff();
    stop();
  }

  void withoutAHeadsetOrItsSoftwareOneSentenceSaysWhatToDo() {
    openExercise(exercise_);
    QTRY_VERIFY(view().canDraw().ok());
    const auto refused = [&](const char* words) {
      find<QAction>("headset")->trigger();
      QMessageBox* box = nullptr;
      QTRY_VERIFY((box = window_->findChild<QMessageBox*>("errorDialog")));
      const QString text = box->text() + ' ' + box->informativeText();
      QVERIFY2(text.contains(words), qPrintable(text));
      QVERIFY(!isOn());
      box->close();
      QTRY_VERIFY(!window_->findChild<QMessageBox*>("errorDialog"));
    };
    runtime().setPluggedIn(false);
    refused("No headset is found");
    ::setenv("XR_RUNTIME_JSON", "/nowhere/runtime.json", 1);
    refused("OpenXR runtime cannot be used");
    ::setenv("XR_RUNTIME_JSON", TREPHINE_XR_MANIFEST, 1);
    runtime().reset();
    runtime().fail("xrCreateInstance", -10, 0, 1);
    refused("Another program has the headset");
  }

  void thePatientStandsBeforeTheHeadWhenThePersonAsksForIt() {
    openExercise(exercise_);
    QTRY_VERIFY(view().canDraw().ok());
    putOn();
    QTRY_VERIFY(seen(0) > 500);
    const int ahead = seen(0);
    // Behind the head now; it does not come by itself.
    runtime().setHead({{0.0, 0.0, 0.0}, glm::angleAxis(glm::pi<double>(), Vec3(0, 1, 0))});
    QTRY_VERIFY(seen(0) < 20);
    framesGoBy(20);
    QVERIFY(seen(0) < 20);
    find<QAction>("headsetRecentre")->trigger();
    QTRY_VERIFY2(std::abs(seen(0) - ahead) < ahead / 3, qPrintable(QString::number(seen(0))));
    // Twice as large, and said.
    find<QAction>("headsetSettings")->trigger();
    auto* scale = find<DecimalField>("headset/scale");
    scale->setValue(200.0);
    QTRY_VERIFY2(seen(0) > ahead + ahead / 2, qPrintable(QString::number(seen(0))));
    QTRY_VERIFY(words().contains("200 %"));
    QVERIFY(
        find<QDialog>("headsetDialog")->grab().save(TREPHINE_ARTEFACTS "/headset-settings.png"));
    find<QDialog>("headsetDialog")->close();
    takeOff();
  }

  void theWindowShowsTheLeftEyeIfItIsToldTo() {
    openExercise(exercise_);
    QTRY_VERIFY(view().canDraw().ok());
    QTRY_VERIFY_WITH_TIMEOUT(view().isComplete(), kLong_ms);
    find<QAction>("headsetSettings")->trigger();
    find<QCheckBox>("headset/mirror")->setChecked(true);
    find<QDialog>("headsetDialog")->close();
    putOn();
    // Its middle is the middle of the eye's picture; above it, in a high view, nothing.
    const auto mirrors = [&] {
      const QImage panel = view().grabFramebuffer(), eye = imageOf(runtime().shown(0));
      const QPoint middle = panel.rect().center();
      const QColor a = panel.pixelColor(middle), b = eye.pixelColor(eye.rect().center());
      return panel.pixelColor(middle.x(), 2) == QColor(Qt::black) &&
             std::abs(a.red() - b.red()) + std::abs(a.blue() - b.blue()) < 30;
    };
    QTRY_VERIFY(mirrors());
    QVERIFY(window_->grab().save(TREPHINE_ARTEFACTS "/headset-mirror.png"));
    takeOff();
    QTRY_VERIFY(view().grabFramebuffer().pixelColor(view().width() / 2, 2) != QColor(Qt::black));
  }

  void forceTimeAndCardAreReadInside() {
    openExercise(exercise_);
    startTraining();
    // A headset of 15 pixels a degree that looks at the card on the left, then at the forces.
    constexpr int kWide = 330;
    const auto look = [&](double middle_deg, const char* file) {
      const double from = std::tan(glm::radians(middle_deg - 11.0));
      const double to = std::tan(glm::radians(middle_deg + 11.0));
      const double high = 0.5 * (to - from);
      runtime().reset();
      runtime().setSize(kWide, kWide);
      runtime().setEyes(0.063, {from, to, -0.4545 - high, -0.4545 + high},
                        {from, to, -0.4545 - high, -0.4545 + high});
      putOn();
      const auto pixels = [](auto wanted) {
        const QImage eye = imageOf(runtime().shown(0));
        int count = 0;
        for (int y = 0; y < eye.height(); ++y) {
          for (int x = 0; x < eye.width(); ++x) count += wanted(qGray(eye.pixel(x, y))) ? 1 : 0;
        }
        return count;
      };
      QTRY_VERIFY(pixels([](int grey) { return grey > 140; }) > 300);               // letters
      QTRY_VERIFY(pixels([](int grey) { return grey < 30; }) > kWide * kWide / 8);  // the card
      QVERIFY(imageOf(runtime().shown(0)).save(file));
      takeOff();
    };
    look(-27.0, TREPHINE_ARTEFACTS "/headset-card.png");
    look(27.0, TREPHINE_ARTEFACTS "/headset-forces.png");
    stop();
  }

  void threeMarksThatAreTouchedSayWhereAnArmStands() {
    openExercise(exercise_);
    QTRY_VERIFY(view().canDraw().ok());
    putOn();
    const FoundArm device{"openhaptics", "1-2", "17", "Touch"};
    RoomPanel panel;
    panel.show();
    auto* words = panel.findChild<QLabel*>("roomWords");
    auto* begin = panel.findChild<QPushButton*>("touchMarks");
    QVERIFY(!begin->isEnabled());
    std::vector<Vec3> marks_m;
    connect(&panel, &RoomPanel::marksWanted, this, [&](bool wanted) {
      if (!wanted) return;
      marks_m = {{0.1, 0.0, -0.5}, {0.2, 0.0, -0.5}, {0.15, 0.0, -0.6}};
      panel.setMarks(marks_m);
    });
    panel.showArm(device);
    panel.setHeadset(true, true);
    panel.follow(Vec3(0.0), 0, true);
    QVERIFY(begin->isEnabled());
    const Pose stands{{0.3, -0.2, -0.4}, glm::angleAxis(0.6, Vec3(0, 1, 0))};
    const auto device_m = [&](const Vec3& room_m) {
      return glm::conjugate(stands.orientation) * (room_m - stands.position);
    };
    const auto touchAll = [&](double off_m) {
      begin->click();
      QVERIFY(panel.isTouching());
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 tip_m = device_m(marks_m[i]) + Vec3(i == 1 ? off_m : 0.0, 0.0, 0.0);
        panel.follow(tip_m, 0, true);
        if (i == 0) {
          panel.findChild<QPushButton*>("markTouched")->click();  // Space
        } else {
          panel.follow(tip_m, 1, true);  // the arm's button
        }
      }
      QVERIFY(!panel.isTouching());
    };
    touchAll(0.0);
    std::optional<ArmInRoom> where = armInRoom(device);
    QVERIFY(where && where->kept && where->error_mm);
    QVERIFY(*where->error_mm < 1e-3);
    QVERIFY(glm::distance(where->room_from_device_m.position, stands.position) < 1e-9);
    QVERIFY2(words->text().contains("0.0 mm"), qPrintable(words->text()));
    touchAll(0.02);  // one of them 2 cm beside its cross
    where = armInRoom(device);
    QVERIFY(*where->error_mm > 5.0);
    QVERIFY2(words->text().contains("touch the marks again"), qPrintable(words->text()));
    // By hand, and away.
    panel.findChild<QPushButton*>("roomByHand")->click();
    auto* dialog = panel.findChild<QDialog*>("roomDialog");
    QVERIFY(dialog);
    dialog->findChild<DecimalField*>("roomRight")->setValue(25.0);
    dialog->findChild<DecimalField*>("roomTurn")->setValue(90.0);
    dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save)->click();
    where = armInRoom(device);
    QVERIFY(where && !where->error_mm);
    QVERIFY(std::abs(where->room_from_device_m.position.x - 0.25) < 1e-9);
    QVERIFY(glm::distance(where->room_from_device_m.orientation * Vec3(1, 0, 0), Vec3(0, 0, -1)) <
            1e-9);
    QVERIFY2(words->text().contains("by hand"), qPrintable(words->text()));
    auto* forget = panel.findChild<QPushButton*>("forgetRoom");
    QVERIFY(forget->isEnabled());
    forget->click();
    QVERIFY(!armInRoom(device));
    takeOff();
  }

  void whatIsRegisteredWhereNoRoomIsKnownHoldsUntilTheHeadsetIsOff() {
    openExercise(exercise_);
    QTRY_VERIFY(view().canDraw().ok());
    runtime().setStage(false);
    putOn();
    const FoundArm now{"openhaptics", "1-2", "17", {}}, kept{"openhaptics", "1-3", "18", {}};
    setArmInRoom(now, ArmInRoom{{}, 1.0, false});
    setArmInRoom(kept, ArmInRoom{{}, 1.0, true});
    takeOff();
    QTRY_VERIFY(!armInRoom(now));
    QVERIFY(armInRoom(kept));
    runtime().reset();
    runtime().setSize(kSize, kSize);
    putOn();
    runtime().moveRoom(false);  // a person has recentred the headset: the room is the same
    framesGoBy(20);
    QVERIFY(armInRoom(kept));
    runtime().moveRoom(true);
    QTRY_VERIFY2(said().contains("register the arms again"), qPrintable(said()));
    QVERIFY(!armInRoom(kept));
    takeOff();
  }

  void ofAProgramThatEndedWithItsHeadsetOnNothingIsLeftThatNoLongerHolds() {
    const FoundArm now{"openhaptics", "1-2", "17", {}}, kept{"openhaptics", "1-3", "18", {}};
    setArmInRoom(now, ArmInRoom{{}, 1.0, false});
    setArmInRoom(kept, ArmInRoom{{}, 1.0, true});
    window_.reset();
    window_ = newWindow(toPath(temporary_.path()) / "recordings");
    QVERIFY(!armInRoom(now));
    QVERIFY(armInRoom(kept));
    (void)forgetArmsInRoom(true);
  }
};

int main(int argc, char** argv) {
  return test::runInWindow<HeadsetGuiTest>(argc, argv);
}

#include "headset_gui_test.moc"
