#include "imaging/files/detail/file_series.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "base/formatted.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/stored_values.h"
#include "imaging/common/detail/text.h"
#include "imaging/report/answers.h"
#include "imaging/series/detail/hu_checks.h"
#include "imaging/series/detail/series.h"
#include "imaging/series/detail/series_geometry.h"
#include "volume/case_memory.h"
#include "volume/codes.h"

namespace trephine {

namespace {

constexpr int kMostLabels = 255;

void add(SeriesReport& report, Code code, Severity severity, std::string text, std::string action) {
  report.findings.push_back({code, severity, std::move(text), {}, std::move(action)});
}

void refuseLabelMap(SeriesReport& report, std::string text) {
  report.modality = "SEG";
  add(report, code::kLabelMap, Severity::refusal, std::move(text),
      tr("Open the CT first, then this file by \"Open segmentation\" on the tab Structures"));
  report.verdict = Verdict::refused;
}

std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

// Where an axis goes in the patient, with how far it is askew.
std::string wayOf(const Vec3& direction) {
  constexpr const char* kWays[3][2] = {{"right", "left"}, {"front", "back"}, {"foot", "head"}};
  int axis = 0;
  for (int n = 1; n < 3; ++n) {
    if (std::abs(direction[n]) > std::abs(direction[axis])) axis = n;
  }
  std::string way = kWays[axis][direction[axis] > 0.0];
  const double askew_deg =
      glm::degrees(std::acos(std::min(1.0, std::abs(direction[axis]) / glm::length(direction))));
  if (askew_deg > 0.05) way += tr(" ({} degrees askew)", shortNumber(askew_deg));
  return way;
}

// Which of the ways in which a file says how it lies in the patient counts.
Result<VolumeFileHeader> inChosenForm(VolumeFileHeader header, const std::filesystem::path& file,
                                      const Answers& answers, SeriesReport& report) {
  if (header.forms.empty()) return header;
  Choice choice{code::kFormsDiffer,
                tr("The file says in two ways how it lies in the patient. Which is right?"),
                {"refuse"},
                {tr("Do not use the file")}};
  for (const VolumeFileHeader::Form& form : header.forms) {
    const GridGeometry& g = form.geometry;
    const Vec3 middle = glm::round(g.centre_mm()) + Vec3(0.0);  // no -0
    choice.options.push_back(form.name);
    choice.words.push_back(tr(
        "The {}: steps of {} mm, {} mm along the slices; columns go to {}, rows to {}, slices to "
        "{}; "
        "its middle at ({}) mm",
        form.name, formatted("%.4g x %.4g x %.4g", g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z),
        formatted("%.0f", g.size[2] * g.spacing_mm.z), wayOf(g.direction[0]), wayOf(g.direction[1]),
        wayOf(form.reversed_slices ? -g.direction[2] : g.direction[2]),
        formatted("%.0f, %.0f, %.0f", middle.x, middle.y, middle.z)));
  }
  const std::string text = header.contradiction;
  const std::string chosen = ask(std::move(choice), answers, report.choices);
  if (Result<VolumeFileHeader> in_form = inForm(header, chosen, file)) {
    add(report, code::kFormsDiffer, Severity::repair, text,
        chosen == "sform"   ? tr("It was taken as its sform says, as was chosen")
        : chosen == "qform" ? tr("It was taken as its qform says, as was chosen")
                            : tr("It was taken with the steps of its pixdim along the axes of its "
                                 "sform, as was chosen"));
    return in_form;
  }
  add(report, code::kFormsDiffer, Severity::refusal, text,
      tr("Measure a known length, or look where the scan came from, and choose the right one"));
  return header;
}

bool namesLabels(std::string name) {
  for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
  return std::ranges::any_of(std::initializer_list<const char*>{"seg", "label", "mask"},
                             [&](const char* word) { return name.find(word) != name.npos; });
}

}  // namespace

SeriesReport assessFile(const std::filesystem::path& file, const std::string& name,
                        const Answers& answers) {
  SeriesReport report;
  report.uid = "file:" + cleanUtf8(name);
  report.description = cleanUtf8(name);
  report.modality = "CT";
  report.verdict = Verdict::pass;
  report.geometry.spacing_mm = Vec3(0.0);
  Result<VolumeFileHeader> header = readVolumeFileHeader(file);
  if (!header) {
    const Error& error = header.error();
    report.source = "file";
    report.modality.clear();
    add(report, error.code, Severity::refusal, error.what, "");
    report.findings.back().action = error.next;
    report.verdict = Verdict::refused;
    return report;
  }
  report.source = header->format;
  report.geometry = header->geometry;
  report.slices = header->geometry.size[2];
  report.reading_mb = voxelsMb(header->geometry.voxelCount());
  report.memory_mb = memoryMb(report, {});
  if (bytesOf(header->type) == 1) {
    refuseLabelMap(report, tr("The voxels have 8 bits: a label map or a picture, not a CT"));
    return report;
  }
  if (header->geometry.size[2] < 2) {
    add(report, code::kOneLocation, Severity::refusal, tr("A single slice is not a volume"),
        tr("Choose a file that covers the anatomy"));
    report.verdict = Verdict::refused;
    return report;
  }
  header = inChosenForm(*std::move(header), file, answers, report);
  report.geometry = header->geometry;
  add(report, code::kAssumedHu, Severity::notice,
      tr("A {} file does not say what its values are", header->format),
      tr("They were taken as HU"));
  for (const std::string& note : header->notes) {
    add(report, code::kFileNote, Severity::notice, note, "");
  }
  if (header->reversed_slices) {
    add(report, code::kLeftHanded, Severity::notice,
        tr("The file counts its slices from the other end"),
        tr("They were reversed; every voxel stays where it was in the patient"));
  }
  if (namesLabels(file.filename().string())) {  // whatever its folder is called
    add(report, code::kNamedAsLabels, Severity::notice, tr("The file is named like a label map"),
        tr("Make sure that it is the CT"));
  }
  report.verdict = verdictOf(report.findings);
  return report;
}

Result<Volume> readFileSeries(const std::filesystem::path& file, const Answers& answers,
                              const Progress& progress, SeriesReport& report, HuSanityCheck& look) {
  Result<VolumeFileReading> reading =
      readVolumeFile(file, progress, answerTo(answers, code::kFormsDiffer));
  if (!reading) return reading.error();
  // Attenuation per cm, or shares: water has 0.2 of the one.
  constexpr double kSmall = 20.0;
  const std::size_t count = reading->volume.hu.size();
  if (reading->rounded > count / 10 && reading->hu_min >= -kSmall && reading->hu_max <= kSmall) {
    add(report, code::kNotHu, Severity::refusal,
        tr("The values lie between {} and {} and are no whole numbers: attenuation (of water 0.2 "
           "per cm) or shares, not HU",
           shortNumber(reading->hu_min), shortNumber(reading->hu_max)),
        tr("Export the scan in HU: 1000 x (value - that of water) / that of water"));
    report.verdict = Verdict::refused;
    const Finding& finding = report.findings.back();
    return Error{finding.code, finding.text, report.uid, finding.action};
  }
  if (reading->rounded > 0) {
    add(report, code::kHuRounded, Severity::repair,
        trCount(reading->rounded, "{} voxel had HU that are not whole numbers",
                "{} voxels had HU that are not whole numbers"),
        tr("They were rounded to the nearest"));
  }
  if (reading->clamped > 0) {
    add(report, code::kHuClamped, Severity::repair,
        trCount(reading->clamped, "{} voxel had HU outside -32768..32767",
                "{} voxels had HU outside -32768..32767"),
        tr("They were set to the nearest limit"));
  }
  if (reading->not_numbers > 0) {
    add(report, code::kNotNumbers, Severity::repair,
        trCount(reading->not_numbers, "{} voxel held no number", "{} voxels held no number"),
        tr("They became air"));
  }
  if (reading->hu_min >= 0.0 && reading->hu_max <= kMostLabels) {
    refuseLabelMap(report,
                   tr("All values lie between 0 and 255: a label map or a picture, not a CT"));
    const Finding& finding = report.findings.back();
    return Error{finding.code, finding.text, report.uid, finding.action};
  }
  // Values that are multiples of 256 alone are of a phantom, or of 8 bits.
  const bool exchanged =
      reading->bytes_exchanged && reading->header.slope == 1.0 &&
      !std::ranges::all_of(reading->volume.hu, [](std::int16_t hu) { return hu % 256 == 0; });
  if (exchanged) {
    look.doubt(
        tr("neighbours differ far less with the bytes of each voxel exchanged, as of a header "
           "that says the wrong byte order"));
  }
  UnnamedPadding padding;
  if (!exchanged) padding = unnamedPaddingToAir(reading->volume);
  sayPadding(padding, report);
  look.addSampleOf(reading->volume.hu, reading->not_numbers + padding.voxels);
  const auto [low, high] = std::ranges::minmax(reading->volume.hu);
  report.hu_min = low;
  report.hu_max = high;
  report.verdict = verdictOf(report.findings);
  return std::move(reading->volume);
}

Result<SlicePicture> fileSlice(const std::filesystem::path& file, int index,
                               const Progress& progress) {
  const Result<VolumeFileHeader> header = readVolumeFileHeader(file);
  if (!header) return header.error();
  const std::string form = header->forms.empty() ? "" : header->forms.front().name;
  const Result<Volume> volume = readVolume(file, progress, form);
  if (!volume) return volume.error();
  const GridGeometry& g = volume->geometry;
  if (index < 0 || index >= g.size[2]) {
    return Error{code::kNoSuchSlice, tr("There is no such slice"), std::to_string(index), ""};
  }
  const auto first = volume->hu.begin() + std::ptrdiff_t(g.indexOf(0, 0, index));
  return SlicePicture{
      g.size[0], g.size[1], g.spacing_mm, {first, first + std::ptrdiff_t(g.size[0]) * g.size[1]}};
}

}  // namespace trephine
