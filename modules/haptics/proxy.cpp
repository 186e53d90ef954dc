#include "haptics/proxy.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

// All of a voxel's smallest edge.
constexpr double kStep = 0.45;        // at most, between two looks at the gaps
constexpr double kNear = 0.05;        // contacts this near are always seen
// Where voxels went, what stands behind them is looked for after so much; in between the tool may
// enter it by that, and what it enters it cuts or is put back from.
constexpr double kWorn = 0.25, kLeastWorn_mm = 0.05;
constexpr double kKeptOff = 0.02;     // the solver keeps this between tool and tissue
constexpr double kArrived = 1e-3;     // a shorter step is none
constexpr double kSolved_mm = 5e-4;   // the solver's rest
constexpr int kRounds = 60;           // of the solver
constexpr int kCorrections = 4;       // where the surface bends
constexpr int kShorter = 3;           // tries, each with a shorter step
constexpr double kShorterBy = 0.4;
constexpr double kNearer_mm2 = 1e-9;  // or it is not nearer
constexpr double kHeld_mm = 1e-6;
// A turn costs as a shift of the mean square by which it moves a rod, tip to handle, a third of its
// length squared; half of that, for the far end moves most. A short tool has a handle all the same.
constexpr double kHandle_mm = 60.0;

// A small turn applied to an orientation.
Quat turned(const Vec3& by, const Quat& q) {
  return glm::normalize(Quat(1.0, 0.5 * by.x, 0.5 * by.y, 0.5 * by.z) * q);
}

}  // namespace

Proxy::Proxy(const Tool& tool, const GridGeometry& geometry)
    : surface_(tool, geometry),
      turn_mm2_(std::pow(std::max(surface_.reach_mm(), kHandle_mm), 2) / 6.0) {}

void Proxy::place(const Pose& pose_mm) {
  hold(pose_mm);
  arm_ = pose_mm;
  stiffness_ = 0.0;
}

void Proxy::hold(const Pose& pose_mm) {
  pose_ = pose_mm;
  pull_ = Pull{};
  blocker_count_ = 0;
  gathered_ = false;
}

Proxy::Motion Proxy::towards(const Pose& from, const Pose& to) const {
  const Quat by = to.orientation * glm::conjugate(from.orientation);
  const double sign = by.w < 0.0 ? -2.0 : 2.0;
  return {to.position - from.position, sign * Vec3(by.x, by.y, by.z)};
}

double Proxy::way_mm(const Motion& motion) const {
  return glm::length(motion.shift_mm) + surface_.reach_mm() * glm::length(motion.turn);
}

double Proxy::cost(const Motion& motion) const {
  return glm::dot(motion.shift_mm, motion.shift_mm) +
         turn_mm2_ * glm::dot(motion.turn, motion.turn);
}

// The contacts within a distance, at the proxy's pose or one `moved_mm` from it; the least gap of
// those. A piece from which the tool cannot have come so near is not looked at.
double Proxy::contacts(const PlacedBody& body, double within_mm, double moved_mm) {
  contact_count_ = 0;
  double least_mm = 1e9;
  const bool here = moved_mm == 0.0;
  const double kept_off_mm = kKeptOff * surface_.voxel_mm();
  for (SurfacePiece& piece : surface_.pieces()) {
    const double at_least_mm = piece.gap_mm - (travelled_mm_ + moved_mm - piece.travelled_mm);
    if (at_least_mm > within_mm) {
      if (here) piece.load = 0.0;
      continue;
    }
    const Touch touch = touchOf(piece, body);
    if (here) {
      piece.gap_mm = touch.gap_mm;
      piece.travelled_mm = travelled_mm_;
    }
    least_mm = std::min(least_mm, touch.gap_mm);
    if (touch.gap_mm > within_mm) {
      if (here) piece.load = 0.0;
      continue;
    }
    std::size_t at = contact_count_;
    if (at == kMostContacts) {  // the nearest matter
      at = 0;
      for (std::size_t i = 1; i < kMostContacts; ++i) {
        if (contacts_[i].gap_mm > contacts_[at].gap_mm) at = i;
      }
      if (contacts_[at].gap_mm <= touch.gap_mm) continue;
    } else {
      ++contact_count_;
    }
    Contact& contact = contacts_[at];
    contact.normal = touch.normal;
    contact.moment = glm::cross(touch.lever_mm, touch.normal);
    contact.softness = 1.0 + glm::dot(contact.moment, contact.moment) / turn_mm2_;
    // No correction throws it farther than half a voxel.
    contact.gap_mm = std::max(touch.gap_mm, -0.5 * surface_.voxel_mm()) - kept_off_mm;
    contact.load = here ? piece.load : 0.0;
    contact.piece = &piece;
  }
  return least_mm;
}

// The motion nearest to the given one that keeps every gap open: projected Gauss-Seidel, from the
// loads of the last time.
void Proxy::solve(Motion& motion) {
  for (std::size_t i = 0; i < contact_count_; ++i) {
    const Contact& c = contacts_[i];
    motion.shift_mm += c.load * c.normal;
    motion.turn += (c.load / turn_mm2_) * c.moment;
  }
  for (int round = 0; round < kRounds; ++round) {
    double worst_mm = 0.0;
    for (std::size_t i = 0; i < contact_count_; ++i) {
      Contact& c = contacts_[i];
      const double open =
          c.gap_mm + glm::dot(c.normal, motion.shift_mm) + glm::dot(c.moment, motion.turn);
      const double load = std::max(0.0, c.load - open / c.softness);
      const double more = load - c.load;
      if (more == 0.0) continue;
      c.load = load;
      motion.shift_mm += more * c.normal;
      motion.turn += (more / turn_mm2_) * c.moment;
      worst_mm = std::max(worst_mm, std::abs(more) * c.softness);
    }
    if (worst_mm < kSolved_mm) break;
  }
}

