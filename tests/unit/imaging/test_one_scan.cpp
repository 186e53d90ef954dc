// Slices become one volume without a question only where everything says that they are one scan of
// one patient.
#include "imaging/codes.h"
#include "series_fixture.h"

namespace trephine::test {

namespace fs = std::filesystem;

class OneScan : public SeriesFixture {
 protected:
  // As many slices as make a volume.
  static constexpr int kSlices = 6;

  void SetUp() override { write(rampVolume()); }
  void anew(Index3 size = {7, 5, kSlices}) {
    fs::remove_all(folder());
    write(rampVolume(size));
  }
  void editSome(const std::vector<int>& slices, const Change& change) {
    for (int n : slices) edit(slice(n), change);
  }
  static Change set(const DcmTagKey& tag, const std::string& value) {
    return [=](DcmDataset& data) { put(data, tag, value); };
  }
  const SeriesReport& only() {
    scanned_ = scan().report();
    EXPECT_EQ(scanned_.series.size(), 1u);
    return scanned_.series.front();
  }
  static std::vector<std::string> optionsOf(const SeriesReport& series, const char* code) {
    for (const Choice& choice : series.choices) {
      if (choice.code.str() == code) return choice.options;
    }
    return {};
  }
  void expectAsked(const char* code, const char* answer) {
    expectRefused(code);
    import({{ Code::named(code), answer }});
    EXPECT_EQ(chosen().verdict, Verdict::repaired);
    EXPECT_NE(find(chosen(), code), nullptr);
  }

