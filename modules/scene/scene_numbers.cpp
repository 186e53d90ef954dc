#include "scene/scene_numbers.h"

namespace trephine {

namespace {

constexpr Range kQuaternionPart{-1.001, 1.001};

}  // namespace

Quat readRotation(JsonReader& item) {
  const std::vector<double> q = item.numbers("rotation_wxyz", 4, kQuaternionPart);
  WorkspaceMap map;
  map.rotation = Quat(q[0], q[1], q[2], q[3]);
  if (item.ok() && !validate(map, "")) {
    item.fail("rotation_wxyz", "Expected a unit quaternion, found " + Json(q).dump());
  }
  return map.rotation;
}

std::string sceneNumbersPage() {
  return schemaHead() + schemaLines<Scene>("scene", kSceneNumbers) +
         schemaLines<SceneView>("`view`", kViewNumbers) +
         schemaLines<SceneOutline>("`outline`", kOutlineNumbers) +
         schemaLines<LandmarkFrame>("outline, `frame`", kOutlineFrameNumbers) +
         schemaLines<Landmark>("landmark, ray", kRayNumbers) +
         schemaLines<Landmark>("landmark, organ", kBulkNumbers) +
         schemaLines<Landmark>("landmark, place", kPlaceNumbers) +
         schemaLines<Landmark>("landmark", kLandmarkNumbers) +
         schemaLines<SceneArm>("arm, `device`", kDeviceNumbers) +
         schemaLines<SceneArm>("arm", kArmNumbers) +
         schemaLines<SceneMap>("arm, `map`", kSceneMapNumbers) +
         schemaLines<WorkspaceMap>("arm, fixed `map`", kWorkspaceMapNumbers) +
         schemaLines<ArmDynamics>("arm, `dynamics`", kArmDynamicsNumbers);
}

std::string toolNumbersPage() {
  return schemaHead() + schemaLines<ToolDescription>("tool", kToolNumbers) +
         schemaLines<ToolDescription>("burr", kBurrNumbers) +
         schemaLines<ToolDescription>("cylinder", kCylinderNumbers) +
         schemaLines<ToolLook>("mesh", kLookNumbers);
}

}  // namespace trephine
