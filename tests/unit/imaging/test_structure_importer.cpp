#include <algorithm>

#include "imaging/codes.h"
#include "imaging/dicom/seg_writer.h"
#include "imaging/importer.h"
#include "imaging/structure_importer.h"
#include "support.h"
#include "volume/codes.h"

namespace trephine {
namespace {

// Soft tissue with an organ in it.
Volume belly(const Vec3& origin_mm = Vec3(0.0), std::int16_t corner_HU = 0) {
  Volume volume;
  volume.geometry.size = {24, 20, 12};
  volume.geometry.spacing_mm = {2.0, 2.0, 5.0};
  volume.geometry.origin_mm = origin_mm;
  volume.hu.assign(volume.geometry.voxelCount(), -80);
  for (int k = 3; k < 9; ++k) {
    for (int j = 4; j < 14; ++j) {
      for (int i = 5; i < 15; ++i) volume.hu[volume.geometry.indexOf(i, j, k)] = 50;
    }
  }
  volume.hu[0] = corner_HU;
  return volume;
}

LabelMap importedLiver(const Volume& volume) {
  LabelMap map{volume.geometry, std::vector<std::uint8_t>(volume.hu.size()), {}};
  for (std::size_t v = 0; v < map.labels.size(); ++v) map.labels[v] = volume.hu[v] == 50 ? 4 : 0;
  map.structures = {{4, "liver", Vec3(0.5, 0.25, 0.25)}};
  return map;
}

struct Written {
  Volume volume;
  SourceIds ids;
  std::filesystem::path seg;
};

Written write(const Volume& volume, const std::filesystem::path& folder) {
  EXPECT_TRUE(writeStructuresAsDicom(volume, importedLiver(volume), folder).ok());
  auto scanned = CtFolder::scan(folder / "CT", Progress());
  auto read = scanned->read(*scanned->bestSeries(), {}, Progress());
  EXPECT_TRUE(read.ok());
  return {*std::move(read), scanned->report().provenance->source_ids, folder / "structures.dcm"};
}

StructureRequest of(const SourceIds& ids, const Answers& answers = {}) {
  StructureRequest request;
  request.ct = ids;
  request.answers = answers;
  return request;
}

TEST(StructureImporter, ASegmentationOfThisCtIsTakenWithoutAWord) {
  const test::TemporaryFolder folder;
  const Written own = write(belly(), folder / "a");
  EXPECT_FALSE(own.ids.frame_of_reference.empty());
  const auto fit = importStructures(own.seg, own.volume, of(own.ids));
  ASSERT_TRUE(fit) << fit.error().sentence();
  EXPECT_EQ(fit->structures[0].voxels, 600u);
  EXPECT_TRUE(fit->choices.empty());
  EXPECT_TRUE(fit->findings.empty())
      << "slices without anything of it are left out by every writer: " << fit->findings[0].text;
  const LabelMap liver = importedLiver(own.volume);
  for (std::size_t v = 0; v < liver.labels.size(); ++v) {
    ASSERT_EQ(fit->map.labels[v] != 0, liver.labels[v] != 0) << v;
  }
}

TEST(StructureImporter, AnotherStudyThatLiesOnTheCtIsAskedAbout) {
  const test::TemporaryFolder folder;
  const Written own = write(belly(), folder / "a");
  const Written other = write(belly(Vec3(0.4, 0.0, 0.0), 7), folder / "b");
  const auto asked = importStructures(other.seg, own.volume, of(own.ids));
  ASSERT_FALSE(asked);
  EXPECT_EQ(asked.error().code.str(), "OTHER_FRAME");
  EXPECT_NE(asked.error().what.find("another study"), std::string::npos);
  const auto kept =
      importStructures(other.seg, own.volume, of(own.ids, {{code::kOtherFrame, "keep"}}));
  ASSERT_TRUE(kept) << kept.error().sentence();
  EXPECT_EQ(kept->choices.size(), 1u);
  EXPECT_FALSE(
      importStructures(other.seg, own.volume, of(own.ids, {{code::kOtherFrame, "refuse"}})));
  // Of a volume file nothing is known: its place alone speaks.
  EXPECT_TRUE(importStructures(other.seg, own.volume, of({})));
}

TEST(StructureImporter, APersonsAnswersNeedNoFileAnyMore) {
  const test::TemporaryFolder folder;
  const Written own = write(belly(), folder / "a");
  const Written other = write(belly(Vec3(0.4, 0.0, 0.0), 7), folder / "b");
  StructureFile file(other.seg);
  StructureRequest request = of(own.ids);
  request.ask_person = true;
  const auto asked = file.fit(own.volume, request);
  ASSERT_TRUE(asked) << asked.error().sentence();
  const auto* question = std::get_if<StructureAsked>(&*asked);
  ASSERT_TRUE(question);
  EXPECT_EQ(question->kind, StructureAsked::Kind::option);
  EXPECT_EQ(question->choice.code.str(), "OTHER_FRAME");
  EXPECT_EQ(question->choice.options, std::vector<std::string>{"keep"});
  // It has everything by now, also of a file that is not there any more.
  ASSERT_TRUE(std::filesystem::remove(other.seg));
  request.answers[code::kOtherFrame] = "keep";
  const auto fit = file.fit(own.volume, request);
  ASSERT_TRUE(fit) << fit.error().sentence();
  ASSERT_TRUE(std::holds_alternative<StructureFit>(*fit));
  EXPECT_EQ(std::get<StructureFit>(*fit).choices.size(), 1u);
}

TEST(StructureImporter, ACancelledLookAtAHeaderIsNoDamage) {
  const test::TemporaryFolder folder;
  const Written own = write(belly(), folder / "a");
  StructureFile file(own.seg);
  StructureRequest request = of(own.ids);
  request.ask_person = true;
  Progress progress;
  progress.cancel();
  EXPECT_EQ(file.fit(own.volume, request, progress).error().code.str(), "CANCELLED");
  EXPECT_TRUE(file.fit(own.volume, request)) << "and it can be read again";
}

TEST(StructureImporter, ASegmentationOfAnotherPatientIsRefused) {
  const test::TemporaryFolder folder;
  const Written own = write(belly(), folder / "a");
  const Written other = write(belly(Vec3(13.0, 2.0, 31.0), 7), folder / "b");
  for (const Answers& answers : {Answers(), Answers{{code::kOtherFrame, "keep"}}}) {
    const auto refused = importStructures(other.seg, own.volume, of(own.ids, answers));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code.str(), "OTHER_PATIENT");
  }
}

TEST(StructureImporter, OfACaseThatIsKeptByAKeyTheSameIsTakenAndAnotherRefused) {
  const test::TemporaryFolder folder;
  const Written own = write(belly(), folder / "a");
  const SourceIds kept = own.ids.keyed("of this case");
  const auto fit = importStructures(own.seg, own.volume, of(kept));
  ASSERT_TRUE(fit) << fit.error().sentence();
  EXPECT_TRUE(fit->choices.empty());
  const Written other = write(belly(Vec3(13.0, 2.0, 31.0), 7), folder / "b");
  EXPECT_EQ(importStructures(other.seg, own.volume, of(kept)).error().code.str(), "OTHER_PATIENT");
}

TEST(StructureImporter, WhereItIsNotKnownWhichCtTheCaseIsOfThatIsSaidAndThePlaceDecides) {
  const test::TemporaryFolder folder;
  const Written own = write(belly(), folder / "a");
  SourceIds unknown;
  unknown.unreadable = true;
  const auto fit = importStructures(own.seg, own.volume, of(unknown));
  ASSERT_TRUE(fit) << fit.error().sentence();
  EXPECT_EQ(std::ranges::count(fit->findings, code::kSourceUnchecked, &Finding::code), 1);
  const Written other = write(belly(Vec3(13.0, 2.0, 31.0), 7), folder / "b");
  EXPECT_EQ(importStructures(other.seg, own.volume, of(unknown)).error().code.str(), "OTHER_FRAME");
}

TEST(StructureImporter, NamesThatAreHiddenAreNeitherSaidNorInTheMap) {
  const test::TemporaryFolder folder;
  const Written own = write(belly(), folder / "a");
  StructureRequest request = of(own.ids);
  request.hide_names = [](Segmentation& segmentation) {
    for (Segmentation::Segment& segment : segmentation.segments) segment.name = "label 4";
    return int(segmentation.segments.size());
  };
  const auto fit = importStructures(own.seg, own.volume, request);
  ASSERT_TRUE(fit) << fit.error().sentence();
  EXPECT_EQ(fit->map.structures[0].name, "label 4");
  EXPECT_EQ(toJson(*fit).dump().find("liver"), std::string::npos);
  EXPECT_EQ(std::ranges::count(fit->findings, code::kRenamedStructure, &Finding::code), 1);
}

}  // namespace
}  // namespace trephine
