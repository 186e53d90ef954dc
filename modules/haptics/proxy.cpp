#include "haptics/proxy.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace trephine {

namespace {

// Lengths, all in units of a voxel's smallest edge.
constexpr double kStep = 0.45;  // the longest step between two looks at the gaps
constexpr double kNear = 0.05;  // the shortest distance within which touches are looked for
// Pieces that voxels which went have made stale hold for so much travel only (0.05 mm at least).
// Until the next search the tool may enter what stood behind them by that much: it cuts it or is
// put back from it.
constexpr double kWorn = 0.25, kLeastWorn_mm = 0.05;
constexpr double kKeptOff = 0.02;     // gap that is kept where the tool comes from farther away
constexpr double kTolerated = 0.002;  // depth to which a sliding tool may be inside
constexpr double kInside = 0.1;       // a tool that is deeper is put outside
// A tool that starts deeper is in solid tissue: the centre of a voxel may be in it.
constexpr double kStands = 0.6;
constexpr double kSame = 1.0;  // flat pieces that touch the tool so near each other are one touch
constexpr double kArrived = 1e-3;  // a shorter step is none

constexpr int kCorrections = 4;       // of a pose, where the surface bends
constexpr int kShorter = 3;           // tries of a step, each shorter
constexpr double kShorterBy = 0.4;    // by this factor
constexpr double kNearer_mm2 = 1e-9;  // by which the squared distance to the arm must fall
constexpr double kHeld_mm = 1e-6;     // a tool nearer to its arm is at it
// The next search of the surface goes on kWorkATick rows a tick. It begins when, at the present
// speed, it takes this share of the time for which the present surface still holds.
constexpr double kEarly = 0.67;
constexpr int kWorkATick = 256;
// The weight of turns, r^2, is a sixth of the tool's reach squared, with a reach of this at least:
// a hand holds a short tool by a handle, too. (A rod's points move by a third of its length squared
// on average; half of that, since its far end moves most.)
constexpr double kHandle_mm = 60.0;

SmallMotion towards(const Pose& from, const Pose& to) {
  return {to.position - from.position, smallTurn(from.orientation, to.orientation)};
}

// A small turn applied to an orientation.
Quat turned(const Vec3& by, const Quat& q) {
  return glm::normalize(Quat(1.0, 0.5 * by.x, 0.5 * by.y, 0.5 * by.z) * q);
}

}  // namespace

Proxy::Proxy(const Tool& tool, const GridGeometry& geometry, int touch_version)
    : surface_(tool, geometry, touch_version),
      turn_mm2_(std::pow(std::max(surface_.reach_mm(), kHandle_mm), 2) / 6.0) {}

void Proxy::place(const Pose& pose_mm) {
  arm_ = pose_mm;
  loaded_ = false;
  hold(pose_mm);
}

void Proxy::hold(const Pose& pose_mm) {
  pose_ = pose_mm;
  blocker_count_ = 0;
  if (!loaded_) {
    stiffness_ = 0.0;
    held_by_ = -1;
  }
  changed();
  pullBack();
}

// The pull from the arm to the tool. Once the tool is at the arm, nothing holds it.
void Proxy::pullBack() {
  const SmallMotion left = towards(arm_, pose_);
  if (!(cost(left) > kHeld_mm * kHeld_mm)) {
    stiffness_ = 0.0;
    held_by_ = -1;
  }
  pull_ = {left.shift_mm, left.turn, turn_mm2_, stiffness_};
}

bool Proxy::standsInSolid(const TissueField& tissue, const Pose& arm_mm) {
  const SmallMotion by = towards(pose_, arm_mm);
  travelled_.add(by);
  next_travelled_.add(by);
  pose_ = arm_ = arm_mm;
  pullBack();
  const PlacedBody body = surface_.place(arm_mm);
  if (!surface_.mayMeet(tissue, body, body)) {
    changed();
    return false;
  }
  const double near_mm = kNear * surface_.voxel_mm();
  look(tissue, body, near_mm, way_mm(by), true);
  return touches(body, near_mm, 0.0, 0.0) < -kStands * surface_.voxel_mm() &&
         surface_.centreIn(body);
}

double Proxy::usedUp_mm(const Travel& travel) const {
  return std::max(travel.of_mm(surface_.near_reach_mm()),
                  travel.of_mm(surface_.reach_mm()) / SolidSurface::kFar);
}

double Proxy::way_mm(const SmallMotion& motion) const {
  Travel travel;
  travel.add(motion);
  return usedUp_mm(travel);
}

double Proxy::cost(const SmallMotion& motion) const {
  return glm::dot(motion.shift_mm, motion.shift_mm) +
         turn_mm2_ * glm::dot(motion.turn, motion.turn);
}

