// Stacks that are not even: missing slices, several spacings, jitter. What must come out is
// computed here from the slices that were written.
#include <cmath>

#include "imaging/codes.h"
#include "series_fixture.h"

namespace trephine::test {

namespace fs = std::filesystem;

class TrapGaps : public SeriesFixture {
 protected:
  struct Written {
    double z;
    std::vector<int> hu;
  };

  static Image imageAt(double z, int instance) {
    Image image;
    image.position_mm = {-20.0, 10.5, z};
    image.instance = instance;
    return image;
  }

  void addPatterns(const std::vector<double>& zs) {
    for (std::size_t n = 0; n < zs.size(); ++n) {
      Image image = imageAt(zs[n], int(n) + 1);
      fillPattern(image, int(n));
      addAndKeep(image, zs[n]);
    }
  }

  void addAndKeep(const Image& image, double z) {
    Written slice{z, {}};
    for (const int value : image.stored) slice.hu.push_back(value - 1024);
    written_.push_back(slice);
    add(makeImage(image));
  }

  // HU at z by linear interpolation of what was written, and how far the nearest slice differs from
  // it at most if it lies within `snap_mm` and was taken as it is.
  std::pair<double, double> expectedAt(double z, std::size_t pixel, double snap_mm) const {
    for (std::size_t n = 0; n + 1 < written_.size(); ++n) {
      const Written &a = written_[n], &b = written_[n + 1];
      if (z > b.z + 1e-9) continue;
      const double share = std::clamp((z - a.z) / (b.z - a.z), 0.0, 1.0);
      const double slope = std::abs(b.hu[pixel] - a.hu[pixel]) / (b.z - a.z);
      return {(1 - share) * a.hu[pixel] + share * b.hu[pixel], snap_mm * slope};
    }
    return {written_.back().hu[pixel], 0.0};
  }

  void expectInterpolated(const Volume& volume, double first, double last, double snap_mm) {
    const GridGeometry& g = volume.geometry;
    ASSERT_EQ(g.size[0] * g.size[1], 35);
    EXPECT_DOUBLE_EQ(g.origin_mm.z, first);
    EXPECT_NEAR(g.origin_mm.z + g.spacing_mm.z * (g.size[2] - 1), last, 1e-9);
    for (int k = 0; k < g.size[2]; ++k) {
      for (std::size_t n = 0; n < 35; ++n) {
        const auto [hu, snap] = expectedAt(first + k * g.spacing_mm.z, n, snap_mm);
        ASSERT_NEAR(volume.hu[std::size_t(k) * 35 + n], hu, 0.5 + 1e-6 + snap) << k << " " << n;
      }
    }
  }

