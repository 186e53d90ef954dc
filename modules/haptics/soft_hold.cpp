#include "haptics/soft_hold.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

// An edge sticks until its force is this share above that of steady cutting, and slips until it is
// as much below: the crack runs on by the energy that was stored, so that the mean is that of
// steady cutting. Tuned here, uncited; the form: Chanthasopeephan, Desai and Lau 2003.
constexpr double kStickSlip = 0.15;
// Work of an edge above that of new surface alone; tuned here, uncited.
constexpr double kDull = 1.1;

constexpr std::size_t kTurns = 16;     // ticks from one look at a part of the shaft to the next
constexpr std::size_t kEdgeTurns = 4;  // of the edge
constexpr double kPart_mm = 0.5;       // of shaft and edge, but
constexpr double kMostParts = 128.0;   // parts at most
constexpr double kStepOfVoxel = 0.25;  // along the way of the tip
constexpr double kMostSteps = 64.0;    // a tick
constexpr double kAhead = 0.75;        // voxels beyond the slot: what is before it, is whole
constexpr double kLeash_mm = 0.5;      // over which the way of the tip is taken
constexpr double kForwards = 0.5;      // cosine: a tip meets a membrane along its tool
constexpr int kSheet = 7;              // voxels of 27: fewer are a speckle
constexpr double kAway_mm = 1.0;       // from a membrane: it may be met again
constexpr double kWithin_mm = 1.0;     // on in a thick one: it has another side
constexpr double kTiny_mm = 1e-9;

}  // namespace

SoftHold::SoftHold(const Tool& tool, const GridGeometry& geometry, const SoftLaws& laws,
                   double period_s)
    : laws_(laws),
      patient_to_voxel_(geometry.patientToVoxel()),
      turn_to_voxel_(patient_to_voxel_),
      period_s_(period_s),
      width_mm_(2000.0 * tool.radius_m),
      parts_tissue_(!tool.blunt) {
  const Vec3& spacing = geometry.spacing_mm;
  voxel_mm_ = std::max({spacing.x, spacing.y, spacing.z});
  step_mm_ = kStepOfVoxel * std::min({spacing.x, spacing.y, spacing.z});
  slot_mm_ = std::max(0.5 * width_mm_, 0.5 * voxel_mm_);
  reach_ = slot_mm_ / spacing + 0.5;
  const double length_mm = tool.made_from.length_mm;
  const auto partsOf = [](double mm) {
    return std::size_t(std::clamp(std::ceil(mm / kPart_mm), 1.0, kMostParts));
  };
  shaft_.assign(partsOf(length_mm), -1);
  part_mm_ = length_mm / double(shaft_.size());
  const double edge_mm = parts_tissue_ ? 1000.0 * tool.solid_to_m.z : 0.0;
  if (edge_mm > 0.0) {
    edge_.assign(partsOf(edge_mm), -1);
    edge_part_mm_ = edge_mm / double(edge_.size());
  }
}

void SoftHold::forget() {
  stretch_mm_ = crept_mm_ = Vec3(0.0);
  last_.position = tip_mm_;
  held_ = -1;
  cut_J_ = 0.0;
  gave_way_ = false;
  pull_ = {};
}

void SoftHold::place(const Pose& arm_mm) {
  last_ = arm_mm;
  arm_mm_ = tip_mm_ = behind_mm_ = arm_mm.position;
  fresh_ = true;
  class_ = ahead_ = passing_ = -1;
  enclosed_ = false;
  std::fill(shaft_.begin(), shaft_.end(), std::int8_t(-1));
  std::fill(edge_.begin(), edge_.end(), std::int8_t(-1));
  count();
  forget();
}

void SoftHold::count() {
  parts_.fill(0);
  in_tissue_ = 0;
  for (std::int8_t c : shaft_) {
    if (c < 0) continue;
    ++parts_[std::size_t(c)];
    ++in_tissue_;
  }
}

std::uint32_t SoftHold::wholeBefore(const TissueTable& tissues) const {
  std::uint32_t whole = 0;
  for (int c = 0; laws_.membrane && c < tissues.count; ++c) {
    if (c != passing_ && isMembrane(tissues.classes[std::size_t(c)])) whole |= 1u << c;
  }
  return whole;
}

