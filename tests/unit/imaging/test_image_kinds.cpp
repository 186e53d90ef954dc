// What the standard's attributes say of an image: only what was scanned in HU passes unasked.
#include "series_fixture.h"

namespace trephine::test {

namespace fs = std::filesystem;

class ImageKinds : public SeriesFixture {
 protected:
  void SetUp() override { write(rampVolume()); }
  void anew() {
    fs::remove_all(folder());
    write(rampVolume());
  }
  void setAll(const DcmTagKey& tag, const std::string& value) {
    editAll([&](DcmDataset& data) { put(data, tag, value); });
  }
  // Enhanced: six frames, with what stands in the frame type of all.
  void enhanced(const Change& frame_type) {
    fs::remove_all(folder());
    Image image;
    image.frames = 6;
    fillPattern(image, 0);
    std::vector<Vec3> places_mm;
    for (int k = 0; k < 6; ++k) places_mm.push_back(Vec3(0.0, 0.0, 100.0 + k));
    DcmDataset data = makeEnhanced(image, places_mm);
    put(data, DCM_ImageType, "ORIGINAL\\PRIMARY\\VOLUME\\NONE");
    DcmItem& item = functionalGroup(data, DCM_CTImageFrameTypeSequence, -1);
    DcmDataset values;
    frame_type(values);
    for (unsigned long n = 0; n < values.card(); ++n) {
      item.insert(static_cast<DcmElement*>(values.getElement(n)->clone()), OFTrue);
    }
    add(data);
  }
  // The one series, as the scan has it.
  SeriesReport only() {
    const CtFolder ct = scan();
    EXPECT_EQ(ct.report().series.size(), 1u);
    return ct.report().series.front();
  }
  // Refused unasked; the finding that is left where it is agreed to.
  Finding expectAsked(const char* code) {
    expectRefused(code);
    import({{ Code::named(code), "accept" }});
    EXPECT_EQ(chosen().verdict, Verdict::repaired) << codes(chosen());
    const Finding* finding = find(chosen(), code);
    EXPECT_NE(finding, nullptr);
    return finding ? *finding : Finding{};
  }
  static DcmItem& itemOf(DcmItem& data, const DcmTagKey& sequence) {
    DcmItem* item = nullptr;
    EXPECT_TRUE(data.findOrCreateSequenceItem(sequence, item).good());
    return *item;
  }
  // A map of real-world values in this unit.
  static void mapValues(DcmItem& data, const char* unit, double slope, double intercept) {
    DcmItem& map = itemOf(data, DCM_RealWorldValueMappingSequence);
    map.putAndInsertFloat64(DCM_RealWorldValueSlope, slope);
    map.putAndInsertFloat64(DCM_RealWorldValueIntercept, intercept);
    DcmItem& code = itemOf(map, DCM_MeasurementUnitsCodeSequence);
    code.putAndInsertString(DCM_CodeValue, unit);
  }
};

TEST_F(ImageKinds, PlainAxialCtPassesWhoeverWroteIt) {
  for (const char* type :
       {"ORIGINAL\\PRIMARY\\AXIAL", "DERIVED\\SECONDARY\\AXIAL", "DERIVED\\SECONDARY",
        "DERIVED\\SECONDARY\\OTHER", "ORIGINAL\\PRIMARY\\AXIAL\\CT_SOM5 SPI", "ORIGINAL\\PRIMARY",
        "ORIGINAL\\PRIMARY\\AXIAL\\HELIX", "DERIVED\\PRIMARY\\AXIAL\\CT_SOM7 SPI DUAL"}) {
    setAll(DCM_ImageType, type);
    EXPECT_EQ(only().verdict, Verdict::pass) << type << ": " << codes(only());
  }
  for (const char* type : {"ORIGINAL\\PRIMARY\\VOLUME\\NONE", "ORIGINAL\\PRIMARY\\ANGIO\\NONE",
                           "DERIVED\\PRIMARY\\VOLUME\\NONE", ""}) {
    enhanced([&](DcmDataset& frame) {
      put(frame, DCM_FrameType, type);
      put(frame, DCM_PixelPresentation, "MONOCHROME");
      put(frame, DCM_VolumetricProperties, "VOLUME");
      put(frame, DCM_VolumeBasedCalculationTechnique, "NONE");
    });
    EXPECT_EQ(only().verdict, Verdict::pass) << type << ": " << codes(only());
  }
}

TEST_F(ImageKinds, ReformattedSlicesAreAsked) {
  for (const char* type :
       {"DERIVED\\SECONDARY\\MPR", "DERIVED\\SECONDARY\\REFORMATTED\\AVERAGE",
        "DERIVED\\SECONDARY\\OTHER\\CSA MPR", "DERIVED\\PRIMARY\\VOLUME\\RESAMPLED",
        "DERIVED\\PRIMARY\\AXIAL\\VMI", "DERIVED\\PRIMARY\\AXIAL\\MAT_REMOVED",
        "ORIGINAL\\PRIMARY\\PERFUSION\\NONE"}) {
    anew();
    setAll(DCM_ImageType, type);
    SCOPED_TRACE(type);
    expectAsked("DERIVED_IMAGES");
  }
}

TEST_F(ImageKinds, ProjectionsAndPicturesAreRefused) {
  for (const char* type :
       {"DERIVED\\SECONDARY\\MIP", "DERIVED\\SECONDARY\\REFORMATTED\\MIN IP",
        "DERIVED\\SECONDARY\\PROJECTION IMAGE", "DERIVED\\PRIMARY\\VOLUME\\MAXIMUM"}) {
    setAll(DCM_ImageType, type);
    SCOPED_TRACE(type);
    expectRefused("PROJECTION");
    EXPECT_TRUE(only().choices.empty());
  }
}

TEST_F(ImageKinds, MapsAndDifferencesAreRefused) {
  for (const char* type :
       {"DERIVED\\PRIMARY\\VOLUME\\SUBTRACTION", "DERIVED\\SECONDARY\\AXIAL\\MTT",
        "DERIVED\\PRIMARY\\PERFUSION\\NONE", "DERIVED\\PRIMARY\\AXIAL\\MAT_SPECIFIC",
        "DERIVED\\PRIMARY\\AXIAL\\EFF_ATOMIC_NUM", "DERIVED\\PRIMARY\\AXIAL\\ELECTRON_DENSITY",
        "DERIVED\\SECONDARY\\MPR\\SUBTRACTION"}) {
    setAll(DCM_ImageType, type);
    SCOPED_TRACE(type);
    expectRefused("NOT_HU");
  }
}

TEST_F(ImageKinds, AFrameSaysWhatItIsWhateverTheWholeSays) {
  const auto refusedAs = [&](const DcmTagKey& tag, const char* value) {
    enhanced([&](DcmDataset& frame) { put(frame, tag, value); });
    const SeriesReport series = only();
    EXPECT_EQ(series.verdict, Verdict::refused) << value;
    return codes(series);
  };
  EXPECT_EQ(refusedAs(DCM_FrameType, "DERIVED\\PRIMARY\\VOLUME\\SUBTRACTION"), "NOT_HU ");
  EXPECT_EQ(refusedAs(DCM_FrameType, "DERIVED\\PRIMARY\\VOLUME\\MAXIMUM"), "PROJECTION ");
  EXPECT_EQ(refusedAs(DCM_FrameType, "DERIVED\\PRIMARY\\VOLUME\\MIXED"), "DERIVED_IMAGES ");
  EXPECT_EQ(refusedAs(DCM_VolumetricProperties, "SAMPLED"), "PROJECTION ");
  EXPECT_EQ(refusedAs(DCM_VolumetricProperties, "DISTORTED"), "PROJECTION ");
  for (const char* technique :
       {"MAX_IP", "MIN_IP", "VOLUME_RENDER", "SURFACE_RENDER", "CURVED_MPR"}) {
    EXPECT_EQ(refusedAs(DCM_VolumeBasedCalculationTechnique, technique), "PROJECTION ");
  }
  EXPECT_EQ(refusedAs(DCM_VolumeBasedCalculationTechnique, "MPR"), "DERIVED_IMAGES ");
  for (const char* presentation : {"COLOR", "TRUE_COLOR", "MIXED"}) {
    EXPECT_EQ(refusedAs(DCM_PixelPresentation, presentation), "COLOUR ");
  }
}

TEST_F(ImageKinds, ThePartsOfASeriesThatAreAnotherKindAreNamed) {
  edit(slice(3), [](DcmDataset& data) { put(data, DCM_ImageType, "DERIVED\\SECONDARY\\MIP"); });
  EXPECT_EQ(expectRefused("PROJECTION").slices, std::vector<std::string>{"slice 3"});
}

TEST_F(ImageKinds, CtThatCallsItselfAnotherModalityIsRefused) {
  for (const char* modality : {"PT", "NM", "MR"}) {
    setAll(DCM_Modality, modality);
    EXPECT_NE(expectRefused("NOT_CT").text.find(modality), std::string::npos);
  }
}

TEST_F(ImageKinds, ValuesThatNeedATableAreRefused) {
  editAll([](DcmDataset& data) {
    DcmItem& table = itemOf(data, DCM_ModalityLUTSequence);
    const Uint16 descriptor[] = {2, 0, 16}, values[] = {0, 1000};
    table.putAndInsertUint16Array(DCM_LUTDescriptor, descriptor, 3);
    table.putAndInsertUint16Array(DCM_LUTData, values, 2);
    put(data, DCM_SeriesDescription, "with a table");
  });
  EXPECT_NE(expectRefused("NOT_HU").text.find("Modality LUT"), std::string::npos);
}

TEST_F(ImageKinds, ValuesWithAnotherScaleBesideHuAreAsked) {
  editAll([](DcmDataset& data) { mapValues(data, "mg/mL", 0.1, 0.0); });
  EXPECT_NE(expectAsked("VALUE_MAP").text.find("'mg/mL'"), std::string::npos);
  anew();
  editAll([](DcmDataset& data) { mapValues(data, "[hnsf'U]", 2.0, -1000.0); });
  expectAsked("VALUE_MAP");
}

TEST_F(ImageKinds, AMapThatSaysTheSameAsTheRescaleIsNone) {
  editAll([](DcmDataset& data) {
    const double intercept = std::stod(text(data, DCM_RescaleIntercept));
    mapValues(data, "[hnsf'U]", 1.0, intercept);
  });
  EXPECT_EQ(only().verdict, Verdict::pass) << codes(only());
}

TEST_F(ImageKinds, AFrameOfAnEnhancedImageMayHaveAMapOfItsOwn) {
  Image image;
  image.frames = 6;
  fillPattern(image, 0);
  std::vector<Vec3> places_mm;
  for (int k = 0; k < 6; ++k) places_mm.push_back(Vec3(0.0, 0.0, 100.0 + k));
  fs::remove_all(folder());
  DcmDataset data = makeEnhanced(image, places_mm);
  DcmItem& map = functionalGroup(data, DCM_RealWorldValueMappingSequence, 2);
  map.putAndInsertFloat64(DCM_RealWorldValueSlope, 0.1);
  add(data);
  EXPECT_EQ(expectRefused("VALUE_MAP").slices, std::vector<std::string>{"slice 3"});
}

}  // namespace trephine::test
