// What a hand meets in a tissue before anybody has touched it: a tool goes straight into a block of
// it, computed by the core itself; the published range of that force beside it; and what the arm's
// own friction hides. Pure.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "exercise/exercise.h"
#include "exercise/rig.h"
#include "session/poke_curves.h"

namespace trephine {

// At 10 mm/s, 12 mm deep, by the arm as it is on this rig: the tool that it has at first, pushed
// along itself into a block of this tissue by a hand that nothing stops, at 2 kHz at most. Forces
// at the arm. No points where the exercise touches by points, and none of them meets this tissue.
// About 30 ms. `arm` and `tissue`: places in the exercise.
PokeCurve pokeOf(const Exercise& exercise, const Rig& rig, std::size_t arm, std::size_t tissue);
constexpr double kPokeSpeed_mm_s = 10.0, kPokeDepth_mm = 12.0;

// Published of the force of such a poke, at the arm, from one depth to another: low and high at
// both ends, straight between them.
struct PublishedBand {
  enum class Of { rupture, passing } of = Of::rupture;  // giving way; going on and along the shaft
  double from_mm = 0.0, to_mm = 0.0;
  double low_from_N = 0.0, high_from_N = 0.0, low_to_N = 0.0, high_to_N = 0.0;
  Confidence confidence = Confidence::unstated;  // the weakest of the numbers that it is made of
};
// Of the tissue's numbers that carry a published range and that a law of the exercise goes by: the
// force at which it gives way to this tool; and toughness times the tool's width, with the friction
// along the shaft. Of a number without a range, where the other one has one, its value. Empty where
// nothing was published.
std::vector<PublishedBand> publishedBands(const Exercise& exercise, std::size_t arm,
                                          std::size_t tissue);

// All pokes of one arm, a curve for each of the exercise's tissues.
struct ArmPokes {
  std::size_t arm = 0;
  double friction_N = 0.0;  // the arm's own; 0: not known
  std::vector<PokeCurve> curves;
};
// Of every arm. Errors: CANCELLED.
Result<std::vector<ArmPokes>> pokesOf(const Exercise& exercise, const Rig& rig,
                                      const Progress& progress = Progress());

// A stated rule, and no measure of what people perceive: a force that does not exceed the arm's
// friction over 0.2 mm of the way is lost in it (a hand at rest meets nothing, a moving one a
// little more drag). Two tissues are told apart where their forces differ by more than it over 0.2
// mm, however one is shifted against the other by up to 1 mm: no hand knows where a tissue began.
// True where the friction is not known.
bool isFeltThrough(const PokeCurve& curve, double friction_N);
bool areToldApart(const PokeCurve& one, const PokeCurve& other, double friction_N);

// The tissues that are felt, as this one is, and that this arm does not tell apart from it.
std::vector<std::size_t> notToldApart(const ArmPokes& pokes, std::size_t tissue);

// In words, a line each, for a tissue: "Brain: at most 0.06 N in a poke at the right arm, which is
// lost in that arm's own friction, stated as 0.26 N".
std::vector<std::string> hiddenWords(const Exercise& exercise, const ArmPokes& pokes,
                                     std::size_t tissue);

}  // namespace trephine
