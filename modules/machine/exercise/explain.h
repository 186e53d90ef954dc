// What an exercise instantiates, and what each part costs in a tick on this machine.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "exercise/exercise.h"
#include "machine/trades/recommended.h"

namespace trephine {

// -> {exercise, goal (of its card; null: none), case, rate_hz, controller, laws, removal, tissues,
//     numbers (usedNumbers),
//     arms:[{name, plugin, tool, other_tools, force_scale, points, renderable}],
//     warnings:[{code, text}] as of a run of the exercise's own script in its own case: tools that
//     start in tissue; null where it has no case or no script,
//     settings:[{knob, setting, recommended}] where anything is `recommended` here,
//     bounded:[what the arms do not show of a tissue, and what is felt],
//     touch:[{arm, tool, tissue, most_N, friction_N, felt (null: not known),
//     at_limit, like, words}] (tissue_poke.h),
//     journal_mb, cost:[{part, arm (null: any), ns_per_tick}], tick_ns}
// Each part is timed alone (median of batches, about 0.1 s for all of them) on a small block of the
// exercise's firmest tissue; tick_ns is a whole tick of all arms there, without the devices.
// Errors: those of the devices, the script and the case, CANCELLED.
Result<Json> explainExercise(Exercise exercise, const std::vector<RecommendedSetting>& recommended,
                             const Progress& progress = Progress());

// [{tissue, number, unit, value, source, range, confidence, condition, text}]: of each tissue the
// numbers that the exercise's laws and its removal go by, in the units of its file; what is not
// known is not there. `text` is all of it for a person.
Json usedNumbers(const Exercise& exercise);

// The same for a person, some lines, together with what the command adds of the workstation:
// `locks` [names], `refused` (a sentence or null).
std::string explanationText(const Json& explained);

// The knobs of the trades that an exercise sets or is drawn with, each once: knob and
// setting.
std::vector<std::pair<std::string, std::string>> exerciseSettings(const Exercise& exercise);

}  // namespace trephine
