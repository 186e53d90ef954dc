// What a law is told in a tick. Patient axes, SI units.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "base/math.h"
#include "haptics/arm_dynamics.h"
#include "haptics/proxy.h"
#include "haptics/stiffness_ball.h"
#include "tissue/tissue_set.h"

namespace trephine {

// Where the force of a contact acts: as if at the tip, in the firmest tissue that any point touches
// (the seed paper), or spread over the tool's points, each with its own tissue and velocity.
enum class ForceAt : std::int32_t { tip, distributed };
inline constexpr std::array<std::pair<std::string_view, ForceAt>, 2> kForceAtNames{
    {{"tip", ForceAt::tip}, {"distributed", ForceAt::distributed}}};

// A point at which a law acts. With ForceAt::tip there is one, at the tip, with weight 1.
struct TouchPoint {
  Vec3 arm_m{0.0};        // r, from the tip
  Vec3 turning_m_s{0.0};  // omega x r: its velocity beyond that of the tip
  double weight = 1.0;    // its share of the tool
  std::int32_t tissue_class = -1;  // -1 air
};

// The tool is where its proxy is; it moves as the arm moves it.
struct LawInput {
  Vec3 tip_m{0.0};
  Vec3 velocity_m_s{0.0};  // of the arm, at the tip
  Vec3 into_m{0.0};        // the way the tool points, of length 1
  std::span<const TouchPoint> points;
  bool touching = false;   // any of them
  std::int32_t tip_class = -1;  // where the tip itself is
  const TissueTable* tissues = nullptr;
  Impedance share{1.0, 1.0};  // of the tissues' damping and stiffness that is rendered
  Pull pull;                  // of solid tissue, which the proxy does not enter; and:
  ElasticPush push;           // of soft tissue on the tool's ball; both for the elastic law
  Vec3 ball_m{0.0};           // the ball's centre from the tip
  bool parts = false;         // the tool parts the tissue before it, being sharp
  double ball_radius_m = 0.0;

  const TissueClass& tissue(const TouchPoint& p) const {
    return tissues->classes[std::size_t(p.tissue_class)];
  }
};

}  // namespace trephine