void Proxy::follow(const Tissue& tissue, const Pose& arm_mm, Cutting cutting) {
  arm_ = arm_mm;
  blocker_count_ = 0;
  pull_ = Pull{};
  PlacedBody body = surface_.place(pose_);
  if (!surface_.mayMeet(tissue.bricks, body, surface_.place(arm_mm))) {
    place(arm_mm);
    return;
  }
  if (cutting != cutting_) gathered_ = false;
  cutting_ = cutting;
  const double voxel_mm = surface_.voxel_mm(), longest_mm = kStep * voxel_mm;
  const double near_mm = kNear * voxel_mm;
  // As far as it went last time it will go again, or twice as far.
  double step_mm = std::clamp(2.0 * last_step_mm_ + near_mm, near_mm, longest_mm);
  last_step_mm_ = 0.0;
  double load = 0.0, stiff = 0.0;
  for (int step = 0; step < kMostSteps; ++step) {
    Motion motion = towards(pose_, arm_mm);
    const double before = cost(motion), way = way_mm(motion);
    if (stale_ && gathered_) surface_.drop(tissue.grid, tissue.lookup);
    const bool worn = stale_ && travelled_mm_ > std::max(kWorn * voxel_mm, kLeastWorn_mm);
    if (!gathered_ || worn || travelled_mm_ + step_mm > surface_.margin_mm()) {
      surface_.gather(tissue.grid, tissue.bricks, tissue.lookup, tissue.classes, body, cutting);
      gathered_ = true;
      stale_ = false;
      travelled_mm_ = 0.0;
    }
    const bool inside = contacts(body, step_mm + 2.0 * kKeptOff * voxel_mm, 0.0) < 0.0;
    if (way < kHeld_mm && !inside) break;
    load = stiff = 0.0;
    blocker_count_ = 0;
    if (contact_count_ == 0) {  // free as far as it goes in this step
      const double most_mm = surface_.pieces().empty() ? surface_.margin_mm() - travelled_mm_ : step_mm;
      const double share = way > most_mm ? most_mm / way : 1.0;
      pose_ = share < 1.0 ? Pose{pose_.position + share * motion.shift_mm,
                                 turned(share * motion.turn, pose_.orientation)}
                          : arm_mm;
      body = surface_.place(pose_);
      travelled_mm_ += share * way;
      last_step_mm_ += share * way;
      if (share == 1.0) break;
      step_mm = longest_mm;
      continue;
    }
    solve(motion);
    for (std::size_t i = 0; i < contact_count_; ++i) {
      const Contact& c = contacts_[i];
      c.piece->load = c.load;
      if (!(c.load > 0.0)) continue;
      load += c.load;
      stiff += c.load * tissue.classes.classes[std::size_t(c.piece->tissue_class)].stiffness_N_per_m;
      if (c.piece->cuttable) blockers_[blocker_count_++] = {c.piece->voxel, c.piece->tissue_class};
    }
    double length = way_mm(motion);
    if (length < kArrived * voxel_mm && !inside) break;
    const bool whole = length <= step_mm;
    if (!whole) {
      motion.shift_mm *= step_mm / length;
      motion.turn *= step_mm / length;
    }
    // Where the surface bends the pose is put back onto it, and only one nearer to the arm is taken:
    // so it neither creeps nor buzzes.
    bool moved = false, bent = false;
    for (int shorter = 0; shorter < kShorter && !moved; ++shorter) {
      Pose there{pose_.position + motion.shift_mm, turned(motion.turn, pose_.orientation)};
      PlacedBody body_there = surface_.place(there);
      double far = way_mm(motion);
      for (int n = 0; n <= kCorrections; ++n) {
        if (contacts(body_there, 2.0 * kKeptOff * voxel_mm, far) >= 0.0) {
          moved = true;
          break;
        }
        bent = true;
        if (n == kCorrections) break;
        Motion back;
        solve(back);
        there = {there.position + back.shift_mm, turned(back.turn, there.orientation)};
        body_there = surface_.place(there);
        far += way_mm(back);
      }
      if (moved && !inside && !(cost(towards(there, arm_mm)) < before - kNearer_mm2)) moved = false;
      if (moved) {
        length = way_mm(towards(pose_, there));
        pose_ = there;
        body = body_there;
        travelled_mm_ += length;
        last_step_mm_ += length;
      } else {
        motion.shift_mm *= kShorterBy;
        motion.turn *= kShorterBy;
      }
    }
    if (!moved || (whole && !bent) || length < kArrived * voxel_mm) break;
    if (!whole) step_mm = longest_mm;
  }
  const Motion left = towards(arm_mm, pose_);
  if (!(cost(left) > kHeld_mm * kHeld_mm)) stiffness_ = 0.0;
  // On its way back to an arm that went fast it pulls as it did.
  if (load > 0.0) stiffness_ = stiff / load;
  pull_ = {left.shift_mm, left.turn, turn_mm2_, stiffness_};
}

Pose Proxy::ahead_mm(double by_mm) const {
  const Motion wanted = towards(pose_, arm_);
  const double way = way_mm(wanted);
  if (!(way > 0.0)) return pose_;
  const double share = std::min(1.0, by_mm / way);
  return {pose_.position + share * wanted.shift_mm, turned(share * wanted.turn, pose_.orientation)};
}

}  // namespace trephine
