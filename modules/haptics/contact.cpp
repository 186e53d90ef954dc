#include "haptics/contact.h"

namespace trephine {

namespace {

int classAt(const Grid& grid, const Mat4& patient_to_voxel, const TissueTable& tissues,
            const Vec3& patient_mm, std::int64_t& voxel) {
  voxel = nearestVoxel(grid.geometry(), patient_to_voxel, patient_mm);
  return voxel < 0 ? -1 : classify(tissues, grid.hu(std::size_t(voxel)));
}

bool firmer(const TissueTable& tissues, int a, int b) {
  if (b < 0) return true;
  const TissueClass& x = tissues.classes[std::size_t(a)];
  const TissueClass& y = tissues.classes[std::size_t(b)];
  if (x.yield_N != y.yield_N) return x.yield_N > y.yield_N;
  return x.damping_Ns_per_m > y.damping_Ns_per_m;
}

bool tissueNear(const Grid& grid, const Mat4& patient_to_voxel, const TissueTable& tissues,
                const Vec3& point_mm, double reach_mm) {
  std::int64_t voxel = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (double sign : {-1.0, 1.0}) {
      Vec3 p = point_mm;
      p[axis] += sign * reach_mm;
      if (classAt(grid, patient_to_voxel, tissues, p, voxel) >= 0) return true;
    }
  }
  return false;
}

}  // namespace

std::int64_t nearestVoxel(const GridGeometry& geometry, const Mat4& patient_to_voxel,
                          const Vec3& patient_mm) {
  const Vec3 v = Vec3(patient_to_voxel * glm::dvec4(patient_mm, 1.0)) + 0.5;
  // Written so that NaN falls out as "outside".
  const bool inside = v.x >= 0.0 && v.y >= 0.0 && v.z >= 0.0 && v.x < geometry.size[0] &&
                      v.y < geometry.size[1] && v.z < geometry.size[2];
  if (!inside) return -1;
  return std::int64_t(geometry.indexOf(int(v.x), int(v.y), int(v.z)));
}

Contact findContact(const Grid& grid, const Mat4& patient_to_voxel, const TissueTable& tissues,
                    const Tool& tool, const Pose& pose_mm, const Contact& before, double hold_mm,
                    std::vector<Hit>& hits) {
  hits.clear();
  Contact contact;
  for (const Vec3& point_m : tool.points_m) {
    const Vec3 point_mm = pose_mm.position + 1000.0 * (pose_mm.orientation * point_m);
    std::int64_t voxel = 0;
    const int found = classAt(grid, patient_to_voxel, tissues, point_mm, voxel);
    if (found < 0) continue;
    ++contact.points;
    hits.push_back({std::size_t(voxel), found});
    if (firmer(tissues, found, contact.tissue_class)) contact.tissue_class = found;
  }
  if (contact.touching() || !before.touching()) return contact;
  for (const Vec3& point_m : tool.points_m) {
    const Vec3 point_mm = pose_mm.position + 1000.0 * (pose_mm.orientation * point_m);
    if (tissueNear(grid, patient_to_voxel, tissues, point_mm, hold_mm)) {
      contact.tissue_class = before.tissue_class;
      break;
    }
  }
  return contact;
}

}  // namespace trephine
