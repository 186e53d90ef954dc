// The part of a tick that takes voxels.
#include <algorithm>
#include <bit>
#include <bitset>
#include <limits>
#include <utility>

#include "haptics/haptic_core.h"

namespace trephine {

namespace {
// What a tool would enter is looked for so far ahead of it: half a voxel, and this at least.
constexpr double kLeastAhead_mm = 0.25;
}  // namespace

// All tools bite into the tissue as it was, then it goes. Arms that take the same voxel in a tick
// share its cost, so that the order of the arms changes no credit. Its entry goes to the newest of
// their strokes: undo takes that first, so that what any of them took is back once it is undone.
void HapticCore::removeBites(std::uint64_t tick, TickRecord& record) {
  const CarveJournal::Credits before = credits();
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    Arm& arm = arms_[i];
    arm.bites.clear();
    if (!arm.cuts || !may_remove_ || !any_cuttable_) continue;
    bite(arm, record.arms[i]);
    arm.bites_low.fill(std::numeric_limits<std::int32_t>::max());
    arm.bites_high.fill(-1);
    for (const Bite& bite : arm.bites) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        arm.bites_low[axis] = std::min(arm.bites_low[axis], bite.voxel[axis]);
        arm.bites_high[axis] = std::max(arm.bites_high[axis], bite.voxel[axis]);
      }
    }
  }
  sortBites();
  const std::array<std::size_t, kMaxArms> order = newestStrokeFirst(before, tick);
  const GridGeometry& geometry = writer_.grid().geometry();
  for (std::size_t n = 0; n < arms_.size(); ++n) {
    const std::size_t owner = order[n];
    for (const Bite& bite : arms_[owner].bites) {
      const std::size_t voxel = geometry.indexOf(bite.voxel[0], bite.voxel[1], bite.voxel[2]);
      if (writer_.grid().hu(voxel) == kAirHu) continue;  // shared, and gone with its owner's
      std::uint32_t sharers = 0;
      for (std::size_t later = n + 1; later < arms_.size(); ++later) {
        if (takes(arms_[order[later]], bite.voxel)) sharers |= 1u << order[later];
      }
      const bool paid = parameters_.removal == RemovalKind::work;
      if (!erase(owner, bite, voxel, paid ? sharers : 0, tick)) {
        arms_[owner].removal.refund(bite.cost_J);  // those after it may still take it
        continue;
      }
      ++record.arms[owner].removed_voxels;
      if (sharers == 0) continue;
      const double share_J = bite.cost_J / (1 + std::popcount(sharers));
      for (std::size_t i = 0; i < arms_.size(); ++i) {
        if (i == owner || (sharers >> i & 1u)) arms_[i].removal.refund(bite.cost_J - share_J);
      }
    }
  }
  const bool solid_went = std::any_of(carves_.begin(), carves_.end(), [&](const CarveRecord& carve) {
    return lookup_.isSolid(carve.tissue_class);
  });
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    Arm& arm = arms_[i];
    if (solid_went && arm.proxy) arm.proxy->removed();
    if (!arm.cuts) continue;
    const int arm_number = int(i);
    arm.air_ticks = arm.contact.contact().touching() ? 0 : arm.air_ticks + 1;
    if (journal_.inStroke(arm_number) && arm.air_ticks > stroke_gap_ticks_) {
      journal_.endStroke(arm_number);
    }
  }
}

// What the tool would enter, where tissue holds it back, else what it is in. Where nothing of that is
// left and it is held all the same, what holds it goes.
void HapticCore::bite(Arm& arm, const ArmRecord& moved) {
  const GridGeometry& geometry = writer_.grid().geometry();
  Pose front_mm{moved.proxy_position_mm, moved.proxy_orientation};
  const bool held = arm.proxy && arm.proxy->held();
  if (held) {
    const Vec3& s = geometry.spacing_mm;
    front_mm = arm.proxy->ahead_mm(std::max({0.5 * s.x, 0.5 * s.y, 0.5 * s.z, kLeastAhead_mm}));
  }
  arm.removal.sweep(writer_.grid(), *bricks_, lookup_, parameters_.tissues, front_mm, arm.bites);
  if (!held || !arm.bites.empty()) return;
  for (const Proxy::Blocker& blocker : arm.proxy->blockers()) {
    arm.removal.take(geometry.indicesOf(blocker.voxel), blocker.tissue_class, parameters_.tissues,
                     arm.bites);
  }
}

