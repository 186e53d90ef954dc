// A whole import of DOE^JANE, ID 4711-SECRET, from a folder of that name: what is written, and what
// the case may be called.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "base/file.h"
#include "cases.h"
#include "imaging/dicom/ct_writer.h"
#include "imaging/importer.h"
#include "library/name_words.h"
#include "volume/label_map.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;

class CaseOfJaneDoe : public ::testing::Test {
 protected:
  void SetUp() override {
    Volume volume;
    volume.geometry.size = {24, 20, 8};
    volume.geometry.spacing_mm = {2.0, 2.0, 3.0};
    volume.hu.resize(volume.geometry.voxelCount());
    for (std::size_t n = 0; n < volume.hu.size(); ++n) {
      volume.hu[n] = std::int16_t(n % 24 < 4 ? -1000 : int(n * 7919 % 300) - 20);
    }
    const fs::path source = temporary_ / "DOE^JANE" / "4711-SECRET";
    ASSERT_TRUE(
        writeCtSeries(volume, {"CT of Jane Doe", "HEAD", "DOE^JANE", "4711-SECRET"}, source));
    // What is no slice is looked at and left out, which the report says.
    std::ofstream(source / "Letter of Jane Doe.txt") << "Dear Mrs Doe";
    auto ct = CtFolder::scan(source, Progress());
    ASSERT_TRUE(ct);
    const auto uid = ct->bestSeries();
    ASSERT_TRUE(uid) << ct->report().error->sentence();
    auto read = ct->read(*uid, ImportRequest(), Progress());
    ASSERT_TRUE(read) << read.error().sentence();
    case_.volume = std::make_shared<const Volume>(*std::move(read));
    case_.report = ct->report();
    case_.provenance = ct->report().provenance;
    case_.source = ct->sourceIdentity(*uid);
    case_.region = BodyRegion::head;
    LabelMap map{case_.volume->geometry, std::vector<std::uint8_t>(volume.hu.size(), 1), {}};
    map.structures = {{1, "Tumour of Jane Doe", Vec3(1, 0, 0)}, {2, "liver", Vec3(0, 1, 0)}};
    case_.structures = std::make_shared<const LabelMap>(std::move(map));
    case_.tissues = {{"format", "trephine.tissues"}};
  }

  fs::path storage() const { return temporary_ / "storage"; }
  CaseRecord saved() {
    const auto result = CaseLibrary(storage()).save(case_);
    EXPECT_TRUE(result) << (result ? "" : result.error().sentence());
    return result ? result->record : CaseRecord{};
  }

  test::TemporaryFolder temporary_;
  NewCase case_;
};

