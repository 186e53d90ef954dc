// A slice view alone: what the mouse and the keys do to it, and what it shows.
#include "ui/views/slice_view.h"

#include <gtest/gtest.h>

#include <QtTest>
#include <glm/gtc/matrix_transform.hpp>

#include "qt_support.h"

using namespace trephine;

namespace {

TissueSet bone() {
  Tissue tissue;
  tissue.id = "bone";
  tissue.name = "Bone";
  tissue.hu_min = 300;
  tissue.hu_max = 3000;
  return {"set", {tissue}};
}

// Each voxel a HU of its own.
Volume numberedSlices(const Mat3& direction, const Index3& size = {40, 30, 12}) {
  Volume volume;
  GridGeometry& g = volume.geometry;
  g.size = size;
  g.spacing_mm = {0.5, 0.8, 2.0};
  g.origin_mm = {-31.0, 12.5, 140.0};
  g.direction = direction;
  volume.hu.resize(g.voxelCount());
  for (std::size_t i = 0; i < volume.hu.size(); ++i) volume.hu[i] = std::int16_t(i % 2500);
  return volume;
}

class SliceViewTest : public testing::Test {
 protected:
  SliceViewTest() { test::application(); }

  void show(Volume volume, SliceAxis axis = SliceAxis::axial,
            std::shared_ptr<const LabelMap> labels = nullptr) {
    colours_.setTissues(bone());
    mirror_->show(std::move(volume), std::move(labels));
    view_ = std::make_unique<SliceView>(axis, mirror_, colours_, toolbox_);
    QObject::connect(view_.get(), &SliceView::pointChosen, view_.get(),
                     [this](const Vec3& point) { view_->setPoint(point); });
    QObject::connect(view_.get(), &SliceView::windowChosen, view_.get(),
                     [this](const HuWindow& window) {
                       colours_.setWindow(window);
                       view_->coloursChanged();
                     });
    view_->resize(400, 420);
    view_->show();
    view_->takeChanges();
    view_->setPoint(mirror_->volume().geometry.centre_mm());
  }
  const GridGeometry& grid() { return mirror_->volume().geometry; }
  // The middle of a pixel of the slice.
  QPointF at(int x, int y) { return view_->toWidget({x + 0.5, y + 0.5}); }
  void mouse(QEvent::Type type, const QPointF& at, Qt::MouseButton button,
             Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    const bool move = type == QEvent::MouseMove;
    QMouseEvent event(type, at, view_->mapToGlobal(at), move ? Qt::NoButton : button,
                      type == QEvent::MouseButtonRelease ? Qt::NoButton : button, modifiers);
    QCoreApplication::sendEvent(view_.get(), &event);
  }
  void hover(const QPointF& at) { mouse(QEvent::MouseMove, at, Qt::NoButton); }
  void drag(const QPointF& from, const QPointF& to, Qt::MouseButton button = Qt::LeftButton,
            Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    mouse(QEvent::MouseButtonPress, from, button, modifiers);
    mouse(QEvent::MouseMove, to, button, modifiers);
    mouse(QEvent::MouseButtonRelease, to, button, modifiers);
  }
  void press(Qt::Key key) { QTest::keyClick(view_.get(), key); }
  void wheel(int eighths, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    const QPointF at(200, 200);
    QWheelEvent event(at, view_->mapToGlobal(at), {}, {0, eighths}, Qt::NoButton, modifiers,
                      Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(view_.get(), &event);
  }
  QImage picture() { return view_->grab().toImage(); }
  int grey(const QPointF& at) { return qRed(picture().pixel(at.toPoint())); }

  SliceColours colours_;
  Toolbox toolbox_;
  std::shared_ptr<VolumeMirror> mirror_ = std::make_shared<VolumeMirror>();
  std::unique_ptr<SliceView> view_;
};

TEST_F(SliceViewTest, SaysTheStoredHuUnderThePointerInAnyGrid) {
  const Mat3 oblique(glm::rotate(Mat4(1.0), 0.7, glm::normalize(Vec3(1, 2, -0.5))));
  for (const Mat3& direction : {Mat3(1.0), Mat3(-1, 0, 0, 0, -1, 0, 0, 0, 1), oblique}) {
    for (SliceAxis axis : kSliceAxes) {
      show(numberedSlices(direction), axis);
      const QRectF box = view_->target();
      int read = 0;
      for (int n = 1; n < 20; ++n) {
        const QPointF place =
            box.topLeft() + QPointF(box.width() * n / 20.0, box.height() * (n * 7 % 20) / 20.0);
        hover(place);
        const auto voxel = voxelAt(grid(), view_->toPatient_mm(place));
        if (!voxel) {
          EXPECT_TRUE(view_->readout().isEmpty());
          continue;
        }
        ++read;
        const int hu = mirror_->volume().at((*voxel)[0], (*voxel)[1], (*voxel)[2]);
        const QString words = QString("%1 HU").arg(hu) + (hu >= 300 ? " \u00b7 Bone" : "");
        EXPECT_EQ(view_->readout(), words);
      }
      EXPECT_GT(read, 5);
    }
  }
}

TEST_F(SliceViewTest, SaysTheLabelToo) {
  const Volume volume = numberedSlices(Mat3(1.0));
  LabelMap map{volume.geometry, std::vector<std::uint8_t>(volume.hu.size(), 4)};
  show(volume, SliceAxis::axial, std::make_shared<const LabelMap>(std::move(map)));
  hover(at(20, 10));
  EXPECT_TRUE(view_->readout().endsWith("label 4")) << view_->readout().toStdString();
}

TEST_F(SliceViewTest, ShowsACutAtOnceAndIsDrawnOnlyWhereOneTouchesIt) {
  Volume volume = numberedSlices(Mat3(1.0));
  volume.hu.assign(volume.hu.size(), 1400);
  Grid grid(volume);
  show(volume);
  EXPECT_GT(grey(at(20, 10)), 240);
  const int drawn = view_->drawn();
  const int k = view_->slice();
  const auto cut = [&](int slice) {
    auto writer = grid.takeWriter();
    for (int j = 5; j < 15; ++j) {
      for (int i = 15; i < 25; ++i) writer->store(i, j, slice, kAirHu);
    }
  };
  cut(k);
  ASSERT_TRUE(mirror_->pull(grid));
  view_->takeChanges();
  EXPECT_LT(grey(at(20, 10)), 10);
  EXPECT_EQ(view_->drawn(), drawn + 1);
  hover(at(20, 10));
  EXPECT_EQ(view_->readout(), "-1000 HU");
  picture();
  EXPECT_EQ(view_->drawn(), drawn + 1) << "a pointer that moves draws no slice";

  show(numberedSlices(Mat3(1.0), {40, 30, 40}));
  Grid tall(numberedSlices(Mat3(1.0), {40, 30, 40}));
  picture();
  const int before = view_->drawn();
  tall.takeWriter()->store(3, 3, 39, kAirHu);  // far above
  ASSERT_TRUE(mirror_->pull(tall));
  view_->takeChanges();
  picture();
  EXPECT_EQ(view_->drawn(), before);
}

TEST_F(SliceViewTest, GoesThroughItsSlicesByWheelAndKeysAndStopsAtTheirEnds) {
  show(numberedSlices(Mat3(1.0), {40, 30, 60}));
  EXPECT_EQ(view_->slice(), 30);
  wheel(-120);
  EXPECT_EQ(view_->slice(), 31);
  wheel(60);
  EXPECT_EQ(view_->slice(), 31) << "half a notch";
  wheel(60);
  EXPECT_EQ(view_->slice(), 30);
  press(Qt::Key_Up);
  EXPECT_EQ(view_->slice(), 31);
  press(Qt::Key_PageUp);
  EXPECT_EQ(view_->slice(), 41);
  press(Qt::Key_End);
  press(Qt::Key_Up);
  EXPECT_EQ(view_->slice(), 59);
  press(Qt::Key_Home);
  press(Qt::Key_PageDown);
  EXPECT_EQ(view_->slice(), 0);
  hover(at(7, 9));
  EXPECT_EQ(view_->readout(), QString("%1 HU \u00b7 Bone").arg(9 * 40 + 7));
}

TEST_F(SliceViewTest, WindowsByKeysAndByDragging) {
  show(numberedSlices(Mat3(1.0)));
  for (std::size_t i = 0; i < kWindowPresets.size(); ++i) {
    press(Qt::Key(Qt::Key_1 + int(i)));
    EXPECT_EQ(colours_.window(), kWindowPresets[i].window);
    const Index3 v{20, 10, view_->slice()};
    EXPECT_NEAR(grey(at(v[0], v[1])), colours_.greyOf(mirror_->volume().at(v[0], v[1], v[2])), 3);
  }
  press(Qt::Key_2);
  const HuWindow before = colours_.window();
  drag({150, 150}, {210, 150});
  EXPECT_GT(colours_.window().width_hu, before.width_hu * 1.2) << "right is wider";
  EXPECT_EQ(colours_.window().centre_hu, before.centre_hu);
  press(Qt::Key_2);
  const int grey_before = grey(at(20, 10));
  drag({150, 150}, {150, 90});
  EXPECT_LT(colours_.window().centre_hu, before.centre_hu);
  EXPECT_GT(grey(at(20, 10)), grey_before + 20) << "up is brighter";
  drag({150, 150}, {-90000, 90000});
  EXPECT_GE(colours_.window().width_hu, 1.0);
}

TEST_F(SliceViewTest, ZoomsAroundThePointerAndShifts) {
  show(numberedSlices(Mat3(1.0)));
  const QPointF centre(200, 200);
  const QPointF place = view_->toSlice(centre);
  const double scale = view_->pixelsPerMm();
  wheel(240, Qt::ControlModifier);
  EXPECT_GT(view_->pixelsPerMm(), 1.15 * scale);
  EXPECT_NEAR(view_->toSlice(centre).x(), place.x(), 1e-9);
  EXPECT_NEAR(view_->toSlice(centre).y(), place.y(), 1e-9);
  const QPointF marked = view_->toWidget(place);
  drag({100, 100}, {130, 90}, Qt::MiddleButton);
  EXPECT_NEAR(view_->toWidget(place).x(), marked.x() + 30, 1e-9);
  EXPECT_NEAR(view_->toWidget(place).y(), marked.y() - 10, 1e-9);
  const double nearer = view_->pixelsPerMm();
  drag({100, 100}, {100, 60}, Qt::RightButton);
  EXPECT_GT(view_->pixelsPerMm(), 1.2 * nearer);
  press(Qt::Key_0);
  EXPECT_NEAR(view_->pixelsPerMm(), scale, 1e-9);
}

TEST_F(SliceViewTest, MeasuresALengthAndAnAngleAndForgetsThemAgain) {
  show(numberedSlices(Mat3(1.0)));
  press(Qt::Key_M);
  drag(at(5, 5), at(25, 20));
  ASSERT_EQ(view_->measures().size(), 1u);
  const double truth = std::hypot(20 * 0.5, 15 * 0.8);
  EXPECT_NEAR(length_mm(view_->measures()[0]), truth, 0.25);
  drag(at(8, 8), at(8, 8));
  drag(at(8, 8), at(8, 8));
  EXPECT_EQ(view_->measures().size(), 1u) << "two clicks at one place are no ruler";
  drag(at(8, 8), at(8, 8));
  drag(at(28, 8), at(28, 8));
  ASSERT_EQ(view_->measures().size(), 2u) << "two clicks are one";
  EXPECT_NEAR(length_mm(view_->measures()[1]), 20 * 0.5, 0.25);
  hover(at(15, 12.5));  // at the first
  press(Qt::Key_Delete);
  ASSERT_EQ(view_->measures().size(), 1u);
  EXPECT_NEAR(length_mm(view_->measures()[0]), 20 * 0.5, 0.25) << "it removed the one it was at";
  press(Qt::Key_Delete);
  EXPECT_TRUE(view_->measures().empty()) << "else the last";
  drag(at(5, 5), at(25, 20));

  press(Qt::Key_N);
  for (const QPointF& point : {at(30, 5), at(10, 5), at(10, 25)}) {
    mouse(QEvent::MouseButtonPress, point, Qt::LeftButton);
    mouse(QEvent::MouseButtonRelease, point, Qt::LeftButton);
  }
  ASSERT_EQ(view_->measures().size(), 2u);
  EXPECT_NEAR(angle_deg(view_->measures()[1]), 90.0, 0.5);

  wheel(-120);
  press(Qt::Key_Delete);
  EXPECT_EQ(view_->measures().size(), 2u) << "those of this slice alone";
  wheel(120);
  press(Qt::Key_Delete);
  ASSERT_EQ(view_->measures().size(), 1u);
  EXPECT_EQ(view_->measures()[0].kind, Measure::Kind::ruler);
  mouse(QEvent::MouseButtonPress, at(3, 3), Qt::LeftButton);
  press(Qt::Key_Escape);
  press(Qt::Key_Escape);
  press(Qt::Key_Delete);
  EXPECT_TRUE(view_->measures().empty());
  const HuWindow before = colours_.window();
  drag({150, 150}, {210, 150});
  EXPECT_NE(colours_.window(), before) << "the mouse has the window again";
}

TEST_F(SliceViewTest, APointIsChosenWithShiftAndStaysInTheSlice) {
  show(numberedSlices(Mat3(1.0)));
  Vec3 chosen(0.0);
  QObject::connect(view_.get(), &SliceView::pointChosen, view_.get(),
                   [&](const Vec3& point) { chosen = point; });
  drag(at(5, 5), at(11, 9), Qt::LeftButton, Qt::ShiftModifier);
  const Vec3 voxel = toVoxel(grid(), chosen);
  EXPECT_LT(glm::distance(voxel, Vec3(11, 9, view_->slice())), 1e-6);
  drag(at(5, 5), at(-50, 900), Qt::LeftButton, Qt::ShiftModifier);
  EXPECT_LT(glm::distance(toVoxel(grid(), chosen), Vec3(0, 29, view_->slice())), 1e-6);
}

TEST_F(SliceViewTest, ALineOfAnotherViewIsDraggedAndThePointerSaysSo) {
  show(numberedSlices(Mat3(1.0)));
  const HuWindow window = colours_.window();
  const auto voxel = [&] { return toVoxel(grid(), view_->point_mm()); };
  const auto shape = [&](const QPointF& place) {
    hover(place);
    return view_->cursor().shape();
  };
  const QPointF point = view_->fromPatient(view_->point_mm());
  const QPointF on_vertical(point.x() + 3, point.y() + 60);
  const QPointF on_horizontal(point.x() - 60, point.y() - 3);
  EXPECT_EQ(shape(on_vertical), Qt::SplitHCursor);
  EXPECT_EQ(shape(on_horizontal), Qt::SplitVCursor);
  EXPECT_EQ(shape(point + QPointF(2, -2)), Qt::SizeAllCursor) << "both, where they meet";
  EXPECT_EQ(shape(point + QPointF(30, 30)), Qt::ArrowCursor);

  const Vec3 before = voxel();
  drag(on_vertical, on_vertical);
  EXPECT_EQ(voxel(), before) << "taking hold moves nothing";
  const double pixels_a_voxel = at(1, 0).x() - at(0, 0).x();
  drag(on_vertical, on_vertical + QPointF(6 * pixels_a_voxel, 25));
  EXPECT_NEAR(voxel().x, before.x + 6, 1e-6);
  EXPECT_EQ(voxel().y, before.y) << "the other line stays";
  EXPECT_EQ(voxel().z, before.z);
  drag(on_horizontal, on_horizontal + QPointF(40, -100000));
  EXPECT_NEAR(voxel().x, before.x + 6, 1e-6);
  EXPECT_NEAR(voxel().y, 0.0, 1e-6) << "it stays in the case";
  view_->setPoint(grid().centre_mm());
  drag(point, point + QPointF(2 * pixels_a_voxel, 0) + (at(0, 3) - at(0, 0)));
  EXPECT_NEAR(voxel().x, before.x + 2, 1e-6);
  EXPECT_NEAR(voxel().y, before.y + 3, 1e-6);
  EXPECT_EQ(colours_.window(), window) << "and no window changes";

  // A measure begins on a line as anywhere, and so does whatever another button does.
  view_->setPoint(grid().centre_mm());
  press(Qt::Key_M);
  EXPECT_EQ(shape(on_vertical), Qt::CrossCursor);
  drag(on_vertical, on_vertical + QPointF(50, 10));
  EXPECT_EQ(view_->measures().size(), 1u);
  press(Qt::Key_Escape);
  drag(on_vertical, on_vertical + QPointF(50, 10), Qt::MiddleButton);
  EXPECT_EQ(voxel(), before);
}

TEST_F(SliceViewTest, MarksAToolBoldlyInItsSliceAndFaintlyBeyond) {
  Volume dark = numberedSlices(Mat3(1.0));
  dark.hu.assign(dark.hu.size(), kAirHu);
  show(dark);
  ToolView tool;
  tool.colour = {1.0, 0.6, 0.1};
  tool.length_mm = 4.0;
  const auto orange = [&](int k) {
    tool.pose_mm.position = grid().toPatient_mm(Vec3(12, 22, k));
    view_->setTools({tool});
    const QImage image = picture();
    const QPoint tip = at(12, 22).toPoint();
    int count = 0;
    for (int y = -8; y <= 8; ++y) {
      for (int x = -8; x <= 8; ++x) {
        const QColor c = image.pixelColor(tip + QPoint(x, y));
        count += c.red() > 90 && c.red() > 2 * c.blue();
      }
    }
    return count;
  };
  const int inside = orange(view_->slice()), beyond = orange(view_->slice() + 3);
  EXPECT_GT(inside, 60);
  EXPECT_GT(beyond, 5);
  EXPECT_GT(inside, 2 * beyond);
  view_->setTools({});
  EXPECT_EQ(qRed(picture().pixel(at(12, 22).toPoint())), 0);
}

// The letter as it is drawn where nothing is under the pointer.
TEST_F(SliceViewTest, TheLetterBelowStaysReadableHoweverLongTheNameOfATissueIs) {
  show(numberedSlices(Mat3(1.0)));
  TissueSet set = bone();
  set.tissues[0].name = "Bone of the kind that has a very long name";
  set.tissues[0].hu_min = -3000;
  colours_.setTissues(set);
  for (int width : {310, 340, 400, 640}) {
    view_->resize(width, 420);
    const QRect letter(width / 2 - 6, 400, 12, 20);
    const auto drawn = [&](const QPointF& pointer) {
      hover(pointer);
      return view_->grab(letter).toImage();
    };
    const QImage alone = drawn({-5, -5});
    EXPECT_EQ(drawn(at(20, 12)), alone) << width;
    EXPECT_FALSE(view_->readout().isEmpty());
  }
}

TEST_F(SliceViewTest, TheScaleBarIsAsLongAsItSaysToThePixel) {
  Volume dark = numberedSlices(Mat3(1.0));
  dark.hu.assign(dark.hu.size(), kAirHu);
  show(dark);
  for (int width = 300; width < 640; width += 17) {
    view_->resize(width, 420);
    view_->fit();
    const QImage image = picture();
    int first = 0, last = 0;
    for (int x = width / 2; x < width; ++x) {
      if (qGray(image.pixel(x, 420 - 7)) < 150) continue;
      if (first == 0) first = x;
      last = x;
    }
    const double mm = (last - first) / view_->pixelsPerMm();
    double apart = 1e9;
    for (double round_mm : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0}) {
      apart = std::min(apart, std::abs(mm - round_mm) * view_->pixelsPerMm());
    }
    EXPECT_LE(apart, 0.51) << width;
  }
}

TEST_F(SliceViewTest, OfOneSliceOfEqualHuOrOfNoSizeIsAPictureAndNoCrash) {
  Volume flat = numberedSlices(Mat3(1.0), {40, 30, 1});
  flat.hu.assign(flat.hu.size(), 500);
  for (SliceAxis axis : kSliceAxes) {
    show(flat, axis);
    press(Qt::Key_2);
    const QRectF box = view_->target();
    EXPECT_GT(box.width(), 0.0);
    const GridGeometry& s = view_->stack();
    EXPECT_NEAR(box.width() / box.height(),
                s.size[0] * s.spacing_mm.x / (s.size[1] * s.spacing_mm.y), 1e-6);
    EXPECT_EQ(grey(box.center() + QPointF(3, box.height() / 4.0)), 128);
    press(Qt::Key_PageUp);
    for (const QSize& size : {QSize(0, 0), QSize(0, 80), QSize(1, 1)}) {
      view_->setMinimumSize(0, 0);
      view_->resize(size);
      QImage into(8, 8, QImage::Format_RGB32);
      view_->render(&into);
      hover({0, 0});
      wheel(-120);
      drag({0, 0}, {5, 5});
    }
  }
}

TEST_F(SliceViewTest, WithoutACaseItSaysSo) {
  view_ = std::make_unique<SliceView>(SliceAxis::axial, mirror_, colours_, toolbox_);
  view_->resize(200, 200);
  view_->takeChanges();
  press(Qt::Key_PageUp);
  wheel(-120);
  drag({10, 10}, {90, 90});
  hover({20, 20});
  EXPECT_TRUE(view_->readout().isEmpty());
  const QImage image = picture();
  int bright = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) bright += qGray(image.pixel(x, y)) > 80;
  }
  EXPECT_GT(bright, 20);
}

}  // namespace
