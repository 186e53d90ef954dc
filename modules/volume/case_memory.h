// What a case takes in memory: four copies of its voxels and a bit of each, by whom, and what comes
// with them. An import promises it, and who takes a part of it asks for that part first
// (base/memory.h). In MB of 2^20 bytes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <thread>

namespace trephine {

// The window before a case is opened, where no graphics card draws; measured on Debian 12.
constexpr double kWindow_mb = 110.0;
// An exercise beside its voxels: the journal's ring (82 MB), the rings to the recorder, HDF5, the
// slab that is hashed (16 MB), and what threads keep for themselves. Measured, 122 to 124 in turn
// on a case of 64^3, whose slab is small, and 165 to 170 on one of 400^3; what an exercise before
// gave back counts.
constexpr double kExercise_mb = 180.0;
// The stacks of all threads and what else nobody had touched, which the first exercise holds in
// memory and the process keeps. Measured on two cores, 137 to 160 in turn; every further one may
// bring a thread of the graphics driver.
inline const double kHeld_mb =
    180.0 + 8.0 * std::max(0, int(std::thread::hardware_concurrency()) - 2);
// What the view knows of each 8^3 voxels: their range, two bytes each, and how far to leap.
constexpr double kLeapShare = 6.0 / (8 * 8 * 8) / sizeof(std::int16_t);

// A copy of so many voxels. The case's own; the grid that is cut; the view's mirror of that grid;
// and the texture that the mirror is sent to.
constexpr double voxelsMb(std::size_t voxels) {
  return double(voxels) * sizeof(std::int16_t) / 1048576.0;
}
// To show it, in the window or for a picture.
constexpr double shownMb(std::size_t voxels) {
  return (2.0 + kLeapShare) * voxelsMb(voxels);
}
// Labels, a byte each: a case's, or those in the view's texture.
constexpr double labelsMb(std::size_t voxels) {
  return 0.5 * voxelsMb(voxels);
}
// Which voxels are solid for a tool, a bit each; touch keeps it.
constexpr double solidMb(std::size_t voxels) {
  return voxelsMb(voxels) / (8.0 * sizeof(std::int16_t));
}
// To practise on it, for the first time or once more.
inline double exerciseMb(std::size_t voxels, bool held_before = false) {
  return voxelsMb(voxels) + solidMb(voxels) + kExercise_mb + (held_before ? 0.0 : kHeld_mb);
}
// To open it, show it and practise on it, beyond the window; labels come on top (labelsMb, twice).
inline double openedMb(std::size_t voxels) {
  return voxelsMb(voxels) + shownMb(voxels) + exerciseMb(voxels);
}

}  // namespace trephine
