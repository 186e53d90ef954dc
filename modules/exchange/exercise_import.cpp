// A folder becomes an exercise of this workstation.
#include <algorithm>
#include <set>

#include "base/codes.h"
#include "base/disk_room.h"
#include "base/file.h"
#include "base/json.h"
#include "base/tr.h"
#include "base/utf8.h"
#include "case/case.h"
#include "exchange/exercise_folder.h"
#include "exchange/exercise_parts.h"
#include "exchange/named_files.h"
#include "exercise/exercise.h"
#include "session/operator_script.h"
#include "volume/phantom.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr Range kBytes{0, 1e15, "bytes"};
constexpr std::size_t kMostParts = 4096;

// Within the folder, wherever that lies: no way up, none from the root, none by another name.
bool staysWithin(const fs::path& file) {
  if (file.empty() || file.is_absolute()) return false;
  if (file.lexically_normal().native() != file.native()) return false;  // "tools//a.json" too
  return *file.begin() != ".." && *file.begin() != ".";
}

Error namesOutside(const std::string& file, const std::string& name) {
  return {code::kBadField, tr("It names '{}', which is no part of the exercise", name), file,
          tr("Export the exercise anew")};
}

// Whether a part belongs to a volume or label map that is named: its list of names or sidecar,
// called as it is, or voxels that its header names.
bool liesBeside(const fs::path& folder, const fs::path& part, const fs::path& named) {
  const std::string name = named.filename().string();
  const fs::path stem = named.parent_path() / name.substr(0, name.find('.', 1));
  for (const char* ending : {".json", ".structures.json", ".label", ".txt"}) {
    if (part == stem.string() + ending) return true;
  }
  const auto header = readVolumeFileHeader(folder / named);
  return header && header->data.file.lexically_normal() == (folder / part).lexically_normal();
}

// Everything that the exercise and its files name is among the parts, and nothing else is. Each
// file of JSON is read once, however often it is named.
Status namesPartsAlone(const fs::path& folder, const ExerciseCheck& check, Json& exercise,
                       const Progress& progress) {
  std::set<fs::path> parts, read, named{check.exercise}, volumes;
  for (const ExercisePart& part : check.parts) parts.insert(part.file);
  const auto isPart = [&](const std::string& by, const std::string& name) {
    const fs::path file = (fs::path(by).parent_path() / name).lexically_normal();
    named.insert(file);
    return parts.contains(file) ? Status() : Status(namesOutside(by, name));
  };
  const Status all =
      eachNamedFile(exercise, [&](NamedFile kind, const std::string&, Json& name) -> Status {
        const std::string file = name.get<std::string>();
        if (progress.cancelled()) return Error{code::kCancelled, tr("It was cancelled"), "", ""};
        if (Status is = isPart(check.exercise, file); !is) return is;
        const fs::path path = (fs::path(check.exercise).parent_path() / file).lexically_normal();
        if (kind == NamedFile::caseVolume || kind == NamedFile::labels) volumes.insert(path);
        if (kind != NamedFile::tissues && kind != NamedFile::tool) return {};
        if (!read.insert(path).second) return {};
        Result<Json> json = readJsonFile(folder / path, progress, kMostWrittenBytes);
        if (!json) return json.error();
        const Json* inner = kind == NamedFile::tool ? meshOf(*json) : elsewhereOf(*json);
        return inner ? isPart(path.string(), inner->get<std::string>()) : Status();
      });
  if (!all) return all;
  for (const fs::path& part : parts) {
    if (named.contains(part)) continue;
    const bool beside = std::ranges::any_of(
        volumes, [&](const fs::path& volume) { return liesBeside(folder, part, volume); });
    if (!beside) {
      return Error{code::kBadField,
                   tr("Nothing in the exercise names its part '{}'", part.string()), kListFile,
                   tr("Export the exercise anew")};
    }
  }
  return {};
}

// Before any of it is read: a part may say any size, and have it without taking room.
double bytesOf(const ExerciseCheck& check) {
  double bytes = 0.0;
  for (const ExercisePart& part : check.parts) bytes += double(part.bytes);
  return bytes;
}

// Reads all that the exercise of a folder consists of, to its end: what cannot be read here cannot
// be opened later.
Status readWhole(const fs::path& exercise_file, const Progress& progress) {
  const Result<Exercise> exercise = readExercise(exercise_file);
  if (!exercise) return exercise.error();
  if (!exercise->operator_file.empty()) {
    const Result<OperatorScript> script = readOperatorScript(exercise->operator_file, *exercise);
    if (!script) return script.error();
  }
  if (exercise->case_source.empty()) return {};
  if (phantomNamed(exercise->case_source) && exercise->labels_file.empty()) return {};
  const Result<Case> of = readCase(exercise->case_source, Progress(progress, 0.0, 0.8));
  if (!of) return of.error();
  if (exercise->labels_file.empty()) return {};
  const Result<Case> labelled =
      withLabels(*of, exercise->labels_file, Progress(progress, 0.8, 1.0));
  return labelled ? Status() : Status(labelled.error());
}

