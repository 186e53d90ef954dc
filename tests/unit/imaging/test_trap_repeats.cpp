// Several slices at one place: phases, copies, overlaps.
#include <random>

#include "imaging/codes.h"
#include "series_fixture.h"

namespace trephine::test {

class TrapRepeats : public SeriesFixture {
 protected:
  static constexpr int kSlices = 7;

  // Slice k of a phase; its pixels differ from phase to phase.
  static Image image(int phase, int k, int instance) {
    Image image;
    image.position_mm.z = 100.0 + 2.0 * k;
    image.instance = instance;
    fillPattern(image, 100 * phase + k);
    return image;
  }

  void addSlice(const Image& image, const Change& change = {}) {
    DcmDataset data = makeImage(image);
    if (change) change(data);
    add(data);
  }

  // Every slice of two phases; `mark` says which phase a slice is of.
  void addPhases(const std::function<void(DcmDataset&, int phase, int k)>& mark,
                 const std::function<bool(int phase, int k)>& wanted = {}) {
    for (int phase = 0; phase < 2; ++phase) {
      for (int k = 0; k < kSlices; ++k) {
        if (wanted && !wanted(phase, k)) continue;
        // By instance number the phases take turns, the wrong way round in every second place.
        const int instance = 1 + 2 * k + (k % 2 ? 1 - phase : phase);
        addSlice(image(phase, k, instance), [&](DcmDataset& data) { mark(data, phase, k); });
      }
    }
  }

  static void expectPhase(const Volume& volume, int phase, int from = 0, int to = kSlices) {
    ASSERT_EQ(volume.geometry.size, (Index3{7, 5, to - from})) << "phase " << phase;
    EXPECT_DOUBLE_EQ(volume.geometry.origin_mm.z, 100.0 + 2.0 * from);
    EXPECT_DOUBLE_EQ(volume.geometry.spacing_mm.z, 2.0);
    for (int k = from; k < to; ++k) {
      for (int j = 0; j < 5; ++j) {
        for (int i = 0; i < 7; ++i) {
          ASSERT_EQ(volume.at(i, j, k - from), patternValue(i, j, 100 * phase + k) - 1024)
              << "phase " << phase << " at " << i << " " << j << " " << k;
        }
      }
    }
  }

