// The folder of an exercise while it is written, and its list. For this room's .cpp files.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/locked_folder.h"
#include "base/progress.h"
#include "base/result.h"
#include "exchange/exercise_folder.h"

namespace trephine {

inline constexpr const char* kListFile = "exercise.json";
inline constexpr const char* kSceneFile = "scene.json";

// Letters, digits and "-" of a text, at most 40; `otherwise` where nothing is left.
std::string plainName(const std::string& text, const std::string& otherwise);

// CANNOT_WRITE where something is there that is not an empty folder.
Status checkFreeFolder(const std::filesystem::path& folder);

// Of a regular file; a link is none. Where `expected_bytes` is given, a file of another size is not
// read. Errors: MISSING_FILE, OTHER_SIZE, UNREADABLE, CANCELLED.
Result<ExercisePart> partOf(const std::filesystem::path& folder, const std::string& file,
                            const Progress& progress,
                            std::optional<std::uint64_t> expected_bytes = {});

// Beside the folder that it is to be; gone with this unless it became that. What a program that was
// killed has left, the next one removes.
class PartFolder {
 public:
  static Result<PartFolder> make(const std::filesystem::path& target);
  // What this account's programs that were killed have left in a folder; make() does it as well.
  static void removeLeft(const std::filesystem::path& folder);
  const std::filesystem::path& path() const { return folder_.path(); }
  // `file` is a path in the folder; `write` leaves it whole and on the disk (replaceFile).
  Status write(const std::string& file,
               const std::function<Status(const std::filesystem::path&)>& write);
  Status writeText(const std::string& file, std::string_view text);
  Status copy(const std::filesystem::path& from, const std::string& file);
  // A surface: the same triangles, without what its header says of who made it and where.
  Status copyMesh(const std::filesystem::path& from, const std::string& file);
  // The list of all that lies here, the exercise first.
  Result<std::vector<ExercisePart>> writeList(const std::string& exercise,
                                              const Progress& progress);
  // The folder that it was made for, by one rename. CANNOT_WRITE.
  Status become();
  // The same at another place in that folder.
  Status becomeAt(const std::filesystem::path& target);
  // The same in the place of one that is there, which goes: either is whole at any time. What a
  // person has put into it stays: every file but `own`, paths in the folder.
  Status becomeInstead(const std::set<std::filesystem::path>& own);

 private:
  Status keepOthers(const std::set<std::filesystem::path>& own);
  PartFolder(LockedFolder folder, std::filesystem::path target)
      : folder_(std::move(folder)), target_(std::move(target)) {}

  LockedFolder folder_;
  std::filesystem::path target_;
};

}  // namespace trephine
