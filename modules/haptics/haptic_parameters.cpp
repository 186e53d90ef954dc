#include "haptics/haptic_parameters.h"

#include <cmath>

#include "base/codes.h"
#include "base/tr.h"
#include "haptics/codes.h"

namespace trephine {

namespace {

constexpr FieldRow kPeriod{"period_s", {1e-5, 0.1, "s"}, Given::always, trLater("of a tick")};
constexpr FieldRow kMaxForce{"max_force_N", kPeakForce_N, Given::always, trLater("on the arm")};

}  // namespace

Status validate(const ArmDynamics& arm, const std::string& of) {
  if (Status s = checkFields<ArmDynamics>(kArmDynamicsFields, arm, of); !s) return s;
  return checkNumber(kArmPeakForce, arm.peak_force_N, of);
}

double delaySamples(const ArmDynamics& arm, double period_s) {
  const double samples = arm.delay_s / period_s, whole = std::round(samples);
  return std::abs(samples - whole) < 1e-6 ? whole : samples;
}

Status validate(const WorkspaceMap& map, const std::string& of) {
  if (Status s = checkFields<WorkspaceMap>(kWorkspaceMapFields, map, of); !s) return s;
  const double length = glm::length(map.rotation);
  if (std::abs(length - 1.0) <= 1e-6) return {};
  return Error{code::kImpossibleNumber,
               tr("The rotation has a length of {}, and a rotation has 1", plainNumber(length)),
               of + ": rotation_wxyz", tr("Correct it")};
}

std::string contradictsTouchByPoints(const std::vector<LawKind>& laws, ForceAt force_at,
                                     RemovalKind removal) {
  for (LawKind law : laws) {
    if (law == LawKind::viscous) continue;
    return tr(
        "A tool that touches by its points alone feels no other law than `viscous`, and here "
        "is `{}`",
        wordsOf(law).id);
  }
  if (force_at != ForceAt::tip) {
    return tr(
        "A tool that touches by its points alone has its force at the `tip`, and here it is "
        "`distributed`");
  }
  if (removal != RemovalKind::instant) {
    return tr(
        "A tool that touches by its points alone removes what it touches in an `instant`, and "
        "here it is by `work`");
  }
  return {};
}

std::string besideTouchByPoints() {
  return tr("Set that as it has to be, or take `touch_by_points` out");
}

Status validate(const HapticParameters& parameters) {
  if (Status s = checkNumber(kPeriod, parameters.period_s, tr("the loop")); !s) return s;
  if (parameters.arms.size() > std::size_t(kMaxArms)) {
    return Error{
        code::kTooManyArms,
        tr("There are {} arms, and at most {} are served", parameters.arms.size(), kMaxArms),
        tr("the arms"), tr("Take the others out")};
  }
  for (std::size_t i = 0; i < parameters.arms.size(); ++i) {
    const ArmParameters& arm = parameters.arms[i];
    const std::string of = tr("arm {}", i);
    if (Status s = validate(arm.dynamics, of); !s) return s;
    const double samples = delaySamples(arm.dynamics, parameters.period_s);
    if (!kDelaySamples.holds(samples)) {
      return checkNumber({"delay_s", kDelaySamples, Given::always, ""}, samples, of);
    }
    if (Status s = validate(arm.map, of); !s) return s;
    if (Status s = checkNumber(kMaxForce, arm.max_force_N, of); !s) return s;
    if (arm.other_tools.size() >= kMostTools) {
      return Error{code::kTooManyTools,
                   tr("An arm has {} tools, and at most {} are kept ready",
                      1 + arm.other_tools.size(), kMostTools),
                   of, tr("Take the others out")};
    }
  }
  if (parameters.touch_by_points != 0) {
    const std::string what =
        contradictsTouchByPoints(parameters.laws, parameters.force_at, parameters.removal);
    if (!what.empty()) {
      return Error{code::kContradiction, what, "touch_by_points", besideTouchByPoints()};
    }
    if (parameters.touch_by_points >> parameters.tissues.count != 0) {
      return Error{code::kContradiction,
                   tr("A tool is to touch a tissue that is none of the {} that there are",
                      parameters.tissues.count),
                   "touch_by_points", tr("Name tissues of the set")};
    }
  }
  for (int c = 0; c < parameters.tissues.count; ++c) {
    for (const TissueNumber& number : kTissueNumbers) {
      const double value = parameters.tissues.classes[std::size_t(c)].*number.in_tick;
      const std::string of = tr("tissue {}", c);
      if (Status s = checkNumber(number.row(), value, of); !s) return s;
    }
  }
  return {};
}

}  // namespace trephine