  void expectTwoPhases() {
    expectRefused("PHASES");
    EXPECT_EQ(report_.series.front().phases, 2);
    EXPECT_EQ(report_.series.front().choices.front().options,
              (std::vector<std::string>{"refuse", "1", "2"}));
    expectPhase(import({{code::kPhases, "1"}}), 0);
    expectPhase(import({{code::kPhases, "2"}}), 1);
    EXPECT_EQ(chosen().verdict, Verdict::repaired);
    EXPECT_EQ(report_.provenance->answers, (Answers{{code::kPhases, "2"}}));
    EXPECT_EQ(refusal({{code::kPhases, "3"}}).code.str(), "BAD_CHOICE");
  }
};

TEST_F(TrapRepeats, PhasesByTemporalPosition) {
  addPhases([](DcmDataset& data, int phase, int) {
    put(data, DCM_TemporalPositionIdentifier, std::to_string(phase + 1));
    put(data, DCM_AcquisitionNumber, std::to_string(9 - phase));  // says the contrary
  });
  expectTwoPhases();
}

TEST_F(TrapRepeats, PhasesByAcquisitionNumber) {
  addPhases([](DcmDataset& data, int phase, int) {
    put(data, DCM_AcquisitionNumber, std::to_string(phase + 9));  // "9" and "10"
  });
  expectTwoPhases();
}

TEST_F(TrapRepeats, PhasesByOneAcquisitionTimeEach) {
  addPhases([](DcmDataset& data, int phase, int) {
    put(data, DCM_AcquisitionTime, phase ? "101500.25" : "095959");
  });
  expectTwoPhases();
}

TEST_F(TrapRepeats, PhasesByAcquisitionTimesThatDifferFromSliceToSlice) {
  addPhases([](DcmDataset& data, int phase, int k) {
    put(data, DCM_AcquisitionTime, std::to_string(100000 + 100 * phase + k));
  });
  expectTwoPhases();
}

TEST_F(TrapRepeats, PhasesByAcquisitionTimesAcrossMidnight) {
  addPhases([](DcmDataset& data, int phase, int k) {
    put(data, DCM_AcquisitionDateTime,
        (phase ? "20240301000010.5" : "20240229235950.2") + std::to_string(k) + "+0100");
    put(data, DCM_AcquisitionTime, phase ? "000010" : "235950");
  });
  expectTwoPhases();
}

TEST_F(TrapRepeats, PhasesByInstanceNumberOnly) {
  for (int phase = 0; phase < 2; ++phase) {
    for (int k = 0; k < kSlices; ++k) addSlice(image(phase, k, phase * kSlices + k + 1));
  }
  expectTwoPhases();
}

TEST_F(TrapRepeats, PhasesThatShareASliceOfAirStayWhole) {
  for (int phase = 0; phase < 2; ++phase) {
    for (int k = 0; k < kSlices; ++k) {
      Image slice = image(phase, k, phase * kSlices + k + 1);
      if (k == 0 || k == 3) slice.stored.assign(35, 24);
      addSlice(slice, [&](DcmDataset& data) {
        put(data, DCM_TemporalPositionIdentifier, std::to_string(phase + 1));
      });
    }
  }
  expectRefused("PHASES");
  for (const char* phase : {"1", "2"}) {
    const Volume volume = import({{code::kPhases, phase}});
    ASSERT_EQ(volume.geometry.size[2], kSlices) << phase;
    EXPECT_EQ(volume.at(3, 3, 0), -1000);
    EXPECT_EQ(volume.at(3, 3, 3), -1000);
    EXPECT_EQ(find(chosen(), "MISSING_SLICES"), nullptr);
  }
}

TEST_F(TrapRepeats, OfAPhaseWithAMissingSliceOnlyThatPhaseIsIncomplete) {
  addPhases([](DcmDataset& data, int phase,
               int) { put(data, DCM_TemporalPositionIdentifier, std::to_string(phase + 1)); },
            [](int phase, int k) { return phase == 0 || k != 2; });
  expectRefused("PHASES");
  expectPhase(import({{code::kPhases, "1"}}), 0);
  EXPECT_EQ(refusal({{code::kPhases, "2"}}).code.str(), "MISSING_SLICES");
  expectPhase(import({{code::kPhases, "2"}, {code::kMissingSlices, "part"}}), 1, 3, kSlices);
  const Volume filled = import({{code::kPhases, "2"}, {code::kMissingSlices, "fill"}});
  ASSERT_EQ(filled.geometry.size[2], kSlices);
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 7; ++i) {
      const double middle = (patternValue(i, j, 101) + patternValue(i, j, 103)) / 2.0 - 1024;
      ASSERT_NEAR(filled.at(i, j, 2), middle, 0.5);
    }
  }
}

TEST_F(TrapRepeats, AnIncompletePhaseIsNeverMixedFromTheOther) {
  // Nothing but times that differ from slice to slice, or numbers, tells the phases apart.
  for (const bool times : {true, false}) {
    std::filesystem::remove_all(folder());
    for (int phase = 0; phase < 2; ++phase) {
      for (int k = 0; k < kSlices; ++k) {
        if (phase == 0 && k == 2) continue;
        addSlice(image(phase, k, phase * kSlices + k + 1), [&](DcmDataset& data) {
          if (times) {
            put(data, DCM_AcquisitionTime, std::to_string(100000 + 100 * phase + k));
          }
        });
      }
    }
    CtFolder ct = scan();
    const SeriesReport series = ct.report().series.front();
    ASSERT_EQ(series.verdict, Verdict::refused);
    for (const Choice& choice : series.choices) {
      for (const std::string& option : choice.options) {
        ImportRequest request;
        request.answers = {{choice.code, option}};
        const auto volume = ct.read(series.uid, request, Progress());
        if (!volume.ok()) continue;
        const int phase = volume->at(0, 0, 0) == patternValue(0, 0, 0) - 1024 ? 0 : 1;
        expectPhase(*volume, phase);
      }
    }
  }
}

