// `commission`: whether this machine is fit, as JSON, in lines and as a page to be printed.
#include <algorithm>
#include <cstdio>

#include "app/answer.h"
#include "app/lab_commands.h"
#include "base/crash_report.h"
#include "base/file.h"
#include "lab/commission/commission.h"
#include "library/case_library.h"

namespace trephine {

int commissionCommand(const CommissionArguments& arguments, const Policy& policy, bool json,
                      const Progress& progress) {
  const char* name = "commission";
  const auto storage = storageOf(arguments.storage, policy);
  if (!storage) return printError(name, storage.error(), json);
  const std::filesystem::path out = arguments.out;
  if (Status made = makeFolder(out); !made) return printError(name, made.error(), json);
  CommissionOptions options;
  options.storage = *storage;
  options.seconds = arguments.seconds;
  for (const ListedCase& one : CaseLibrary(*storage).list()) {
    for (const int edge : one.record.grid.size) {
      options.largest_edge = std::max(options.largest_edge, edge);
    }
  }
  const Result<Commissioning> made = commission(options, progress);
  if (!made) return printError(name, made.error(), json);
  std::vector<CommissionChange> changes;
  const auto state = stateFolder();
  const std::filesystem::path last = state ? *state / "commission.json" : "";
  if (state) {
    if (const auto before = readCommissioning(last)) changes = changesSince(*before, *made);
  }
  const std::string text = toJson(*made).dump(1) + "\n";
  Status written = writeTextFile(out / "commission.json", text);
  if (written) written = writeTextFile(out / "commission.html", toHtml(*made, changes));
  if (!written) return printError(name, written.error(), json);
  if (state && makeFolder(*state)) (void)writeTextFile(last, text);  // the next compares with it
  if (json) {
    printAnswer(name, toJson(*made));
  } else {
    std::printf("%s%s\n", toText(*made, changes).c_str(), (out / "commission.html").c_str());
  }
  return 0;
}

}  // namespace trephine
