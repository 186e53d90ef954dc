#include "lab/render/upload_measurement.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/codes.h"
#include "render/scene_renderer.h"

namespace trephine {

namespace {

constexpr int kTries = 15;
constexpr Index3 kSize{512, 512, 300};
constexpr int kBoxEdge = 48;
constexpr std::int16_t kBoneHu = 1200;

// A ball of bone in air, as wide as the grid is high.
Volume ball() {
  Volume volume;
  volume.geometry.size = kSize;
  volume.geometry.spacing_mm = Vec3(0.5, 0.5, 0.8);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  const Vec3 spacing = volume.geometry.spacing_mm;
  const double radius_mm = 0.46 * kSize[2] * spacing.z;
  for (int k = 0; k < kSize[2]; ++k) {
    for (int j = 0; j < kSize[1]; ++j) {
      const double z = (k - kSize[2] / 2) * spacing.z, y = (j - kSize[1] / 2) * spacing.y;
      const double left = radius_mm * radius_mm - z * z - y * y;
      if (left <= 0.0) continue;
      const int half = std::min(kSize[0] / 2 - 1, int(std::sqrt(left) / spacing.x));
      const auto row =
          volume.hu.begin() + std::ptrdiff_t(volume.geometry.indexOf(kSize[0] / 2 - half, j, k));
      std::fill(row, row + 2 * half, kBoneHu);
    }
  }
  return volume;
}

void fill(Volume& volume, const VoxelBox& box, std::int16_t hu) {
  for (int k = box.low[2]; k < box.high[2]; ++k) {
    for (int j = box.low[1]; j < box.high[1]; ++j) {
      const auto row =
          volume.hu.begin() + std::ptrdiff_t(volume.geometry.indexOf(box.low[0], j, k));
      std::fill(row, row + (box.high[0] - box.low[0]), hu);
    }
  }
}

TissueSet bone() {
  Tissue tissue;
  tissue.id = "bone";
  tissue.hu_min = 300;
  tissue.hu_max = 3071;
  tissue.colour = Vec3(0.9, 0.85, 0.75);
  tissue.opacity = 0.9;
  return {"upload", {tissue}};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

Result<UploadMeasurement> measureUpload(const Progress& progress) {
  const Error cancelled{code::kCancelled, "The measurement was cancelled", "measure upload", ""};
  progress.at(0.0, "volume");
  Result<std::unique_ptr<SceneRenderer>> made = SceneRenderer::offscreen(480, 360);
  if (!made) return made.error();
  SceneRenderer& renderer = **made;
  {
    const Grid grid(ball());
    renderer.setVolume(grid);
  }
  renderer.setTissues(bone());
  renderer.resetCamera(Vec3(0, 1, 0), Vec3(0, 0, 1));
  const Picture before = renderer.picture();

  // Where the ball faces the eye, so that the picture shows what is done there.
  VoxelBox box;
  const Index3 corner{kSize[0] / 2 - kBoxEdge / 2, 0, kSize[2] / 2 - kBoxEdge / 2};
  const double front = kSize[1] / 2.0 - 0.46 * kSize[2] * 0.8 / 0.5;
  box.low = {corner[0], std::max(0, int(front)), corner[2]};
  for (std::size_t axis = 0; axis < 3; ++axis) box.high[axis] = box.low[axis] + kBoxEdge;

  // An odd number of tries that cut and fill in turn leaves the box cut.
  static_assert(kTries % 2 == 1);
  std::vector<double> full, boxes;
  for (int i = 0; i < kTries; ++i) {
    if (progress.cancelled()) return cancelled;
    progress.at(0.2 + 0.6 * i / kTries, "uploads");
    full.push_back(UploadProbe::fullUpload_ms(renderer));
    fill(UploadProbe::copy(renderer), box, i % 2 == 0 ? kAirHu : kBoneHu);
    boxes.push_back(UploadProbe::boxUpload_ms(renderer, box));
  }

  progress.at(0.8, "pictures");
  const Picture after_box = renderer.picture();
  full.push_back(UploadProbe::fullUpload_ms(renderer));
  const Picture after_full = renderer.picture();

  UploadMeasurement result;
  result.full_ms = median(full);
  result.box_ms = median(boxes);
  result.ratio = result.full_ms / result.box_ms;
  // Two pictures in which nothing was cut would be equal as well.
  result.pictures_equal = after_box == after_full && !(after_box == before);
  progress.at(1.0, "done");
  return result;
}

Json toJson(const UploadMeasurement& measurement) {
  return {{"full_ms", measurement.full_ms},
          {"box_ms", measurement.box_ms},
          {"ratio", measurement.ratio},
          {"pictures_equal", measurement.pictures_equal}};
}

}  // namespace trephine
