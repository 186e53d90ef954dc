// A case as the list of cases shows it: one of the library's, one that came with an exercise, or a
// built-in one.
#pragma once

#include <QImage>
#include <QString>
#include <optional>
#include <string>
#include <vector>

#include "case/case.h"
#include "library/case_library.h"
#include "training/recording_list.h"
#include "volume/phantom.h"

namespace trephine {

struct CaseEntry {
  std::string id;  // the library's; of a built-in one its name, "cranium", "abdomen"
  bool built_in = false;
  std::filesystem::path exercise{};  // that brought the case along; empty: none did
  CaseRecord record;                 // of the library; else name and grid, as far as they are known
  std::optional<Error> problem;  // why it cannot be opened
  QImage picture;                // null: there is none
  bool isOfLibrary() const { return !built_in && exercise.empty(); }
  // ListedRecording::caseKey() of what was done on it; empty where nothing is known of it.
  std::string caseKey() const { return built_in ? phantomSource(id) : record.volume_sha256; }
};

// The picture and what stands below it: name, size, verdict, structures.
QString cardWords(const CaseEntry& entry);
// The same at length, for the chosen one: plain text.
QString detailWords(const CaseEntry& entry);
// What a case is and shows, in a few lines.
QString caseWords(const Case& of);

// Of the case that came with the exercise of this file.
std::string idOfExercise(const std::filesystem::path& exercise_file);

// All that there is to practise on: the library's, the newest first, then those of the exercises
// below `storage` that brought theirs, then the built-in ones. Takes some hundredths of a second a
// case. Any thread.
std::vector<CaseEntry> listCases(const CaseLibrary& library, const std::filesystem::path& storage);

}  // namespace trephine
