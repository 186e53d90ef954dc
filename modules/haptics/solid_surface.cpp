#include "haptics/solid_surface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace trephine {

namespace {

// The tool may travel so far before the surface is searched anew: 1.3 of a voxel's smallest edge,
// 0.5 mm at least.
constexpr double kMargin = 1.3;
constexpr double kLeastMargin_mm = 0.5;
// Rows of voxels that are looked at lie apart by at most a seventh of a part's radius or 0.4 mm, if
// that is more; every row, where voxels are larger.
constexpr double kRowsPerRadius = 1.0 / 7.0;
constexpr double kLeastRows_mm = 0.4;
constexpr int kMostAlong = 256, kMostDirections = 16;
constexpr double kLeastCell_mm = 0.25;
// Flat disks within kBlended radii of a touch have a common plane, where the cosine between their
// normals and the touch's is at least kAlike. The place of the touch follows in kSettled rounds.
constexpr double kAlike = 0.8;
constexpr int kSettled = 2;
constexpr double kBlended = 1.5;
constexpr int kFitReach = 3;  // meshes from a voxel that its surface follows from (surface_fit.h)
// Rounding of a bound against the distance itself, mm.
constexpr double kRounding_mm = 1e-9;

}  // namespace

std::optional<Touch> SolidSurface::touchWithin(std::size_t number, const PlacedBody& body,
                                               double within_mm, double& gap_mm) const {
  const SurfacePiece& piece = pieces_[number];
  const PlacedBody::Part& part = body.parts[std::size_t(piece.part)];
  const Vec3 centre =
      part.from_mm +
      nearestOn(part.from_mm, part.along_mm, part.per_length2, piece.at_mm) * part.along_mm;
  const Vec3 away = centre - piece.at_mm;
  Touch touch;
  double distance = 0.0;
  if (piece.normal == Vec3(0.0)) {
    distance = glm::length(away);
    gap_mm = distance - part.radius_mm - piece.size_mm;
    if (gap_mm > within_mm) return {};
    touch.normal = distance > 0.0 ? away / distance : Vec3(0.0, 0.0, 1.0);
  } else {
    const double height = glm::dot(away, piece.normal);
    const Vec3 aside = away - height * piece.normal;
    const double aside2 = glm::dot(aside, aside);
    if (aside2 <= piece.size_mm * piece.size_mm) {
      distance = height;
      touch.normal = piece.normal;
    } else {  // the disk's rim
      const double beside = std::sqrt(aside2), beyond = beside - piece.size_mm;
      const double about = std::sqrt(height * height + beyond * beyond);
      gap_mm = about - part.radius_mm - kRounding_mm;
      if (by_rows_ && gap_mm > within_mm) return {};
      const Vec3 to_rim = away - aside * (piece.size_mm / beside);
      distance = glm::length(to_rim);
      touch.normal = distance > 0.0 ? to_rim / distance : piece.normal;
    }
    gap_mm = distance - part.radius_mm;
    if (gap_mm > within_mm) return {};
  }
  touch.gap_mm = gap_mm;
  touch.lever_mm = centre - part.radius_mm * touch.normal - body.tip_mm;
  return touch;
}