  ImportReport scanned_;
};

TEST_F(OneScan, OfEqualHeadersPasses) {
  EXPECT_EQ(only().verdict, Verdict::pass) << codes(only());
}

TEST_F(OneScan, IsOfOnePatient) {
  for (const auto& [tag, value] :
       {std::pair(DCM_PatientID, "4711"), std::pair(DCM_PatientName, "MUSTERMANN^ERIKA"),
        std::pair(DCM_PatientBirthDate, "19700101")}) {
    anew({7, 5, 10});
    editAll(set(DCM_PatientBirthDate, "19800202"));
    if (tag == DCM_PatientName) editAll(set(DCM_PatientID, ""));
    editSome({6, 7, 8, 9, 10}, set(tag, value));
    const CtFolder folder = scan();
    ASSERT_EQ(folder.report().series.size(), 2u) << value;
    for (const SeriesReport& part : folder.report().series) {
      EXPECT_EQ(part.slices, 5);
      EXPECT_EQ(part.verdict, Verdict::repaired) << codes(part);
      EXPECT_TRUE(optionsOf(part, "PARTS").empty()) << "two patients are never joined";
      const Finding* split = find(part, "SERIES_SPLIT");
      ASSERT_NE(split, nullptr);
      EXPECT_NE(split->text.find("5 of its 10 images"), std::string::npos) << split->text;
      EXPECT_NE(split->text.find("patient"), std::string::npos) << split->text;
    }
    const std::string json = toJson(folder.report()).dump();
    EXPECT_EQ(json.find(value), std::string::npos);
  }
}

TEST_F(OneScan, IsOfOnePatientHoweverTheNameIsWritten) {
  for (const auto& [charset, name] :
       {std::pair("ISO_IR 192", "doe^jane"), std::pair("ISO_IR 192", " Doe ^ Jane"),
        std::pair("ISO_IR 192", "DOE^JANE=\xE5\xB1\xB1"), std::pair("ISO_IR 100", "DOE^JANE")}) {
    anew();
    editAll([](DcmDataset& data) { put(data, DCM_PatientName, "DOE^JANE"); });
    editSome({2, 4}, [&](DcmDataset& data) {
      put(data, DCM_SpecificCharacterSet, charset);
      put(data, DCM_PatientName, name);
    });
    EXPECT_EQ(only().verdict, Verdict::pass) << name << ": " << codes(only());
  }
  anew();
  editAll([](DcmDataset& data) {
    put(data, DCM_SpecificCharacterSet, "ISO_IR 192");
    put(data, DCM_PatientName, "M\xC3\xBCLLER");
  });
  editSome({3}, [](DcmDataset& data) {
    put(data, DCM_SpecificCharacterSet, "ISO_IR 100");
    put(data, DCM_PatientName, "M\xFCLLER");
  });
  EXPECT_EQ(only().verdict, Verdict::pass) << codes(only());
}

TEST_F(OneScan, IsOfOnePatientByIdAndBirthDateThoughTheNameHasChanged) {
  editAll([](DcmDataset& data) {
    put(data, DCM_PatientID, "4711");
    put(data, DCM_PatientBirthDate, "19700101");
    put(data, DCM_PatientName, "MUELLER^EVA");
  });
  editSome({2, 4}, set(DCM_PatientName, "MEIER^EVA"));
  EXPECT_EQ(only().verdict, Verdict::pass) << codes(only());
  EXPECT_NE(find(only(), "NAMES_DIFFER"), nullptr) << codes(only());
  editSome({2, 4}, set(DCM_PatientBirthDate, "19700102"));
  EXPECT_EQ(scan().report().series.size(), 2u);
}

TEST_F(OneScan, BesideAnotherPatientsOrAnotherDaysSaysOfWhichItIs) {
  const auto numbers = [&](const char* code) {
    std::string all;
    const CtFolder folder = scan();
    for (const SeriesReport& one : folder.report().series) {
      const Finding* finding = find(one, code);
      all += finding ? finding->text.substr(finding->text.find(" CT of")) + "; " : "none; ";
    }
    return all;
  };
  anew({7, 5, 10});
  editAll(set(DCM_PatientID, "4711"));
  editAll(set(DCM_AcquisitionDate, "20240102"));
  editSome({6, 7, 8, 9, 10}, set(DCM_SeriesInstanceUID, "1.2.3.4.99"));
  EXPECT_EQ(numbers("PATIENTS"), "none; none; ");
  EXPECT_EQ(numbers("DAYS"), "none; none; ");
  editSome({6, 7, 8, 9, 10}, set(DCM_AcquisitionDate, "20240103"));
  EXPECT_NE(numbers("DAYS").find("2 days: this one is of number 1"), std::string::npos)
      << numbers("DAYS");
  EXPECT_NE(numbers("DAYS").find("2 days: this one is of number 2"), std::string::npos);
  editSome({6, 7, 8, 9, 10}, set(DCM_PatientID, "4712"));
  EXPECT_EQ(numbers("DAYS"), "none; none; ");
  EXPECT_NE(numbers("PATIENTS").find("2 patients: this one is of number 1"), std::string::npos);
  EXPECT_NE(numbers("PATIENTS").find("2 patients: this one is of number 2"), std::string::npos);
}

TEST_F(OneScan, IsOfOnePatientThoughSomeSlicesSayLessOfHim) {
  editAll([](DcmDataset& data) { put(data, DCM_PatientBirthDate, "19700101"); });
  editSome({1, 2}, set(DCM_PatientBirthDate, ""));
  editSome({3, 4}, set(DCM_PatientID, ""));
  EXPECT_EQ(only().verdict, Verdict::pass) << codes(only());
  editSome({5}, [](DcmDataset& data) {
    for (const auto& tag : {DCM_PatientID, DCM_PatientName, DCM_PatientBirthDate})
      put(data, tag, "");
  });
  EXPECT_EQ(scan().report().series.size(), 2u) << "nothing in common is another patient";
}

TEST_F(OneScan, IsMadeByOneScannerOfAPatientWhoLiesInOneWay) {
  for (const auto& [tag, value, words] :
       {std::tuple(DCM_Manufacturer, "Another", "scanner"),
        std::tuple(DCM_PatientPosition, "FFS", "position of the patient (FFS in 3 and HFS in 3)"),
        std::tuple(DCM_ContrastBolusAgent, "Iodine", "contrast agent")}) {
    anew();
    editAll([](DcmDataset& data) {
      put(data, DCM_Manufacturer, "One");
      put(data, DCM_PatientPosition, "HFS");
      put(data, DCM_ContrastBolusAgent, "none");
    });
    editSome({1, 2, 3}, set(tag, value));
    expectAsked("MIXED_SLICES", "accept");
    const Finding* finding = find(chosen(), "MIXED_SLICES");
    EXPECT_NE(finding->text.find(words), std::string::npos) << finding->text;
    EXPECT_EQ(finding->slices.size(), 3u) << "those that differ are named";
  }
}

TEST_F(OneScan, MayCallItselfWhatItsMakerLikesFromTheFourthTypeOn) {
  editAll(set(DCM_ImageType, "ORIGINAL\\PRIMARY\\AXIAL\\CT_SOM5 SPI"));
  editSome({1, 2}, set(DCM_ImageType, "ORIGINAL\\PRIMARY\\AXIAL\\CT_SOM5 SEQ"));
  EXPECT_EQ(only().verdict, Verdict::pass) << codes(only());
}

TEST_F(OneScan, SaysWhereSomeSlicesAreSilentAboutTheirKernel) {
  editSome({1, 2}, set(DCM_ConvolutionKernel, "B30f"));
  EXPECT_EQ(only().verdict, Verdict::pass);
  ASSERT_NE(find(only(), "PARTLY_SAID"), nullptr);
  EXPECT_NE(find(only(), "PARTLY_SAID")->text.find("convolution kernel in 4"), std::string::npos);
}

TEST_F(OneScan, NamesNobodyInItsTypeOrKernel) {
  editAll(set(DCM_ConvolutionKernel, "B30f"));
  editSome({1}, set(DCM_ConvolutionKernel, "MEIER^ANNA"));
  editSome({2}, set(DCM_ConvolutionKernel, std::string(10000, 'x')));
  editSome({3}, set(DCM_Modality, "MEIER^ANNA"));
  EXPECT_EQ(toJson(scan().report()).dump().find("MEIER"), std::string::npos);
  EXPECT_LT(toJson(scan().report()).dump().size(), 10000u);
}

TEST_F(OneScan, IsOfOneModality) {
  anew({7, 5, 10});
  editSome({6, 7, 8, 9, 10}, set(DCM_Modality, "PT"));
  const ImportReport report = scan().report();
  ASSERT_EQ(report.series.size(), 2u);
  for (const SeriesReport& part : report.series) {
    EXPECT_EQ(part.slices, 5);
    EXPECT_NE(part.verdict, Verdict::pass);
  }
}

TEST_F(OneScan, IsOfOnePatientHoweverTheNameEnds) {
  editSome({1, 2}, set(DCM_PatientName, "TREPHINE^PHANTOM^^^"));
  EXPECT_EQ(only().verdict, Verdict::pass) << codes(only());
}

TEST_F(OneScan, IsMadeInOneWay) {
  for (const auto& [tag, value, words] :
       {std::tuple(DCM_ConvolutionKernel, "B70f", "convolution kernel"),
        std::tuple(DCM_KVP, "80", "tube voltage (80.00 to 120.00 kV)"),
        std::tuple(DCM_SliceThickness, "3", "slice thickness"),
        std::tuple(DCM_ImageType, "DERIVED\\SECONDARY\\AXIAL", "image type"),
        std::tuple(DCM_SeriesDescription, "Mueller", "series description")}) {
    anew();
    editAll([](DcmDataset& data) {
      put(data, DCM_ConvolutionKernel, "B30f");
      put(data, DCM_KVP, "120");
      put(data, DCM_ImageType, "ORIGINAL\\PRIMARY\\AXIAL");
    });
    EXPECT_EQ(only().verdict, Verdict::pass) << codes(only());
    editSome({4, 5, 6}, set(tag, value));
    expectAsked("MIXED_SLICES", "accept");
    const std::string text = find(chosen(), "MIXED_SLICES")->text;
    EXPECT_NE(text.find(words), std::string::npos) << text;
    EXPECT_EQ(text.find("Mueller"), std::string::npos) << "a description may be a name";
  }
}

TEST_F(OneScan, MayLackWhatSomeOfItsSlicesSay) {
  editSome({2, 3}, [](DcmDataset& data) {
    put(data, DCM_SliceThickness, "0");
    put(data, DCM_ConvolutionKernel, "B30f");
    put(data, DCM_KVP, "120");
  });
  EXPECT_EQ(only().verdict, Verdict::pass) << codes(only());
}

TEST_F(OneScan, OfTwoKernelsIsTwoAndTheyAreToldApartByThem) {
  editAll([](DcmDataset& data) {
    put(data, DCM_ConvolutionKernel, "B30f");
    put(data, DCM_AcquisitionTime, "101500");
  });
  for (int n = 1; n <= kSlices; ++n) {
    again(n, [&](DcmDataset& data) {
      put(data, DCM_ConvolutionKernel, "B70f");
      put(data, DCM_RescaleIntercept, "-1000");
      // Saved one after the other: times would mix the two.
      put(data, DCM_ContentTime, std::to_string(101500 + n));
    });
  }
  const Finding finding = expectRefused("PHASES");
  EXPECT_NE(finding.text.find("told apart by convolution kernel"), std::string::npos)
      << finding.text;
  const Choice& choice = report_.series.front().choices.front();
  ASSERT_EQ(choice.words.size(), 3u);
  EXPECT_NE(choice.words[1].find("kernel B30f, 10:15:00, 6 slices"), std::string::npos)
      << choice.words[1];
  EXPECT_NE(choice.words[2].find("kernel B70f"), std::string::npos);
  ASSERT_EQ(choice.on_screen.size(), 3u);
  EXPECT_EQ(choice.on_screen[1], "Test series");
  EXPECT_GE(choice.shown[1], 0);
  EXPECT_NE(choice.shown[1], choice.shown[2]);
  const Volume soft = import({{code::kPhases, "1"}});
  EXPECT_EQ(soft.hu, rampVolume().hu);
  EXPECT_EQ(find(chosen(), "MIXED_SLICES"), nullptr);
}

TEST_F(OneScan, ThatNothingTellsFromAnotherOffersNoChoice) {
  for (int n = 1; n <= kSlices; ++n) {
    again(n, [&](DcmDataset& data) {
      put(data, DCM_RescaleIntercept, "-1000");
      data.findAndDeleteElement(DCM_InstanceNumber);
    });
    edit(slice(n), [](DcmDataset& data) { data.findAndDeleteElement(DCM_InstanceNumber); });
  }
  expectRefused("DUPLICATE_POSITIONS");
  EXPECT_TRUE(report_.series.front().choices.empty());
}

// As public archives have them.
TEST_F(OneScan, WhoseSlicesEachNameAFrameOfReferenceOrStudyIsJoinedOnConsent) {
  for (const DcmTagKey& tag : {DCM_FrameOfReferenceUID, DCM_StudyInstanceUID}) {
    anew();
    for (int n = 1; n <= kSlices; ++n) edit(slice(n), set(tag, "1.2.3.99." + std::to_string(n)));
    expectRefused("PARTS");
    ASSERT_EQ(report_.series.size(), 1u);
    EXPECT_EQ(optionsOf(report_.series.front(), "PARTS"),
              (std::vector<std::string>{"refuse", "join"}));
    EXPECT_EQ(import({{code::kParts, "join"}}).hu, rampVolume().hu);
    EXPECT_EQ(chosen().verdict, Verdict::repaired);
    EXPECT_NE(find(chosen(), "PARTS")->action.find("assumed"), std::string::npos);
  }
}

TEST_F(OneScan, WhoseEverySecondSliceHasAnotherSpacingIsJoinedOnConsent) {
  editSome({2, 4, 6}, set(DCM_PixelSpacing, "0.7503\\0.5003"));
  expectRefused("PARTS");
  const Volume joined = import({{code::kParts, "join"}});
  EXPECT_EQ(joined.hu, rampVolume().hu);
  EXPECT_NEAR(joined.geometry.spacing_mm.x, 0.50015, 1e-9);
}

TEST_F(OneScan, WhoseOrientationIsNoisyIsJoinedOnConsent) {
  for (int n = 1; n <= kSlices; ++n) {
    const double off = (n % 3 - 1) * 1e-3;
    edit(slice(n), [&](DcmDataset& data) {
      put(data, DCM_ImageOrientationPatient,
          "1\\" + decimalText(off) + "\\0\\" + decimalText(-off) + "\\1\\0");
    });
  }
  expectRefused("PARTS");
  EXPECT_EQ(import({{code::kParts, "join"}}).hu, rampVolume().hu);
}

TEST_F(OneScan, CanBeAPartAndWhatWasLeftOutIsSaid) {
  anew({7, 5, 10});
  editSome({1, 2, 3, 4}, set(DCM_FrameOfReferenceUID, "1.2.3.99"));
  expectRefused("PARTS");
  EXPECT_EQ(optionsOf(report_.series.front(), "PARTS"),
            (std::vector<std::string>{"refuse", "join", "1", "2"}));
  const Volume part = import({{code::kParts, "1"}});
  EXPECT_EQ(part.geometry.size, (Index3{7, 5, 6}));
  EXPECT_DOUBLE_EQ(part.geometry.origin_mm.z, 105.0);
  EXPECT_EQ(chosen().verdict, Verdict::repaired);
  EXPECT_NE(find(chosen(), "PARTS")->action.find("6 of 10 slices; the others were left out"),
            std::string::npos)
      << find(chosen(), "PARTS")->action;
}

// A patient who was laid down anew and scanned again under one number.
TEST_F(OneScan, WhosePartHasAGapSaysSoOnceThePartIsChosen) {
  anew({7, 5, 10});
  editSome({4, 5}, set(DCM_FrameOfReferenceUID, "1.2.3.99"));
  CtFolder ct = scan();
  const Answers part{{code::kParts, "1"}};
  const auto best = ct.bestSeries(part);
  ASSERT_TRUE(best);
  ImportRequest request;
  request.answers = part;
  const auto read = ct.read(*best, request, Progress());
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code.str(), "MISSING_SLICES") << read.error().sentence();
  EXPECT_FALSE(optionsOf(ct.report().series.front(), "MISSING_SLICES").empty());
}

