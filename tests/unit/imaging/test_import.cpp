#include <sys/stat.h>

#include "series_fixture.h"

namespace trephine::test {

using Import = SeriesFixture;
namespace fs = std::filesystem;

TEST_F(Import, FileNamesAndFoldersDoNotMatter) {
  const Volume volume = rampVolume();
  write(volume);
  const char* names[] = {"z", "sub/a.jpg", "sub/deep/\xE9\xA0\xAD.txt", "DICOMDIR.bak", "9", "1"};
  for (int n = 1; n <= 6; ++n) {
    const fs::path target = folder() / names[n - 1];
    fs::create_directories(target.parent_path());
    fs::rename(slice(n), target);
  }
  const Volume back = import();
  EXPECT_EQ(back.hu, volume.hu);
  EXPECT_EQ(back.geometry, volume.geometry);
}

TEST_F(Import, AFileWithoutPreambleIsRead) {
  const Volume volume = rampVolume();
  write(volume);
  for (int n = 1; n <= 6; ++n) writeBytes(slice(n), readBytes(slice(n)).substr(132));
  EXPECT_EQ(import().hu, volume.hu);
}

TEST_F(Import, EveryUncompressedTransferSyntaxGivesTheSameVoxels) {
  const Volume volume = rampVolume();
  for (const auto& [syntax, uid] : {std::pair(EXS_LittleEndianImplicit, "1.2.840.10008.1.2"),
                                    std::pair(EXS_LittleEndianExplicit, "1.2.840.10008.1.2.1"),
                                    std::pair(EXS_BigEndianExplicit, "1.2.840.10008.1.2.2")}) {
    write(volume);
    editAll([](DcmDataset&) {}, syntax);
    EXPECT_EQ(import().hu, volume.hu) << uid;
    EXPECT_EQ(chosen().transfer_syntax, uid);
    EXPECT_EQ(chosen().verdict, Verdict::pass);
  }
}

TEST_F(Import, SlopeAndInterceptAreTakenPerSlice) {
  Volume volume = rampVolume({7, 5, 4});
  write(volume);
  edit(slice(2), [](DcmDataset& data) {
    put(data, DCM_RescaleSlope, "2");
    put(data, DCM_RescaleIntercept, "-2000");
  });
  const Volume back = import();
  EXPECT_EQ(back.at(3, 3, 0), volume.at(3, 3, 0));
  EXPECT_EQ(back.at(3, 3, 1), 2 * (volume.at(3, 3, 1) + 1024) - 2000);
  for (const int k : {2, 3}) EXPECT_EQ(back.at(3, 3, k), volume.at(3, 3, k));
  EXPECT_EQ(chosen().verdict, Verdict::pass);
}

TEST_F(Import, AnAbsentOrZeroSlopeIsOne) {
  const Volume volume = rampVolume({7, 5, 4});
  write(volume);
  edit(slice(1), [](DcmDataset& data) { put(data, DCM_RescaleSlope, "0"); });
  edit(slice(2), [](DcmDataset& data) { data.findAndDeleteElement(DCM_RescaleSlope); });
  EXPECT_EQ(import().hu, volume.hu);
  EXPECT_EQ(chosen().verdict, Verdict::pass);
  const Finding* finding = find(chosen(), "RESCALE_DEFAULT");
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->slices, (std::vector<std::string>{"slice 1", "slice 2"}));
}

TEST_F(Import, ValuesThatAreNotWholeAreRoundedAndSaidToBe) {
  write(rampVolume({7, 5, 4}));
  edit(slice(2), [](DcmDataset& data) { put(data, DCM_RescaleSlope, "0.3"); });
  import();
  EXPECT_EQ(chosen().verdict, Verdict::repaired);
  EXPECT_NE(find(chosen(), "HU_ROUNDED"), nullptr);
}

