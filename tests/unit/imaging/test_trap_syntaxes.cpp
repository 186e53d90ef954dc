// Every transfer syntax that can be written, lossless and lossy, whole and damaged.
#include <cmath>

#include "base/memory.h"
#include "imaging/codes.h"
#include "series_fixture.h"

namespace trephine::test {

namespace fs = std::filesystem;

class TrapSyntaxes : public SeriesFixture {
 protected:
  struct Form {
    int allocated, stored;
    bool is_signed;
  };

  static Image image(const Form& form, int columns = 19, int rows = 13) {
    Image image;
    image.columns = columns;
    image.rows = rows;
    image.bits_allocated = form.allocated;
    image.bits_stored = form.stored;
    image.high_bit = form.stored - 1;
    image.is_signed = form.is_signed;
    image.intercept = form.stored < 16 ? "-24" : form.is_signed ? "0" : "-32768";
    return image;
  }

  static std::string nameOf(const Packing& packing, const Form& form) {
    return std::string(DcmXfer(packing.syntax).getXferName()) + " predictor " +
           std::to_string(packing.predictor) + ", " + std::to_string(form.stored) + " of " +
           std::to_string(form.allocated) + (form.is_signed ? " signed" : " unsigned");
  }

  // The k-th of a stack, from 0.
  static Image sliceOf(const Form& form, int k) {
    Image slice = image(form);
    slice.position_mm.z = 100.0 + k;
    slice.instance = k + 1;
    fillPattern(slice, k);
    return slice;
  }
  void addStack(const Form& form, const Packing& packing, int slices) {
    for (int k = 0; k < slices; ++k) {
      add(makeImage(sliceOf(form, k)), packing);
    }
  }

  static void expectStack(const Volume& volume, const Form& form, int slices) {
    ASSERT_EQ(volume.geometry.size, (Index3{19, 13, slices}));
    const int intercept = std::stoi(image(form).intercept);
    for (int k = 0; k < slices; ++k) {
      for (int j = 0; j < 13; ++j) {
        for (int i = 0; i < 19; ++i) {
          ASSERT_EQ(volume.at(i, j, k),
                    patternValue(i, j, k, form.stored, form.is_signed) + intercept)
              << i << " " << j << " " << k;
        }
      }
    }
  }

  void expectLossless(const Form& form, const Packing& packing) {
    SCOPED_TRACE(nameOf(packing, form));
    fs::remove_all(folder());
    addStack(form, packing, 4);
    expectStack(import(), form, 4);
    EXPECT_EQ(chosen().verdict, Verdict::pass);
    EXPECT_EQ(chosen().transfer_syntax, DcmXfer(packing.syntax).getXferID());
    EXPECT_FALSE(chosen().lossy);
  }

  // The file of this instance number, and where its compressed pixels start and end.
  fs::path fileOf(int instance) {
    for (const auto& entry : fs::directory_iterator(folder())) {
      DcmFileFormat dicom;
      EXPECT_TRUE(dicom.loadFile(entry.path().c_str()).good());
      if (text(*dicom.getDataset(), DCM_InstanceNumber) == std::to_string(instance)) {
        return entry.path();
      }
    }
    ADD_FAILURE() << "no such slice";
    return {};
  }

