#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QLabel>
#include <QPushButton>
#include <QRadioButton>
#include <QSlider>
#include <QSpinBox>
#include <QToolButton>
#include <QWheelEvent>

#include "imaging/codes.h"
#include "import_support.h"
#include "qt_support.h"
#include "ui/cases/choice_panel.h"
#include "ui/cases/report_card.h"
#include "ui/cases/series_list.h"
#include "ui/cases/size_panel.h"
#include "ui/cases/state_mark.h"
#include "ui/views/slice_preview.h"
#include "volume/codes.h"
#include "volume/reduce.h"

namespace trephine {
namespace {

using test::askingSeries;
using test::fakeSeries;

class ImportWidgetsTest : public ::testing::Test {
 protected:
  template <class Widget>
  static Widget& find(QWidget& parent, const char* name) {
    auto* widget = parent.findChild<Widget*>(name);
    if (!widget) throw std::runtime_error(std::string("there is no ") + name);
    return *widget;
  }
  QApplication& application_ = test::application();
};

// --- The list ---

TEST_F(ImportWidgetsTest, UsableCtComesFirstThenWhatAsksThenTheRest) {
  SeriesReport mr = fakeSeries("mr", Verdict::refused, 900);
  mr.modality = "MR";
  const std::vector<SeriesReport> series = {
      mr, fakeSeries("refused", Verdict::refused, 800), askingSeries("asks"),
      fakeSeries("small", Verdict::pass, 20), fakeSeries("large", Verdict::repaired, 300)};
  SeriesList list;
  list.showSeries(series, {});
  QStringList shown;
  for (int row = 0; row < list.count(); ++row) shown << list.item(row)->text();
  EXPECT_EQ(shown.join(", "), "Series large, Series small, Series asks, Series refused, Series mr");
}

TEST_F(ImportWidgetsTest, AStateIsSaidInAWordForThoseWhoDoNotSeeTheMark) {
  SeriesList list;
  list.showSeries({askingSeries("1")}, {});
  const auto spoken = [&] { return list.item(0)->data(Qt::AccessibleTextRole).toString(); };
  EXPECT_TRUE(spoken().contains("Has a question")) << spoken().toStdString();
  EXPECT_TRUE(spoken().contains("100 slices"));
  list.updateSeries(askingSeries("1"), {{code::kMissingSlices, "fill"}});
  EXPECT_TRUE(spoken().contains("As answered")) << spoken().toStdString();
}

TEST_F(ImportWidgetsTest, MarksDifferInShapeAndNotInColourAlone) {
  const auto shape = [](SeriesState state) {
    return stateIcon(state)
        .pixmap(QSize(48, 48), 1.0)
        .toImage()
        .convertToFormat(QImage::Format_Alpha8);
  };
  EXPECT_NE(shape(SeriesState::pass), shape(SeriesState::repaired));
  EXPECT_NE(shape(SeriesState::pass), shape(SeriesState::refused));
  EXPECT_NE(shape(SeriesState::repaired), shape(SeriesState::answered));
  EXPECT_NE(shape(SeriesState::asks), shape(SeriesState::pass));
  EXPECT_NE(shape(SeriesState::structures), shape(SeriesState::refused));
}

TEST_F(ImportWidgetsTest, OnlySeriesWithoutAThumbnailAskForOne) {
  SeriesList list;
  list.showSeries({fakeSeries("1", Verdict::pass, 30), fakeSeries("2", Verdict::pass, 20)}, {});
  EXPECT_EQ(list.withoutThumbnail(), (std::vector<std::string>{"1", "2"}));
  list.setThumbnail("1", QImage());  // it has none, and is not asked again
  EXPECT_EQ(list.withoutThumbnail(), (std::vector<std::string>{"2"}));
}

TEST_F(ImportWidgetsTest, TheSelectionIsTold) {
  SeriesList list;
  std::string selected = "none";
  QObject::connect(&list, &SeriesList::seriesSelected, &list,
                   [&] { selected = list.selectedUid(); });
  list.showSeries({fakeSeries("1", Verdict::pass, 30), fakeSeries("2", Verdict::pass, 20)}, {});
  list.select("2");
  EXPECT_EQ(selected, "2");
  list.showSeries({}, {});
  EXPECT_EQ(selected, "");
}

ScreenNames named(const char* patient_key, const char* study_key, const char* patient,
                  const char* study) {
  return {patient_key, study_key, patient, study};
}

// The lines over each item, "-" where there are none.
QString headings(const SeriesList& list) {
  QStringList all;
  for (int row = 0; row < list.count(); ++row) {
    const QStringList lines = list.item(row)->data(kHeadingRole).toStringList();
    all << (lines.isEmpty() ? QString("-") : lines.join('/'));
  }
  return all.join(" | ");
}

TEST_F(ImportWidgetsTest, SeriesStandTogetherUnderTheirPatientAndStudy) {
  const std::vector<SeriesReport> series = {
      fakeSeries("1", Verdict::pass, 400), fakeSeries("2", Verdict::pass, 300),
      fakeSeries("3", Verdict::pass, 200), fakeSeries("4", Verdict::refused, 100),
      fakeSeries("file", Verdict::pass, 50)};
  SeriesList list;
  list.showSeries(series, {},
                  {{"1", named("a", "s", "Doe, Jane", "Head")},
                   {"2", named("b", "t", "", "Hip")},
                   {"3", named("a", "u", "Doe, Jane", "")},
                   {"4", named("a", "s", "Doe, Jane", "Head")}});
  QStringList shown;
  for (int row = 0; row < list.count(); ++row) shown << list.item(row)->text();
  EXPECT_EQ(shown.join(", "), "Series 1, Series 4, Series 3, Series 2, Series file");
  EXPECT_EQ(headings(list),
            "Doe, Jane/Head | - | A study without a description | A patient without a name/Hip | "
            "Files of no patient");
}

TEST_F(ImportWidgetsTest, OnePatientIsNamedOnceAndNobodyWhereNothingIsKnown) {
  SeriesList list;
  list.showSeries(
      {fakeSeries("1", Verdict::pass), fakeSeries("2", Verdict::pass)}, {},
      {{"1", named("a", "s", "Doe, Jane", "")}, {"2", named("a", "s", "Doe, Jane", "")}});
  EXPECT_EQ(headings(list), "Doe, Jane | -");
  list.showSeries({fakeSeries("1", Verdict::pass), fakeSeries("2", Verdict::pass)}, {},
                  {{"1", named("a", "s", "", "")}, {"2", named("a", "s", "", "")}});
  EXPECT_EQ(headings(list), "- | -");
}

TEST_F(ImportWidgetsTest, WhatAScanFindsGrowsInItsPlaceAndKeepsTheSelection) {
  SeriesList list;
  list.showFound({{"1", "Head", "CT", 5, named("a", "s", "Doe, Jane", "")}});
  list.select("1");
  list.showFound({{"1", "Head", "CT", 80, named("a", "s", "Doe, Jane", "")},
                  {"2", "Hip", "CT", 3, named("b", "t", "Roe, Max", "")},
                  {"3", "Bone", "CT", 1, named("a", "s", "Doe, Jane", "")}});
  QStringList shown;
  for (int row = 0; row < list.count(); ++row) {
    shown << list.item(row)->data(Qt::AccessibleTextRole).toString();
  }
  EXPECT_EQ(shown.join(" | ").toStdString(),
            "Head, CT \u00b7 80 slices, Still looking | Bone, CT \u00b7 1 slice, Still looking | "
            "Hip, CT \u00b7 3 slices, Still looking");
  EXPECT_EQ(list.selectedUid(), "1");
}

// --- Questions ---

class ChoicePanelTest : public ImportWidgetsTest {
 protected:
  ChoicePanel panel_;
};

TEST_F(ChoicePanelTest, AnOptionShowsItsSliceAndWhatIsForTheScreenAlone) {
  const Choice phases{code::kPhases,
                      "Which phase?",
                      {"refuse", "1", "2"},
                      {"None", "One", "Two"},
                      {"", "arterial", "venous"},
                      {-1, 7, 9}};
  panel_.ask({phases}, {});
  EXPECT_EQ(panel_.slicesShown(), (std::vector{7, 9}));
  QStringList words;
  for (const QLabel* label : panel_.findChildren<QLabel*>()) words << label->text();
  EXPECT_TRUE(words.contains("arterial") && words.contains("venous"))
      << words.join(", ").toStdString();
  QImage slice(160, 80, QImage::Format_Grayscale8);
  slice.fill(Qt::gray);
  panel_.setPicture(9, slice);
  EXPECT_EQ(find<QLabel>(panel_, "picture_PHASES_2").pixmap().size(), QSize(72, 36));
  EXPECT_TRUE(find<QLabel>(panel_, "picture_PHASES_1").pixmap().isNull());
  EXPECT_EQ(panel_.findChild<QLabel*>("picture_PHASES_refuse"), nullptr);
  panel_.ask({}, {});
  panel_.setPicture(9, slice);  // of a series that is not shown any more
  EXPECT_TRUE(panel_.slicesShown().empty());
}

TEST_F(ChoicePanelTest, NothingIsAnsweredForThePerson) {
  panel_.ask({test::missingSlices(), test::couch()}, {});
  for (QRadioButton* button : panel_.findChildren<QRadioButton*>()) {
    EXPECT_FALSE(button->isChecked()) << button->objectName().toStdString();
  }
  EXPECT_FALSE(panel_.allAnswered());
  EXPECT_TRUE(panel_.answers().empty());
}

TEST_F(ChoicePanelTest, AnAnswerIsTheOptionsNameAndIsToldOnce) {
  panel_.ask({test::missingSlices(), test::couch()}, {});
  int told = 0;
  QObject::connect(&panel_, &ChoicePanel::answered, &panel_, [&] { ++told; });
  find<QRadioButton>(panel_, "choice_MISSING_SLICES_fill").click();
  EXPECT_EQ(told, 1);
  EXPECT_FALSE(panel_.allAnswered());
  find<QRadioButton>(panel_, "choice_COUCH_keep").click();
  find<QRadioButton>(panel_, "choice_COUCH_remove").click();
  EXPECT_EQ(panel_.answers(), (Answers{{code::kCouch, "remove"}, {code::kMissingSlices, "fill"}}));
  EXPECT_TRUE(panel_.allAnswered());
  EXPECT_EQ(told, 3);
}

TEST_F(ChoicePanelTest, WhatWasAnsweredBeforeIsShown) {
  panel_.ask({test::missingSlices()}, {{code::kMissingSlices, "fill"}, {code::kFace, "keep"}});
  EXPECT_TRUE(find<QRadioButton>(panel_, "choice_MISSING_SLICES_fill").isChecked());
  EXPECT_TRUE(panel_.allAnswered());
  EXPECT_EQ(panel_.answers(), (Answers{{code::kMissingSlices, "fill"}})) << "of what is asked only";
  panel_.ask({}, {});
  EXPECT_TRUE(panel_.findChildren<QRadioButton*>().isEmpty());
}

// --- How much, how finely ---

class SizePanelTest : public ImportWidgetsTest {
 protected:
  SizePanelTest() { panel_.setGrid(fakeSeries("1", Verdict::pass).geometry); }
  void set(const char* name, int value) { find<QSpinBox>(panel_, name).setValue(value); }
  SizePanel panel_;
};

TEST_F(SizePanelTest, TakesAllAtFullResolutionUntilToldOtherwise) {
  EXPECT_FALSE(panel_.crop().has_value());
  EXPECT_EQ(panel_.reduction(), 1);
  EXPECT_TRUE(find<QLabel>(panel_, "sizeOutcome").text().contains("64 \u00d7 48 \u00d7 100"));
}

TEST_F(SizePanelTest, CountsFromOneAndIncludesBothEnds) {
  set("cropFrom0", 11);
  set("cropTo0", 20);
  set("cropTo2", 50);
  EXPECT_EQ(panel_.crop(), (VoxelBox{{10, 0, 0}, {20, 48, 50}}));
  find<QPushButton>(panel_, "cropReset").click();
  EXPECT_FALSE(panel_.crop().has_value());
}

TEST_F(SizePanelTest, TheEndsDoNotPassEachOther) {
  set("cropTo1", 10);
  set("cropFrom1", 10);
  set("cropFrom1", 40);
  EXPECT_EQ(panel_.crop(), (VoxelBox{{0, 9, 0}, {64, 10, 100}}));
  EXPECT_TRUE(panel_.isRefused());
  QLabel& reason = find<QLabel>(panel_, "cropFrom1Refused");
  EXPECT_FALSE(reason.isHidden());
  EXPECT_TRUE(reason.text().contains("between 1 and 10")) << reason.text().toStdString();
  set("cropTo1", 45);
  EXPECT_TRUE(reason.isHidden()) << "now it can be had";
  EXPECT_EQ(panel_.crop(), (VoxelBox{{0, 39, 0}, {64, 45, 100}}));
}

TEST_F(SizePanelTest, AnEndBeyondTheGridIsRefusedAndNotCut) {
  set("cropTo2", 900);
  EXPECT_FALSE(panel_.crop().has_value());
  EXPECT_TRUE(panel_.isRefused());
  EXPECT_FALSE(find<QLabel>(panel_, "cropTo2Refused").isHidden());
  find<QPushButton>(panel_, "cropReset").click();
  EXPECT_FALSE(panel_.isRefused());
  EXPECT_EQ(find<QSpinBox>(panel_, "cropTo2").value(), 100);
}

TEST_F(SizePanelTest, SaysWhatComesOutAndWhatItWeighs) {
  find<QRadioButton>(panel_, "reduction2").click();
  EXPECT_EQ(panel_.reduction(), 2);
  const QString text = find<QLabel>(panel_, "sizeOutcome").text();
  EXPECT_TRUE(text.contains("32 \u00d7 24 \u00d7 50")) << text.toStdString();
  EXPECT_TRUE(text.contains("1.00 \u00d7 1.50 \u00d7 4.00 mm"));
  const GridGeometry odd =
      outcomeOf({{7, 8, 9}, Vec3(1.0), {}, Mat3(1.0)}, {{0, 0, 0}, {7, 8, 9}}, 4);
  EXPECT_EQ(odd.size, (Index3{2, 2, 3}));
}

TEST_F(SizePanelTest, ABoxBeyondTheGridIsCutToIt) {
  panel_.setBox({{-5, 3, 0}, {900, 20, 100}});
  EXPECT_EQ(panel_.box(), (VoxelBox{{0, 3, 0}, {64, 20, 100}}));
}

TEST_F(SizePanelTest, AGridThatIsNotKnownYetCannotBeCropped) {
  panel_.setGrid({});
  EXPECT_FALSE(panel_.crop().has_value());
  EXPECT_TRUE(find<QSpinBox>(panel_, "cropFrom0").isHidden() ||
              !find<QSpinBox>(panel_, "cropFrom0").isVisibleTo(&panel_));
  find<QRadioButton>(panel_, "reduction4").click();
  EXPECT_EQ(panel_.reduction(), 4);
}

// --- Slices ---

SlicePicture slice(int columns, int rows, const Vec3& spacing_mm, std::int16_t hu = 500) {
  return {columns, rows, spacing_mm,
          std::vector<std::int16_t>(std::size_t(columns) * std::size_t(rows), hu)};
}

class SlicePreviewTest : public ImportWidgetsTest {
 protected:
  SlicePreviewTest() {
    preview_.resize(400, 460);
    preview_.show();
    QObject::connect(&preview_, &SlicePreview::sliceWanted, &preview_,
                     [this](int index) { wanted_.push_back(index); });
    preview_.showStack(101);
  }
  void turnWheel(int eighths) {
    const QPointF at(200, 200);
    QWheelEvent event(at, preview_.mapToGlobal(at), {}, {0, eighths}, Qt::NoButton, Qt::NoModifier,
                      Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(&preview_, &event);
  }
  void press(int key) {
    QKeyEvent event(QEvent::KeyPress, key, Qt::NoModifier, QString(QChar(key)));
    QCoreApplication::sendEvent(&find<QSlider>(preview_, "sliceSlider"), &event);
  }
  SlicePreview preview_;
  std::vector<int> wanted_;
};

TEST_F(SlicePreviewTest, StartsInTheMiddleAndFollowsWheelAndKeys) {
  EXPECT_EQ(wanted_, (std::vector<int>{50}));
  turnWheel(-120);
  EXPECT_EQ(preview_.index(), 51);
  turnWheel(60);
  EXPECT_EQ(preview_.index(), 51) << "half a notch";
  turnWheel(60);
  EXPECT_EQ(preview_.index(), 50);
  press(Qt::Key_Right);
  press(Qt::Key_PageUp);
  EXPECT_EQ(preview_.index(), 61);
  press(Qt::Key_End);
  turnWheel(-120);  // there is nothing beyond
  EXPECT_EQ(preview_.index(), 100);
  EXPECT_EQ(wanted_.back(), 100);
  EXPECT_EQ(find<QLabel>(preview_, "slicePosition").text(), "Slice 101 of 101");
}

TEST_F(SlicePreviewTest, AWindowChangesThePictureAndNothingElse) {
  preview_.showSlice(50, slice(4, 4, Vec3(1.0)));
  EXPECT_EQ(preview_.canvas().image().constScanLine(0)[0], 128);
  find<QToolButton>(preview_, "window3").click();
  EXPECT_EQ(preview_.canvas().image().constScanLine(0)[0], 255);
  find<QToolButton>(preview_, "window2").click();
  EXPECT_EQ(preview_.canvas().image().constScanLine(0)[0], 128);
  EXPECT_EQ(preview_.index(), 50);
}

TEST_F(SlicePreviewTest, ASliceThatCannotBeReadSaysWhyInItsPlace) {
  preview_.showSlice(50, slice(4, 4, Vec3(1.0)));
  preview_.showSlice(49, Error{code::kUnreadable, "The file is cut", "", ""});
  EXPECT_FALSE(preview_.canvas().image().isNull()) << "that slice is not the one wanted";
  preview_.showSlice(50, Error{code::kUnreadable, "The file is cut", "", ""});
  EXPECT_TRUE(preview_.canvas().image().isNull());
}

TEST_F(SlicePreviewTest, ProportionsAreThoseOfThePatient) {
  preview_.showSlice(50, slice(100, 50, Vec3(1.0, 4.0, 1.0)));
  const QRectF target = preview_.canvas().target();
  EXPECT_NEAR(target.height() / target.width(), 2.0, 1e-9);
}

TEST_F(SlicePreviewTest, ADragDrawsABoxInTheSlicesPixels) {
  SliceCanvas& canvas = preview_.canvas();
  preview_.showSlice(50, slice(100, 50, Vec3(1.0, 4.0, 1.0)));
  QRect drawn;
  QObject::connect(&canvas, &SliceCanvas::boxDrawn, &canvas,
                   [&](const QRect& box) { drawn = box; });
  const QRectF target = canvas.target();
  const auto drag = [&](QPointF from, QPointF to) {
    const auto at = [&](QPointF share) {
      return QPointF(target.left() + share.x() * target.width(),
                     target.top() + share.y() * target.height());
    };
    QMouseEvent down(QEvent::MouseButtonPress, at(from), canvas.mapToGlobal(at(from)),
                     Qt::LeftButton, Qt::LeftButton, Qt::NoModifier);
    QMouseEvent move(QEvent::MouseMove, at(to), canvas.mapToGlobal(at(to)), Qt::NoButton,
                     Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&canvas, &down);
    QCoreApplication::sendEvent(&canvas, &move);
  };
  drag({0.105, 0.21}, {0.505, 0.81});
  EXPECT_TRUE(drawn.isNull()) << "nobody asked for a box";
  EXPECT_FALSE(canvas.window() == kWindowPresets[kFirstPreset].window)
      << "it set the window, as a drag does in every slice";
  EXPECT_EQ(preview_.findChild<QButtonGroup*>()->checkedId(), -1) << "which is no preset's now";
  canvas.setDrawable(true);
  drag({0.505, 0.81}, {0.105, 0.21});
  EXPECT_EQ(drawn, QRect(QPoint(10, 10), QPoint(50, 40)));
  drag({0.505, 0.51}, {2.0, 2.0});
  EXPECT_EQ(drawn.bottomRight(), QPoint(99, 49)) << "cut to the slice";
}

TEST_F(SlicePreviewTest, AHeadIsLookedAtAsBoneAndAnAbdomenAsSoftTissue) {
  const auto bone = kWindowPresets[1].window, soft = kWindowPresets[2].window;
  preview_.setBodyPart("HEAD");
  EXPECT_EQ(preview_.canvas().window(), bone);
  preview_.setBodyPart("Abdomen");
  EXPECT_EQ(preview_.canvas().window(), soft);
  EXPECT_EQ(preview_.findChild<QButtonGroup*>()->checkedId(), 2);
  preview_.canvas().setWindow(kWindowPresets[4].window);
  preview_.setBodyPart("Abdomen");
  EXPECT_EQ(preview_.canvas().window(), kWindowPresets[4].window) << "as a person has set it";
  EXPECT_EQ(windowOfBodyPart(""), soft);
  EXPECT_EQ(windowOfBodyPart("HEART"), soft);
  EXPECT_EQ(windowOfBodyPart("CSPINE"), bone);
}

TEST_F(SlicePreviewTest, TheFrontIsUpAndThePatientsRightIsAtTheLeftHoweverItIsStored) {
  // One white pixel: the patient's right front.
  const auto stored = [](int column, int row) {
    SlicePicture picture = slice(4, 4, Vec3(1.0), -2000);
    picture.hu[std::size_t(row * 4 + column)] = 3000;
    return picture;
  };
  const auto drawnAt = [&](const Mat3& direction, const SlicePicture& picture) {
    preview_.showStack(101, direction);
    preview_.showSlice(50, picture);
    const QImage& image = preview_.canvas().image();
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) {
        if (image.constScanLine(y)[x] == 255) return QPoint(x, y);
      }
    }
    return QPoint(-1, -1);
  };
  EXPECT_EQ(drawnAt(Mat3(1.0), stored(0, 0)), QPoint(0, 0)) << "head first, supine";
  const Mat3 from_ras(-1, 0, 0, 0, -1, 0, 0, 0, 1);
  EXPECT_EQ(drawnAt(from_ras, stored(3, 3)), QPoint(0, 0));
  const Mat3 coronal(1, 0, 0, 0, 0, 1, 0, -1, 0);  // rows go up
  EXPECT_EQ(drawnAt(coronal, stored(0, 3)), QPoint(0, 0)) << "the head is up";
}

TEST_F(SlicePreviewTest, ABoxIsThatOfTheStoredPixelsHoweverTheyAreDrawn) {
  SliceCanvas& canvas = preview_.canvas();
  preview_.showStack(101, Mat3(-1, 0, 0, 0, -1, 0, 0, 0, 1));
  preview_.showSlice(50, slice(100, 100, Vec3(1.0)));
  canvas.setDrawable(true);
  QRect drawn;
  QObject::connect(&canvas, &SliceCanvas::boxDrawn, &canvas,
                   [&](const QRect& box) { drawn = box; });
  const QRectF target = canvas.target();
  const auto at = [&](double x, double y) {
    return QPointF(target.left() + x * target.width(), target.top() + y * target.height());
  };
  QMouseEvent down(QEvent::MouseButtonPress, at(0.005, 0.005), {}, Qt::LeftButton, Qt::LeftButton,
                   Qt::NoModifier);
  QMouseEvent move(QEvent::MouseMove, at(0.105, 0.205), {}, Qt::NoButton, Qt::LeftButton,
                   Qt::NoModifier);
  QCoreApplication::sendEvent(&canvas, &down);
  QCoreApplication::sendEvent(&canvas, &move);
  EXPECT_EQ(drawn, QRect(QPoint(89, 79), QPoint(99, 99)));
  canvas.setKept(drawn);
  const QImage picture = canvas.grab().toImage();
  EXPECT_GT(picture.pixelColor(at(0.05, 0.1).toPoint()).lightness(), 100) << "kept";
  EXPECT_LT(picture.pixelColor(at(0.5, 0.5).toPoint()).lightness(), 100) << "left out";
}

TEST_F(SlicePreviewTest, ASliceOfAVolumeIsItsVoxelsInOrder) {
  Volume volume;
  volume.geometry.size = {2, 2, 2};
  volume.geometry.spacing_mm = {1.0, 2.0, 3.0};
  volume.hu = {0, 1, 2, 3, 4, 5, 6, 7};
  const SlicePicture top = sliceOf(volume, 1);
  EXPECT_EQ(top.hu, (std::vector<std::int16_t>{4, 5, 6, 7}));
  EXPECT_EQ(top.spacing_mm, Vec3(1.0, 2.0, 3.0));
  EXPECT_TRUE(sliceOf(volume, 2).hu.empty());
}

// --- The card ---

TEST_F(ImportWidgetsTest, TheCardSaysTheVerdictAndTheMemoryThatIsNeeded) {
  ReportCard card;
  SeriesReport series = fakeSeries("1", Verdict::pass);
  card.showSeries(series, {}, 5000.0, 2000.0);
  EXPECT_EQ(find<QLabel>(card, "verdictWord").text(), "Pass");
  EXPECT_TRUE(find<QLabel>(card, "verdictSentence").text().startsWith("Ready to use"));
  EXPECT_TRUE(find<QLabel>(card, "memoryNeeded").text().contains("lower resolution"));
  card.showSeries(askingSeries("2"), {}, 5000.0, 2000.0);
  EXPECT_EQ(find<QLabel>(card, "verdictWord").text(), "Has a question");
  EXPECT_TRUE(find<QLabel>(card, "reportCard").text().contains("Two slices are missing"));
}

}  // namespace
}  // namespace trephine
