// Cases and sizes that a window must bear: one slice, slices far apart, HU that are all alike,
// views of no size. Each is a picture that can be read or words that say why not.
#include <QApplication>
#include <QDir>
#include <QLabel>
#include <QMessageBox>
#include <QtTest>

#include "gui_support.h"
#include "ui/common/words.h"

using namespace trephine;

namespace {

constexpr int kBone = 1200, kBrain = 35;
constexpr double kRadius_mm = 80.0;

// A ball of bone around brain, at the middle of a box of air.
Volume head(const Index3& size, const Vec3& spacing_mm) {
  Volume v;
  v.geometry.size = size;
  v.geometry.spacing_mm = spacing_mm;
  v.geometry.origin_mm = -0.5 * spacing_mm * Vec3(size[0] - 1, size[1] - 1, size[2] - 1);
  for (std::size_t i = 0; i < v.geometry.voxelCount(); ++i) {
    const Index3 at = v.geometry.indicesOf(i);
    const double r = glm::length(v.geometry.toPatient_mm(Vec3(at[0], at[1], at[2])));
    v.hu.push_back(std::int16_t(r < kRadius_mm - 10.0 ? kBrain : r < kRadius_mm ? kBone : kAirHu));
  }
  return v;
}

Volume even(int hu) {
  Volume v = head({40, 40, 40}, Vec3(4.0));
  std::ranges::fill(v.hu, std::int16_t(hu));
  return v;
}

// Pixels of bone from the picture's middle along a step.
int reach(const QImage& image, const QPoint& step) {
  int n = 0;
  for (QPoint at = image.rect().center(); image.valid(at); at += step, ++n) {
    if (image.pixelColor(at).lightness() < 90 && n > 20) break;
  }
  return n;
}

}  // namespace

class OddCasesGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  FourUp& views() { return window_->views(); }
  ViewWidget& view() { return window_->view(); }

  // What the window said of it; it is said once.
  QString open(Volume volume) {
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openImported(caseOf(std::make_shared<const Volume>(std::move(volume))));
    [&] { QVERIFY(opened.count() == 1 || opened.wait(kLong_ms)); }();
    rest();
    QString said;
    if (auto* box = window_->findChild<QMessageBox*>("errorDialog")) {
      said = box->text() + "\n" + box->informativeText();
      box->close();
    }
    view().lookAtAll({});
    return said;
  }
  QImage volumePicture() {
    const Result<Picture> picture = view().picture();
    if (!picture) return {};
    return QImage(picture->rgb.data(), picture->width, picture->height, 3 * picture->width,
                  QImage::Format_RGB888)
        .copy();
  }
  // Brain, bone and air one after another along a direction from the middle.
  bool isSliceOfHead(SliceAxis axis, const Vec3& direction) {
    views().setPoint(Vec3(20.0, 20.0, 0.0));
    SliceView& slice = views().slice(axis);
    const Vec3 from = slice.stack().toPatient_mm(Vec3(0, 0, slice.slice()));
    const Vec3 normal = slice.stack().direction[2];
    const QImage image = slice.grab().toImage();
    const auto grey = [&](double mm) {
      Vec3 at = glm::normalize(direction) * mm + Vec3(0, 0, 1);  // beside the point's lines
      at += normal * glm::dot(from - at, normal);
      return qGray(image.pixel(slice.fromPatient(at).toPoint()));
    };
    const int brain = grey(-50.0), bone = grey(-72.0), air = grey(-86.0);
    const bool is = std::abs(brain - views().colours().greyOf(kBrain)) < 12 &&
                    std::abs(bone - views().colours().greyOf(kBone)) < 12 && air < 12;
    if (!is) qInfo("brain %d, bone %d, air %d", brain, bone, air);
    return is;
  }
  void keepGrab(const char* name) {
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/%1").arg(name)));
  }

 private slots:
  void initTestCase() {
    QApplication::setApplicationName("trephine-test-odd-cases");
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    window_ = newWindow(toPath(temporary_.filePath("recordings")));
    window_->resize(1280, 800);
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    views().setLayout({ViewLayout::Kind::four, 0});
  }

  void oneSliceIsSeenInTheSlicesAndThe3dViewSaysWhyItIsEmpty() {
    QVERIFY(open(head({128, 128, 1}, Vec3(1.5, 1.5, 3.0))).contains("bone"));
    auto* hint = find<QLabel>("viewHint");
    QVERIFY(hint->isVisible() && hint->text().contains("One slice"));
    QCOMPARE(views().slice(SliceAxis::axial).slices(), 1);
    QVERIFY(isSliceOfHead(SliceAxis::axial, Vec3(1, 1, 0)));
    QVERIFY(isSliceOfHead(SliceAxis::coronal, Vec3(1, 0, 0)));
    QVERIFY(isSliceOfHead(SliceAxis::sagittal, Vec3(0, 1, 0)));
    keepGrab("odd-one-slice.png");
    open(head({64, 64, 64}, Vec3(3.0)));
    QVERIFY(!hint->isVisible());
  }

  void slicesFarApartShowARoundHead() {
    QVERIFY(open(head({320, 320, 20}, Vec3(0.5, 0.5, 10.0))).isEmpty());
    QVERIFY(isSliceOfHead(SliceAxis::axial, Vec3(1, 1, 0)));
    QVERIFY(isSliceOfHead(SliceAxis::coronal, Vec3(1, 0, 1)));
    QVERIFY(isSliceOfHead(SliceAxis::sagittal, Vec3(0, 1, 1)));
    const QImage image = volumePicture();
    // To the sides that the light comes from.
    const int across = reach(image, {-1, 0}), up = reach(image, {0, -1});
    QVERIFY2(across > 60 && std::abs(across - up) < across / 8,
             qPrintable(QString("%1 %2").arg(across).arg(up)));
    keepGrab("odd-far-apart.png");
  }

  void whatIsAllAlikeIsThatHuEverywhereOrSaidToBeNothing() {
    QVERIFY(open(even(kAirHu)).contains("no voxel of the tissue 'bone'"));
    const QColor nothing = volumePicture().pixelColor(volumePicture().rect().center());
    QVERIFY(open(even(kBone)).isEmpty());
    const QImage image = volumePicture();
    QVERIFY(image.pixelColor(image.rect().center()).lightness() > nothing.lightness() + 60);
    for (SliceAxis axis : kSliceAxes) {
      SliceView& slice = views().slice(axis);
      const QImage seen = slice.grab().toImage();
      QCOMPARE(seen.pixelColor(slice.width() / 4, slice.height() / 4).red(),
               int(views().colours().greyOf(kBone)));
    }
  }

  void viewsOfNoSizeDoNoHarm() {
    open(head({64, 64, 64}, Vec3(3.0)));
    const QImage before = volumePicture();
    std::vector<QWidget*> all{&view()};
    for (SliceAxis axis : kSliceAxes) all.push_back(&views().slice(axis));
    for (QWidget* widget : all) {
      const QRect place = widget->geometry();
      const QSize least = widget->minimumSize();
      widget->setMinimumSize(0, 0);
      for (const QSize& size : {QSize(0, 0), QSize(0, 80), QSize(80, 0), QSize(1, 1)}) {
        widget->resize(size);
        rest();
        QTest::keyClick(widget, Qt::Key_Plus);
        QWheelEvent wheel({}, {}, {}, {0, 120}, Qt::NoButton, {}, Qt::NoScrollPhase, false);
        QCoreApplication::sendEvent(widget, &wheel);
        widget->grab();
      }
      widget->setMinimumSize(least);
      widget->setGeometry(place);
    }
    view().lookAtAll({});
    QTRY_COMPARE_WITH_TIMEOUT(volumePicture(), before, kLong_ms);
  }

  void cleanupTestCase() { window_.reset(); }
};

int main(int argc, char** argv) {
  return test::runInWindow<OddCasesGuiTest>(argc, argv);
}

#include "odd_cases_gui_test.moc"