Touch SolidSurface::blended(const Touch& touch, std::size_t number, const PlacedBody& body) {
  if (!near_known_) {
    Vec3 low(1e300), high(-1e300);
    for (const SurfacePiece& piece : pieces_) {
      low = glm::min(low, piece.at_mm);
      high = glm::max(high, piece.at_mm);
    }
    near_.clear(low, high, pieces_.size());
    for (std::size_t n = 0; n < pieces_.size(); ++n) {
      if (pieces_[n].normal != Vec3(0.0)) near_.add(n, pieces_[n].at_mm);
    }
    near_known_ = true;
  }
  const SurfacePiece& piece = pieces_[number];
  const double radius_mm = body.parts[std::size_t(piece.part)].radius_mm;
  const double reach_mm = kBlended * piece.size_mm;
  const double reach2 = kBlended * kBlended * piece.size_mm * piece.size_mm;
  const Vec3 centre = body.tip_mm + touch.lever_mm + radius_mm * touch.normal;
  Touch out = touch;
  // From the second round on the place is that of the common plane, whichever piece the first was
  // of.
  for (int round = 0; round < kSettled; ++round) {
    const Vec3 at = centre - (radius_mm + out.gap_mm) * out.normal;
    Vec3 normals(0.0);
    double heights = 0.0, weights = 0.0;
    near_.around(at, reach_mm + kRounding_mm, [&](std::size_t n) {
      const SurfacePiece& other = pieces_[n];
      const Vec3 apart = other.at_mm - at;
      const double distance2 = glm::dot(apart, apart);
      if (distance2 >= reach2 || glm::dot(other.normal, touch.normal) < kAlike) return;
      const double near = 1.0 - distance2 / reach2, weight = near * near;
      normals += weight * other.normal;
      heights -= weight * glm::dot(other.normal, apart);
      weights += weight;
    });
    if (!(weights > 0.0)) break;
    out.normal = glm::normalize(normals);
    out.gap_mm = heights / weights + glm::dot(out.normal, centre - at) - radius_mm;
  }
  out.lever_mm = centre - radius_mm * out.normal - body.tip_mm;
  return out;
}

SolidSurface::SolidSurface(const Tool& tool, const GridGeometry& geometry, int touch_version)
    : geometry_(geometry),
      patient_to_voxel_(geometry.patientToVoxel()),
      spacing_mm_(geometry.spacing_mm),
      wide_spheres_(touch_version <= 9),
      by_rows_(touch_version >= 11) {
  const Vec3& s = spacing_mm_;
  voxel_mm_ = std::min({s.x, s.y, s.z});
  half_diagonal_mm_ = 0.5 * glm::length(s);
  margin_mm_ = std::max(kMargin * voxel_mm_, kLeastMargin_mm);
  reach_mm_ = 0.0;
  int cells = 0;
  std::size_t stretches = 0, most = 0;  // found at once
  for (const BodyPart& part : tool.body) {
    parts_mm_.push_back(
        {1000.0 * part.from_m, 1000.0 * part.to_m, 1000.0 * part.radius_m, part.cuts});
    const BodyPart& mm = parts_mm_.back();
    reach_mm_ = std::max(
        {reach_mm_, glm::length(mm.from_m) + mm.radius_m, glm::length(mm.to_m) + mm.radius_m});
    const double length = glm::length(mm.to_m - mm.from_m);
    Cells of;
    // A face of a cube around the part is a quarter of its turn wide: cells of half a row's
    // distance.
    of.apart = rowsApart(mm.radius_m);
    const double cell_mm = 0.5 * std::min({s.x, of.apart[1] * s.y, of.apart[2] * s.z});
    of.directions = std::clamp(int(std::ceil(1.6 * mm.radius_m / cell_mm)), 2, kMostDirections);
    of.along = std::clamp(int(std::ceil(length / std::max(cell_mm, kLeastCell_mm))), 1, kMostAlong);
    of.first = cells;
    const int all = of.along * 6 * of.directions * of.directions;
    cells += all;
    cells_.push_back(of);
    const std::size_t count = std::size_t(length / kStretch_mm) + 1;
    stretches += count;
    // No more than voxels within reach of its stretches: a long thin part has many times the cells.
    const double around_mm = mm.radius_m + margin_mm_ + 2.0 * half_diagonal_mm_;
    const double around_mm3 = std::numbers::pi * around_mm * around_mm *
                              (std::min(length, kStretch_mm) + 4.0 / 3.0 * around_mm);
    const double voxels = double(count) * std::ceil(around_mm3 / (s.x * s.y * s.z));
    const std::size_t by_cells = std::size_t(std::min(double(all), voxels));
    most += std::max(by_cells, by_rows_ && mm.cuts ? count * rowsAround(of, length, around_mm) : 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      fit_reach_[axis] = std::max(fit_reach_[axis], kFitReach * of.apart[axis]);
    }
  }
  near_reach_mm_ = reach_mm_;
  pieces_.reserve(most);
  due_mm_.reserve(most);
  awake_.reserve(most);
  next_.reserve(most);
  stretches_.reserve(stretches);
  found_.reserve(most);
  cell_.assign(std::size_t(cells), 0);
  stamp_.assign(std::size_t(cells), 0);
  near_ = NearPieces(most);
  if (by_rows_) slots_.assign(std::bit_ceil(4 * most + 4), 0);
}

