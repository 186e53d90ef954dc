#include "scene/scene_numbers.h"

namespace trephine {

std::string sceneNumbersPage() {
  return schemaHead() + schemaLines<Scene>("scene", kSceneNumbers) +
         schemaLines<SceneView>("`view`", kViewNumbers) +
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