  static constexpr Form kForms[] = {{8, 8, false},   {16, 12, false}, {16, 12, true},
                                    {16, 16, false}, {16, 16, true},  {16, 10, false},
                                    {16, 8, false}};
  static constexpr E_TransferSyntax kCompressed[] = {EXS_RLELossless,          EXS_JPEGProcess14,
                                                     EXS_JPEGProcess14SV1,     EXS_JPEGLSLossless,
                                                     EXS_JPEG2000LosslessOnly, EXS_JPEG2000};
};

TEST_F(TrapSyntaxes, EveryLosslessSyntaxGivesEveryForm) {
  for (const Form& form : kForms) {
    for (const E_TransferSyntax syntax :
         {EXS_LittleEndianImplicit, EXS_LittleEndianExplicit, EXS_BigEndianExplicit,
          EXS_DeflatedLittleEndianExplicit}) {
      expectLossless(form, {syntax});
    }
    for (const E_TransferSyntax syntax : kCompressed) expectLossless(form, {syntax});
  }
}

TEST_F(TrapSyntaxes, EveryPredictorOfLosslessJpeg) {
  for (int predictor = 2; predictor <= 7; ++predictor) {
    for (const Form& form : kForms) expectLossless(form, {EXS_JPEGProcess14, predictor});
  }
}

TEST_F(TrapSyntaxes, FramesOfOneCompressedFile) {
  const auto at = [](double z) { return Vec3(-20.0, 10.5, z); };
  for (const E_TransferSyntax syntax : kCompressed) {
    for (const Form& form : {Form{8, 8, false}, Form{16, 12, true}, Form{16, 16, false}}) {
      for (const bool table : {true, false}) {
        for (const int fragments : {1, 3}) {
          if (syntax == EXS_RLELossless && fragments > 1) continue;  // PS3.5 A.4.2: one a frame
          SCOPED_TRACE(nameOf({syntax}, form) + (table ? " table " : " no table ") +
                       std::to_string(fragments));
          fs::remove_all(folder());
          Image frames = image(form);
          frames.frames = 5;
          fillPattern(frames, 0);
          Packing packing{syntax};
          packing.offset_table = table;
          packing.fragments = fragments;
          add(makeEnhanced(frames, {at(100), at(101), at(102), at(103), at(104)}), packing);
          if (!table && fragments > 1) {  // nothing tells the frames apart, and that is said
            expectRefused("SIZE_MISMATCH");
          } else {
            expectStack(import(), form, 5);
          }
        }
      }
    }
  }
}

TEST_F(TrapSyntaxes, SeveralFragmentsOfASingleFrame) {
  for (const E_TransferSyntax syntax :
       {EXS_JPEGProcess14SV1, EXS_JPEGLSLossless, EXS_JPEG2000LosslessOnly}) {
    for (const bool table : {true, false}) {
      Packing packing{syntax};
      packing.fragments = 4;
      packing.offset_table = table;
      expectLossless({16, 12, true}, packing);
    }
  }
}

// They are no nesting, however many there are.
TEST_F(TrapSyntaxes, ThreeHundredThousandFragmentsOfASingleFrame) {
  Packing packing{EXS_JPEGProcess14SV1};
  packing.fragments = 300000;
  for (int k = 0; k < 4; ++k) {
    DcmDataset data = makeImage(sliceOf(kForms[1], k));
    auto codestreams = encodeFrames(data, packing);
    // Before a marker JPEG may have any number of these.
    auto& bytes = codestreams.front();
    bytes.insert(bytes.begin() + 2, 600000 - bytes.size(), 0xFF);
    saveEncapsulated(data, codestreams, packing, folder() / std::to_string(k));
  }
  expectStack(import(), kForms[1], 4);
}

TEST_F(TrapSyntaxes, CompressedPixelsOfAnotherSizeThanTheHeaderSays) {
  for (const E_TransferSyntax syntax : kCompressed) {
    for (const auto& [columns, rows] :
         {std::pair(19, 12), {19, 14}, {18, 13}, {20, 13}, {13, 19}, {247, 1}}) {
      SCOPED_TRACE(nameOf({syntax}, kForms[1]) + " " + std::to_string(columns) + "x" +
                   std::to_string(rows));
      fs::remove_all(folder());
      for (int k = 0; k < 4; ++k) {
        DcmDataset data = makeImage(sliceOf(kForms[1], k));
        const auto codestreams = encodeFrames(data, {syntax});
        data.putAndInsertUint16(DCM_Rows, Uint16(rows));
        data.putAndInsertUint16(DCM_Columns, Uint16(columns));
        saveEncapsulated(data, codestreams, {syntax}, folder() / std::to_string(k));
      }
      // As many pixels in another shape cannot be told in RLE, which states no size.
      if (syntax == EXS_RLELossless && columns * rows == 247) continue;
      const Error error = refusal();
      EXPECT_TRUE(error.code.str() == "MISSING_SLICES" || error.code.str() == "SIZE_MISMATCH")
          << error.code.str();
    }
  }
}

TEST_F(TrapSyntaxes, PixelsThatAreClaimedToBeFourGigavoxelsAllocateNothing) {
  for (const E_TransferSyntax syntax : kCompressed) {
    fs::remove_all(folder());
    for (int k = 0; k < 4; ++k) {
      DcmDataset data = makeImage(sliceOf(kForms[1], k));
      const auto codestreams = encodeFrames(data, {syntax});
      data.putAndInsertUint16(DCM_Rows, 65535);
      data.putAndInsertUint16(DCM_Columns, 65535);
      saveEncapsulated(data, codestreams, {syntax}, folder() / std::to_string(k));
    }
    const double before_mb = peakResidentMb();
    EXPECT_EQ(refusal().code.str(), "PIXEL_FORMAT");
    CtFolder ct = scan();
    EXPECT_FALSE(ct.slice("1.2.3.4", 0).ok());
    EXPECT_LT(peakResidentMb(), before_mb + 100.0);
  }
}

TEST_F(TrapSyntaxes, AFileThatIsCutIsAMissingSliceWhereverItLies) {
  for (const E_TransferSyntax syntax :
       {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit, EXS_BigEndianExplicit,
        EXS_DeflatedLittleEndianExplicit, EXS_RLELossless, EXS_JPEGProcess14SV1, EXS_JPEGLSLossless,
        EXS_JPEG2000LosslessOnly}) {
    for (const int instance : {1, 3, 5}) {
      for (const unsigned cut : {9U, 120U}) {
        SCOPED_TRACE(nameOf({syntax}, kForms[1]) + ", slice " + std::to_string(instance) +
                     ", without " + std::to_string(cut) + " bytes");
        fs::remove_all(folder());
        addStack(kForms[1], {syntax}, 5);
        const fs::path file = fileOf(instance);
        fs::resize_file(file, fs::file_size(file) - cut);
        const Error error = refusal();
        EXPECT_EQ(error.code.str(), "MISSING_SLICES") << error.sentence();
        if (error.code.str() != "MISSING_SLICES") continue;
        const Volume volume = import({{code::kMissingSlices, "fill"}});
        const int first = instance == 1 ? 1 : 0, last = instance == 5 ? 3 : 4;
        ASSERT_EQ(volume.geometry.size[2], last - first + 1);
        for (int k = first; k <= last; ++k) {
          for (int i = 0; i < 19; ++i) {
            double hu = patternValue(i, 7, k) - 24;
            if (k + 1 == instance) {
              hu = (patternValue(i, 7, k - 1) + patternValue(i, 7, k + 1)) / 2.0 - 24;
            }
            ASSERT_NEAR(volume.at(i, 7, k - first), hu, k + 1 == instance ? 0.5 : 0.0);
          }
        }
      }
    }
  }
}

TEST_F(TrapSyntaxes, ACodestreamThatIsCutInsideAWholeFileIsAMissingSlice) {
  for (const E_TransferSyntax syntax : kCompressed) {
    for (const bool zeros : {false, true}) {
      SCOPED_TRACE(nameOf({syntax}, kForms[1]) + (zeros ? ", zeros behind" : ", shorter"));
      fs::remove_all(folder());
      addStack(kForms[1], {syntax}, 7);
      Image slice = image(kForms[1]);
      slice.position_mm.z = 102.0;
      slice.instance = 3;
      fillPattern(slice, 2);
      DcmDataset data = makeImage(slice);
      auto codestreams = encodeFrames(data, {syntax});
      Bytes& bytes = codestreams.front();
      const std::size_t whole = bytes.size();
      bytes.resize(whole / 4 * 2);
      if (zeros) bytes.resize(whole, 0);
      saveEncapsulated(data, codestreams, {syntax}, fileOf(3));
      const Error error = refusal();
      EXPECT_EQ(error.code.str(), "MISSING_SLICES") << error.sentence();
      if (error.code.str() != "MISSING_SLICES") continue;
      EXPECT_EQ(find(report_.series.front(), "MISSING_SLICES")->slices,
                std::vector<std::string>{"102.00 mm"});
      const Volume part = import({{code::kMissingSlices, "part"}});
      EXPECT_EQ(part.geometry.size[2], 4);
    }
  }
}

TEST_F(TrapSyntaxes, OneDamagedFrameOfACompressedFileIsOneMissingSlice) {
  const auto at = [](double z) { return Vec3(-20.0, 10.5, z); };
  for (const E_TransferSyntax syntax : kCompressed) {
    SCOPED_TRACE(DcmXfer(syntax).getXferName());
    fs::remove_all(folder());
    Image frames = image(kForms[1]);
    frames.frames = 5;
    fillPattern(frames, 0);
    DcmDataset data = makeEnhanced(frames, {at(100), at(101), at(102), at(103), at(104)});
    auto codestreams = encodeFrames(data, {syntax});
    std::fill(codestreams[1].begin() + 64, codestreams[1].end(), 0);
    saveEncapsulated(data, codestreams, {syntax}, folder() / "x");
    EXPECT_EQ(refusal().code.str(), "MISSING_SLICES");
    EXPECT_EQ(find(report_.series.front(), "MISSING_SLICES")->slices,
              std::vector<std::string>{"101.00 mm"});
  }
}

class TrapLossy : public TrapSyntaxes {
 protected:
  // A smooth picture over the whole range, which DCMTK's lossy encoders do not stretch.
  static int smooth(int i, int j, int k, int most) {
    const double x = i / 31.0, y = j / 31.0;
    const double wave = 0.5 - 0.5 * std::cos(3.14159265 * x) * std::cos(3.14159265 * y);
    return int(std::lround(most * std::clamp(wave + 0.0 * k, 0.0, 1.0)));
  }

