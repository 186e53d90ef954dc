#include "machine/commission/start_check.h"

#include <algorithm>

#include "base/tr.h"
#include "machine/codes.h"
#include "machine/commission/arm_checks.h"
#include "machine/commission/disk_check.h"
#include "machine/ticks/jitter_measurement.h"

namespace trephine {

namespace {

constexpr double kRate_hz = 1000.0, kTicks_s = 1.0, kDiskTry_s = 1.0;
constexpr std::size_t kDiskBytes = 32'000'000;

}  // namespace

Result<Commissioning> lastCommissioning(const std::filesystem::path& own_folder,
                                        const std::filesystem::path& hospital_folder) {
  std::optional<Commissioning> last;
  for (const std::filesystem::path& folder : {own_folder, hospital_folder}) {
    if (folder.empty()) continue;
    Result<Commissioning> read = readCommissioning(folder / "commission.json");
    if (read && (!last || read->when > last->when)) last = *std::move(read);
  }
  if (last) return *std::move(last);
  return Error{code::kNotCommissioned, tr("This workstation was not commissioned yet"), "",
               tr("See Help")};
}

Result<std::vector<CommissionCheck>> checkAtStart(const StartSurroundings& surroundings,
                                                  const Progress& progress) {
  std::vector<CommissionCheck> checks;
  HostClock clock;
  const auto measure = [&](bool real_time) {
    return measureJitterRow(kRate_hz, real_time, kTicks_s, clock, progress, 0.0, 0.4);
  };
  Result<JitterRow> row = measure(true);
  const bool granted = row || row.error().code != code::kNoRealTime;
  if (!granted) row = measure(false);
  if (!row) return row.error();
  const auto lateness = [&] {
    return judged(granted ? "lateness_1000_fifo" : "lateness_1000_normal", row->p999_us);
  };
  CommissionCheck late = lateness();
  if (late.verdict != Fitness::pass) {  // a program that begins is busy: once more
    row = measure(granted);
    if (!row) return row.error();
    if (const CommissionCheck again = lateness(); *again.value < *late.value) late = again;
  }
  checks.push_back(judged("priority", granted ? 1.0 : 0.0));
  checks.push_back(late);
  std::vector<CommissionCheck> disk = checkDisk(surroundings.storage, kDiskBytes, kDiskTry_s,
                                                progress, surroundings.storage_is_set);
  if (disk[1].value && disk[1].verdict != Fitness::pass) {  // another may have been writing
    const auto again = checkDisk(surroundings.storage, kDiskBytes, kDiskTry_s, progress,
                                 surroundings.storage_is_set);
    if (again[1].value > disk[1].value) disk[1] = again[1];
  }
  checks.insert(checks.end(), disk.begin(), disk.end());
  if (surroundings.arms) checks.push_back(countArms());
  checks.push_back(judgedScreen(surroundings.screen));
  if (surroundings.driver != "none") checks.push_back(judgedCard(surroundings.driver));
  progress.at(1.0, "done");
  return checks;
}

std::optional<StartWords> storageWords(const StartSurroundings& surroundings) {
  std::error_code ec;
  if (!surroundings.storage_is_set || std::filesystem::is_directory(surroundings.storage, ec)) {
    return {};
  }
  return StartWords{
      Fitness::fail, tr("The folder of cases is not there: see whether its disk is connected."),
      tr("{}, as /etc/trephine/settings.json has it.", surroundings.storage.string())};
}

StartWords startWords(const std::optional<Commissioning>& commissioned,
                      const std::vector<CommissionCheck>& now) {
  if (!commissioned) {
    return {Fitness::warn, tr("This workstation has not been commissioned yet: File, Commission."),
            tr("It then says what the machine is fit for, and what has changed at each start.")};
  }
  Commissioning compared = *commissioned;
  compared.checks = now;
  const std::vector<CommissionChange> changes = changesSince(*commissioned, compared);
  StartWords said{Fitness::pass, tr("As commissioned on {}.", commissioned->when),
                  tr("Arms, ticks, disk and screen are as they were then.")};
  if (fitnessOf(*commissioned) == Fitness::fail) {
    said = {Fitness::fail,
            tr("Commissioned on {}, and not fit for exercises: see File, Commission.",
               commissioned->when),
            ""};
    for (const CommissionCheck& check : commissioned->checks) {
      if (check.verdict == Fitness::fail) said.all += check.words + ": " + check.next + "\n";
    }
  }
  int worse = 0;
  for (const CommissionChange& change : changes) {
    if (change.now == Fitness::pass) continue;  // better than it was: nothing is to be done
    const auto check = std::ranges::find(now, change.words, &CommissionCheck::words);
    const std::string next = check == now.end() ? "" : check->next;
    if (worse == 0 && said.fitness == Fitness::pass) said.all.clear();
    said.all += changeText(change) + ". " + next + "\n";
    if (worse++ == 0 || change.now > said.fitness) {
      said.words =
          tr("{}, now {}: {}", change.words, shownValue(change.value_now, change.unit), next);
    }
    said.fitness = std::max(said.fitness, change.now);
  }
  if (worse > 1) said.words += tr(" ({} more: point here)", worse - 1);
  return said;
}

}  // namespace trephine