TEST_F(TrapRepeats, PhasesWithJitteredSteps) {
  const double zs[] = {100, 102.1, 104, 106, 108.1, 110, 112};
  for (int phase = 0; phase < 2; ++phase) {
    for (int k = 0; k < kSlices; ++k) {
      Image slice = image(phase, k, phase * kSlices + k + 1);
      slice.position_mm.z = zs[k];
      addSlice(slice, [&](DcmDataset& data) {
        put(data, DCM_TemporalPositionIdentifier, std::to_string(phase + 1));
      });
    }
  }
  const Volume volume = import({{code::kPhases, "2"}});
  ASSERT_EQ(volume.geometry.size[2], kSlices);
  ASSERT_NE(find(chosen(), "RESAMPLED_SPACING"), nullptr);
  ASSERT_NE(find(chosen(), "PHASES"), nullptr);
  for (const int k : {0, 2, 3, 5}) {  // these lie on the grid
    for (int i = 0; i < 7; ++i) {
      ASSERT_EQ(volume.at(i, 2, k), patternValue(i, 2, 100 + k) - 1024) << k;
    }
  }
  for (int i = 0; i < 7; ++i) {  // 102 mm of 100 and 102.1
    const double share = 2.0 / 2.1;
    const double hu =
        (1 - share) * patternValue(i, 2, 100) + share * patternValue(i, 2, 101) - 1024;
    ASSERT_NEAR(volume.at(i, 2, 1), hu, 0.5 + 1e-6);
  }
}

// --- Scans whose slices lie between one another ---

TEST_F(TrapRepeats, ScansThatLieBetweenOneAnotherAreAskedAboutWhateverTellsThemApart) {
  struct Case {
    const char* what;
    DcmTagKey tag;
    std::function<std::string(int phase, int k)> value;
  };
  const auto number = [](int base, int each) {
    return [=](int phase, int k) { return std::to_string(base + each * phase + k * (each > 1)); };
  };
  const std::vector<Case> cases = {
      {"acquisition", DCM_AcquisitionNumber, number(3, 1)},
      {"temporal position", DCM_TemporalPositionIdentifier, number(1, 1)},
      {"one time each", DCM_AcquisitionTime, number(101500, 1)},
      {"times", DCM_AcquisitionTime, number(100000, 100)},
      {"content times", DCM_ContentTime, number(100000, 100)},
      {"tube voltage", DCM_KVP, [](int phase, int) { return phase ? "140" : "80"; }},
      {"kernel", DCM_ConvolutionKernel, [](int phase, int) { return phase ? "B70f" : "B30f"; }},
      {"instance number", DCM_InstanceNumber, number(1, kSlices)}};
  for (const Case& one : cases) {
    for (const double shift_mm : {1.0, 0.7, 5.0}) {
      std::filesystem::remove_all(folder());
      for (int phase = 0; phase < 2; ++phase) {
        for (int k = 0; k < kSlices; ++k) {
          Image slice = image(phase, k, 1 + 2 * k + (k % 2 ? 1 - phase : phase));
          slice.position_mm.z += shift_mm * phase;
          addSlice(slice, [&](DcmDataset& data) { put(data, one.tag, one.value(phase, k)); });
        }
      }
      const std::string what = one.what + (" " + std::to_string(shift_mm));
      const CtFolder ct = scan();
      ASSERT_EQ(ct.report().series.size(), 1u) << what;
      const SeriesReport series = ct.report().series.front();
      EXPECT_EQ(series.verdict, Verdict::refused) << what;
      ASSERT_NE(find(series, "PHASES"), nullptr) << what << ": " << codes(series);
      EXPECT_NE(find(series, "PHASES")->text.find("between one another"), std::string::npos);
      EXPECT_EQ(series.choices.front().options,
                (std::vector<std::string>{"refuse", "1", "2", "all"}));
      for (int phase = 0; phase < 2; ++phase) {
        const Volume volume = import({{code::kPhases, std::to_string(phase + 1)}});
        ASSERT_EQ(volume.geometry.size, (Index3{7, 5, kSlices})) << what;
        EXPECT_NEAR(volume.geometry.origin_mm.z, 100.0 + shift_mm * phase, 1e-9) << what;
        EXPECT_NEAR(volume.geometry.spacing_mm.z, 2.0, 1e-9) << what;
        EXPECT_EQ(volume.at(2, 3, 4), patternValue(2, 3, 100 * phase + 4) - 1024) << what;
      }
      if (shift_mm != 1.0 || one.tag == DCM_KVP || one.tag == DCM_ConvolutionKernel) continue;
      EXPECT_EQ(import({{code::kPhases, "all"}}).geometry.size[2], 2 * kSlices) << what;
    }
  }
}

