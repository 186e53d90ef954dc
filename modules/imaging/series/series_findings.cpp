#include "imaging/series/detail/series_findings.h"

#include <algorithm>
#include <set>
#include <utility>

#include "base/codes.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "imaging/report/answers.h"

namespace trephine {

void keepFinding(Series& series, Finding finding) {
  auto& findings = series.report.findings;
  // Answers that cannot save the series are not asked for.
  if (finding.severity == Severity::refusal) series.report.choices.clear();
  findings.insert(findings.begin() + std::ptrdiff_t(series.findings_kept++), std::move(finding));
  series.report.verdict = verdictOf(findings);
}

std::optional<Error> folderError(const ImportReport& report) {
  const auto is_ct = [](const SeriesReport& s) { return s.modality == "CT"; };
  if (report.files_seen == 0 && !report.skipped.empty()) {
    const SkippedFiles& first = report.skipped.front();
    return Error{
        code::kUnreadable,
        trCount(std::uint64_t(first.count), "There is no file that can be read; {} was skipped: {}",
                "There is no file that can be read; {} were skipped: {}", first.reason),
        report.path,
        tr("Choose the folder that holds the CT; where you have no right to read it, ask "
           "for that")};
  }
  if (report.files_seen == 0) {
    return Error{code::kEmptyFolder, tr("The folder holds no files"), report.path,
                 tr("Choose another folder")};
  }
  if (std::ranges::none_of(report.series, is_ct)) {
    std::string what = report.files_seen == 1 ? tr("The only file is no CT series")
                                              : trCount(std::uint64_t(report.files_seen),
                                                        "There is no CT series among the {} file",
                                                        "There is no CT series among the {} files");
    const auto isPacked = [](const SkippedFiles& s) { return s.packed; };
    auto most = std::ranges::find_if(report.skipped, isPacked);
    const bool packed = most != report.skipped.end();
    if (!packed) most = std::ranges::max_element(report.skipped, {}, &SkippedFiles::count);
    // A volume file that cannot be read says more than what was skipped.
    const auto isFile = [](const SeriesReport& s) { return s.source == "file"; };
    if (std::ranges::count_if(report.series, isFile) == 1) {
      const SeriesReport& one = *std::ranges::find_if(report.series, isFile);
      const Finding& why = *std::ranges::find(one.findings, Severity::refusal, &Finding::severity);
      return Error{code::kNoCt, tr("The only volume file cannot be used: {}", why.text),
                   report.path, why.action};
    }
    if (most != report.skipped.end()) {
      what += trCount(std::uint64_t(most->count), "; {} was skipped: {}", "; {} were skipped: {}",
                      most->reason);
    }
    return Error{code::kNoCt, what, report.path,
                 packed ? tr("Unpack it, and choose the folder that then holds the CT")
                        : tr("Choose the folder that holds the CT")};
  }
  const SeriesReport* largest = nullptr;
  for (const SeriesReport& series : report.series) {
    if (!is_ct(series)) continue;
    if (series.verdict != Verdict::refused) return std::nullopt;
    if (!largest || series.geometry.size[2] > largest->geometry.size[2]) largest = &series;
  }
  const auto refusal = std::ranges::find(largest->findings, Severity::refusal, &Finding::severity);
  const bool only = std::ranges::count_if(report.series, is_ct) == 1;
  return Error{code::kAllRefused,
               (only ? tr("The CT series cannot be used: ")
                     : tr("No CT series can be used; of the largest: ")) +
                   refusal->text,
               report.path, refusal->action};
}

void addValueFindings(const HuCounts& counts, SeriesReport& report) {
  const auto add = [&](Code code, Severity severity, std::uint64_t voxels, const std::string& text,
                       const std::string& action) {
    if (voxels > 0) report.findings.push_back({code, severity, text, {}, action});
  };
  add(code::kPaddingToAir, Severity::notice, counts.padding,
      trCount(counts.padding, "{} voxel of padding", "{} voxels of padding"),
      tr("Padding became air"));
  add(code::kHuRounded, Severity::repair, counts.rounded,
      trCount(counts.rounded, "{} voxel had HU that are not whole numbers",
              "{} voxels had HU that are not whole numbers"),
      tr("Rounded to the nearest"));
  add(code::kHuClamped, Severity::repair, counts.clamped,
      trCount(counts.clamped, "{} voxel had HU outside -32768..32767",
              "{} voxels had HU outside -32768..32767"),
      tr("Set to the nearest limit"));
}

void askAboutHighBits(const DicomHeader& slice, const Answers& answers, SeriesReport& report) {
  const std::string bits = std::to_string(slice.format.bits_stored);
  const std::string text =
      tr("The header says {} bits a pixel, and the pixels have more bits than that, which no "
         "overlay explains",
         bits);
  const std::string answer =
      ask({code::kHighBits,
           tr("The pixels have more bits than the header says. Are these a part of the values?"),
           {"refuse", "use", "mask"},
           {tr("Do not use the series"), tr("They are: take all bits"),
            tr("They are none: take {} bits, as the header says", bits)}},
          answers, report.choices);
  report.findings.push_back(
      {code::kHighBits,
       answer == "refuse" ? Severity::refusal : Severity::repair,
       text,
       {},
       answer == "use" ? tr("All bits were taken, as was chosen")
       : answer == "mask"
           ? tr("The others were left out, as was chosen")
           : tr("Look at the slices: with the wrong answer bright tissue turns dark")});
}

bool hasFinding(const SeriesReport& series, Code code) {
  return std::ranges::find(series.findings, code, &Finding::code) != series.findings.end();
}

bool looksLikeLabels(const SeriesReport& series) {
  return hasFinding(series, code::kLabelMap) || hasFinding(series, code::kNamedAsLabels);
}

void sayWhatLabelsAreFor(SeriesReport& series) {
  for (Finding& finding : series.findings) {
    if (finding.code != code::kLabelMap && finding.code != code::kNamedAsLabels) continue;
    finding.action =
        tr("Import the CT beside it: this file can be opened with it, as its label map");
  }
}

// Its slices may lie among what was not looked at; where some of that lies beside them, they most
// probably do.
void addStoppedScan(const ScannedFiles& files, Series& series) {
  const int left = files.not_looked_at;
  const bool beside = std::ranges::any_of(series.slices, [&](const DicomHeader& slice) {
    return files.folders_left.contains(slice.file.parent_path());
  });
  keepFinding(series, {code::kScanStopped,
                       beside ? Severity::refusal : Severity::repair,
                       trCount(std::uint64_t(left),
                               "{} file was not looked at, since the search was ended early: {}",
                               "{} files were not looked at, since the search was ended early: {}",
                               (beside ? tr("the rest of this series is probably among them")
                                       : tr("slices of this series may be among them"))),
                       {},
                       tr("Open the folder again and let the search come to its end")});
}

// Beside its files some are empty: slices that were not copied, perhaps. A gap that they leave is
// asked about; at an end they leave none.
void addEmptyFiles(const ScannedFiles& files, Series& series) {
  std::set<std::filesystem::path> folders;
  for (const DicomHeader& slice : series.slices) folders.insert(slice.file.parent_path());
  int empty = 0;
  for (const std::filesystem::path& folder : folders) {
    const auto beside = files.empty_files.find(folder);
    if (beside != files.empty_files.end()) empty += beside->second;
  }
  if (empty == 0) return;
  keepFinding(
      series,
      {code::kIncomplete,
       Severity::notice,
       trCount(std::uint64_t(empty),
               "{} file lies beside its slices that is empty or cut short: a slice, perhaps, that "
               "was not copied to its end",
               "{} files lie beside its slices that are empty or cut short: slices, perhaps, that "
               "were not copied to their end"),
       {},
       tr("Copy all files of the series again if the scan ends too early")});
}

void saySeveral(std::vector<Series>& all) {
  std::vector<Series*> scans;
  for (Series& series : all) {
    const bool scan = !series.slices.empty() && isCt(series.slices.front()) &&
                      !isLocalizer(series.slices.front());
    if (scan) scans.push_back(&series);
  }
  std::vector<const DicomHeader*> patients;
  std::vector<std::size_t> patient_of;
  std::set<std::string> days;
  for (const Series* series : scans) {
    const DicomHeader& one = series->slices.front();
    const auto known = std::ranges::find_if(
        patients, [&](const DicomHeader* other) { return otherPatient(*other, one) == nullptr; });
    patient_of.push_back(std::size_t(known - patients.begin()));
    if (known == patients.end()) patients.push_back(&one);
    if (!one.acquired.empty()) days.insert(one.acquired);
  }
  const auto say = [](Series& series, Code code, const std::string& what, std::size_t number) {
    keepFinding(series,
                {code,
                 Severity::notice,
                 tr("The folder holds CT of {}: this one is of number {}", what, number + 1),
                 {},
                 tr("Make sure that it is the one that is wanted")});
  };
  for (std::size_t n = 0; n < scans.size(); ++n) {
    if (patients.size() > 1)
      say(*scans[n], code::kPatients, trCount(patients.size(), "{} patient", "{} patients"),
          patient_of[n]);
    const auto day = days.find(scans[n]->slices.front().acquired);
    if (patients.size() > 1 || days.size() < 2 || day == days.end()) continue;
    say(*scans[n], code::kDays, trCount(days.size(), "{} day", "{} days"),
        std::size_t(std::distance(days.begin(), day)));
  }
}

Error refuseVanished(SeriesReport& series) {
  series.findings.push_back({code::kSourceVanished,
                             Severity::refusal,
                             tr("The source vanished while it was read"),
                             {},
                             tr("Plug it in or connect it again, then open the folder again")});
  series.verdict = Verdict::refused;
  const Finding& finding = series.findings.back();
  return Error{finding.code, finding.text, cleanUtf8(series.description), finding.action};
}

}  // namespace trephine