// Upper bound of the parts of rows within a distance of a stretch of a part, however it lies.
std::size_t SolidSurface::rowsAround(const Cells& of, double length_mm, double around_mm) const {
  constexpr int kAngles = 16;  // of the axis against the rows; one more for what lies between
  const double y_mm = of.apart[1] * spacing_mm_.y, z_mm = of.apart[2] * spacing_mm_.z;
  const double part_mm = std::max(kRowPart_mm, 2.0 * spacing_mm_.x) - spacing_mm_.x;
  const double stretch_mm = std::min(length_mm, kStretch_mm), wide_mm = 2.0 * around_mm;
  double most = 0.0;
  for (int n = 0; n < kAngles; ++n) {
    const double low = 0.5 * std::numbers::pi * n / kAngles,
                 high = 0.5 * std::numbers::pi * (n + 1) / kAngles;
    const double across_mm = stretch_mm * std::sin(high) + wide_mm;
    // A box around it, wherever it points to in the rows' plane.
    const double rows = (across_mm / y_mm + 2.0) * (wide_mm / z_mm + 2.0) +
                        (across_mm / z_mm + 2.0) * (wide_mm / y_mm + 2.0);
    // What may become the nearest place is no longer than the stretch.
    const double range_mm = stretch_mm * std::cos(low) + 2.0 * margin_mm_;
    most = std::max(most, rows * (range_mm / part_mm + 4.0));
  }
  return std::size_t(most);
}

bool SolidSurface::centreIn(const PlacedBody& body) const {
  return std::any_of(pieces_.begin(), pieces_.end(), [&](const SurfacePiece& piece) {
    if (piece.voxel == SurfacePiece::kGone) return false;
    const Index3& v = piece.at;
    const PlacedBody::Part& part = body.parts[std::size_t(piece.part)];
    const Vec3 from = geometry_.toPatient_mm(Vec3(v[0], v[1], v[2])) - part.from_mm;
    const double on = std::clamp(glm::dot(from, part.along_mm) * part.per_length2, 0.0, 1.0);
    return glm::length(from - on * part.along_mm) < part.radius_mm;
  });
}

PlacedBody SolidSurface::place(const Pose& pose_mm) const {
  PlacedBody body;
  body.tip_mm = pose_mm.position;
  body.count = std::min(parts_mm_.size(), PlacedBody::kMost);
  for (std::size_t n = 0; n < body.count; ++n) {
    const BodyPart& mm = parts_mm_[n];
    PlacedBody::Part& part = body.parts[n];
    part.from_mm = pose_mm.position + pose_mm.orientation * mm.from_m;
    part.along_mm = pose_mm.orientation * (mm.to_m - mm.from_m);
    const double length2 = glm::dot(part.along_mm, part.along_mm);
    part.per_length2 = length2 > 0.0 ? 1.0 / length2 : 0.0;
    part.radius_mm = mm.radius_m;
  }
  return body;
}

bool SolidSurface::mayMeet(const TissueField& tissue, const PlacedBody& from,
                           const PlacedBody& to) const {
  for (std::size_t n = 0; n < from.count; ++n) {
    Vec3 low(1e300), high(-1e300);
    for (const PlacedBody* body : {&from, &to}) {
      const PlacedBody::Part& part = body->parts[n];
      for (const Vec3& end : {part.from_mm, part.from_mm + part.along_mm}) {
        const Vec3 voxel(patient_to_voxel_ * glm::dvec4(end, 1.0));
        low = glm::min(low, voxel);
        high = glm::max(high, voxel);
      }
    }
    const double around = from.parts[n].radius_mm + margin_mm_ + half_diagonal_mm_;
    const Vec3 reach = around / spacing_mm_;
    if (tissue.mayHoldSolid(low - reach, high + reach)) return true;
  }
  return false;
}