TEST_F(OneScan, IsNotJoinedWithAnotherAtTheSamePlaces) {
  for (int n = 1; n <= kSlices; ++n) {
    again(n, [&](DcmDataset& data) {
      put(data, DCM_FrameOfReferenceUID, "1.2.3.99");
      put(data, DCM_RescaleIntercept, "-1000");
    });
  }
  expectRefused("PARTS");
  EXPECT_EQ(optionsOf(report_.series.front(), "PARTS"),
            (std::vector<std::string>{"refuse", "1", "2"}));
  EXPECT_EQ(import({{code::kParts, "1"}}).geometry.size[2], kSlices);
}

class Contradiction : public OneScan {
 protected:
  void locate(const std::function<double(int)>& location_mm) {
    for (int n = 1; n <= kSlices; ++n) {
      edit(slice(n), set(DCM_SliceLocation, decimalText(location_mm(n))));
    }
  }
};

TEST_F(Contradiction, OfSliceLocationsIsAsked) {
  locate([](int n) { return -1.25 * n; });
  EXPECT_EQ(only().verdict, Verdict::pass) << "another zero and sense are none";
  locate([](int n) { return std::round(12.5 * n) / 10.0; });
  EXPECT_EQ(only().verdict, Verdict::pass) << "nor is rounding to 0.1 mm";
  locate([](int n) { return 1.25 * (n + (n > 3 ? 2 : 0)); });
  expectAsked("LOCATION_MISMATCH", "positions");
  const std::string text = find(chosen(), "LOCATION_MISMATCH")->text;
  EXPECT_NE(text.find("1.25 mm by position and 3.75 mm by slice location"), std::string::npos)
      << text;
}