Pose SoftHold::follow(const TissueField& tissue, const Pose& arm, bool stopped, bool driven) {
  gave_way_ = false;
  cut_J_ = 0.0;
  arm_mm_ = arm.position;
  last_.orientation = arm.orientation;
  lookAlong(tissue);
  double let_go_J = -1.0;
  if (held_ >= 0 && !pressesOn(tissue)) let_go_J = letGo_J(tissue);
  const Vec3 target_mm = held_ >= 0 ? kept_mm_ : arm_mm_;
  if (held_ < 0 && (!stopped || let_go_J > 0.0)) slip(tissue, target_mm, driven, let_go_J);
  creep(tissue);
  last_.position = target_mm - stretch_mm_;
  tell(tissue);
  return last_;
}

// False where the arm has drawn back from the membrane, or presses as much as it bears.
bool SoftHold::pressesOn(const TissueField& tissue) const {
  const TissueClass& t = tissue.ofClass(held_);
  const Vec3 pressed_mm = arm_mm_ - from_mm_;
  if (!isMembrane(t) || glm::dot(pressed_mm, inwards_) < 0.0) return false;
  const double travel_mm = glm::length(pressed_mm);
  return membraneForce_N(t, travel_mm - crept_travel_mm_) < ruptureForce_N(t, width_mm_);
}

// The membrane no longer holds the tip. Returns the energy that it had stored where it gave way;
// -1 where the arm drew back and it is whole.
double SoftHold::letGo_J(const TissueField& tissue) {
  const TissueClass& t = tissue.ofClass(held_);
  const int c = held_;
  held_ = -1;
  const Vec3 pressed_mm = arm_mm_ - from_mm_;
  if (!isMembrane(t) || glm::dot(pressed_mm, inwards_) < 0.0) return -1.0;
  gave_way_ = true;
  passing_ = c;
  away_mm_ = within_mm_ = 0.0;
  hole_ = next_hole_;
  next_hole_ = (next_hole_ + 1) % kHoles;
  holes_[std::size_t(hole_)] = {tip_mm_, tip_mm_, c};
  // Not beyond the force at which it gave way, however far the arm went in this tick.
  return membraneEnergy_J(
      t, std::min(glm::length(pressed_mm) - crept_travel_mm_, ruptureTravel_mm(t, width_mm_)));
}

// The tool goes on where its spring pulls it by more than its way costs.
void SoftHold::slip(const TissueField& tissue, const Vec3& target_mm, bool driven,
                    double let_go_J) {
  const double before_mm = glm::length(stretch_mm_ - crept_mm_);
  stretch_mm_ = target_mm - last_.position;
  const Vec3 pulls_mm = stretch_mm_ - crept_mm_;
  const double length_mm = glm::length(pulls_mm);
  if (!(length_mm > kTiny_mm)) return;
  const Vec3 way = pulls_mm / length_mm;
  int ahead = enclosed_ ? ahead_ : -1;
  if (let_go_J >= 0.0) {
    ahead = softAt(tissue, placeOf(target_mm) + beyond(forwards()));
  }
  lookBefore(tissue, way);
  const Cost cost = costOf(tissue, way, ahead, driven);
  const double all_N = cost.cutting_N + cost.friction_N;
  const double per_mm = 0.001 * kCling_N_per_m;
  const double high_N = all_N + kStickSlip * cost.cutting_N;
  double low_N = all_N - kStickSlip * cost.cutting_N;
  if (all_N > 0.0) cutting_share_ = cost.cutting_N / all_N;
  if (per_mm * length_mm <= high_N && let_go_J < 0.0) return;
  const double before_J = 0.0005 * per_mm * before_mm * before_mm;
  if (let_go_J >= 0.0) {
    // What the membrane had stored is all that there is for the spring after it.
    low_N = std::min(low_N, std::sqrt(2000.0 * per_mm * (before_J + let_go_J)));
    low_N = std::min(low_N, per_mm * length_mm);
  }
  const double left_mm = low_N / per_mm;
  if (all_N > 0.0) {
    stretch_mm_ = crept_mm_ + left_mm * way;
  } else {
    stretch_mm_ = crept_mm_ = Vec3(0.0);
  }
  if (let_go_J >= 0.0) {
    cut_J_ += std::max(0.0, before_J + let_go_J - 0.0005 * per_mm * left_mm * left_mm);
  } else {
    cut_J_ += 0.001 * cost.cutting_N * (length_mm - left_mm);
  }
}

