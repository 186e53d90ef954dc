#include "ui/work/import_task.h"

#include <gtest/gtest.h>

#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QRadioButton>
#include <QTemporaryDir>

#include "imaging/dicom/ct_writer.h"
#include "qt_support.h"
#include "support.h"
#include "ui/cases/import_page.h"
#include "ui/common/words.h"
#include "volume/case_memory.h"
#include "volume/volume_files.h"

namespace trephine {
namespace {

using test::waitFor;

// Every voxel says in which slice it lies.
Volume stack(int slices, std::int16_t first_hu) {
  Volume volume;
  volume.geometry.size = {16, 12, slices};
  volume.geometry.spacing_mm = {1.0, 1.0, 2.0};
  for (int k = 0; k < slices; ++k) {
    volume.hu.insert(volume.hu.end(), std::size_t(16 * 12), std::int16_t(first_hu + k));
  }
  return volume;
}

class ImportTaskTest : public ::testing::Test {
 protected:
  ImportTaskTest() {
    write(stack(40, -100), "forty");
    write(stack(10, 200), "ten");
    QObject::connect(&task_, &ImportTask::scanned, &task_, [this] { ++scanned_; });
    QObject::connect(&task_, &ImportTask::readDone, &task_, [this] { ++read_; });
    QObject::connect(&task_, &ImportTask::stopped, &task_, [this] { ++stopped_; });
    QObject::connect(&task_, &ImportTask::failed, &task_,
                     [this](const Error& error) { error_ = error; });
    QObject::connect(&task_, &ImportTask::sliceReady, &task_,
                     [this](const QString&, int index, const Result<SlicePicture>& picture) {
                       slices_.push_back(index);
                       last_hu_ = picture ? int(picture->hu[0]) : -1;
                     });
  }
  void write(const Volume& volume, const char* name) {
    const Status written = writeCtSeries(volume, {name, "HEAD"}, path() / name);
    ASSERT_TRUE(written.ok()) << written.error().sentence();
  }
  std::filesystem::path path() const { return toPath(folder_.path()); }
  void scan() {
    task_.scan(path());
    ASSERT_TRUE(waitFor([&] { return scanned_ == 1; }));
  }

