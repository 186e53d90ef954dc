// The search of a SolidSurface: from a body to the pieces of solid tissue around it, some rows of
// voxels at a time.
#include <algorithm>
#include <cmath>

#include "haptics/solid_surface.h"

namespace trephine {

namespace {

constexpr double kDisk = 0.5;      // radius of a disk, of the diagonal of the mesh in its plane
constexpr double kFlatDisk = 1.0;  // the same where the columns around it are in a plane
constexpr int kPieceWork = 8;      // work to make a piece, in rows

// The cell of a cube's face that a direction meets, faces of n^2 cells.
int cellOf(const Vec3& d, int n) {
  int axis = 0;
  if (std::abs(d.y) > std::abs(d.x)) axis = 1;
  if (std::abs(d.z) > std::abs(d[axis])) axis = 2;
  const double size = std::abs(d[axis]);
  if (!(size > 0.0)) return 0;
  const auto at = [&](double value) {
    return std::min(n - 1, int((value / size + 1.0) * 0.5 * n));
  };
  const int face = 2 * axis + (d[axis] < 0.0 ? 1 : 0);
  return (face * n + at(d[(axis + 1) % 3])) * n + at(d[(axis + 2) % 3]);
}

}  // namespace

void SolidSurface::begin(const TissueField& tissue, const PlacedBody& body, Cutting cutting) {
  stretches_.clear();
  found_.clear();
  next_.clear();
  searched_ = made_ = 0;
  done_ = 0;
  under_way_ = true;
  cutting_ = cutting;
  next_reach_mm_ = 0.0;
  next_disks_ = {};
  some_went_ = lost_ = false;
  ++turn_;
  const auto place = [&](const Vec3& patient_mm) {
    return Vec3(patient_to_voxel_ * glm::dvec4(patient_mm, 1.0)) * spacing_mm_;
  };
  const Vec3 tip = place(body.tip_mm);
  for (std::size_t n = 0; n < body.count; ++n) {
    const PlacedBody::Part& part = body.parts[n];
    const Vec3 from = place(part.from_mm), along = place(part.from_mm + part.along_mm) - from;
    const double length = glm::length(along);
    const int count = std::max(1, int(std::ceil(length / kStretch_mm)));
    Stretch stretch;
    stretch.part = n;
    stretch.share = 1.0 / count;
    stretch.along = stretch.share * along;
    stretch.per_length2 = length > 0.0 ? 1.0 / glm::dot(stretch.along, stretch.along) : 0.0;
    for (int number = 0; number < count; ++number) {
      stretch.from = number * stretch.share;
      const Vec3 start = from + stretch.from * along;
      stretch.axis = {start, start + stretch.along, part.radius_mm};
      const double far_mm = part.radius_mm + kFar * margin_mm_ + half_diagonal_mm_;
      const Vec3 low = glm::min(stretch.axis.from, stretch.axis.to) - far_mm;
      const Vec3 high = glm::max(stretch.axis.from, stretch.axis.to) + far_mm;
      if (!tissue.mayHoldSolid(low / spacing_mm_, high / spacing_mm_)) continue;
      next_reach_mm_ =
          std::max({next_reach_mm_, part.radius_mm + glm::length(stretch.axis.from - tip),
                    part.radius_mm + glm::length(stretch.axis.to - tip)});
      addStretch(tissue, stretch);
    }
  }
}

void SolidSurface::addStretch(const TissueField& tissue, Stretch stretch) {
  const Capsule& axis = stretch.axis;
  const double outer = axis.radius + margin_mm_ + half_diagonal_mm_;
  const Vec3 low = (glm::min(axis.from, axis.to) - outer) / spacing_mm_;
  const Vec3 high = (glm::max(axis.from, axis.to) + outer) / spacing_mm_;
  if (!tissue.mayHoldSolid(low, high)) return;
  bound(stretch);
  const int apart = cells_[stretch.part].apart[2];
  stretch.plane = int(std::max(0.0, low.z) / apart) * apart;
  stretch.last_plane = std::min(geometry_.size[2] - 1, int(std::max(-1.0, high.z)));
  stretches_.push_back(stretch);
}

void SolidSurface::bound(Stretch& stretch) const {
  Capsule outer = stretch.axis, inner = stretch.axis;
  outer.radius = stretch.axis.radius + margin_mm_ + half_diagonal_mm_;
  inner.radius = stretch.axis.radius - half_diagonal_mm_;
  stretch.hollow = inner.radius > 0.0;
  stretch.around = CapsuleRows(outer);
  if (stretch.hollow) stretch.within = CapsuleRows(inner);
}

bool SolidSurface::goOn(const TissueField& tissue, int work) {
  for (const int until = done_ + std::min(work, kAll - done_); done_ < until;) {
    if (searched_ < stretches_.size()) {
      Stretch& stretch = stretches_[searched_];
      done_ += searchPlane(tissue, stretch);
      if (stretch.plane > stretch.last_plane) ++searched_;
    } else if (made_ < found_.size()) {
      addPiece(tissue, found_[made_++]);
      done_ += kPieceWork;
    } else {
      finish(tissue);
      return true;
    }
  }
  return false;
}

// The pieces that were found are those that hold from now on.
void SolidSurface::finish(const TissueField& tissue) {
  std::swap(pieces_, next_);
  due_mm_.assign(pieces_.size(), 0.0);
  forgetAwake();
  disks_ = next_disks_;
  near_reach_mm_ = next_reach_mm_;
  under_way_ = near_known_ = false;
  work_ = done_;
  if (!by_rows_) return;
  for (std::size_t n = 0; some_went_ && n < pieces_.size(); ++n) {
    SurfacePiece& piece = pieces_[n];
    if (tissue.isSolidAt(piece.at[0], piece.at[1], piece.at[2])) continue;
    if (!goOnAlongRow(tissue, piece)) lost_ = true;
    if (piece.voxel == SurfacePiece::kGone) due_mm_[n] = std::numeric_limits<double>::max();
  }
  index();
}

// The rows of voxels of a plane around a stretch. Returns how many rows it has.
int SolidSurface::searchPlane(const TissueField& tissue, Stretch& stretch) {
  const Vec3& s = spacing_mm_;
  const Index3& apart = cells_[stretch.part].apart;
  const double per_x = 1.0 / s.x;
  const int k = stretch.plane;
  stretch.plane += apart[2];
  if (k > stretch.last_plane) return 1;
  const double z = k * s.z;
  const Interval band = stretch.around.band(z);
  if (band.empty()) return 1;
  // Some rows at a time: their voxels are on the way while the others are found.
  std::array<Row, 16> rows;
  std::size_t count = 0;
  int all = 1;
  const int last_j = std::min(geometry_.size[1] - 1, int(std::max(-1.0, band.high / s.y)));
  for (int j = int(std::max(0.0, band.low / s.y) / apart[1]) * apart[1]; j <= last_j;
       j += apart[1]) {
    const double y = j * s.y;
    const Interval around = stretch.around.row(y, z);
    if (around.empty() || around.high < 0.0) continue;
    Row& row = rows[count];
    row.from = std::max(0, int(around.low * per_x));
    row.to = std::min(geometry_.size[0] - 1, int(around.high * per_x));
    if (row.from > row.to) continue;
    row.j = j;
    row.k = k;
    row.left = row.right = 0;
    const Interval clear = stretch.hollow ? stretch.within.row(y, z) : Interval{};
    if (!clear.empty()) {
      row.left = std::min(row.to, clear.low > 0.0 ? int(clear.low * per_x) + 1 : 0);
      row.right = std::max({row.from, row.left + 1, int(std::max(0.0, clear.high) * per_x)});
    }
    tissue.prefetchSolid(row.from, j, k);
    tissue.prefetchSolid(row.to, j, k);
    ++all;
    if (++count < rows.size()) continue;
    searchRows(tissue, stretch, rows);
    count = 0;
  }
  searchRows(tissue, stretch, {rows.data(), count});
  return all;
}

// Each row from its middle, where the body keeps solid tissue out, outwards to the first solid
// voxel.
void SolidSurface::searchRows(const TissueField& tissue, const Stretch& stretch,
                              std::span<const Row> rows) {
  for (const Row& row : rows) {
    if (by_rows_) {
      searchRowParts(tissue, stretch, row);
      continue;
    }
    if (row.right <= row.left) {
      for (int i = row.from; (i = tissue.solidUp(i, row.to, row.j, row.k)) <= row.to; ++i) {
        find(tissue, {i, row.j, row.k}, stretch);
      }
      continue;
    }
    int i = tissue.solidDown(row.left, row.from, row.j, row.k);
    if (i >= row.from) find(tissue, {i, row.j, row.k}, stretch);
    i = tissue.solidUp(row.right, row.to, row.j, row.k);
    if (i <= row.to) find(tissue, {i, row.j, row.k}, stretch);
  }
}

// The first solid voxel on either side of where the row is nearest to the axis: the distance from a
// segment grows outwards. That place moves as the tool does, and the more the longer the axis lies
// along the row: wherever it may come to, there is one more in each part of kRowPart_mm. (Before
// version 11 all voxels of a row that comes near nowhere were found, most of them in vain.)
void SolidSurface::searchRowParts(const TissueField& tissue, const Stretch& stretch,
                                  const Row& row) {
  const Vec3& from = stretch.axis.from;
  const Vec3& along = stretch.along;
  const double y = row.j * spacing_mm_.y - from.y, z = row.k * spacing_mm_.z - from.z;
  const double across2 = along.y * along.y + along.z * along.z, share = y * along.y + z * along.z;
  double on = 0.5, on_low = 0.0, on_high = 1.0;
  if (across2 > 0.0) {
    // The place of the axis that is nearest to the row, and all that may be once each has come a
    // margin nearer and that one gone a margin away.
    on = std::clamp(share / across2, 0.0, 1.0);
    const double dy = y - on * along.y, dz = z - on * along.z;
    const double far = std::sqrt(dy * dy + dz * dz) + 2.0 * margin_mm_;
    const double root =
        std::sqrt(std::max(0.0, share * share - across2 * (y * y + z * z - far * far)));
    on_low = std::clamp((share - root) / across2, 0.0, 1.0);
    on_high = std::clamp((share + root) / across2, 0.0, 1.0);
  }
  const auto at = [&](double place) { return (from.x + place * along.x) / spacing_mm_.x; };
  const double margin = margin_mm_ / spacing_mm_.x;
  const double lowest = std::min(at(on_low), at(on_high)) - margin,
               highest = std::max(at(on_low), at(on_high)) + margin;
  int left = int(std::clamp(at(on), double(row.from), double(row.to))), right = left + 1;
  if (row.right > row.left) {
    left = row.left;
    right = std::max(row.right, row.left + 1);
  }
  const int part = std::max(1, int(kRowPart_mm / spacing_mm_.x));
  const int kept = cutsRows(stretch.part) ? 1 : 0;
  // Parts without any solid voxel are passed over together.
  while (left >= row.from) {
    const int found = tissue.solidDown(left, row.from, row.j, row.k);
    if (found < row.from) break;
    const int first = left - (left - found) / part * part;
    const int end = first > lowest ? std::max(row.from, first - part + 1) : row.from;
    find(tissue, {found, row.j, row.k}, stretch, -kept, end);
    left = end - 1;
  }
  while (right <= row.to) {
    const int found = tissue.solidUp(right, row.to, row.j, row.k);
    if (found > row.to) break;
    const int first = right + (found - right) / part * part;
    const int end = first < highest ? std::min(row.to, first + part - 1) : row.to;
    find(tissue, {found, row.j, row.k}, stretch, kept, end);
    right = end + 1;
  }
}

// Keeps the voxel if it is the nearest of its cell, which is one at the surface; that of a row
// (`row_step`) whatever its cell has, if it may be cut.
void SolidSurface::find(const TissueField& tissue, const Index3& voxel, const Stretch& stretch,
                        int row_step, int row_end) {
  if (found_.size() == found_.capacity()) return;
  const Vec3 centre = Vec3(voxel[0], voxel[1], voxel[2]) * spacing_mm_;
  const double on_axis = nearestOn(stretch.axis.from, stretch.along, stretch.per_length2, centre);
  const Vec3 away = centre - (stretch.axis.from + on_axis * stretch.along);
  const double distance2 = glm::dot(away, away);
  const double farthest = stretch.axis.radius + margin_mm_ + half_diagonal_mm_;
  if (distance2 > farthest * farthest) return;
  if (row_step != 0 && mayCut(tissue, voxel)) {
    found_.push_back(
        {voxel, stretch.part, away, distance2, kNoCell, row_end, std::int8_t(row_step)});
    return;
  }
  const Cells& cells = cells_[stretch.part];
  const double on_part = stretch.from + on_axis * stretch.share;
  const int along = std::min(cells.along - 1, int(on_part * cells.along));
  const std::size_t cell =
      std::size_t(cells.first + along * 6 * cells.directions * cells.directions +
                  cellOf(away, cells.directions));
  if (stamp_[cell] != turn_) {
    stamp_[cell] = turn_;
    cell_[cell] = std::int32_t(found_.size());
    found_.push_back({voxel, stretch.part, away, distance2, std::int32_t(cell), 0, 0});
    return;
  }
  Found& nearest = found_[std::size_t(cell_[cell])];
  if (distance2 < nearest.distance2_mm2)
    nearest = {voxel, stretch.part, away, distance2, std::int32_t(cell), 0, 0};
}

// Where all solid tissue may be cut, or none, no voxel is looked at.
bool SolidSurface::mayCut(const TissueField& tissue, const Index3& voxel) const {
  if (tissue.cutsOfSolid() != TissueField::Cuts::some) {
    return tissue.cutsOfSolid() == TissueField::Cuts::all;
  }
  const int c = tissue.classAt(geometry_.indexOf(voxel[0], voxel[1], voxel[2]));
  return c >= 0 && tissue.ofClass(c).cuttable != 0;
}

void SolidSurface::addPiece(const TissueField& tissue, const Found& found) {
  const auto [i, j, k] = found.voxel;
  const double radius = parts_mm_[found.part].radius_m;
  const std::size_t voxel = geometry_.indexOf(i, j, k);
  const int c = tissue.classAt(voxel);
  const Cutting cutting = parts_mm_[found.part].cuts ? cutting_ : Cutting::nothing;
  SurfacePiece piece;
  piece.part = std::int32_t(found.part);
  piece.voxel = std::uint32_t(voxel);
  piece.at = found.voxel;
  piece.row_step = found.row_step;
  piece.row_end = found.row_end;
  const bool went = !tissue.isSolid(c);  // meanwhile
  if (went && found.cell != kNoCell) {
    lost_ = true;
    return;
  }
  piece.tissue_class = std::int8_t(std::max(0, c));
  piece.cuttable = went || (cutting != Cutting::nothing && tissue.ofClass(c).cuttable != 0);
  Vec3 at = Vec3(i, j, k) * spacing_mm_;
  if (piece.cuttable && cutting == Cutting::driven) {
    // Held by what removal takes and by no row beside it, which would be erased too. Between the
    // centres a tool thinner than a voxel would slip through: nothing does between such spheres.
    const double most_mm = std::max({spacing_mm_.x, spacing_mm_.y, spacing_mm_.z});
    const bool by_centres = radius >= kHalfVoxel * most_mm && !wide_spheres_;
    piece.size_mm = by_centres ? 0.0 : std::max(0.0, half_diagonal_mm_ - radius);
  } else {
    next_disks_.add(found.voxel);
    const VoxelSurroundings around(tissue, found.voxel, cells_[found.part].apart, c);
    const SurfaceFit fit = fitSurface(around, found.away_mm);
    if (fit.kind == SurfaceFit::Kind::behind) return;
    if (fit.kind == SurfaceFit::Kind::plate) {
      piece.size_mm = kPlate * voxel_mm_;
    } else {
      piece.flat = fit.kind == SurfaceFit::Kind::flat;
      at += fit.above_mm;
      piece.normal = geometry_.direction * fit.normal;
      const Vec3 in_plane = glm::sqrt(glm::max(Vec3(0.0), 1.0 - fit.normal * fit.normal));
      piece.size_mm = (piece.flat ? kFlatDisk : kDisk) * glm::length(around.mesh_mm() * in_plane);
    }
  }
  piece.at_mm = geometry_.origin_mm + geometry_.direction * at;
  next_.push_back(piece);
}

}  // namespace trephine