SoftHold::Cost SoftHold::costOf(const TissueField& tissue, const Vec3& way, int ahead,
                                bool driven) const {
  Cost cost;
  if (laws_.friction) {
    for (int c = 0; c < tissue.tissues().count; ++c) {
      cost.friction_N += parts_[std::size_t(c)] * part_mm_ * tissue.ofClass(c).shaft_N_per_mm;
    }
  }
  if (!laws_.cutting || driven || !parts_tissue_) return cost;
  const auto per_mm = [&](int c) {
    return kDull * 0.001 * toughness_J_per_m2(tissue.ofClass(c), width_mm_);
  };
  const double along = glm::dot(way, forwards());
  const double across = std::sqrt(std::max(0.0, 1.0 - along * along));
  if (ahead >= 0 && along > 0.0) cost.cutting_N += per_mm(ahead) * width_mm_ * along;
  for (std::int8_t c : edge_) {
    if (c >= 0) cost.cutting_N += per_mm(c) * edge_part_mm_ * across;
  }
  return cost;
}

// From the axis of the tool to beyond what it has cut, voxels.
Vec3 SoftHold::beyond(const Vec3& way) const {
  const Vec3 along = turn_to_voxel_ * way;  // voxels per mm
  const double most = std::max({std::abs(along.x), std::abs(along.y), std::abs(along.z)});
  return (slot_mm_ + kAhead / most) * along;
}

int SoftHold::softAt(const TissueField& tissue, const Vec3& place) const {
  const int c = tissue.classAt(place);
  return tissue.isSolid(c) ? -1 : c;
}

// The soft tissue at a place on the axis, or beside the slot that the tool has cut there.
int SoftHold::classBeside(const TissueField& tissue, const Vec3& place) const {
  int firmest = softAt(tissue, place);
  if (firmest >= 0) return firmest;
  for (int axis = 0; axis < 3; ++axis) {
    for (double reach : {reach_[axis], -reach_[axis]}) {
      Vec3 at = place;
      at[axis] += reach;
      const int found = softAt(tissue, at);
      if (tissue.firmer(found, firmest)) firmest = found;
    }
  }
  return firmest;
}

// The parts of the shaft take turns.
void SoftHold::lookAlong(const TissueField& tissue) {
  if (!laws_.friction) return;
  ++turn_;
  const Vec3 tip = placeOf(last_.position);
  const Vec3 step = part_mm_ * (turn_to_voxel_ * (last_.orientation * Vec3(0.0, 0.0, 1.0)));
  const Vec3 end = tip + double(shaft_.size()) * step;
  if (!tissue.mayHold(glm::min(tip, end) - reach_ - 1.0, glm::max(tip, end) + reach_ + 1.0)) {
    if (in_tissue_ == 0) return;
    std::fill(shaft_.begin(), shaft_.end(), std::int8_t(-1));
    return count();
  }
  for (std::size_t i = turn_ % kTurns; i < shaft_.size(); i += kTurns) {
    const auto found = std::int8_t(classBeside(tissue, tip + (double(i) + 0.5) * step));
    std::int8_t& was = shaft_[i];
    if (found == was) continue;
    if (was >= 0) --parts_[std::size_t(was)], --in_tissue_;
    if (found >= 0) ++parts_[std::size_t(found)], ++in_tissue_;
    was = found;
  }
}

// The parts of the edge take turns; what is before them, across the edge.
void SoftHold::lookBefore(const TissueField& tissue, const Vec3& way) {
  if (edge_.empty() || !laws_.cutting) return;
  const Vec3 back = last_.orientation * Vec3(0.0, 0.0, 1.0);
  const Vec3 across = way - glm::dot(way, back) * back;
  const double length = glm::length(across);
  if (!(length > kTiny_mm)) return;
  const Vec3 before = placeOf(last_.position) + beyond(across / length);
  const Vec3 step = edge_part_mm_ * (turn_to_voxel_ * back);
  for (std::size_t i = turn_ % kEdgeTurns; i < edge_.size(); i += kEdgeTurns) {
    edge_[i] = std::int8_t(softAt(tissue, before + (double(i) + 0.5) * step));
  }
}

