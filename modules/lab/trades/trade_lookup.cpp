// The HU of a point: from the nearest voxel, or a trilinear mean of eight.
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

#include "haptics/contact.h"
#include "lab/common/quantile.h"
#include "lab/common/shell_phantom.h"
#include "lab/trades/trade_knobs.h"

namespace trephine {

namespace {

constexpr double kStep_mm = 0.01;  // along a ray
constexpr double kReach_mm = 3.0;  // to either side of the surface
constexpr int kLookups = 64;
constexpr int kBatches = 2001;

struct Looker {
  const Grid& grid;
  Mat4 to_voxel;
  double threshold_hu;

  bool nearest(const Vec3& at_mm) const {
    const std::int64_t voxel = nearestVoxel(grid.geometry(), to_voxel, at_mm);
    return voxel >= 0 && grid.hu(std::size_t(voxel)) >= threshold_hu;
  }
  bool trilinear(const Vec3& at_mm) const {
    const Vec3 v = Vec3(to_voxel * glm::dvec4(at_mm, 1.0));
    const Vec3 low = glm::floor(v), t = v - low;
    double sum = 0.0;
    for (int n = 0; n < 8; ++n) {
      const Vec3 corner(n & 1, n >> 1 & 1, n >> 2);
      const Vec3 share = glm::mix(1.0 - t, t, corner);
      const Vec3 at = low + corner;
      sum += share.x * share.y * share.z * grid.hu(int(at.x), int(at.y), int(at.z));
    }
    return sum >= threshold_hu;
  }
};

// How far along the ray the first tissue lies from where the surface is; a ray that finds none is
// off by its whole reach.
template <class IsTissue>
double surfaceError_mm(const Vec3& surface_mm, const Vec3& inwards, IsTissue&& isTissue) {
  for (double along = -kReach_mm; along <= kReach_mm; along += kStep_mm) {
    if (isTissue(surface_mm + along * inwards)) return std::abs(along);
  }
  return kReach_mm;
}

template <class IsTissue>
double lookupNs(const std::array<Vec3, kLookups>& points_mm, IsTissue&& isTissue) {
  std::vector<double> ns;
  unsigned found = 0;
  for (int batch = 0; batch < kBatches; ++batch) {
    const Vec3 shift(1e-3 * (batch % 500));  // not the same voxels every time
    const auto begin = std::chrono::steady_clock::now();
    for (const Vec3& p : points_mm) found += isTissue(p + shift);
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
    ns.push_back(took.count());
  }
  asm volatile("" : : "g"(&found) : "memory");  // somebody reads it
  std::sort(ns.begin(), ns.end());
  return quantile(ns, 500);
}

}  // namespace

TradeRows tradeLookup(const TradesOptions& options, const Progress& progress) {
  // Voxels of a clinical scan, around the top of the shell.
  constexpr double kBox_mm = 64.0;
  constexpr int kSize = 82;
  const EllipsoidShell shell;
  const Vec3 top_mm(0.0, 0.0, shell.half_axes_mm.z - 10.0);
  const Grid grid(scannedShell(shell, cubeGeometry(kSize, kBox_mm, top_mm), 10.0, 2));
  // A surface lies half-way between the HU of its two sides.
  const Looker looker{grid, grid.geometry().patientToVoxel(), 0.5 * (shell.bone_hu + kAirHu)};
  const auto nearest = [&](const Vec3& p) { return looker.nearest(p); };
  const auto trilinear = [&](const Vec3& p) { return looker.trilinear(p); };

  std::array<double, 2> sum_mm{};
  std::array<Vec3, kLookups> points_mm{};
  for (int n = 0; n < options.rays; ++n) {
    if (progress.cancelled()) return tradesCancelled();
    // Evenly over the cap within 20 degrees of the top, slanted rays among them.
    const double z = 1.0 - 0.06 * (n + 0.5) / options.rays, flat = std::sqrt(1.0 - z * z);
    const double turn = n * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const Vec3 at_mm = surfacePoint_mm(shell, {flat * std::cos(turn), flat * std::sin(turn), z});
    const Vec3 inwards = -surfaceNormal(shell, at_mm);
    sum_mm[0] += surfaceError_mm(at_mm, inwards, nearest);
    sum_mm[1] += surfaceError_mm(at_mm, inwards, trilinear);
    points_mm[std::size_t(n % kLookups)] = at_mm;
  }
  std::vector<TradeRow> rows;
  for (int which : {0, 1}) {
    TradeRow row;
    row.knob = "hu_lookup";
    row.setting = which == 0 ? "nearest" : "trilinear";
    row.error = sum_mm[std::size_t(which)] / options.rays;
    row.error_unit = "mm";
    row.cost = which == 0 ? lookupNs(points_mm, nearest) : lookupNs(points_mm, trilinear);
    row.cost_unit = "ns per 64 look-ups";
    row.reference =
        "mean distance along the normal from the known surface of a scanned shell, "
        "voxels of 0.78 mm";
    rows.push_back(row);
  }
  return rows;
}

}  // namespace trephine
