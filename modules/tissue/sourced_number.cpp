#include "tissue/sourced_number.h"

#include <cmath>

#include "base/field.h"
#include "base/tr.h"
#include "base/utf8.h"
#include "tissue/codes.h"

namespace trephine {

namespace {

constexpr FieldRow kValueRow{"value", {}, Given::always, trLater("what is felt")};
constexpr FieldRow kSourceRow{
    "source", {}, Given::always, trLater("not empty: a citation, or \"tuned here, uncited\"")};
constexpr FieldRow kPublishedRow{
    "range",
    {},
    Given::may_be,
    trLater("what was measured or published, low <= high, in the value's unit and within its "
            "key's range; it need not hold the value")};
constexpr FieldOf<SourcedNumber> kConfidenceField{
    {"confidence",
     {},
     Given::may_be,
     trLater("`measured`: a published measurement that was read in its source; `second-hand`: "
             "quoted by another paper; `derived`: computed from measured numbers, the source says "
             "how; `estimate`: estimated; `tuned`: tuned here")},
    oneOf<&SourcedNumber::stated, kConfidenceNames>()};
constexpr FieldRow kConditionRow{
    "condition",
    {},
    Given::may_be,
    trLater("what it was measured under, such as \"bovine liver ex vivo, 1.2 mm needle\"")};

Error refused(const std::string& where, const std::string& what, const std::string& next) {
  return Error{code::kBadTissue, what, where, next};
}

// Why a tissue cannot have this value.
Status checkValue(const std::string& where, const Range& allowed, double value) {
  if (!isFinite(value)) {
    return refused(where, tr("The value {} is not finite", exactNumber(value)),
                   tr("Correct that value"));
  }
  if (value < 0.0) {
    return refused(where, tr("The value {} is negative", exactNumber(value)),
                   tr("A tissue cannot push: use 0 or more"));
  }
  if (!allowed.holds(value)) {
    return refused(where, tr("The value {} is absurd: no tissue has it", exactNumber(value)),
                   tr("Use one {}", allowed.words()));
  }
  return {};
}

std::string spanWords(const SourcedNumber::Published& range, double shown_per) {
  const std::string low = plainNumber(range.low * shown_per);
  const std::string high = plainNumber(range.high * shown_per);
  return low == high ? low : tr("{} to {}", low, high);
}

}  // namespace

std::string exactNumber(double value) {
  return isFinite(value) ? Json(value).dump() : std::to_string(value);  // JSON has no nan
}

Confidence SourcedNumber::confidence() const {
  return stated == Confidence::unstated && source == kOwnSource ? Confidence::tuned : stated;
}

bool SourcedNumber::operator==(const SourcedNumber& other) const {
  return value == other.value && source == other.source && range == other.range &&
         confidence() == other.confidence() && condition == other.condition;
}

std::string sourceIn(JsonReader& object, const char* key) {
  constexpr std::size_t kMost = 4096;
  const Json& text = object.raw(key);
  const bool known = text.is_string() && text.get_ref<const std::string&>().size() <= kMost;
  return known ? cleanUtf8(text.get_ref<const std::string&>()) : object.text(key);
}

SourcedNumber readSourced(JsonReader object, const Range& allowed) {
  SourcedNumber number{object.number(kValueRow.key, allowed), sourceIn(object, kSourceRow.key)};
  if (object.has(kPublishedRow.key)) {
    const std::vector<double> ends = object.numbers(kPublishedRow.key, 2, allowed);
    number.range = {ends[0], ends[1]};
  }
  if (object.has(kConfidenceField.row.key)) {
    setValue(kConfidenceField, number, readField(object, shapeOf(kConfidenceField)));
  }
  if (object.has(kConditionRow.key)) number.condition = sourceIn(object, kConditionRow.key);
  return number;
}

Json toJson(const SourcedNumber& number) {
  Json json{{kValueRow.key, number.value}, {kSourceRow.key, number.source}};
  if (number.range) json[kPublishedRow.key] = {number.range->low, number.range->high};
  if (number.stated != Confidence::unstated) {
    writeField(json, shapeOf(kConfidenceField), valueOf(kConfidenceField, number));
  }
  if (!number.condition.empty()) json[kConditionRow.key] = number.condition;
  return json;
}

Status checkSourced(const std::string& file, const std::string& field, const Range& allowed,
                    const SourcedNumber& number) {
  const std::string where = file + ": " + field;
  if (Status s = checkValue(where, allowed, number.value); !s) return s;
  if (number.source.empty()) {
    return refused(where, tr("The value {} has no source", exactNumber(number.value)),
                   tr("Cite one, or write \"tuned here, uncited\""));
  }
  if (number.range) {
    const auto [low, high] = *number.range;
    const std::string of = where + "." + kPublishedRow.key;
    for (const double end : {low, high}) {
      if (Status s = checkValue(of, allowed, end); !s) return s;
    }
    if (low > high) {
      return refused(of,
                     tr("The range {} to {} is not possible", exactNumber(low), exactNumber(high)),
                     tr("Give the lower value first"));
    }
  }
  if (number.stated == Confidence::measured && number.source == kOwnSource) {
    return refused(where + "." + kConfidenceField.row.key,
                   tr("The value {} is \"measured\", and its source says \"{}\"",
                      exactNumber(number.value), number.source),
                   tr("Cite the measurement, or write \"tuned\""));
  }
  return {};
}

std::string sourcedFieldsPage() {
  constexpr const char* kOf = "sourced number";
  return schemaLine(kOf, kValueRow, "number, as its key has it", "") +
         schemaLine(kOf, kSourceRow, "text", "") +
         schemaLine(kOf, kPublishedRow, "two numbers, as its key has them", "none") +
         schemaLine(kOf, shapeOf(kConfidenceField),
                    std::string("`tuned` of the source \"") + kOwnSource + "\", else not stated") +
         schemaLine(kOf, kConditionRow, "text", "none");
}

std::string confidenceWord(Confidence confidence) {
  switch (confidence) {
    case Confidence::unstated:
      return {};
    case Confidence::measured:
      return tr("measured");
    case Confidence::second_hand:
      return tr("second-hand");
    case Confidence::derived:
      return tr("derived");
    case Confidence::estimate:
      return tr("estimated");
    case Confidence::tuned:
      return tr("tuned here");
  }
  return {};
}

namespace {
// "outside the published 2.2 to 3.3 N, by a factor of 0.18", with three digits.
std::string outsideWords(const SourcedNumber& number, const std::string& span) {
  const double nearest = number.nearestPublished();
  if (!(nearest > 0.0) || !(number.value > 0.0)) return tr("outside the published {}", span);
  const double factor = number.value / nearest;
  const double digits = std::pow(10.0, 2.0 - std::floor(std::log10(factor)));
  return tr("outside the published {}, by a factor of {}", span,
            plainNumber(std::round(factor * digits) / digits));
}
}  // namespace

std::string provenanceWords(const SourcedNumber& number, std::string_view unit, double shown_per) {
  const std::string of_unit = (unit.empty() ? "" : " ") + std::string(unit);
  // Its own source says that a number is tuned.
  std::string known = number.source == kOwnSource && number.confidence() == Confidence::tuned
                          ? std::string()
                          : confidenceWord(number.confidence());
  if (!number.condition.empty()) known += (known.empty() ? "" : "; ") + number.condition;
  if (!number.range) return known;
  const std::string span = spanWords(*number.range, shown_per) + of_unit;
  const std::string words =
      number.isOutOfRange() ? outsideWords(number, span) : tr("published {}", span);
  return known.empty() ? words : words + " (" + known + ")";
}

}  // namespace trephine
