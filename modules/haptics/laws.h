// The force laws that a scene can name. Each is a small type in its own file under laws/ with one
// signature, created only when the scene names it:
//
//   explicit Law(points)                       room for a tool of so many points
//   void add(const LawInput&, ContactForce&)   adds its force on the arm; nothing without contact
//   void forget()                              after an undo or reset: back to the state of a new law
//
// To add a law: its file, its lines here, its tests.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>
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
inline void addLaw(Law& law, const LawInput& in, ContactForce& out) {
  std::visit([&](auto& l) { l.add(in, out); }, law);
}
inline void forgetLaw(Law& law) {
  std::visit([](auto& l) { l.forget(); }, law);
}

}  // namespace trephine