  void addSmooth(const Form& form, const Packing& packing, int missing = -1) {
    for (int k = 0; k < 5; ++k) {
      if (k == missing) continue;
      Image slice = image(form, 32, 32);
      slice.position_mm.z = 100.0 + k;
      slice.instance = k + 1;
      const int low = form.is_signed ? -(1 << (form.stored - 1)) : 0;
      for (int j = 0; j < 32; ++j) {
        for (int i = 0; i < 32; ++i) {
          slice.stored.push_back(low + smooth(i, j, k, (1 << form.stored) - 1));
        }
      }
      add(makeImage(slice), packing);
    }
  }

  void expectLossy(const Form& form, const Packing& packing, int most) {
    SCOPED_TRACE(nameOf(packing, form));
    fs::remove_all(folder());
    addSmooth(form, packing);
    expectRefused("LOSSY_SOURCE");
    EXPECT_TRUE(report_.series.front().lossy);
    EXPECT_EQ(refusal({{code::kLossySource, "refuse"}}).code.str(), "LOSSY_SOURCE");
    const Volume volume = import({{code::kLossySource, "accept"}});
    ASSERT_EQ(volume.geometry.size, (Index3{32, 32, 5}));
    EXPECT_EQ(chosen().verdict, Verdict::repaired);
    EXPECT_TRUE(chosen().lossy);
    EXPECT_TRUE(report_.provenance->lossy);
    const int low = (form.is_signed ? -(1 << (form.stored - 1)) : 0) - 24;
    for (int k = 0; k < 5; ++k) {
      for (int j = 0; j < 32; ++j) {
        for (int i = 0; i < 32; ++i) {
          ASSERT_NEAR(volume.at(i, j, k), low + smooth(i, j, k, (1 << form.stored) - 1), most)
              << i << " " << j << " " << k;
        }
      }
    }
  }
};

TEST_F(TrapLossy, LossIsRefusedUntilItIsAccepted) {
  Packing near_lossless{EXS_JPEGLSLossy};
  near_lossless.near_by = 3;
  Packing wavelet{EXS_JPEG2000};
  wavelet.irreversible = true;
  expectLossy({8, 8, false}, {EXS_JPEGProcess1}, 3);
  expectLossy({16, 12, false}, {EXS_JPEGProcess2_4}, 12);
  expectLossy({16, 12, false}, near_lossless, 3);
  expectLossy({16, 12, false}, wavelet, 8);
  expectLossy({16, 12, true}, wavelet, 8);
}

TEST_F(TrapLossy, ACodestreamWithLossUnderALosslessNameIsToldByItself) {
  const auto expectTold = [&](Packing packing, const Form& form, E_TransferSyntax called) {
    SCOPED_TRACE(nameOf(packing, form));
    packing.called = called;
    fs::remove_all(folder());
    addSmooth(form, packing);
    const SeriesReport series = scan().report().series.front();
    EXPECT_EQ(series.verdict, Verdict::refused);
    EXPECT_TRUE(series.lossy);
  };
  Packing wavelet{EXS_JPEG2000};
  wavelet.irreversible = true;
  Packing near_lossless{EXS_JPEGLSLossy};
  near_lossless.near_by = 3;
  expectTold(wavelet, {16, 12, false}, EXS_JPEG2000LosslessOnly);
  expectTold(near_lossless, {16, 12, false}, EXS_JPEGLSLossless);
  expectTold({EXS_JPEGProcess1}, {8, 8, false}, EXS_JPEGProcess14SV1);
  expectTold({EXS_JPEGProcess2_4}, {16, 12, false}, EXS_JPEGProcess14);
}

TEST_F(TrapLossy, LossAndAMissingSliceAreAskedForBoth) {
  Packing near_lossless{EXS_JPEGLSLossy};
  near_lossless.near_by = 3;
  addSmooth({16, 12, false}, near_lossless, 2);
  EXPECT_FALSE(refusal({{code::kLossySource, "accept"}}).code.empty());
  EXPECT_EQ(refusal({{code::kLossySource, "accept"}}).code.str(), "MISSING_SLICES");
  EXPECT_EQ(refusal({{code::kMissingSlices, "fill"}}).code.str(), "LOSSY_SOURCE");
  const Volume volume = import({{code::kLossySource, "accept"}, {code::kMissingSlices, "fill"}});
  ASSERT_EQ(volume.geometry.size[2], 5);
  for (int i = 0; i < 32; ++i) {
    ASSERT_NEAR(volume.at(i, 5, 2), smooth(i, 5, 2, 4095) - 24, 4);
  }
  EXPECT_EQ(report_.provenance->answers,
            (Answers{{code::kLossySource, "accept"}, {code::kMissingSlices, "fill"}}));
}

TEST_F(TrapLossy, AnOldLossIsRememberedByItsAttribute) {
  addStack(kForms[1], {EXS_LittleEndianExplicit}, 4);
  editAll([](DcmDataset& data) { put(data, DCM_LossyImageCompression, "01"); });
  expectRefused("LOSSY_SOURCE");
  expectStack(import({{code::kLossySource, "accept"}}), kForms[1], 4);
}

}  // namespace trephine::test
