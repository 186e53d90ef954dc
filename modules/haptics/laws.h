// Force laws: each a small type with one signature, created only when the scene names it.
//
//   void add(const LawInput&, ContactForce&)   adds its force on the arm, patient axes; nothing
//                                              without contact
//   void forget()                              after an undo or reset: back to the state of a new law
//
// To add a law: a type here, its line in kLawNames and in makeLaw, its tests.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <variant>

#include "base/math.h"
#include "haptics/contact.h"
#include "haptics/contact_force.h"
#include "tissue/tissue_set.h"

namespace trephine {

struct LawInput {
  Vec3 tip_m{0.0};         // patient axes, metres
  Contact contact;
  TissueClass tissue;      // of the firmest tissue touched; unused without contact
};

// Seed paper, eq. 1: f = -b v at the tip, b the damping of the tissue touched [N s/m].
struct ViscousLaw {
  void add(const LawInput& in, ContactForce& out) const;
  void forget() {}
};

// A spring from the tip to an anchor set where contact began: f = -k (x - anchor). Beyond the
// tissue's yield force F the anchor is dragged along, |x - anchor| <= F / k: the tissue holds at
// rest and gives way under load, so that bone resists a blade that erases what it touches. Energy
// is stored or lost, never made. (Elastic-perfectly plastic: Prandtl 1928, in one point.)
struct ElasticLaw {
  void add(const LawInput& in, ContactForce& out);
  void forget() { anchor_m.reset(); }
  std::optional<Vec3> anchor_m;
};

using Law = std::variant<ViscousLaw, ElasticLaw>;

enum class LawKind { viscous, elastic };
inline constexpr std::array<std::pair<std::string_view, LawKind>, 2> kLawNames{
    {{"viscous", LawKind::viscous}, {"elastic", LawKind::elastic}}};

Law makeLaw(LawKind kind);
inline void addLaw(Law& law, const LawInput& in, ContactForce& out) {
  std::visit([&](auto& l) { l.add(in, out); }, law);
}
inline void forgetLaw(Law& law) {
  std::visit([](auto& l) { l.forget(); }, law);
}

}  // namespace trephine
