// The force laws that an exercise can name. Each is a small type in its own file under laws/,
// created only when the exercise names it:
//
//   static constexpr LawWords kWords           what it is called and does
//   static constexpr std::array kNumbers       which numbers of a tissue it uses, as members of
//                                              TickNumbers; where one of them is 0, the others do
//                                              nothing by this law
//   explicit Law(points)                       room for a tool of so many points
//   void add(const LawInput&, ContactForce&)   adds its force on the arm; nothing without contact
//   void forget()                              after an undo or reset: it begins anew
//   static Impedance impedance(tissue)         what it demands of a tissue; zero: not its own
//   static void visitState(self, archive)      its members, if it has any (base/state_archive.h)
//
// and, where it is so:
//
//   static constexpr bool kEachAlone           each of its numbers acts without the others
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
// To add a law: its file, its include and its place in the list here, its tests (README.md).
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "haptics/laws/coulomb.h"
#include "haptics/laws/cutting.h"
#include "haptics/laws/elastic.h"
#include "haptics/laws/friction.h"
#include "haptics/laws/membrane.h"
#include "haptics/laws/relaxation.h"
#include "haptics/laws/rupture.h"
#include "haptics/laws/viscous.h"

namespace trephine {

template <class... Laws>
struct LawList {};
using AllLaws = LawList<ViscousLaw, CoulombLaw, ElasticLaw, RuptureLaw, MembraneLaw, CuttingLaw,
                        FrictionLaw, RelaxationLaw>;

// A law's place in the list. Those that are spoken of elsewhere have a name here; that of any is
// kLawKind.
enum class LawKind { viscous, coulomb, elastic, rupture, membrane, cutting, friction, relaxation };

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
  LawWords words{};
  std::span<double TickNumbers::*const> numbers;
  Impedance (*impedance)(const TissueClass&) = nullptr;
  std::optional<LawKind> stands_in_for;
  bool stops_at_solid = false;
  bool each_alone = false;
  bool shares_spring = false;  // all such laws pull by one spring together
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
  traits.words = L::kWords;
  traits.numbers = L::kNumbers;
  traits.impedance = &L::impedance;
  if constexpr (requires { typename L::StandsInFor; }) {
    traits.stands_in_for = kindOf<typename L::StandsInFor>(AllLaws{});
  }
  if constexpr (requires { L::kEachAlone; }) traits.each_alone = L::kEachAlone;
  if constexpr (requires { L::kSharesSpring; }) traits.shares_spring = L::kSharesSpring;
  if constexpr (requires { L::kStopsAtSolid; }) traits.stops_at_solid = L::kStopsAtSolid;
  return traits;
}
template <class... Laws>
constexpr std::array<LawTraits, sizeof...(Laws)> traitsOfAll(LawList<Laws...>) {
  return {traitsOf<Laws>()...};
}
template <std::size_t N>
constexpr std::array<std::pair<std::string_view, LawKind>, N> namesOf(
    const std::array<LawTraits, N>& laws) {
  std::array<std::pair<std::string_view, LawKind>, N> names{};
  for (std::size_t n = 0; n < N; ++n) names[n] = {laws[n].words.id, LawKind(n)};
  return names;
}

template <class List>
struct Made;
template <class... Laws>
struct Made<LawList<Laws...>> {
  using OfTool = std::variant<LawOfTool<Laws>...>;
  using OfTissues = std::tuple<typename LawOfTool<Laws>::Tissues...>;
};

}  // namespace detail

template <class L>
inline constexpr LawKind kLawKind = detail::kindOf<L>(AllLaws{});
static_assert(kLawKind<ViscousLaw> == LawKind::viscous);
static_assert(kLawKind<CoulombLaw> == LawKind::coulomb);
static_assert(kLawKind<ElasticLaw> == LawKind::elastic);
static_assert(kLawKind<RuptureLaw> == LawKind::rupture);
static_assert(kLawKind<MembraneLaw> == LawKind::membrane);
static_assert(kLawKind<CuttingLaw> == LawKind::cutting);
static_assert(kLawKind<FrictionLaw> == LawKind::friction);
static_assert(kLawKind<RelaxationLaw> == LawKind::relaxation);

inline constexpr auto kLawTraits = detail::traitsOfAll(AllLaws{});
// By the laws' ids, in files.
inline constexpr auto kLawNames = detail::namesOf(kLawTraits);

constexpr const LawWords& wordsOf(LawKind law) {
  return kLawTraits[std::size_t(law)].words;
}
// Whether a law has a use for a number of a tissue: it uses it, and the tissue has whatever else
// that needs.
inline bool feels(LawKind law, double TickNumbers::*number, const TickNumbers& tissue) {
  bool uses = false, has_others = true;
  for (double TickNumbers::*one : kLawTraits[std::size_t(law)].numbers) {
    uses = uses || one == number;
    has_others = has_others && (one == number || tissue.*one > 0.0);
  }
  return uses && (has_others || kLawTraits[std::size_t(law)].each_alone);
}

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
  double shared = 0.0;
  for (LawKind law : laws) {
    if (!acts(laws, law, tissue)) continue;
    const detail::LawTraits& traits = kLawTraits[std::size_t(law)];
    const Impedance demanded = traits.impedance(tissue);
    sum.damping += demanded.damping;
    if (traits.shares_spring) {
      shared = std::max(shared, demanded.stiffness);
    } else {
      sum.stiffness += demanded.stiffness;
    }
  }
  sum.stiffness += shared;
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