TEST_F(Contradiction, OfSliceLocationsIsFoundThoughEverySecondLacksOne) {
  locate([](int n) { return 4.0 * n; });
  editSome({2, 4, 6}, set(DCM_SliceLocation, ""));
  expectRefused("LOCATION_MISMATCH");
}

TEST_F(Contradiction, OfSliceLocationsIsNoneWhereTheyAreACoordinateOrSayNothing) {
  locate([](int) { return 0.0; });
  EXPECT_EQ(only().verdict, Verdict::pass) << codes(only());
  locate([](int n) { return std::round(1.25 * n); });
  EXPECT_EQ(only().verdict, Verdict::pass) << "whole millimetres: " << codes(only());
  // Straight slices at 40 degrees, located by their z.
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (int n = 1; n <= kSlices; ++n) {
    edit(slice(n), [&](DcmDataset& data) {
      put(data, DCM_ImageOrientationPatient,
          "1\\0\\0\\0\\" + decimalText(c) + "\\" + decimalText(s));
      put(data, DCM_ImagePositionPatient, positionText(Vec3(0.0, -s, c) * (3.0 * n)));
      put(data, DCM_SliceLocation, decimalText(3.0 * n * c));
    });
  }
  EXPECT_EQ(find(only(), "LOCATION_MISMATCH"), nullptr) << codes(only());
}

