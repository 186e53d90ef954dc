// How tissues look in the 3-D view, chosen in the window: told by the pixels of its picture.
// The steps build on each other, in order.
#include <QApplication>
#include <QComboBox>
#include <QDir>
#include <QSignalSpy>
#include <QTabWidget>
#include <QToolButton>
#include <QtTest>
#include <algorithm>

#include "gui_support.h"
#include "ui/common/words.h"

using namespace trephine;

namespace {

// Pixels whose channels stand to each other as a tissue's colour does, whatever the light.
int pixelsLike(const Picture& picture, const Vec3& colour) {
  int count = 0;
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
    const Vec3 pixel(picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]);
    if (std::max({pixel.x, pixel.y, pixel.z}) < 80.0) continue;
    count += glm::dot(glm::normalize(pixel), glm::normalize(colour)) > 0.9985;
  }
  return count;
}

}  // namespace

class LooksGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  const Tissue& tissue(const char* id) { return *workstation().exercise()->tissues.find(id); }
  Picture picture() { return *window_->view().picture(); }
  int shown(const char* id) { return pixelsLike(picture(), tissue(id).colour); }
  void press(const char* preset) { QTest::mouseClick(find<QToolButton>(preset), Qt::LeftButton); }
  // With the keyboard: opens the list, goes down from its first line, takes it.
  void choose(const char* id, TissueLook look) {
    auto* box = find<QComboBox>(QString("look:%1").arg(id));
    box->setFocus();
    QVERIFY(box->hasFocus());
    QTest::keyClick(box, Qt::Key_Down);
    auto* list = box->view();
    QTRY_VERIFY(list->isVisible());
    QTest::keyClick(list, Qt::Key_Home);
    for (int n = 0; n < int(look); ++n) QTest::keyClick(list, Qt::Key_Down);
    QTest::keyClick(list, Qt::Key_Return);
    QTRY_VERIFY(!list->isVisible());
    QCOMPARE(box->currentIndex(), int(look));
  }

 private slots:
  void initTestCase() {
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    window_ = newWindow(toPath(temporary_.filePath("sessions")));
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QApplication::setActiveWindow(window_.get());
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openImported(caseOf(std::make_shared<const Volume>(test::coarseCranium(4))));
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    showTissues();
    window_->view().lookAtAll({});
  }

  void theSkinPresetShowsSkinThatTheSetHasClear() {
    QCOMPARE(tissue("scalp").opacity, 0.0);
    const int before = shown("scalp");
    press("presetSkin");
    const int after = shown("scalp");
    QVERIFY2(after > 5000 && after > 5 * before,
             qPrintable(QString("%1 %2").arg(before).arg(after)));
    QCOMPARE(find<QComboBox>("look:scalp")->currentIndex(), int(TissueLook::shown));
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/looks-skin.png")));
  }

  void theBonePresetShowsBoneAlone() {
    press("presetBone");
    const Picture bone = picture();
    QVERIFY(pixelsLike(bone, tissue("bone").colour) > 3000);
    QVERIFY(pixelsLike(bone, tissue("scalp").colour) < 300);
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/looks-bone.png")));
  }

  void aTissueThatIsHiddenIsGoneAndAGhostIsNeitherThatNorSolid() {
    const Picture bone = picture();
    choose("bone", TissueLook::hidden);
    const Picture nothing = picture();
    QCOMPARE(pixelsLike(nothing, tissue("bone").colour), 0);
    choose("bone", TissueLook::ghosted);
    const Picture ghost = picture();
    QVERIFY(!(ghost == nothing));
    QVERIFY(psnr_dB(ghost, nothing) > psnr_dB(bone, nothing));
    choose("bone", TissueLook::shown);
    QVERIFY(psnr_dB(picture(), bone) > 40.0);
  }

  void aPresetThatTheSetHasNothingForIsNotOffered() {
    QVERIFY(!find<QToolButton>("presetLiver")->isVisible());
  }

  void looksAreNoEditsOfTissuesAndAnotherExerciseBringsItsOwn() {
    QVERIFY(!workstation().tissuesEdited());
    QVERIFY(workstation().exercise()->view.looks.empty());
    press("presetBone");
    QSignalSpy changed(&workstation(), &Workstation::exerciseChanged);
    auto* exercises = find<QComboBox>("scenes");
    for (int i = 0; i < exercises->count(); ++i) {
      if (!exercises->itemData(i).toString().endsWith("burr-hole.json")) continue;
      exercises->setCurrentIndex(i);
      QVERIFY(QMetaObject::invokeMethod(exercises, "activated", Q_ARG(int, i)));
    }
    QVERIFY(changed.count() > 0 || changed.wait(kLong_ms));
    QCOMPARE(find<QComboBox>("look:brain")->currentIndex(), int(TissueLook::shown));
  }

  void cleanupTestCase() { window_.reset(); }
};

int main(int argc, char** argv) {
  return trephine::test::runInWindow<LooksGuiTest>(argc, argv);
}

#include "looks_gui_test.moc"
