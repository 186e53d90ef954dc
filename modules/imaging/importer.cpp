#include "imaging/importer.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/codes.h"
#include "base/memory.h"
#include "base/system.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/source_watch.h"
#include "imaging/common/detail/text.h"
#include "imaging/common/workers.h"
#include "imaging/dicom/detail/dicom_pixels.h"
#include "imaging/dicom/detail/transfer_syntax.h"
#include "imaging/files/detail/archive.h"
#include "imaging/files/detail/file_series.h"
#include "imaging/report/answers.h"
#include "imaging/series/detail/assembly.h"
#include "imaging/series/detail/hu_checks.h"
#include "imaging/series/detail/scan.h"
#include "imaging/series/detail/series.h"
#include "imaging/series/detail/series_findings.h"
#include "imaging/series/detail/series_geometry.h"
#include "imaging/series_state.h"
#include "imaging/steps/detail/volume_steps.h"
#include "volume/codes.h"

namespace trephine {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Error refusalOf(const SeriesReport& series) {
  const auto finding = std::ranges::find(series.findings, Severity::refusal, &Finding::severity);
  return Error{finding->code, finding->text, series.uid, finding->action};
}

Error noSuchSeries(const std::string& uid, std::size_t listed) {
  return Error{code::kNoSuchSeries, tr("There is no such series in the folder"), cleanUtf8(uid),
               listed == 0 ? tr("Choose another folder") : tr("Choose one that the report lists")};
}

Provenance provenanceOf(const SeriesReport& series, const ImportRequest& request) {
  Provenance provenance;
  provenance.source = series.source;
  if (!series.transfer_syntax.empty()) {
    provenance.transfer_syntax = transferSyntaxName(series.transfer_syntax);
  }
  provenance.lossy = series.lossy;
  for (const Choice& choice : series.choices) {
    const auto given = request.answers.find(choice.code);
    const bool answered = given != request.answers.end();
    provenance.answers[choice.code] = answered ? given->second : choice.options.front();
    if (!answered) provenance.unanswered.push_back(choice.code);
  }
  for (const auto& [code, option] : request.answers) {
    if (!provenance.answers.contains(code)) provenance.unused_answers.push_back(code);
  }
  std::ranges::copy_if(series.findings, std::back_inserter(provenance.changes),
                       [](const Finding& f) {
                         return f.severity == Severity::repair || f.severity == Severity::edit;
                       });
  provenance.crop = request.crop;
  provenance.reduction = request.reduction;
  provenance.build = buildName();
  return provenance;
}

// Slices of it may be among what could not be unpacked.
void addNotWhole(const UnpackedArchives& unpacked, Series& series) {
  for (const auto& archive : unpacked.not_whole) {
    const bool from_it = std::ranges::any_of(series.slices, [&](const DicomHeader& slice) {
      return slice.file.parent_path() == archive.folder;
    });
    if (!from_it) continue;
    return keepFinding(
        series,
        {code::kArchiveNotWhole,
         Severity::refusal,
         tr("It comes from {}: some of its slices may not be there", archive.why),
         {},
         tr("Copy or download the archive again, or unpack it by hand and import the folder")});
  }
}

Status roomToRead(const SeriesReport& series, const ImportRequest& request) {
  return enoughToRead(readingMb(series, request), tr("Reading the series"), "",
                      request.most_memory_mb.value_or(usableMemoryMb()));
}

// What is found out while a series is read.
struct Reading {
  int slices_used = 0;  // of DICOM
  SourceIds ids;
  HuSanityCheck look;
};

// Of slices that are one scan; what they do not agree on stays empty.
SourceIds idsOf(const std::vector<DicomHeader>& slices, const std::vector<std::size_t>& used) {
  const auto common = [&](std::string DicomHeader::*uid) {
    const std::string& first = slices[used.front()].*uid;
    const bool same =
        std::ranges::all_of(used, [&](std::size_t n) { return slices[n].*uid == first; });
    return same ? hashOrNone(first) : "";
  };
  if (used.empty()) return {};
  const bool named = slices[used.front()].series_key.empty();
  return {common(&DicomHeader::study_uid), named ? common(&DicomHeader::series_uid) : "",
          common(&DicomHeader::frame_of_reference)};
}

// A series of DICOM slices, or a volume file.
struct Source {
  Series series;
  std::filesystem::path file;  // empty for DICOM
};

// What is said of it once these questions are answered; its voxels are not looked at.
SeriesReport answeredReport(const Source& source, const Answers& answers) {
  if (!source.file.empty()) {
    return assessFile(source.file, source.series.report.description, answers);
  }
  Series answered = source.series;
  assessSeries(answered, answers);
  return answered.report;
}

}  // namespace

