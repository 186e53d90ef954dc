// The force laws that an exercise can name. Each is a small type in its own file under laws/ with
// one signature, created only when the exercise names it:
//
//   explicit Law(points)                       room for a tool of so many points
//   void add(const LawInput&, ContactForce&)   adds its force on the arm; nothing without contact
//   void forget()                              after an undo or reset: it begins anew
//   static Impedance impedance(tissue)         what it demands of a tissue; zero: not its own
//   using StandsInFor = Other                  where both are named and it acts, Other does not
//
// To add a law: its file, its lines here, its tests (README.md).
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "haptics/laws/coulomb.h"
#include "haptics/laws/elastic.h"
#include "haptics/laws/rupture.h"
#include "haptics/laws/viscous.h"

namespace trephine {

using Law = std::variant<ViscousLaw, CoulombLaw, ElasticLaw, RuptureLaw>;

// In the order of the variant.
enum class LawKind { viscous, coulomb, elastic, rupture };
inline constexpr std::array<std::pair<std::string_view, LawKind>, std::variant_size_v<Law>>
    kLawNames{{{"viscous", LawKind::viscous},
               {"coulomb", LawKind::coulomb},
               {"elastic", LawKind::elastic},
               {"rupture", LawKind::rupture}}};

namespace detail {
template <std::size_t N = 0>
Law makeLawFrom(std::size_t index, std::size_t points) {
  if constexpr (N + 1 < std::variant_size_v<Law>) {
    if (index > N) return makeLawFrom<N + 1>(index, points);
  }
  return Law(std::in_place_index<N>, points);
}
}  // namespace detail

inline Law makeLaw(LawKind kind, std::size_t points = 1) {
  return detail::makeLawFrom(std::size_t(kind), points);
}
inline bool names(const std::vector<LawKind>& laws, LawKind law) {
  return std::find(laws.begin(), laws.end(), law) != laws.end();
}

// What the laws say of a tissue, by kind. No allocation.
struct LawOfTissue {
  Impedance (*impedance)(const TissueClass&) = nullptr;
  std::optional<LawKind> stands_in_for;
};

namespace detail {
template <class L, std::size_t N = 0>
constexpr LawKind kindOf() {
  if constexpr (std::is_same_v<L, std::variant_alternative_t<N, Law>>) {
    return LawKind(N);
  } else {
    return kindOf<L, N + 1>();
  }
}
template <class L>
constexpr LawOfTissue lawOfTissue() {
  LawOfTissue row;
  row.impedance = &L::impedance;
  if constexpr (requires { typename L::StandsInFor; }) {
    row.stands_in_for = kindOf<typename L::StandsInFor>();
  }
  return row;
}
template <class... Laws>
constexpr std::array<LawOfTissue, sizeof...(Laws)> lawsOfTissue(const std::variant<Laws...>*) {
  return {lawOfTissue<Laws>()...};
}
}  // namespace detail

inline constexpr auto kLawsOfTissue = detail::lawsOfTissue(static_cast<const Law*>(nullptr));

// Whether a law acts in a tissue, in an exercise that names these laws: it is one of them, and none
// of the others stands in for it there.
inline bool acts(const std::vector<LawKind>& laws, LawKind law, const TissueClass& tissue) {
  const auto standsIn = [&](LawKind other) {
    const LawOfTissue& of = kLawsOfTissue[std::size_t(other)];
    if (of.stands_in_for != law) return false;
    const Impedance demanded = of.impedance(tissue);
    return demanded.damping > 0.0 || demanded.stiffness > 0.0;
  };
  return names(laws, law) && std::none_of(laws.begin(), laws.end(), standsIn);
}

// Damping and stiffness that these laws together demand of a tissue.
inline Impedance demandedOf(const std::vector<LawKind>& laws, const TissueClass& tissue) {
  Impedance sum;
  for (LawKind law : laws) {
    if (!acts(laws, law, tissue)) continue;
    const Impedance demanded = kLawsOfTissue[std::size_t(law)].impedance(tissue);
    sum.damping += demanded.damping;
    sum.stiffness += demanded.stiffness;
  }
  return sum;
}

inline void addLaw(Law& law, const LawInput& in, ContactForce& out) {
  std::visit([&](auto& l) { l.add(in, out); }, law);
}
inline void forgetLaw(Law& law) {
  std::visit([](auto& l) { l.forget(); }, law);
}

}  // namespace trephine
