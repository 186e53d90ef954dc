// `storage list` and `storage share`: the folder of cases, exercises and recordings of a machine.
#include <sys/stat.h>

#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>

#include "app/answer.h"
#include "app/lab_commands.h"
#include "base/codes.h"
#include "base/utf8.h"
#include "library/case_library.h"
#include "library/shared_storage.h"
#include "tissue/tissue_set.h"

namespace trephine {

namespace {

// Why not all of a case can be used.
std::optional<Error> problemOf(const Result<LoadedCase>& loaded, const std::string& id) {
  if (!loaded) return loaded.error();
  if (loaded->structures_problem) return loaded->structures_problem;
  if (loaded->tissues_problem) return loaded->tissues_problem;
  if (loaded->tissues.is_object() && loaded->tissues.empty()) return {};
  const Result<TissueSet> set = parseTissueSet(loaded->tissues, id + "/tissues.json");
  return set ? std::nullopt : std::optional(set.error());
}

}  // namespace

int listStorageCommand(const std::string& storage, bool open, const Policy& policy, bool json,
                       const Progress& progress) {
  const auto at = storageOf(storage, policy);
  if (!at) return printError("storage-list", at.error(), json);
  std::error_code ec;
  const bool there = std::filesystem::exists(*at, ec);
  const bool wanted = !storage.empty() || !policy.storage.empty();
  if (!ec && !there && wanted) {
    return printError("storage-list",
                      {code::kMissingFolder, "This folder is not there", at->string(),
                       "Check its name, and whether its disk is connected"},
                      json);
  }
  std::filesystem::directory_iterator look(*at / "cases", ec);
  if (ec == std::errc::permission_denied) {
    return printError(
        "storage-list",
        {code::kCannotRead, "This account may not look at the cases here", at->string(),
         "Ask an administrator for the group trephine, and log in again"},
        json);
  }
  CaseLibrary library(*at);
  const std::vector<ListedCase> all = library.list();
  Json cases = Json::array();
  std::size_t bad = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::optional<Error> problem = all[i].problem;
    if (open && !problem) {
      const Progress part(progress, double(i) / double(all.size()),
                          double(i + 1) / double(all.size()));
      problem = problemOf(library.load(all[i].id, part), all[i].id);
    }
    if (progress.cancelled()) {
      return printError("storage-list", {code::kCancelled, "The cases were not all opened", "", ""},
                        json);
    }
    bad += problem ? 1 : 0;
    if (json) {
      cases.push_back({{"id", all[i].id},
                       {"name", all[i].record.name},
                       {"problem", problem ? errorJson(*problem) : Json(nullptr)}});
    } else {
      // The name of a folder that others made may hold what a terminal obeys.
      const std::string said = problem ? problem->sentence() : all[i].record.name;
      say("%s: %s\n", cleanUtf8(all[i].id).c_str(), cleanUtf8(said).c_str());
    }
  }
  if (json) printAnswer("storage-list", {{"storage", at->string()}, {"cases", cases}});
  if (!json && all.empty()) say("No case is kept in %s\n", cleanUtf8(at->string()).c_str());
  return bad > 0 ? 1 : 0;
}

int shareStorageCommand(const std::string& folder, bool json) {
  ::umask(022);  // what is made on the way others may pass
  const auto shared = shareStorage(folder);
  if (!shared) return printError("storage-share", shared.error(), json);
  const StorageGroups groups;
  if (json) {
    printAnswer(
        "storage-share",
        {{"storage", shared->string()}, {"readers", groups.readers}, {"writers", groups.writers}});
  } else {
    say("%s: the group %s may look at cases and exercises, the group %s may change them, and each\n"
        "keeps recordings of his own. Accounts that make cases belong to both groups.\n"
        "Name the folder as \"storage\" in /etc/trephine/settings.json.\n",
        cleanUtf8(shared->string()).c_str(), groups.readers.c_str(), groups.writers.c_str());
  }
  return 0;
}

}  // namespace trephine
