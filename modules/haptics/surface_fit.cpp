#include "haptics/surface_fit.h"

#include <array>
#include <cmath>
#include <optional>

namespace trephine {

namespace {

constexpr double kNoSide = 0.15;  // of the slope of a clear side: below it a voxel has none
constexpr double kFlat = 0.6;     // meshes: two columns and the one between them bend by less

// A voxel and the 26 around it.
class Cube {
 public:
  explicit Cube(const VoxelSurroundings& around) : around_(around) {
    for (int dk = -1; dk <= 1; ++dk) {
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) at_[numberOf({di, dj, dk})] = around.beyond({di, dj, dk});
      }
    }
  }
  double at(const Index3& by) const {
    for (int step : by) {
      if (step < -1 || step > 1) return around_.beyond(by);
    }
    return at_[numberOf(by)];
  }
  // Differences under binomial weights (Sobel), HU/mm.
  Vec3 slope() const {
    Vec3 slope(0.0);
    for (int dk = -1; dk <= 1; ++dk) {
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          const int off = (di != 0) + (dj != 0) + (dk != 0);
          const double weight = off == 1 ? 4.0 : off == 2 ? 2.0 : 1.0;
          slope += weight * at_[numberOf({di, dj, dk})] * Vec3(di, dj, dk);
        }
      }
    }
    return slope / (32.0 * around_.mesh_mm());
  }

 private:
  static std::size_t numberOf(const Index3& by) {
    return std::size_t((by[2] + 1) * 9 + (by[1] + 1) * 3 + by[0] + 1);
  }
  const VoxelSurroundings& around_;
  std::array<double, 27> at_;
};

// The columns along the axis that a surface faces most.
class Columns {
 public:
  Columns(const Cube& cube, int up, int out) : cube_(cube), up_(up), out_(out) {}

  // How many meshes above the voxel the surface stands in a column, where that is near.
  std::optional<double> height(int du, int dv) const {
    Index3 by{0, 0, 0};
    by[std::size_t((up_ + 1) % 3)] = du;
    by[std::size_t((up_ + 2) % 3)] = dv;
    const auto at = [&](int step) {
      by[std::size_t(up_)] = step * out_;
      return cube_.at(by);
    };
    double below = at(0);
    if (below > 0.0) {
      for (int step = 1; step <= 3; ++step) {
        const double above = at(step);
        if (above < 0.0) return step - 1 + below / (below - above);
        below = above;
      }
      return {};
    }
    double above = below;
    for (int step = -1; step >= -2; --step) {
      below = at(step);
      if (below > 0.0) return step + below / (below - above);
      above = below;
    }
    return {};
  }

 private:
  const Cube& cube_;
  int up_, out_;
};

// The plane through the columns around the middle one, by least squares: of two that lie opposite
// each other both must have a height, of those across the corners all four.
struct Plane {
  double height = 0.0, tilt_u = 0.0, tilt_v = 0.0;  // meshes
};
std::optional<Plane> planeThrough(const Columns& columns, double own) {
  const auto pair = [&](int du, int dv, double& sum, double& tilt) {
    const auto one = columns.height(du, dv);
    if (!one) return false;
    const auto other = columns.height(-du, -dv);
    if (!other || !(std::abs(*one + *other - 2.0 * own) < kFlat)) return false;
    tilt = 0.5 * (*one - *other);
    sum += *one + *other;
    return true;
  };
  double sum = own, tilt_u = 0.0, tilt_v = 0.0;
  if (!pair(1, 0, sum, tilt_u) || !pair(0, 1, sum, tilt_v)) return {};
  double corners = 0.0, tilt_uv = 0.0, tilt_vu = 0.0;
  if (!pair(1, 1, corners, tilt_uv) || !pair(1, -1, corners, tilt_vu)) {
    return Plane{sum / 5.0, tilt_u, tilt_v};
  }
  return Plane{(sum + corners) / 9.0, (tilt_u + tilt_uv + tilt_vu) / 3.0,
               (tilt_v + tilt_uv - tilt_vu) / 3.0};
}

}  // namespace

SurfaceFit fitSurface(const VoxelSurroundings& around, const Vec3& away_mm) {
  using Kind = SurfaceFit::Kind;
  const Cube cube(around);
  const Vec3 mesh_mm = around.mesh_mm(), slope = cube.slope();
  const double steep = glm::length(slope);
  const Vec3 n = steep > 0.0 ? -slope / steep : Vec3(0.0);
  const double mesh_least_mm = std::min({mesh_mm.x, mesh_mm.y, mesh_mm.z});
  if (!(steep * mesh_least_mm > kNoSide * VoxelSurroundings::kWhole_hu) ||
      glm::dot(away_mm, n) >= 0.0) {
    return {Kind::plate, {}, {}};
  }
  int up = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(n[axis]) * mesh_mm[axis] > std::abs(n[up]) * mesh_mm[up]) up = axis;
  }
  const int u = (up + 1) % 3, v = (up + 2) % 3, out = n[up] > 0.0 ? 1 : -1;
  const Columns columns(cube, up, out);
  const auto own = columns.height(0, 0);
  if (!own) return {Kind::behind, {}, {}};
  SurfaceFit fit{Kind::rough, Vec3(0.0), n};
  fit.above_mm[up] = *own * out * mesh_mm[up];
  if (const auto plane = planeThrough(columns, *own)) {
    fit.kind = Kind::flat;
    fit.above_mm[up] = plane->height * out * mesh_mm[up];
    Vec3 normal(0.0);
    normal[up] = out;
    normal[u] = -plane->tilt_u * mesh_mm[up] / mesh_mm[u];
    normal[v] = -plane->tilt_v * mesh_mm[up] / mesh_mm[v];
    fit.normal = glm::normalize(normal);
  }
  return fit;
}

}  // namespace trephine
