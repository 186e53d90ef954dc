// How often a case's voxels are in memory in the real window: what their owners count, against what
// the process has written to.
#include <QApplication>
#include <QtTest>
#include <utility>

#include "base/file.h"
#include "base/system.h"
#include "gui_support.h"
#include "memory_probe.h"
#include "shells.h"
#include "ui/common/words.h"
#include "volume/case_memory.h"
#include "volume/volume_files.h"
#include "volume/voxel_slabs.h"

using namespace trephine;

namespace {

// A ball of bone around brain, 180 mm across, in a box of so many voxels a side and 200 mm.
Volume head(int edge, double voxel_mm) {
  return test::shells(edge, voxel_mm, {{90, -20}, {80, 1200}, {70, 35}});
}

std::size_t bytesOf(const Volume& volume) {
  return volume.hu.size() * sizeof(std::int16_t);
}

}  // namespace

class CopiesGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  std::filesystem::path exercise(const Volume& volume, const char* name) {
    return test::exerciseOn(volume, toPath(temporary_.path()), name);
  }
  // Opened, drawn and everything written that comes with it.
  void open(const std::filesystem::path& exercise) {
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openPath(exercise);
    QVERIFY(opened.wait(kLong_ms));
    settle();
  }
  void settle() {
    bool whole = false;
    for (int i = 0; i < 40 && !(whole && i > 1); ++i) {
      QSignalSpy painted(&window_->view(), &ViewWidget::framePainted);
      window_->view().update();
      QVERIFY(painted.wait(kLong_ms));
      whole = painted.back().at(1).toBool();
    }
    QVERIFY(whole);
    waitUntilSteady();
  }
  // The texture is sent with the first picture, hashes are taken in the background.
  void waitUntilSteady() {
    restRefined();
    constexpr std::size_t kLooks = 50;  // apart
    std::vector<double> seen_mb;
    const auto steady = [&] {
      seen_mb.push_back(test::privateDirtyMb());
      return seen_mb.size() > kLooks &&
             std::abs(seen_mb.back() - seen_mb[seen_mb.size() - 1 - kLooks]) < 1.0;
    };
    QVERIFY2(QTest::qWaitFor(steady, kLong_ms), "memory does not come to rest");
  }
  double exercise_mb() {
    const double before_mb = test::privateDirtyMb();
    window_->startExercise();
    [&] { QTRY_VERIFY_WITH_TIMEOUT(workstation().session(), kLong_ms); }();
    [&] { QTRY_VERIFY(workstation().session()->state().ticks > 1500); }();
    waitUntilSteady();
    return test::privateDirtyMb() - before_mb;
  }
  void stop() {
    workstation().stop();
    QTRY_COMPARE_WITH_TIMEOUT(workstation().phase(), Workstation::Phase::ready, kLong_ms);
  }

 private slots:
  void areTwoOfACaseThatIsOpenAndThreeOfOneThatIsPractisedOn() {
    real_time_ = true;  // its threads hold their memory
    window_ = newWindow(toPath(temporary_.path()) / "recordings");
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    // What an exercise takes beside its voxels, once the stacks of all threads were held.
    const int small_edge = 64, edge = 400;
    open(exercise(head(small_edge, 200.0 / small_edge), "small"));
    const double first_mb = exercise_mb();
    stop();
    const double beside_mb = exercise_mb();
    stop();
    std::printf("beside its voxels the first exercise takes %.0f MB, the second %.0f\n", first_mb,
                beside_mb);
    QVERIFY2(beside_mb < kExercise_mb, "what was promised");
    QVERIFY(first_mb - beside_mb < kHeld_mb);

    // The same texture and no case, only a mirror, which is written in whole: whether pages that
    // were read alone count differs between kernels.
    const auto large = exercise(head(edge, 200.0 / edge), "large");
    const std::size_t count = std::size_t(edge) * edge * edge;
    const double copy_mb = voxelsMb(count);
    Volume blank;
    blank.geometry.size = {edge, edge, edge};
    blank.geometry.spacing_mm = Vec3(200.0 / edge);
    blank.hu.assign(count, -1000);
    window_->views().showVolume(std::move(blank), nullptr);
    settle();
    const double baseline_mb = test::privateDirtyMb() - copy_mb;

    test::hashed_bytes = 0;
    open(large);
    const double opened_mb = test::privateDirtyMb() - baseline_mb;
    const std::size_t owned =
        bytesOf(*workstation().currentCase()->volume) + bytesOf(window_->view().shownVolume());
    QCOMPARE(owned, 2 * sizeof(std::int16_t) * count);
    std::printf("a copy has %.1f MB; opened: %.2f copies\n", copy_mb, opened_mb / copy_mb);
    QVERIFY(std::abs(opened_mb / copy_mb - 2.0) < 0.2);
    QCOMPARE(std::size_t(test::hashed_bytes), 2 * count);

    const double running_mb = exercise_mb();
    const double slab_mb =
        voxelsMb(VoxelSlabs::kMostVoxels);  // that is hashed; the small case is less
    const double copies = (opened_mb + running_mb - solidMb(count) - slab_mb - beside_mb) / copy_mb;
    std::printf(
        "practised on: %.2f copies, and %.0f MB beside them; %.0f MB more of %.0f promised\n",
        copies, beside_mb, running_mb, exerciseMb(count, true));
    QVERIFY2(running_mb < exerciseMb(count, true), "what was promised");
    QCOMPARE(workstation().session()->grid().geometry().voxelCount(), count);
    QVERIFY(std::abs(copies - 3.0) < 0.3);
    stop();
    QCOMPARE(std::size_t(test::hashed_bytes), 2 * 2 * count);
    const double ended_mb = test::privateDirtyMb() - baseline_mb;
    std::printf("ended: %.2f copies\n", ended_mb / copy_mb);
    QVERIFY(ended_mb / copy_mb < 3.5);
  }
};

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  return test::runInWindow<CopiesGuiTest>(argc, argv);
}

#include "copies_gui_test.moc"
