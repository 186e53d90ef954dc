// The numbers of a tissue that the force laws and removal use: a member and its row each. Files,
// checks, the tick's table, recordings, the panel and the schema page come from them.
//
// To add one: its member and its row here (the compiler refuses one without the other), and the law
// that uses it. Files and recordings that are older lack it: it may be given, and 0 where it is
// not.
#pragma once

#include <iterator>
#include <optional>
#include <string>
#include <variant>

#include "base/field.h"
#include "base/tr.h"

namespace trephine {

// Of each of the mechanics. Far beyond steel; what lies below it and above the arm is bounded, and
// felt as the arm's most.
constexpr Range kMechanicsRange{0, 1e9};

// A number that a person set, and where it comes from: a citation, or "tuned here, uncited".
struct SourcedNumber {
  double value = 0.0;
  std::string source;
  bool operator==(const SourcedNumber&) const = default;
};

// `Number` is what a file always gives, `MaybeNumber` what it may give.
template <class Number, class MaybeNumber>
struct TissueNumbers {
  Number damping_Ns_per_m{};
  Number stiffness_N_per_m{};
  Number friction_N{};
  MaybeNumber rupture_N{};
  Number cutting_J_per_mm3{};

  friend bool operator==(const TissueNumbers&, const TissueNumbers&) = default;
};
using SetNumbers = TissueNumbers<SourcedNumber, std::optional<SourcedNumber>>;
using TickNumbers = TissueNumbers<double, double>;  // 0 where it is not given

struct TissueNumber {
  const char* key;  // in files, scripts and recordings
  const char* unit;
  const char* meaning;  // which law it is of
  std::variant<SourcedNumber SetNumbers::*, std::optional<SourcedNumber> SetNumbers::*> in_set;
  double TickNumbers::*in_tick;
  // In the panel: its name, the most that can be typed, a step and its decimals, in a unit of which
  // `shown_per` make one of the file's.
  const char* label;
  double most, step;
  int decimals = 2;
  const char* shown_unit = nullptr;  // null: the file's
  double shown_per = 1.0;

  constexpr FieldRow row() const {
    return {key,
            {kMechanicsRange.low, kMechanicsRange.high, unit},
            in_set.index() == 0 ? Given::always : Given::may_be,
            meaning};
  }
  // Null where it is not given.
  const SourcedNumber* of(const SetNumbers& tissue) const;
  double valueOf(const SetNumbers& tissue) const {
    const SourcedNumber* number = of(tissue);
    return number ? number->value : 0.0;
  }
  void set(SetNumbers& tissue, const SourcedNumber& number) const;
  void clear(SetNumbers& tissue) const;  // not given, where it may be so; else it stays
};

inline constexpr TissueNumber kTissueNumbers[] = {
    {"damping_Ns_per_m", "N\u00b7s/m", trLater("viscous law"), &SetNumbers::damping_Ns_per_m,
     &TickNumbers::damping_Ns_per_m, trLater("Damping"), 1e5, 0.1},
    {"stiffness_N_per_m", "N/m", trLater("elastic, coulomb and rupture laws"),
     &SetNumbers::stiffness_N_per_m, &TickNumbers::stiffness_N_per_m, trLater("Stiffness"), 1e7,
     10.0},
    {"friction_N", "N", trLater("coulomb law: what a tool that slides in it feels"),
     &SetNumbers::friction_N, &TickNumbers::friction_N, trLater("Friction"), 100.0, 0.05},
    {"rupture_N", "N", trLater("rupture law: the force at which a capsule gives way; at 0, none"),
     &SetNumbers::rupture_N, &TickNumbers::rupture_N, trLater("Rupture"), 100.0, 0.05},
    {"cutting_J_per_mm3", "J/mm\u00b3",
     trLater("work that removes it: its specific cutting energy"), &SetNumbers::cutting_J_per_mm3,
     &TickNumbers::cutting_J_per_mm3, trLater("Cutting"), 10'000.0, 0.001, 4, "mJ/mm\u00b3",
     1000.0},
};
static_assert(sizeof(TickNumbers) == sizeof(double) * std::size(kTissueNumbers),
              "each number has one row");

}  // namespace trephine