// The same exercise, in the same words, from an earlier import.
bool isThere(const fs::path& target, const fs::path& part, const Progress& progress) {
  const Result<Json> here = readJsonFile(target / kListFile),
                     there = readJsonFile(part / kListFile);
  if (!here || !there || *here != *there) return false;
  const Result<ExerciseCheck> check = checkExercise(target, progress);
  return check && check->verified();
}

// An error about a part names the part, not the folder that the import makes.
Error inFolder(Error error, const fs::path& part) {
  const std::string folder = part.string() + '/';
  for (std::string* text : {&error.what, &error.where, &error.next}) {
    for (std::size_t at; (at = text->find(folder)) != std::string::npos;) {
      text->erase(at, folder.size());
    }
  }
  return error;
}

// The n-th folder of that name, from 1 on.
fs::path numbered(const fs::path& storage, const std::string& stem, int n) {
  return storage / "exercises" / (n == 1 ? stem : stem + "-" + std::to_string(n));
}

// What a folder says that it holds; nothing of that is read.
Result<ExerciseCheck> listOf(const fs::path& folder) {
  std::error_code ec;
  if (fs::is_symlink(folder / kListFile, ec)) {
    return Error{code::kMissingFile, tr("The exercise's list is a link to another file"),
                 (folder / kListFile).string(), tr("Give a folder that 'exercise export' wrote")};
  }
  Result<Json> json = readJsonFile(folder / kListFile);
  if (!json) {
    Error error = json.error();
    if (error.code == code::kMissingFile)
      error.next = tr("Give a folder that 'exercise export' wrote");
    return error;
  }
  ExerciseCheck check;
  JsonReader reader(*json, (folder / kListFile).string());
  reader.format("trephine.exercise", 1);
  check.exercise = reader.text("scene");
  bool exercise_listed = false;
  std::set<std::string> listed;
  for (JsonReader& item : reader.objects("parts", kMostParts)) {
    ExercisePart part;
    part.file = item.text("file");
    part.sha256 = item.text("sha256");
    part.bytes = std::uint64_t(item.integer("bytes", kBytes));
    if (item.ok() && !staysWithin(part.file)) {
      item.fail("file", tr("'{}' lies outside of the folder", part.file));
    } else if (item.ok() && part.file != cleanUtf8(part.file)) {
      item.fail("file", tr("'{}' has letters that nobody sees", cleanUtf8(part.file)));
    } else if (item.ok() && !listed.insert(part.file).second) {
      item.fail("file", tr("'{}' is listed twice", part.file));
    }
    exercise_listed = exercise_listed || part.file == check.exercise;
    check.parts.push_back(std::move(part));
  }
  if (reader.ok() && check.exercise != kSceneFile) {
    reader.fail("scene", tr("It must be '{}'", kSceneFile), tr("Export the exercise anew"));
  }
  if (reader.ok() && !exercise_listed) reader.fail("scene", tr("It is not among the parts"));
  if (Status read = reader.finish(); !read) return read.error();
  return check;
}

// CANCELLED.
Status verify(const fs::path& folder, ExerciseCheck& check, const Progress& progress) {
  std::uint64_t bytes = 0, done = 0;
  for (const ExercisePart& part : check.parts) bytes += part.bytes;
  for (const ExercisePart& part : check.parts) {
    progress.at(double(done) / double(std::max<std::uint64_t>(1, bytes)),
                tr("Checking the exercise"));
    const Result<ExercisePart> found = partOf(folder, part.file, progress, part.bytes);
    done += part.bytes;
    if (!found && found.error().code == code::kCancelled) return found.error();
    if (!found && found.error().code == code::kMissingFile) {
      check.missing.push_back(part.file);
    } else if (!found || found->sha256 != part.sha256 || found->bytes != part.bytes) {
      check.changed.push_back(part.file);
    }
  }
  return {};
}

}  // namespace

fs::path exportedExercise(const fs::path& chosen) {
  std::error_code ec;
  const std::string name = chosen.filename().string();
  const bool of_it = name == kListFile || name == kSceneFile;
  const fs::path folder = fs::is_directory(chosen, ec) ? chosen
                          : of_it                      ? chosen.parent_path()
                                                       : fs::path();
  if (folder.empty() || !fs::exists(folder / kListFile, ec)) return {};
  const Result<Json> list = readJsonFile(folder / kListFile);
  // What is broken in it is said by who imports it.
  if (!list || !list->is_object() || !list->contains("format")) return {};
  return list->at("format") == "trephine.exercise" ? folder / kSceneFile : fs::path();
}

