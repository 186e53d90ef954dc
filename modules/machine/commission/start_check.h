// At each start, within 5 s: what may have changed since the workstation was commissioned.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "machine/commission/commission.h"

namespace trephine {

// The last commissioning that holds for this person: his own, or where there is none or it is older
// the hospital's, commission.json beside the workstation's settings. Error: NOT_COMMISSIONED where
// there is none that can be read.
Result<Commissioning> lastCommissioning(const std::filesystem::path& own_folder,
                                        const std::filesystem::path& hospital_folder);

struct StartSurroundings {
  std::filesystem::path storage;  // of cases
  bool storage_is_set = false;    // by the workstation's settings: it has to be there
  std::string driver;             // of the window's pictures; "none": it has drawn none yet
  std::array<int, 2> screen{};    // pixels
  bool arms = true;               // false: they are in use, and not counted
};
// lateness at 1000 Hz, disk, arms, screen and card, as commission() has them, in about 2 s.
Result<std::vector<CommissionCheck>> checkAtStart(const StartSurroundings& surroundings,
                                                  const Progress& progress);

// One line, in plain words, and how good it is.
struct StartWords {
  Fitness fitness = Fitness::pass;
  std::string words;  // one line
  std::string all;    // each change in a line of its own, with its next step
};
// What is wrong whether or not it was commissioned: a folder of cases that is not there.
std::optional<StartWords> storageWords(const StartSurroundings& surroundings);
// `commissioned`: nothing where it never was. Pure.
StartWords startWords(const std::optional<Commissioning>& commissioned,
                      const std::vector<CommissionCheck>& now);

}  // namespace trephine