  std::vector<Written> written_;
};

TEST_F(TrapGaps, OneMissingSliceIsNamedFilledAndMarked) {
  addPatterns({100, 101.25, 102.5, 105, 106.25, 107.5, 108.75});
  const Finding refused = expectRefused("MISSING_SLICES");
  EXPECT_EQ(refused.slices, std::vector<std::string>{"103.75 mm"});
  EXPECT_EQ(report_.series.front().choices.front().options,
            (std::vector<std::string>{"refuse", "fill", "part"}));

  const Volume volume = import({{code::kMissingSlices, "fill"}});
  ASSERT_EQ(volume.geometry.size, (Index3{7, 5, 8}));
  EXPECT_DOUBLE_EQ(volume.geometry.spacing_mm.z, 1.25);
  for (int k = 0; k < 8; ++k) {
    for (std::size_t n = 0; n < 35; ++n) {
      const int hu = volume.hu[std::size_t(k) * 35 + n];
      if (k == 3) {
        const double middle = (written_[2].hu[n] + written_[3].hu[n]) / 2.0;
        ASSERT_EQ(hu, int(std::nearbyint(middle))) << n;
      } else {
        ASSERT_EQ(hu, written_[std::size_t(k < 3 ? k : k - 1)].hu[n]) << k << " " << n;
      }
    }
  }
  EXPECT_EQ(chosen().verdict, Verdict::repaired);
  ASSERT_NE(find(chosen(), "MISSING_SLICES"), nullptr);
  EXPECT_EQ(find(chosen(), "MISSING_SLICES")->severity, Severity::repair);
  EXPECT_EQ(find(chosen(), "MISSING_SLICES")->slices, std::vector<std::string>{"103.75 mm"});
  ASSERT_TRUE(report_.provenance.has_value());
  EXPECT_EQ(report_.provenance->answers, (Answers{{code::kMissingSlices, "fill"}}));
  EXPECT_EQ(report_.provenance->changes.front().code.str(), "MISSING_SLICES");
  EXPECT_EQ(report_.provenance->slices_used, 7);
  EXPECT_TRUE(report_.provenance->unanswered.empty());
  EXPECT_TRUE(report_.provenance->unused_answers.empty());
  import({{code::kMissingSlices, "fill"}, { code::kPhases, "2" }});
  EXPECT_EQ(report_.provenance->unused_answers, std::vector<Code>{code::kPhases});
}

TEST_F(TrapGaps, AGapOfMoreSlicesThanWereScannedIsNotFilled) {
  addPatterns({100, 101, 102, 107, 108});  // 4 missing, 5 there
  expectRefused("MISSING_SLICES");
  EXPECT_EQ(report_.series.front().choices.front().options,
            (std::vector<std::string>{"refuse", "fill", "part"}));
  addPatterns({112, 113});  // 7 and 7
  expectRefused("MISSING_SLICES");
  EXPECT_EQ(report_.series.front().choices.front().options.size(), 3u);
  addPatterns({116});  // 9 and 8
  EXPECT_EQ(expectRefused("MISSING_SLICES").action, "Copy or export the series again");
  EXPECT_EQ(report_.series.front().choices.front().options,
            (std::vector<std::string>{"refuse", "part"}));
  EXPECT_EQ(refusal({{code::kMissingSlices, "fill"}}).code.str(), "BAD_CHOICE");
}

TEST_F(TrapGaps, SlicesLostAtTheEndAreCutOffAndDoNotCountAsFilled) {
  addPatterns({105, 106, 107, 108, 109, 110, 111, 112});
  for (const auto& entry : fs::directory_iterator(folder())) {
    fs::resize_file(entry.path(), fs::file_size(entry.path()) - 6);
  }
  addPatterns({100, 101, 102, 104});  // as if the copying of the others had been broken off
  expectRefused("MISSING_SLICES");
  const Volume volume = import({{code::kMissingSlices, "fill"}});
  EXPECT_EQ(volume.geometry.size[2], 5);
}

TEST_F(TrapGaps, ThePartWithoutAGapIsTheLongest) {
  addPatterns({100, 101.25, 102.5, 105, 106.25, 107.5, 108.75});
  const Volume volume = import({{code::kMissingSlices, "part"}});
  ASSERT_EQ(volume.geometry.size, (Index3{7, 5, 4}));
  EXPECT_EQ(volume.geometry.origin_mm, Vec3(-20, 10.5, 105));
  EXPECT_DOUBLE_EQ(volume.geometry.spacing_mm.z, 1.25);
  for (std::size_t v = 0; v < volume.hu.size(); ++v) {
    ASSERT_EQ(volume.hu[v], written_[3 + v / 35].hu[v % 35]) << v;
  }
  EXPECT_EQ(chosen().verdict, Verdict::repaired);
  EXPECT_EQ(report_.provenance->slices_used, 4);
}

TEST_F(TrapGaps, SeveralMissingSlicesAreNamedAndFilled) {
  addPatterns({100, 101.25, 103.75, 105, 108.75, 110, 111.25});
  EXPECT_EQ(expectRefused("MISSING_SLICES").slices,
            (std::vector<std::string>{"102.50 mm", "106.25 mm to 107.50 mm (2 slices)"}));
  EXPECT_TRUE(report_.series.front().findings.front().text.starts_with("3 slices"));
  const Volume volume = import({{code::kMissingSlices, "fill"}});
  ASSERT_EQ(volume.geometry.size[2], 10);
  expectInterpolated(volume, 100, 111.25, 0.0);
}

TEST_F(TrapGaps, TwoSpacingsAskAndAreResampledOverTheWholeExtent) {
  addPatterns({100, 101, 102, 103, 104, 105, 107.6, 110.2, 112.8});
  expectRefused("UNEVEN_SPACING");
  const Volume volume = import({{code::kUnevenSpacing, "resample"}});
  EXPECT_EQ(volume.geometry.size[2], 14);
  expectInterpolated(volume, 100, 112.8, 0.01);
  EXPECT_EQ(chosen().verdict, Verdict::repaired);
  EXPECT_EQ(find(chosen(), "UNEVEN_SPACING")->severity, Severity::repair);
}

TEST_F(TrapGaps, OfTwoSpacingsTheLongestEvenPartCanBeTaken) {
  addPatterns({100, 101, 102, 103, 104, 105, 107.6, 110.2, 112.8});
  const Volume volume = import({{code::kUnevenSpacing, "part"}});
  ASSERT_EQ(volume.geometry.size[2], 6);
  EXPECT_DOUBLE_EQ(volume.geometry.spacing_mm.z, 1.0);
  for (std::size_t v = 0; v < volume.hu.size(); ++v) {
    ASSERT_EQ(volume.hu[v], written_[v / 35].hu[v % 35]) << v;
  }
}

TEST_F(TrapGaps, JitteredStepsAreResampledAndALinearRampStaysOne) {
  // Ten HU a millimetre at tenths of millimetres: every stored value is exact.
  const std::vector<double> zs = {100, 102.1, 104, 106, 108.1, 110, 112.1, 114};
  for (std::size_t n = 0; n < zs.size(); ++n) {
    Image image = imageAt(zs[n], int(n) + 1);
    for (int p = 0; p < 35; ++p) image.stored.push_back(int(std::lround(zs[n] * 10)) + p);
    addAndKeep(image, zs[n]);
  }
  const Volume volume = import();
  EXPECT_EQ(chosen().verdict, Verdict::repaired);
  ASSERT_NE(find(chosen(), "RESAMPLED_SPACING"), nullptr);
  ASSERT_EQ(volume.geometry.size[2], 8);
  EXPECT_DOUBLE_EQ(volume.geometry.spacing_mm.z, 2.0);
  expectInterpolated(volume, 100, 114, 0.02);
  for (int k = 0; k < 8; ++k) {
    for (int p = 0; p < 35; ++p) {
      const double ramp = (100 + 2.0 * k) * 10 + p - 1024;
      ASSERT_NEAR(volume.hu[std::size_t(k * 35 + p)], ramp, 0.5 + 0.2) << k << " " << p;
    }
  }
}

TEST_F(TrapGaps, StepsWithinOneHundredthAreNotTouched) {
  addPatterns({100, 102.01, 104.01, 106.02, 108.015});
  const Volume volume = import();
  EXPECT_EQ(chosen().verdict, Verdict::pass);
  for (std::size_t v = 0; v < volume.hu.size(); ++v) {
    ASSERT_EQ(volume.hu[v], written_[v / 35].hu[v % 35]) << v;
  }
}

TEST_F(TrapGaps, AGapInAJitteredStackIsFilledWhereTheSlicesLie) {
  addPatterns({100, 102.1, 104, 106, 110.1, 112, 114.1, 116});
  EXPECT_EQ(expectRefused("MISSING_SLICES").slices.size(), 1u);
  const Volume volume = import({{code::kMissingSlices, "fill"}});
  ASSERT_EQ(volume.geometry.size[2], 9);
  expectInterpolated(volume, 100, 116, 0.02);
}

TEST_F(TrapGaps, ThePartOfAJitteredStackIsAsLongAsTheSlicesBetweenGaps) {
  addPatterns({100, 102.1, 104, 106, 110.1, 112, 114.1, 116, 118});
  const Volume volume = import({{code::kMissingSlices, "part"}});
  ASSERT_EQ(volume.geometry.size[2], 5);
  written_.erase(written_.begin(), written_.begin() + 4);
  expectInterpolated(volume, 110.1, 118, 0.02);
}

TEST_F(TrapGaps, WithoutTheFirstAndLastSliceTheRestIsSaidToBeAll) {
  addPatterns({100, 102, 104, 106, 108, 110});
  for (const auto& entry : fs::directory_iterator(folder())) {
    DcmFileFormat dicom;
    ASSERT_TRUE(dicom.loadFile(entry.path().c_str()).good());
    const std::string instance = text(*dicom.getDataset(), DCM_InstanceNumber);
    if (instance != "1" && instance != "6") continue;
    fs::resize_file(entry.path(), fs::file_size(entry.path()) - 6);
  }
  EXPECT_EQ(expectRefused("MISSING_SLICES").slices,
            (std::vector<std::string>{"100.00 mm", "110.00 mm"}));
  for (const char* option : {"fill", "part"}) {
    const Volume volume = import({{code::kMissingSlices, option}});
    ASSERT_EQ(volume.geometry.size[2], 4) << option;
    EXPECT_EQ(volume.geometry.origin_mm.z, 102.0);
    for (std::size_t v = 0; v < volume.hu.size(); ++v) {
      ASSERT_EQ(volume.hu[v], written_[1 + v / 35].hu[v % 35]) << option << v;
    }
  }
}

TEST_F(TrapGaps, AnAnswerThatCannotBeIsRefusedAndOneThatIsNotAskedForIsNot) {
  addPatterns({100, 101.25, 102.5, 105, 106.25});
  EXPECT_EQ(refusal({{code::kMissingSlices, "guess"}}).code.str(), "BAD_CHOICE");
  EXPECT_EQ(refusal({{Code("MISING_SLICES"), "fill"}}).code.str(), "BAD_CHOICE");
  EXPECT_EQ(refusal({{Code("missing_slices"), "fill"}}).code.str(), "BAD_CHOICE");
  EXPECT_EQ(refusal({{code::kMissingSlices, "refuse"}}).code.str(), "MISSING_SLICES");
  import({{code::kMissingSlices, "fill"}, {code::kPhases, "7"}, { code::kLossySource, "accept" }});
  EXPECT_EQ(report_.provenance->answers, (Answers{{code::kMissingSlices, "fill"}}));
}

}  // namespace trephine::test
