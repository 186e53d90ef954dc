#include "imaging/importer.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <new>
#include <utility>

#include "base/system.h"
#include "imaging/scan.h"
#include "imaging/series.h"
#include "imaging/text.h"
#include "imaging/workers.h"

namespace trephine {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Why no volume can come out of the folder; nothing where one can.
std::optional<Error> folderError(const ImportReport& report) {
  const auto is_ct = [](const SeriesReport& s) { return s.modality == "CT"; };
  if (report.files_seen == 0) {
    return Error{"EMPTY_FOLDER", "The folder holds no files", report.path, "Choose another folder"};
  }
  if (std::ranges::none_of(report.series, is_ct)) {
    std::string what =
        "There is no CT series among the " + std::to_string(report.files_seen) + " files";
    const auto most = std::ranges::max_element(report.skipped, {}, &SkippedFiles::count);
    if (most != report.skipped.end()) {
      what += "; skipped were " + std::to_string(most->count) + ": " + most->reason;
    }
    return Error{"NO_CT", what, report.path, "Choose the folder that holds the CT"};
  }
  const SeriesReport* largest = nullptr;
  for (const SeriesReport& series : report.series) {
    if (!is_ct(series)) continue;
    if (series.verdict != Verdict::refused) return std::nullopt;
    if (!largest || series.geometry.size[2] > largest->geometry.size[2]) largest = &series;
  }
  const auto refusal = std::ranges::find(largest->findings, "refusal", &Finding::severity);
  return Error{"ALL_REFUSED", "No CT series can be used; of the largest: " + refusal->text,
               report.path, refusal->action};
}

std::optional<Error> memoryError(const GridGeometry& geometry) {
  const double machine = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE));
  const double needed = double(geometry.voxelCount()) * sizeof(std::int16_t);
  if (needed <= 0.7 * machine) return std::nullopt;
  return Error{"OUT_OF_MEMORY",
               "The volume needs " + fixedText(needed / 1048576.0, 0) +
                   " MB, more than this computer can hold",
               "", "Use a computer with more memory or export fewer slices"};
}

// Zeroed voxels on large pages where the kernel gives them: page faults are most of a read's cost.
std::optional<Error> allocate(Volume& volume) {
  if (auto error = memoryError(volume.geometry)) return error;
  const std::size_t count = volume.geometry.voxelCount();
  try {
    volume.hu.reserve(count);
    constexpr std::uintptr_t kPage = 4096;
    const auto begin = (reinterpret_cast<std::uintptr_t>(volume.hu.data()) + kPage - 1) / kPage;
    const auto end = reinterpret_cast<std::uintptr_t>(volume.hu.data() + count) / kPage;
    if (end > begin) {  // a hint: failing costs time only
      ::madvise(reinterpret_cast<void*>(begin * kPage), (end - begin) * kPage, MADV_HUGEPAGE);
    }
    volume.hu.resize(count);
  } catch (const std::bad_alloc&) {
    return Error{"OUT_OF_MEMORY", "There is not enough memory for the volume", "",
                 "Close other programs and try again"};
  }
  return std::nullopt;
}

void addValueFindings(const HuCounts& counts, SeriesReport& report) {
  const auto add = [&](const char* code, const char* severity, std::uint64_t voxels,
                       const char* what, const char* action) {
    if (voxels == 0) return;
    report.findings.push_back({code, severity, std::to_string(voxels) + what, {}, action});
  };
  add("PADDING_TO_AIR", "notice", counts.padding, " voxels are padding", "They became air");
  add("HU_ROUNDED", "repair", counts.rounded, " voxels had HU that are not whole numbers",
      "They were rounded to the nearest");
  add("HU_CLAMPED", "repair", counts.clamped, " voxels had HU outside -32768..32767",
      "They were set to the nearest limit");
}

bool isValueFinding(const Finding& finding) {
  return finding.code == "PADDING_TO_AIR" || finding.code == "HU_ROUNDED" ||
         finding.code == "HU_CLAMPED";
}

}  // namespace

struct CtFolder::Contents {
  ImportReport report;
  std::vector<std::vector<DicomHeader>> slices;  // of report.series, in stack order

  // The slices' pixels into `volume`; `unreadable` gets the names of those that failed.
  Status readSlices(const std::vector<DicomHeader>& headers, const Progress& progress,
                    Volume& volume, HuCounts& counts, Finding& unreadable) const;
};

Status CtFolder::Contents::readSlices(const std::vector<DicomHeader>& headers,
                                      const Progress& progress, Volume& volume, HuCounts& counts,
                                      Finding& unreadable) const {
  const std::size_t slice = std::size_t(volume.geometry.size[0]) * volume.geometry.size[1];
  std::mutex mutex;
  return forEachFile(headers.size(), progress, {0.0, 0.9, "Reading slices"}, [&](std::size_t k) {
    thread_local HuConverter converter;
    std::int16_t* words = volume.hu.data() + k * slice;
    const Status read = readStoredWords(headers[k], words);
    const HuCounts slice_counts =
        read ? converter.convert(words, slice, headers[k].format) : HuCounts{};
    const std::lock_guard lock(mutex);
    counts.add(slice_counts);
    if (read) return;
    unreadable.slices.push_back(sliceName(headers[k]));
    unreadable.text = "A slice cannot be read: " + read.error().what;
  });
}

