#include "library/name_words.h"

#include <gtest/gtest.h>

#include "library/name_guard.h"
#include "support.h"

namespace trephine {
namespace {

using Kind = IdentityKind;
using Words = std::vector<std::string>;

SourceIdentity jane() {
  SourceIdentity source;
  source.add(Kind::patient_name, "DOE^JANE");
  source.add(Kind::patient_id, "4711-SECRET");
  source.add(Kind::accession, "ACC.778899");
  source.add(Kind::study_id, "12");
  source.addFile("/media/stick/Clinic 3/Xray.dcm");
  return source;
}

SourceIdentity patient(const std::string& name) {
  SourceIdentity source;
  source.add(Kind::patient_name, name);
  return source;
}

bool refused(const std::string& name, const SourceIdentity& source) {
  return toldBy(name, sourceKeys(source)).has_value();
}

TEST(NameWords, AreTheSameHoweverANameIsWritten) {
  EXPECT_EQ(wordsOf("DOE^Jane"), (Words{"doe", "jane"}));
  EXPECT_EQ(wordsOf(" jane_doe-2.B "), (Words{"jane", "doe", "2", "b"}));
  EXPECT_EQ(wordsOf("JaneDoe2"), (Words{"jane", "doe", "2"}));
  EXPECT_EQ(wordsOf("MÜLLER"), (Words{"muller"}));
  EXPECT_EQ(wordsOf("Mu\xCC\x88ller"), (Words{"muller"})) << "the accent on its own";
  EXPECT_EQ(wordsOf("Ｊａｎｅ"), (Words{"jane"})) << "full width";
  EXPECT_EQ(wordsOf("山田太郎の頭"), (Words{"山田太郎", "の", "頭"}));
  EXPECT_EQ(wordsOf("ヤマダ"), wordsOf("やまだ"));
  EXPECT_EQ(wordsOf("ﾔﾏﾀﾞ"), wordsOf("やまだ")) << "half width";
  EXPECT_TRUE(wordsOf("^ _ - . ,").empty());
}

TEST(NameWords, OfThePatientAreRefusedInAnyOrderAndAnyWriting) {
  for (const char* name : {"Jane Doe", "DOE^JANE", "jane_doe", "Doe, Jane", "janedoe", "DoeJane",
                           "liver of Jane", "Doe 2", "case (JANE)", "JANE2", "j\xC3\xA1ne"}) {
    EXPECT_TRUE(refused(name, jane())) << name;
  }
  for (const char* name :
       {"Head 2026-11-24 1", "Janet's liver", "doer", "Liver with a tumour", "J D"}) {
    EXPECT_FALSE(refused(name, jane())) << name;
  }
}

TEST(NameWords, HoldNoIdOrAccessionNumberOfThePatient) {
  for (const char* name : {"4711-SECRET", "4711 secret", "liver 4711secret", "4711_SECRET b",
                           "acc 778899", "ACC778899 head"}) {
    EXPECT_TRUE(refused(name, jane())) << name;
  }
  EXPECT_FALSE(refused("4711", jane())) << "a part of it";
  SourceIdentity short_id;
  short_id.add(Kind::patient_id, "7");
  EXPECT_TRUE(refused("7", short_id));
  EXPECT_FALSE(refused("Head 7", short_id)) << "too short to be known again";
}

TEST(NameWords, AreNotThoseOfStudyFolderOrFileAsAWhole) {
  for (const char* name : {"12", "Clinic 3", "clinic-3", "STICK", "xray", "Xray.dcm"}) {
    EXPECT_TRUE(refused(name, jane())) << name;
  }
  for (const char* name : {"Head 12", "Clinic case", "Xray of a skull"}) {
    EXPECT_FALSE(refused(name, jane())) << name;
  }
}

TEST(NameWords, OfAFolderAreComparedInAnyOrder) {
  SourceIdentity anonymous;
  anonymous.addFile("/ct/DOE JANE/IM1");
  EXPECT_TRUE(refused("Jane Doe", anonymous));
  EXPECT_FALSE(refused("Jane Doe's liver", anonymous)) << "of folders only the whole is compared";
}

TEST(NameWords, OfFilesThatAreCountedAreRefusedByWhatTheyShare) {
  SourceIdentity source;
  for (int n = 1; n <= 900; ++n) source.addFile("/ct/Miller" + std::to_string(n) + ".dcm");
  const SourceKeys keys = sourceKeys(source);
  EXPECT_LT(keys.keys.size(), 8u) << "each costs 20 ms";
  EXPECT_TRUE(toldBy("miller 17", keys));
  EXPECT_FALSE(toldBy("Head 17", keys));
}

TEST(NameWords, MatchUmlautsWrittenAsOneLetterOrAsTwo) {
  for (const char* source : {"MÜLLER^JÖRG", "MUELLER^JOERG", "Müller^Jörg"}) {
    for (const char* name : {"Müller", "Mueller", "MUELLER liver", "Fall JÖRG", "joerg"}) {
      EXPECT_TRUE(refused(name, patient(source))) << source << ": " << name;
    }
    EXPECT_FALSE(refused("Leber mit Zyste", patient(source)));
  }
}

TEST(NameWords, MatchJapaneseNamesInEachOfTheirWritings) {
  const SourceIdentity source = patient("Yamada^Tarou=山田^太郎=やまだ^たろう");
  for (const char* name : {"山田太郎", "山田 太郎", "太郎の頭", "山田様の肝臓", "やまだ", "ヤマダ",
                           "ﾔﾏﾀﾞ ﾀﾛｳ", "Tarou Yamada", "yamada"}) {
    EXPECT_TRUE(refused(name, source)) << name;
  }
  EXPECT_FALSE(refused("頭部 1", source));
  EXPECT_FALSE(refused("山の頭", source)) << "a single sign is in too many words";
  EXPECT_TRUE(refused("김철수 간", patient("김^철수")));
  EXPECT_TRUE(refused("王明", patient("王^明")));
}

TEST(CaseName, IsOneVisibleLineOfAtMostEightyCharacters) {
  EXPECT_EQ(*caseNameFrom("  Leber  Zürich "), "Leber Zürich");
  EXPECT_EQ(*caseNameFrom("肝臓"), "肝臓");
  std::string eighty;
  for (int n = 0; n < 80; ++n) eighty += "ü";
  EXPECT_TRUE(caseNameFrom(eighty));
  EXPECT_FALSE(caseNameFrom(eighty + "u"));
  for (const char* bad : {"", "  ", "...", "a\nb", "a\tb", "\xff\xfe",
                          "a\xE2\x80\x8B"
                          "b",
                          "a\xE2\x80\xAE"
                          "b"}) {
    const auto name = caseNameFrom(bad);
    ASSERT_FALSE(name) << bad;
    EXPECT_EQ(name.error().code.str(), "BAD_NAME");
  }
}

TEST(CaseName, IsTheSameInLettersOfEitherCase) {
  EXPECT_EQ(foldedName("Head  A"), foldedName("head a"));
  EXPECT_EQ(foldedName("ÄRA"), foldedName("ära"));
  EXPECT_NE(foldedName("Head 1"), foldedName("Head 11"));
}

TEST(NameGuard, RefusesTheSameFromItsFileAsFromItsSource) {
  const test::TemporaryFolder folder;
  const auto guard = NameGuard::of(sourceKeys(jane()));
  ASSERT_TRUE(guard);
  std::ofstream(folder / "key.json") << guard->toJson().dump();
  const auto back = NameGuard::read(folder / "key.json");
  ASSERT_TRUE(back) << back.error().sentence();
  for (const char* name : {"jane_doe", "liver 4711 secret", "Clinic 3"}) {
    const Status told = back->check(name);
    ASSERT_FALSE(told) << name;
    EXPECT_EQ(told.error().code.str(), "NAME_IS_IDENTITY");
    EXPECT_EQ(told.error().sentence().find(name), std::string::npos) << "it is not repeated";
  }
  EXPECT_EQ(back->check("Doe").error().what, "The name holds the patient's name, or a part of it");
  EXPECT_TRUE(back->check("Liver with a cyst"));
  EXPECT_TRUE(back->checkPatient({"Clinic 3", "liver"}, Progress())) << "no word of the patient";
  const Status told = back->checkPatient({"liver", "tumour of Doe"}, Progress());
  ASSERT_FALSE(told);
  EXPECT_EQ(told.error().where, "name 2 of 2");
}

TEST(NameGuard, HoldsNoTextAndNoHashThatTwoCasesShare) {
  const auto one = NameGuard::of(sourceKeys(jane())), other = NameGuard::of(sourceKeys(jane()));
  ASSERT_TRUE(one && other);
  for (const Json& refused : one->toJson()["refused"]) {
    EXPECT_EQ(other->toJson().dump().find(refused["hash"].get<std::string>()), std::string::npos);
  }
  for (const char* text : {"doe", "DOE", "4711", "secret", "Clinic", "clinic"}) {
    EXPECT_EQ(one->toJson().dump().find(std::string(text) + "\""), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace trephine
