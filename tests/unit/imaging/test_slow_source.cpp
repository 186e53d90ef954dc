// A stick of 5 MB/s: how long it still takes is told, cancelling is heard at once, and what
// vanishes is refused as a whole.
#include <array>
#include <atomic>
#include <cstring>
#include <future>
#include <thread>

#include "base/time_left.h"
#include "series_fixture.h"
#include "slow_source/slow_source.h"
#include "support.h"

namespace trephine::test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kStick = 5e6;  // bytes a second
constexpr std::uint64_t kUnderWay = 1'000'000;
constexpr auto kAtOnce = std::chrono::milliseconds(500);

class SlowSourceTest : public SeriesFixture {
 protected:
  // Slices of the given size in a folder of their own below folder().
  void writeSlices(const char* name, Index3 size) {
    const Status written = writeCtSeries(rampVolume(size), {name, "HEAD"}, folder() / name);
    ASSERT_TRUE(written.ok()) << written.error().sentence();
  }
  // An enhanced CT of one file.
  void writeEnhanced(int frames) {
    Image image;
    image.columns = image.rows = 256;
    image.frames = frames;
    std::vector<Vec3> positions;
    image.stored.assign(std::size_t(image.pixels()) * std::size_t(frames), 100);
    for (int k = 0; k < frames; ++k) positions.emplace_back(0.0, 0.0, k);
    DcmDataset data = makeEnhanced(image, positions);
    fs::create_directories(folder());
    save(data, folder() / "enhanced");
  }
  // 1000 x 1000 x `slices` int16 voxels.
  void writeNifti(const std::string& name, int slices) {
    std::string header(352, '\0');
    const auto put = [&](std::size_t at, auto value) {
      std::memcpy(header.data() + at, &value, sizeof value);
    };
    put(0, std::int32_t(348));
    const std::array<std::int16_t, 8> dim = {3, 1000, 1000, std::int16_t(slices), 1, 1, 1, 1};
    put(40, dim);
    put(70, std::int16_t(4));
    put(72, std::int16_t(16));
    const std::array<float, 8> pixdim = {1, 1, 1, 1, 1, 1, 1, 1};
    put(76, pixdim);
    put(108, 352.0F);
    put(112, 1.0F);
    put(254, std::int16_t(1));
    const std::array<float, 12> rows = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    put(280, rows);
    put(344, std::array<char, 4>{'n', '+', '1', '\0'});
    std::string voxels(std::size_t(2000000) * std::size_t(slices), '\x18');
    for (std::size_t n = 1; n < voxels.size(); n += 2) voxels[n] = '\xFC';
    // A fiftieth is tissue, else it would be air alone.
    for (std::size_t n = 0; n < voxels.size(); n += 100) voxels.replace(n, 2, "\x28\0", 2);
    writeBytes(folder() / name, header + voxels);
  }

  // How long `work` goes on after it was cancelled, in the middle of its reading.
  template <class Work>
  static Clock::duration timeToCancel(Work work) {
    Progress progress;
    auto outcome = std::async(std::launch::async, [&] { return work(progress); });
    const auto isOver = [&] {
      return outcome.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    };
    const std::uint64_t before = bytesOfSlowSource();
    EXPECT_TRUE(waitUntil([&] { return bytesOfSlowSource() - before > kUnderWay || isOver(); }));
    EXPECT_FALSE(isOver()) << "it was over before it could be cancelled";
    const auto cancelled = Clock::now();
    progress.cancel();
    const std::string code = outcome.get();
    const auto took = Clock::now() - cancelled;
    EXPECT_EQ(code, "CANCELLED");
    std::printf("cancelled in %.0f ms\n", std::chrono::duration<double, std::milli>(took).count());
    return took;
  }
  template <class T>
  static std::string codeOf(const Result<T>& result) {
    return result ? "" : result.error().code.str();
  }
};

// The first step that names a time left, at which `work` is cancelled; empty where none came.
template <class Work>
std::string timeTold(Work work) {
  std::string told;
  Progress progress(withTimeLeft([&](double, const std::string& step) {
    if (!told.empty() || step.find(" left") == step.npos) return;
    told = step;
    progress.cancel();
  }));
  EXPECT_EQ(work(progress), "CANCELLED");
  return told;
}

TEST_F(SlowSourceTest, ScanningTellsHowLongItStillTakes) {
  writeSlices("many", {64, 64, 2047});
  writeSlices("more", {64, 64, 1000});
  const SlowSource slow(folder().c_str(), kStick);
  const std::string told =
      timeTold([&](const Progress& p) { return codeOf(CtFolder::scan(folder(), p)); });
  EXPECT_EQ(told.find("Reading headers, about "), 0u)
      << told << " after " << bytesOfSlowSource() << " bytes";
}

