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
#include "tissue/sourced_number.h"

namespace trephine {

// Of each of the mechanics. Far beyond steel; what lies below it and above the arm is bounded, and
// felt as the arm's most.
constexpr Range kMechanicsRange{0, 1e9};

// `Number` is what a file always gives, `MaybeNumber` what it may give.
template <class Number, class MaybeNumber>
struct TissueNumbers {
  Number damping_Ns_per_m{};
  Number stiffness_N_per_m{};
  Number friction_N{};
  MaybeNumber rupture_N{};
  MaybeNumber cutting_J_per_mm3{};
  MaybeNumber toughness_J_per_m2{};
  MaybeNumber rupture_mm{};
  MaybeNumber shaft_N_per_mm{};
  MaybeNumber friction_coefficient{};
  MaybeNumber relaxation_share{};
  MaybeNumber relaxation_s{};

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
  double greatest = kMechanicsRange.high;  // in files

  constexpr FieldRow row() const {
    return {key,
            {kMechanicsRange.low, greatest, unit},
            in_set.index() == 0 ? Given::always : Given::may_be,
            meaning};
  }
  // Null where it is not given.
  const SourcedNumber* of(const SetNumbers& tissue) const;
  double valueOf(const SetNumbers& tissue) const {
    const SourcedNumber* number = of(tissue);
    return number ? number->value : 0.0;
  }
  // Of the two that say what cutting costs, by volume and by area, the other one goes.
  void set(SetNumbers& tissue, const SourcedNumber& number) const;
  void clear(SetNumbers& tissue) const;  // not given, where it may be so; else it stays
  // A tissue has one of the two.
  constexpr bool isCutting() const {
    return in_tick == &TickNumbers::cutting_J_per_mm3 ||
           in_tick == &TickNumbers::toughness_J_per_m2;
  }
};

inline constexpr TissueNumber kTissueNumbers[] = {
    {"damping_Ns_per_m", "N\u00b7s/m", trLater("viscous law"), &SetNumbers::damping_Ns_per_m,
     &TickNumbers::damping_Ns_per_m, trLater("Damping"), 1e5, 0.1},
    {"stiffness_N_per_m", "N/m", trLater("elastic, coulomb and rupture laws"),
     &SetNumbers::stiffness_N_per_m, &TickNumbers::stiffness_N_per_m, trLater("Stiffness"), 1e7,
     10.0},
    {"friction_N", "N", trLater("coulomb law: what a tool that slides in it feels"),
     &SetNumbers::friction_N, &TickNumbers::friction_N, trLater("Friction"), 100.0, 0.05},
    {"rupture_N", "N",
     trLater("membrane and rupture laws: the force at which a membrane gives way; at 0, none. By "
             "the membrane law, to a tool 1.2 mm wide, to others in proportion"),
     &SetNumbers::rupture_N, &TickNumbers::rupture_N, trLater("Rupture"), 100.0, 0.05},
    {"cutting_J_per_mm3", "J/mm\u00b3",
     trLater("work that removes it, by volume: its specific cutting energy. This or the toughness, "
             "not both"),
     &SetNumbers::cutting_J_per_mm3, &TickNumbers::cutting_J_per_mm3, trLater("Cutting"), 10'000.0,
     0.001, 4, "mJ/mm\u00b3", 1000.0},
    {"toughness_J_per_m2", "J/m\u00b2",
     trLater("cutting law, and work that removes it, by area of new surface. This or the cutting "
             "energy, not both"),
     &SetNumbers::toughness_J_per_m2, &TickNumbers::toughness_J_per_m2, trLater("Toughness"), 1e5,
     10.0, 1},
    {"rupture_mm", "mm",
     trLater("membrane law: how far the arm goes on until it gives way to a tool 1.2 mm wide"),
     &SetNumbers::rupture_mm, &TickNumbers::rupture_mm, trLater("Gives way after"), 50.0, 0.5},
    {"shaft_N_per_mm", "N/mm",
     trLater("friction law, soft tissue: by millimetre of the shaft that lies in it"),
     &SetNumbers::shaft_N_per_mm, &TickNumbers::shaft_N_per_mm, trLater("Along a shaft"), 10'000.0,
     1.0, 1, "mN/mm", 1000.0},
    {"friction_coefficient", "",
     trLater("friction law, solid tissue: force along the surface by force onto it"),
     &SetNumbers::friction_coefficient, &TickNumbers::friction_coefficient,
     trLater("Friction by push"), 10.0, 0.05},
    {"relaxation_share", "",
     trLater("relaxation law: the share of its force that a tool loses that is held still"),
     &SetNumbers::relaxation_share, &TickNumbers::relaxation_share, trLater("Relaxes by"), 100.0,
     5.0, 0, "%", 100.0, 1.0},
    {"relaxation_s", "s", trLater("relaxation law: the time within which it does"),
     &SetNumbers::relaxation_s, &TickNumbers::relaxation_s, trLater("Relaxes within"), 1000.0, 0.5},
};
static_assert(sizeof(TickNumbers) == sizeof(double) * std::size(kTissueNumbers),
              "each number has one row");

}  // namespace trephine