// A search that another surface began goes on here.
bool SolidSurface::takeOver() {
  std::fill(stamp_.begin(), stamp_.end(), 0);
  turn_ = 1;
  const auto known = [this](const SurfacePiece& piece) {
    const auto& [i, j, k] = piece.at;
    return std::size_t(piece.part) < cells_.size() && geometry_.contains(i, j, k) &&
           piece.voxel == geometry_.indexOf(i, j, k) && piece.row_end >= 0 &&
           piece.row_end < geometry_.size[0] && isFinite(piece.at_mm) && isFinite(piece.normal) &&
           std::isfinite(piece.size_mm);
  };
  if (due_mm_.size() != pieces_.size()) return false;
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    SurfacePiece piece = pieces_[n];
    if (piece.voxel == SurfacePiece::kGone) {
      if (due_mm_[n] != std::numeric_limits<double>::max()) return false;
      piece.voxel = std::uint32_t(geometry_.indexOf(piece.at[0], piece.at[1], piece.at[2]));
    }
    if (!known(piece) || std::isnan(due_mm_[n])) return false;
  }
  near_known_ = false;
  forgetAwake();
  index();
  if (!under_way_) return true;
  if (!std::all_of(next_.begin(), next_.end(), known)) return false;
  for (Stretch& stretch : stretches_) {
    if (stretch.part >= cells_.size() || stretch.plane < 0) return false;
    const Capsule& axis = stretch.axis;
    if (!isFinite(axis.from) || !isFinite(axis.to) || !isFinite(stretch.along) ||
        !std::isfinite(axis.radius) || !std::isfinite(stretch.per_length2) ||
        !(stretch.from >= 0.0 && stretch.share >= 0.0 && stretch.from + stretch.share < 1.001)) {
      return false;
    }
    if (stretch.last_plane >= geometry_.size[2]) return false;
    bound(stretch);
  }
  for (std::size_t n = 0; n < found_.size(); ++n) {
    const Found& found = found_[n];
    const std::size_t cell = std::size_t(found.cell);
    const Index3& v = found.voxel;
    if (found.part >= cells_.size() || !geometry_.contains(v[0], v[1], v[2])) return false;
    if (found.row_end < 0 || found.row_end >= geometry_.size[0]) return false;
    if (found.cell == kNoCell) continue;
    if (cell >= stamp_.size()) return false;
    stamp_[cell] = turn_;
    cell_[cell] = std::int32_t(n);
  }
  return true;
}

// How many rows lie between two that are looked at, and one.
Index3 SolidSurface::rowsApart(double radius_mm) const {
  const double apart_mm = std::max(kRowsPerRadius * radius_mm, kLeastRows_mm);
  Index3 apart{1, 1, 1};
  for (int axis = 1; axis < 3; ++axis) {
    apart[std::size_t(axis)] = std::max(1, int(apart_mm / spacing_mm_[axis]));
  }
  return apart;
}

// The voxel of its row that stands where the piece's went. False where none does within reach, or
// one that is not cut, which is then met as it stands.
bool SolidSurface::goOnAlongRow(const TissueField& tissue, SurfacePiece& piece) const {
  const auto [i, j, k] = piece.at;
  const int step = piece.row_step, end = piece.row_end;
  piece.voxel = SurfacePiece::kGone;
  if (step == 0) {
    piece.normal = Vec3(0.0);
    return false;
  }
  const int next = step > 0 ? tissue.solidUp(i + 1, end, j, k) : tissue.solidDown(i - 1, end, j, k);
  if (step > 0 ? next > end : next < end) return true;
  const std::size_t voxel = geometry_.indexOf(next, j, k);
  const int c = tissue.classAt(voxel);
  piece.voxel = std::uint32_t(voxel);
  piece.at = {next, j, k};
  piece.at_mm = geometry_.toPatient_mm(Vec3(next, j, k));
  piece.tissue_class = std::int8_t(c);
  if (tissue.ofClass(c).cuttable != 0) return true;
  piece.cuttable = false;
  piece.row_step = 0;
  piece.size_mm = kPlate * voxel_mm_;
  return false;
}

