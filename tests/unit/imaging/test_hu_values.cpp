// One look at the voxels tells whether they can be HU at all.
#include <limits>
#include <type_traits>

#include "imaging/codes.h"
#include "imaging/common/detail/hu_sanity_check.h"
#include "painted.h"
#include "series_fixture.h"

namespace trephine::test {

namespace fs = std::filesystem;

class HuValues : public SeriesFixture {
 protected:
  // A body with noise in air: about a fifth of it soft tissue, some bone; corners at -1024.
  static Volume body(Index3 size = {48, 40, 6}) {
    Volume volume;
    volume.geometry = centredGrid(size, Vec3(2.0));
    volume.hu.resize(volume.geometry.voxelCount());
    for (std::size_t n = 0; n < volume.hu.size(); ++n) {
      const Index3 at = volume.geometry.indicesOf(n);
      const double x = at[0] - size[0] / 2.0, y = at[1] - size[1] / 2.0;
      const double r = std::sqrt(x * x + y * y);
      const int noise = int((n * 2654435761u) >> 16 & 15) - 7;
      volume.hu[n] = std::int16_t(r < 3    ? 700 + noise
                                  : r < 13 ? 40 + noise
                                  : r < 24 ? -1000 + noise
                                           : -1024);
    }
    return volume;
  }
  // One volume file of these values in the folder.
  template <class Value>
  void writeRaw(const std::vector<Value>& values) {
    const char* bytes = reinterpret_cast<const char*>(values.data());
    writeBytes(folder() / "case.raw", std::string(bytes, values.size() * sizeof(Value)));
    writeBytes(folder() / "case.json",
               R"({"size": [48, 40, 6], "spacing_mm": [2, 2, 2], "byte_order": "little", )"
               R"("origin_mm": [0, 0, 0], "direction": [1, 0, 0, 0, 1, 0, 0, 0, 1], "type": ")" +
                   std::string(std::is_same_v<Value, float> ? "float32" : "int16") + "\"}");
  }
  void writeRaw(const Volume& volume) {
    writeRaw(std::vector<std::int16_t>(volume.hu.begin(), volume.hu.end()));
  }
  static bool isCorner(std::int16_t hu) { return hu == -1024; }
  template <class Map>
  static Volume mapped(Volume volume, const Map& map) {
    for (std::int16_t& hu : volume.hu) hu = std::int16_t(std::clamp<int>(map(hu), -32768, 32767));
    return volume;
  }
  void anew(const Volume& volume) {
    fs::remove_all(folder());
    write(volume);
  }
  void padWith(int value) {
    editAll([=](DcmDataset& data) {
      Uint16 is_signed = 0;
      data.findAndGetUint16(DCM_PixelRepresentation, is_signed);
      if (is_signed) {
        auto* element = new DcmSignedShort(DcmTag(DCM_PixelPaddingValue, EVR_SS));
        element->putSint16(Sint16(value));
        data.insert(element, OFTrue);
      } else {
        data.putAndInsertUint16(DCM_PixelPaddingValue, Uint16(value + 1024));
      }
    });
  }
  // Passes by its headers, is refused once its voxels are seen, and is read on consent.
  Finding expectAsked() {
    EXPECT_EQ(scan().report().series.front().verdict, Verdict::pass);
    EXPECT_EQ(refusal().code.str(), "IMPLAUSIBLE_HU");
    const SeriesReport series = report_.series.front();
    EXPECT_EQ(series.verdict, Verdict::refused);
    EXPECT_FALSE(report_.chosen);
    EXPECT_TRUE(series.hu_min && series.hu_max);
    EXPECT_EQ(refusal({{code::kImplausibleHu, "perhaps"}}).code.str(), "BAD_CHOICE");
    const Volume read = import({{code::kImplausibleHu, "accept"}});
    EXPECT_EQ(chosen().verdict, Verdict::repaired);
    const auto [low, high] = std::ranges::minmax(read.hu);
    EXPECT_EQ(chosen().hu_min, low);
    EXPECT_EQ(chosen().hu_max, high);
    const Finding* finding = find(chosen(), "IMPLAUSIBLE_HU");
    EXPECT_NE(finding, nullptr);
    return finding ? *finding : Finding{};
  }
};

TEST_F(HuValues, OfABodyInAirPass) {
  write(body());
  import();
  EXPECT_EQ(chosen().verdict, Verdict::pass) << codes(chosen());
  EXPECT_EQ(find(chosen(), "NO_AIR"), nullptr);
}

