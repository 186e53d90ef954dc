// The force laws that an exercise can name. Each is a small type in its own file under laws/,
// created only when the exercise names it:
//
//   explicit Law(points)                       room for a tool of so many points
//   void add(const LawInput&, ContactForce&)   adds its force on the arm; nothing without contact
//   void forget()                              after an undo or reset: it begins anew
//   static Impedance impedance(tissue)         what it demands of a tissue; zero: not its own
//   static void visitState(self, archive)      its members, if it has any (base/state_archive.h)
//
// and, where it is so:
//
//   using StandsInFor = Other                  where both are named and it acts, Other does not
//   static constexpr bool kStopsAtSolid        its tool is where solid tissue lets it be (proxy.h)
//   void engage()                              its arm was put back to it: it begins unstretched
//   struct Query                               what it asks of the tissue around a tool, once a
//   tick
//     Query(const Tool&, const GridGeometry&)
//     Answer ask(const Tissues&, const TissueField&, const Pose& tool_mm, const LawInput&) const
//   struct Answer                              then it has add(const LawInput&, const Answer&, ..)
//   struct Tissues                             what it makes of the tissues for that, for all tools
//     void use(const TissueTable&, std::uint32_t acts_in)   bit c: it acts in class c
//
// To add a law: its file, its lines here, its tests (README.md).
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "haptics/laws/coulomb.h"
#include "haptics/laws/elastic.h"
#include "haptics/laws/rupture.h"
#include "haptics/laws/viscous.h"

namespace trephine {

template <class... Laws>
struct LawList {};
using AllLaws = LawList<ViscousLaw, CoulombLaw, ElasticLaw, RuptureLaw>;

// In the order of the list.
enum class LawKind { viscous, coulomb, elastic, rupture };
inline constexpr std::array<std::pair<std::string_view, LawKind>, 4> kLawNames{
    {{"viscous", LawKind::viscous},
     {"coulomb", LawKind::coulomb},
     {"elastic", LawKind::elastic},
     {"rupture", LawKind::rupture}}};

inline bool names(const std::vector<LawKind>& laws, LawKind law) {
  return std::find(laws.begin(), laws.end(), law) != laws.end();
}

// A law of a tool: as the tissue demands it, and as the controller lets the arm render it. Both
// have the one answer to what it asks of the tissue.
template <class L>
struct LawOfTool {
  struct None {};
  LawOfTool(std::size_t points, const Tool&, const GridGeometry&)
      : demanded(points), rendered(points) {}
  void ask(None, const TissueField&, const Pose&, const LawInput&) {}
  void add(L& law, const LawInput& in, ContactForce& out) const { law.add(in, out); }
  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.demanded, self.rendered);
  }

  using Tissues = None;
  L demanded, rendered;
};
template <class L>
requires requires {
  typename L::Query;
}
struct LawOfTool<L> {
  LawOfTool(std::size_t points, const Tool& tool, const GridGeometry& geometry)
      : demanded(points), rendered(points), query(tool, geometry) {}
  void ask(const typename L::Tissues& tissues, const TissueField& tissue, const Pose& tool_mm,
           const LawInput& in) {
    answer = query.ask(tissues, tissue, tool_mm, in);
  }
  void add(L& law, const LawInput& in, ContactForce& out) const { law.add(in, answer, out); }
  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.demanded, self.rendered);
  }

  using Tissues = typename L::Tissues;
  L demanded, rendered;
  typename L::Query query;
  typename L::Answer answer{};
};

namespace detail {

struct LawTraits {
  Impedance (*impedance)(const TissueClass&) = nullptr;
  std::optional<LawKind> stands_in_for;
  bool stops_at_solid = false;
};

template <class L, class... Laws>
constexpr LawKind kindOf(LawList<Laws...>) {
  int kind = 0;
  (void)((std::is_same_v<L, Laws> || (++kind, false)) || ...);
  return LawKind(kind);
}
template <class L>
constexpr LawTraits traitsOf() {
  LawTraits traits;
  traits.impedance = &L::impedance;
  if constexpr (requires { typename L::StandsInFor; }) {
    traits.stands_in_for = kindOf<typename L::StandsInFor>(AllLaws{});
  }
  if constexpr (requires { L::kStopsAtSolid; }) traits.stops_at_solid = L::kStopsAtSolid;
  return traits;
}
template <class... Laws>
constexpr std::array<LawTraits, sizeof...(Laws)> traitsOfAll(LawList<Laws...>) {
  return {traitsOf<Laws>()...};
}

template <class List>
struct Made;
template <class... Laws>
struct Made<LawList<Laws...>> {
  using OfTool = std::variant<LawOfTool<Laws>...>;
  using OfTissues = std::tuple<typename LawOfTool<Laws>::Tissues...>;
};

}  // namespace detail