SolidSurface::Stale SolidSurface::removed(const TissueField& tissue,
                                          std::span<const std::uint32_t> voxels,
                                          const VoxelBounds& box) {
  some_went_ = true;
  Stale stale{disks_.meets(box, fit_reach_), under_way_ && next_disks_.meets(box, fit_reach_)};
  if (!stale.now && !rows_.meets(box)) return stale;
  for (const std::uint32_t voxel : voxels) {
    for (std::size_t slot = slotOf(voxel); slots_[slot] != 0; slot = (slot + 1) & slot_mask_) {
      const std::size_t number = slots_[slot] - 1;
      SurfacePiece& piece = pieces_[number];
      if (piece.voxel != voxel) continue;
      if (piece.row_step == 0) near_known_ = false;
      if (!goOnAlongRow(tissue, piece)) stale.now = true;
      const bool gone = piece.voxel == SurfacePiece::kGone;
      due_mm_[number] =
          gone ? std::numeric_limits<double>::max() : std::numeric_limits<double>::lowest();
      if (gone) continue;
      wake(number);
      const std::size_t before = filled_;
      index(number);
      // Where the slots were made anew: from the first that this voxel may have, once more.
      if (filled_ <= before) slot = (slotOf(voxel) + slot_mask_) & slot_mask_;
    }
  }
  return stale;
}

void SolidSurface::drop(const TissueField& tissue) {
  std::size_t kept = 0;
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    if (!tissue.isSolid(tissue.classAt(pieces_[n].voxel))) continue;
    due_mm_[kept] = due_mm_[n];
    pieces_[kept++] = pieces_[n];
  }
  pieces_.resize(kept);
  due_mm_.resize(kept);
  forgetAwake();
  near_known_ = false;
}

// Looks at all pieces only every so often: the tool comes a tenth of a millimetre nearer till then.
std::span<const std::uint32_t> SolidSurface::awake(double within_mm, double travelled_mm) {
  constexpr double kAwake_mm = 0.1;
  const double until_mm = within_mm + travelled_mm;
  if (!(until_mm <= awake_until_mm_)) {
    awake_until_mm_ = until_mm + kAwake_mm;
    awake_.clear();
    for (std::size_t n = 0; n < due_mm_.size(); ++n) {
      if (!(due_mm_[n] > awake_until_mm_)) awake_.push_back(std::uint32_t(n));
    }
  }
  return awake_;
}

void SolidSurface::wake(std::size_t piece) {
  const auto at = std::lower_bound(awake_.begin(), awake_.end(), std::uint32_t(piece));
  if (at == awake_.end() || *at != piece) awake_.insert(at, std::uint32_t(piece));
}

void SolidSurface::forgetAwake() {
  awake_.clear();
  awake_until_mm_ = std::numeric_limits<double>::lowest();
}

// Fibonacci hashing.
std::size_t SolidSurface::slotOf(std::uint32_t voxel) const {
  return std::size_t(voxel * 2654435769u >> 8) & slot_mask_;
}

void SolidSurface::index() {
  if (!by_rows_) return;
  slot_mask_ = std::bit_ceil(4 * pieces_.size() + 4) - 1;
  std::fill_n(slots_.begin(), slot_mask_ + 1, 0);
  filled_ = 0;
  rows_ = {};
  for (std::size_t n = 0; n < pieces_.size(); ++n) {
    const SurfacePiece& piece = pieces_[n];
    if (piece.voxel == SurfacePiece::kGone) continue;
    index(n);
    rows_.add(piece.at);
    if (piece.row_step != 0) rows_.add({piece.row_end, piece.at[1], piece.at[2]});
  }
}

// A slot of a voxel that went stays: at most half of them are filled.
void SolidSurface::index(std::size_t piece) {
  if (2 * ++filled_ > slot_mask_ + 1) return index();  // which fills a quarter at most
  std::size_t slot = slotOf(pieces_[piece].voxel);
  while (slots_[slot] != 0) slot = (slot + 1) & slot_mask_;
  slots_[slot] = std::uint32_t(piece + 1);
}

}  // namespace trephine
