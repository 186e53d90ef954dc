// Files that are not as they should be, folders of all sorts, and what a report may tell.
#include <zlib.h>

#include <stdexcept>

#include "imaging/codes.h"
#include "imaging/report/provenance.h"
#include "imaging/report/report_page.h"
#include "series_fixture.h"

namespace trephine::test {

namespace fs = std::filesystem;

class TrapFiles : public SeriesFixture {
 protected:
  static DcmDataset slice(int k, const char* series = nullptr) {
    Image image;
    image.position_mm.z = 100.0 + k;
    image.instance = k + 1;
    fillPattern(image, k);
    DcmDataset data = makeImage(image);
    if (series) {
      put(data, DCM_SeriesInstanceUID, series);
      put(data, DCM_SOPInstanceUID, std::string(series) + "." + std::to_string(k + 1));
    }
    return data;
  }

  static void saveAs(DcmDataset data, const fs::path& file, const Packing& packing = {}) {
    save(data, file, packing);
  }

  // Slices one above the other, in the given files.
  void saveSlices(const std::vector<fs::path>& files) {
    for (std::size_t k = 0; k < files.size(); ++k) saveAs(slice(int(k)), files[k]);
  }

  static void expectSlices(const Volume& volume, int count = 4) {
    ASSERT_EQ(volume.geometry.size, (Index3{7, 5, count}));
    for (std::size_t v = 0; v < volume.hu.size(); ++v) {
      const int n = int(v % 35);
      ASSERT_EQ(volume.hu[v], patternValue(n % 7, n / 7, int(v / 35)) - 1024) << v;
    }
  }

  Volume importOf(const fs::path& path) {
    CtFolder ct = scan(path);
    report_ = ct.report();
    const auto best = ct.bestSeries();
    if (!best) throw std::runtime_error("no series");
    auto volume = ct.read(*best, {}, Progress());
    report_ = ct.report();
    if (!volume.ok()) throw std::runtime_error(volume.error().sentence());
    return std::move(volume).value();
  }

  // The data set alone: no preamble and no meta header.
  static std::string bareBytes(DcmDataset data, E_TransferSyntax syntax, const fs::path& scratch) {
    EXPECT_TRUE(data.saveFile(scratch.c_str(), syntax).good());
    const std::string bytes = readBytes(scratch);
    fs::remove(scratch);
    return bytes;
  }

