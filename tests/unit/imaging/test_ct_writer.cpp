#include "series_fixture.h"

namespace trephine::test {

using CtWriter = SeriesFixture;

TEST_F(CtWriter, AVolumeReadsBackExactly) {
  const Volume volume = rampVolume();
  write(volume);
  const Volume back = import();
  EXPECT_EQ(back.geometry, volume.geometry);
  EXPECT_EQ(back.hu, volume.hu);
  EXPECT_EQ(chosen().verdict, Verdict::pass);
  EXPECT_TRUE(chosen().findings.empty()) << codes(chosen());
  EXPECT_EQ(chosen().description, "Test series");
  EXPECT_EQ(chosen().volume_sha256, volumeSha256(volume));
}

TEST_F(CtWriter, HuBelowThoseOfAirAreStoredSigned) {
  Volume volume = rampVolume();
  volume.hu.front() = -32768;
  volume.hu.back() = 32767;
  write(volume);
  edit(slice(1), [](DcmDataset& data) { EXPECT_EQ(text(data, DCM_PixelRepresentation), "1"); });
  EXPECT_EQ(import().hu, volume.hu);
  EXPECT_EQ(chosen().hu_min, -32768);
  EXPECT_EQ(chosen().hu_max, 32767);
}

TEST_F(CtWriter, OrdinaryCtIsStoredUnsignedWithTheUsualIntercept) {
  write(rampVolume());
  edit(slice(1), [](DcmDataset& data) {
    EXPECT_EQ(text(data, DCM_PixelRepresentation), "0");
    EXPECT_EQ(text(data, DCM_RescaleIntercept), "-1024");
    EXPECT_EQ(text(data, DCM_PatientName), "TREPHINE^PHANTOM");
  });
}

TEST_F(CtWriter, AnObliqueVolumeKeepsItsPlaceAndDirection) {
  Volume volume = rampVolume();
  const Vec3 i = glm::normalize(Vec3(1.0, 0.2, -0.1));
  const Vec3 k = glm::normalize(glm::cross(i, Vec3(0.1, 1.0, 0.3)));
  volume.geometry.direction = Mat3(i, glm::cross(k, i), k);
  write(volume);
  const Volume back = import();
  EXPECT_EQ(back.hu, volume.hu);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(glm::distance(back.geometry.direction[axis], volume.geometry.direction[axis]), 1e-9);
  }
  EXPECT_LT(glm::distance(back.geometry.origin_mm, volume.geometry.origin_mm), 1e-9);
  EXPECT_LT(glm::distance(back.geometry.spacing_mm, volume.geometry.spacing_mm), 1e-9);
}

TEST_F(CtWriter, ALeftHandedVolumeComesBackRightHandedWithEveryVoxelInItsPlace) {
  Volume volume = rampVolume();
  volume.geometry.direction[2] = {0, 0, -1};
  write(volume);
  const Volume back = import();
  EXPECT_NEAR(glm::determinant(back.geometry.direction), 1.0, 1e-12);
  const Index3 size = volume.geometry.size;
  for (int k = 0; k < size[2]; ++k) {
    const Vec3 place = volume.geometry.toPatient_mm(Vec3(2, 3, k));
    EXPECT_LT(glm::distance(place, back.geometry.toPatient_mm(Vec3(2, 3, size[2] - 1 - k))), 1e-9);
    EXPECT_EQ(volume.at(2, 3, k), back.at(2, 3, size[2] - 1 - k));
  }
}

TEST_F(CtWriter, EqualVolumesGiveEqualFilesAndOthersOtherUids) {
  Volume volume = rampVolume();
  write(volume);
  const std::string first = readBytes(slice(3));
  write(volume);  // over itself
  EXPECT_EQ(readBytes(slice(3)), first);
  const std::string uid = scan().report().series.front().uid;
  volume.hu[5] += 1;
  write(volume);
  EXPECT_NE(scan().report().series.front().uid, uid);
}

TEST_F(CtWriter, AShorterPhantomLeavesNoSliceOfALongerOne) {
  write(rampVolume({7, 5, 9}));
  write(rampVolume({7, 5, 4}));
  EXPECT_EQ(import().geometry.size, (Index3{7, 5, 4}));
  EXPECT_EQ(report_.files_seen, 4);
}

TEST_F(CtWriter, AScanThatIsNotAPhantomIsNeverOverwritten) {
  write(rampVolume());
  edit(slice(2), [](DcmDataset& data) { put(data, DCM_PatientName, "SOMEBODY"); });
  const std::string before = readBytes(slice(2));
  const Status written = writeCtSeries(rampVolume({3, 3, 3}), {"Other", ""}, folder());
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().code.str(), "CANNOT_WRITE");
  EXPECT_EQ(readBytes(slice(2)), before);
  EXPECT_TRUE(std::filesystem::exists(slice(1)));
}

TEST_F(CtWriter, ACancelLeavesNothing) {
  Progress progress;
  progress.cancel();
  const Status written = writeCtSeries(rampVolume(), {"Test", ""}, folder(), progress);
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().code.str(), "CANCELLED");
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
}

TEST_F(CtWriter, AFolderThatCannotBeMadeIsNamed) {
  writeBytes(temporary_ / "file", "x");
  const Status written = writeCtSeries(rampVolume(), {"Test", ""}, temporary_ / "file");
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().code.str(), "CANNOT_WRITE");
}

TEST_F(CtWriter, AVolumeWhoseAxesAreNotPerpendicularIsRefused) {
  Volume volume = rampVolume();
  volume.geometry.direction[1] = glm::normalize(Vec3(0.1, 1, 0));
  EXPECT_FALSE(writeCtSeries(volume, {"Test", ""}, folder()).ok());
}

}  // namespace trephine::test
