// The dialog of devices and an exercise on what it chose, with the real plugin for Phantom and
// Touch on our own libHD.so: two arms that the test moves.
#include <dlfcn.h>

#include <QComboBox>
#include <QDialog>
#include <QFrame>
#include <QListWidget>
#include <QMenu>
#include <QtTest>

#include "conformance/hd_test.h"
#include "train_support.h"
#include "ui/common/settings.h"

using namespace trephine;

namespace {

constexpr int kSoon_ms = 20000;

class DevicesGuiTest : public test::TrainTest {
  Q_OBJECT

  test::HdTest* hd_ = nullptr;

  double force_N(std::size_t arm) const {
    const test::HdArm& of = hd_->arms[arm];
    return of.enabled ? std::sqrt(of.force_N[0] * of.force_N[0] + of.force_N[1] * of.force_N[1] +
                                  of.force_N[2] * of.force_N[2])
                      : 0.0;
  }
  QDialog* openDialog() {
    find<QAction>("devices")->trigger();
    auto* dialog = find<QDialog>("devicesDialog");
    if (!QTest::qWaitFor([&] { return find<QListWidget>("deviceList")->count() == 2; }, kSoon_ms)) {
      qFatal("the arms are not found");
    }
    return dialog;
  }
  void closeDialog() {
    find<QDialog>("devicesDialog")->reject();
    QTRY_VERIFY(!window_->findChild<QDialog*>("devicesDialog"));
  }
  void picture(const char* name) {
    QVERIFY(find<QDialog>("devicesDialog")
                ->grab()
                .save(QString(TREPHINE_ARTEFACTS "/%1.png").arg(name)));
  }
  // So many frames of the arms, a thousand a second.
  void framesGoBy(std::uint64_t frames) {
    const std::uint64_t begin = hd_->frames;
    QTRY_VERIFY_WITH_TIMEOUT(hd_->frames > begin + frames, kSoon_ms);
  }
  // Presses the arm's button until the force that is tested for reaches `least_N`. A machine that
  // stands still for a moment has the force taken away, as it must: then the test begins again.
  void pullUp(double least_N) {
    hd_->arms[0].buttons = 1;
    QTRY_VERIFY_WITH_TIMEOUT(
        [&] {
          if (find<QLabel>("forceTest")->text().contains("was taken away")) {
            find<QPushButton>("testForce")->click();
          }
          return force_N(0) > least_N;
        }(),
        kSoon_ms);
  }
  void choose(const char* box, int index) {
    auto* of = find<QComboBox>(box);
    of->setCurrentIndex(index);
    emit of->activated(index);
  }

 private slots:
  void initTestCase() {
    QApplication::setApplicationName("trephine-test-devices");
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    void* library = ::dlopen("libHD.so", RTLD_NOW);
    QVERIFY2(library, "the test's libHD.so is not in LD_LIBRARY_PATH");
    hd_ = reinterpret_cast<test::HdTestEntry>(::dlsym(library, test::kHdTestEntry))();
  }
  void init() {
    hd_->reset();
    real_time_ = true;  // the arms have a clock of their own
    open();
  }
  void cleanup() { closeWindow(); }

  void theArmThatIsMovedIsShownAndIsMadeTheLeft() {
    openDialog();
    auto* list = find<QListWidget>("deviceList");
    QTRY_VERIFY(!find<QLabel>("deviceAble")->text().isEmpty());
    QVERIFY(find<QLabel>("deviceAble")->text().contains("160"));
    QTRY_VERIFY(find<QLabel>("deviceNow")->text().contains("Move it"));
    QCOMPARE(list->currentRow(), 0);
    hd_->arms[1].swing_mm = 30.0;
    QTRY_COMPARE(list->currentRow(), 1);
    QTRY_VERIFY(find<QLabel>("deviceNow")->text().contains("moved by"));
    choose("leftArm", 2);
    QCOMPARE(list->item(1)->text().section('\n', 1), QString("left hand"));
    QCOMPARE(read(settings::kLeftArm).value(1), QString("openhaptics-1"));
    picture("devices-left");
    // One device, one hand.
    choose("rightArm", 2);
    QCOMPARE(find<QComboBox>("leftArm")->currentIndex(), 0);
    QVERIFY(read(settings::kLeftArm).isEmpty());
    // What the other hand had comes in its place.
    choose("leftArm", 1);
    choose("leftArm", 2);
    QCOMPARE(find<QComboBox>("leftArm")->currentIndex(), 2);
    QCOMPARE(find<QComboBox>("rightArm")->currentIndex(), 1);
    QCOMPARE(force_N(0) + force_N(1), 0.0);
    closeDialog();
  }

  void aForceTestPullsUpWhileAButtonIsHeldAndIsGoneWithIt() {
    openDialog();
    auto* test = find<QPushButton>("testForce");
    QTRY_VERIFY(test->isEnabled());
    test->click();
    QTRY_VERIFY(find<QLabel>("forceTest")->text().contains("Hold the arm"));
    framesGoBy(1500);
    QCOMPARE(force_N(0), 0.0);
    pullUp(0.3);
    QVERIFY(hd_->arms[0].force_N[1] > 0.3);
    QTRY_VERIFY(find<QLabel>("forceTest")->text().contains("It pulls up"));
    picture("devices-force");
    hd_->arms[0].buttons = 0;
    constexpr std::uint64_t kFades = 20;
    const std::uint64_t released = hd_->frames;
    framesGoBy(3 * kFades);
    for (std::uint64_t frame = released + kFades; frame < released + 3 * kFades; ++frame) {
      QCOMPARE(hd_->arms[0].sent_N[frame % test::HdArm::kFrames].load(), 0.0);
    }
    QTRY_VERIFY(find<QPushButton>("forceFelt")->isEnabled());
    find<QPushButton>("forceFelt")->click();
    QVERIFY(find<QLabel>("forceTest")->text().contains("works"));
    QVERIFY(find<QListWidget>("deviceList")->item(0)->text().contains("was felt"));
    closeDialog();
  }