TEST_F(Contradiction, OfTheSpacingBetweenSlicesCountsInOneOfThem) {
  editAll(set(DCM_SpacingBetweenSlices, "1.25"));
  editSome({2}, set(DCM_SpacingBetweenSlices, "5"));
  EXPECT_NE(find(only(), "SPACING_MISMATCH"), nullptr) << codes(only());
}

TEST_F(Contradiction, OfTheSpacingBetweenSlicesIsARepair) {
  editAll(set(DCM_SpacingBetweenSlices, "1.25"));
  EXPECT_EQ(only().verdict, Verdict::pass);
  editAll(set(DCM_SpacingBetweenSlices, "2.5"));
  EXPECT_EQ(only().verdict, Verdict::repaired);
  EXPECT_NE(find(only(), "SPACING_MISMATCH"), nullptr);
}

TEST_F(Contradiction, OfTheTiltIsARepairAndNoTiltIsNone) {
  editAll(set(DCM_GantryDetectorTilt, "0"));
  EXPECT_EQ(only().verdict, Verdict::pass);
  editAll(set(DCM_GantryDetectorTilt, "-15"));
  EXPECT_EQ(only().verdict, Verdict::repaired);
  EXPECT_NE(find(only(), "TILT_MISMATCH"), nullptr);
}

