// `commission`: whether this machine is fit, as JSON, in lines and as a page to be printed.
#include <algorithm>
#include <cstdio>
#include <tuple>

#include "app/answer.h"
#include "app/lab_commands.h"
#include "base/file.h"
#include "base/log.h"
#include "base/system.h"
#include "base/utf8.h"
#include "library/case_library.h"
#include "machine/commission/arm_checks.h"
#include "machine/commission/commission.h"
#include "machine/commission/start_check.h"
#include "machine/trades/recommended.h"

namespace trephine {

int commissionCommand(const CommissionArguments& arguments, const Policy& policy, bool json,
                      const Progress& progress) {
  const char* name = "commission";
  const std::filesystem::path out = arguments.out;
  if (arguments.say_progress) reportInLines();
  if (arguments.arms_alone) {
    const Json checks = toJson(tryArms(arguments.patience_s, progress));
    // Not to stdout, to which drivers may write as well.
    const Status told = writeTextFile(out / kArmsAnswer, Json{{"checks", checks}}.dump());
    return told ? 0 : printError(name, told.error(), json);
  }
  const auto storage = storageOf(arguments.storage, policy);
  if (!storage) return printError(name, storage.error(), json);
  if (Status made = makeFolder(out); !made) return printError(name, made.error(), json);
  // Room for its pages, before the minutes that it takes.
  if (Status fits = tryRoom(out, 100'000); !fits) return printError(name, fits.error(), json);
  CommissionOptions options;
  options.storage = *storage;
  options.storage_is_set = *storage == policy.storage;
  options.seconds = arguments.seconds;
  options.patience_s = arguments.patience_s;
  for (const ListedCase& one : CaseLibrary(*storage).list()) {
    for (const int edge : one.record.grid.size) {
      options.largest_edge = std::max(options.largest_edge, edge);
    }
  }
  const Result<Commissioning> made = commission(options, progress);
  if (!made) return printError(name, made.error(), json);
  CommissionChanges changes;
  const auto state = stateFolder();
  const auto before = lastCommissioning(state.value_or(std::filesystem::path()), policy.folder);
  if (before) changes = changesSince(*before, *made);
  const std::string text = toJson(*made).dump(1) + "\n";
  const std::string recommended = toJson(made->recommended).dump(2) + "\n";
  std::vector<RecommendedSetting> own_now = made->recommended;
  const auto config = configFolder();
  std::error_code ec;
  if (config && std::filesystem::exists(*config / "recommended.json", ec)) {
    const auto own = readRecommended(*config / "recommended.json");
    if (own) {
      own_now = renewed(*own, made->recommended);
    } else {
      spdlog::warn("A recommended.json is made anew. {}", own.error().sentence());
    }
  }
  const std::string stands = toJson(own_now).dump(2) + "\n";
  // The next compares with it, and what is recommended here stands from now on.
  for (const auto& [folder, file, words] : {std::tuple(state, "commission.json", &text),
                                            std::tuple(config, "recommended.json", &stands)}) {
    if (!folder) continue;
    Status kept = makeFolder(*folder);
    if (kept) kept = writeTextFile(*folder / file, *words);
    if (!kept) spdlog::warn("{} is not kept for the next time. {}", file, kept.error().sentence());
  }
  Status written = writeTextFile(out / "commission.json", text);
  if (written) written = writeTextFile(out / "commission.html", toHtml(*made, changes));
  if (written) written = writeTextFile(out / "recommended.json", recommended);
  if (!written) return printError(name, written.error(), json);
  if (json) {
    Json answer = toJson(*made);
    answer["changes"] = toJson(changes);
    answer["page"] = (out / "commission.html").string();
    printAnswer(name, answer);
  } else {
    say("%s%s\n", toText(*made, changes).c_str(),
        cleanUtf8((out / "commission.html").string()).c_str());
  }
  return 0;
}

}  // namespace trephine
