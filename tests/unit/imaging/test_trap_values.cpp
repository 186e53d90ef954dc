// Stored words of every form: what they mean is computed here from the values that were stored.
#include <cmath>

#include "imaging/codes.h"
#include "series_fixture.h"

namespace trephine::test {

class TrapValues : public SeriesFixture {
 protected:
  static Image imageAt(int k) {
    Image image;
    image.position_mm.z = 100.0 + k;
    image.instance = k + 1;
    return image;
  }

  static int hounsfield(double value, double slope, double intercept) {
    return int(std::clamp(std::nearbyint(slope * value + intercept), -32768.0, 32767.0));
  }
};

struct Form {
  int allocated, stored, high;
  bool is_signed;
};

constexpr Form kForms[] = {
    {8, 8, 7, false},    {8, 8, 7, true},    {8, 6, 5, false},   {8, 7, 6, true},
    {16, 12, 11, false}, {16, 12, 11, true}, {16, 12, 15, true}, {16, 12, 13, false},
    {16, 16, 15, false}, {16, 16, 15, true}, {16, 10, 9, true},  {16, 8, 7, false},
    {16, 8, 7, true},    {16, 1, 0, false},  {16, 15, 14, true},
};

TEST_F(TrapValues, EveryWidthAndSignWithAnythingInTheOtherBits) {
  for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit,
                                        EXS_BigEndianExplicit, EXS_DeflatedLittleEndianExplicit}) {
    for (const Form& form : kForms) {
      SCOPED_TRACE(std::to_string(form.allocated) + " " + std::to_string(form.stored) + " " +
                   std::to_string(form.high) + (form.is_signed ? " signed " : " unsigned ") +
                   DcmXfer(syntax).getXferName());
      std::filesystem::remove_all(folder());
      const std::string intercept = form.stored == 16 && !form.is_signed ? "-32768" : "-424";
      for (int k = 0; k < 4; ++k) {
        Image image = imageAt(k);
        image.bits_allocated = form.allocated;
        image.bits_stored = form.stored;
        image.high_bit = form.high;
        image.is_signed = form.is_signed;
        image.intercept = intercept;
        fillPattern(image, k);
        DcmDataset data = makeImage(image);
        // Whatever stands above and below the stored bits.
        const int used = ((1 << form.stored) - 1) << (form.high + 1 - form.stored);
        if (form.allocated == 16) {
          const Uint16* words = nullptr;
          ASSERT_TRUE(data.findAndGetUint16Array(DCM_PixelData, words).good());
          std::vector<Uint16> spoilt(words, words + 35);
          for (std::size_t n = 0; n < 35; ++n) spoilt[n] |= Uint16(~used & int(n * 40503));
          data.putAndInsertUint16Array(DCM_PixelData, spoilt.data(), 35);
        }
        add(data, {syntax});
      }
      const Volume volume = import();
      ASSERT_EQ(volume.geometry.size, (Index3{7, 5, 4}));
      for (int k = 0; k < 4; ++k) {
        for (int j = 0; j < 5; ++j) {
          for (int i = 0; i < 7; ++i) {
            const int stored = patternValue(i, j, k, form.stored, form.is_signed);
            ASSERT_EQ(volume.at(i, j, k), hounsfield(stored, 1.0, std::stod(intercept)))
                << i << " " << j << " " << k;
          }
        }
      }
    }
  }
}

TEST_F(TrapValues, EightBitPixelsInWordsOfEitherOrder) {
  // PS3.5 8.1.2: in big endian, OW swaps pairs of 8-bit pixels and OB does not.
  for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_BigEndianExplicit}) {
    for (const DcmEVR vr : {EVR_OB, EVR_OW}) {
      SCOPED_TRACE(std::string(DcmXfer(syntax).getXferName()) + (vr == EVR_OB ? " OB" : " OW"));
      std::filesystem::remove_all(folder());
      for (int k = 0; k < 4; ++k) {
        Image image = imageAt(k);
        image.bits_allocated = image.bits_stored = 8;
        image.high_bit = 7;
        fillPattern(image, k);
        DcmDataset data = makeImage(image);
        std::vector<Uint8> bytes(image.stored.begin(), image.stored.end());
        bytes.push_back(0);
        auto* pixels = new DcmPixelData(DCM_PixelData);  // owned by the data set
        pixels->setVR(vr);
        if (vr == EVR_OB) {
          pixels->putUint8Array(bytes.data(), bytes.size());
        } else {
          pixels->putUint16Array(reinterpret_cast<const Uint16*>(bytes.data()), bytes.size() / 2);
        }
        ASSERT_TRUE(data.insert(pixels, OFTrue).good());
        add(data, {syntax});
      }
      const Volume volume = import();
      for (std::size_t v = 0; v < volume.hu.size(); ++v) {
        const int n = int(v % 35);
        ASSERT_EQ(volume.hu[v], patternValue(n % 7, n / 7, int(v / 35), 8) - 1024) << v;
      }
    }
  }
}