void Proxy::removed(const TissueField& tissue, std::span<const std::uint32_t> voxels,
                    const VoxelBounds& box) {
  if (!surface_.byRows()) {
    stale_ = next_stale_ = gone_ = true;
    return;
  }
  const SolidSurface::Stale stale = surface_.removed(tissue, voxels, box);
  stale_ = stale_ || stale.now;
  next_stale_ = next_stale_ || stale.next;
}

// Of the travel for which the gathered surface holds.
double Proxy::went_mm() const {
  return surface_.byRows() ? way_mm(towards(from_, pose_)) : usedUp_mm(travelled_);
}

// Share of the travel for which the gathered surface holds that is used up after one more step.
double Proxy::worn(double step_mm) const {
  const double worn = (went_mm() + step_mm) / surface_.margin_mm();
  if (!stale_) return worn;
  return std::max(worn, travelled_mm() / std::max(kWorn * surface_.voxel_mm(), kLeastWorn_mm));
}

// Sees to it that the gathered surface holds for one more step. Where it does (`ahead`), it goes on
// with the next search, a part a tick.
void Proxy::look(const TissueField& tissue, const PlacedBody& body, double step_mm, double speed,
                 bool ahead) {
  const auto dropGone = [&] {
    if (gone_) surface_.drop(tissue);
    gone_ = false;
  };
  const auto begin = [&] {
    surface_.begin(tissue, body, cutting_);
    next_travelled_ = {};
    next_from_ = pose_;
    next_stale_ = false;
  };
  const auto goOn = [&](int work) {
    if (!surface_.goOn(tissue, work)) return;
    gathered_ = true;
    travelled_ = next_travelled_;
    from_ = next_from_;
    stale_ = next_stale_ || (surface_.byRows() && surface_.cameStale());
    gone_ = !surface_.byRows() && next_stale_;
    dropGone();
  };
  if (!gathered_) {
    begin();
    goOn(SolidSurface::kAll);
    return;
  }
  dropGone();
  const double used = worn(step_mm);
  if (used <= 1.0) {
    const double ticks = double(surface_.work()) / kWorkATick;
    if (!ahead || (!surface_.underWay() && worn(ticks / kEarly * speed) <= 1.0)) return;
    if (!surface_.underWay()) begin();
    return goOn(kWorkATick);
  }
  if (surface_.underWay()) {
    goOn(SolidSurface::kAll);
    if (worn(step_mm) <= 1.0) return;
  }
  begin();
  goOn(SolidSurface::kAll);
}

// The pieces within a distance of the body, at the proxy's pose or one `moved_mm` from it; the
// nearest, if there are too many. A piece whose last gap is more than the tool has travelled since
// is not looked at.
std::size_t Proxy::nearPieces(const PlacedBody& body, double within_mm, double moved_mm) {
  std::size_t count = 0;
  const double travelled = travelled_mm();
  for (const std::size_t piece : surface_.awake(within_mm, travelled + moved_mm)) {
    if (surface_.leastGap_mm(piece, travelled + moved_mm) > within_mm) continue;
    double gap_mm = 0.0;
    const std::optional<Touch> touch = surface_.touchWithin(piece, body, within_mm, gap_mm);
    if (moved_mm == 0.0) surface_.note(piece, gap_mm, travelled);
    if (!touch) continue;
    std::size_t at = count;
    if (count < kMostTouches) {
      ++count;
    } else {
      at = 0;
      for (std::size_t i = 1; i < kMostTouches; ++i) {
        if (near_[i].touch.gap_mm > near_[at].touch.gap_mm) at = i;
      }
      if (near_[at].touch.gap_mm <= gap_mm) continue;
    }
    near_[at] = {*touch, piece, surface_.pieces()[piece].flat, false};
  }
  return count;
}

// Merges the flat pieces that touch the tool within kSame of where piece `first` does; returns the
// nearest of them.
std::size_t Proxy::merge(std::size_t first, std::size_t count) {
  const double same2 = std::pow(kSame * surface_.voxel_mm(), 2);
  const auto partOf = [&](const Near& near) { return surface_.pieces()[near.piece].part; };
  const auto together = [&](std::size_t a, std::size_t b) {
    const Near &one = near_[a], &other = near_[b];
    const Vec3 apart = one.touch.lever_mm - other.touch.lever_mm;
    return other.flat && !other.merged && partOf(one) == partOf(other) &&
           glm::dot(apart, apart) <= same2;
  };
  std::size_t nearest = first;
  for (std::size_t i = first + 1; i < count; ++i) {
    if (near_[i].touch.gap_mm < near_[nearest].touch.gap_mm && together(first, i)) nearest = i;
  }
  for (std::size_t i = first; i < count; ++i)
    near_[i].merged = near_[i].merged || together(nearest, i);
  near_[first].merged = true;
  return nearest;
}

