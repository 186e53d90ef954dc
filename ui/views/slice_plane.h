// Where slices lie in the patient and which side of them is up. Pure geometry; the only place that
// knows how a slice is customarily looked at: the patient's front or head up, the patient's right
// or front at the left. That is axial seen from the feet, coronal from the front, sagittal from the
// patient's left.
#pragma once

#include <array>
#include <optional>

#include "volume/grid.h"

namespace trephine {

enum class SliceAxis { axial, coronal, sagittal };
inline constexpr std::array kSliceAxes{SliceAxis::axial, SliceAxis::coronal, SliceAxis::sagittal};

// The stack of true axial, coronal or sagittal slices of a grid, as a grid of its own: columns go
// to the right of the screen, rows down, slices away from the eye. Where the grid's axes are those
// of the patient (but for less than a tenth of a voxel from end to end) its pixels are the grid's
// voxels, flipped or permuted. Else they are patient planes through the grid, as fine as its voxels
// are along each axis, and reach around it. `grid` has at least one voxel.
GridGeometry sliceStack(const GridGeometry& grid, SliceAxis axis);

// Whether the grid's axes are the patient's, so that this stack of it has its voxels for pixels.
bool hasVoxelsForPixels(const GridGeometry& stack, const GridGeometry& grid);

// The voxel of the grid that holds a place in the patient: the nearest one.
std::optional<Index3> voxelAt(const GridGeometry& grid, const Vec3& patient_mm);
// Voxel coordinates of a place: a voxel's centre is whole numbers.
Vec3 toVoxel(const GridGeometry& grid, const Vec3& patient_mm);

// Whether slice `k` of `stack` shows a voxel of that box of `grid`.
bool touches(const GridGeometry& stack, int k, const GridGeometry& grid, const VoxelBox& box);

// How a slice as stored is turned to be looked at as is customary. Columns of `direction` are the
// unit directions, LPS, of columns, rows and slices.
struct Mirroring {
  bool across = false, down = false;
};
Mirroring mirroringOf(const Mat3& direction);
// The axis (0 to 2, of LPS) along which it mostly points.
int mainAxis(const Vec3& direction);
// The grid's axis that lies most along a direction.
int axisAlong(const GridGeometry& grid, const Vec3& direction);
// L, R, A, P, S or I: where in the patient the direction mostly points.
char patientLetter(const Vec3& direction);

}  // namespace trephine