TEST_F(HuValues, WithoutTheirInterceptAreAsked) {
  for (const int intercept : {1000, 1024}) {
    anew(mapped(body(), [&](int hu) { return std::max(hu + intercept, 0); }));
    const Finding finding = expectAsked();
    EXPECT_NE(finding.text.find("% of the voxels lie near"), std::string::npos) << finding.text;
    EXPECT_NE(finding.text.find("stored values without their intercept"), std::string::npos);
  }
}

TEST_F(HuValues, WithoutTheirInterceptAreAskedWhateverTheyArePaddedWith) {
  for (const int padding : {-2000, -3024, -1024}) {
    anew(mapped(body(), [&](int hu) { return isCorner(hu) ? padding : hu + 1000; }));
    if (padding == -1024) padWith(padding);  // which could be air where the file does not say it
    expectAsked();
  }
}

TEST_F(HuValues, WhoseAirLiesAtAThousandAreAsked) {
  anew(mapped(body(), [](int hu) { return -hu; }));
  const Finding finding = expectAsked();
  EXPECT_NE(finding.text.find("inverted"), std::string::npos) << finding.text;
}

TEST_F(HuValues, ThatAreNoisyAreAskedInTheSameWay) {
  // As of a thin slice with a sharp kernel, and cut at -1024 as scanners do.
  Volume noisy = body();
  for (std::size_t n = 0; n < noisy.hu.size(); ++n) {
    const int noise = int((n * 40503u) % 83) - 41;
    if (!isCorner(noisy.hu[n])) noisy.hu[n] = std::int16_t(std::max(noisy.hu[n] + noise, -1024));
  }
  anew(noisy);
  import();
  EXPECT_EQ(chosen().verdict, Verdict::pass) << codes(chosen());
  for (const int sign : {1, -1}) {
    anew(mapped(noisy, [&](int hu) { return sign > 0 ? hu + 1024 : -hu; }));
    expectAsked();
  }
}

TEST_F(HuValues, OfABrainWithBonePass) {
  // Brain where stored values have air; fat of the scalp tells it from them.
  anew(mapped(body(), [](int hu) { return hu < -1016 ? 900 : hu < -300 ? hu + 1030 : hu - 100; }));
  import();
  EXPECT_EQ(chosen().verdict, Verdict::pass) << codes(chosen());
}

TEST_F(HuValues, WhoseAirLiesAtTheClampAreAsked) {
  anew(mapped(body(), [](int hu) { return hu < -300 ? 32767 : hu; }));
  expectAsked();
}

TEST_F(HuValues, DownToAnImpossibleScaleAreAsked) {
  anew(mapped(body(), [](int hu) { return isCorner(hu) ? -3339 : hu; }));
  EXPECT_NE(expectAsked().text.find("-3339"), std::string::npos);
  for (const int usual : {-2000, -2048, -3024, -3071}) {
    anew(mapped(body(), [&](int hu) { return isCorner(hu) ? usual : hu; }));
    import();
    EXPECT_EQ(chosen().verdict, Verdict::pass) << usual;
  }
}

TEST_F(HuValues, ThatArePaddingAloneAreAsked) {
  Volume nothing = body();
  std::ranges::fill(nothing.hu, std::int16_t(-500));
  anew(nothing);
  padWith(-500);
  expectAsked();
  std::ranges::fill(nothing.hu, std::int16_t(-1024));
  anew(nothing);
  expectAsked();
}

TEST_F(HuValues, OfABrainAndBoneAlonePass) {
  // A burr hole's surroundings: no air, no fat. And a newborn's, whose brain is near to water.
  for (const int brain : {34, 22, 14}) {
    Volume crop = body();
    for (std::size_t n = 0; n < crop.hu.size(); ++n) {
      const int noise = int((n * 40503u) % 17) + int((n * 69069u / 7) % 17) - 16;
      crop.hu[n] = std::int16_t(n % 7 == 0 ? 1000 + 20 * noise : brain + noise);
    }
    anew(crop);
    import();
    EXPECT_EQ(chosen().verdict, Verdict::pass) << brain << " " << codes(chosen());
  }
}

TEST_F(HuValues, WithoutAirAreNotedAndPass) {
  // A cropped liver: its mode is none of those that tell.
  anew(mapped(body(), [](int hu) { return hu < 0 ? 55 + hu % 9 : hu; }));
  import();
  EXPECT_EQ(chosen().verdict, Verdict::pass) << codes(chosen());
  EXPECT_NE(find(chosen(), "NO_AIR"), nullptr);
}

