#include "exercise/exercise_fields.h"

#include <cmath>

#include "base/tr.h"

namespace trephine {

namespace {

constexpr Range kQuaternionPart{-1.001, 1.001};

}  // namespace

Quat readRotation(JsonReader& item) {
  const std::vector<double> q = item.numbers("rotation_wxyz", 4, kQuaternionPart);
  WorkspaceMap map;
  map.rotation = Quat(q[0], q[1], q[2], q[3]);
  if (item.ok() && !validate(map, "")) {
    item.fail("rotation_wxyz", tr("Expected a unit quaternion, found {}", Json(q).dump()));
  }
  return map.rotation;
}

// R = Rz Ry Rx.
MapTurn turnOf(const Quat& rotation) {
  const glm::dmat3 r = glm::mat3_cast(rotation);  // r[column][row]
  const double flat = std::hypot(r[0][0], r[0][1]);
  Vec3 turn(0.0, std::atan2(-r[0][2], flat), 0.0);
  if (flat > 1e-9) {
    turn.x = std::atan2(r[1][2], r[2][2]);
    turn.z = std::atan2(r[0][1], r[0][0]);
  } else {
    turn.x = std::atan2(-r[2][1], r[1][1]);
  }
  return {glm::degrees(turn)};
}

Quat rotationOf(const MapTurn& turn) {
  const Vec3 of = glm::radians(turn.turned_deg);
  return glm::normalize(glm::angleAxis(of.z, Vec3(0, 0, 1)) * glm::angleAxis(of.y, Vec3(0, 1, 0)) *
                        glm::angleAxis(of.x, Vec3(1, 0, 0)));
}

std::string exerciseFieldsPage() {
  return schemaHead() + schemaLines<Exercise>("scene", kExerciseFields) +
         schemaLines<Exercise>("scene", kTouchFields) +
         schemaLines<Exercise>("scene", kPointsFields) +
         schemaLines<Exercise>("scene", kLockFields) +
         schemaLines<ExerciseView>("`view`", kViewFields) +
         schemaLines<CardText>("`card`, a language", kCardFields) +
         schemaLines<ExerciseOutline>("`outline`", kOutlineFields) +
         schemaLines<LandmarkFrame>("outline, `frame`", kOutlineFrameFields) +
         schemaLines<Landmark>("landmark", kLandmarkFields) +
         schemaLines<ExerciseArm>("arm", kArmFields) +
         schemaLines<ExerciseMap>("arm, `map`", kExerciseMapFields) +
         schemaLines<WorkspaceMap>("arm, fixed `map`", kWorkspaceMapFields) +
         schemaLines<ArmDevice>("arm, `device`", kDeviceFields) +
         schemaLines<ArmDynamics>("arm, `dynamics`", kArmDynamicsFields);
}

std::string toolFieldsPage() {
  return schemaHead() + schemaLines<ToolDescription>("tool", kToolFields) +
         schemaLines<ToolLook>("mesh", kLookFields);
}

}  // namespace trephine