TEST_F(TrapRepeats, AScanThatCoversAPartOfAnotherIsAskedAboutToo) {
  for (int phase = 0; phase < 2; ++phase) {
    for (int k = phase ? 3 : 0; k < kSlices; ++k) {
      Image slice = image(phase, k, 20 * phase + k + 1);
      slice.position_mm.z += phase;
      addSlice(slice, [&](DcmDataset& data) {
        put(data, DCM_AcquisitionNumber, std::to_string(phase + 1));
      });
    }
  }
  expectRefused("PHASES");
  EXPECT_EQ(import({{code::kPhases, "1"}}).geometry.size[2], kSlices);
}

TEST_F(TrapRepeats, HoweverTheSlicesOfEachAreNumberedAndTimed) {
  constexpr int kMany = 16;
  const auto set = [](DcmDataset& data, const DcmTagKey& tag, int value) {
    put(data, tag, std::to_string(value));
  };
  std::mt19937 random(2);
  std::vector<int> shuffled(kMany);
  for (int k = 0; k < kMany; ++k) shuffled[std::size_t(k)] = k;
  std::ranges::shuffle(shuffled, random);
  using Mark = std::function<void(DcmDataset&, int phase, int k)>;
  const std::vector<std::pair<const char*, Mark>> ways = {
      {"an acquisition a rotation of four",
       [&](DcmDataset& d, int p, int k) { set(d, DCM_AcquisitionNumber, 1 + 4 * p + k / 4); }},
      {"an acquisition a slice",
       [&](DcmDataset& d, int p, int k) { set(d, DCM_AcquisitionNumber, 1 + kMany * p + k); }},
      {"a time a rotation",
       [&](DcmDataset& d, int p, int k) { set(d, DCM_AcquisitionTime, 100000 + 500 * p + k / 4); }},
      {"times in disorder",
       [&](DcmDataset& d, int p, int k) {
         set(d, DCM_ContentTime, 100000 + 500 * p + shuffled[std::size_t(k)]);
       }},
      {"there and back",
       [&](DcmDataset& d, int p, int k) {
         set(d, DCM_InstanceNumber, 1 + (p ? 2 * kMany - 1 - k : k));
       }},
      {"there and back, by time",
       [&](DcmDataset& d, int p, int k) {
         set(d, DCM_AcquisitionTime, 100000 + (p ? 2 * kMany - 1 - k : k));
       }},
      {"one says nothing",
       [&](DcmDataset& d, int p, int) {
         if (p) set(d, DCM_AcquisitionNumber, 2);
       }},
      {"a pause, in disorder", [&](DcmDataset& d, int p, int k) {
         set(d, DCM_InstanceNumber, 1 + 100 * p + shuffled[std::size_t(k)]);
       }}};
  for (const auto& [what, mark] : ways) {
    for (const double shift_mm : {1.0, 0.6}) {
      std::filesystem::remove_all(folder());
      for (int phase = 0; phase < 2; ++phase) {
        for (int k = 0; k < kMany; ++k) {
          Image slice = image(phase, k, 2 * k + phase + 1);
          slice.position_mm.z += shift_mm * phase;
          addSlice(slice, [&, m = mark](DcmDataset& data) { m(data, phase, k); });
        }
      }
      const CtFolder ct = scan();
      EXPECT_NE(find(ct.report().series.front(), "PHASES"), nullptr)
          << what << " " << shift_mm << ": " << codes(ct.report().series.front());
      EXPECT_EQ(import({{code::kPhases, "1"}}).geometry.size[2], kMany) << what;
      EXPECT_EQ(import({{code::kPhases, "2"}}).geometry.size[2], kMany) << what;
    }
  }
}