TEST_F(Contradiction, OfThicknessAndStepIsANoticeUntilMostWasNotScanned) {
  for (const char* thickness : {"", "0", "1.25", "5"}) {
    editAll(set(DCM_SliceThickness, thickness));
    EXPECT_EQ(only().verdict, Verdict::pass) << thickness;
    EXPECT_EQ(find(only(), "GAPS_BETWEEN_SLICES"), nullptr) << thickness;
  }
  editAll(set(DCM_SliceThickness, "0.5"));
  EXPECT_EQ(only().verdict, Verdict::pass);
  EXPECT_NE(find(only(), "GAPS_BETWEEN_SLICES"), nullptr);
  editAll(set(DCM_SliceThickness, "0.25"));
  expectAsked("SPARSE_SLICES", "accept");
}

TEST_F(Contradiction, OfAVolumeAndThreeSlicesOrStepsOf25Millimetres) {
  fs::remove_all(folder());
  write(rampVolume({7, 5, 3}));
  expectAsked("SPARSE_SLICES", "accept");
  write(rampVolume({7, 5, 4}));
  EXPECT_EQ(only().verdict, Verdict::pass) << codes(only());
  for (int n = 1; n <= 4; ++n) fs::resize_file(slice(n), fs::file_size(slice(n)) - 8);
  expectRefused("MISSING_SLICES");
  EXPECT_EQ(find(report_.series.front(), "SPARSE_SLICES"), nullptr) << "none can be read at all";
  fs::remove_all(folder());
  Volume volume = rampVolume();
  volume.geometry.spacing_mm.z = 25.0;
  write(volume);
  expectAsked("SPARSE_SLICES", "accept");
}

