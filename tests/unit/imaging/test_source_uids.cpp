#include <algorithm>

#include "imaging/dicom/seg_reader.h"
#include "imaging/importer.h"
#include "imaging/source_uids.h"
#include "support.h"

namespace trephine {
namespace {

struct Imported {
  Volume ct;
  LabelMap map;
  Provenance of;
};

// A CT in `folder`/"CT" with an organ, as it is read back.
Imported importedFrom(const std::filesystem::path& folder, std::int16_t organ_HU = 50) {
  Volume ct;
  ct.geometry.size = {24, 20, 12};
  ct.geometry.spacing_mm = {2.0, 2.0, 3.0};
  ct.hu.assign(ct.geometry.voxelCount(), -80);
  LabelMap map{ct.geometry, std::vector<std::uint8_t>(ct.hu.size()), {{1, "liver", Vec3(0.5)}}};
  for (int k = 3; k < 9; ++k) {
    for (std::size_t v = 0; v < 100; ++v) {
      const std::size_t at = ct.geometry.indexOf(int(5 + v % 10), int(4 + v / 10), k);
      ct.hu[at] = organ_HU;
      map.labels[at] = 1;
    }
  }
  EXPECT_TRUE(writeStructuresAsDicom(ct, map, folder).ok());
  auto scanned = CtFolder::scan(folder / "CT", Progress());
  auto read = scanned->read(*scanned->bestSeries(), {}, Progress());
  EXPECT_TRUE(read.ok());
  return {*std::move(read), std::move(map), *scanned->report().provenance};
}

TEST(SourceUids, AreThoseOfTheSlicesThatTheCaseWasReadFrom) {
  const test::TemporaryFolder folder;
  const Imported own = importedFrom(folder / "a");
  // Another CT beside it is not the case's.
  importedFrom(folder / "b", 70);
  const auto uids = sourceUids(folder.path(), own.of, own.ct.geometry);
  ASSERT_TRUE(uids) << uids.error().sentence();
  EXPECT_EQ(seriesHash(uids->series), own.of.source_ids.series);
  EXPECT_EQ(seriesHash(uids->study), own.of.source_ids.study);
  EXPECT_EQ(seriesHash(uids->frame_of_reference), own.of.source_ids.frame_of_reference);
  ASSERT_EQ(uids->slices.size(), 12u);
  for (const auto& slice : uids->slices) EXPECT_EQ(slice.frame, 0);

  // A segmentation with them is alone in its folder and is taken as that of the CT.
  SegWriting writing;
  writing.source = *uids;
  ASSERT_TRUE(writeStructuresAsDicom(own.ct, own.map, folder / "c", writing).ok());
  EXPECT_FALSE(std::filesystem::exists(folder / "c" / "CT"));
  const auto seg = readDicomSegmentation(folder / "c" / "structures.dcm");
  ASSERT_TRUE(seg) << seg.error().sentence();
  EXPECT_EQ(seg->of, own.of.source_ids);
}

TEST(SourceUids, OfAPartOfTheCtAreThoseOfItsSlices) {
  const test::TemporaryFolder folder;
  const Imported own = importedFrom(folder / "a");
  GridGeometry part = own.ct.geometry;
  part.origin_mm = part.toPatient_mm(Vec3(0.0, 0.0, 4.0));
  part.size[2] = 5;
  EXPECT_EQ(sourceUids(folder / "a", own.of, part)->slices.size(), 5u);
}

TEST(SourceUids, OfAnotherFolderOrOfNoDicomAreRefused) {
  const test::TemporaryFolder folder;
  const Imported own = importedFrom(folder / "a");
  importedFrom(folder / "b", 70);
  const auto other = sourceUids(folder / "b", own.of, own.ct.geometry);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code.str(), "BAD_SOURCE");
  EXPECT_NE(other.error().what.find("not in this folder"), std::string::npos);
  EXPECT_EQ(sourceUids(folder / "a", Provenance(), own.ct.geometry).error().code.str(),
            "BAD_SOURCE");
  EXPECT_EQ(sourceUids(folder / "none", own.of, own.ct.geometry).error().code.str(),
            "MISSING_FOLDER");
}

}  // namespace
}  // namespace trephine