struct CtFolder::Contents {
  ImportReport report;
  std::optional<UnpackedArchives> unpacked;  // where the files lie, of a series in an archive
  std::vector<Source> sources;               // of report.series

  Source* find(const std::string& uid) {
    for (std::size_t n = 0; n < report.series.size(); ++n) {
      if (report.series[n].uid == uid) return &sources[n];
    }
    for (std::size_t n = 0; n < report.series.size(); ++n) {
      if (std::to_string(n + 1) == uid) return &sources[n];
    }
    return nullptr;
  }
  // That can be read, or could be with answers; a volume file that is named like a label map is
  // none.
  bool hasCt() const {
    return std::ranges::any_of(sources, [](const Source& source) {
      const SeriesReport& s = source.series.report;
      return s.modality == "CT" && !looksLikeLabels(s) &&
             (s.verdict != Verdict::refused || !s.choices.empty());
    });
  }
  // Empty where there are several, or none.
  std::string onlyCtOf(const DicomHeader& segmentation) const {
    std::string only;
    for (const Source& source : sources) {
      if (!source.file.empty() || source.series.report.modality != "CT") continue;
      const DicomHeader& ct = source.series.slices.front();
      if (ct.study_uid != segmentation.study_uid ||
          ct.frame_of_reference != segmentation.frame_of_reference) {
        continue;
      }
      if (!only.empty()) return {};
      only = source.series.report.uid;
    }
    return only;
  }
  // The report's copy of what the source says of itself.
  void publish(const Source& source) {
    report.series[std::size_t(&source - sources.data())] = source.series.report;
  }

  // Of a folder that holds archives and nothing else to read: what is in them instead, if that is
  // anything. What could not be unpacked is among what was skipped. CANCELLED, and the
  // errors of scanFiles().
  Status unpackInto(ScannedFiles& files, std::filesystem::path& scanned, const Progress& progress,
                    ScanGuide* guide);

  Result<Volume> readDicom(Series& series, const ImportRequest& request, const Progress& progress,
                           Reading& reading);
};

Status CtFolder::Contents::unpackInto(ScannedFiles& files, std::filesystem::path& scanned,
                                      const Progress& progress, ScanGuide* guide) {
  constexpr std::size_t kMostArchives = 16;
  if (files.archives.size() > kMostArchives) return {};
  Result<UnpackedArchives> some = unpack(files.archives, progress);
  // Where nothing can be unpacked, they are what they were: packed.
  if (!some) return some.error().code == code::kCancelled ? Status(some.error()) : Status();
  Result<ScannedFiles> within = scanFiles(some->folder.path(), progress, guide);
  if (!within) return within.error();
  if (within->headers.empty() && within->volume_files.empty()) {
    // Why, where that is more than that it is packed.
    for (const auto& archive : some->not_whole) {
      if (!archive.damaged) ++files.skipped[archive.why];
    }
    return {};
  }
  for (const auto& archive : some->not_whole) ++within->skipped[archive.why];
  within->files_seen += files.files_seen - int(files.archives.size());
  files = *std::move(within);
  scanned = some->folder.path();
  unpacked = *std::move(some);
  return {};
}