TEST_F(Import, ValuesOutsideInt16AreClampedAndSaidToBe) {
  write(rampVolume({7, 5, 4}));
  edit(slice(2), [](DcmDataset& data) { put(data, DCM_RescaleSlope, "1000"); });
  import();
  EXPECT_EQ(chosen().verdict, Verdict::repaired);
  EXPECT_NE(find(chosen(), "HU_CLAMPED"), nullptr);
  EXPECT_EQ(chosen().hu_max, 32767);
}

TEST_F(Import, GarbageAboveTwelveStoredBitsDoesNotReachTheVolume) {
  const Volume volume = rampVolume({7, 5, 4});
  write(volume);
  editAll([](DcmDataset& data) {
    const Uint16* words = nullptr;
    unsigned long count = 0;
    ASSERT_TRUE(data.findAndGetUint16Array(DCM_PixelData, words, &count).good());
    std::vector<Uint16> spoilt(words, words + count);
    for (std::size_t n = 0; n < spoilt.size(); ++n) spoilt[n] |= Uint16((n % 16) << 12);
    data.putAndInsertUint16Array(DCM_PixelData, spoilt.data(), spoilt.size());
    data.putAndInsertUint16(DCM_BitsStored, 12);
    data.putAndInsertUint16(DCM_HighBit, 11);
  });
  EXPECT_EQ(import().hu, volume.hu);
}

TEST_F(Import, SignedTwelveBitPixelsAreSignExtended) {
  write(rampVolume({4, 4, 4}));
  editAll([](DcmDataset& data) {
    std::vector<Uint16> words(16, 0x0F9C);  // -100 in 12 bits
    words[0] = 0x0800;
    data.putAndInsertUint16Array(DCM_PixelData, words.data(), words.size());
    data.putAndInsertUint16(DCM_BitsStored, 12);
    data.putAndInsertUint16(DCM_HighBit, 11);
    data.putAndInsertUint16(DCM_PixelRepresentation, 1);
    put(data, DCM_RescaleIntercept, "0");
  });
  const Volume back = import();
  EXPECT_EQ(back.at(0, 0, 0), -2048);
  EXPECT_EQ(back.at(1, 0, 0), -100);
}

TEST_F(Import, PaddingBecomesAirAndThePassStays) {
  Volume volume = rampVolume({4, 4, 4});
  for (std::size_t n = 0; n < volume.hu.size(); n += 5) volume.hu[n] = -2000;  // stored signed
  write(volume);
  editAll([](DcmDataset& data) { data.putAndInsertUint16(DCM_PixelPaddingValue, Uint16(-2000)); });
  const Volume back = import();
  std::uint64_t padding = 0;
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const bool padded = volume.hu[n] == -2000;
    padding += padded;
    EXPECT_EQ(back.hu[n], padded ? kAirHu : volume.hu[n]);
  }
  EXPECT_EQ(chosen().verdict, Verdict::pass);
  ASSERT_NE(find(chosen(), "PADDING_TO_AIR"), nullptr);
  EXPECT_TRUE(find(chosen(), "PADDING_TO_AIR")->text.starts_with(std::to_string(padding) + " "));
}

TEST_F(Import, Monochrome1KeepsItsHu) {
  const Volume volume = rampVolume();
  write(volume);
  editAll([](DcmDataset& data) { put(data, DCM_PhotometricInterpretation, "MONOCHROME1"); });
  EXPECT_EQ(import().hu, volume.hu);
  EXPECT_EQ(chosen().verdict, Verdict::pass);
}

TEST_F(Import, CopiesOfAFileAreDroppedWithANotice) {
  const Volume volume = rampVolume();
  write(volume);
  fs::copy_file(slice(2), folder() / "copy");
  EXPECT_EQ(import().hu, volume.hu);
  EXPECT_EQ(chosen().verdict, Verdict::pass);
  EXPECT_NE(find(chosen(), "DUPLICATE_FILES"), nullptr);
}

TEST_F(Import, ACutCopyDoesNotSpoilTheWholeSlice) {
  const Volume volume = rampVolume();
  write(volume);
  writeBytes(folder() / "AA_first", readBytes(slice(2)).substr(0, fs::file_size(slice(2)) - 20));
  EXPECT_EQ(import().hu, volume.hu);
  EXPECT_NE(find(chosen(), "DUPLICATE_FILES"), nullptr);
}

