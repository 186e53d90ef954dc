// Whom and what a series is of, in the words of its source: for the screen, and to be compared with
// a name that a person gives. Never in a file, log or picture.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace trephine {

enum class IdentityKind { patient_name, patient_id, accession, study_id, folder, file };

struct SourceIdentity {
  // Valid UTF-8. A patient's name as DICOM has it: parts between '^', other ways of writing it
  // (ideographic, phonetic) between '='. A file's name with its ending.
  std::map<IdentityKind, std::set<std::string>> texts;

  bool empty() const { return texts.empty(); }
  // Blank texts are left out.
  void add(IdentityKind kind, const std::string& text);
  void add(const SourceIdentity& other);
  // The names of a file and of all folders that it lies in.
  void addFile(const std::filesystem::path& file);
};

}  // namespace trephine
