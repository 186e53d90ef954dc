#include "structures/surface.h"

#include <cstring>
#include <fstream>

#include "support.h"

namespace trephine {
namespace {

struct Triangle {
  float numbers[12];  // normal, then three corners
};

std::vector<Triangle> trianglesOf(const std::filesystem::path& stl) {
  std::ifstream in(stl, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  EXPECT_EQ(bytes.size(), 84 + std::size_t(count) * 50);
  std::vector<Triangle> all(count);
  for (std::size_t n = 0; n < count; ++n) std::memcpy(&all[n], bytes.data() + 84 + 50 * n, 48);
  return all;
}

// A ball on an oblique grid of unequal spacing, cut by the scan's end where it is moved there.
LabelMap ball(double radius_mm, const Vec3& moved_mm = Vec3(0.0)) {
  LabelMap map;
  map.geometry.size = {60, 50, 40};
  map.geometry.spacing_mm = {0.8, 1.0, 1.5};
  map.geometry.origin_mm = {100, -50, 30};
  map.geometry.direction = glm::mat3_cast(glm::angleAxis(0.6, glm::normalize(Vec3(1, -2, 0.5))));
  map.labels.resize(map.geometry.voxelCount());
  const Vec3 middle = map.geometry.centre_mm() + moved_mm;
  for (std::size_t v = 0; v < map.labels.size(); ++v) {
    const Index3 at = map.geometry.indicesOf(v);
    const Vec3 mm = map.geometry.toPatient_mm(Vec3(at[0], at[1], at[2]));
    map.labels[v] = glm::length(mm - middle) < radius_mm ? 3 : 7;
  }
  return map;
}

TEST(Surface, LiesOnTheStructureInThePatientWithNormalsOut) {
  const test::TemporaryFolder folder;
  const LabelMap map = ball(15.0);
  const auto written = writeSurface(map, 3, folder / "ball.stl");
  ASSERT_TRUE(written) << written.error().sentence();
  EXPECT_NEAR(written->ml, 4.0 / 3.0 * 3.14159265 * 15 * 15 * 15 / 1000.0, 0.4);
  const std::vector<Triangle> all = trianglesOf(folder / "ball.stl");
  EXPECT_EQ(all.size(), written->triangles);
  for (const Triangle& t : all) {
    Vec3 middle(0.0);
    for (int c = 1; c < 4; ++c) {
      const Vec3 at(t.numbers[3 * c], t.numbers[3 * c + 1], t.numbers[3 * c + 2]);
      EXPECT_NEAR(glm::length(at - map.geometry.centre_mm()), 15.0, 0.9);
      middle += at / 3.0;
    }
    const Vec3 normal(t.numbers[0], t.numbers[1], t.numbers[2]);
    EXPECT_GT(glm::dot(normal, middle - map.geometry.centre_mm()), 0.0);
  }
}

TEST(Surface, IsClosedWhereTheScanEnds) {
  const test::TemporaryFolder folder;
  const LabelMap map = ball(15.0, glm::normalize(Vec3(1, 0, 0)) * 25.0);
  const auto written = writeSurface(map, 3, folder / "ball.stl");
  ASSERT_TRUE(written) << written.error().sentence();
  const double of_voxels = double(std::count(map.labels.begin(), map.labels.end(), 3)) *
                           map.geometry.voxelVolume_mm3() / 1000.0;
  EXPECT_NEAR(written->ml / of_voxels, 1.0, 0.05) << "an open surface encloses less";
}

TEST(Surface, NothingIsWrittenOfNothing) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(writeSurface(ball(15.0), 4, folder / "a.stl").error().code.str(), "EMPTY_STRUCTURE");
  EXPECT_EQ(writeSurface(ball(15.0), 3, folder / "none" / "a.stl").error().code.str(),
            "CANNOT_WRITE");
  Progress progress;
  progress.cancel();
  EXPECT_EQ(writeSurface(ball(15.0), 3, folder / "a.stl", progress).error().code.str(),
            "CANCELLED");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace trephine