TEST_F(TrapRepeats, WhereSlicesAreMissingOrPlacesRoundedOrAThirdScanIsShort) {
  constexpr int kMany = 14;
  const auto series = [&](const std::function<double(int phase, int k)>& place_mm,
                          const std::function<bool(int phase, int k)>& wanted, int phases) {
    std::filesystem::remove_all(folder());
    for (int phase = 0; phase < phases; ++phase) {
      for (int k = 0; k < kMany; ++k) {
        if (!wanted(phase, k)) continue;
        Image slice = image(phase, k, 2 * k + phase + 1);
        slice.position_mm.z = place_mm(phase, k);
        addSlice(slice, [&](DcmDataset& data) {
          put(data, DCM_AcquisitionNumber, std::to_string(phase + 1));
        });
      }
    }
    const CtFolder ct = scan();
    const SeriesReport& found = ct.report().series.front();
    EXPECT_NE(find(found, "PHASES"), nullptr) << codes(found);
    EXPECT_EQ(found.verdict, Verdict::refused);
  };
  const auto all = [](int, int) { return true; };
  series([](int p, int k) { return 100.0 + 2.0 * k + p; },
         [](int p, int k) { return p == 0 || (k != 4 && k != 9); }, 2);
  series([](int p, int k) { return std::round(10.0 * (100.0 + 1.25 * k + 0.625 * p)) / 10.0; }, all,
         2);
  series([](int p, int k) { return 100.0 + 2.0 * k + p + 0.05 * (k % 3 - 1); }, all, 2);
  series([](int p, int k) { return 100.0 + 2.0 * k + 0.7 * p; },
         [](int p, int k) { return p < 2 || k < 4; }, 3);
  series([](int p, int k) { return 100.0 + 8.0 * k + p; }, all, 8);
  // One of wide steps among one of narrow ones.
  series([](int p, int k) { return 100.0 + (p ? 5.0 * k + 0.5 : 1.0 * k); },
         [](int p, int k) { return p == 0 || k < 4; }, 2);
}

// Two kernels of two scans: neither answer may mix the scans.
TEST_F(TrapRepeats, WhatIsToldApartIsLookedAtByTheOtherKeysAsWell) {
  for (int scan = 0; scan < 2; ++scan) {
    for (int kernel = 0; kernel < 2; ++kernel) {
      for (int k = 0; k < 12; ++k) {
        Image slice = image(2 * scan + kernel, k, 1 + k + 12 * kernel + 24 * scan);
        slice.position_mm.z += scan;
        addSlice(slice, [&](DcmDataset& data) {
          put(data, DCM_ConvolutionKernel, kernel ? "B70f" : "B30f");
          put(data, DCM_AcquisitionNumber, std::to_string(scan + 1));
        });
      }
    }
  }
  const CtFolder ct = scan();
  EXPECT_EQ(ct.report().series.front().phases, 4);
  for (const char* number : {"1", "2", "3", "4"}) {
    const Volume volume = import({{code::kPhases, number}});
    EXPECT_EQ(volume.geometry.size[2], 12);
    EXPECT_NEAR(volume.geometry.spacing_mm.z, 2.0, 1e-9);
  }
}