std::string inSmallLetters(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

TEST_F(CaseOfJaneDoe, LeavesNothingOfHerInAnyFileOrFileName) {
  const CaseRecord record = saved();
  ASSERT_TRUE(CaseLibrary(storage()).rename(record.id, "Exercise with a cyst"));
  int files = 0;
  for (const auto& file : fs::recursive_directory_iterator(storage())) {
    std::string text = file.path().lexically_relative(storage()).string() + "\n";
    if (file.is_regular_file()) text += test::bytesOf(file.path());
    files += file.is_regular_file();
    text = inSmallLetters(std::move(text));
    for (const char* told : {"jane", "doe^", "doe ", "4711", "secret", "letter"}) {
      EXPECT_EQ(text.find(told), std::string::npos) << told << " in " << file.path();
    }
    // As UTF-16, too.
    EXPECT_EQ(text.find(std::string("j\0a\0n\0e", 7)), std::string::npos) << file.path();
  }
  EXPECT_GE(files, 9);
}

TEST_F(CaseOfJaneDoe, HasTheCardOfItsImportAndItsVerdict) {
  const CaseRecord record = saved();
  EXPECT_EQ(record.verdict, Verdict::pass);
  EXPECT_NE(test::bytesOf(record.folder / "report.html").find("not for diagnosis"),
            std::string::npos);
  EXPECT_TRUE(Json::parse(test::bytesOf(record.folder / "report.json")).contains("series"));
  EXPECT_EQ(CaseLibrary(storage()).load(record.id)->provenance->source, "DICOM");
}

// Every file of the storage but those for its importer alone.
std::string allThatOthersMayRead(const fs::path& storage) {
  std::string all;
  for (const auto& file : fs::recursive_directory_iterator(storage)) {
    const bool own = file.path().lexically_relative(storage).begin()->string() == "private";
    if (file.is_regular_file() && !own) all += test::bytesOf(file.path());
  }
  return all;
}

TEST_F(CaseOfJaneDoe, KeepsWhichCtItIsOfByAKeyThatOthersMayNotRead) {
  const SourceIds plain = case_.provenance->source_ids;
  ASSERT_FALSE(plain.study.empty());
  const std::string uid = case_.report->series.front().uid;
  const CaseRecord one = saved(), other = saved();
  const std::string all = allThatOthersMayRead(storage());
  for (const std::string& told :
       {plain.study, plain.series, plain.frame_of_reference, uid, seriesHash(uid)}) {
    EXPECT_EQ(all.find(told), std::string::npos);
  }
  const SourceIds kept = CaseLibrary(storage()).load(one.id)->provenance->source_ids;
  EXPECT_TRUE(kept.standsFor(kept.study, plain.study));
  EXPECT_TRUE(kept.standsFor(kept.series, plain.series));
  EXPECT_NE(kept.study, CaseLibrary(storage()).load(other.id)->provenance->source_ids.study)
      << "two cases of one patient cannot be told";
  fs::remove(storage() / "private" / (one.names_key + ".json"));
  EXPECT_TRUE(CaseLibrary(storage()).load(one.id)->provenance->source_ids.unreadable);
}

TEST_F(CaseOfJaneDoe, ThatSaysWhichCtItIsOfWhereAllMayReadItIsRefusedInOneSentence) {
  const CaseRecord record = saved();
  Json provenance = Json::parse(test::bytesOf(record.folder / "provenance.json"));
  provenance["source_ids"] = {{"study", "a"}, {"series", "b"}, {"frame_of_reference", "c"}};
  ASSERT_TRUE(writeTextFile(record.folder / "provenance.json", provenance.dump(2)));
  const Result<LoadedCase> refused = CaseLibrary(storage()).load(record.id);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code.str(), "OLDER_VERSION");
  EXPECT_NE(refused.error().sentence().find("Import the CT again"), std::string::npos);
}

TEST_F(CaseOfJaneDoe, WhenACopyOfItIsDeletedKeepsWhatItMayNotBeCalled) {
  const CaseRecord record = saved();
  fs::copy(record.folder, storage() / "cases" / "copy", fs::copy_options::recursive);
  ASSERT_TRUE(CaseLibrary(storage()).remove("copy"));
  EXPECT_EQ(CaseLibrary(storage()).rename(record.id, "Jane Doe").error().code.str(),
            "NAME_IS_IDENTITY");
}

TEST(HideNames, CallsSegmentsByTheirValuesWhereTheyTellWhoThePatientIs) {
  SourceIdentity jane;
  jane.add(IdentityKind::patient_name, "DOE^JANE");
  jane.add(IdentityKind::patient_id, "4711");
  jane.add(IdentityKind::folder, "liver");
  Segmentation segmentation;
  segmentation.segments = {{"Jane's liver"}, {"liver"}, {"4711"}};
  segmentation.segments[2].value = 3;
  EXPECT_EQ(hideNames(segmentation, sourceKeys(jane)), 2);
  EXPECT_EQ(segmentation.segments[0].name, "label 1");
  EXPECT_EQ(segmentation.segments[1].name, "liver");
  EXPECT_EQ(segmentation.segments[2].name, "label 3");
}

TEST(HideNames, GivesTwoOfOneValueNamesOfTheirOwn) {
  SourceIdentity jane;
  jane.add(IdentityKind::patient_name, "DOE^JANE");
  Segmentation segmentation;
  segmentation.segments = {{"Jane's liver"}, {"Label 1"}, {"Doe's spleen"}};
  EXPECT_EQ(hideNames(segmentation, sourceKeys(jane)), 2);
  EXPECT_EQ(segmentation.segments[0].name, "label 1 (2)");
  EXPECT_EQ(segmentation.segments[1].name, "Label 1");
  EXPECT_EQ(segmentation.segments[2].name, "label 1 (3)");
}

TEST_F(CaseOfJaneDoe, CallsAStructureByItsLabelWhereItsNameTellsWhoSheIs) {
  const auto result = CaseLibrary(storage()).save(case_);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->warnings.size(), 1u);
  EXPECT_EQ(result->warnings[0].code.str(), "RENAMED_STRUCTURE");
  EXPECT_EQ(result->record.structures[0].name, "label 1");
  EXPECT_EQ(result->record.structures[1].name, "liver");
  // In later sessions a person is told which one.
  LabelMap map = *case_.structures;
  map.structures[0].name = "label 1";
  EXPECT_TRUE(CaseLibrary(storage()).saveStructures(result->record.id, map));
  map.structures[1].name = "JANE's liver";
  const auto refused = CaseLibrary(storage()).saveStructures(result->record.id, map);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code.str(), "NAME_IS_IDENTITY");
}

