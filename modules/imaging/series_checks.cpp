// What a series' headers say about it: kind, values, pixels, geometry. Each check adds a finding
// with its own code; README.md lists them.
#include <algorithm>
#include <limits>
#include <map>

#include "imaging/series.h"
#include "imaging/series_geometry.h"
#include "imaging/text.h"

namespace trephine {

namespace {

class Findings {
 public:
  explicit Findings(Series& series) : series_(series) {}

  void refuse(const char* code, std::string text, std::string action,
              std::vector<std::string> slices = {}) {
    series_.report.findings.push_back(
        {code, "refusal", std::move(text), std::move(slices), std::move(action)});
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

std::string countOfSlices(const std::vector<std::string>& slices) {
  return std::to_string(slices.size()) + (slices.size() == 1 ? " slice" : " slices");
}

// The slice that speaks for all: one with pixels where there is one, so with a whole header.
const DicomHeader& typicalSlice(const std::vector<DicomHeader>& slices) {
  const auto whole = std::ranges::find(slices, true, &DicomHeader::has_pixels);
  return whole == slices.end() ? slices.front() : *whole;
}

// Series of which no volume can come whatever their geometry. True where one of these it is.
bool refusedByKind(const DicomHeader& first, Findings& findings) {
  constexpr const char* kChooseCt = "Choose a CT series";
  const std::string& kind = first.sop_class;
  const bool secondary = kind.starts_with("1.2.840.10008.5.1.4.1.1.7");
  if (!first.has_pixels && first.defect == Defect::none) {
    findings.refuse("NOT_AN_IMAGE_SERIES",
                    "The series holds " + (first.modality.empty() ? "objects" : first.modality) +
                        " without CT pixels",
                    kChooseCt);
  } else if (secondary) {
    findings.refuse("SECONDARY_CAPTURE", "The series holds captured pictures, not slices",
                    kChooseCt);
  } else if (!isCt(first)) {
    findings.refuse("NOT_CT",
                    "The series is " + (first.modality.empty() ? "no CT" : first.modality) +
                        ": its values are not HU",
                    kChooseCt);
  } else if (isLocalizer(first)) {
    findings.refuse("LOCALIZER", "The series is a localizer (scout), not a stack of slices",
                    kChooseCt);
  } else if (first.frames != 1 || kind != "1.2.840.10008.5.1.4.1.1.2") {
    findings.refuse("MULTIFRAME",
                    "The series is stored as multi-frame CT, which cannot be read yet",
                    "Export it as classic CT, one file a slice");
  } else {
    return false;
  }
  return true;
}

void checkTransferSyntax(const Series& series, Findings& findings) {
  std::map<std::string, int> counts;
  for (const DicomHeader& header : series.slices) ++counts[header.transfer_syntax];
  for (const auto& [uid, count] : counts) {
    if (isReadableTransferSyntax(uid)) continue;
    findings.refuse("UNSUPPORTED_TRANSFER_SYNTAX",
                    "The transfer syntax " + transferSyntaxName(uid) + " (" + cleanUtf8(uid) +
                        ") of " + std::to_string(count) + " slices cannot be read yet",
                    "Export the series uncompressed (Explicit VR Little Endian)");
  }
}

void checkValues(const Series& series, Findings& findings) {
  const DicomHeader& first = typicalSlice(series.slices);
  const bool grey = first.photometric == "MONOCHROME1" || first.photometric == "MONOCHROME2";
  if (first.samples != 1 || (!grey && !first.photometric.empty())) {
    findings.refuse("COLOUR", "The pixels are colour (" + first.photometric + "), not HU",
                    "Export the original CT slices");
  }
  const auto odd_format = findings.slicesWhere([](const DicomHeader& h) {
    const StoredFormat& f = h.format;
    return h.has_pixels &&
           (h.bits_allocated != 16 || f.bits_stored < 1 || f.bits_stored > 16 ||
            f.high_bit < f.bits_stored - 1 || f.high_bit > 15 || h.ambiguous_order ||
            h.photometric.empty() || h.rows == 0 || h.columns == 0);
  });
  if (!odd_format.empty()) {
    findings.refuse("PIXEL_FORMAT",
                    countOfSlices(odd_format) +
                        " do not say 16 allocated bits, 1 to 16 stored bits, rows, columns and "
                        "photometric interpretation as CT must",
                    "Export the series again as CT with 16-bit pixels", odd_format);
  }
  const auto not_hu = findings.slicesWhere([](const DicomHeader& h) {
    return !h.rescale_type.empty() && h.rescale_type != "HU" && h.rescale_type != "US";
  });
  if (!not_hu.empty()) {
    findings.refuse("NOT_HU", "The values are " + first.rescale_type + ", not HU",
                    "Choose the series in HU", not_hu);
  }
  const auto bad = findings.slicesWhere([](const DicomHeader& h) { return h.rescale_bad; });
  if (!bad.empty()) {
    findings.refuse("BAD_RESCALE",
                    "The rescale slope or intercept of " + countOfSlices(bad) + " is no number",
                    "Export the series again", bad);
  }
  const auto lossy = findings.slicesWhere([](const DicomHeader& h) { return h.lossy; });
  if (!lossy.empty()) {
    findings.refuse("LOSSY_SOURCE", countOfSlices(lossy) + " were compressed with loss before",
                    "Use the original series; lossy ones are not taken without being asked", lossy);
  }
  const auto unscaled = findings.slicesWhere(
      [](const DicomHeader& h) { return h.has_pixels && !h.rescale_given && !h.rescale_bad; });
  if (!unscaled.empty()) {
    findings.notice("RESCALE_DEFAULT",
                    countOfSlices(unscaled) + " lack a rescale slope (or have 0) or intercept",
                    "Slope 1 and intercept 0 were taken where absent", unscaled);
  }
  if (first.photometric == "MONOCHROME1") {
    findings.notice("MONOCHROME1", "The series is meant to be shown with white for low values",
                    "The HU are not touched by that");
  }
}

void checkPixels(const Series& series, Findings& findings) {
  std::vector<std::string> cut, mismatched;
  std::string cut_text, mismatch_text;
  for (const DicomHeader& header : series.slices) {
    if (header.defect == Defect::cut) {
      cut.push_back(sliceName(header));
      cut_text = header.defect_text;
    } else if (header.defect == Defect::size_mismatch) {
      mismatched.push_back(sliceName(header));
      mismatch_text = header.defect_text;
    } else if (!header.has_pixels) {
      cut.push_back(sliceName(header));
      cut_text = "it has no pixels";
    }
  }
  if (!cut.empty()) {
    findings.refuse("MISSING_SLICES",
                    countOfSlices(cut) + " cannot be read (the last of them: " + cut_text + ")",
                    "Copy these files again from their source", cut);
  }
  if (!mismatched.empty()) {
    findings.refuse(
        "SIZE_MISMATCH",
        countOfSlices(mismatched) + " contradict themselves (the last: " + mismatch_text + ")",
        "Export the series again", mismatched);
  }
}

void checkGeometry(Series& series, Findings& findings) {
  const auto lost = findings.slicesWhere([](const DicomHeader& h) {
    return h.has_pixels && (!h.position_mm || !h.orientation || !h.pixel_spacing_mm);
  });
  if (!lost.empty()) {
    findings.refuse("NO_GEOMETRY",
                    countOfSlices(lost) + " lack a usable position, orientation or pixel spacing",
                    "Export the series again with its geometry", lost);
    return;
  }
  // Slices with bad pixels keep their place, so that a gap means a file that is not there at all.
  std::vector<DicomHeader> placed, unplaced;
  for (DicomHeader& header : series.slices) {
    (header.position_mm && header.orientation ? placed : unplaced).push_back(std::move(header));
  }
  if (!placed.empty() && typicalSlice(placed).pixel_spacing_mm) {
    const DicomHeader& first = typicalSlice(placed);
    StackInput input{first.rows, first.columns, *first.pixel_spacing_mm, *first.orientation, {}};
    for (const DicomHeader& header : placed) input.positions_mm.push_back(*header.position_mm);
    Stack stack = stackSlices(input);
    series.report.geometry = stack.geometry;
    series.report.tilt_deg = stack.tilt_deg;
    std::ranges::move(stack.findings, std::back_inserter(series.report.findings));
    series.slices.clear();
    for (const std::size_t i : stack.order) series.slices.push_back(std::move(placed[i]));
  } else {
    series.slices = std::move(placed);
  }
  std::ranges::move(unplaced, std::back_inserter(series.slices));
}

}  // namespace

void assessSeries(Series& series) {
  SeriesReport& report = series.report;
  Findings findings(series);
  std::ranges::stable_sort(series.slices, {}, [](const DicomHeader& header) {
    return parseInteger(header.instance_number).value_or(std::numeric_limits<int>::max());
  });
  const DicomHeader& first = typicalSlice(series.slices);
  report.description = first.description;
  report.modality = first.modality.empty() && isCt(first) ? "CT" : first.modality;
  report.transfer_syntax = cleanUtf8(first.transfer_syntax);
  report.slices = int(series.slices.size());
  report.geometry.size = {first.columns, first.rows, std::int32_t(series.slices.size())};
  report.geometry.spacing_mm = Vec3(0.0);
  if (first.pixel_spacing_mm) {
    report.geometry.spacing_mm.x = (*first.pixel_spacing_mm)[1];
    report.geometry.spacing_mm.y = (*first.pixel_spacing_mm)[0];
  }
  report.lossy = std::ranges::any_of(series.slices, &DicomHeader::lossy);

  if (!refusedByKind(first, findings)) {
    checkTransferSyntax(series, findings);
    checkValues(series, findings);
    checkPixels(series, findings);
    checkGeometry(series, findings);
    if (const Status size = checkSize(report.geometry.size, ""); !size) {
      findings.refuse(size.error().code == "TOO_LARGE" ? "TOO_LARGE" : "PIXEL_FORMAT",
                      size.error().what, size.error().next);
    }
  }
  report.verdict = verdictOf(report.findings);
}

}  // namespace trephine