// Slices that turn out to be unreadable are missing slices: they are marked, and the series is
// looked at again, until it is read or refused.
Result<Volume> CtFolder::Contents::readDicom(Series& series, const ImportRequest& request,
                                             const Progress& progress, Reading& reading) {
  const Answers& answers = request.answers;
  while (true) {
    const SeriesPlan plan = assessSeries(series, answers);
    if (const Status valid = fits(optionsOf(series.report), answers); !valid) {
      return valid.error();
    }
    if (series.report.verdict == Verdict::refused) return refusalOf(series.report);
    if (Status enough = roomToRead(series.report, request); !enough) return enough.error();
    Result<Assembly> assembly = assemble(series, plan, progress);
    if (!assembly) return assembly.error();
    if (assembly->vanished) return refuseVanished(series.report);
    for (const Assembly::Unreadable& lost : assembly->unreadable) {
      series.slices[lost.slice].defect = Defect::cut;
      series.slices[lost.slice].defect_text = lost.why;
    }
    if (!assembly->unreadable.empty()) continue;
    if (assembly->high_bits) {
      askAboutHighBits(series.slices[plan.sources.front()], answers, series.report);
    }
    addValueFindings(assembly->counts, series.report);
    series.report.hu_min = assembly->counts.hu_min;
    series.report.hu_max = assembly->counts.hu_max;
    if (assembly->counts.padding == 0 && assembly->counts.hu_min < kLowestAir_HU) {
      sayPadding(unnamedPaddingToAir(assembly->volume), series.report);
      series.report.hu_min = *std::ranges::min_element(assembly->volume.hu);
    }
    reading.slices_used = int(plan.sources.size());
    reading.ids = idsOf(series.slices, plan.sources);
    reading.look = std::move(assembly->look);
    return std::move(assembly->volume);
  }
}

CtFolder::CtFolder() : contents_(std::make_unique<Contents>()) {}
CtFolder::CtFolder(CtFolder&&) noexcept = default;
CtFolder& CtFolder::operator=(CtFolder&&) noexcept = default;
CtFolder::~CtFolder() = default;

const ImportReport& CtFolder::report() const {
  return contents_->report;
}

Result<CtFolder> CtFolder::scan(const std::filesystem::path& path, const Progress& progress,
                                ScanGuide* guide) {
  CtFolder folder;
  Contents& contents = *folder.contents_;
  ImportReport& report = contents.report;
  report.start_rss_mb = residentMb();
  const auto start = Clock::now();
  Result<ScannedFiles> files = scanFiles(path, progress, guide);
  if (!files) return files.error();
  std::filesystem::path scanned = path;
  if (files->headers.empty() && files->volume_files.empty() && !files->archives.empty()) {
    Status done = contents.unpackInto(*files, scanned, progress, guide);
    if (!done) return done.error();
  }

  report.path = cleanUtf8(path.string());
  report.files_seen = files->files_seen;
  report.files_read = files->dicom_files + int(files->volume_files.size());
  for (const auto& [reason, count] : files->skipped) {
    report.skipped.push_back({reason, count, files->packed.contains(reason)});
  }
  if (files->not_looked_at > 0) {
    report.skipped.push_back(
        {tr("not looked at, since the search was ended early"), files->not_looked_at});
  }
  std::vector<Series> grouped = groupSeries(std::move(files->headers), progress);
  saySeveral(grouped);
  for (Series& series : grouped) {
    if (files->not_looked_at > 0) addStoppedScan(*files, series);
    addEmptyFiles(*files, series);
    if (contents.unpacked) addNotWhole(*contents.unpacked, series);
    contents.sources.push_back({std::move(series), {}});
  }
  if (progress.cancelled()) return Error{code::kCancelled, tr("The import was cancelled"), "", ""};
  std::error_code error;
  const bool one_file = std::filesystem::is_regular_file(scanned, error);
  for (const std::filesystem::path& file : files->volume_files) {
    if (progress.cancelled())
      return Error{code::kCancelled, tr("The import was cancelled"), "", ""};
    const auto name = one_file ? file.filename() : file.lexically_relative(scanned);
    Source source;
    source.series.report = assessFile(file, name.string());
    source.file = file;
    contents.sources.push_back(std::move(source));
  }
  if (contents.hasCt()) {
    for (Source& source : contents.sources) sayWhatLabelsAreFor(source.series.report);
  }
  for (const Source& source : contents.sources) report.series.push_back(source.series.report);
  report.error = folderError(report);
  report.seconds.scan = secondsSince(start);
  report.peak_rss_mb = std::max(peakResidentMb(), report.start_rss_mb);  // read at other moments
  return folder;
}