bool HapticCore::takes(const Arm& arm, const Index3& voxel) const {
  if (arm.bites.empty()) return false;
  for (std::size_t axis = 0; axis < 3; ++axis) {  // tools are mostly apart
    if (voxel[axis] < arm.bites_low[axis] || voxel[axis] > arm.bites_high[axis]) return false;
  }
  const auto index = std::uint32_t(writer_.grid().geometry().indexOf(voxel[0], voxel[1], voxel[2]));
  return std::binary_search(arm.taken.begin(), arm.taken.end(), index);
}

// Where bites of two arms may be the same, those of each in order, to be found again. Most tools
// that are near each other still take other voxels: a filter of a bit a voxel, by the lower bits of
// its number, tells that at little cost.
void HapticCore::sortBites() {
  constexpr std::uint32_t kFilterBits = 1u << 16;
  const GridGeometry& geometry = writer_.grid().geometry();
  const auto number = [&geometry](const Bite& bite) {
    return std::uint32_t(geometry.indexOf(bite.voxel[0], bite.voxel[1], bite.voxel[2]));
  };
  std::array<bool, kMaxArms> meets{};
  for (std::size_t a = 0; a < arms_.size(); ++a) {
    std::bitset<kFilterBits> filter;
    bool filled = false;
    for (std::size_t b = a + 1; b < arms_.size(); ++b) {
      const Arm &one = arms_[a], &other = arms_[b];
      bool apart = one.bites.empty() || other.bites.empty();
      for (std::size_t axis = 0; axis < 3 && !apart; ++axis) {
        apart = other.bites_low[axis] > one.bites_high[axis] ||
                other.bites_high[axis] < one.bites_low[axis];
      }
      if (apart) continue;
      if (!filled) {
        for (const Bite& bite : one.bites) filter.set(number(bite) % kFilterBits);
        filled = true;
      }
      const auto hit = [&](const Bite& bite) { return filter.test(number(bite) % kFilterBits); };
      if (std::any_of(other.bites.begin(), other.bites.end(), hit)) meets[a] = meets[b] = true;
    }
  }
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    Arm& arm = arms_[i];
    arm.taken.clear();
    if (!meets[i]) continue;
    for (const Bite& bite : arm.bites) arm.taken.push_back(number(bite));
    std::sort(arm.taken.begin(), arm.taken.end());
  }
}

// Begins the strokes of the arms that bite and have none; then the arms, the newest stroke first.
std::array<std::size_t, kMaxArms> HapticCore::newestStrokeFirst(const CarveJournal::Credits& before,
                                                                std::uint64_t tick) {
  std::array<std::size_t, kMaxArms> order{};
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    order[i] = i;
    // One that only shares with an arm after it would be left with an empty stroke, which an undo
    // would seem not to undo.
    const auto alone = [&](const Bite& bite) {
      for (std::size_t other = i + 1; other < arms_.size(); ++other) {
        if (takes(arms_[other], bite.voxel)) return false;
      }
      return true;
    };
    const std::vector<Bite>& bites = arms_[i].bites;
    if (journal_.inStroke(int(i)) || std::none_of(bites.begin(), bites.end(), alone)) continue;
    if (!journal_.beginStroke(int(i), before)) continue;
    events_.push_back({tick, EventKind::stroke_began, std::int32_t(i), 0, {}});
  }
  const auto before_it = [this](std::size_t a, std::size_t b) {
    const bool x = journal_.inStroke(int(a)), y = journal_.inStroke(int(b));
    return x && (!y || journal_.openStroke(int(a)) > journal_.openStroke(int(b)));
  };
  for (std::size_t i = 1; i < arms_.size(); ++i) {
    for (std::size_t n = i; n > 0 && before_it(order[n], order[n - 1]); --n) {
      std::swap(order[n], order[n - 1]);
    }
  }
  return order;
}

bool HapticCore::erase(std::size_t index, const Bite& bite, std::size_t voxel,
                       std::uint32_t sharers, std::uint64_t tick) {
  const int arm = int(index);
  const std::int16_t old_hu = writer_.grid().hu(voxel);
  if (!journal_.erase(writer_, arm, voxel, bite.tissue_class, sharers)) return false;
  bricks_->remove(bite.voxel, lookup_.isSolid(bite.tissue_class));
  carves_.push_back(
      {tick, std::uint32_t(voxel), old_hu, std::int8_t(index), std::int8_t(bite.tissue_class)});
  return true;
}

}  // namespace trephine