  // A DICOMDIR with one record for each of these references.
  static void saveDicomDir(const fs::path& file, const std::vector<std::string>& references) {
    DcmFileFormat dicom;
    DcmDataset& data = *dicom.getDataset();
    put(data, DCM_SOPClassUID, UID_MediaStorageDirectoryStorage);
    put(data, DCM_SOPInstanceUID, "1.2.3.99");
    put(data, DCM_FileSetID, "TRAPS");
    for (std::size_t n = 0; n < references.size(); ++n) {
      DcmItem* record = nullptr;
      ASSERT_TRUE(
          data.findOrCreateSequenceItem(DCM_DirectoryRecordSequence, record, long(n)).good());
      record->putAndInsertString(DCM_DirectoryRecordType, "IMAGE");
      record->putAndInsertString(DCM_ReferencedFileID, references[n].c_str());
    }
    fs::create_directories(file.parent_path());
    ASSERT_TRUE(dicom.saveFile(file.c_str(), EXS_LittleEndianExplicit).good());
    ASSERT_NE(readBytes(file).find(UID_MediaStorageDirectoryStorage), std::string::npos);
  }
};

TEST_F(TrapFiles, DataSetsWithoutAnyMetaHeader) {
  for (const E_TransferSyntax syntax :
       {EXS_LittleEndianImplicit, EXS_LittleEndianExplicit, EXS_BigEndianExplicit}) {
    SCOPED_TRACE(DcmXfer(syntax).getXferName());
    for (int k = 0; k < 4; ++k) {
      writeBytes(folder() / std::to_string(k), bareBytes(slice(k), syntax, temporary_ / "scratch"));
    }
    expectSlices(import());
    EXPECT_EQ(chosen().transfer_syntax, DcmXfer(syntax).getXferID());
  }
}

TEST_F(TrapFiles, AMetaHeaderWithoutTransferSyntax) {
  for (int k = 0; k < 4; ++k) {
    const fs::path file = folder() / std::to_string(k);
    saveAs(slice(k), file);
    std::string bytes = readBytes(file);
    // The element leaves, and the group's length shrinks by as much.
    const std::size_t at = bytes.find(std::string("\x02\x00\x10\x00UI", 6));
    ASSERT_NE(at, std::string::npos);
    const std::size_t length = 8 + static_cast<unsigned char>(bytes[at + 6]);
    bytes.erase(at, length);
    bytes[140] = char(static_cast<unsigned char>(bytes[140]) - length);
    writeBytes(file, bytes);
  }
  expectSlices(import());
}

TEST_F(TrapFiles, HeadersThatAreCutAnywhereNeverLoseTheOtherSlices) {
  const std::vector<fs::path> files = {folder() / "a", folder() / "b", folder() / "c",
                                       folder() / "d", folder() / "e"};
  for (const int cut : {1, 4}) {
    const std::string whole =
        bareBytes(slice(cut), EXS_LittleEndianExplicit, temporary_ / "scratch");
    for (std::size_t length = 0; length < whole.size(); length += 13) {
      SCOPED_TRACE(std::to_string(length) + " bytes of slice " + std::to_string(cut + 1));
      fs::remove_all(folder());
      saveSlices(files);
      writeBytes(files[std::size_t(cut)], whole.substr(0, length));
      CtFolder ct = scan();
      ASSERT_EQ(ct.report().series.size(), 1u);
      // Cut before it says what it is, it is skipped: at the end, an even stack is left.
      const auto volume = ct.read("1.2.3.4", {}, Progress());
      if (volume.ok()) {
        int skipped = 0;
        for (const SkippedFiles& some : ct.report().skipped) skipped += some.count;
        ASSERT_EQ(skipped, 1);
        ASSERT_EQ(cut, 4);
        ASSERT_EQ(volume->geometry.size[2], 4);
      } else {
        ASSERT_EQ(volume.error().code.str(), "MISSING_SLICES");
      }
    }
  }
}

TEST_F(TrapFiles, ADeflatedFileThatUnfoldsIntoEndlessSequencesIsRefused) {
  std::string nested = bareBytes(slice(0), EXS_LittleEndianExplicit, temporary_ / "scratch");
  nested.resize(nested.find(std::string("\x28\x00\x02\x00", 4)));  // up to the image's own group
  const std::string level("\x20\x00\x40\x11SQ\0\0\xFF\xFF\xFF\xFF\xFE\xFF\x00\xE0\xFF\xFF\xFF\xFF",
                          20);
  nested.reserve(nested.size() + 1500000 * level.size());
  for (int n = 0; n < 1500000; ++n) nested += level;
  z_stream stream{};
  ASSERT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(nested.size() / 8, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(nested.data());
  stream.avail_in = uInt(nested.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = uInt(packed.size());
  ASSERT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);

  saveAs(slice(0), folder() / "0", {EXS_DeflatedLittleEndianExplicit});
  std::string bytes = readBytes(folder() / "0");
  const auto meta_length = static_cast<unsigned char>(bytes[140]);  // of the group, below 256
  bytes.resize(std::size_t(144) + meta_length);
  writeBytes(folder() / "0", bytes + packed);
  const CtFolder ct = scan();  // and the program is still there
  EXPECT_FALSE(ct.bestSeries().has_value());
}

TEST_F(TrapFiles, NamesOutsideOfAscii) {
  const fs::path below = folder() /
                         "\xC3\x9C"
                         "berpr\xC3\xBC"
                         "fung \xE9\xA0\xAD\xE9\x83\xA8" /
                         "\xFF\xFE bytes";
  saveSlices({below / "\xD0\x9B\xD1\x8E\xD0\xBA", below / "a b\nc", below / "\x80", below / "1"});
  expectSlices(import());
  expectSlices(importOf(below));
  EXPECT_NO_THROW(toJson(report_).dump());
}

TEST_F(TrapFiles, OneInodeUnderManyNamesIsOneFile) {
  saveSlices({folder() / "a", folder() / "b", folder() / "c", folder() / "d"});
  fs::create_hard_link(folder() / "a", folder() / "again");
  fs::create_symlink(folder() / "b", folder() / "link");
  fs::create_symlink(folder() / "gone", folder() / "broken");
  fs::create_directory_symlink(folder(), folder() / "loop");
  expectSlices(import());
  EXPECT_EQ(report_.files_read, 4);
  EXPECT_EQ(chosen().findings.size(), 0u);
}

TEST_F(TrapFiles, ADicomDirNamesItsFilesInWhateverCase) {
  saveSlices(
      {folder() / "sub/Im1", folder() / "sub/im2", folder() / "SUB2/IM3", folder() / "SUB2/im4"});
  saveAs(slice(9, "1.2.3.5"), folder() / "not in the directory");
  saveDicomDir(folder() / "DICOMDIR", {"SUB\\IM1", "Sub\\IM2", "sub2\\im3", "SUB2\\IM4"});
  expectSlices(importOf(folder() / "DICOMDIR"));
  EXPECT_EQ(report_.files_seen, 4);
  EXPECT_EQ(report_.series.size(), 1u);
  // Inside a folder it is a file that is skipped.
  expectSlices(import());
  EXPECT_EQ(report_.files_seen, 6);
  EXPECT_EQ(report_.series.size(), 2u);
}

TEST_F(TrapFiles, ADicomDirNeverLeadsOutOfItsFolder) {
  saveSlices({folder() / "a", folder() / "b", folder() / "c", folder() / "d"});
  saveAs(slice(9, "1.2.3.5"), temporary_ / "outside" / "secret");
  const std::string absolute = (temporary_ / "outside" / "secret").string();
  for (const std::string& reference :
       {std::string("..\\OUTSIDE\\SECRET"), std::string("../outside/secret"), absolute}) {
    saveDicomDir(folder() / "DICOMDIR", {"A", "B", "C", "D", reference});
    expectSlices(importOf(folder() / "DICOMDIR"));
    EXPECT_EQ(report_.series.size(), 1u) << reference;
  }
}

TEST_F(TrapFiles, AStaleDicomDirIsAReasonToLookAtTheFolder) {
  saveSlices({folder() / "a", folder() / "b", folder() / "c", folder() / "d"});
  saveDicomDir(folder() / "DICOMDIR", {"A", "B", "C", "E"});
  expectSlices(importOf(folder() / "DICOMDIR"));
  saveDicomDir(folder() / "DICOMDIR", {});
  expectSlices(importOf(folder() / "DICOMDIR"));
  // Named without a folder, as one does who stands in it.
  const fs::path before = fs::current_path();
  fs::current_path(folder());
  expectSlices(importOf("DICOMDIR"));
  saveDicomDir(folder() / "DICOMDIR", {"A", "B", "C", "D"});
  expectSlices(importOf("DICOMDIR"));
  fs::current_path(before);
}

TEST_F(TrapFiles, ADicomDirWhoseFilesAreCutIsStillUsed) {
  saveSlices({folder() / "a", folder() / "b", folder() / "c", folder() / "d"});
  saveDicomDir(folder() / "DICOMDIR", {"A", "B", "C", "D"});
  const std::string bytes = readBytes(folder() / "DICOMDIR");
  writeBytes(folder() / "DICOMDIR", bytes.substr(0, bytes.size() - 7));
  expectSlices(importOf(folder() / "DICOMDIR"));
}

TEST_F(TrapFiles, ASeriesWhoseUidWasEmptiedIsToldByStudyNumberAndTime) {
  for (int k = 0; k < 4; ++k) {
    for (const int number : {1, 2}) {
      DcmDataset data = slice(k);
      put(data, DCM_SeriesInstanceUID, "");
      put(data, DCM_SOPInstanceUID, "1.2." + std::to_string(10 * number + k));
      put(data, DCM_SeriesNumber, std::to_string(number));
      if (number == 2) put(data, DCM_RescaleIntercept, "-1000");
      add(data);
    }
  }
  CtFolder ct = scan();
  ASSERT_EQ(ct.report().series.size(), 2u);
  for (const SeriesReport& series : ImportReport(ct.report()).series) {
    EXPECT_EQ(series.slices, 4);
    ASSERT_NE(find(series, "NO_SERIES_UID"), nullptr);
    const auto volume = ct.read(series.uid, {}, Progress());
    ASSERT_TRUE(volume.ok());
    EXPECT_EQ(volume->at(3, 2, 1),
              patternValue(3, 2, 1) - (series.uid.ends_with("#2") ? 1000 : 1024));
  }
}

TEST_F(TrapFiles, ObjectsOfOtherKindsAreListedAndNeverStacked) {
  saveSlices({folder() / "a", folder() / "b", folder() / "c", folder() / "d"});
  const std::pair<const char*, const char*> kinds[] = {
      {UID_ComprehensiveSRStorage, "SR"},
      {UID_RTStructureSetStorage, "RTSTRUCT"},
      {UID_RTDoseStorage, "RTDOSE"},
      {UID_SegmentationStorage, "SEG"},
      {UID_EncapsulatedPDFStorage, "DOC"},
      {UID_KeyObjectSelectionDocumentStorage, "KO"},
      {UID_GrayscaleSoftcopyPresentationStateStorage, "PR"},
      {UID_RTPlanStorage, "RTPLAN"}};
  // In series of their own, and then in that of the slices.
  for (const bool own : {true, false}) {
    int n = 0;
    for (const auto& [sop_class, modality] : kinds) {
      ++n;
      for (int k = 0; k < 2; ++k) {
        DcmDataset data = slice(k, ("1.2.3.7." + std::to_string(n)).c_str());
        if (!own) put(data, DCM_SeriesInstanceUID, "1.2.3.4");
        put(data, DCM_SOPClassUID, sop_class);
        put(data, DCM_Modality, own ? modality : "CT");
        const std::string name = modality;
        if (name != "RTDOSE" && name != "SEG") data.findAndDeleteElement(DCM_PixelData);
        saveAs(data, folder() / (name + std::to_string(k)),
               {name == "SR" ? EXS_DeflatedLittleEndianExplicit : EXS_LittleEndianExplicit});
      }
    }
    expectSlices(import());
    if (own) {
      EXPECT_EQ(report_.series.size(), 1 + std::size(kinds));
      for (const SeriesReport& series : report_.series) {
        if (series.uid == report_.chosen) continue;
        EXPECT_EQ(series.verdict, Verdict::refused) << series.modality;
        const char* code = series.modality == "RTDOSE" || series.modality == "SEG"
                               ? "NOT_CT"
                               : "NOT_AN_IMAGE_SERIES";
        EXPECT_NE(find(series, code), nullptr) << series.modality << ": " << codes(series);
      }
    }
  }
}

TEST_F(TrapFiles, ALocalizerInTheSeriesWithTheSlicesGeometryIsSplitOff) {
  saveSlices({folder() / "a", folder() / "b", folder() / "c", folder() / "d"});
  DcmDataset scout = slice(5);
  put(scout, DCM_ImageType, "ORIGINAL\\PRIMARY\\LOCALIZER\\CT_SOM5 TOP");
  saveAs(scout, folder() / "scout");
  expectSlices(import());
  DcmDataset sagittal = slice(6);
  put(sagittal, DCM_ImageOrientationPatient, "0\\1\\0\\0\\0\\-1");
  saveAs(sagittal, folder() / "scout");
  expectSlices(import());
}

TEST_F(TrapFiles, ColourOfAnyKindIsRefused) {
  for (const char* photometric : {"RGB", "YBR_FULL", "PALETTE COLOR"}) {
    fs::remove_all(folder());
    for (int k = 0; k < 4; ++k) {
      DcmDataset data = slice(k);
      put(data, DCM_PhotometricInterpretation, photometric);
      if (std::string(photometric) != "PALETTE COLOR") {
        data.putAndInsertUint16(DCM_SamplesPerPixel, 3);
        const std::vector<Uint16> words(35 * 3, 7);
        data.putAndInsertUint16Array(DCM_PixelData, words.data(), words.size());
      }
      add(data);
    }
    expectRefused("COLOUR");
  }
}

// What may leave the room names no patient, file, description or UID, whatever went wrong.
TEST_F(TrapFiles, ProvenanceAndPageTellNothingOfThePatient) {
  const fs::path named = temporary_ / "MUSTERMANN_ERIKA";
  const auto secretly = [&](DcmDataset data) {
    put(data, DCM_PatientName, "MUSTERMANN^ERIKA");
    put(data, DCM_PatientID, "ID-4711");
    put(data, DCM_SeriesDescription, "Mustermann Schaedel");
    put(data, DCM_StudyDescription, "Mustermann");
    put(data, DCM_InstitutionName, "Mustermann-Klinik");
    put(data, DCM_BodyPartExamined, "MUSTERMANN");
    put(data, DCM_PatientBirthDate, "19710823");
    put(data, DCM_AccessionNumber, "4711");
    return data;
  };
  for (int k = 0; k < 6; ++k) {
    if (k == 2) continue;
    Image image;
    image.position_mm.z = 100.0 + k;
    image.instance = k + 1;
    fillPattern(image, k);
    DcmDataset data = secretly(makeImage(image));
    put(data, DCM_SeriesInstanceUID, "1.2.826.4711");
    if (k == 4) put(data, DCM_InstanceNumber, "4711");
    saveAs(data, named / ("mustermann" + std::to_string(k)));
  }
  fs::resize_file(named / "mustermann4", fs::file_size(named / "mustermann4") - 20);
  writeBytes(named / "mustermann.txt", "Mustermann, geb. 23.8.1971");
  writeBytes(named / "mustermann.nii", std::string(400, 'x'));
  writeBytes(named / "mustermann_cut", readBytes(named / "mustermann1").substr(0, 300));
  DcmDataset other = secretly(slice(0, "1.2.826.4711.5"));
  put(other, DCM_RescaleType, "4711");
  saveAs(other, named / "other");

  const auto expectSilent = [](const std::string& text) {
    std::string lower = text;
    for (char& c : lower) c = char(std::tolower(static_cast<unsigned char>(c)));
    for (const char* secret :
         {"mustermann", "erika", "id-4711", "1.2.826", "1.2.3", "schaedel", "1971"}) {
      EXPECT_EQ(lower.find(secret), std::string::npos) << secret << " in " << text;
    }
  };
  CtFolder ct = scan(named);
  expectSilent(reportPage(ct.report()));
  ImportRequest request;
  const auto refused = ct.read("1.2.826.4711", request, Progress());
  ASSERT_FALSE(refused.ok());
  expectSilent(reportPage(ct.report()));
  request.answers = {{code::kMissingSlices, "fill"}};
  const auto volume = ct.read("1.2.826.4711", request, Progress());
  ASSERT_TRUE(volume.ok()) << volume.error().sentence();
  expectSilent(reportPage(ct.report()));
  const Json json = toJson(*ct.report().provenance);
  expectSilent(json.dump());
  EXPECT_EQ(json["choices"]["MISSING_SLICES"], "fill");
  EXPECT_EQ(json["changes"][0]["code"], "MISSING_SLICES");
  EXPECT_EQ(json["transfer_syntax"], "Explicit VR Little Endian");
  EXPECT_EQ(json["volume_sha256"], volumeSha256(*volume));
  EXPECT_EQ(json["lossy"], false);
}

TEST_F(TrapFiles, AnInstanceNumberThatIsNoNumberIsNotRepeated) {
  for (int k = 0; k < 4; ++k) {
    DcmDataset data = slice(k);
    put(data, DCM_InstanceNumber, "MUSTER");
    put(data, DCM_RescaleSlope, "0");
    add(data);
  }
  const ImportReport report = scan().report();
  ASSERT_EQ(find(report.series.front(), "RESCALE_DEFAULT")->slices.size(), 4u);
  EXPECT_EQ(toJson(report).dump().find("MUSTER"), std::string::npos);
}

}  // namespace trephine::test
