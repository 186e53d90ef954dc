#include "imaging/codes.h"
#include "imaging/common/source_identity.h"
#include "imaging/report/provenance.h"
#include "series_fixture.h"
#include "volume/codes.h"
#include "volume/volume_files.h"

namespace trephine::test {

class SourceIdentityTexts : public SeriesFixture {};
using Kind = IdentityKind;
using Texts = std::set<std::string>;

TEST_F(SourceIdentityTexts, AreAllNamesAndIdsOfThePatient) {
  write(rampVolume());
  editAll([](DcmDataset& data) {
    put(data, DCM_PatientName, "Yamada^Tarou=山田^太郎=やまだ^たろう");
    put(data, DCM_PatientBirthName, "Suzuki^Tarou");
    put(data, DCM_PatientID, " 4711-SECRET ");
    put(data, DCM_AccessionNumber, "ACC 99");
    put(data, DCM_StudyID, "");
  });
  CtFolder ct = scan();
  auto texts = ct.sourceIdentity(*ct.bestSeries()).texts;
  EXPECT_EQ(texts[Kind::patient_name],
            (Texts{"Yamada^Tarou=山田^太郎=やまだ^たろう", "Suzuki^Tarou"}));
  EXPECT_EQ(texts[Kind::patient_id], Texts{"4711-SECRET"});
  EXPECT_EQ(texts[Kind::accession], Texts{"ACC 99"});
  EXPECT_FALSE(texts.contains(Kind::study_id)) << "an empty one";
}

TEST_F(SourceIdentityTexts, AreTheNamesOfItsFilesAndOfAllFoldersAboveThem) {
  write(rampVolume());
  CtFolder ct = scan();
  auto texts = ct.sourceIdentity(*ct.bestSeries()).texts;
  EXPECT_TRUE(texts[Kind::file].contains("IM0001.dcm"));
  EXPECT_TRUE(texts[Kind::folder].contains("ct"));
  EXPECT_TRUE(texts[Kind::folder].contains(temporary_.path().filename().string()));
  EXPECT_TRUE(ct.sourceIdentity("1.2.3").empty()) << "no such series";
}

TEST_F(SourceIdentityTexts, OfAVolumeFileAreItsNameAndItsFolders) {
  std::filesystem::create_directories(folder() / "DOE^JANE");
  ASSERT_TRUE(writeVolume(rampVolume(), folder() / "DOE^JANE" / "head.nii.gz"));
  CtFolder ct = scan(folder());
  auto texts = ct.sourceIdentity(ct.report().series.front().uid).texts;
  EXPECT_EQ(texts[Kind::file], Texts{"head.nii.gz"});
  EXPECT_TRUE(texts[Kind::folder].contains("DOE^JANE"));
}

TEST_F(SourceIdentityTexts, StandInNoReport) {
  write(rampVolume());
  editAll([](DcmDataset& data) { put(data, DCM_PatientID, "4711-SECRET"); });
  import();
  EXPECT_EQ(toJson(report_, Identity::shown).dump().find("4711"), std::string::npos);
}

TEST(Provenance, IsReadBackAsItWasWritten) {
  Provenance of;
  of.source = "DICOM";
  of.transfer_syntax = "JPEG 2000";
  of.lossy = true;
  of.slices_used = 120;
  of.answers = {{code::kCouch, "remove"}, {code::kFace, "deface"}};
  of.unanswered = {code::kFace};
  of.unused_answers = {code::kPhases};
  of.changes = {
      {code::kGantryTilt, Severity::repair, "The stack leans", {"3", "4"}, "Straightened"}};
  of.crop = VoxelBox{{1, 2, 3}, {10, 20, 30}};
  of.reduction = 2;
  of.loss = MeasuredLoss{3.5, 40.0, -1.25};
  of.volume_sha256 = std::string(64, 'a');
  of.source_ids = {"1", "2", "3"};
  of.build = "0.1.0 Release";
  const auto back = provenanceFrom(toJson(of), "provenance.json");
  ASSERT_TRUE(back) << back.error().sentence();
  EXPECT_EQ(toJson(*back), toJson(of));
  EXPECT_FALSE(toJson(of).contains("source_ids")) << "nothing by which a patient could be found";
  EXPECT_TRUE(back->source_ids.empty());
  Json before = toJson(of);
  before["source_ids"] = {{"study", "1"}, {"series", "2"}, {"frame_of_reference", "3"}};
  EXPECT_EQ(provenanceFrom(before, "provenance.json").error().code.str(), "OLDER_VERSION");
  EXPECT_EQ(back->crop, of.crop);
  const auto plain = provenanceFrom(toJson(Provenance{}), "p");
  ASSERT_TRUE(plain) << plain.error().sentence();
  EXPECT_FALSE(plain->crop || plain->loss);
}

TEST(Provenance, ThatIsSpoiltIsRefusedByField) {
  Json json = toJson(Provenance{});
  json["reduction"] = 99;
  const auto bad = provenanceFrom(json, "provenance.json");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().where, "provenance.json: reduction");
  EXPECT_FALSE(provenanceFrom(Json::array(), "p"));
  json = toJson(Provenance{});
  json["choices"] = 3;
  EXPECT_FALSE(provenanceFrom(json, "p"));
}

}  // namespace trephine::test