TEST_F(TrapRepeats, OneScanIsOneHoweverItsSlicesAreNumberedAndTimed) {
  using Mark = std::function<void(Image&, DcmDataset&, int k)>;
  constexpr int kMany = 24;
  std::vector<int> shuffled(kMany);
  for (int k = 0; k < kMany; ++k) shuffled[std::size_t(k)] = k;
  std::mt19937 random(1);
  std::ranges::shuffle(shuffled, random);
  std::vector<std::string> by_name;
  for (int k = 1; k <= kMany; ++k) by_name.push_back(std::to_string(k));
  std::ranges::sort(by_name);
  const auto set = [](DcmDataset& data, const DcmTagKey& tag, int value) {
    put(data, tag, std::to_string(value));
  };
  const std::vector<std::pair<const char*, Mark>> ways = {
      {"upwards", [&](Image&, DcmDataset& d, int k) { set(d, DCM_InstanceNumber, k + 1); }},
      {"downwards", [&](Image&, DcmDataset& d, int k) { set(d, DCM_InstanceNumber, kMany - k); }},
      {"at random",
       [&](Image&, DcmDataset& d, int k) { set(d, DCM_InstanceNumber, shuffled[std::size_t(k)]); }},
      {"by name",
       [&](Image&, DcmDataset& d, int k) {
         set(d, DCM_InstanceNumber,
             int(std::ranges::find(by_name, std::to_string(k + 1)) - by_name.begin()));
       }},
      {"fours turned round",
       [&](Image&, DcmDataset& d, int k) { set(d, DCM_InstanceNumber, k / 4 * 4 + 3 - k % 4); }},
      {"one number", [&](Image&, DcmDataset& d, int) { set(d, DCM_InstanceNumber, 1); }},
      {"an acquisition a slice",
       [&](Image&, DcmDataset& d, int k) { set(d, DCM_AcquisitionNumber, k + 1); }},
      {"an acquisition every four slices",
       [&](Image&, DcmDataset& d, int k) { set(d, DCM_AcquisitionNumber, k / 4); }},
      {"two stations",
       [&](Image&, DcmDataset& d, int k) { set(d, DCM_AcquisitionNumber, 1 + k / 12); }},
      {"stations that pass one another by a slice",
       [&](Image&, DcmDataset& d, int k) {
         set(d, DCM_AcquisitionNumber, k == 11 ? 2 : k == 12 ? 1 : 1 + k / 12);
       }},
      {"a part taken again",
       [&](Image&, DcmDataset& d, int k) { set(d, DCM_AcquisitionNumber, k / 8 == 1 ? 2 : 1); }},
      {"times at random",
       [&](Image&, DcmDataset& d, int k) {
         set(d, DCM_ContentTime, 100000 + shuffled[std::size_t(k)]);
       }},
      {"seconds of three machines",
       [&](Image&, DcmDataset& d, int k) {
         set(d, DCM_ContentTime, 100000 + shuffled[std::size_t(k)] / 5);
       }},
      {"a second every four slices",
       [&](Image&, DcmDataset& d, int k) { set(d, DCM_AcquisitionTime, 100000 + k / 4); }},
      {"times downwards",
       [&](Image&, DcmDataset& d, int k) { set(d, DCM_AcquisitionTime, 100050 - k); }},
      {"one time", [&](Image&, DcmDataset& d, int) { set(d, DCM_AcquisitionTime, 100000); }},
      {"heart beats", [&](Image&, DcmDataset& d, int k) { set(d, DCM_TriggerTime, 750 + k % 7); }},
      {"step and shoot in blocks by turns",
       [&](Image&, DcmDataset& d, int k) { set(d, DCM_TriggerTime, k / 6 % 2 ? 310 : 250); }},
      {"acquisitions in blocks by turns",
       [&](Image&, DcmDataset& d, int k) { set(d, DCM_AcquisitionNumber, 1 + k / 6 % 2); }},
      {"a position of time a slice",
       [&](Image&, DcmDataset& d, int k) { set(d, DCM_TemporalPositionIdentifier, k); }},
      {"delays in blocks",
       [&](Image&, DcmDataset& d, int k) { set(d, DCM_TriggerTime, 100 * (k / 6)); }}};
  ASSERT_GE(ways.size(), 20u);
  for (const auto& [what, mark] : ways) {
    std::filesystem::remove_all(folder());
    for (int k = 0; k < kMany; ++k) {
      Image slice = image(0, k, k + 1);
      addSlice(slice, [&, m = mark](DcmDataset& data) { m(slice, data, k); });
    }
    const CtFolder ct = scan();
    ASSERT_EQ(ct.report().series.size(), 1u) << what;
    EXPECT_EQ(ct.report().series.front().verdict, Verdict::pass)
        << what << ": " << codes(ct.report().series.front());
  }
}

