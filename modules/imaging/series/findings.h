// Noting what is found about a series while its headers are looked at.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "imaging/common/text.h"
#include "imaging/series/series.h"

namespace trephine {

class Findings {
 public:
  explicit Findings(Series& series) : series_(series) {}

  void refuse(const char* code, std::string text, std::string action,
              std::vector<std::string> slices = {}) {
    series_.report.findings.push_back(
        {code, "refusal", std::move(text), std::move(slices), std::move(action)});
  }
  void repaired(const char* code, std::string text, std::string action,
                std::vector<std::string> slices = {}) {
    series_.report.findings.push_back(
        {code, "repair", std::move(text), std::move(slices), std::move(action)});
  }
  void notice(const char* code, std::string text, std::string action,
              std::vector<std::string> slices = {}) {
    series_.report.findings.push_back(
        {code, "notice", std::move(text), std::move(slices), std::move(action)});
  }
  // The names of all slices that `test` holds for.
  template <class Test>
  std::vector<std::string> slicesWhere(Test test) const {
    std::vector<std::string> names;
    for (const DicomHeader& header : series_.slices) {
      if (test(header)) names.push_back(sliceName(header));
    }
    return names;
  }

 private:
  Series& series_;
};

inline std::string countOfSlices(const std::vector<std::string>& slices,
                                 std::string_view one_does = "", std::string_view many_do = "") {
  return counted(slices.size(), "slice", one_does, many_do);
}

}  // namespace trephine
