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

// An exercise that is made on this workstation: the exercise and the files that it names, in a
// folder of its own, in the place of what is there: files that are not of the exercise stay. Its
// case and label map stay where they are and are named from there, within `storage` relatively. The
// same exercise, read and saved again, gives the same bytes. The exercise's file. Errors: those of
// readExercise (what it names is not there, a number out of range), CANNOT_WRITE, CANCELLED.
Result<std::filesystem::path> saveExercise(const Exercise& exercise,
                                           const std::filesystem::path& folder,
                                           const std::filesystem::path& storage,
                                           const Progress& progress = Progress());

// The exercises below `storage`/exercises: their exercise files, in the order of their folders'
// names.
std::vector<std::filesystem::path> exercisesIn(const std::filesystem::path& storage);
// A folder there that is free, called after the exercise.
std::filesystem::path freshExercise(const std::filesystem::path& storage, const std::string& name);

struct ExportedExercise {
  std::filesystem::path folder;
  std::vector<ExercisePart> parts;  // the exercise first
};

// Writes the folder, whole or not at all. The case is read as `run` reads it and written as a
// volume and a label map; `case_source`, also a folder of the library, instead of the exercise's
// own where it is not empty. Errors: those of readExercise, readCase and of writing; CANNOT_WRITE
// where `folder` is there and not empty; CANCELLED. `hide` as of withLabels() (session/case.h).
Result<ExportedExercise> exportExercise(const std::filesystem::path& exercise,
                                        const std::string& case_source,
                                        const std::filesystem::path& folder,
                                        const Progress& progress = Progress(),
                                        const NameHider& hide = {});

// What of a folder is not there or not what was exported, by its path in the folder.
struct ExerciseCheck {
  std::vector<ExercisePart> parts;  // as the folder lists them
  std::string exercise;             // its path in the folder
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
// Copies a verified folder to `storage`/exercises, whole or not at all; what is
// there already in the same words is taken as it is. Case, structures and script are read to their
// end from the copy, which holds nothing but the parts. Nothing is kept of one that is not verified
// or cannot be read. Errors: those of checkExercise, readExercise, readCase and withLabels;
// BAD_FIELD where a file of it names one outside of the folder, or nothing names a part;
// CANNOT_WRITE, also where the disk has no room for the parts, of which then none is read;
// CANCELLED.
Result<ImportedExercise> importExercise(const std::filesystem::path& folder,
                                        const std::filesystem::path& storage,
                                        const Progress& progress = Progress());

}  // namespace trephine
