// A number that a person set, and how it is known: its source, the range that was published, how
// sure it is, and under which condition it was measured. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/json.h"
#include "base/range.h"
#include "base/result.h"

namespace trephine {

// The source of a number that a person set here.
inline constexpr const char* kOwnSource = "tuned here, uncited";

// What a number is worth. `unstated`: nobody has said so; in no file.
enum class Confidence { unstated, measured, second_hand, derived, estimate, tuned };
inline constexpr std::array<std::pair<std::string_view, Confidence>, 5> kConfidenceNames{{
    {"measured", Confidence::measured},
    {"second-hand", Confidence::second_hand},
    {"derived", Confidence::derived},
    {"estimate", Confidence::estimate},
    {"tuned", Confidence::tuned},
}};

struct SourcedNumber {
  double value = 0.0;
  std::string source{};  // a citation, or kOwnSource
  // What was measured or published, both ends included, in the value's unit. The value may lie
  // outside: what is felt well is not always what was measured.
  struct Published {
    double low = 0.0;
    double high = 0.0;
    bool operator==(const Published&) const = default;
  };
  std::optional<Published> range{};
  Confidence stated = Confidence::unstated;  // as the file has it
  std::string condition{};                   // of the measurement; empty: not said

  // Of its own source a number is tuned, whether or not the file says so.
  Confidence confidence() const;
  bool isOutOfRange() const { return range && !(value >= range->low && value <= range->high); }
  // The end of the range that lies nearest to the value; the value where there is no range.
  double nearestPublished() const {
    return range ? std::clamp(value, range->low, range->high) : value;
  }
  // What two claim, not how their files put it.
  bool operator==(const SourcedNumber& other) const;
};

// `allowed`: what its value may be, and both ends of its range.
SourcedNumber readSourced(JsonReader object, const Range& allowed);
Json toJson(const SourcedNumber& number);
// Text from elsewhere in one line: what ends a line, or what nobody sees, becomes a blank.
std::string sourceIn(JsonReader& object, const char* key);
// Every rule that a number must keep, whether read from a file or typed in a panel: finite,
// allowed, not negative, with a source, and no claim that contradicts it. `field` is the number's.
Status checkSourced(const std::string& file, const std::string& field, const Range& allowed,
                    const SourcedNumber& number);

// Its fields, as rows of the schema page.
std::string sourcedFieldsPage();

// With every digit, as in the file.
std::string exactNumber(double value);
// "measured", as a person reads it; empty: not stated.
std::string confidenceWord(Confidence confidence);
// "published 2.2 to 3.3 N (measured; human cadaver, access needle)", "outside the published ..." of
// a value that is; empty where its source says all. `shown_per` of `unit` make one of the number's.
std::string provenanceWords(const SourcedNumber& number, std::string_view unit, double shown_per);

}  // namespace trephine