// A tissue that relaxes gives way by its share of the stretch within its time; nothing of it comes
// back, so that it only takes energy.
void SoftHold::creep(const TissueField& tissue) {
  if (!laws_.relaxation) return;
  const auto rate = [&](int c) {
    const TissueClass& t = tissue.ofClass(c);
    return t.relaxation_s > 0.0 ? std::min(1.0, period_s_ / t.relaxation_s) : 0.0;
  };
  if (held_ >= 0) {
    const double travel_mm = glm::length(arm_mm_ - from_mm_);
    const double left_mm = tissue.ofClass(held_).relaxation_share * travel_mm - crept_travel_mm_;
    crept_travel_mm_ += rate(held_) * std::max(0.0, left_mm);
  }
  const int at = class_ >= 0 ? class_ : ahead_;
  if (at < 0) return;
  const Vec3 left_mm = tissue.ofClass(at).relaxation_share * stretch_mm_ - crept_mm_;
  if (glm::dot(left_mm, stretch_mm_ - crept_mm_) > 0.0) crept_mm_ += rate(at) * left_mm;
}

void SoftHold::tell(const TissueField& tissue) {
  pull_ = {};
  pull_.parts = laws_.cutting && parts_tissue_;
  const Vec3 pulls_mm = stretch_mm_ - crept_mm_;
  if (pulls_mm != Vec3(0.0) || in_tissue_ > 0 || enclosed_) {
    pull_.stiffness = kCling_N_per_m;
    pull_.force_N = -0.001 * kCling_N_per_m * pulls_mm;
    pull_.cutting = !laws_.friction ? 1.0 : !laws_.cutting ? 0.0 : cutting_share_;
    pull_.friction = 1.0 - pull_.cutting;
  }
  if (held_ < 0) return;
  const TissueClass& t = tissue.ofClass(held_);
  const Vec3 pressed_mm = arm_mm_ - from_mm_;
  const double length_mm = glm::length(pressed_mm);
  const double travel_mm = std::max(0.0, length_mm - crept_travel_mm_);
  pull_.membrane_stiffness = membraneStiffness_N_per_m(t, travel_mm);
  pull_.membrane_J = membraneEnergy_J(t, travel_mm);
  if (length_mm > kTiny_mm) {
    pull_.membrane_N = (-membraneForce_N(t, travel_mm) / length_mm) * pressed_mm;
  }
}

// How the tip moved over the last half millimetre, unit; where it stood, along the tool.
Vec3 SoftHold::wayOfTip(const Vec3& tip_mm) const {
  const Vec3 way = tip_mm - behind_mm_;
  const double length_mm = glm::length(way);
  return length_mm > kTiny_mm ? way / length_mm : forwards();
}

// Whether there is tissue beside the tip: before that the slot's front is not in it.
bool SoftHold::isEnclosed(const TissueField& tissue, const Pose& at) const {
  const Vec3 place = placeOf(at.position);
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
    const Vec3 reach = beyond(at.orientation * side);
    if (softAt(tissue, place + reach) >= 0 || softAt(tissue, place - reach) >= 0) return true;
  }
  return false;
}

