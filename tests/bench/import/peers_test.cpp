#include "bench/import/peers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "base/child_process.h"
#include "support.h"
#include "unit/lab/import_fixture.h"
#include "volume/volume_files.h"

namespace trephine::bench {
namespace {

// A volume file that another program might write of the known volume.
class KnownVoxels : public ::testing::Test {
 protected:
  KnownVoxels() {
    volume_.geometry.size = {4, 3, 2};
    for (int n = 0; n < 24; ++n) volume_.hu.push_back(std::int16_t(n * n - 100));
    known_ = {volume_.geometry, volumeSha256(volume_)};
  }
  // The same voxels in the same places, rows and slices the other way round.
  Volume turned() const {
    Volume out = volume_;
    GridGeometry& g = out.geometry;
    g.origin_mm = volume_.geometry.toPatient_mm(Vec3(0, 2, 1));
    g.direction[1] = -g.direction[1];
    g.direction[2] = -g.direction[2];
    for (int k = 0; k < 2; ++k) {
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 4; ++i) out.hu[g.indexOf(i, j, k)] = volume_.at(i, 2 - j, 1 - k);
      }
    }
    return out;
  }
  bool holds(const Volume& volume) const {
    const Status written = writeVolume(volume, folder_ / "x.nii");
    EXPECT_TRUE(written);
    return holdsKnownVoxels(folder_ / "x.nii", known_);
  }

  test::TemporaryFolder folder_;
  Volume volume_;
  KnownVolume known_;
};

TEST_F(KnownVoxels, AreFoundWhicheverWayRowsAndSlicesRun) {
  EXPECT_TRUE(holds(volume_));
  EXPECT_TRUE(holds(turned()));
}

TEST_F(KnownVoxels, AreNotThereWhereOneIsOffOrOutOfItsPlace) {
  Volume off = volume_;
  off.hu[7] += 1;
  EXPECT_FALSE(holds(off));
  Volume mirrored = turned();
  mirrored.geometry.direction = volume_.geometry.direction;
  EXPECT_FALSE(holds(mirrored));
  Volume shorter = volume_;
  shorter.geometry.size[2] = 1;
  shorter.hu.resize(12);
  EXPECT_FALSE(holds(shorter));
  EXPECT_FALSE(holdsKnownVoxels(folder_ / "none.nii", known_));
}

class MeasuredWithPeers : public test::Measured {
 protected:
  // The series are none, and so are the programs of this machine.
  void measureBeside(double limit_s) {
    const test::Environment path("PATH", (folder_ / "peers").string());
    subjects_ = withPeers(std::move(subjects_), limit_s);
    options_.series.names = {"int16"};
    measured_ = measure();
  }
  bool grantsNamespaces() const {
    return find(measured_, "int16", "dcm2niix").skipped_reason.find("namespace") ==
           std::string::npos;
  }
  void SetUp() override { std::filesystem::create_directory(folder_ / "peers"); }

  ImportMeasurement measured_;
};

TEST_F(MeasuredWithPeers, ThoseThatAreNotInstalledAreSkipped) {
  measureBeside(120.0);
  for (const char* peer : {"dcm2niix", "dicomtonifti"}) {
    const ImportRow& r = find(measured_, "int16", peer);
    EXPECT_EQ(r.skipped_reason, "not installed");
    EXPECT_FALSE(r.seconds_median);
    EXPECT_FALSE(r.correct);
  }
  ASSERT_EQ(measured_.scan.size(), 2u);
  EXPECT_EQ(measured_.scan[1].loader, "gdcmscanner");
  EXPECT_EQ(measured_.scan[1].skipped_reason, "not installed");
}

TEST_F(MeasuredWithPeers, ThoseThatAreTextAreNotProgramsToRun) {
  ASSERT_TRUE(writeTextFile(folder_ / "peers" / "dcm2niix", "not a program"));
  measureBeside(120.0);
  EXPECT_EQ(find(measured_, "int16", "dcm2niix").skipped_reason, "not installed");
}

TEST_F(MeasuredWithPeers, ThoseThatFailWriteNothingOrTakeTooLongSaySo) {
  program("peers/dcm2niix", "exec /bin/sleep 60");
  program("peers/dicomtonifti", ":");
  program("peers/gdcmscanner", "exit 3");
  measureBeside(1.0);
  if (!grantsNamespaces()) GTEST_SKIP() << "this system grants no namespaces";
  EXPECT_EQ(find(measured_, "int16", "dcm2niix").skipped_reason, "took over 1 s");
  EXPECT_EQ(find(measured_, "int16", "dicomtonifti").skipped_reason, "wrote 0 volumes");
  EXPECT_EQ(find(measured_, "int16", "dicomtonifti").correct, false);
  EXPECT_EQ(measured_.scan[1].skipped_reason, "failed with exit code 3");
}

TEST_F(MeasuredWithPeers, TheyHaveNoNetworkButAnUnconnectedLoopback) {
  ChildCommand command;
  command.words = offline({"/bin/sh", "-c", "cat /proc/net/route; cat /proc/net/dev"});
  command.output = folder_ / "stdout";
  command.home = folder_.path();
  const Result<ChildRun> run = runChild(command, Progress());
  ASSERT_TRUE(run) << run.error().sentence();
  if (run->exit_code != 0) GTEST_SKIP() << "this system grants no namespaces";
  std::ifstream in(folder_ / "stdout");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(std::count(text.begin(), text.end(), ':'), 1) << text;
  EXPECT_NE(text.find("lo:"), std::string::npos) << text;
}

}  // namespace
}  // namespace trephine::bench