class Rounded : public OneScan {
 protected:
  // Slices every `step_mm`, written down to the nearest `grid_mm`.
  void place(int count, double step_mm, double grid_mm, const std::vector<int>& without = {}) {
    fs::remove_all(folder());
    Volume volume = rampVolume({7, 5, count});
    write(volume);
    for (int n = 1; n <= count; ++n) {
      const double z = std::round((100.0 + step_mm * (n - 1)) / grid_mm) * grid_mm;
      edit(slice(n), [&](DcmDataset& data) {
        put(data, DCM_ImagePositionPatient, "-20\\10\\" + decimalText(z));
        put(data, DCM_SliceThickness, decimalText(step_mm));
      });
    }
    for (int n : without) fs::remove(slice(n));
  }
};

TEST_F(Rounded, PositionsArePutBackOnTheirLine) {
  for (const auto& [step_mm, grid_mm] :
       {std::pair(0.625, 0.1), std::pair(0.75, 0.1), std::pair(1.25, 1.0), std::pair(1.5, 1.0)}) {
    place(40, step_mm, grid_mm);
    const Volume volume = import();
    EXPECT_EQ(volume.hu, rampVolume({7, 5, 40}).hu) << step_mm << ": nothing is interpolated";
    EXPECT_NEAR(volume.geometry.spacing_mm.z, step_mm, 0.01 * step_mm);
    EXPECT_EQ(chosen().verdict, Verdict::repaired);
    EXPECT_NE(find(chosen(), "ROUNDED_POSITIONS"), nullptr) << codes(chosen());
  }
}

// From half a millimetre on every second one is rounded by as much as can be.
TEST_F(Rounded, PositionsArePutOnTheLineOfAKnownStepWhereverItBegins) {
  for (const double step_mm : {1.25, 1.5, 1.75}) {
    for (const double begin_mm : {50.0, -30.5, -30.25}) {
      fs::remove_all(folder());
      write(rampVolume({7, 5, 40}));
      for (int n = 1; n <= 40; ++n) {
        const double z = std::nearbyint(begin_mm + step_mm * (n - 1));  // halves to even
        edit(slice(n), [&](DcmDataset& data) {
          put(data, DCM_ImagePositionPatient, positionText(Vec3(-115.5, -1.85, z)));
          put(data, DCM_SpacingBetweenSlices, decimalText(step_mm));
          put(data, DCM_SliceThickness, decimalText(step_mm));
          put(data, DCM_SliceLocation, decimalText(begin_mm + step_mm * (n - 1)));
        });
      }
      const Volume volume = import();
      EXPECT_EQ(volume.geometry.size[2], 40) << step_mm << " from " << begin_mm;
      EXPECT_NEAR(volume.geometry.spacing_mm.z, step_mm, 1e-9);
      EXPECT_NE(find(chosen(), "ROUNDED_POSITIONS"), nullptr) << codes(chosen());
      EXPECT_EQ(find(chosen(), "LOCATION_MISMATCH"), nullptr);
      EXPECT_EQ(find(chosen(), "SPACING_MISMATCH"), nullptr);
      if (begin_mm != 50.0) continue;
      fs::remove(slice(20));
      EXPECT_NE(expectRefused("MISSING_SLICES").text.find("1 slice is missing"), std::string::npos);
    }
  }
}