TEST_F(SlowSourceTest, ReadingTellsHowLongItStillTakes) {
  writeSlices("head", {512, 512, 50});
  CtFolder ct = scan();
  const SlowSource slow(folder().c_str(), kStick);
  const std::string told =
      timeTold([&](const Progress& p) { return codeOf(ct.read(*ct.bestSeries(), {}, p)); });
  EXPECT_EQ(told.find("Reading slices, about "), 0u) << told;
}

TEST_F(SlowSourceTest, AScanIsCancelledAtOnce) {
  writeSlices("many", {64, 64, 2047});
  const SlowSource slow(folder().c_str(), kStick);
  EXPECT_LT(timeToCancel([&](const Progress& p) { return codeOf(CtFolder::scan(folder(), p)); }),
            kAtOnce);
}

TEST_F(SlowSourceTest, AScanOfOneLargeFileReadsItsHeaderAlone) {
  writeEnhanced(80);
  ASSERT_GT(fs::file_size(folder() / "enhanced"), 10'000'000u);
  const SlowSource slow(folder().c_str(), kStick);
  EXPECT_EQ(codeOf(CtFolder::scan(folder(), Progress())), "");
  EXPECT_GT(bytesOfSlowSource(), 0u);
  EXPECT_LT(bytesOfSlowSource(), kUnderWay);
}

TEST_F(SlowSourceTest, AScanThatComparesCopiesIsCancelledAtOnce) {
  writeSlices("head", {512, 512, 20});
  fs::copy(folder() / "head", folder() / "again");
  const SlowSource slow(folder().c_str(), kStick);
  EXPECT_LT(timeToCancel([&](const Progress& p) { return codeOf(CtFolder::scan(folder(), p)); }),
            kAtOnce);
}

TEST_F(SlowSourceTest, ReadingSlicesIsCancelledAtOnce) {
  writeSlices("head", {1024, 1024, 20});
  CtFolder ct = scan();
  const SlowSource slow(folder().c_str(), kStick);
  EXPECT_LT(
      timeToCancel([&](const Progress& p) { return codeOf(ct.read(*ct.bestSeries(), {}, p)); }),
      kAtOnce);
}

TEST_F(SlowSourceTest, ReadingFramesOfOneFileIsCancelledAtOnce) {
  writeEnhanced(80);
  CtFolder ct = scan();
  const SlowSource slow(folder().c_str(), kStick);
  EXPECT_LT(
      timeToCancel([&](const Progress& p) { return codeOf(ct.read(*ct.bestSeries(), {}, p)); }),
      kAtOnce);
}

TEST_F(SlowSourceTest, ReadingOrShowingAVolumeFileIsCancelledAtOnce) {
  writeNifti("volume.nii", 8);
  CtFolder ct = scan();
  const SlowSource slow(folder().c_str(), kStick);
  EXPECT_LT(
      timeToCancel([&](const Progress& p) { return codeOf(ct.read("file:volume.nii", {}, p)); }),
      kAtOnce);
  EXPECT_LT(
      timeToCancel([&](const Progress& p) { return codeOf(ct.slice("file:volume.nii", 3, p)); }),
      kAtOnce);
}

// --- What vanishes ---

TEST_F(SlowSourceTest, ASourceThatVanishesWhileItIsReadIsRefusedAsAWhole) {
  writeSlices("head", {256, 256, 60});
  CtFolder ct = scan();
  {
    const SlowSource slow(folder().c_str(), 1e9, 2e6);  // of 8 MB
    const auto volume = ct.read(*ct.bestSeries(), {}, Progress());
    ASSERT_FALSE(volume);
    EXPECT_EQ(volume.error().code.str(), "SOURCE_VANISHED") << volume.error().sentence();
    EXPECT_EQ(volume.error().what, "The source vanished while it was read");
    const SeriesReport& series = ct.report().series.front();
    EXPECT_EQ(series.verdict, Verdict::refused);
    EXPECT_EQ(find(series, "MISSING_SLICES"), nullptr) << codes(series);
  }
  EXPECT_TRUE(ct.read(ct.report().series.front().uid, {}, Progress())) << "it is there again";
}

TEST_F(SlowSourceTest, AFolderThatIsRemovedWhileItIsReadIsRefusedAsAWhole) {
  for (const bool files_only : {false, true}) {
    writeSlices("head", {512, 512, 40});
    CtFolder ct = scan();
    const SlowSource slow(folder().c_str(), 20e6);
    std::thread away([&] {
      EXPECT_TRUE(waitUntil([] { return bytesOfSlowSource() > 5'000'000; }));
      for (int n = 40; files_only && n > 15; --n) {
        char name[32];
        std::snprintf(name, sizeof name, "IM%04d.dcm", n);
        fs::remove(folder() / "head" / name);
      }
      if (!files_only) fs::remove_all(folder());
    });
    const auto volume = ct.read(*ct.bestSeries(), {}, Progress());
    away.join();
    ASSERT_FALSE(volume);
    EXPECT_EQ(volume.error().code.str(), "SOURCE_VANISHED") << volume.error().sentence();
  }
}

