// Two pictures on a second screen: it is covered, each eye has its half, a lens bends them,
// nonsense is refused in words, and the exercise goes on when the screen goes.
#include <QCheckBox>
#include <QComboBox>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QProcess>
#include <QPushButton>
#include <QStatusBar>

#include "train_support.h"
#include "ui/common/settings.h"
#include "ui/headset/stereo_window.h"

using namespace trephine;

namespace {

// This test has a display of its own: two screens of it, beside each other.
void split() {
  std::system("xrandr --setmonitor near 1280/340x800/212+0+0 screen");
  std::system("xrandr --setmonitor far 640/170x800/212+1280+0 none");
}

}  // namespace

class StereoGuiTest : public test::TrainTest {
  Q_OBJECT

  std::filesystem::path exercise_;

  StereoWindow* shown() {
    for (QWidget* each : QApplication::topLevelWidgets()) {
      if (auto* found = qobject_cast<StereoWindow*>(each); found && found->isVisible())
        return found;
    }
    return nullptr;
  }
  QMessageBox* error() { return window_->findChild<QMessageBox*>("errorDialog"); }
  // Until its picture does not change any more.
  QImage picture() {
    restRefined();
    QImage last;
    (void)QTest::qWaitFor([&] {
      rest();
      const QImage now = shown()->grabFramebuffer();
      return now == std::exchange(last, now);
    });
    return last;
  }
  static int difference(const QImage& a, const QImage& b) {
    int count = 0;
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        count += std::abs(qGray(a.pixel(x, y)) - qGray(b.pixel(x, y))) > 12 ? 1 : 0;
      }
    }
    return count;
  }

 private slots:
  void initTestCase() {
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    QCOMPARE(QGuiApplication::screens().size(), 2);
    exercise_ = test::exerciseOn(test::coarseCranium(2), toPath(temporary_.path()), "coarse");
  }
  void init() {
    open();
    window_->move(0, 0);
    openExercise(exercise_);
    QTRY_VERIFY(view().canDraw().ok());
    QTRY_VERIFY_WITH_TIMEOUT(view().isComplete(), kLong_ms);
  }
  void cleanup() { window_.reset(); }

  void theOtherScreenIsCoveredAndEachEyeHasItsHalf() {
    key(Qt::Key_F9, Qt::ShiftModifier);
    QTRY_VERIFY(shown());
    QTRY_COMPARE(shown()->geometry(), QRect(1280, 0, 640, 800));
    QTRY_VERIFY(find<QLabel>("eyes")->text().contains("Both eyes on"));
    StereoWindow* const first = shown();
    const QImage both = picture();
    QVERIFY(both.save(TREPHINE_ARTEFACTS "/stereo-half.png"));
    const QImage left = both.copy(0, 0, 320, 800), right = both.copy(320, 0, 320, 800);
    QVERIFY2(difference(left, right) > 1000, "each eye sees something of its own");
    // What is looked at lies in the screen's plane: the middle hardly differs.
    QVERIFY(difference(left.copy(150, 390, 20, 20), right.copy(150, 390, 20, 20)) <
            difference(left, right));
    find<QAction>("headsetSettings")->trigger();
    auto* packing = find<QComboBox>("stereo/packing");
    packing->setCurrentIndex(packing->findData("top_bottom"));
    emit packing->activated(packing->currentIndex());
    QCOMPARE(shown(), first);  // no other window, which could take the keys
    const QImage above = picture();
    QVERIFY(above.save(TREPHINE_ARTEFACTS "/stereo-top-bottom.png"));
    QVERIFY(difference(above, both) > 1000);
    find<QDialog>("headsetDialog")->close();
    QVERIFY(!shown()->isActiveWindow());
    QTRY_VERIFY(window_->isActiveWindow());
    view().setFocus();  // whichever view lies under the pointer
    // The status line follows what the pictures take, though nothing is switched.
    const QString before = find<QLabel>("eyes")->text();
    int keys = 0;
    QTRY_VERIFY2(
        (key(keys++ % 2 == 0 ? Qt::Key_A : Qt::Key_S), find<QLabel>("eyes")->text() != before),
        qPrintable(before));
    QTest::mouseDClick(shown(), Qt::LeftButton);
    QTRY_VERIFY(!shown());
    QTRY_VERIFY(!find<QAction>("stereo")->isChecked());
  }

  void aLensBendsThePicturesAndNonsenseIsRefused() {
    const auto write_lens = [&](const char* name, const char* text) {
      const QString file = temporary_.filePath(name);
      QFile of(file);
      if (!of.open(QIODevice::WriteOnly)) qFatal("no file");
      of.write(text);
      return file;
    };
    const QString good = write_lens(
        "lens.json",
        R"({"format": "trephine.lens", "version": 1, "k": [0.3, 0.1, 0.0], "colour": [1.01, 1, 0.99]})");
    const QString bad =
        write_lens("bad.json", R"({"format": "trephine.lens", "version": 1, "k": [-2, 0.0, 0.0]})");
    key(Qt::Key_F9, Qt::ShiftModifier);
    QTRY_VERIFY(shown());
    const QImage straight = picture();
    find<QAction>("headsetSettings")->trigger();
    const auto choose = [&](const QString& file) {
      QTest::mouseClick(find<QPushButton>("chooseLens"), Qt::LeftButton);
      QTRY_VERIFY(window_->findChild<QFileDialog*>("lensDialog"));
      auto* dialog = find<QFileDialog>("lensDialog");
      emit dialog->fileSelected(file);
      dialog->close();
    };
    choose(bad);
    QTRY_VERIFY(error());
    QVERIFY2(error()->text().contains("fold the picture over"), qPrintable(error()->text()));
    QCOMPARE(error()->parentWidget(), find<QDialog>("headsetDialog"));  // the keys go back to it
    error()->close();
    QVERIFY(find<QLineEdit>("stereoLens")->text().isEmpty());
    choose(good);
    QTRY_COMPARE(find<QLineEdit>("stereoLens")->text(), good);
    QTRY_VERIFY(shown());
    const QImage bent = picture();
    QVERIFY(bent.save(TREPHINE_ARTEFACTS "/stereo-lens.png"));
    QVERIFY(difference(bent, straight) > 1000);
    QCOMPARE(bent.pixelColor(1, 1), QColor(Qt::black));  // from beyond the picture
    find<QDialog>("headsetDialog")->close();
    // The file goes: the next time one sentence says so.
    find<QAction>("stereo")->trigger();
    QTRY_VERIFY(!shown());
    QFile::remove(good);
    find<QAction>("stereo")->trigger();
    QTRY_VERIFY(error());
    QTRY_VERIFY(!find<QAction>("stereo")->isChecked());
    QVERIFY2(error()->text().startsWith("The lens"), qPrintable(error()->text()));
    error()->close();
    QVERIFY(!shown());
    write(settings::kStereoLens, QString());
  }

  void whatCannotBeginLeavesTheOther() {
    key(Qt::Key_F9, Qt::ShiftModifier);
    QTRY_VERIFY(shown());
    ::setenv("XR_RUNTIME_JSON", "/nowhere/runtime.json", 1);
    find<QAction>("headset")->trigger();
    QTRY_VERIFY(error());
    error()->close();
    shown()->close();
    QTRY_VERIFY(!shown());
    QTRY_VERIFY(!find<QAction>("stereo")->isChecked());
  }

  // Last: the screen does not come back.
  void theExerciseGoesOnWhenTheScreenGoes() {
    startTraining();
    key(Qt::Key_F9, Qt::ShiftModifier);
    QTRY_VERIFY(shown());
    QCOMPARE(QProcess::execute("xrandr", {"--delmonitor", "far"}), 0);
    QTRY_VERIFY(!shown());
    const QString said = window_->statusBar()->currentMessage();
    QVERIFY2(said.contains("exercise goes on"), qPrintable(said));
    const std::uint64_t before = workstation().session()->state().ticks;
    QTRY_VERIFY(workstation().session()->state().ticks > before + 200);
    stop();
    find<QAction>("stereo")->trigger();
    QTRY_VERIFY(error());
    const QString text = error()->text() + error()->informativeText();
    QVERIFY2(text.contains("one screen only"), qPrintable(text));
  }
};

int main(int argc, char** argv) {
  split();
  return test::runInWindow<StereoGuiTest>(argc, argv);
}

#include "stereo_gui_test.moc"