TEST_F(TrapRepeats, TwoStationsThatOverlapByASliceAreNoPhases) {
  for (int k = 0; k < 5; ++k) {
    addSlice(image(0, k, k + 1), [](DcmDataset& d) { put(d, DCM_AcquisitionNumber, "1"); });
    addSlice(image(1, k + 4, k + 6), [](DcmDataset& d) { put(d, DCM_AcquisitionNumber, "2"); });
  }
  EXPECT_EQ(expectRefused("DUPLICATE_POSITIONS").slices, std::vector<std::string>{"108.00 mm"});
  for (const int phase : {0, 1}) {
    const Volume volume = import({{code::kDuplicatePositions, phase ? "last" : "first"}});
    ASSERT_EQ(volume.geometry.size[2], 9);
    for (int k = 0; k < 9; ++k) {
      const int of = k < 4 ? 0 : k > 4 ? 1 : phase;
      for (int i = 0; i < 7; ++i) {
        ASSERT_EQ(volume.at(i, 2, k), patternValue(i, 2, 100 * of + k) - 1024) << k;
      }
    }
  }
}

TEST_F(TrapRepeats, AnEqualSliceUnderANewNameIsDropped) {
  for (int k = 0; k < kSlices; ++k) addSlice(image(0, k, k + 1));
  for (const int k : {0, 3}) addSlice(image(0, k, 20 + k));
  expectPhase(import(), 0);
  EXPECT_EQ(chosen().verdict, Verdict::pass);
  ASSERT_NE(find(chosen(), "DUPLICATE_FILES"), nullptr);
  EXPECT_EQ(find(chosen(), "DUPLICATE_FILES")->severity, Severity::notice);
}

TEST_F(TrapRepeats, ASeriesThatWasSentTwiceUnderNewNamesIsOneSeries) {
  for (int k = 0; k < kSlices; ++k) {
    addSlice(image(0, k, k + 1));
    addSlice(image(0, k, 20 + k));
  }
  expectPhase(import(), 0);
  EXPECT_EQ(chosen().phases, 1);
}

TEST_F(TrapRepeats, EqualWordsWithAnotherInterceptAreNotEqualSlices) {
  for (int k = 0; k < kSlices; ++k) addSlice(image(0, k, k + 1));
  addSlice(image(0, 3, 20), [](DcmDataset& data) { put(data, DCM_RescaleIntercept, "-1000"); });
  expectRefused("DUPLICATE_POSITIONS");
}

TEST_F(TrapRepeats, ADifferentSliceAtOnePlaceAsksWhich) {
  for (int k = 0; k < kSlices; ++k) addSlice(image(0, k, 10 + k));
  addSlice(image(7, 3, 9));  // of a smaller number: acquired first
  EXPECT_EQ(expectRefused("DUPLICATE_POSITIONS").slices, std::vector<std::string>{"106.00 mm"});
  for (const bool first : {true, false}) {
    const Volume volume = import({{code::kDuplicatePositions, first ? "first" : "last"}});
    ASSERT_EQ(volume.geometry.size[2], kSlices);
    for (int k = 0; k < kSlices; ++k) {
      const int pattern = first && k == 3 ? 703 : k;
      for (int i = 0; i < 7; ++i) {
        ASSERT_EQ(volume.at(i, 4, k), patternValue(i, 4, pattern) - 1024) << k << first;
      }
    }
    EXPECT_EQ(chosen().verdict, Verdict::repaired);
  }
}

TEST_F(TrapRepeats, AWholeSliceIsTakenRatherThanACutOneAtItsPlace) {
  for (int k = 0; k < kSlices; ++k) addSlice(image(0, k, k + 1));
  addSlice(image(0, 3, 20));
  const auto name = folder() / std::to_string(8 * 7919 % 1000).append("_8");
  ASSERT_TRUE(std::filesystem::exists(name));
  std::filesystem::resize_file(name, std::filesystem::file_size(name) - 8);
  const SeriesReport series = scan().report().series.front();
  if (series.verdict == Verdict::refused) {  // asking is right too, mixing is not
    ASSERT_NE(find(series, "DUPLICATE_POSITIONS"), nullptr);
    expectPhase(import({{code::kDuplicatePositions, "first"}}), 0);
  } else {
    expectPhase(import(), 0);
  }
}

}  // namespace trephine::test