TEST_F(TrapValues, SlopeAndInterceptDifferFromSliceToSlice) {
  const std::pair<const char*, const char*> scales[] = {{"1", "-1024"},      {"2", "-2000"},
                                                        {"0.5", "-1000.25"}, {"1.0e0", "-1.024E3"},
                                                        {"-1", "900"},       {"16", "-1024"}};
  for (int k = 0; k < 6; ++k) {
    Image image = imageAt(k);
    image.slope = scales[k].first;
    image.intercept = scales[k].second;
    fillPattern(image, k);
    add(makeImage(image));
  }
  const Volume volume = import({{code::kSlopesDiffer, "accept"}});
  int clamped = 0, rounded = 0;
  for (int k = 0; k < 6; ++k) {
    const double slope = std::stod(scales[k].first), intercept = std::stod(scales[k].second);
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 7; ++i) {
        const double exact = slope * patternValue(i, j, k) + intercept;
        ASSERT_EQ(volume.at(i, j, k), hounsfield(patternValue(i, j, k), slope, intercept)) << k;
        clamped += exact > 32767;
        rounded += exact != std::nearbyint(exact);
      }
    }
  }
  ASSERT_GT(clamped, 0);
  ASSERT_GT(rounded, 0);
  EXPECT_TRUE(find(chosen(), "HU_CLAMPED")->text.starts_with(std::to_string(clamped) + " "));
  EXPECT_TRUE(find(chosen(), "HU_ROUNDED")->text.starts_with(std::to_string(rounded) + " "));
}

TEST_F(TrapValues, ASliceWithoutTheInterceptThatOthersHaveIsNotTakenSilently) {
  for (int k = 0; k < 4; ++k) {
    Image image = imageAt(k);
    if (k == 2) image.intercept = "";
    fillPattern(image, k);
    add(makeImage(image));
  }
  expectRefused("BAD_RESCALE");
}

TEST_F(TrapValues, PaddingIsComparedWithWhatIsStored) {
  struct Case {
    bool is_signed;
    int value, limit;  // equal: no range
  };
  const Case cases[] = {{false, 0, 0},        {false, 63, 63},      {false, 10, 900},
                        {false, 900, 10},     {true, -2048, -2048}, {true, -2048, -1500},
                        {true, -1500, -2048}, {true, -3, 4}};
  for (const Case& c : cases) {
    for (const E_TransferSyntax syntax :
         {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit, EXS_BigEndianExplicit}) {
      SCOPED_TRACE(std::to_string(c.value) + ".." + std::to_string(c.limit));
      std::filesystem::remove_all(folder());
      for (int k = 0; k < 4; ++k) {
        Image image = imageAt(k);
        image.is_signed = c.is_signed;
        image.slope = "2";
        image.intercept = "-500";
        fillPattern(image, k);
        image.stored[5] = c.value;
        image.stored[6] = c.limit;
        image.stored[7] = (c.value + c.limit) / 2;
        image.stored[8] = std::max(c.value, c.limit) + 1;
        DcmDataset data = makeImage(image);
        const auto put_padding = [&](const DcmTag& tag, int value) {
          if (c.is_signed) {
            auto* element = new DcmSignedShort(DcmTag(tag, EVR_SS));
            element->putSint16(Sint16(value));
            data.insert(element, OFTrue);
          } else {
            data.putAndInsertUint16(tag, Uint16(value));
          }
        };
        put_padding(DCM_PixelPaddingValue, c.value);
        if (c.limit != c.value) put_padding(DCM_PixelPaddingRangeLimit, c.limit);
        add(data, {syntax});
      }
      const Volume volume = import();
      const int low = std::min(c.value, c.limit), high = std::max(c.value, c.limit);
      int padding = 0;
      for (int k = 0; k < 4; ++k) {
        for (int n = 0; n < 35; ++n) {
          int stored = patternValue(n % 7, n / 7, k, 12, c.is_signed);
          if (n == 5) stored = c.value;
          if (n == 6) stored = c.limit;
          if (n == 7) stored = (c.value + c.limit) / 2;
          if (n == 8) stored = high + 1;
          const bool padded = stored >= low && stored <= high;
          padding += padded;
          ASSERT_EQ(volume.hu[std::size_t(k * 35 + n)], padded ? -1000 : 2 * stored - 500) << n;
        }
      }
      ASSERT_NE(find(chosen(), "PADDING_TO_AIR"), nullptr);
      EXPECT_TRUE(
          find(chosen(), "PADDING_TO_AIR")->text.starts_with(std::to_string(padding) + " "));
    }
  }
}

