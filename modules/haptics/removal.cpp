#include "haptics/removal.h"

#include <algorithm>
#include <array>

namespace trephine {

namespace {

// So many voxels are looked at in a tick of a millisecond or less, in proportion more in a longer
// one, up to kMostLooks times as many. Finding a row counts as kLooksPerRow voxels.
constexpr int kLooksPerTick = 4096;
constexpr double kMostLooks = 4.0;
constexpr int kLooksPerRow = 26;
constexpr int kBatch = 16;            // rows
constexpr double kKept_s = 0.05;      // time constant with which unspent work is forgotten

}  // namespace

// The first and last whole index within an interval, cut to 0 .. count - 1. No floor() or ceil():
// without SSE 4 these are calls.
inline Removal::Indices Removal::indices(const Interval& mm, double per_spacing, int count) {
  if (mm.empty()) return {};
  const double low = mm.low * per_spacing, high = mm.high * per_spacing;
  if (!(low < count && high >= 0.0)) return {};
  const int below = low > 0.0 ? int(low) : 0;
  const int last = high < count ? int(high) : count - 1;
  return {low > below ? below + 1 : below, last};
}

Removal::Removal(const Tool& tool, const GridGeometry& geometry, RemovalKind kind, double period_s)
    : tool_(tool),
      geometry_(geometry),
      patient_to_voxel_(geometry.patientToVoxel()),
      normal_to_voxel_(glm::transpose(glm::inverse(Mat3(patient_to_voxel_)))),
      kind_(kind),
      fading_(1.0 / (1.0 + period_s / kKept_s)) {
  radius_mm_ = 1000.0 * tool.radius_m;
  spacing_mm_ = glm::min(geometry.spacing_mm, Vec3(radius_mm_ / kHalfVoxel));
  per_spacing_ = 1.0 / spacing_mm_;
  const Vec3& s = spacing_mm_;
  layer_mm_ = std::max({s.x, s.y, s.z, 0.1 * radius_mm_});
  still_mm_ = 0.125 * std::min({s.x, s.y, s.z});
  looks_ = int(kLooksPerTick * std::clamp(1000.0 * period_s, 1.0, kMostLooks));
  farthest_mm_ = 1000.0 * kFastest_m_s * period_s;
  // A slot of the area A is 2 r A of the voxels as the sweep sees them.
  voxel_m2_ = 1e-6 * s.x * s.y * s.z / (2.0 * radius_mm_);
}

// By the area of new surface, or by volume.
double Removal::voxelWork_J(const TissueClass& tissue) const {
  if (tissue.toughness_J_per_m2 > 0.0) return tissue.toughness_J_per_m2 * voxel_m2_;
  return tissue.cutting_J_per_mm3 * geometry_.voxelVolume_mm3();
}

// What a tool pays for a voxel.
double Removal::cost_J(const TissueClass& tissue) const {
  return kind_ == RemovalKind::instant ? 0.0 : voxelWork_J(tissue);
}

bool Removal::isSpared(int tissue_class, int i, int j, int k) const {
  return (spared_ >> tissue_class & 1u) && glm::dot(Vec3(i, j, k) - tip_, ahead_) > 0.0;
}

void Removal::goOnFrom(const Pose& from_mm) {
  clear_ = capsuleAt(from_mm);
  clear_.radius = 0.0;
  known_ = went_on_ = true;
  passing_ = false;
  last_.reset();
}

Capsule Removal::capsuleAt(const Pose& pose_mm) const {
  const auto place = [&](const Vec3& tool_m) {
    const Vec3 patient_mm = pose_mm.position + 1000.0 * (pose_mm.orientation * tool_m);
    return Vec3(patient_to_voxel_ * glm::dvec4(patient_mm, 1.0)) * spacing_mm_;
  };
  return {place(tool_.solid_from_m), place(tool_.solid_to_m), radius_mm_};
}

void Removal::giveWork(double work_J, double lost_J, const TissueField& tissue) {
  lost_J_ = lost_J;
  double dearest_J = 0.0;
  for (int c = 0; c < tissue.tissues().count; ++c) {
    const TissueClass& t = tissue.ofClass(c);
    if (t.cuttable) dearest_J = std::max(dearest_J, voxelWork_J(t));
  }
  recent_J_ = fading_ * (recent_J_ + work_J);
  credit_J_ = std::min(credit_J_ + work_J, recent_J_ + 2.0 * dearest_J);
}

void Removal::begin(const Capsule& now) {
  goal_ = now;
  const double clear_mm = known_ ? clear_.radius : -layer_mm_;
  goal_.radius = std::min(radius_mm_, std::max(0.0, clear_mm) + layer_mm_);
  if (kind_ == RemovalKind::instant || !known_ || went_on_) goal_.radius = radius_mm_;
  went_on_ = false;
  layOut();
  slice_ = 0;
  row_ = -1;
  paid_ = true;
  passing_ = true;
  backwards_ = !backwards_;
}

// What the pass from what is clear to its goal goes through.
void Removal::layOut() {
  Capsule from = known_ ? clear_ : goal_;
  from.radius = goal_.radius;
  solid_.set(from, goal_);
  cleared_ = CapsuleRows(known_ ? clear_ : Capsule{});
  const Indices slices = indices(solid_.depth(), per_spacing_.z, geometry_.size[2]);
  low_[2] = slices.first;
  high_[2] = slices.last;
  const Indices columns = indices(solid_.width(), per_spacing_.x, geometry_.size[0]);
  low_[0] = columns.first;
  high_[0] = columns.last;
  slice_end_ = high_[2] - low_[2] + 1;
}

void Removal::end(const Capsule& now) {
  passing_ = false;
  if (paid_) {
    clear_ = goal_;
    known_ = true;
    return;
  }
  // What was clear around the last place is clear around this one as far as it reaches.
  const double clear_mm = known_ ? clear_.radius - moved(clear_, now) : 0.0;
  clear_ = now;
  clear_.radius = std::max(0.0, clear_mm);
  known_ = true;
}

void Removal::take(const TissueField& tissue, const Index3& voxel, int tissue_class,
                   std::vector<RemovedVoxel>& removed) {
  const double price_J = cost_J(tissue.ofClass(tissue_class));
  if (!affords(price_J) || removed.size() == kMostVoxels) return;
  spend(price_J);
  removed.push_back({voxel, tissue_class, price_J});
}

void Removal::takeTouched(const TissueField& tissue, std::span<const std::int64_t> voxels,
                          std::span<const std::int8_t> classes,
                          std::vector<RemovedVoxel>& removed) {
  for (std::size_t i = 0; i < tool_.cutting_points; ++i) {
    const int c = classes[i];
    if (c < 0 || !tissue.ofClass(c).cuttable) continue;
    if (i > 0 && voxels[i] == voxels[i - 1]) continue;  // taken already
    take(tissue, geometry_.indicesOf(std::size_t(voxels[i])), c, removed);
  }
}

bool Removal::mayMeetTissue(const TissueField& tissue, const Capsule& now) const {
  const Vec3 low = glm::min(glm::min(clear_.from, clear_.to), glm::min(now.from, now.to));
  const Vec3 high = glm::max(glm::max(clear_.from, clear_.to), glm::max(now.from, now.to));
  return tissue.mayHold((low - radius_mm_) * per_spacing_, (high + radius_mm_) * per_spacing_);
}

void Removal::sweep(const TissueField& tissue, const Pose& pose_mm,
                    std::vector<RemovedVoxel>& removed) {
  const Capsule now = capsuleAt(pose_mm);
  if (!isFinite(now.from) || !isFinite(now.to)) {
    forget();
    return;
  }
  if (last_ && !(moved(*last_, now) <= farthest_mm_)) forget();
  last_ = now;
  if (spared_ != 0) {
    // The plane across the tool at its tip: a way that is ahead of it is so in voxels, too.
    tip_ = Vec3(patient_to_voxel_ * glm::dvec4(pose_mm.position, 1.0));
    ahead_ = normal_to_voxel_ * (pose_mm.orientation * Vec3(0.0, 0.0, -1.0));
  }
  // Work ran short and the tool went on: it must not take later what it has left.
  if (passing_ && !paid_ && moved(goal_, now) > layer_mm_) end(now);
  if (!passing_ && !beginWhereNeeded(tissue, now)) return;
  Tick tick{tissue, removed, looks_};
  if (!sweepSlices(tick)) return;
  paid_ = true;  // waited for, but paid in the end
  end(now);
}

// False where the tool stands still, or where there is no tissue on its way, and nothing is left to
// be cleared.
bool Removal::beginWhereNeeded(const TissueField& tissue, const Capsule& now) {
  const bool all = known_ && clear_.radius >= radius_mm_;
  if (all && moved(clear_, now) < still_mm_) return false;
  if (all && !mayMeetTissue(tissue, now)) {
    clear_ = now;
    return false;
  }
  begin(now);
  return true;
}

// The slices of the pass that are left. False where it goes on in the next tick: work is short, or
// this tick has looked at enough.
bool Removal::sweepSlices(Tick& tick) {
  while (slice_ < slice_end_) {
    if (!sweepSlice(tick)) return false;
    row_ = -1;
    ++slice_;
    if (tick.looks <= 0 && slice_ < slice_end_) return false;
  }
  return true;
}

int Removal::sliceNow() const {
  return backwards_ ? high_[2] - slice_ : low_[2] + slice_;
}

void Removal::layOutSlice(int k) {
  const Indices rows = indices(solid_.band(k * spacing_mm_.z), per_spacing_.y, geometry_.size[1]);
  low_[1] = rows.first;
  high_[1] = rows.last;
}

// A pass that another removal began goes on here.
bool Removal::takeOver() {
  if (!passing_) return true;
  layOut();
  if (slice_ < 0 || slice_ >= slice_end_) return false;
  if (row_ < 0) return true;
  layOutSlice(sliceNow());
  return row_ <= high_[1] - low_[1] + 1;
}

bool Removal::sweepSlice(Tick& tick) {
  const int k = sliceNow();
  if (row_ < 0) {
    layOutSlice(k);
    row_ = 0;
  }
  const int rows = high_[1] - low_[1] + 1;
  while (row_ < rows) {
    // A batch of rows at a time: their first voxels are on the way while the others are found.
    std::array<Row, kBatch> batch;
    int next = row_;
    const std::size_t count = findRows(tick, k, rows, next, batch);
    for (std::size_t n = 0; n < count; ++n) {
      if (sweepRow(tick, batch[n])) continue;
      row_ = batch[n].number;  // goes on here in the next tick
      return false;
    }
    row_ = next;
    if (tick.looks <= 0 && row_ < rows) return false;
  }
  return true;
}

// The next rows of slice k that the solid crosses, from row `next` of `rows` on; returns how many
// they are. Rows of bricks that hold no tissue are passed over together.
std::size_t Removal::findRows(Tick& tick, int k, int rows, int& next, std::span<Row> batch) const {
  const int row_looks = (goal_.isSphere() ? kLooksPerRow : 2 * kLooksPerRow) * solid_.places();
  const double z = k * spacing_mm_.z;
  std::size_t count = 0;
  for (const int first_row = next; count < batch.size() && next < rows; ++next) {
    const int j = backwards_ ? high_[1] - next : low_[1] + next;
    const int in_brick = j & (kBrickEdge - 1);
    if (next == first_row || in_brick == (backwards_ ? kBrickEdge - 1 : 0)) {
      const int more = backwards_ ? in_brick : kBrickEdge - 1 - in_brick;
      const Vec3 first(low_[0], backwards_ ? j - more : j, k);
      const Vec3 last(high_[0] - 1, (backwards_ ? j : j + more) - 1, k - 1);
      if (!tick.tissue.mayHold(first, last)) {
        next += more;
        tick.looks -= kLooksPerRow;
        continue;
      }
    }
    tick.looks -= row_looks;
    Row& row = batch[count];
    const double y = j * spacing_mm_.y;
    row.all = indices(solid_.row(y, z), per_spacing_.x, geometry_.size[0]);
    if (row.all.first > row.all.last) continue;
    row.clear = known_ ? indices(cleared_.row(y, z), per_spacing_.x, geometry_.size[0]) : Indices{};
    row.j = j;
    row.k = k;
    row.number = next;
    row.voxel = geometry_.indexOf(0, j, k);
    tick.tissue.prefetch(row.voxel + std::size_t(row.all.first));
    tick.tissue.prefetch(row.voxel + std::size_t(row.all.last));
    ++count;
  }
  return count;
}

// Takes what of a row may be cut and is paid for. False at the first voxel that is not paid for, or
// that is one too many for a tick.
bool Removal::sweepRow(Tick& tick, const Row& row) {
  for (int i = row.all.first; i <= row.all.last; ++i) {
    if (i >= row.clear.first && i <= row.clear.last) {
      i = row.clear.last;
      continue;
    }
    --tick.looks;
    const std::size_t voxel = row.voxel + std::size_t(i);
    const std::int16_t hu = tick.tissue.hu(voxel);
    const int c = hu == kAirHu ? -1 : tick.tissue.classAt(voxel, hu);
    if (c < 0 || !tick.tissue.ofClass(c).cuttable) continue;
    if (spared_ != 0 && isSpared(c, i, row.j, row.k)) continue;
    const double price_J = cost_J(tick.tissue.ofClass(c));
    const bool pays = affords(price_J);
    if (!pays) paid_ = false;
    if (!pays || tick.removed.size() == kMostVoxels) return false;
    spend(price_J);
    tick.removed.push_back({{i, row.j, row.k}, c, price_J});
  }
  return true;
}

}  // namespace trephine
