// What an exercise says to a trainee before it begins, in plain words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json.h"

namespace trephine {

// Characters, not bytes.
constexpr std::size_t kCardGoal = 300, kCardStep = 200, kCardHands = 300;
constexpr std::size_t kCardSteps = 12;

struct CardText {
  std::string goal;                // what is to be reached
  std::vector<std::string> steps;  // one after the other; at least one
  std::string hands;               // which tool in which hand, and how to move it
  bool operator==(const CardText&) const = default;
};

struct ExerciseCard {
  CardText en;
  std::optional<CardText> zh_TW;  // Traditional Chinese
  bool zh_TW_is_old = false;      // the English text was changed after the Chinese one
  bool operator==(const ExerciseCard&) const = default;
};

ExerciseCard readExerciseCard(JsonReader card);
Json toJson(const ExerciseCard& card);

}  // namespace trephine