  QApplication& application_ = test::application();
  QTemporaryDir folder_;
  double given_back_mb_ = 0.0;
  ImportTask task_{[this] { return given_back_mb_; }};
  int scanned_ = 0, read_ = 0, stopped_ = 0, last_hu_ = -1;
  std::vector<int> slices_;
  std::optional<Error> error_;
};

// As the workspace shows it.
struct ShownPage : ImportPage {
  explicit ShownPage(ImportTask& task) : ImportPage(task) {
    connect(this, &ImportPage::opened, this, &QWidget::show);
    connect(this, &ImportPage::closed, this, &QWidget::hide);
  }
};

TEST_F(ImportTaskTest, AScanListsTheSeriesAndARreadGivesTheVoxels) {
  scan();
  ASSERT_EQ(task_.report().series.size(), 2u);
  ASSERT_TRUE(task_.bestSeries());
  task_.read(*task_.bestSeries(), {});
  ASSERT_TRUE(waitFor([&] { return read_ == 1; }));
  ASSERT_TRUE(task_.volume());
  EXPECT_EQ(task_.volume()->hu, stack(40, -100).hu);
  EXPECT_EQ(task_.report().chosen, task_.bestSeries());
  EXPECT_FALSE(task_.isWorking());
}

TEST_F(ImportTaskTest, WhatCouldBeReadButNotPractisedOnIsRefusedBeforeItIsRead) {
  scan();
  const std::string uid = *task_.bestSeries();
  const double promised_mb = task_.report().series.front().memory_mb;
  {
    const test::DataLimit limit(0.9 * promised_mb - kWindow_mb);
    task_.read(uid, {}, promised_mb - kWindow_mb);
    ASSERT_TRUE(waitFor([&] { return error_.has_value(); }));
    EXPECT_EQ(error_->code.str(), "OUT_OF_MEMORY");
    EXPECT_NE(error_->what.find("practising"), std::string::npos) << error_->what;
    EXPECT_FALSE(task_.volume());
  }
  task_.read(uid, {}, promised_mb - kWindow_mb);
  ASSERT_TRUE(waitFor([&] { return read_ == 1; })) << "it is there for another try";
}

TEST_F(ImportTaskTest, OfManySlicesWantedInARushTheLastIsShownAndMostAreNeverRead) {
  scan();
  for (int i = 0; i < 40; ++i) task_.wantSlice(*task_.bestSeries(), i);
  ASSERT_TRUE(waitFor([&] { return !slices_.empty() && slices_.back() == 39; }));
  EXPECT_EQ(last_hu_, -61);
  EXPECT_LE(slices_.size(), 2u) << "the one under way, and the last";
}

TEST_F(ImportTaskTest, EverySeriesGetsItsThumbnail) {
  scan();
  std::map<QString, QImage> thumbnails;
  QObject::connect(&task_, &ImportTask::thumbnailReady, &task_,
                   [&](const QString& uid, const QImage& picture) { thumbnails[uid] = picture; });
  std::vector<std::string> uids;
  for (const SeriesReport& series : task_.report().series) uids.push_back(series.uid);
  task_.wantThumbnails(uids);
  ASSERT_TRUE(waitFor([&] { return thumbnails.size() == 2; }));
  for (const auto& [uid, picture] : thumbnails) EXPECT_FALSE(picture.isNull());
}

TEST_F(ImportTaskTest, SlicesThatTellPhasesApartComeBeforeTheThumbnails) {
  scan();
  std::vector<int> order;
  QObject::connect(&task_, &ImportTask::thumbnailReady, &task_,
                   [&](const QString&, const QImage&) { order.push_back(-1); });
  QObject::connect(&task_, &ImportTask::pictureReady, &task_,
                   [&](const QString&, int slice, const QImage& picture) {
                     EXPECT_FALSE(picture.isNull());
                     order.push_back(slice);
                   });
  const std::string uid = *task_.bestSeries();
  task_.wantThumbnails({uid, uid});
  task_.wantPictures(uid, {3, 4});
  ASSERT_TRUE(waitFor([&] { return order.size() == 4; }));
  EXPECT_EQ(order, (std::vector{-1, 4, 3, -1})) << "one was under way";
}

TEST_F(ImportTaskTest, AReadGoesBeforeTheThumbnailsThatWait) {
  scan();
  std::vector<QString> order;
  QObject::connect(&task_, &ImportTask::thumbnailReady, &task_,
                   [&](const QString&, const QImage&) { order.push_back("thumbnail"); });
  QObject::connect(&task_, &ImportTask::readDone, &task_, [&] { order.push_back("read"); });
  const std::string uid = *task_.bestSeries();
  task_.wantThumbnails({uid, uid, uid});
  task_.read(uid, {});
  ASSERT_TRUE(waitFor([&] { return order.size() == 4; }));
  EXPECT_EQ(order[1], "read") << "only the thumbnail under way comes before";
}

TEST_F(ImportTaskTest, AFolderThatIsMissingLeavesTheOneBefore) {
  scan();
  task_.scan(path() / "nowhere");
  ASSERT_TRUE(waitFor([&] { return error_.has_value(); }));
  EXPECT_EQ(error_->code.str(), "MISSING_FOLDER");
  EXPECT_EQ(stopped_, 1);
  EXPECT_EQ(task_.report().series.size(), 2u);
}

TEST_F(ImportTaskTest, WhatIsCancelledStopsWithoutAnError) {
  task_.scan(path());
  task_.cancel();
  ASSERT_TRUE(waitFor([&] { return stopped_ + scanned_ == 1; }));
  EXPECT_EQ(stopped_, 1);
  EXPECT_FALSE(error_.has_value());
  EXPECT_FALSE(task_.hasFolder());
}

TEST_F(ImportTaskTest, WhatIsCancelledAsItEndsCountsAsCancelled) {
  const std::size_t threads = test::threadsNamed().size();
  task_.scan(path());
  // It is done, and nothing of it has been delivered.
  ASSERT_TRUE(test::waitUntil([&] { return test::threadsNamed().size() <= threads; }));
  task_.cancel();
  ASSERT_TRUE(waitFor([&] { return stopped_ + scanned_ == 1; }));
  EXPECT_EQ(stopped_, 1);
  EXPECT_FALSE(task_.hasFolder());
}

TEST_F(ImportTaskTest, AnotherFolderTakesThePlaceOfTheOneBeingScanned) {
  task_.scan(path());
  task_.scan(path() / "ten");
  ASSERT_TRUE(waitFor([&] { return scanned_ == 1; }));
  EXPECT_FALSE(task_.isWorking()) << "nothing comes after it";
  QCoreApplication::processEvents();
  EXPECT_EQ(scanned_, 1);
  EXPECT_EQ(task_.report().series.size(), 1u);
  EXPECT_EQ(stopped_, 0);
}

TEST_F(ImportTaskTest, AfterARefusedImportTheDialogKeepsTheSizeThatWasChosen) {
  ShownPage dialog(task_);
  task_.scan(path());
  auto* import = dialog.findChild<QPushButton*>("import");
  ASSERT_TRUE(waitFor([&] { return import->isEnabled(); }));
  auto* half = dialog.findChild<QRadioButton*>("reduction2");
  half->click();
  // Whoever reads a picture reserves a stack that would count as room once he is done.
  auto* list = dialog.findChild<SeriesList*>();
  ASSERT_TRUE(waitFor([&] { return list->withoutThumbnail().empty(); }));
  {
    const test::DataLimit limit(200.0);
    import->click();
    ASSERT_TRUE(waitFor([&] { return error_.has_value(); }));
    EXPECT_EQ(error_->code.str(), "OUT_OF_MEMORY");
  }
  EXPECT_TRUE(half->isChecked());
}

TEST_F(ImportTaskTest, WhatTheOpenCaseGivesBackCountsForTheNext) {
  scan();
  const test::DataLimit limit(100.0);
  given_back_mb_ = 1000.0;
  task_.read(*task_.bestSeries(), {}, 500.0);
  ASSERT_TRUE(waitFor([&] { return read_ == 1 || error_.has_value(); }));
  EXPECT_FALSE(error_ && error_->what.find("practising") != std::string::npos)
      << error_->sentence();
}

TEST_F(ImportTaskTest, ThePromiseAfterBackIsThatOfTheWholeSeries) {
  Volume large;
  large.geometry.size = {256, 256, 40};
  large.hu.assign(large.geometry.voxelCount(), 100);
  write(large, "large");
  ShownPage dialog(task_);
  task_.scan(path() / "large");
  auto* import = dialog.findChild<QPushButton*>("import");
  ASSERT_TRUE(waitFor([&] { return import->isEnabled(); }));
  auto* memory = dialog.findChild<QLabel*>("memoryNeeded");
  auto* outcome = dialog.findChild<QLabel*>("sizeOutcome");
  const QString whole = outcome->text(), promised = memory->text().section(';', 0, 0);
  dialog.findChild<QRadioButton*>("reduction2")->click();
  import->click();
  auto* open = dialog.findChild<QPushButton*>("openCase");
  ASSERT_TRUE(waitFor([&] { return open->isVisible(); }));
  dialog.findChild<QPushButton*>("importBack")->click();
  dialog.findChild<QRadioButton*>("reduction1")->click();
  EXPECT_EQ(outcome->text(), whole);
  EXPECT_EQ(memory->text().section(';', 0, 0), promised);
}

TEST_F(ImportTaskTest, TheDialogImportsTheBestSeriesAsItStands) {
  ShownPage dialog(task_);
  Case of;
  QObject::connect(&dialog, &ImportPage::caseRead, &dialog, [&](const Case& read) { of = read; });
  task_.scan(path());
  EXPECT_TRUE(dialog.isVisible()) << "it opens by itself";
  auto* import = dialog.findChild<QPushButton*>("import");
  EXPECT_FALSE(import->isEnabled());
  ASSERT_TRUE(waitFor([&] { return import->isEnabled(); }));
  import->click();
  ASSERT_TRUE(waitFor([&] { return of.volume != nullptr; }));
  EXPECT_EQ(of.volume->hu, stack(40, -100).hu);
  EXPECT_EQ(of.name, "forty");
  EXPECT_EQ(of.sha256, volumeSha256(*of.volume));
  ASSERT_TRUE(of.provenance);
  EXPECT_EQ(of.provenance->volume_sha256, of.sha256);
  EXPECT_FALSE(dialog.isVisible());
  EXPECT_FALSE(task_.volume()) << "the dialog keeps no second copy";

  dialog.open();
  EXPECT_TRUE(import->isEnabled()) << "another series of the same folder";
}

TEST_F(ImportTaskTest, AClickThatComesLateForCancelIsNoImport) {
  ShownPage dialog(task_);
  task_.scan(path());
  auto* cancel = dialog.findChild<QPushButton*>("cancelImport");
  auto* import = dialog.findChild<QPushButton*>("import");
  const auto placeOf = [&](QPushButton* button) {
    QApplication::processEvents();
    return QRect(button->mapTo(&dialog, QPoint()), button->size());
  };
  const QRect cancelled = placeOf(cancel);
  ASSERT_FALSE(cancelled.isEmpty());
  ASSERT_TRUE(waitFor([&] { return import->isEnabled(); }));
  EXPECT_FALSE(placeOf(import).intersects(cancelled));
}

TEST_F(ImportTaskTest, ALabelMapBesideTheCtIsOfferedWithItAndLeftUnlessItIsChosen) {
  write(stack(40, -100), "labelled/ct");
  ASSERT_TRUE(writeVolume(stack(60, 0), path() / "labelled" / "organs_seg.nii.gz"));
  ShownPage dialog(task_);
  std::vector<std::filesystem::path> labels;
  QObject::connect(&dialog, &ImportPage::caseRead, &dialog,
                   [&](const Case&, const std::filesystem::path& file) { labels.push_back(file); });
  auto* import = dialog.findChild<QPushButton*>("import");
  auto* offered = dialog.findChild<QComboBox*>("labelFile");
  task_.scan(path() / "labelled");
  ASSERT_TRUE(waitFor([&] { return import->isEnabled(); }));
  EXPECT_TRUE(offered->isVisible());
  EXPECT_EQ(offered->currentText(), "None");
  import->click();
  ASSERT_TRUE(waitFor([&] { return labels.size() == 1; }));
  EXPECT_TRUE(labels.back().empty());

  dialog.open();
  offered->setCurrentIndex(1);
  EXPECT_EQ(offered->currentText(), "organs_seg.nii.gz");
  import->click();
  ASSERT_TRUE(waitFor([&] { return labels.size() == 2; }));
  EXPECT_EQ(labels.back(), path() / "labelled" / "organs_seg.nii.gz");

  task_.scan(path() / "ten");
  ASSERT_TRUE(waitFor([&] { return import->isEnabled(); }));
  EXPECT_FALSE(offered->isVisible());
}

TEST_F(ImportTaskTest, ADialogThatIsClosedStopsItsWork) {
  ShownPage dialog(task_);
  task_.scan(path());
  dialog.reject();
  ASSERT_TRUE(waitFor([&] { return !task_.isWorking(); }));
  EXPECT_FALSE(dialog.isVisible());
  EXPECT_FALSE(task_.hasFolder());
}

}  // namespace
}  // namespace trephine
