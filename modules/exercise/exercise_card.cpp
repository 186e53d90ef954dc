#include "exercise/exercise_card.h"

#include "base/tr.h"
#include "base/utf8.h"
#include "exercise/exercise_fields.h"

namespace trephine {

namespace {

void checkText(JsonReader& reader, const char* key, const std::string& text, std::size_t most) {
  if (text.empty())
    reader.fail(key, tr("The text is empty"), tr("Say it, or leave the whole card out"));
  if (cleanUtf8(text) != text) {
    reader.fail(key,
                tr("The text is no plain line: it has line breaks, control characters or spaces "
                   "around it"));
  }
  if (const std::size_t count = charactersOf(text); count > most) {
    reader.fail(key,
                tr("The text has {} characters, at most {} can be read at a glance", count, most),
                tr("Say it in fewer words"));
  }
}

CardText readText(JsonReader reader) {
  CardText text;
  readFields(reader, kCardFields, text);
  if (!reader.ok()) return text;
  checkText(reader, "goal", text.goal, kCardGoal);
  if (text.steps.empty()) reader.fail("steps", tr("There is no step"), tr("Say at least one"));
  for (const std::string& step : text.steps) checkText(reader, "steps", step, kCardStep);
  checkText(reader, "hands", text.hands, kCardHands);
  return text;
}

Json toJson(const CardText& text) {
  Json json;
  writeFields(json, kCardFields, text);
  return json;
}

}  // namespace

ExerciseCard readExerciseCard(JsonReader card) {
  ExerciseCard out;
  out.en = readText(card.object("en"));
  if (card.has("zh_TW")) {
    out.zh_TW = readText(card.object("zh_TW"));
    out.zh_TW_is_old = card.boolean("zh_TW_is_old", false);
  }
  return out;
}

Json toJson(const ExerciseCard& card) {
  Json json{{"en", toJson(card.en)}};
  if (card.zh_TW) {
    json["zh_TW"] = toJson(*card.zh_TW);
    if (card.zh_TW_is_old) json["zh_TW_is_old"] = true;
  }
  return json;
}

}  // namespace trephine
