// What the domain's values are called on the screen.
#pragma once

#include <QString>
#include <cstdint>
#include <filesystem>

#include "base/result.h"
#include "exercise/exercise_tool.h"
#include "exercise/policy.h"
#include "haptics/haptic_types.h"
#include "imaging/importer.h"

namespace trephine {

QString toQt(const std::string& utf8);
// A name that came from a file, to be shown: without marks that turn or hide what stands beside it,
// and with places to break a line at.
QString shownName(const std::string& utf8);
// Paths keep the bytes that the file system gave, whatever their encoding.
std::filesystem::path toPath(const QString& text);
QString toQt(const std::filesystem::path& path);

// "For training, not for diagnosis or treatment planning".
QString purposeText();

// Of a case that comes with the program: "Cranium, built in".
QString builtInName(const std::string& phantom);

// Of the tissue that a tool touches; empty: none.
QString touchedName(const ArmRecord& arm, const TissueSet& tissues);
QString verdictWord(Verdict verdict);
QString controllerWord(ControllerKind kind);
// "craniotome, 2.4 mm": as the exercise calls it; of a burr how thick it is, else how long.
QString toolWord(const ExerciseTool& tool);
// "rod burr, 2.4 mm": what it is, whatever it is called.
QString toolKindWord(const ExerciseTool& tool);
// What a controller does, in a sentence.
QString controllerMeaning(ControllerKind kind);
// What makes the sent force another than the demanded one: the parts of the controller that acted
// (ControllerPart), or why there is none at all.
QString forceChangeWords(const ArmRecord& arm, bool paused);
// Each of those words explained, a paragraph each.
QString forceChangeMeanings();
// Each fault bit as a sentence, one a line; empty for none.
QString faultWords(std::uint32_t faults);
// Findings of a series, what was noticed and what was done, one a line.
QString findingWords(const SeriesReport& series);
// Who takes off what the workstation locks, or why nobody does; without a stop, as Error::next.
QString unlockWords(const Policy& policy);
// Why it cannot be changed in Prepare now, and what ends that: `by_policy`, or what an exercise
// keeps holds until its run has ended.
QString lockedWords(const Policy& policy, bool by_policy);
// "1:05" of 65 seconds.
QString timeWords(std::uint32_t seconds);
// "512 x 512 x 140 voxels", and on a second line "0.49 x 0.49 x 1.00 mm".
QString sizeWords(const GridGeometry& geometry);

}  // namespace trephine
