// The part of a tick that removes voxels.
#include <algorithm>
#include <bit>
#include <bitset>
#include <utility>

#include "haptics/haptic_core.h"

namespace trephine {

namespace {
// What a tool would enter is looked for so far ahead of it: half a voxel, and this at least.
constexpr double kLeastAhead_mm = 0.25;

// Linear, of a voxel of the grid.
std::uint32_t indexOf(const GridGeometry& geometry, const Index3& voxel) {
  return std::uint32_t(geometry.indexOf(voxel[0], voxel[1], voxel[2]));
}
}  // namespace

// All tools sweep the tissue as it was, then it goes. Arms that remove the same voxel in a tick
// share its cost, so that the order of the arms changes no credit. Its entry goes to the newest of
// their strokes: undo takes that first, so that what any of them removed is back once it is undone.
void HapticCore::removeVoxels(std::uint64_t tick, TickRecord& record) {
  const CarveJournal::Credits before = credits();
  sweepTools(record);
  indexShared();
  const std::array<std::size_t, kMaxArms> order = newestStrokeFirst(before, tick);
  for (std::size_t place = 0; place < arms_.size(); ++place) eraseOf(place, order, tick, record);
  tellProxies();
  endStrokes();
}

void HapticCore::sweepTools(const TickRecord& record) {
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    Arm& arm = arms_[i];
    arm.removed.clear();
    arm.removed_box = {};
    if (!arm.cuts || !may_remove_ || !any_cuttable_) continue;
    sweepTool(arm, record.arms[i]);
    for (const RemovedVoxel& removed : arm.removed) arm.removed_box.add(removed.voxel);
  }
}

// What the tool would enter, where tissue holds it back, else what it is in. Where nothing of that
// is left and it is held all the same, what holds it goes.
void HapticCore::sweepTool(Arm& arm, const ArmRecord& moved) {
  const GridGeometry& geometry = writer_.grid().geometry();
  Pose front_mm{moved.proxy_position_mm, moved.proxy_orientation};
  ArmTool& tool = arm.tool();
  if (parameters_.touch_by_points != 0) {
    const ToolContact& of = tool.contact;
    return tool.removal.takeTouched(tissue_, of.voxels(), of.classes(), arm.removed);
  }
  const bool held = tool.proxy && tool.proxy->held();
  if (held) {
    const Vec3& s = geometry.spacing_mm;
    front_mm = tool.proxy->ahead_mm(std::max({0.5 * s.x, 0.5 * s.y, 0.5 * s.z, kLeastAhead_mm}));
  }
  if (tool.soft) tool.removal.spareAhead(tool.soft->wholeBefore(tissue_.tissues()));
  if (tool.soft && tool.soft->gaveWay())
    tool.removal.goOnFrom(Pose{tool.soft->gaveWay_mm(), front_mm.orientation});
  tool.removal.sweep(tissue_, front_mm, arm.removed);
  if (!held || !arm.removed.empty()) return;
  for (const Proxy::Blocker& blocker : tool.proxy->blockers()) {
    tool.removal.take(tissue_, geometry.indicesOf(blocker.voxel), blocker.tissue_class,
                      arm.removed);
  }
}

// The voxels of the arm at this place of the order; one that arms after it remove too goes now.
void HapticCore::eraseOf(std::size_t place, const std::array<std::size_t, kMaxArms>& order,
                         std::uint64_t tick, TickRecord& record) {
  const std::size_t owner = order[place];
  const bool paid = parameters_.removal == RemovalKind::work;
  for (const RemovedVoxel& removed : arms_[owner].removed) {
    const std::size_t voxel = indexOf(writer_.grid().geometry(), removed.voxel);
    if (writer_.grid().hu(voxel) == kAirHu) continue;  // shared, and gone with its owner's
    std::uint32_t sharers = 0;
    for (std::size_t later = place + 1; later < arms_.size(); ++later) {
      if (alsoRemoves(arms_[order[later]], removed.voxel)) sharers |= 1u << order[later];
    }
    if (!erase(owner, removed, voxel, paid ? sharers : 0, tick)) {
      arms_[owner].tool().removal.returnWork(removed.cost_J);  // those after it may still remove it
      continue;
    }
    ++record.arms[owner].removed_voxels;
    if (sharers != 0) returnShares(removed, owner, sharers);
  }
}

// Each of n arms paid all of a voxel's cost: gets back what is more than its n-th part.
void HapticCore::returnShares(const RemovedVoxel& removed, std::size_t owner,
                              std::uint32_t sharers) {
  const double share_J = removed.cost_J / (1 + std::popcount(sharers));
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    if (i == owner || (sharers >> i & 1u)) {
      arms_[i].tool().removal.returnWork(removed.cost_J - share_J);
    }
  }
}

