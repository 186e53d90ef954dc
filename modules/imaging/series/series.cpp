#include "imaging/series/series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <tuple>
#include <utility>

#include "imaging/common/text.h"
#include "imaging/series/series_repeats.h"

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

// Why two slices of one Series UID cannot lie in one stack; null where they can. The tolerances
// allow for cosines and spacings that a writer rounded differently from slice to slice.
const char* difference(const DicomHeader& a, const DicomHeader& b) {
  if (a.sop_class != b.sop_class) return "kind of image";
  if (isLocalizer(a) != isLocalizer(b)) return "localizer";
  if (a.rows != b.rows || a.columns != b.columns) return "size";
  if (!near(a.pixel_spacing_mm, b.pixel_spacing_mm, 1e-4)) return "pixel spacing";
  if (!near(a.orientation, b.orientation, 1e-4)) return "orientation";
  if (a.photometric != b.photometric) return "photometric interpretation";
  if (a.samples != b.samples) return "samples";
  if (a.frame_of_reference != b.frame_of_reference) return "frame of reference";
  return nullptr;
}

bool sameBytes(const DicomHeader& a, const DicomHeader& b) {
  if (a.file_bytes != b.file_bytes) return false;
  std::ifstream file_a(a.file, std::ios::binary), file_b(b.file, std::ios::binary);
  std::vector<char> block_a(1 << 16), block_b(1 << 16);
  while (file_a && file_b) {
    file_a.read(block_a.data(), std::streamsize(block_a.size()));
    file_b.read(block_b.data(), std::streamsize(block_b.size()));
    const std::streamsize count = file_a.gcount();
    if (count != file_b.gcount()) return false;
    if (!std::equal(block_a.begin(), block_a.begin() + count, block_b.begin())) return false;
  }
  return file_a.eof() && file_b.eof();
}

// Keeps one of each set of equal files, and prefers a whole file to a cut copy of it.
void dropDuplicates(Series& series) {
  std::vector<DicomHeader> kept;
  std::map<std::pair<std::filesystem::path, std::filesystem::path>, bool> compared;  // of frames
  const auto equal = [&](const DicomHeader& a, const DicomHeader& b) {
    const auto [it, first_time] = compared.try_emplace({a.file, b.file}, false);
    if (first_time) it->second = sameBytes(a, b);
    return it->second;
  };
  const auto image = [](const DicomHeader& h) { return std::tie(h.sop_instance, h.frame); };
  Finding dropped{"DUPLICATE_FILES", "notice", "", {}, "One copy of each was kept"};
  Finding different{"DUPLICATE_INSTANCES", "notice", "", {}, "Both were kept; places decide"};
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
    dropped.text = count == 1 ? "1 file is a copy of another"
                              : std::to_string(count) + " files are copies of others";
    series.report.findings.push_back(std::move(dropped));
  }
  if (!different.slices.empty()) {
    const std::size_t count = different.slices.size();
    different.text = std::to_string(count) + (count == 1 ? " file claims" : " files claim") +
                     " to be another file's image but " + (count == 1 ? "differs" : "differ") +
                     " from it";
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
      if (reason && std::ranges::find(reasons, reason) == reasons.end()) reasons.push_back(reason);
      home = &parts.emplace_back();
    }
    home->slices.push_back(std::move(header));
  }
  if (parts.empty()) parts.emplace_back();
  std::ranges::stable_sort(parts, std::greater(), [](const Series& s) { return s.slices.size(); });
  for (DicomHeader& header : headless) parts.front().slices.push_back(std::move(header));

  std::string text;
  for (const std::string& reason : reasons) {
    if (!text.empty()) text += ", ";
    text += reason;
  }
  if (parts.size() == 1) return parts;
  for (Series& part : parts) {
    part.report.findings.push_back({"SERIES_SPLIT",
                                    "notice",
                                    "The series was split into " + std::to_string(parts.size()) +
                                        " parts that differ in " + text,
                                    {},
                                    "Each part is listed on its own"});
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
  return number ? "slice " + std::to_string(*number) : "a slice without number";
}

Verdict verdictOf(const std::vector<Finding>& findings) {
  const auto any = [&](const char* severity) {
    return std::ranges::any_of(findings, [&](const Finding& f) { return f.severity == severity; });
  };
  return any("refusal") ? Verdict::refused : any("repair") ? Verdict::repaired : Verdict::pass;
}

std::vector<Series> groupSeries(std::vector<DicomHeader> headers) {
  // Numbered in order of UIDs, which no file name or folder order can change.
  std::map<std::array<std::string, 3>, std::vector<DicomHeader>> groups;
  for (DicomHeader& header : headers) {
    groups[{header.series_uid, header.study_uid, header.series_key}].push_back(std::move(header));
  }
  std::vector<Series> all;
  std::map<std::string, int> parts_of_uid;  // a Series UID may occur in two studies
  for (auto& [uids, group] : groups) {
    for (Series& series : splitSeries(std::move(group))) {
      const int number = ++parts_of_uid[uids[0]];
      series.report.uid = uids[0];
      if (number > 1) series.report.uid += "#" + std::to_string(number);
      if (!uids[2].empty()) {
        series.report.findings.push_back(
            {"NO_SERIES_UID",
             "notice",
             "The files name no series: their Series Instance UID was emptied",
             {},
             "Slices of one study, series number, date and time were taken together"});
      }
      dropDuplicates(series);
      dropEqualRepeats(series);
      series.findings_kept = series.report.findings.size();
      assessSeries(series);
      all.push_back(std::move(series));
    }
  }
  return all;
}

}  // namespace trephine