CtFolder::CtFolder() : contents_(std::make_unique<Contents>()) {}
CtFolder::CtFolder(CtFolder&&) noexcept = default;
CtFolder& CtFolder::operator=(CtFolder&&) noexcept = default;
CtFolder::~CtFolder() = default;

const ImportReport& CtFolder::report() const {
  return contents_->report;
}

Result<CtFolder> CtFolder::scan(const std::filesystem::path& path, const Progress& progress) {
  CtFolder folder;
  ImportReport& report = folder.contents_->report;
  report.start_rss_mb = residentMb();
  const auto start = Clock::now();
  Result<ScannedFiles> files = scanFiles(path, progress);
  if (!files) return files.error();

  report.path = cleanUtf8(path.string());
  report.files_seen = files->files_seen;
  report.files_read = int(files->headers.size());
  for (const auto& [reason, count] : files->skipped) report.skipped.push_back({reason, count});
  for (Series& series : groupSeries(std::move(files->headers))) {
    report.series.push_back(std::move(series.report));
    folder.contents_->slices.push_back(std::move(series.slices));
  }
  report.error = folderError(report);
  report.seconds.scan = secondsSince(start);
  report.peak_rss_mb = peakResidentMb();
  return folder;
}

std::optional<std::string> CtFolder::bestSeries(const Answers&) const {
  const SeriesReport* best = nullptr;
  for (const SeriesReport& series : contents_->report.series) {
    if (series.verdict == Verdict::refused || series.modality != "CT") continue;
    if (!best || series.geometry.size[2] > best->geometry.size[2]) best = &series;
  }
  if (!best) return std::nullopt;
  return best->uid;
}

Result<SlicePicture> CtFolder::slice(const std::string& uid, int index) const {
  const ImportReport& report = contents_->report;
  const auto series = std::ranges::find(report.series, uid, &SeriesReport::uid);
  if (series == report.series.end()) return Error{"NO_SUCH_SERIES", "There is no such series", "", ""};
  const auto& headers = contents_->slices[std::size_t(series - report.series.begin())];
  if (index < 0 || std::size_t(index) >= headers.size()) {
    return Error{"NO_SUCH_SLICE", "There is no such slice", "", ""};
  }
  const DicomHeader& header = headers[std::size_t(index)];
  if (header.samples != 1 || header.bits_allocated != 16 || header.defect != Defect::none ||
      !isReadableTransferSyntax(header.transfer_syntax)) {
    return Error{"NO_PICTURE", "The slice holds no grey pixels", "", ""};
  }
  SlicePicture picture{header.columns, header.rows, Vec3(1.0), {}};
  picture.hu.resize(std::size_t(header.columns) * std::size_t(header.rows));
  if (const Status read = readStoredWords(header, picture.hu.data()); !read) return read.error();
  HuConverter().convert(picture.hu.data(), picture.hu.size(), header.format);
  return picture;
}

Result<Volume> CtFolder::read(const std::string& uid, const ImportRequest&,
                              const Progress& progress) {
  ImportReport& report = contents_->report;
  const auto series = std::ranges::find(report.series, uid, &SeriesReport::uid);
  if (series == report.series.end()) {
    return Error{"NO_SUCH_SERIES", "There is no such series in the folder", cleanUtf8(uid),
                 "Choose one of the " + std::to_string(report.series.size()) + " listed"};
  }
  const auto refusal = [&] {
    const auto finding = std::ranges::find(series->findings, "refusal", &Finding::severity);
    return Error{finding->code, finding->text, series->uid, finding->action};
  };
  if (series->verdict == Verdict::refused) {
    report.chosen.reset();
    report.error = refusal();
    return *report.error;
  }
  const std::vector<DicomHeader>& headers =
      contents_->slices[std::size_t(series - report.series.begin())];
  const auto start = Clock::now();
  Volume volume;
  volume.geometry = series->geometry;
  if (auto error = allocate(volume)) return *error;
  HuCounts counts;
  Finding unreadable{"MISSING_SLICES", "refusal", "", {}, "Copy these files again"};
  if (const Status read = contents_->readSlices(headers, progress, volume, counts, unreadable);
      !read) {
    return read.error();
  }
  report.seconds.read = secondsSince(start);

  if (!unreadable.slices.empty()) {
    series->findings.push_back(std::move(unreadable));
    series->verdict = Verdict::refused;
    report.chosen.reset();
    report.error = refusal();
    return *report.error;
  }
  std::erase_if(series->findings, isValueFinding);  // of an earlier read
  addValueFindings(counts, *series);
  series->verdict = verdictOf(series->findings);
  series->hu_min = counts.hu_min;
  series->hu_max = counts.hu_max;

  progress.at(0.9, "Checking");
  const auto hash_start = Clock::now();
  series->volume_sha256 = volumeSha256(volume);
  report.seconds.hash = secondsSince(hash_start);
  report.chosen = uid;
  report.error.reset();
  report.peak_rss_mb = peakResidentMb();
  progress.at(1.0, "Done");
  return volume;
}

}  // namespace trephine