// What the body touches within a distance, at the proxy's pose or one `moved_mm` from it; the least
// gap.
double Proxy::touches(const PlacedBody& body, double within_mm, double moved_mm, double clear_mm) {
  const std::size_t count = nearPieces(body, within_mm, moved_mm);
  const double voxel_mm = surface_.voxel_mm();
  double least_mm = 1e9;
  touch_count_ = 0;
  for (std::size_t n = 0; n < count; ++n) {
    if (near_[n].merged) continue;
    const bool flat = near_[n].flat;
    const Near& near = near_[flat ? merge(n, count) : n];
    const Touch touch = flat ? surface_.blended(near.touch, near.piece, body) : near.touch;
    least_mm = std::min(least_mm, touch.gap_mm);
    // At the proxy's own pose a touch that is not deeper than kInside keeps the gap that it has, up
    // to `clear_mm`; every other touch must open to `clear_mm`.
    double keep_mm = clear_mm;
    if (moved_mm == 0.0 && touch.gap_mm >= -kInside * voxel_mm) {
      keep_mm = std::min(touch.gap_mm, clear_mm);
    }
    // A depth of more than half a voxel counts as half a voxel: no correction is larger.
    const double gap_mm = std::max(touch.gap_mm, -0.5 * voxel_mm) - keep_mm;
    touches_[touch_count_] = {touch.normal, glm::cross(touch.lever_mm, touch.normal), gap_mm, 0.0};
    touched_[touch_count_++] = near.piece;
  }
  return least_mm;
}

void Proxy::move(const Pose& to, const PlacedBody& body, Way& way) {
  const SmallMotion by = towards(pose_, to);
  travelled_.add(by);
  next_travelled_.add(by);
  last_step_mm_ += way_mm(by);
  pose_ = to;
  way.body = body;
}

// Nothing is near: goes as far as the gathered surface holds. True when the arm is farther.
bool Proxy::goFreely(Way& way) {
  way.load = way.stiff = way.rough = way.most = 0.0;
  blocker_count_ = 0;
  const SmallMotion wanted = towards(pose_, arm_);
  const double length_mm = way_mm(wanted);
  const double most_mm = surface_.pieces().empty() ? surface_.margin_mm() - went_mm() : way.step_mm;
  const bool whole = length_mm <= most_mm;
  const double share = most_mm / length_mm;
  const Pose to = whole ? arm_
                        : Pose{pose_.position + share * wanted.shift_mm,
                               turned(share * wanted.turn, pose_.orientation)};
  move(to, surface_.place(to), way);
  way.step_mm = kStep * surface_.voxel_mm();
  return !whole;
}

// The pose after a motion, corrected where the surface bends until every gap is at least
// `least_mm`. False where that fails. First to just that gap, then to a clear one.
bool Proxy::putBack(const SmallMotion& motion, double least_mm, Pose& there, PlacedBody& body,
                    bool& bent) {
  there = {pose_.position + motion.shift_mm, turned(motion.turn, pose_.orientation)};
  body = surface_.place(there);
  const double voxel_mm = surface_.voxel_mm();
  const double clear_mm = kKeptOff * voxel_mm, just_mm = least_mm + 0.1 * kTolerated * voxel_mm;
  double far_mm = way_mm(motion);
  for (int n = 0; n <= kCorrections; ++n) {
    const double keep_mm = n == 0 ? just_mm : clear_mm;
    if (touches(body, 2.0 * clear_mm, far_mm, keep_mm) >= least_mm) return true;
    bent = true;
    if (n == kCorrections) break;
    const SmallMotion back = nearestMotion({}, turn_mm2_, {touches_.data(), touch_count_});
    if (!(way_mm(back) < voxel_mm)) break;  // they contradict each other
    there = {there.position + back.shift_mm, turned(back.turn, there.orientation)};
    body = surface_.place(there);
    far_mm += way_mm(back);
  }
  return false;
}

// What friction leaves of a motion along what bears load: without it the tool would stop where the
// motion ends, with it as far before as the friction's pull stretches.
SmallMotion Proxy::dragged(const SmallMotion& motion, const SmallMotion& wanted,
                           const Way& way) const {
  if (!(way.friction_N > 0.0 || way.by_push) || !(way.stiff > 0.0)) return motion;
  double behind_mm = 1000.0 * way.friction_N * way.load / way.stiff;
  if (way.by_push) {
    // What the touches take of the wanted motion is the push on them, over the pull's stiffness.
    const double pressed_mm =
        std::sqrt(cost({wanted.shift_mm - motion.shift_mm, wanted.turn - motion.turn}));
    behind_mm += way.rough / way.load * pressed_mm;
  }
  const double left_mm = std::sqrt(cost(motion));
  if (left_mm <= behind_mm) return {};
  const double share = 1.0 - behind_mm / left_mm;
  return {share * motion.shift_mm, share * motion.turn};
}