std::optional<std::string> CtFolder::bestSeries(const Answers& answers) const {
  const SeriesReport* best = nullptr;
  // DICOM says that it is CT; a file that is named like a label map comes last.
  const auto rank = [](const SeriesReport& s) {
    return std::tuple(s.source == "DICOM", !hasFinding(s, code::kNamedAsLabels),
                      s.geometry.size[2]);
  };
  for (const Source& source : contents_->sources) {
    const SeriesReport& listed =
        contents_->report.series[std::size_t(&source - contents_->sources.data())];
    if (listed.modality != "CT") continue;
    bool usable = listed.verdict != Verdict::refused;
    if (!usable && !listed.choices.empty() && !answers.empty()) {
      usable = answeredReport(source, answers).verdict != Verdict::refused &&
               !refusedByHu(listed, answers);
    }
    if (usable && (!best || rank(*best) < rank(listed))) best = &listed;
  }
  // Where none can be used, the one that the answers were for: reading it says what is in the way.
  const auto answered = [&](const SeriesReport& s) {
    return s.modality == "CT" && std::ranges::any_of(s.choices, [&](const Choice& choice) {
             return answers.contains(choice.code);
           });
  };
  for (const SeriesReport& listed : contents_->report.series) {
    if (best || !answered(listed)) continue;
    best = &listed;
  }
  if (!best) return std::nullopt;
  return best->uid;
}

Status CtFolder::checkAnswers(const Answers& answers) const {
  Options asked;
  for (const Source& source : contents_->sources) {
    if (source.series.report.choices.empty()) continue;
    const SeriesReport answered = answeredReport(source, answers);
    for (const SeriesReport* report :
         std::initializer_list<const SeriesReport*>{&source.series.report, &answered}) {
      for (const auto& [code, options] : optionsOf(*report)) {
        for (const std::string& option : options) {
          if (std::ranges::find(asked[code], option) == asked[code].end()) {
            asked[code].push_back(option);
          }
        }
      }
    }
  }
  return fits(asked, answers);
}

std::vector<ScreenNames> CtFolder::screenNames() const {
  std::vector<ScreenNames> names;
  for (const Source& source : contents_->sources) {
    const std::vector<DicomHeader>& slices = source.series.slices;
    names.push_back(slices.empty() ? ScreenNames{} : trephine::screenNames(slices.front()));
  }
  return names;
}

SourceIdentity CtFolder::sourceIdentity(const std::string& uid) const {
  SourceIdentity identity;
  const Source* source = contents_->find(uid);
  if (!source) return identity;
  if (!source->file.empty()) identity.addFile(source->file);
  for (const DicomHeader& slice : source->series.slices) {
    if (slice.identity) identity.add(*slice.identity);
    identity.addFile(slice.file);
  }
  return identity;
}

std::vector<CtFolder::LabelFile> CtFolder::labelFiles() const {
  std::vector<LabelFile> files;
  if (!contents_->hasCt()) return files;
  for (const Source& source : contents_->sources) {
    const SeriesReport& series = source.series.report;
    if (!source.file.empty() && looksLikeLabels(series)) {
      files.push_back({series.description, source.file});
    } else if (source.file.empty() && seriesState(series, {}) == SeriesState::structures) {
      const DicomHeader& first = source.series.slices.front();
      const std::string name =
          series.description.empty() ? first.file.filename().string() : series.description;
      files.push_back({name, first.file, contents_->onlyCtOf(first)});
    }
  }
  return files;
}

Result<SlicePicture> CtFolder::slice(const std::string& uid, int index,
                                     const Progress& progress) const {
  Source* source = contents_->find(uid);
  if (!source) return noSuchSeries(uid, contents_->report.series.size());
  const Error no_slice{code::kNoSuchSlice, tr("There is no such slice"), std::to_string(index), ""};
  if (!source->file.empty()) return fileSlice(source->file, index, progress);
  const std::vector<DicomHeader>& slices = source->series.slices;
  if (index < 0 || std::size_t(index) >= slices.size()) return no_slice;
  const DicomHeader& header = slices[std::size_t(index)];
  const StoredFormat& format = header.format;
  if (!header.has_pixels || !header.holdsGreyWords() || header.rescale_bad ||
      !findTransferSyntax(header.transfer_syntax)) {
    return Error{code::kNoPicture, tr("The slice holds no grey pixels that can be shown"), "", ""};
  }
  if (header.defect != Defect::none) {
    return Error{code::kUnreadable, tr("The slice cannot be read: {}", header.defect_text), "", ""};
  }
  SlicePicture picture;
  picture.columns = header.columns;
  picture.rows = header.rows;
  if (const auto& spacing = header.pixel_spacing_mm) {
    picture.spacing_mm = Vec3((*spacing)[1], (*spacing)[0], 1.0);
  }
  picture.hu.resize(header.pixelCount());
  Status read;
  const Status done = forEachFile(1, Progress(), {}, [&](std::size_t) {
    read = PixelReader(progress).read(header, picture.hu.data());
    if (read) HuConverter().convert(picture.hu.data(), picture.hu.size(), format);
  });
  if (!done) return done.error();
  if (!read) {
    return Error{code::kUnreadable, tr("The slice cannot be read: {}", read.error().what), "", ""};
  }
  return picture;
}

