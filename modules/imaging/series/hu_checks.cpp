#include "imaging/series/detail/hu_checks.h"

#include <algorithm>

#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "imaging/series/detail/series_geometry.h"

namespace trephine {

namespace {

bool hasPadding(const SeriesReport& report) {
  return std::ranges::find(report.findings, code::kPaddingToAir, &Finding::code) !=
         report.findings.end();
}

}  // namespace

void checkHu(const HuSanityCheck& look, const Answers& answers, SeriesReport& report) {
  const std::vector<std::string> doubts =
      look.doubts(report.hu_min.value_or(0), report.hu_max.value_or(0));
  if (!doubts.empty()) {
    const std::string text = tr("The values can hardly be HU: {}", listed(doubts));
    const std::string answer =
        ask({code::kImplausibleHu,
             tr("The values can hardly be HU. Use them all the same?"),
             {"refuse", "accept"},
             {tr("Do not use the series"), tr("Take them as HU: what looks and cuts like air, "
                                              "tissue or bone may be something else")}},
            answers, report.choices);
    if (answer == "accept") {
      report.findings.push_back({code::kImplausibleHu,
                                 Severity::repair,
                                 text,
                                 {},
                                 tr("They were taken as HU, as was agreed")});
    } else {
      report.findings.push_back(
          {code::kImplausibleHu,
           Severity::refusal,
           text,
           {},
           tr("Export the series again with its rescale, or agree to use it")});
    }
  } else if (!look.hasAir()) {
    report.findings.push_back(
        {code::kNoAir,
         Severity::notice,
         tr("{}. It is small or cropped, or these are stored values and not HU",
            (hasPadding(report)
                 ? tr("Hardly anything in it but padding lies where air does")
                 : tr("Hardly anything in it lies where air does; the smallest value is {}",
                      report.hu_min.value_or(0)))),
         {},
         tr("Nothing was changed; if bone and air look wrong, export it again with its rescale")});
  }
}

void sayPadding(const UnnamedPadding& padding, SeriesReport& report) {
  if (padding.voxels == 0) return;
  report.findings.push_back(
      {code::kPaddingToAir,
       Severity::notice,
       trCount(padding.voxels,
               "{} voxel had {} HU, which nothing in a patient has: the space around the scan",
               "{} voxels had {} HU, which nothing in a patient has: the space around the scan",
               padding.hu),
       {},
       tr("They became air")});
}

bool refusedByHu(const SeriesReport& report, const Answers& answers) {
  if (std::ranges::find(report.choices, code::kImplausibleHu, &Choice::code) ==
      report.choices.end()) {
    return false;
  }
  const auto answer = answers.find(code::kImplausibleHu);
  return answer == answers.end() || answer->second != "accept";
}

}  // namespace trephine
