#include "imaging/series/detail/series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "imaging/series/detail/series_repeats.h"

namespace trephine {

namespace {

template <std::size_t kCount>
bool near(const std::optional<std::array<double, kCount>>& a,
          const std::optional<std::array<double, kCount>>& b, double tolerance) {
  if (!a || !b) return a.has_value() == b.has_value();
  for (std::size_t i = 0; i < kCount; ++i) {
    if (!(std::abs((*a)[i] - (*b)[i]) <= tolerance)) return false;
  }
  return true;
}

// By ID and birth date.
bool isSamePerson(const DicomHeader& a, const DicomHeader& b) {
  constexpr std::size_t kId = 1, kBirth = 2;
  return !a.patient[kId].empty() && a.patient[kId] == b.patient[kId] &&
         !a.patient[kBirth].empty() && a.patient[kBirth] == b.patient[kBirth];
}

}  // namespace

const char* otherPatient(const DicomHeader& a, const DicomHeader& b) {
  constexpr const char* kNames[] = {"patient's name", "patient's ID",
                                    trLater("patient's birth date"), "patient's sex"};
  constexpr std::size_t kName = 0, kSex = 3;  // half of all have the sex in common
  bool common = std::equal(a.patient.begin(), a.patient.begin() + kSex, b.patient.begin());
  for (std::size_t n = 0; n < a.patient.size(); ++n) {
    if (a.patient[n].empty() || b.patient[n].empty() || (n == kName && isSamePerson(a, b))) continue;
    if (a.patient[n] != b.patient[n]) return kNames[n];
    common |= n != kSex;
  }
  return common ? nullptr : "patient";
}

namespace {

// Why two slices of one Series UID cannot lie in one stack; null where they can. Spacings and
// cosines may differ by what a writer makes of one scan; parts() has the finer look.
const char* difference(const DicomHeader& a, const DicomHeader& b) {
  if (const char* what = otherPatient(a, b)) return what;
  if (a.modality != b.modality) return "modality";
  if (a.sop_class != b.sop_class) return trLater("kind of image");
  if (isLocalizer(a) != isLocalizer(b)) return trLater("being a localizer");
  if (a.rows != b.rows || a.columns != b.columns) return "size";
  if (!near(a.pixel_spacing_mm, b.pixel_spacing_mm, 1e-3)) return trLater("pixel spacing");
  if (!near(a.orientation, b.orientation, 2.1e-3)) return "orientation";
  if (a.photometric != b.photometric) return trLater("photometric interpretation");
  if (a.samples != b.samples) return "samples";
  return nullptr;
}

// Whether two slices were acquired on two days, other than by a scan that goes on past midnight.
bool onOtherDays(const DicomHeader& a, const DicomHeader& b) {
  if (a.acquired.size() != 8 || b.acquired.size() != 8 || a.acquired == b.acquired) return false;
  // Seconds of the day, of HHMMSS alone or after a date.
  const auto seconds = [](const DicomHeader& h) -> std::optional<double> {
    const std::optional<double>& time = h.phase[kAcquisitionTime];
    if (!time || *time < 0.0 || *time > 1e15) return std::nullopt;
    const auto clock = std::int64_t(std::fmod(*time, 1e6));
    return double(clock / 10000) * 3600.0 + double(clock / 100 % 100) * 60.0 + double(clock % 100);
  };
  const DicomHeader& before = a.acquired < b.acquired ? a : b;
  const DicomHeader& after = a.acquired < b.acquired ? b : a;
  const auto late = seconds(before), early = seconds(after);
  constexpr double kDay_s = 86400.0, kLongest_s = 3600.0;
  return !late || !early || kDay_s - *late + *early > kLongest_s;
}

// What two slices that could lie in one stack differ in, beyond what rounding explains.
std::vector<std::string> smallDifferences(const DicomHeader& a, const DicomHeader& b) {
  std::vector<std::string> all;
  if (a.study_uid != b.study_uid) all.push_back("study");
  if (a.frame_of_reference != b.frame_of_reference) all.push_back(tr("frame of reference"));
  if (!near(a.pixel_spacing_mm, b.pixel_spacing_mm, 1e-4)) all.push_back(tr("pixel spacing"));
  if (!near(a.orientation, b.orientation, 1e-4)) all.push_back("orientation");
  if (onOtherDays(a, b)) all.push_back(tr("day of the scan"));
  return all;
}

bool agree(const DicomHeader& a, const DicomHeader& b) {
  return a.study_uid == b.study_uid && a.frame_of_reference == b.frame_of_reference &&
         near(a.pixel_spacing_mm, b.pixel_spacing_mm, 1e-4) &&
         near(a.orientation, b.orientation, 1e-4) && !onOtherDays(a, b);
}

// Numbers the parts of what could be one stack, from the largest down.
void markParts(Series& series) {
  std::vector<const DicomHeader*> firsts;
  std::vector<int> counts;
  std::vector<int> of(series.slices.size());
  for (std::size_t n = 0; n < series.slices.size(); ++n) {
    const DicomHeader& header = series.slices[n];
    std::size_t part = 0;
    while (part < firsts.size() && !agree(*firsts[part], header)) ++part;
    if (part == firsts.size()) {
      firsts.push_back(&header);
      counts.push_back(0);
    }
    of[n] = int(part);
    ++counts[part];
  }
  for (std::size_t part = 1; part < firsts.size(); ++part) {
    for (std::string& what : smallDifferences(*firsts.front(), *firsts[part])) {
      if (std::ranges::find(series.parted_by, what) == series.parted_by.end()) {
        series.parted_by.push_back(std::move(what));
      }
    }
  }
  std::vector<int> by_size(counts.size());
  std::iota(by_size.begin(), by_size.end(), 0);
  std::ranges::stable_sort(by_size, std::greater(), [&](int part) { return counts[std::size_t(part)]; });
  std::vector<int> number(counts.size());
  for (std::size_t n = 0; n < by_size.size(); ++n) number[std::size_t(by_size[n])] = int(n);
  for (std::size_t n = 0; n < of.size(); ++n) {
    series.slices[n].part = number[std::size_t(of[n])];
  }
}

bool sameBytes(const DicomHeader& a, const DicomHeader& b, const Progress& progress) {
  if (a.file_bytes != b.file_bytes) return false;
  std::ifstream file_a(a.file, std::ios::binary), file_b(b.file, std::ios::binary);
  std::vector<char> block_a(1 << 16), block_b(1 << 16);
  while (file_a && file_b) {
    if (progress.cancelled()) return false;
    file_a.read(block_a.data(), std::streamsize(block_a.size()));
    file_b.read(block_b.data(), std::streamsize(block_b.size()));
    const std::streamsize count = file_a.gcount();
    if (count != file_b.gcount()) return false;
    if (!std::equal(block_a.begin(), block_a.begin() + count, block_b.begin())) return false;
  }
  return file_a.eof() && file_b.eof();
}

// Keeps one of each set of equal files, and prefers a whole file to a cut copy of it.
void dropDuplicates(Series& series, const Progress& progress) {
  std::vector<DicomHeader> kept;
  std::map<std::pair<std::filesystem::path, std::filesystem::path>, bool> compared;  // of frames
  const auto equal = [&](const DicomHeader& a, const DicomHeader& b) {
    const auto [it, first_time] = compared.try_emplace({a.file, b.file}, false);
    if (first_time) it->second = sameBytes(a, b, progress);
    return it->second;
  };
  const auto image = [](const DicomHeader& h) { return std::tie(h.sop_instance, h.frame); };
  Finding dropped{code::kDuplicateFiles, Severity::notice, "", {}, tr("One copy of each was kept")};
  Finding different{
      code::kDuplicateInstances, Severity::notice, "", {}, tr("Both were kept; places decide")};
  std::ranges::stable_sort(series.slices, {}, image);
  for (DicomHeader& header : series.slices) {
    const auto first = std::ranges::lower_bound(kept, image(header), {}, image);
    if (first == kept.end() || image(*first) != image(header)) {
      kept.push_back(std::move(header));
      continue;
    }
    const bool one_cut = (first->defect == Defect::cut) != (header.defect == Defect::cut);
    if (one_cut || equal(*first, header)) {
      dropped.slices.push_back(sliceName(header));
      if (first->defect == Defect::cut) *first = std::move(header);
    } else {
      different.slices.push_back(sliceName(header));
      kept.push_back(std::move(header));
    }
  }
  series.slices = std::move(kept);
  if (!dropped.slices.empty()) {
    const std::size_t count = dropped.slices.size();
    dropped.text = trCount(count, "{} file is a copy of another", "{} files are copies of others");
    series.report.findings.push_back(std::move(dropped));
  }
  if (!different.slices.empty()) {
    const std::size_t count = different.slices.size();
    different.text = trCount(count, "{} file claims to be another file's image but differs from it",
                             "{} files claim to be another file's image but differ from it");
    series.report.findings.push_back(std::move(different));
  }
}

// The parts of one Series UID, largest first, and what they differ in.
std::vector<Series> splitSeries(std::vector<DicomHeader> headers) {
  std::vector<Series> parts;
  std::vector<DicomHeader> headless;  // cut before their pixels: they go with the largest part
  std::vector<std::string> reasons;
  for (DicomHeader& header : headers) {
    // A CT image without pixels is one that was cut between two elements.
    if (!header.has_pixels && (header.defect == Defect::cut || isCt(header))) {
      headless.push_back(std::move(header));
      continue;
    }
    Series* home = nullptr;
    const char* reason = nullptr;
    for (Series& part : parts) {
      reason = difference(part.slices.front(), header);
      if (!reason) home = &part;
      if (home) break;
    }
    if (!home) {
      if (reason && std::ranges::find(reasons, tr(reason)) == reasons.end()) {
        reasons.push_back(tr(reason));
      }
      home = &parts.emplace_back();
    }
    home->slices.push_back(std::move(header));
  }
  if (parts.empty()) parts.emplace_back();
  std::ranges::stable_sort(parts, std::greater(), [](const Series& s) { return s.slices.size(); });
  for (Series& part : parts) markParts(part);
  std::size_t images = headless.size();
  for (const Series& part : parts) images += part.slices.size();
  for (DicomHeader& header : headless) parts.front().slices.push_back(std::move(header));
  if (parts.size() == 1) return parts;
  for (Series& part : parts) {
    if (!isCt(part.slices.front())) continue;
    part.report.findings.push_back(
        {code::kSeriesSplit,
         Severity::repair,
         tr("This is a part of a series: {} of its {} images. Its {} parts differ in {}",
            part.slices.size(), images, parts.size(), listed(reasons)),
         {},
         tr("The others were left out of it; each part is listed on its own")});
  }
  return parts;
}

}  // namespace

bool isCt(const DicomHeader& header) {
  return header.sop_class.starts_with("1.2.840.10008.5.1.4.1.1.2.") ||
         header.sop_class == "1.2.840.10008.5.1.4.1.1.2";
}

bool isLocalizer(const DicomHeader& header) {
  return std::ranges::find(header.image_type, "LOCALIZER") != header.image_type.end();
}

std::string sliceName(const DicomHeader& header) {
  // A number only: whatever else stands there could be a name.
  const auto number = parseInteger(header.instance_number);
  return number ? tr("slice {}", *number) : tr("a slice without number");
}

Verdict verdictOf(const std::vector<Finding>& findings) {
  const auto any = [&](Severity severity) {
    return std::ranges::any_of(findings, [&](const Finding& f) { return f.severity == severity; });
  };
  return any(Severity::refusal)  ? Verdict::refused
         : any(Severity::repair) ? Verdict::repaired
                                 : Verdict::pass;
}

void assignVerdict(Series& series) {
  std::vector<Finding>& findings = series.report.findings;
  series.report.verdict = verdictOf(findings);
  if (series.report.verdict != Verdict::refused) return;
  for (std::size_t n = series.findings_kept; n < findings.size(); ++n) {
    if (findings[n].severity == Severity::repair) findings[n].action.clear();
  }
}

std::vector<Series> groupSeries(std::vector<DicomHeader> headers, const Progress& progress) {
  // Numbered in order of UIDs, which no file name or folder order can change.
  std::map<std::array<std::string, 2>, std::vector<DicomHeader>> groups;
  for (DicomHeader& header : headers) {
    groups[{header.series_uid, header.series_key}].push_back(std::move(header));
  }
  std::vector<Series> all;
  std::map<std::string, int> parts_of_uid;  // of an emptied one there may be several series
  for (auto& [uids, group] : groups) {
    for (Series& series : splitSeries(std::move(group))) {
      const int number = ++parts_of_uid[uids[0]];
      series.report.uid = uids[0];
      if (number > 1) series.report.uid += "#" + std::to_string(number);
      if (!uids[1].empty()) {
        series.report.findings.push_back(
            {code::kNoSeriesUid,
             Severity::notice,
             tr("The files name no series: their Series Instance UID was emptied"),
             {},
             tr("Slices of one study, series number, date and time were taken together")});
      }
      dropDuplicates(series, progress);
      dropEqualRepeats(series, progress);
      series.findings_kept = series.report.findings.size();
      assessSeries(series);
      all.push_back(std::move(series));
    }
  }
  return all;
}

}  // namespace trephine