Pose SoftHold::moved(const TissueField& tissue, const Pose& tool, bool stopped) {
  const Vec3 from_mm = tip_mm_, way_mm = tool.position - from_mm;
  const double length_mm = glm::length(way_mm);
  const Vec3 forwards = tool.orientation * Vec3(0.0, 0.0, -1.0);
  const double steps = std::clamp(std::ceil(length_mm / step_mm_), 1.0, kMostSteps);
  Pose at = tool;
  for (double n = 1.0; n <= steps && laws_.membrane; ++n) {
    const Vec3 tip_mm = from_mm + (n / steps) * way_mm;
    const Vec3 place = placeOf(tip_mm);
    const int c = softAt(tissue, place), before = class_;
    class_ = c;
    if (passing_ >= 0) {
      // In the channel that it cuts itself the tissue is before it.
      const bool in_it = c == passing_ || ahead_ == passing_;
      away_mm_ = in_it ? 0.0 : away_mm_ + length_mm / steps;
      if (in_it && hole_ >= 0) holes_[std::size_t(hole_)].to_mm = tip_mm;
      if (away_mm_ > std::max(kAway_mm, voxel_mm_)) passing_ = -1;
    }
    const bool entered = c >= 0 && c != before && c != passing_ && isMembrane(tissue.ofClass(c));
    if (!entered) continue;
    if (!fresh_ && !stopped && held_ < 0 && meets(tissue, tip_mm, place, c)) {
      at.position = tip_mm;
      meet(c, tip_mm);
      break;
    }
    if (held_ < 0 && !stopped) {
      passing_ = c;
      away_mm_ = within_mm_ = 0.0;
      hole_ = holeAt(tip_mm, c);
    }
  }
  fresh_ = false;
  const Vec3 lag_mm = at.position - behind_mm_;
  const double lag = glm::length(lag_mm);
  const bool on = glm::dot(wayOfTip(at.position), forwards) > kForwards;
  if (lag > kLeash_mm) behind_mm_ = at.position - (kLeash_mm / lag) * lag_mm;
  const int was_ahead = ahead_;
  ahead_ = softAt(tissue, placeOf(at.position) + beyond(forwards));
  enclosed_ = ahead_ >= 0 && isEnclosed(tissue, at);
  // The other side of a thick membrane, where nothing stands behind it.
  if (passing_ >= 0 && ahead_ == passing_ && on && !gave_way_) {
    within_mm_ += glm::length(at.position - from_mm);
  }
  const bool leaves = passing_ >= 0 && was_ahead == passing_ && ahead_ < 0 && on && !stopped &&
                      held_ < 0 && !gave_way_ && within_mm_ > kWithin_mm;
  if (leaves && tissue.classAt(placeOf(at.position) + beyond(forwards)) < 0) {
    meet(passing_, at.position);
    within_mm_ = 0.0;
  }
  tip_mm_ = at.position;
  return at;
}

bool SoftHold::meets(const TissueField& tissue, const Vec3& tip_mm, const Vec3& place,
                     int c) const {
  return glm::dot(wayOfTip(tip_mm), forwards()) >= kForwards && holeAt(tip_mm, c) < 0 &&
         isSheet(tissue, place, c);
}

void SoftHold::meet(int c, const Vec3& tip_mm) {
  held_ = c;
  from_mm_ = arm_mm_;
  kept_mm_ = tip_mm + stretch_mm_;
  inwards_ = wayOfTip(tip_mm);
  crept_travel_mm_ = 0.0;
  last_.position = tip_mm;
}

// Whether there is more of it around than a voxel or two.
bool SoftHold::isSheet(const TissueField& tissue, const Vec3& place, int c) const {
  int count = 0;
  for (int k = -1; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) count += tissue.classAt(place + Vec3(i, j, k)) == c;
    }
  }
  return count >= kSheet;
}

// The hole of this tissue that a place is in, or -1.
std::int32_t SoftHold::holeAt(const Vec3& tip_mm, int c) const {
  const double wide_mm = slot_mm_ + voxel_mm_;
  for (std::int32_t n = 0; n < kHoles; ++n) {
    const Hole& hole = holes_[std::size_t(n)];
    if (hole.tissue_class != c) continue;
    const Vec3 along = hole.to_mm - hole.from_mm, to = tip_mm - hole.from_mm;
    const double length2 = glm::dot(along, along);
    const double share = length2 > 0.0 ? std::clamp(glm::dot(to, along) / length2, 0.0, 1.0) : 0.0;
    if (glm::length(to - share * along) <= wide_mm) return n;
  }
  return -1;
}

void SoftHold::restored(const TissueField& tissue) {
  for (Hole& hole : holes_) {
    if (hole.tissue_class >= 0 && tissue.classAt(placeOf(hole.from_mm)) >= 0) hole = {};
  }
}

}  // namespace trephine