TEST_F(SlowSourceTest, AFewSlicesThatCannotBeReadAreStillAskedAbout) {
  writeSlices("head", {64, 64, 40});
  CtFolder ct = scan();
  for (const char* name : {"IM0007.dcm", "IM0008.dcm", "IM0009.dcm"}) {
    fs::remove(folder() / "head" / name);
  }
  const auto volume = ct.read(*ct.bestSeries(), {}, Progress());
  ASSERT_FALSE(volume);
  EXPECT_EQ(volume.error().code.str(), "MISSING_SLICES") << volume.error().sentence();
}

TEST_F(SlowSourceTest, AVolumeFileThatVanishesIsRefusedByTheSameName) {
  writeNifti("volume.nii", 4);
  CtFolder ct = scan();
  {
    const SlowSource slow(folder().c_str(), 1e9, 3e6);
    EXPECT_EQ(codeOf(ct.read("file:volume.nii", {}, Progress())), "SOURCE_VANISHED");
  }
  EXPECT_EQ(codeOf(ct.read("file:volume.nii", {}, Progress())), "");
  fs::remove(folder() / "volume.nii");
  EXPECT_EQ(codeOf(ct.read("file:volume.nii", {}, Progress())), "SOURCE_VANISHED");
}

TEST_F(SlowSourceTest, ASourceThatVanishesWhileItIsScannedIsNoShorterSeries) {
  writeSlices("many", {32, 32, 200});
  const SlowSource slow(folder().c_str(), 1e9, 4e5);
  EXPECT_EQ(codeOf(CtFolder::scan(folder(), Progress())), "SOURCE_VANISHED");
}

// --- A series that is opened before the scan ends ---

TEST_F(SlowSourceTest, AFoundSeriesCanBeHadBeforeTheScanEnds) {
  writeSlices("a", {64, 64, 100});
  writeSlices("b", {64, 64, 1500});
  const SlowSource slow(folder().c_str(), kStick);
  std::atomic<int> calls{0}, most{0};
  ScanGuide* at_hand = nullptr;
  ScanGuide guide([&](const std::vector<FoundSeries>& found) {
    ++calls;
    most = std::max(most.load(), int(found.size()));
    if (found.front().description == "a" && found.front().slices >= 50) {
      at_hand->choose(found.front().uid);
    }
  });
  at_hand = &guide;
  Result<CtFolder> ct = CtFolder::scan(folder(), Progress(), &guide);
  ASSERT_TRUE(ct);
  EXPECT_GE(calls.load(), 1);
  const auto series = std::ranges::find(ct->report().series, "a", &SeriesReport::description);
  ASSERT_NE(series, ct->report().series.end());
  EXPECT_EQ(series->slices, 100) << "its folder was looked at to the end";
  EXPECT_EQ(series->verdict, Verdict::repaired);
  const Finding* stopped = find(*series, "SCAN_STOPPED");
  ASSERT_NE(stopped, nullptr) << codes(*series);
  EXPECT_EQ(stopped->severity, Severity::repair);
  EXPECT_NE(stopped->text.find("files were not looked at"), std::string::npos) << stopped->text;
  EXPECT_EQ(ct->report().files_seen, 1600);
  int left = 0;
  for (const SkippedFiles& skipped : ct->report().skipped) left += skipped.count;
  EXPECT_GT(left, 500);
  EXPECT_EQ(ct->report().files_read + left, 1600);
  const auto other = std::ranges::find(ct->report().series, "b", &SeriesReport::description);
  if (other != ct->report().series.end()) {
    EXPECT_EQ(other->verdict, Verdict::refused) << "half of a series is none";
    EXPECT_EQ(find(*other, "SCAN_STOPPED")->severity, Severity::refusal);
  }
  EXPECT_EQ(ct->bestSeries(), series->uid);
  const auto volume = ct->read(series->uid, {}, Progress());
  ASSERT_TRUE(volume) << volume.error().sentence();
  EXPECT_NE(find(ct->report().series[0], "SCAN_STOPPED"), nullptr) << "reading keeps it";
}

TEST_F(SlowSourceTest, AScanThatIsOnlyWatchedLooksAtEverything) {
  writeSlices("a", {32, 32, 10});
  writeSlices("b", {32, 32, 20});
  ScanGuide guide([](const std::vector<FoundSeries>&) {});
  guide.choose("no such series");
  const Result<CtFolder> ct = CtFolder::scan(folder(), Progress(), &guide);
  ASSERT_TRUE(ct);
  EXPECT_EQ(ct->report().files_read, 30);
  for (const SeriesReport& series : ct->report().series) {
    EXPECT_EQ(series.verdict, Verdict::pass) << codes(series);
  }
}

}  // namespace
}  // namespace trephine::test
