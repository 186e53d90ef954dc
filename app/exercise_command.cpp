// `exercise export` and `exercise import`: an exercise as a folder that goes to other workstations.
#include <cstdio>

#include "app/answer.h"
#include "app/codes.h"
#include "app/lab_commands.h"
#include "base/system.h"
#include "base/utf8.h"
#include "exchange/exercise_folder.h"
#include "library/name_words.h"

namespace trephine {

namespace fs = std::filesystem;

Result<fs::path> storageOf(const std::string& given, const Policy& policy) {
  if (!given.empty()) return fs::path(given);
  if (!policy.storage.empty()) return policy.storage;
  if (policy.problem) return *policy.problem;  // which says where it is, perhaps
  if (const auto own = dataFolder()) return *own;
  return Error{code::kNoStorage, "It is not known where cases and exercises are kept", "--storage",
               "Give a folder"};
}

namespace {

std::string listed(const char* title, const std::vector<std::string>& files) {
  std::string text;
  for (const std::string& file : files)
    text += "  " + std::string(title) + ": " + cleanUtf8(file) + "\n";
  return text;
}

}  // namespace

int exportExerciseCommand(const std::string& exercise, const std::string& case_source,
                          const std::string& out, bool json, const Progress& progress) {
  const auto exported = exportExercise(exercise, case_source, out, progress, hideNamesOf);
  if (!exported) return printError("exercise-export", exported.error(), json);
  Json parts = Json::array();
  for (const ExercisePart& part : exported->parts) parts.push_back(toJson(part));
  if (json) {
    printAnswer("exercise-export", {{"folder", exported->folder.string()}, {"parts", parts}});
  } else {
    say("%s: %zu files\n", cleanUtf8(exported->folder.string()).c_str(), exported->parts.size());
  }
  return 0;
}

int importExerciseCommand(const std::string& folder, const std::string& storage,
                          const Policy& policy, bool json, const Progress& progress) {
  const auto to = storageOf(storage, policy);
  if (!to) return printError("exercise-import", to.error(), json);
  const auto imported = importExercise(folder, *to, progress);
  if (!imported) return printError("exercise-import", imported.error(), json);
  const ExerciseCheck& check = imported->check;
  if (json) {
    printAnswer("exercise-import", {{"scene", imported->exercise.string()},
                                    {"verified", check.verified()},
                                    {"missing", check.missing},
                                    {"changed", check.changed}});
  } else if (check.verified()) {
    say("%s\n", cleanUtf8(imported->exercise.string()).c_str());
  } else {
    sayError("It is not the exercise that was exported; nothing was written.\n%s%s",
             listed("missing", check.missing).c_str(), listed("changed", check.changed).c_str());
  }
  return check.verified() ? 0 : 1;
}

}  // namespace trephine