inline constexpr auto kLawTraits = detail::traitsOfAll(AllLaws{});
static_assert(kLawTraits.size() == kLawNames.size());

using Law = detail::Made<AllLaws>::OfTool;

namespace detail {
template <std::size_t N = 0>
Law makeLawFrom(std::size_t index, std::size_t points, const Tool& tool,
                const GridGeometry& geometry) {
  if constexpr (N + 1 < std::variant_size_v<Law>) {
    if (index > N) return makeLawFrom<N + 1>(index, points, tool, geometry);
  }
  return Law(std::in_place_index<N>, points, tool, geometry);
}
}  // namespace detail

// For a tool that acts at so many points.
inline Law makeLaw(LawKind kind, std::size_t points, const Tool& tool,
                   const GridGeometry& geometry) {
  return detail::makeLawFrom(std::size_t(kind), points, tool, geometry);
}

// Whether a law acts in a tissue, in an exercise that names these laws: it is one of them, and none
// of the others stands in for it there. No allocation.
inline bool acts(const std::vector<LawKind>& laws, LawKind law, const TissueClass& tissue) {
  const auto standsIn = [&](LawKind other) {
    const detail::LawTraits& traits = kLawTraits[std::size_t(other)];
    if (traits.stands_in_for != law) return false;
    const Impedance demanded = traits.impedance(tissue);
    return demanded.damping > 0.0 || demanded.stiffness > 0.0;
  };
  return names(laws, law) && std::none_of(laws.begin(), laws.end(), standsIn);
}

// Damping and stiffness that these laws together demand of a tissue.
inline Impedance demandedOf(const std::vector<LawKind>& laws, const TissueClass& tissue) {
  Impedance sum;
  for (LawKind law : laws) {
    if (!acts(laws, law, tissue)) continue;
    const Impedance demanded = kLawTraits[std::size_t(law)].impedance(tissue);
    sum.damping += demanded.damping;
    sum.stiffness += demanded.stiffness;
  }
  return sum;
}

// Whether solid tissue stops a tool under these laws; else it is where its arm is.
inline bool stopAtSolid(const std::vector<LawKind>& laws) {
  return std::any_of(laws.begin(), laws.end(),
                     [](LawKind law) { return kLawTraits[std::size_t(law)].stops_at_solid; });
}

// What the laws of an exercise make of its tissues, for all tools.
class LawTissues {
 public:
  // From now on the tissues are these. No allocation.
  void use(const TissueTable& tissues, const std::vector<LawKind>& laws) {
    static_assert(kMaxTissues <= 32);
    std::apply(
        [&, kind = 0](auto&... of) mutable { (useOne(of, LawKind(kind++), tissues, laws), ...); },
        of_laws_);
  }
  // What law asks of the tissue around its tool, at this pose; once a tick, before its force.
  void ask(Law& law, const TissueField& tissue, const Pose& tool_mm, const LawInput& in) const {
    askOne(law, tissue, tool_mm, in, std::make_index_sequence<std::variant_size_v<Law>>());
  }

 private:
  template <class Tissues>
  static void useOne(Tissues& of, LawKind law, const TissueTable& tissues,
                     const std::vector<LawKind>& laws) {
    if constexpr (requires { of.use(tissues, 0u); }) {
      std::uint32_t acts_in = 0;
      for (int c = 0; c < tissues.count; ++c) {
        if (acts(laws, law, tissues.classes[std::size_t(c)])) acts_in |= 1u << c;
      }
      if (names(laws, law)) of.use(tissues, acts_in);
    }
  }
  template <std::size_t... N>
  void askOne(Law& law, const TissueField& tissue, const Pose& tool_mm, const LawInput& in,
              std::index_sequence<N...>) const {
    const auto ask = [&](auto* one, const auto& of) {
      if (one) one->ask(of, tissue, tool_mm, in);
    };
    (ask(std::get_if<N>(&law), std::get<N>(of_laws_)), ...);
  }

  detail::Made<AllLaws>::OfTissues of_laws_;
};

// What the tissue demands; what the controller lets the arm render of it, by `in.share`.
inline void addDemanded(Law& law, const LawInput& in, ContactForce& out) {
  std::visit([&](auto& of) { of.add(of.demanded, in, out); }, law);
}
inline void addRendered(Law& law, const LawInput& in, ContactForce& out) {
  std::visit([&](auto& of) { of.add(of.rendered, in, out); }, law);
}
inline void forgetLaw(Law& law) {
  std::visit(
      [](auto& of) {
        of.demanded.forget();
        of.rendered.forget();
      },
      law);
}
// The arm was put back to its tool elsewhere.
inline void engageLaw(Law& law) {
  std::visit(
      [](auto& of) {
        if constexpr (requires { of.demanded.engage(); }) {
          of.demanded.engage();
          of.rendered.engage();
        }
      },
      law);
}

}  // namespace trephine