TEST_F(CaseOfJaneDoe, IsCalledAfterNothingOfHerNeitherNowNorLater) {
  const std::vector<std::string> refused{"Jane Doe",   "DOE^JANE",    "jane_doe",
                                         "Doe's head", "4711-secret", "case 4711 SECRET",
                                         "IM0003",     "im 3.dcm"};
  for (const std::string& name : refused) {
    NewCase named = case_;
    named.name = name;
    const auto result = CaseLibrary(storage()).save(named);
    ASSERT_FALSE(result) << name;
    EXPECT_EQ(result.error().code.str(), "NAME_IS_IDENTITY") << name;
    EXPECT_EQ(inSmallLetters(result.error().sentence()).find("jane"), std::string::npos);
  }
  const CaseRecord record = saved();
  fs::remove_all(temporary_ / "DOE^JANE");  // the stick is gone
  CaseLibrary later(storage());
  for (const std::string& name : refused) {
    const auto result = later.rename(record.id, name);
    ASSERT_FALSE(result) << name;
    EXPECT_EQ(result.error().code.str(), "NAME_IS_IDENTITY") << name;
  }
  const auto renamed = later.rename(record.id, " Skull  base, right ");
  ASSERT_TRUE(renamed) << renamed.error().sentence();
  EXPECT_EQ(renamed->name, "Skull base, right");
  EXPECT_EQ(renamed->id, record.id) << "its folder keeps its name";
  EXPECT_TRUE(later.rename(record.id, record.name)) << "the neutral name again";
}

TEST_F(CaseOfJaneDoe, MayBeCalledAnythingElseThatNoOtherCaseIs) {
  NewCase named = case_;
  named.name = "Leber Zürich";
  const auto first = CaseLibrary(storage()).save(named);
  ASSERT_TRUE(first) << first.error().sentence();
  EXPECT_EQ(first->record.name, "Leber Zürich");
  EXPECT_TRUE(first->record.id.starts_with("head-")) << "the folder is not called so";
  EXPECT_EQ(CaseLibrary(storage()).save(named).error().code.str(), "NAME_TAKEN");
  const CaseRecord other = saved();
  CaseLibrary library(storage());
  EXPECT_EQ(library.rename(other.id, "leber  ZÜRICH").error().code.str(), "NAME_TAKEN");
  EXPECT_TRUE(library.rename(first->record.id, "LEBER Zürich")) << "its own name";
  EXPECT_EQ(library.rename(other.id, "a\nb").error().code.str(), "BAD_NAME");
  EXPECT_EQ(library.rename("gone", "x").error().code.str(), "NO_SUCH_CASE");
}

TEST_F(CaseOfJaneDoe, KeepsWhatItMayNotBeCalledForItsOwnerAlone) {
  const CaseRecord record = saved();
  struct stat folder {
  }, file{};
  ASSERT_EQ(::stat((storage() / "private").c_str(), &folder), 0);
  ASSERT_EQ(::stat((storage() / "private" / (record.names_key + ".json")).c_str(), &file), 0);
  EXPECT_EQ(folder.st_mode & 0777, 0700u);
  EXPECT_EQ(file.st_mode & 0777, 0600u);
  EXPECT_EQ(test::entriesIn(storage() / "private"), 1u);
}

TEST_F(CaseOfJaneDoe, KeepsItsNameWhereAnotherCannotBeChecked) {
  const CaseRecord record = saved();
  fs::remove_all(storage() / "private");
  CaseLibrary library(storage());
  const auto renamed = library.rename(record.id, "Anything");
  ASSERT_FALSE(renamed);
  EXPECT_EQ(renamed.error().code.str(), "NAME_UNCHECKED");
  EXPECT_EQ(library.list()[0].record.name, record.name);
  EXPECT_TRUE(library.load(record.id));
}

TEST_F(CaseOfJaneDoe, IsStillGuardedWhenItsFolderIsRenamedUnderneath) {
  const CaseRecord record = saved();
  fs::rename(record.folder, record.folder.parent_path() / "exercise");
  EXPECT_EQ(CaseLibrary(storage()).rename("exercise", "Jane").error().code.str(),
            "NAME_IS_IDENTITY");
}

}  // namespace
}  // namespace trephine