  void EscapeTakesTheForceOfATestAwayAndThenClosesTheDialog() {
    auto* dialog = openDialog();
    auto* test = find<QPushButton>("testForce");
    QTRY_VERIFY(test->isEnabled());
    test->click();
    pullUp(0.2);
    QTest::keyClick(dialog, Qt::Key_Escape);
    QVERIFY(dialog->isVisible());
    QTRY_COMPARE(force_N(0), 0.0);
    QTest::keyClick(dialog, Qt::Key_Escape);
    QTRY_VERIFY(!window_->findChild<QDialog*>("devicesDialog"));
  }

  void whereArmsHaveBothHandsThePointerHasNone() {
    openDialog();
    choose("leftArm", 1);
    choose("rightArm", 2);
    closeDialog();
    openExercise(resourceFolder() / "scenes" / "cranium.json");
    startTraining();
    QVERIFY(find<QLabel>("hint")->text().contains("The arms move the tools"));
    QVERIFY(!find<QAction>("devices")->isEnabled());
    QTest::keyClick(&window_->view(), Qt::Key_Down);
    framesGoBy(300);
    QVERIFY(!find<QWidget>("handBar")->isVisible());
    stop();
    QVERIFY(find<QAction>("devices")->isEnabled());
    find<QAction>("devices")->trigger();
    QTRY_COMPARE(find<QListWidget>("deviceList")->count(), 2);
    choose("leftArm", 0);
    choose("rightArm", 0);
    closeDialog();
  }

  void closingInTheMiddleOfATestTakesTheForceAway() {
    openDialog();
    auto* test = find<QPushButton>("testForce");
    QTRY_VERIFY(test->isEnabled());
    test->click();
    pullUp(0.2);
    QElapsedTimer clock;
    clock.start();
    closeDialog();
    QVERIFY2(clock.elapsed() < 1000, qPrintable(QString::number(clock.elapsed())));
    QCOMPARE(force_N(0), 0.0);
  }

  void anArmThatDoesNotKnowWhereItIsSaysWhatToDo() {
    hd_->arms[0].calibration = 0x5002;
    hd_->styles = 0b100;
    openDialog();
    const auto words = [this] { return find<QLabel>("deviceNow")->text(); };
    QTRY_VERIFY2(words().contains("inkwell") || words().contains("holder"), qPrintable(words()));
    QVERIFY(!find<QPushButton>("testForce")->isEnabled());
    picture("devices-holder");
    closeDialog();
  }

  // One arm real, the other the mouse's; nobody's hand, a hand, a device that goes.
  void anExerciseRunsOnWhatWasChosenAndTheOtherHandGoesOnWithoutIt() {
    openDialog();
    choose("leftArm", 1);
    closeDialog();
    openExercise(resourceFolder() / "scenes" / "cranium.json");
    startTraining();
    QVERIFY(!workstation().session()->isSimulated(0));
    QVERIFY(workstation().session()->isSimulated(1));
    auto* notice = find<QFrame>("forceNotice");
    QTRY_VERIFY(notice->isVisible());
    QTRY_VERIFY(arm(0).tool_state & kToolNoHand);
    QVERIFY(!(arm(1).tool_state & kToolNoHand));
    hd_->arms[0].swing_mm = 20.0;
    QTRY_VERIFY(!(arm(0).tool_state & kToolNoHand));
    QTRY_VERIFY(glm::length(arm(0).device_position_m) > 0.0);

    hd_->arms[0].error = 0x0302;
    hd_->arms[0].errors = 1000000;
    QTRY_VERIFY(arm(0).faults & kFaultDeviceLost);
    QCOMPARE(arm(1).faults, 0u);
    // The notice may still show what it said before.
    const auto saysThatTheOtherGoesOn = [notice] {
      const auto labels = notice->findChildren<QLabel*>();
      return std::any_of(labels.begin(), labels.end(), [](const QLabel* label) {
        return label->text().contains("The other hand goes on");
      });
    };
    QTRY_VERIFY(notice->isVisible() && saysThatTheOtherGoesOn());
    const std::uint64_t ticks = workstation().session()->state().ticks;
    QTRY_VERIFY(workstation().session()->state().ticks > ticks + 200);
    stop();
  }

  void aChosenArmThatIsNotThereIsSaidWhenAnExerciseBegins() {
    write(settings::kRightArm, QStringList{"woodenhaptics", "usb-9-9", "1", "WoodenHaptics"});
    openExercise(resourceFolder() / "scenes" / "cranium.json");
    QSignalSpy failed(&workstation(), &Workstation::failed);
    window_->startExercise();
    QVERIFY(failed.count() == 1 || failed.wait(kSoon_ms));
    const Error error = failed[0][0].value<Error>();
    QCOMPARE(error.code.str(), std::string("NO_DEVICE"));
    for (const char* part : {"right", "WoodenHaptics", "usb-9-9"}) {
      QVERIFY2(error.what.find(part) != std::string::npos, error.what.c_str());
    }
    if (auto* box = window_->findChild<QDialog*>("errorDialog")) box->reject();
    find<QAction>("devices")->trigger();
    auto* right = find<QComboBox>("rightArm");
    QTRY_VERIFY(right->currentText().contains("not plugged in"));
    choose("rightArm", 0);
    closeDialog();
    startTraining();
    stop();
  }
};

}  // namespace

int main(int argc, char** argv) {
  return test::runInWindow<DevicesGuiTest>(argc, argv);
}

#include "devices_gui_test.moc"
