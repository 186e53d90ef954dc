#include "structures/structure_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "volume/two_threads.h"

namespace trephine {

namespace {

constexpr int kOver = 2;  // drawn so many times as large, against steps
constexpr double kXrayShare = 0.6;
// From the left above, where one looks from the front; towards the eye is the last.
const Vec3 kLight = glm::normalize(Vec3(-0.4, 0.5, 1.0));

}  // namespace

StructurePictures::StructurePictures(const Volume& volume, int longest) : grid_(volume.geometry) {
  // Across: the patient's left; up: the head; into the picture: the back.
  const std::array<Vec3, 3> wanted{Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, 1, 0)};
  std::array<bool, 3> taken{};
  for (std::size_t side : {std::size_t(1), std::size_t(0), std::size_t(2)}) {
    double most = -1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double along = glm::dot(grid_.direction[axis], wanted[side]);
      if (taken[std::size_t(axis)] || std::abs(along) <= most) continue;
      most = std::abs(along);
      axes_[side] = axis;
      turned_[side] = along < 0.0;
    }
    taken[std::size_t(axes_[side])] = true;
  }
  turned_[1] = !turned_[1];  // rows come from above
  const auto extent_mm = [&](std::size_t side) {
    return grid_.size[std::size_t(axes_[side])] * grid_.spacing_mm[axes_[side]];
  };
  const int most = kOver * std::clamp(longest, 16, 1024);
  pixel_mm_ = std::max(extent_mm(0), extent_mm(1)) / most;
  const auto pixels = [&](std::size_t side) {
    return kOver * std::max(1, int(std::lround(extent_mm(side) / pixel_mm_ / kOver)));
  };
  width_ = pixels(0);
  height_ = pixels(1);
  xray_.resize(std::size_t(width_) * std::size_t(height_));
  onTwoThreads(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      float sum = 0.0F;
      for (int d = 0; d < grid_.size[std::size_t(axes_[2])]; ++d) {
        sum += float(std::clamp(volume.hu[indexAt(x, y, d)] + 1000, 0, 2500));
      }
      xray_[std::size_t(y) * std::size_t(width_) + std::size_t(x)] = sum;
    }
  });
  const float highest = *std::max_element(xray_.begin(), xray_.end());
  for (float& value : xray_) value = highest > 0.0F ? value / highest : 0.0F;
}

// The voxel under a pixel of what is drawn, so many deep from the front.
std::size_t StructurePictures::indexAt(double across, double up, int depth) const {
  Index3 at{0, 0, 0};
  const std::array<double, 3> pixel{across, up, double(depth)};
  for (std::size_t side = 0; side < 3; ++side) {
    const auto axis = std::size_t(axes_[side]);
    const int size = grid_.size[axis];
    int n = side == 2 ? depth : int((pixel[side] + 0.5) * pixel_mm_ / grid_.spacing_mm[int(axis)]);
    n = std::clamp(n, 0, size - 1);
    at[axis] = turned_[side] ? size - 1 - n : n;
  }
  return grid_.indexOf(at[0], at[1], at[2]);
}

ColourPicture StructurePictures::of(const LabelMap& map, int label, const Vec3& colour) const {
  const int depth = grid_.size[std::size_t(axes_[2])];
  const double step_mm = grid_.spacing_mm[axes_[2]];
  const auto at = [&](int x, int y) {
    return std::size_t(y) * std::size_t(width_) + std::size_t(x);
  };
  constexpr float kNothing = std::numeric_limits<float>::infinity();
  std::vector<float> deep_mm(xray_.size(), kNothing);  // of what is seen first
  onTwoThreads(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      for (int d = 0; d < depth; ++d) {
        if (map.labels[indexAt(x, y, d)] != label) continue;
        deep_mm[at(x, y)] = float(d * step_mm);
        break;
      }
    }
  });
  // The mean over about a voxel's width, of what hangs together: the voxels' steps are no surface.
  const int blur = std::clamp(int(std::lround(step_mm / pixel_mm_)), 1, 4);
  std::vector<float> smooth_mm = deep_mm;
  onTwoThreads(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      const float here = deep_mm[at(x, y)];
      if (here == kNothing) continue;
      double sum = 0.0;
      int count = 0;
      for (int b = std::max(0, y - blur); b <= std::min(height_ - 1, y + blur); ++b) {
        for (int a = std::max(0, x - blur); a <= std::min(width_ - 1, x + blur); ++a) {
          const float there = deep_mm[at(a, b)];
          if (std::abs(there - here) > 6.0 * step_mm) continue;
          sum += there;
          ++count;
        }
      }
      smooth_mm[at(x, y)] = float(sum / count);
    }
  });
  const auto slope = [&](int x, int y, int dx, int dy) {
    const auto deep = [&](int a, int b) {
      const bool inside = a >= 0 && b >= 0 && a < width_ && b < height_;
      return inside ? smooth_mm[at(a, b)] : kNothing;
    };
    const float here = deep(x, y), before = deep(x - dx, y - dy), after = deep(x + dx, y + dy);
    const float low = before == kNothing ? here : before, high = after == kNothing ? here : after;
    const int apart = (before != kNothing) + (after != kNothing);
    return apart ? double(high - low) / (apart * pixel_mm_) : 0.0;
  };
  ColourPicture picture{width_ / kOver, height_ / kOver, {}};
  picture.rgb.resize(std::size_t(picture.width) * std::size_t(picture.height) * 3);
  onTwoThreads(picture.height, [&](int row) {
    for (int column = 0; column < picture.width; ++column) {
      Vec3 sum(0.0);
      for (int y = kOver * row; y < kOver * (row + 1); ++y) {
        for (int x = kOver * column; x < kOver * (column + 1); ++x) {
          if (smooth_mm[at(x, y)] == kNothing) {
            sum += Vec3(kXrayShare * xray_[at(x, y)]);
            continue;
          }
          // Deeper to the right: the surface looks to the right. Rows go down.
          const Vec3 normal = glm::normalize(Vec3(slope(x, y, 1, 0), -slope(x, y, 0, 1), 1.0));
          sum += colour * (0.25 + 0.75 * std::max(0.0, glm::dot(normal, kLight)));
        }
      }
      const Vec3 mean = glm::clamp(sum / double(kOver * kOver), Vec3(0.0), Vec3(1.0));
      for (int channel = 0; channel < 3; ++channel) {
        picture.rgb[3 * (std::size_t(row) * std::size_t(picture.width) + std::size_t(column)) +
                    std::size_t(channel)] = std::uint8_t(std::lround(255.0 * mean[channel]));
      }
    }
  });
  return picture;
}

}  // namespace trephine
