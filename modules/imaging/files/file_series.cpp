#include "imaging/files/file_series.h"

#include <algorithm>
#include <cctype>

#include "imaging/common/text.h"
#include "imaging/series/series.h"
#include "volume/case_memory.h"

namespace trephine {

namespace {

constexpr int kMostLabels = 255;

void add(SeriesReport& report, const char* code, const char* severity, std::string text,
         const char* action) {
  report.findings.push_back({code, severity, std::move(text), {}, action});
}

void refuseLabelMap(SeriesReport& report, std::string text) {
  report.modality = "SEG";
  add(report, "LABEL_MAP", "refusal", std::move(text),
      "Open the CT first, then this file by \"Open segmentation\" on the tab Structures");
  report.verdict = Verdict::refused;
}

bool namesLabels(std::string name) {
  for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
  return std::ranges::any_of(std::initializer_list<const char*>{"seg", "label", "mask"},
                             [&](const char* word) { return name.find(word) != name.npos; });
}

}  // namespace

SeriesReport assessFile(const std::filesystem::path& file, const std::string& name) {
  SeriesReport report;
  report.uid = "file:" + cleanUtf8(name);
  report.description = cleanUtf8(name);
  report.modality = "CT";
  report.verdict = Verdict::pass;
  report.geometry.spacing_mm = Vec3(0.0);
  const Result<VolumeFileHeader> header = readVolumeFileHeader(file);
  if (!header) {
    const Error& error = header.error();
    report.source = "file";
    report.modality.clear();
    add(report, error.code.c_str(), "refusal", error.what, "");
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
    refuseLabelMap(report, "The voxels have 8 bits: a label map or a picture, not a CT");
    return report;
  }
  if (header->geometry.size[2] < 2) {
    add(report, "ONE_LOCATION", "refusal", "A single slice is not a volume",
        "Choose a file that covers the anatomy");
    report.verdict = Verdict::refused;
    return report;
  }
  add(report, "ASSUMED_HU", "notice",
      "A " + header->format + " file does not say what its values are", "They were taken as HU");
  for (const std::string& note : header->notes) {
    add(report, "FILE_NOTE", "notice", note, "");
  }
  if (header->reversed_slices) {
    add(report, "LEFT_HANDED", "notice", "The file counts its slices from the other end",
        "They were reversed; every voxel stays where it was in the patient");
  }
  if (namesLabels(file.filename().string())) {  // whatever its folder is called
    add(report, "NAMED_AS_LABELS", "notice", "The file is named like a label map",
        "Make sure that it is the CT");
  }
  return report;
}

Result<Volume> readFileSeries(const std::filesystem::path& file, const Progress& progress,
                              SeriesReport& report, HuLook& look) {
  Result<VolumeFileReading> reading = readVolumeFile(file, progress);
  if (!reading) return reading.error();
  const auto voxels = [](std::uint64_t count) { return counted(count, "voxel"); };
  if (reading->rounded > 0) {
    add(report, "HU_ROUNDED", "repair",
        voxels(reading->rounded) + " had HU that are not whole numbers",
        "They were rounded to the nearest");
  }
  if (reading->clamped > 0) {
    add(report, "HU_CLAMPED", "repair", voxels(reading->clamped) + " had HU outside -32768..32767",
        "They were set to the nearest limit");
  }
  if (reading->not_numbers > 0) {
    add(report, "NOT_NUMBERS", "repair", voxels(reading->not_numbers) + " held no number",
        "They became air");
  }
  if (reading->hu_min >= 0.0 && reading->hu_max <= kMostLabels) {
    refuseLabelMap(report, "All values lie between 0 and 255: a label map or a picture, not a CT");
    const Finding& finding = report.findings.back();
    return Error{finding.code, finding.text, report.uid, finding.action};
  }
  look.addSampleOf(reading->volume.hu, reading->not_numbers);
  const auto [low, high] = std::ranges::minmax(reading->volume.hu);
  report.hu_min = low;
  report.hu_max = high;
  report.verdict = verdictOf(report.findings);
  return std::move(reading->volume);
}

Result<SlicePicture> fileSlice(const std::filesystem::path& file, int index,
                               const Progress& progress) {
  const Result<Volume> volume = readVolume(file, progress);
  if (!volume) return volume.error();
  const GridGeometry& g = volume->geometry;
  if (index < 0 || index >= g.size[2]) {
    return Error{"NO_SUCH_SLICE", "There is no such slice", std::to_string(index), ""};
  }
  const auto first = volume->hu.begin() + std::ptrdiff_t(g.indexOf(0, 0, index));
  return SlicePicture{
      g.size[0], g.size[1], g.spacing_mm, {first, first + std::ptrdiff_t(g.size[0]) * g.size[1]}};
}

}  // namespace trephine
