#pragma once

#include "imaging/codes.h"
#include "imaging/importer.h"

namespace trephine::test {

// What a scan might report of a series; nothing of it is read from files.
inline SeriesReport fakeSeries(const std::string& uid, Verdict verdict, int slices = 100) {
  SeriesReport series;
  series.uid = uid;
  series.description = "Series " + uid;
  series.modality = "CT";
  series.verdict = verdict;
  series.slices = slices;
  series.geometry.size = {64, 48, slices};
  series.geometry.spacing_mm = {0.5, 0.75, 2.0};
  return series;
}

inline Choice missingSlices() {
  return {code::kMissingSlices,
          "Two slices are missing. Fill them?",
          {"refuse", "fill"},
          {"Do not use the series", "Fill them from their neighbours"}};
}

inline Choice couch() {
  return {code::kCouch, "Remove the couch?", {"keep", "remove"}, {"Keep it", "Make it air"}};
}

inline SeriesReport askingSeries(const std::string& uid) {
  SeriesReport series = fakeSeries(uid, Verdict::refused);
  series.findings.push_back(
      {code::kMissingSlices, Severity::refusal, "Two slices are missing", {"3.0"}, ""});
  series.choices.push_back(missingSlices());
  return series;
}

}  // namespace trephine::test