// A step along what it touches. True when the arm is farther and another step may come nearer. Only
// a pose that is nearer to the arm is taken, so that a tool at rest neither creeps nor alternates.
bool Proxy::slide(const TissueField& tissue, Way& way) {
  const SmallMotion wanted = towards(pose_, arm_);
  SmallMotion motion = nearestMotion(wanted, turn_mm2_, {touches_.data(), touch_count_});
  way.load = way.stiff = way.rough = way.most = 0.0;
  blocker_count_ = 0;
  for (std::size_t i = 0; i < touch_count_; ++i) {
    const double load = touches_[i].load;
    const SurfacePiece& piece = surface_.pieces()[touched_[i]];
    if (!(load > 0.0)) continue;
    way.load += load;
    if (load > way.most) {
      way.most = load;
      way.tissue_class = piece.tissue_class;
    }
    way.stiff += load * tissue.ofClass(piece.tissue_class).stiffness_N_per_m;
    way.rough += load * tissue.ofClass(piece.tissue_class).friction_coefficient;
    if (piece.cuttable) blockers_[blocker_count_++] = {piece.voxel, piece.tissue_class};
  }
  if (!way.inside) motion = dragged(motion, wanted, way);
  const double arrived_mm = kArrived * surface_.voxel_mm();
  const double length_mm = way_mm(motion);
  if (length_mm < arrived_mm && !way.inside) return false;
  const bool whole = length_mm <= way.step_mm;
  double share = whole ? 1.0 : way.step_mm / length_mm;
  for (int n = 0; n < kShorter; ++n, share *= kShorterBy) {
    motion = {share * motion.shift_mm, share * motion.turn};
    share = 1.0;
    Pose there;
    PlacedBody body;
    bool bent = n > 0;
    const bool out = putBack(motion, way.least_mm, there, body, bent);
    if (!out || !(way.inside || cost(towards(there, arm_)) < cost(wanted) - kNearer_mm2)) continue;
    const double moved_mm = way_mm(towards(pose_, there));
    move(there, body, way);
    if (!whole) way.step_mm = kStep * surface_.voxel_mm();
    return (!whole || bent) && moved_mm >= arrived_mm;
  }
  return false;
}

void Proxy::follow(const TissueField& tissue, const Pose& arm_mm, Cutting cutting,
                   double friction_N, bool by_push) {
  arm_ = arm_mm;
  blocker_count_ = 0;
  Way way{surface_.place(pose_)};
  way.friction_N = friction_N;
  way.by_push = by_push;
  if (!surface_.mayMeet(tissue, way.body, surface_.place(arm_mm))) {
    place(arm_mm);
    return;
  }
  if (cutting != cutting_) changed();
  cutting_ = cutting;
  // The first step is at most twice as long as the way of the last tick.
  const double voxel_mm = surface_.voxel_mm(), near_mm = kNear * voxel_mm;
  way.step_mm = std::clamp(2.0 * last_step_mm_ + near_mm, near_mm, kStep * voxel_mm);
  const double speed = last_step_mm_;
  last_step_mm_ = 0.0;
  for (int step = 0; step < kMostSteps; ++step) {
    look(tissue, way.body, way.step_mm, speed, step == 0);
    const double clear_mm = kKeptOff * voxel_mm;
    const double gap_mm = touches(way.body, way.step_mm + 2.0 * clear_mm, 0.0, clear_mm);
    way.inside = gap_mm < -kInside * voxel_mm;
    way.least_mm = -kTolerated * voxel_mm;
    if (!way.inside) way.least_mm = std::min(way.least_mm, gap_mm);
    if (way_mm(towards(pose_, arm_mm)) < kHeld_mm && !way.inside) break;
    if (touch_count_ > 0 ? !slide(tissue, way) : !goFreely(way)) break;
  }
  // Where nothing bears load now, the pull keeps its stiffness until the tool is at the arm.
  loaded_ = way.load > 0.0;
  if (loaded_) {
    stiffness_ = way.stiff / way.load;
    held_by_ = way.tissue_class;
  }
  pullBack();
}

Pose Proxy::ahead_mm(double by_mm) const {
  const SmallMotion wanted = towards(pose_, arm_);
  const double way = way_mm(wanted);
  if (!(way > 0.0)) return pose_;
  const double share = std::min(1.0, by_mm / way);
  return {pose_.position + share * wanted.shift_mm, turned(share * wanted.turn, pose_.orientation)};
}

}  // namespace trephine