TEST_F(Import, LinksAreFollowedOnceAndLoopsEnd) {
  const Volume volume = rampVolume();
  write(volume);
  fs::create_directory_symlink(folder(), folder() / "loop");
  fs::create_symlink(slice(1), folder() / "link");
  fs::create_hard_link(slice(2), folder() / "hard");
  fs::create_symlink(folder() / "nowhere", folder() / "broken");
  ASSERT_EQ(::mkfifo((folder() / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(import().hu, volume.hu);
  EXPECT_EQ(report_.files_seen, 10);
  EXPECT_EQ(report_.files_read, 6);
  int skipped = 0;
  for (const SkippedFiles& files : report_.skipped) skipped += files.count;
  EXPECT_EQ(skipped, 4);
}

TEST_F(Import, ALocalizerOfTheSameSeriesIsSplitOff) {
  const Volume volume = rampVolume();
  write(volume);
  fs::copy_file(slice(1), folder() / "scout");
  edit(folder() / "scout", [](DcmDataset& data) {
    put(data, DCM_SOPInstanceUID, "1.2.3.4");
    put(data, DCM_ImageType, "ORIGINAL\\PRIMARY\\LOCALIZER");
  });
  EXPECT_EQ(import().hu, volume.hu);
  ASSERT_EQ(report_.series.size(), 2u);
  EXPECT_EQ(report_.series[1].uid, report_.series[0].uid + "#2");
  EXPECT_NE(find(report_.series[1], "LOCALIZER"), nullptr);
  EXPECT_NE(find(report_.series[0], "SERIES_SPLIT"), nullptr);
}

TEST_F(Import, TheCtSeriesWithMostSlicesIsTheDefault) {
  write(rampVolume({7, 5, 4}));
  const fs::path small = folder();
  const Volume large = rampVolume({7, 5, 9});
  ASSERT_TRUE(writeCtSeries(large, {"Large", ""}, folder() / "large").ok());
  EXPECT_EQ(import().hu, large.hu);
  EXPECT_EQ(chosen().description, "Large");
  ASSERT_EQ(report_.series.size(), 2u);
  for (const SeriesReport& series : report_.series) {
    EXPECT_EQ(series.volume_sha256.has_value(), series.description == "Large");
  }
}

TEST_F(Import, AcquisitionNumbersDoNotSplitAStack) {
  const Volume volume = rampVolume();
  write(volume);
  edit(slice(2), [](DcmDataset& data) { put(data, DCM_AcquisitionNumber, "7"); });
  EXPECT_EQ(import().hu, volume.hu);
  EXPECT_EQ(report_.series.size(), 1u);
}

TEST_F(Import, DescriptionsInAnyCharacterSetComeOutAsUtf8) {
  write(rampVolume());
  const auto describe = [&](const char* charset, const std::string& bytes) {
    editAll([&](DcmDataset& data) {
      put(data, DCM_SpecificCharacterSet, charset);
      put(data, DCM_SeriesDescription, bytes);
    });
    return scan().report().series.front().description;
  };
  EXPECT_EQ(describe("ISO_IR 100",
                     "Sch\xE4"
                     "del"),
            "Schädel");
  EXPECT_EQ(describe("ISO_IR 144", "\xBB\xEE\xDA"), "Люк");
  EXPECT_EQ(describe("ISO_IR 192", "頭部"), "頭部");
  EXPECT_EQ(describe("GB18030", "\xCD\xF5"), "王");
  EXPECT_EQ(describe("NO_SUCH_SET",
                     "Sch\xE4"
                     "del"),
            "Schädel");
  EXPECT_EQ(describe("",
                     "Sch\xE4"
                     "del"),
            "Schädel");
  const std::string kanji = describe("\\ISO 2022 IR 87", "CT \x1B$B;3ED\x1B(B");
  EXPECT_TRUE(kanji.starts_with("CT ")) << kanji;
}

TEST_F(Import, TheReportNeverHoldsThePatientsName) {
  write(rampVolume());
  edit(slice(1), [](DcmDataset& data) { put(data, DCM_ImagePositionPatient, "1\\2"); });
  editAll([](DcmDataset& data) {
    put(data, DCM_PatientName, "MUSTERMANN^ERIKA");
    put(data, DCM_PatientID, "ID-4711");
  });
  const std::string json = toJson(scan().report()).dump();
  EXPECT_EQ(json.find("MUSTERMANN"), std::string::npos);
  EXPECT_EQ(json.find("4711"), std::string::npos);
}

TEST_F(Import, TheJsonHasTheKeysOfTheContract) {
  write(rampVolume());
  import();
  const Json json = toJson(report_);
  const auto keys = [](const Json& object) {
    std::string all;
    for (const auto& [key, value] : object.items()) all += key + " ";
    return all;
  };
  EXPECT_EQ(keys(json),
            "path files_seen files_read skipped series chosen provenance seconds start_rss_mb "
            "peak_rss_mb ");
  EXPECT_EQ(keys(json["series"][0]),
            "uid description modality source slices phases memory_mb verdict size spacing_mm origin_mm direction hu_min hu_max "
            "tilt_deg transfer_syntax lossy findings choices volume_sha256 ");
  EXPECT_EQ(keys(json["seconds"]), "scan read hash ");
  EXPECT_EQ(json["series"][0]["direction"], Json::parse("[1.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0]"));
  EXPECT_GT(report_.start_rss_mb, 0.0);
  EXPECT_GE(report_.peak_rss_mb, report_.start_rss_mb);
}

TEST_F(Import, TheDirectionIsRowMajorWithTheAxesAsColumns) {
  SeriesReport series;
  series.geometry.direction = Mat3(Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 9));
  ImportReport report;
  report.series.push_back(series);
  EXPECT_EQ(toJson(report)["series"][0]["direction"],
            Json::parse("[1.0,4.0,7.0,2.0,5.0,8.0,3.0,6.0,9.0]"));
}

TEST_F(Import, TheJsonIsValidUtf8WhateverThePathHolds) {
  ImportReport report;
  report.path = "/data/\xFF\xFE";
  report.series.emplace_back().description = "\xC3";
  EXPECT_NO_THROW(toJson(report).dump());
}

TEST_F(Import, AnUnknownSeriesIsNamed) {
  write(rampVolume());
  CtFolder ct = scan();
  const auto volume = ct.read("1.2.3", {}, Progress());
  ASSERT_FALSE(volume.ok());
  EXPECT_EQ(volume.error().code.str(), "NO_SUCH_SERIES");
}

TEST_F(Import, ACancelStopsScanAndRead) {
  write(rampVolume());
  CtFolder ct = scan();
  Progress cancelled;
  cancelled.cancel();
  EXPECT_EQ(CtFolder::scan(folder(), cancelled).error().code.str(), "CANCELLED");
  EXPECT_EQ(ct.read(*ct.bestSeries(), {}, cancelled).error().code.str(), "CANCELLED");
  EXPECT_TRUE(ct.read(*ct.bestSeries(), {}, Progress()).ok());
}

TEST_F(Import, AFileThatIsCutAfterTheScanRefusesTheSeries) {
  write(rampVolume());
  CtFolder ct = scan();
  const std::string best = *ct.bestSeries();
  fs::resize_file(slice(3), fs::file_size(slice(3)) - 10);
  const auto volume = ct.read(best, {}, Progress());
  ASSERT_FALSE(volume.ok());
  EXPECT_EQ(volume.error().code.str(), "MISSING_SLICES");
  EXPECT_FALSE(ct.bestSeries().has_value());
  EXPECT_EQ(find(ct.report().series.front(), "MISSING_SLICES")->slices,
            std::vector<std::string>{"102.50 mm"});
}

}  // namespace trephine::test
