// Noting what is found about a series while its headers are looked at.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "imaging/common/detail/text.h"
#include "imaging/series/detail/series.h"

namespace trephine {

class Findings {
 public:
  explicit Findings(Series& series) : series_(series) {}

  void refuse(Code code, std::string text, std::string action,
              std::vector<std::string> slices = {}) {
    series_.report.findings.push_back(
        {code, Severity::refusal, std::move(text), std::move(slices), std::move(action)});
  }
  void repaired(Code code, std::string text, std::string action,
                std::vector<std::string> slices = {}) {
    series_.report.findings.push_back(
        {code, Severity::repair, std::move(text), std::move(slices), std::move(action)});
  }
  void notice(Code code, std::string text, std::string action,
              std::vector<std::string> slices = {}) {
    series_.report.findings.push_back(
        {code, Severity::notice, std::move(text), std::move(slices), std::move(action)});
  }
  // Asks whether the series shall be used in spite of what was found (the second option): then it
  // is a repair, else a refusal.
  void askConsent(Choice choice, const Answers& answers, std::string text, std::string done,
                  std::string to_do, std::vector<std::string> slices = {}) {
    const Code code = choice.code;
    const std::string agreed = choice.options[1];
    if (ask(std::move(choice), answers, series_.report.choices) == agreed) {
      repaired(code, std::move(text), std::move(done), std::move(slices));
    } else {
      refuse(code, std::move(text), std::move(to_do), std::move(slices));
    }
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

}  // namespace trephine
