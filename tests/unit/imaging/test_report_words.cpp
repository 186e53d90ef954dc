// What a report says, and whom it does not name.
#include <regex>

#include "imaging/codes.h"
#include "imaging/report/report_page.h"
#include "series_fixture.h"

namespace trephine::test {

namespace fs = std::filesystem;

class ReportWords : public SeriesFixture {
 protected:
  void SetUp() override { write(rampVolume()); }
  const SeriesReport& only() {
    scanned_ = scan().report();
    EXPECT_EQ(scanned_.series.size(), 1u);
    return scanned_.series.front();
  }
  // Slices that slide by this much from one to the next, along rows and columns [mm].
  void shear(double along_rows_mm, double along_columns_mm) {
    for (int n = 1; n <= 6; ++n) {
      edit(slice(n), [&](DcmDataset& data) {
        put(data, DCM_ImagePositionPatient,
            positionText(Vec3(along_rows_mm * n, along_columns_mm * n, 1.0 * n)));
      });
    }
  }
  ImportReport scanned_;
};

TEST_F(ReportWords, CountOneAndMany) {
  const auto one = [](int count) {
    return [=](DcmDataset& data) {
      if (std::stoi(text(data, DCM_InstanceNumber)) <= count) {
        delete data.remove(DCM_RescaleSlope);
      }
    };
  };
  editAll(one(1));
  EXPECT_EQ(find(only(), "RESCALE_DEFAULT")->text.rfind("1 slice lacks ", 0), 0u);
  editAll(one(2));
  EXPECT_EQ(find(only(), "RESCALE_DEFAULT")->text.rfind("2 slices lack ", 0), 0u);
}

TEST_F(ReportWords, NeverPutOneBesideAPlural) {
  const std::regex wrong(R"([^;] 1 (slices|files|voxels|images)\b|\b1 slice (are|were|lack|do)\b)");
  const auto expectRight = [&] {
    const std::string page = reportPage(scan().report());
    std::smatch found;
    EXPECT_FALSE(std::regex_search(page, found, wrong)) << found.str() << "\n" << page;
  };
  const Change spoilings[] = {
      [](DcmDataset& data) { put(data, DCM_LossyImageCompression, "01"); },
      [](DcmDataset& data) { put(data, DCM_RescaleSlope, "many"); },
      [](DcmDataset& data) { delete data.remove(DCM_RescaleIntercept); },
      [](DcmDataset& data) { put(data, DCM_BitsStored, "40"); },
      [](DcmDataset& data) { put(data, DCM_ImagePositionPatient, "1\\2"); },
      [](DcmDataset& data) { put(data, DCM_PhotometricInterpretation, ""); },
      [](DcmDataset& data) { put(data, DCM_RescaleType, "OD"); },
  };
  for (const Change& spoil : spoilings) {
    fs::remove_all(folder());
    write(rampVolume());
    edit(slice(3), spoil);
    expectRight();
  }
  fs::remove_all(folder());
  write(rampVolume());
  fs::remove(slice(3));
  expectRight();
  fs::copy_file(slice(2), folder() / "again");
  expectRight();
  writeBytes(slice(4), readBytes(slice(4)).substr(0, 300));
  expectRight();
  fs::remove_all(folder());
  fs::create_directories(folder());
  writeBytes(folder() / "letter", "no DICOM");
  expectRight();
}

TEST_F(ReportWords, CallShearAlongColumnsAGantryTilt) {
  shear(0.0, 0.3);
  ASSERT_NE(find(only(), "GANTRY_TILT"), nullptr) << codes(only());
  EXPECT_EQ(find(only(), "SHEARED_SIDEWAYS"), nullptr);
}

TEST_F(ReportWords, CallShearAlongRowsNoGantryTilt) {
  for (double columns_mm : {0.0, 0.3}) {
    shear(0.3, columns_mm);
    EXPECT_EQ(find(only(), "GANTRY_TILT"), nullptr);
    const Finding* sideways = find(only(), "SHEARED_SIDEWAYS");
    ASSERT_NE(sideways, nullptr) << codes(only());
    EXPECT_EQ(sideways->severity, Severity::repair);
    EXPECT_NE(sideways->text.find("sideways"), std::string::npos);
    EXPECT_GT(only().tilt_deg, 10.0);
  }
}

TEST_F(ReportWords, SayOfWhatIsRefusedThatNothingWasPutRight) {
  shear(0.0, 0.3);
  EXPECT_NE(find(only(), "GANTRY_TILT")->action.find("straightened"), std::string::npos);
  editAll([](DcmDataset& data) { put(data, DCM_LossyImageCompression, "01"); });
  EXPECT_EQ(only().verdict, Verdict::refused);
  EXPECT_EQ(find(only(), "GANTRY_TILT")->action, "");
  EXPECT_EQ(reportPage(scanned_).find("straightened"), std::string::npos);
  import({{ code::kLossySource, "accept" }});
  EXPECT_NE(find(chosen(), "GANTRY_TILT")->action.find("straightened"), std::string::npos);
}

TEST_F(ReportWords, OnPaperListTheOptionsAndNumberTheSeriesInTheirOrder) {
  editAll([](DcmDataset& data) {
    put(data, DCM_LossyImageCompression, "01");
    put(data, DCM_SeriesInstanceUID, "1.2.3.1");
  });
  fs::rename(folder(), folder().string() + "-lossy");
  write(rampVolume());
  fs::rename(folder().string() + "-lossy", folder() / "lossy");
  const ImportReport report = scan().report();
  ASSERT_EQ(report.series.size(), 2u);
  const std::string page = reportPage(report);
  const auto first = page.find("Series 1 of 2"), second = page.find("Series 2 of 2");
  ASSERT_NE(first, std::string::npos) << page;
  ASSERT_NE(second, std::string::npos) << page;
  EXPECT_LT(first, second);
  EXPECT_NE(page.find("PASS"), std::string::npos);
  EXPECT_LT(page.find("PASS"), second) << "what can be used comes first";
  for (const char* words : {"LOSSY_SOURCE=refuse", "LOSSY_SOURCE=accept", "Use it?",
                            "Use it for training, marked as lossy"}) {
    EXPECT_NE(page.find(words), std::string::npos) << words;
  }
}

TEST_F(ReportWords, ShowJapaneseCharactersOfEverySet) {
  const auto describe = [&](const char* charset, const std::string& bytes) {
    editAll([&](DcmDataset& data) {
      put(data, DCM_SpecificCharacterSet, charset);
      put(data, DCM_SeriesDescription, bytes);
    });
    return scan().report().series.front().description;
  };
  EXPECT_EQ(describe("\\ISO 2022 IR 87", "CT \x1B$B;3ED\x1B(B x"), "CT 山田 x");
  EXPECT_EQ(describe("ISO 2022 IR 13\\ISO 2022 IR 87", "\xD4\xCF\xC0\xDE \x1B$B;3ED\x1B(J"),
            "ﾔﾏﾀﾞ 山田");
  EXPECT_EQ(describe("\\ISO 2022 IR 87\\ISO 2022 IR 159", "\x1B$(D0]\x1B(B a \x1B$BB@O:\x1B(B"),
            "伮 a 太郎");
  // Half a character, and one that no set has.
  EXPECT_TRUE(describe("\\ISO 2022 IR 87", "CT \x1B$B;").starts_with("CT"));
  EXPECT_TRUE(describe("\\ISO 2022 IR 87", "CT \x1B$B\x7F\x7F\x1B(B").starts_with("CT"));
}

TEST_F(ReportWords, InJsonNameNothingOfTheSourceUnlessAsked) {
  editAll([](DcmDataset& data) { put(data, DCM_SeriesDescription, "Mueller^Anna"); });
  import();
  const std::string uid = chosen().uid;
  const Json hidden = toJson(report_), shown = toJson(report_, Identity::shown);
  for (const std::string& name : {uid, std::string("Mueller"), folder().string()}) {
    EXPECT_EQ(hidden.dump().find(name), std::string::npos) << name;
  }
  EXPECT_EQ(hidden["series"][0]["uid"], hidden["chosen"]);
  EXPECT_EQ(hidden["chosen"], "1") << "its number";
  EXPECT_EQ(hidden.dump().find(seriesHash(uid)), std::string::npos);
  EXPECT_EQ(reportPage(report_).find(seriesHash(uid)), std::string::npos);
  for (const char* key : {"description", "source"}) EXPECT_EQ(hidden["series"][0][key], "") << key;
  EXPECT_EQ(hidden["path"], "");
  EXPECT_EQ(shown["path"], folder().string());
  EXPECT_EQ(shown["chosen"], uid);
  EXPECT_EQ(shown["series"][0]["uid"], uid);
  EXPECT_EQ(shown["series"][0]["description"], "Mueller^Anna");
  EXPECT_EQ(shown["series"][0]["source"], "DICOM");
}

TEST_F(ReportWords, InJsonAnErrorSaysNotWhere) {
  fs::remove_all(folder());
  fs::create_directories(folder() / "Mueller");
  const ImportReport report = scan().report();
  ASSERT_TRUE(report.error);
  EXPECT_EQ(toJson(report)["error"]["where"], "");
  EXPECT_EQ(toJson(report, Identity::shown)["error"]["where"], folder().string());
}

TEST(SeriesHash, IsTheSameEverywhereAndKeepsTheNumberOfAPart) {
  // printf 1.2.3 | sha256sum
  EXPECT_EQ(seriesHash("1.2.3"), "c47f5b18b8a430e698b9fe15e51f6119");
  EXPECT_EQ(seriesHash("1.2.3#2"), seriesHash("1.2.3") + "#2");
  EXPECT_EQ(seriesHash("file:Anna#2").find('#'), std::string::npos);
}

TEST_F(ReportWords, ANumberChoosesTheSeriesAsItsUidDoes) {
  CtFolder ct = scan();
  const std::string uid = ct.report().series.front().uid;
  ASSERT_TRUE(ct.read("1", {}, Progress()).ok());
  EXPECT_EQ(ct.report().chosen, uid);
  EXPECT_EQ(ct.read("2", {}, Progress()).error().code.str(), "NO_SUCH_SERIES");
}

TEST(SourceIds, ByAKeyStandForTheSameUidsAndForNobodyWithoutIt) {
  const SourceIds plain{seriesHash("1.2"), seriesHash("1.2.3"), seriesHash("1.2.7")};
  const SourceIds kept = plain.keyed("a"), others = plain.keyed("b");
  EXPECT_NE(kept.study, plain.study);
  EXPECT_NE(kept.study, others.study) << "two cases of one patient cannot be told";
  for (const SourceIds* of : {&plain, &kept, &others}) {
    EXPECT_TRUE(of->standsFor(of->study, seriesHash("1.2")));
    EXPECT_FALSE(of->standsFor(of->study, seriesHash("1.3")));
    EXPECT_FALSE(of->standsFor(of->study, ""));
  }
  EXPECT_TRUE(SourceIds().keyed("a").empty());
}

TEST_F(ReportWords, AnOptionThatNoSeriesOffersIsNamedWhereverItIsAsked) {
  editAll([](DcmDataset& data) { put(data, DCM_LossyImageCompression, "01"); });
  const auto answer = [&](const char* option) {
    return scan().checkAnswers({{code::kLossySource, option}});
  };
  EXPECT_TRUE(answer("accept").ok());
  ASSERT_FALSE(answer("yes").ok());
  EXPECT_EQ(answer("yes").error().code.str(), "BAD_CHOICE");
  EXPECT_EQ(answer("yes").error().next, "Choose refuse or accept");
  EXPECT_TRUE(scan().checkAnswers({{code::kPhases, "7"}}).ok()) << "nobody asked";
}

TEST_F(ReportWords, AnOptionOfAQuestionThatComesWithAnAnswerIsChecked) {
  // The second scan has a gap, which is only asked about once that scan is chosen.
  editAll([](DcmDataset& data) { put(data, DCM_ConvolutionKernel, "B30f"); });
  for (int n : {1, 2, 4, 5, 6}) {
    again(n, [&](DcmDataset& data) {
      put(data, DCM_ConvolutionKernel, "B70f");
      put(data, DCM_RescaleIntercept, "-1000");
    });
  }
  EXPECT_TRUE(scan().checkAnswers({{code::kPhases, "1"}, {code::kMissingSlices, "guess"}}).ok());
  EXPECT_TRUE(scan().checkAnswers({{code::kPhases, "2"}, {code::kMissingSlices, "fill"}}).ok());
  const Status wrong = scan().checkAnswers({{code::kPhases, "2"}, {code::kMissingSlices, "guess"}});
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error().code.str(), "BAD_CHOICE");
}

}  // namespace trephine::test