Result<Volume> CtFolder::read(const std::string& uid, const ImportRequest& request,
                              const Progress& progress) {
  ImportReport& report = contents_->report;
  Source* source = contents_->find(uid);
  if (!source) return noSuchSeries(uid, report.series.size());
  SeriesReport& series = source->series.report;
  report.chosen.reset();
  report.provenance.reset();
  const auto fail = [&](const Error& error) {
    assignVerdict(source->series);
    contents_->publish(*source);
    if (error.code != code::kCancelled) report.error = error;
    return error;
  };

  const auto start = Clock::now();
  std::uintmax_t bytes = 0;  // of a volume file
  Reading reading;
  if (!source->file.empty()) {
    std::error_code error;
    bytes = std::filesystem::file_size(source->file, error);
    if (isGone(source->file, 0)) return fail(refuseVanished(series));
    series = assessFile(source->file, series.description, request.answers);
    if (contents_->hasCt()) sayWhatLabelsAreFor(series);
    if (series.verdict == Verdict::refused) {
      const Status valid = fits(optionsOf(series), request.answers);
      return fail(valid ? refusalOf(series) : valid.error());
    }
    if (Status enough = roomToRead(series, request); !enough) return fail(enough.error());
  }
  Result<Volume> volume =
      source->file.empty()
          ? contents_->readDicom(source->series, request, progress, reading)
          : readFileSeries(source->file, request.answers, progress, series, reading.look);
  if (!volume && !source->file.empty() && volume.error().code != code::kCancelled &&
      isGone(source->file, bytes)) {
    return fail(refuseVanished(series));
  }
  if (!volume && volume.error().code == code::kLabelMap && contents_->hasCt()) {
    sayWhatLabelsAreFor(series);
    return fail(refusalOf(series));
  }
  if (!volume) {
    const Error& error = volume.error();
    const bool of_the_file = !source->file.empty() && series.verdict != Verdict::refused;
    if (of_the_file && (error.code == code::kUnreadable || error.code == code::kNotHu)) {
      series.findings.push_back({error.code, Severity::refusal, error.what, {}, error.next});
    }
    return fail(error);
  }
  checkHu(reading.look, request.answers, series);
  series.verdict = verdictOf(series.findings);
  if (series.verdict == Verdict::refused) {
    const Status valid = fits(optionsOf(series), request.answers);
    return fail(valid ? refusalOf(series) : valid.error());
  }

  Provenance provenance;
  const Status stepped = takeVolumeSteps(request, progress, series, *volume, provenance.loss);
  if (const Status valid = fits(optionsOf(series), request.answers); !valid) {
    return fail(valid.error());
  }
  if (!stepped) return fail(stepped.error());
  report.seconds.read = secondsSince(start);
  assignVerdict(source->series);
  series.geometry = volume->geometry;

  progress.at(0.95, tr("Checking"));
  const auto hash_start = Clock::now();
  series.volume_sha256 = volumeSha256(*volume);
  report.seconds.hash = secondsSince(hash_start);
  const auto loss = provenance.loss;
  provenance = provenanceOf(series, request);
  provenance.loss = loss;
  provenance.slices_used = source->file.empty() ? reading.slices_used : series.slices;
  provenance.source_ids = reading.ids;
  provenance.volume_sha256 = *series.volume_sha256;
  contents_->publish(*source);
  report.provenance = std::move(provenance);
  report.chosen = series.uid;
  report.error.reset();
  report.peak_rss_mb = std::max(peakResidentMb(), report.start_rss_mb);  // read at other moments
  progress.at(1.0, tr("Done"));
  return volume;
}

}  // namespace trephine