TEST_F(HuValues, OfWaterInAirPass) {
  // Over a third of it lies at 0, but it stands in air.
  anew(mapped(body(), [](int hu) { return hu > -980 || hu < -1015 ? 0 : hu; }));
  import();
  EXPECT_EQ(chosen().verdict, Verdict::pass) << codes(chosen());
}

TEST_F(HuValues, OfATiltedStackAreJudgedWithoutTheCornersThatItGained) {
  Volume tilted = mapped(body(), [](int hu) { return std::max(hu + 1000, 0); });
  write(tilted);
  for (int k = 0; k < 6; ++k) {
    edit(slice(k + 1), [&](DcmDataset& data) {
      put(data, DCM_ImagePositionPatient, positionText(Vec3(0.0, 6.0 * k, 2.0 * k)));
    });
  }
  EXPECT_EQ(refusal().code.str(), "IMPLAUSIBLE_HU");
}

TEST_F(HuValues, OfAVolumeFileAreJudgedInTheSameWay) {
  writeRaw(body());
  EXPECT_EQ(import().hu, body().hu);
  EXPECT_EQ(codes(chosen()), "ASSUMED_HU ");
  writeRaw(mapped(body(), [](int hu) { return std::max(hu + 1000, 0); }));
  expectAsked();
  CtFolder ct = scan();
  const std::string uid = ct.report().series.front().uid;
  EXPECT_FALSE(ct.read(uid, {}, Progress()));
  EXPECT_FALSE(ct.bestSeries({{code::kCouch, "keep"}}));
  EXPECT_EQ(ct.bestSeries({{code::kImplausibleHu, "accept"}}), uid);
}

TEST_F(HuValues, OfAVolumeFileAreJudgedWithoutWhatIsNoNumber) {
  std::vector<float> values;
  for (const std::int16_t hu : body().hu) {
    values.push_back(isCorner(hu) ? std::numeric_limits<float>::quiet_NaN() : float(hu + 1000));
  }
  writeRaw(values);
  EXPECT_EQ(refusal().code.str(), "IMPLAUSIBLE_HU");
}

// `count` values, spread evenly over a range.
void spread(HuSanityCheck& look, int count, int from, int to) {
  std::vector<std::int16_t> hu;
  for (int n = 0; n < count; ++n) hu.push_back(std::int16_t(from + n * (to - from + 1) / count));
  look.add(hu);
}

TEST(HuSanityCheck, FindsAModeBesideCornersOfOneValue) {
  HuSanityCheck look;
  spread(look, 200, 0, 0);
  spread(look, 320, 10, 49);  // a third of what the corners leave, not of all
  spread(look, 480, 950, 1400);
  EXPECT_EQ(look.doubts(0, 1400).size(), 1u);
}

TEST(HuSanityCheck, KnowsStoredAirByTheCutAtZero) {
  for (const bool cut : {true, false}) {
    HuSanityCheck look;
    spread(look, 500, 10, 49);
    spread(look, 490, 1500, 3000);
    if (cut) spread(look, 10, 0, 0);
    EXPECT_EQ(look.doubts(0, 3000).empty(), !cut);
  }
}

TEST(HuSanityCheck, TakesBrainAndBoneForWhatTheyAre) {
  HuSanityCheck look;
  spread(look, 500, -2, 49);
  spread(look, 500, 600, 1700);
  EXPECT_TRUE(look.doubts(-2, 1700).empty());
  EXPECT_FALSE(look.hasAir());
}

TEST(HuSanityCheck, SeesEveryVoxelOfASmallBlockAndAFewOfALargeOne) {
  std::vector<int> seen(16000);
  visitSample(seen.size(), [&](std::size_t n) { ++seen[n]; });
  EXPECT_EQ(std::ranges::count(seen, 1), 16000);
  // No column is seen much more often than another, whatever the width.
  for (const std::size_t width : {512u, 610u, 768u}) {
    std::vector<int> columns(width);
    int all = 0;
    visitSample(width * 4096, [&](std::size_t n) {
      ++columns[n % width];
      ++all;
    });
    EXPECT_NEAR(double(width * 4096) / all, 128.5, 2.0);
    const auto [least, most] = std::ranges::minmax(columns);
    EXPECT_GT(least, 10) << width;
    EXPECT_LT(most, 70) << width;
  }
}

}  // namespace trephine::test
