#include "library/case_library.h"

#include <algorithm>
#include <new>
#include <tuple>
#include <utility>

#include "base/codes.h"
#include "base/file.h"
#include "base/local_time.h"
#include "base/memory.h"
#include "base/stretched_hash.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/report/provenance.h"
#include "imaging/report/report_page.h"
#include "library/case_picture.h"
#include "library/codes.h"
#include "library/name_guard.h"
#include "library/name_words.h"
#include "volume/grid_place.h"
#include "volume/segmentation.h"
#include "volume/volume_files.h"

namespace trephine {

namespace fs = std::filesystem;
using namespace case_folders;

namespace {

constexpr std::uint64_t kRoomForTheRest = 4 << 20;  // bytes: report, picture, JSON, folders

Error noSuchCase(const std::string& id) {
  return Error{code::kNoSuchCase, tr("The case is not there any more"), id,
               tr("Look at the list again")};
}

Error wrongGrid() {
  return Error{code::kWrongGrid, tr("The structures lie on another grid than the case"), "",
               tr("Fit them to the case first")};
}

Error partMissing(const std::string& id, const char* file, const char* what) {
  return Error{code::kCasePartMissing, tr("The case's {} is not there any more", what),
               id + "/" + file, tr("Put the file back, or import the CT again")};
}

Error caseChanged(const std::string& id, const char* file, const char* what) {
  return Error{code::kCaseChanged, tr("The case's {} is not as it was saved", what),
               id + "/" + file, tr("Put the file back as it was, or import the CT again")};
}

// By what their file keeps whole.
bool alike(const std::vector<CaseStructure>& a, const std::vector<CaseStructure>& b) {
  return std::ranges::equal(a, b, [](const CaseStructure& one, const CaseStructure& other) {
    return one.name == other.name && one.ml == other.ml;
  });
}

Error nameTaken() {
  return Error{code::kNameTaken, tr("Another case has this name"), "", tr("Choose another name")};
}

// A case's folder, and none that a name could lead to from there.
bool isFolderName(const std::string& id) {
  return !id.empty() && id[0] != '.' && id.find('/') == id.npos && id.find('\0') == id.npos;
}

const char* regionWord(BodyRegion region) {
  switch (region) {
    case BodyRegion::head:
      return "Head";
    case BodyRegion::abdomen:
      return "Abdomen";
    case BodyRegion::not_sure:
      break;
  }
  return "CT";
}

// "head-2026-11-24-2"
std::string neutralId(BodyRegion region, const std::string& day, int number) {
  std::string id = neutralName(region, day, number);
  for (char& c : id) c = c == ' ' ? '-' : c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return id;
}

bool sameGrid(const GridGeometry& a, const GridGeometry& b) {
  constexpr double kSame_mm = 1e-6;  // a header's digits, over the whole of a scan
  return cornersApart_mm(a, b) < kSame_mm;
}

Result<LabelMap> structuresOn(const GridGeometry& grid, const std::string& id, const fs::path& file,
                              const Progress& progress) {
  const Result<Segmentation> segmentation = readSegmentation(file, progress);
  if (!segmentation) return segmentation.error();
  LabelMap map = merged(*segmentation, smallerFirst(*segmentation));
  if (!sameGrid(map.geometry, grid)) return caseChanged(id, kStructuresFile, "structures");
  map.geometry = grid;
  return map;
}

std::optional<Verdict> verdictOf(const ImportReport& report) {
  for (const SeriesReport& series : report.series) {
    if (report.chosen == series.uid) return series.verdict;
  }
  return std::nullopt;
}

std::string pretty(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

bool isNone(const Json& tissues) {
  return tissues.is_null() || (tissues.is_object() && tissues.empty());
}

// Names that tell who the patient is give way to their labels.
LabelMap withoutIdentity(LabelMap map, const SourceKeys& source, std::vector<Warning>& warnings) {
  for (Structure& s : map.structures) {
    if (const auto told = toldBy(s.name, source); !told || !tellsPatient(*told)) continue;
    std::string name = "label " + std::to_string(s.label);
    for (int n = 2; map.find(name); ++n) {
      name = "label " + std::to_string(s.label) + " " + std::to_string(n);
    }
    s.name = name;
    warnings.push_back(
        {code::kRenamedStructure,
         tr("The name of a structure told who the patient is: it is now called '{}'", name)});
  }
  return map;
}

// What went wrong inside of a part does not name the part: that is gone, and what it took of the
// disk is free again.
Error ofStorage(Error error, const Folders& folders, std::uint64_t needed) {
  if (error.code != code::kCannotWrite) return error;
  if (Status room = folders.roomFor(needed); !room) return room.error();
  error.where = folders.storage().string();
  return error;
}

Error savingCancelled() {
  return Error{code::kCancelled, tr("Saving was cancelled"), "", ""};
}

}  // namespace

std::string neutralName(BodyRegion region, const std::string& day, int number) {
  return std::string(regionWord(region)) + " " + day + " " + std::to_string(number);
}

bool isNeutralName(const std::string& name) {
  for (const BodyRegion region : {BodyRegion::head, BodyRegion::abdomen, BodyRegion::not_sure}) {
    const std::string begin = std::string(regionWord(region)) + " ";
    if (!name.starts_with(begin)) continue;
    const std::string rest = name.substr(begin.size());
    constexpr std::string_view kDay = "0000-00-00 ";
    if (rest.size() <= kDay.size() || rest.size() > kDay.size() + 6) return false;
    for (std::size_t n = 0; n < rest.size(); ++n) {
      const char c = n < kDay.size() ? kDay[n] : '0';
      if (c == '0' ? rest[n] < '0' || rest[n] > '9' : rest[n] != c) return false;
    }
    return true;
  }
  return false;
}

CaseLibrary::CaseLibrary(fs::path storage) : folders_(std::move(storage)) {
  folders_.putInOrder();
}

Result<CaseRecord> CaseLibrary::record(const std::string& id) const {
  const fs::path folder = folders_.caseFolder(id);
  std::error_code ec;
  if (!isFolderName(id) || !fs::is_directory(folder, ec)) return noSuchCase(id);
  const std::string where = id + "/" + kCaseFile;
  const fs::file_status file = fs::status(folder / kCaseFile, ec);
  if (file.type() == fs::file_type::none) {
    return Error{code::kMissingFile, tr("The case's folder cannot be read: {}", ec.message()), id,
                 tr("Let its owner allow it, or delete the case")};
  }
  if (!fs::is_regular_file(file)) {  // a pipe would be waited for
    if (!fs::is_directory(folder, ec)) return noSuchCase(id);
    return Error{code::kCasePartMissing, tr("The folder has no case.json, so it is no whole case"),
                 where, tr("Put the file back, or delete the case")};
  }
  Result<Json> json = readJsonFile(folder / kCaseFile, Progress(), kMostWrittenBytes);
  if (!json) {
    Error error = json.error();
    error.where = where;
    return error;
  }
  Result<CaseRecord> record = caseRecordFrom(*json, where);
  if (!record) return record;
  record->id = id;
  record->folder = folder;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    std::error_code unknown;
    if (const auto bytes = it->file_size(unknown); !unknown) record->bytes += bytes;
  }
  return record;
}

std::vector<ListedCase> CaseLibrary::list() const {
  std::vector<ListedCase> cases;
  std::error_code ec;
  for (fs::directory_iterator it(folders_.cases(), ec), end; !ec && it != end; it.increment(ec)) {
    std::error_code unknown;
    const std::string id = it->path().filename().string();
    if (!isFolderName(id) || !fs::is_directory(it->path(), unknown)) continue;
    ListedCase listed{id, {}, {}};
    listed.record.id = id;
    listed.record.folder = it->path();
    Result<CaseRecord> read = record(id);
    if (read) {
      listed.record = *std::move(read);
      const std::uint64_t voxels = listed.record.grid.voxelCount() * sizeof(std::int16_t);
      const auto bytes = fs::file_size(it->path() / kVolumeFile, unknown);
      if (unknown) {
        listed.problem = partMissing(id, kVolumeFile, "volume");
      } else if (bytes < voxels) {
        listed.problem = caseChanged(id, kVolumeFile, "volume");
      }
    } else if (read.error().code == code::kNoSuchCase) {
      continue;  // deleted meanwhile
    } else {
      listed.problem = read.error();
    }
    cases.push_back(std::move(listed));
  }
  std::ranges::sort(cases, [](const ListedCase& a, const ListedCase& b) {
    return std::tie(a.record.imported, a.id) > std::tie(b.record.imported, b.id);
  });
  return cases;
}

std::set<std::string> CaseLibrary::namesBeside(const std::string& id) const {
  std::set<std::string> names;
  for (const ListedCase& other : list()) {
    const std::string name = foldedName(other.record.name);
    if (other.id != id && !name.empty()) names.insert(name);
  }
  return names;
}

Status CaseLibrary::writeRecord(const CaseRecord& record, const Part& part) const {
  return writeTextFile(part / kCaseFile, pretty(toJson(record)));
}

Result<SavedCase> CaseLibrary::save(const NewCase& of, const Progress& progress) try {
  const Volume& volume = *of.volume;
  if (of.structures && !sameGrid(of.structures->geometry, volume.geometry)) return wrongGrid();
  SavedCase saved;
  CaseRecord& record = saved.record;
  if (!of.name.empty()) {
    Result<std::string> name = caseNameFrom(of.name);
    if (!name) return name.error();
    if (namesBeside("").contains(foldedName(*name))) return nameTaken();
    record.name = *name;
  }
  const SourceKeys source = sourceKeys(of.source);
  if (!record.name.empty() && !isNeutralName(record.name)) {
    if (const auto told = toldBy(record.name, source)) return identityError(*told);
  }

  // A label a byte, packed to a tenth and less.
  const std::uint64_t voxels = volume.hu.size();
  const std::uint64_t needed =
      voxels * sizeof(std::int16_t) + (of.structures ? voxels / 8 : 0) + kRoomForTheRest;
  if (Status made = folders_.make(); !made) return made.error();
  if (Status room = folders_.roomFor(needed); !room) return room.error();
  Result<Part> made = Part::make(folders_, Part::Of::wholeCase);
  if (!made) return ofStorage(made.error(), folders_, needed);
  Part& part = *made;
  const auto failed = [&](const Error& error) {
    part.drop();
    return ofStorage(error, folders_, needed);
  };

  progress.at(0.0, tr("Saving the case"));
  record.volume_sha256 = volumeSha256(volume);
  record.region = of.region;
  record.grid = volume.geometry;
  if (of.report) record.verdict = verdictOf(*of.report);
  if (progress.cancelled()) return savingCancelled();

  const Status volume_written =
      writeVolume(slabsOf(volume), part / kVolumeFile, Progress(progress, 0.1, 0.7));
  if (!volume_written) return failed(volume_written.error());
  if (of.structures && !of.structures->structures.empty()) {
    const LabelMap map = withoutIdentity(*of.structures, source, saved.warnings);
    record.structures = structuresOf(map);
    const Status written =
        writeSegmentation(map, part / kStructuresFile, false, Progress(progress, 0.7, 0.8));
    if (!written) return failed(written.error());
  }
  progress.at(0.8, tr("Drawing the case's picture"));
  const std::string picture = pngOf(casePicture(volume, of.region));
  std::vector<std::pair<const char*, std::string>> texts{{kPictureFile, picture}};
  if (of.report) {
    texts.emplace_back(kReportPage, reportPage(*of.report));
    texts.emplace_back(kReportFile, pretty(toJson(*of.report, Identity::hidden)));
  }
  if (of.provenance) texts.emplace_back(kProvenanceFile, pretty(toJson(*of.provenance)));
  if (!isNone(of.tissues)) texts.emplace_back(kTissuesFile, pretty(of.tissues));
  for (const auto& [name, text] : texts) {
    if (Status written = writeTextFile(part / name, text); !written) return failed(written.error());
  }
  if (progress.cancelled()) return savingCancelled();

  progress.at(0.9, tr("Keeping what the case may not be called"));
  NameGuard guard;
  const SourceIds ids = of.provenance ? of.provenance->source_ids : SourceIds();
  if (!source.keys.empty() || !ids.empty()) {
    Result<std::string> key = randomHex(8);
    if (!key) return key.error();
    Result<NameGuard> of_source = NameGuard::of(source, progress);
    if (!of_source) return of_source.error();
    record.names_key = *key;
    guard = *std::move(of_source);
    if (Status kept = guard.setSource(ids); !kept) return kept.error();
  }

  // From here on it is quick, and nobody else changes the list.
  const Result<FileLock> list_lock = folders_.lock();
  if (!list_lock) return failed(list_lock.error());
  if (progress.cancelled()) return savingCancelled();
  const std::string day = localTime("%Y-%m-%d");
  record.imported = localTime("%Y-%m-%dT%H:%M:%S");
  const std::set<std::string> taken = namesBeside("");
  if (taken.contains(foldedName(record.name))) return nameTaken();
  for (int number = 1; record.id.empty(); ++number) {
    std::error_code ec;
    const std::string id = neutralId(of.region, day, number);
    const fs::file_status there = fs::symlink_status(folders_.caseFolder(id), ec);
    const std::string neutral = neutralName(of.region, day, number);
    if (fs::exists(there) || (record.name.empty() && taken.contains(foldedName(neutral)))) continue;
    record.id = id;
    if (record.name.empty()) record.name = neutral;
  }
  record.folder = folders_.caseFolder(record.id);
  if (Status written = writeRecord(record, part); !written) return failed(written.error());
  if (!record.names_key.empty()) {
    const Status kept = part.writePrivate(record.names_key, pretty(guard.toJson()));
    if (!kept) return failed(kept.error());
  }
  if (Status there = part.becomeCase(record.folder); !there) return failed(there.error());
  progress.at(1.0, tr("The case is saved"));
  Result<CaseRecord> as_listed = this->record(record.id);
  if (!as_listed) return as_listed.error();
  record = *std::move(as_listed);
  return saved;
} catch (const std::bad_alloc&) {
  return outOfMemory(tr("to save the case"), "");
}

Result<LoadedCase> CaseLibrary::load(const std::string& id, const Progress& progress) try {
  Result<CaseRecord> read = record(id);
  if (!read) return read.error();
  LoadedCase loaded;
  loaded.record = *std::move(read);
  const fs::path& folder = loaded.record.folder;
  std::error_code ec;
  // Whatever it is: what is no file, a pipe perhaps, is said when it is read.
  const auto has = [&](const char* file) {
    return fs::symlink_status(folder / file, ec).type() != fs::file_type::not_found;
  };
  // Whatever went wrong, with the folder gone that is why; `where` is the case's own.
  const auto failed = [&](Error error, const char* file) {
    if (!fs::is_directory(folder, ec)) return noSuchCase(id);
    if (error.code != code::kCancelled) error.where = id + "/" + file;
    return error;
  };

  if (!has(kVolumeFile)) return failed(partMissing(id, kVolumeFile, "volume"), kVolumeFile);
  Result<Volume> volume = readVolume(folder / kVolumeFile, Progress(progress, 0.0, 0.7));
  if (!volume) return failed(volume.error(), kVolumeFile);
  progress.at(0.7, tr("Checking the volume"));
  if (!sameGrid(volume->geometry, loaded.record.grid) ||
      volumeSha256(*volume) != loaded.record.volume_sha256) {
    return caseChanged(id, kVolumeFile, "volume");
  }
  if (progress.cancelled())
    return Error{code::kCancelled, tr("Opening the case was cancelled"), "", ""};
  if (has(kStructuresFile)) {
    Result<LabelMap> map =
        structuresOn(volume->geometry, id, folder / kStructuresFile, Progress(progress, 0.8, 0.95));
    if (!map && map.error().code == code::kCancelled) return map.error();
    if (map) {
      loaded.structures = std::make_shared<const LabelMap>(*std::move(map));
    } else {
      loaded.structures_problem = failed(map.error(), kStructuresFile);
    }
  }
  for (const char* file : {kProvenanceFile, kTissuesFile}) {
    if (!has(file)) continue;
    Result<Json> json = readJsonFile(folder / file);
    if (file == kTissuesFile) {
      if (json) loaded.tissues = *std::move(json);
      if (!json) loaded.tissues_problem = failed(json.error(), file);
      if (json && isNone(loaded.tissues)) {
        loaded.tissues_problem = Error{code::kMissingFile, tr("The file holds no tissues"),
                                       id + "/" + file, tr("Save the case's tissues again")};
      }
      continue;
    }
    if (!json) return failed(json.error(), file);
    Result<Provenance> provenance = provenanceFrom(*json, id + "/" + file);
    if (!provenance) return provenance.error();
    loaded.provenance = *std::move(provenance);
    loaded.provenance->source_ids = idsOf(loaded.record, *loaded.provenance);
  }
  loaded.volume = std::make_shared<const Volume>(*std::move(volume));
  const std::vector<CaseStructure> listed =
      std::exchange(loaded.record.structures, loaded.structures ? structuresOf(*loaded.structures)
                                                                : std::vector<CaseStructure>());
  if (!loaded.structures_problem && !alike(listed, loaded.record.structures)) {
    mendRows(loaded.record);
  }
  progress.at(1.0, tr("The case is open"));
  return loaded;
} catch (const std::bad_alloc&) {
  return outOfMemory(tr("for the case"), id);
}

// Which CT a case is of, as far as this account may know.
SourceIds CaseLibrary::idsOf(const CaseRecord& record, const Provenance& provenance) const {
  if (record.names_key.empty()) return {};
  const Result<NameGuard> guard = NameGuard::read(folders_.privateFile(record.names_key));
  if (guard) return guard->source();
  SourceIds unknown;
  unknown.unreadable = provenance.source == "DICOM";
  return unknown;
}

// A program that ended between the structures and their rows in case.json left old ones. The list
// is right again where this can be written; the case is open either way.
void CaseLibrary::mendRows(const CaseRecord& of) const {
  const Result<Part> part = Part::make(folders_, Part::Of::someFiles);
  if (!part) return;
  const Result<FileLock> list_lock = folders_.lock();
  Result<CaseRecord> now = record(of.id);
  if (!list_lock || !now) return;
  now->structures = of.structures;
  if (writeRecord(*now, *part)) (void)part->replace(kCaseFile, now->folder);
}

Result<CaseRecord> CaseLibrary::rename(const std::string& id, const std::string& new_name) {
  Result<std::string> name = caseNameFrom(new_name);
  if (!name) return name.error();
  Result<CaseRecord> was = record(id);
  if (!was) return was;
  if (!was->names_key.empty() && !isNeutralName(*name) && *name != was->name) {
    const Result<NameGuard> guard = NameGuard::read(folders_.privateFile(was->names_key));
    if (!guard) {
      return Error{
          code::kNameUnchecked,
          tr("Whether this name tells who the patient is cannot be checked: what the case may "
             "not be called is not on this computer"),
          id, tr("Keep the name, or import the CT again")};
    }
    if (Status told = guard->check(*name); !told) return told.error();
  }
  Result<Part> part = Part::make(folders_, Part::Of::someFiles);
  if (!part) return ofStorage(part.error(), folders_, 1 << 16);
  const Result<FileLock> list_lock = folders_.lock();
  if (!list_lock) return list_lock.error();
  if (namesBeside(id).contains(foldedName(*name))) return nameTaken();
  Result<CaseRecord> now = record(id);
  if (!now) return now;
  now->name = *name;
  Status done = writeRecord(*now, *part);
  if (done) done = part->replace(kCaseFile, now->folder);
  if (!done) return ofStorage(done.error(), folders_, 1 << 16);
  return record(id);
}

Status CaseLibrary::remove(const std::string& id) {
  std::error_code ec;
  if (!isFolderName(id) || !fs::is_directory(folders_.caseFolder(id), ec)) return noSuchCase(id);
  const Result<FileLock> list_lock = folders_.lock();
  if (!list_lock) return list_lock.error();
  const bool whole = record(id).ok();
  const Status removed = removeCase(folders_, id);
  if (whole || !removed) return removed;
  // Its case.json may not have named its private file: it is the one that no other case names.
  std::set<std::string> keys;
  for (const ListedCase& other : list()) {
    if (other.record.volume_sha256.empty()) return removed;  // nor can that one be asked
    keys.insert(other.record.names_key);
  }
  folders_.keepPrivateOf(keys);
  return removed;
}

Result<CaseRecord> CaseLibrary::saveStructures(const std::string& id, const LabelMap& structures,
                                               const Progress& progress) try {
  Result<CaseRecord> was = record(id);
  if (!was) return was;
  if (!sameGrid(structures.geometry, was->grid)) return wrongGrid();
  std::vector<std::string> new_names;
  for (const Structure& s : structures.structures) {
    const bool old =
        std::ranges::find(was->structures, s.name, &CaseStructure::name) != was->structures.end();
    if (!old && s.name != "label " + std::to_string(s.label)) new_names.push_back(s.name);
  }
  if (!new_names.empty() && !was->names_key.empty()) {
    // A file that is not there tells nothing: names of organs do not wait for it.
    const Result<NameGuard> guard = NameGuard::read(folders_.privateFile(was->names_key));
    if (guard) {
      if (Status told = guard->checkPatient(new_names, progress); !told) return told.error();
    }
  }
  const std::uint64_t needed = structures.labels.size() / 8 + (1 << 20);
  if (Status room = folders_.roomFor(needed); !room) return room.error();
  Result<Part> part = Part::make(folders_, Part::Of::someFiles);
  if (!part) return ofStorage(part.error(), folders_, needed);
  const bool none = structures.structures.empty();
  if (!none) {
    const Status written = writeSegmentation(structures, *part / kStructuresFile, false, progress);
    if (!written) return ofStorage(written.error(), folders_, needed);
  }
  const Result<FileLock> list_lock = folders_.lock();
  if (!list_lock) return list_lock.error();
  Result<CaseRecord> now = record(id);  // it may have been renamed meanwhile
  if (!now) return now;
  now->structures = structuresOf(structures);
  // The file counts, and rows that are not its own are mended by load().
  Status done = writeRecord(*now, *part);
  std::error_code ec;
  if (done && !none) done = part->replace(kStructuresFile, now->folder);
  if (done && none) fs::remove(now->folder / kStructuresFile, ec);
  if (ec) done = writeError(now->folder / kStructuresFile, ec.value());
  if (done) done = part->replace(kCaseFile, now->folder);
  if (!done) return ofStorage(done.error(), folders_, needed);
  return record(id);
} catch (const std::bad_alloc&) {
  return outOfMemory(tr("to save the structures"), id);
}

Status CaseLibrary::saveTissues(const std::string& id, const Json& tissues) {
  Result<CaseRecord> was = record(id);
  if (!was) return was.error();
  const fs::path file = was->folder / kTissuesFile;
  if (isNone(tissues)) {
    std::error_code ec;
    fs::remove(file, ec);
    if (ec) return writeError(file, ec.value());
    return syncFolder(was->folder);
  }
  Result<Part> part = Part::make(folders_, Part::Of::someFiles);
  if (!part) return ofStorage(part.error(), folders_, 1 << 16);
  Status done = writeTextFile(*part / kTissuesFile, pretty(tissues));
  if (done) done = part->replace(kTissuesFile, was->folder);
  if (!done) return ofStorage(done.error(), folders_, 1 << 16);
  return {};
}

}  // namespace trephine
