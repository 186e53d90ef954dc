// What a law is told in a tick. Patient axes, SI units.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "base/math.h"
#include "haptics/arm_dynamics.h"
#include "haptics/law_words.h"
#include "haptics/proxy.h"
#include "haptics/soft_pull.h"
#include "tissue/tissue_set.h"

namespace trephine {

// Where the force of a contact acts: as if at the tip, in the firmest tissue that any point touches
// (the seed paper), or spread over the tool's points, each with its own tissue and velocity.
enum class ForceAt : std::int32_t { tip, distributed };
inline constexpr std::array<std::pair<std::string_view, ForceAt>, 2> kForceAtNames{
    {{"tip", ForceAt::tip}, {"distributed", ForceAt::distributed}}};

// A point at which a law acts. With ForceAt::tip there is one, at the tip, with weight 1.
struct TouchPoint {
  Vec3 lever_m{0.0};               // r, from the tip
  Vec3 rotational_m_s{0.0};        // omega x r: its velocity beyond that of the tip
  double weight = 1.0;             // its share of the tool
  std::int32_t tissue_class = -1;  // -1 air
};

// The tool is where its proxy is; it moves as the arm moves it.
struct LawInput {
  Vec3 tip_m{0.0};
  Vec3 velocity_m_s{0.0};  // of the arm, at the tip
  double period_s = 0.0;   // since the tick before
  Vec3 tool_direction{0.0};  // from the handle to the tip, unit
  std::span<const TouchPoint> points;
  std::int32_t tissue_class = -1;  // the firmest that any of the tool touches; -1 none
  std::int32_t tip_class = -1;     // where the tip itself is
  const TissueTable* tissues = nullptr;
  Impedance share{1.0, 1.0};  // rendered / demanded, of the tissues' damping and stiffness
  Pull pull;  // from the arm to the proxy that solid tissue holds, if a law stops its tool there
  SoftPull soft;  // of soft tissue, if a law holds its tool there

  bool touching() const { return tissue_class >= 0; }
  const TissueClass& tissue(const TouchPoint& p) const {
    return tissues->classes[std::size_t(p.tissue_class)];
  }
};

}  // namespace trephine