// What went is told to all proxies once all of it went.
void HapticCore::tellProxies() {
  went_.clear();
  VoxelBounds box;
  for (const CarveRecord& carve : carves_) {
    if (!tissue_.isSolid(carve.tissue_class)) continue;
    went_.push_back(carve.voxel);
  }
  if (went_.empty()) return;
  for (const Arm& arm : arms_) box.join(arm.removed_box);
  for (Arm& arm : arms_) {
    for (ArmTool& tool : arm.tools) {
      if (tool.proxy) tool.proxy->removed(tissue_, went_, box);
    }
  }
}

void HapticCore::endStrokes() {
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    Arm& arm = arms_[i];
    if (!arm.cuts) continue;
    const int arm_number = int(i);
    arm.air_ticks = arm.tool().contact.contact().touching() ? 0 : arm.air_ticks + 1;
    if (journal_.inStroke(arm_number) && arm.air_ticks > stroke_gap_ticks_) {
      journal_.endStroke(arm_number);
    }
  }
}

// Of an arm that may share voxels with another; of others false.
bool HapticCore::alsoRemoves(const Arm& arm, const Index3& voxel) const {
  if (!arm.removed_box.meets({voxel, voxel})) return false;  // tools are mostly apart
  return std::binary_search(arm.removed_indices.begin(), arm.removed_indices.end(),
                            indexOf(writer_.grid().geometry(), voxel));
}

// Sorts the voxels of the arms that may share some. Most tools that are near each other still
// remove other voxels: a filter of 65536 bits, by the lower bits of a voxel's index, tells that at
// little cost.
void HapticCore::indexShared() {
  constexpr std::uint32_t kFilterBits = 1u << 16;
  const GridGeometry& geometry = writer_.grid().geometry();
  const auto bitOf = [&geometry](const RemovedVoxel& removed) {
    return indexOf(geometry, removed.voxel) % kFilterBits;
  };
  std::array<bool, kMaxArms> may_share{};
  for (std::size_t a = 0; a < arms_.size(); ++a) {
    std::bitset<kFilterBits> filter;
    bool filled = false;
    for (std::size_t b = a + 1; b < arms_.size(); ++b) {
      const Arm &one = arms_[a], &other = arms_[b];
      if (!one.removed_box.meets(other.removed_box)) continue;
      if (!filled) {
        for (const RemovedVoxel& removed : one.removed) filter.set(bitOf(removed));
        filled = true;
      }
      const auto hit = [&](const RemovedVoxel& removed) { return filter.test(bitOf(removed)); };
      if (std::any_of(other.removed.begin(), other.removed.end(), hit)) {
        may_share[a] = may_share[b] = true;
      }
    }
  }
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    std::vector<std::uint32_t>& indices = arms_[i].removed_indices;
    indices.clear();
    if (!may_share[i]) continue;
    for (const RemovedVoxel& removed : arms_[i].removed) {
      indices.push_back(indexOf(geometry, removed.voxel));
    }
    std::sort(indices.begin(), indices.end());
  }
}

// Begins the strokes of the arms that remove something and have none; then the arms, the newest
// stroke first.
std::array<std::size_t, kMaxArms> HapticCore::newestStrokeFirst(const CarveJournal::Credits& before,
                                                                std::uint64_t tick) {
  std::array<std::size_t, kMaxArms> order{};
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    order[i] = i;
    // An arm all of whose voxels go to arms after it would be left with an empty stroke: an undo of
    // that would change nothing.
    const auto alone = [&](const RemovedVoxel& removed) {
      for (std::size_t other = i + 1; other < arms_.size(); ++other) {
        if (alsoRemoves(arms_[other], removed.voxel)) return false;
      }
      return true;
    };
    const std::vector<RemovedVoxel>& removed = arms_[i].removed;
    if (journal_.inStroke(int(i)) || std::none_of(removed.begin(), removed.end(), alone)) continue;
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

bool HapticCore::erase(std::size_t index, const RemovedVoxel& removed, std::size_t voxel,
                       std::uint32_t sharers, std::uint64_t tick) {
  const std::int16_t old_hu = writer_.grid().hu(voxel);
  if (!journal_.erase(writer_, int(index), voxel, removed.tissue_class, sharers)) return false;
  tissue_.removed(removed.voxel, removed.tissue_class);
  carves_.push_back(
      {tick, std::uint32_t(voxel), old_hu, std::int8_t(index), std::int8_t(removed.tissue_class)});
  return true;
}

}  // namespace trephine
