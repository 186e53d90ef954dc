// An exercise as a folder that goes to other workstations: the exercise, every file that it names,
// and the sha256 of each, under names that say nothing of where they came from.
// resources/schemas/exercise.md.
//
// Any thread; nothing throws.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "case/case.h"

namespace trephine {

struct ExercisePart {
  std::string file;  // "tools/blade.json": its path in the folder
  std::string sha256;
  std::uint64_t bytes = 0;
};

Json toJson(const ExercisePart& part);

struct Exercise;

// Saves an exercise of this workstation in `folder`, whole or not at all: scene.json and copies of
// the files that it names. Of an exercise that is there, its own files go; what a person has put
// beside them stays, under another name ("-kept") where the name is needed. The case and the label
// map are not copied: they are named by a relative path where they lie within `storage`, else by
// the whole path. The same exercise, read and saved again, gives the same bytes. Returns the path
// of scene.json. Errors: those of readExercise (what it names is not there, a number out of range),
// CANNOT_WRITE, CANCELLED.
Result<std::filesystem::path> saveExercise(const Exercise& exercise,
                                           const std::filesystem::path& folder,
                                           const std::filesystem::path& storage,
                                           const Progress& progress = Progress());

// The exercises below `storage`/exercises: their exercise files, in the order of their folders'
// names.
std::vector<std::filesystem::path> exercisesIn(const std::filesystem::path& storage);
// A folder there that is free, called after the letters and digits of `name`. It is not made: two
// callers may get the same.
std::filesystem::path freshExercise(const std::filesystem::path& storage, const std::string& name);

struct ExportedExercise {
  std::filesystem::path folder;
  std::vector<ExercisePart> parts;  // the exercise first
};

// Writes `folder`, whole or not at all. The case is read by readCase() (case/case.h) and written as
// a volume and a label map. `case_source`, where it is not empty, stands for the exercise's own:
// what readCase() takes, or a case's folder in the library. `hide` as of withLabels()
// (case/case.h): without it names of structures that tell who the patient is stay; hideNamesOf
// (library/name_words.h) hides them. Errors: those of readExercise, readCase and of writing;
// CANNOT_WRITE where `folder` is there and not empty; CANCELLED.
Result<ExportedExercise> exportExercise(const std::filesystem::path& exercise,
                                        const std::string& case_source,
                                        const std::filesystem::path& folder,
                                        const Progress& progress = Progress(),
                                        const NameHider& hide = {});

// The exercise in the folder that exportExercise() wrote, of what a person may choose of it: the
// folder, its list or the exercise. Empty where it is none. One that was imported has such a list,
// too.
std::filesystem::path exportedExercise(const std::filesystem::path& chosen);
// Whether a file is of one of the exercises below `storage`/exercises: the exercise itself, or what
// it came with.
bool isOfOwnExercise(const std::filesystem::path& storage, const std::filesystem::path& file);
// That exercise; empty where the file is of none.
std::filesystem::path exerciseThatBrought(const std::filesystem::path& storage,
                                          const std::filesystem::path& file);
// Whether the exercise is one of those below `storage`/exercises.
bool isOwnExercise(const std::filesystem::path& storage, const std::filesystem::path& exercise);

// What of a folder is missing or is not what was exported, by its path in the folder; files that
// the list does not name are not looked at.
struct ExerciseCheck {
  std::vector<ExercisePart> parts;  // as exercise.json lists them, sha256 in small hex digits
  std::string exercise;             // its path in the folder: always scene.json
  std::vector<std::string> missing, changed;
  bool verified() const { return missing.empty() && changed.empty(); }
};
// Errors: MISSING_FILE (no exercise.json, or a link in its place), BAD_JSON, BAD_FIELD (a newer
// version; a part outside of the folder or listed twice), CANCELLED.
Result<ExerciseCheck> checkExercise(const std::filesystem::path& folder,
                                    const Progress& progress = Progress());

struct ImportedExercise {
  std::filesystem::path exercise;  // in the storage, for `run`; empty where it was not verified
  ExerciseCheck check;
};
// Copies a verified folder to `storage`/exercises, whole or not at all; where an exercise with the
// same list of parts is there already, whole, that one is returned. Case, structures and script are
// read to their end from the copy, which holds nothing but the parts. Nothing is kept of one that
// is not verified or cannot be read. Errors: those of checkExercise, readExercise, readCase and
// withLabels; BAD_FIELD where a file of it names one outside of the folder, or nothing names a
// part; CANNOT_WRITE, also where the disk has no room for the parts: then no part is read;
// CANCELLED.
Result<ImportedExercise> importExercise(const std::filesystem::path& folder,
                                        const std::filesystem::path& storage,
                                        const Progress& progress = Progress());

}  // namespace trephine