fs::path exerciseThatBrought(const fs::path& storage, const fs::path& file) {
  const fs::path below = file.lexically_normal().lexically_relative(storage / "exercises");
  if (below.empty() || below.begin()->string() == ".." || !below.has_parent_path()) return {};
  return storage / "exercises" / *below.begin() / kSceneFile;
}

bool isOfOwnExercise(const fs::path& storage, const fs::path& file) {
  return !exerciseThatBrought(storage, file).empty();
}

bool isOwnExercise(const fs::path& storage, const fs::path& exercise) {
  return exercise.parent_path().parent_path() == storage / "exercises";
}

Result<ExerciseCheck> checkExercise(const fs::path& folder, const Progress& progress) {
  Result<ExerciseCheck> check = listOf(folder);
  if (!check) return check;
  if (Status read = verify(folder, *check, progress); !read) return read.error();
  return check;
}

Result<ImportedExercise> importExercise(const fs::path& folder, const fs::path& storage,
                                        const Progress& progress) {
  Result<ExerciseCheck> check = listOf(folder);
  if (!check) return check.error();
  PartFolder::removeLeft(storage / "exercises");
  if (Status room = enoughRoom(storage, bytesOf(*check), tr("the exercise")); !room) {
    return room.error();
  }
  if (Status read = verify(folder, *check, Progress(progress, 0.0, 0.3)); !read) {
    return read.error();
  }
  ImportedExercise imported{{}, *std::move(check)};
  if (!imported.check.verified()) return imported;
  Result<Json> exercise =
      readJsonFile(folder / imported.check.exercise, progress, kMostWrittenBytes);
  if (!exercise) return exercise.error();
  if (Status names = namesPartsAlone(folder, imported.check, *exercise, progress); !names) {
    return names.error();
  }
  const Result<Exercise> parsed = parseExercise(*exercise, folder / imported.check.exercise);
  if (!parsed) return parsed.error();

  const std::string stem = plainName(parsed->name, "exercise");
  Result<PartFolder> part = PartFolder::make(numbered(storage, stem, 1));
  if (!part) return part.error();
  progress.at(0.3, tr("Copying the exercise"));
  for (const ExercisePart& one : imported.check.parts) {
    if (progress.cancelled()) return Error{code::kCancelled, tr("It was cancelled"), "", ""};
    if (Status copied = part->copy(folder / one.file, one.file); !copied) return copied.error();
  }
  if (Status copied = part->copy(folder / kListFile, kListFile); !copied) return copied.error();
  // The stick may have gone bad, or changed, on the way.
  Result<ExerciseCheck> copy = checkExercise(part->path(), Progress(progress, 0.5, 0.7));
  if (!copy) return copy.error();
  if (!copy->verified()) return ImportedExercise{{}, *std::move(copy)};
  const Result<Json> copied = readJsonFile(part->path() / imported.check.exercise);
  if (!copied || *copied != *exercise) {
    imported.check.changed.push_back(imported.check.exercise);
    return ImportedExercise{{}, std::move(imported.check)};
  }
  // In a folder that holds its parts alone: a file beside them is read by nobody.
  const Status whole =
      readWhole(part->path() / imported.check.exercise, Progress(progress, 0.75, 0.95));
  if (!whole) return inFolder(whole.error(), part->path());

  for (int n = 1;; ++n) {
    const fs::path target = numbered(storage, stem, n);
    std::error_code ec;
    const fs::file_type there = fs::symlink_status(target, ec).type();
    if (there == fs::file_type::none) return writeError(target, ec.value());
    imported.exercise = target / imported.check.exercise;
    if (there != fs::file_type::not_found) {
      if (!isThere(target, part->path(), Progress(progress, 0.95, 1.0))) continue;
      return imported;
    }
    Status done = part->becomeAt(target);
    if (!done && fs::exists(target, ec)) {  // another import was faster: of the same, perhaps
      --n;
      continue;
    }
    if (!done) return done.error();
    return imported;
  }
}

std::vector<fs::path> exercisesIn(const fs::path& storage) {
  std::vector<fs::path> exercises;
  std::error_code ec;
  for (auto at = fs::directory_iterator(storage / "exercises", ec); !ec && at != fs::end(at);
       at.increment(ec)) {
    const std::string name = at->path().filename().string();
    std::error_code none;
    const fs::path exercise = at->path() / kSceneFile;
    if (!name.starts_with('.') && fs::is_regular_file(exercise, none))
      exercises.push_back(exercise);
  }
  std::ranges::sort(exercises);
  return exercises;
}

fs::path freshExercise(const fs::path& storage, const std::string& name) {
  const std::string stem = plainName(name, "exercise");
  for (int n = 1;; ++n) {
    const fs::path folder = numbered(storage, stem, n);
    std::error_code ec;
    const fs::file_type there = fs::symlink_status(folder, ec).type();
    // What cannot be looked at cannot be written either, and that says why.
    if (there == fs::file_type::not_found || there == fs::file_type::none) return folder;
  }
}

}  // namespace trephine