TEST_F(Rounded, PositionsThatFellTogetherAreTakenApartByAStepThatIsKnown) {
  for (const double step_mm : {0.625, 0.4, 0.9}) {
    for (const bool by_location : {false, true}) {
      fs::remove_all(folder());
      write(rampVolume({7, 5, 40}));
      for (int n = 1; n <= 40; ++n) {
        edit(slice(n), [&](DcmDataset& data) {
          const double z = 100.0 + step_mm * (n - 1);
          put(data, DCM_ImagePositionPatient, positionText(Vec3(-20.0, 10.5, std::round(z))));
          put(data, DCM_SpacingBetweenSlices, by_location ? "" : decimalText(step_mm));
          put(data, DCM_SliceLocation, by_location ? decimalText(-z) : "");
          put(data, DCM_SliceThickness, decimalText(step_mm));
        });
      }
      EXPECT_EQ(import().hu, rampVolume({7, 5, 40}).hu) << step_mm;
      EXPECT_NEAR(chosen().geometry.spacing_mm.z, step_mm, 1e-9);
      EXPECT_EQ(codes(chosen()), "ROUNDED_POSITIONS ") << step_mm << " " << by_location;
    }
  }
}

TEST_F(Rounded, PositionsWithASliceMissingHaveAGapThere) {
  for (const auto& [step_mm, grid_mm] : {std::pair(0.625, 0.1), std::pair(1.25, 1.0)}) {
    place(40, step_mm, grid_mm, {20});
    const Finding finding = expectRefused("MISSING_SLICES");
    EXPECT_NE(finding.text.find("1 slice is missing"), std::string::npos) << finding.text;
    ASSERT_EQ(finding.slices.size(), 1u);
    EXPECT_NEAR(std::stod(finding.slices.front()), 100.0 + 19 * step_mm, 0.5 * grid_mm);
  }
}

// Five places 0, 1, 2, 4, 5 mm: one slice in six missing, or 1.25 mm rounded. The step that the
// header states tells; a thickness of 1.25 mm leaves both, and 40 slices of them one alone.
TEST_F(Rounded, PositionsOrAGapIsToldByTheStepThatTheHeaderStates) {
  place(6, 1.0, 1.0, {4});
  expectRefused("MISSING_SLICES");
  EXPECT_EQ(find(report_.series.front(), "ROUNDED_POSITIONS"), nullptr);
  place(5, 1.25, 1.0);
  expectAsked("MISSING_SLICES", "line");
  EXPECT_NEAR(chosen().geometry.spacing_mm.z, 1.25, 1e-9);
  place(5, 1.25, 1.0);
  for (int n = 1; n <= 5; ++n) edit(slice(n), set(DCM_SpacingBetweenSlices, "1.25"));
  import();
  EXPECT_NE(find(chosen(), "ROUNDED_POSITIONS"), nullptr) << codes(chosen());
}

TEST_F(Rounded, PositionsThatNoLineExplainsStayUneven) {
  fs::remove_all(folder());
  write(rampVolume({7, 5, 12}));
  for (int n = 1; n <= 12; ++n) {
    const int z = 100 + 4 * n + (n % 2 ? 0 : 1) + (n > 6 ? 2 : 0);
    edit(slice(n), set(DCM_ImagePositionPatient, "-20\\10\\" + std::to_string(z)));
  }
  expectRefused("UNEVEN_SPACING");
}

}  // namespace trephine::test