TEST_F(TrapValues, PaddingIsNotMixedIntoFilledSlices) {
  for (const int k : {0, 1, 3, 4}) {
    Image image = imageAt(k);
    image.stored.assign(35, 1124 + 10 * k);
    for (std::size_t n = 0; n < 35; n += 3) image.stored[n] = 0;
    if (k == 1) image.stored[1] = 0;  // lost on one side of the gap only
    DcmDataset data = makeImage(image);
    data.putAndInsertUint16(DCM_PixelPaddingValue, 0);
    add(data);
  }
  const Volume volume = import({{code::kMissingSlices, "fill"}});
  for (int n = 0; n < 35; ++n) {
    const int hu = volume.hu[std::size_t(2 * 35 + n)];
    if (n == 1) {
      EXPECT_TRUE(hu == -1000 || hu == 130) << hu;
    } else {
      EXPECT_EQ(hu, n % 3 == 0 ? -1000 : 120) << n;
    }
  }
}

TEST_F(TrapValues, DisplayAttributesNeverChangeHu) {
  for (int k = 0; k < 4; ++k) {
    Image image = imageAt(k);
    fillPattern(image, k);
    DcmDataset data = makeImage(image);
    put(data, DCM_PhotometricInterpretation, "MONOCHROME1");
    put(data, DCM_WindowCenter, "40\\400");
    put(data, DCM_WindowWidth, "80\\2000");
    put(data, DCM_PresentationLUTShape, "INVERSE");
    data.putAndInsertUint16(DCM_SmallestImagePixelValue, 5);
    add(data);
  }
  const Volume volume = import();
  for (std::size_t v = 0; v < volume.hu.size(); ++v) {
    const int n = int(v % 35);
    ASSERT_EQ(volume.hu[v], patternValue(n % 7, n / 7, int(v / 35)) - 1024);
  }
  EXPECT_EQ(chosen().verdict, Verdict::pass);
  EXPECT_NE(find(chosen(), "MONOCHROME1"), nullptr);
}

TEST_F(TrapValues, AnIconBesideThePixelsIsNotThePixels) {
  for (int k = 0; k < 4; ++k) {
    Image image = imageAt(k);
    fillPattern(image, k);
    DcmDataset data = makeImage(image);
    DcmItem* icon = nullptr;
    ASSERT_TRUE(data.findOrCreateSequenceItem(DCM_IconImageSequence, icon).good());
    const std::vector<Uint8> grey(64 * 64, 77);
    icon->putAndInsertUint16(DCM_Rows, 64);
    icon->putAndInsertUint16(DCM_Columns, 64);
    icon->putAndInsertUint16(DCM_BitsAllocated, 8);
    icon->putAndInsertUint8Array(DCM_PixelData, grey.data(), grey.size());
    add(data, {k == 0 ? EXS_LittleEndianImplicit : EXS_LittleEndianExplicit});
  }
  const Volume volume = import();
  ASSERT_EQ(volume.geometry.size, (Index3{7, 5, 4}));
  for (std::size_t v = 0; v < volume.hu.size(); ++v) {
    const int n = int(v % 35);
    ASSERT_EQ(volume.hu[v], patternValue(n % 7, n / 7, int(v / 35)) - 1024);
  }
}

}  // namespace trephine::test
