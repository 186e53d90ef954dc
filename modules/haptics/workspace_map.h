// From an arm's workspace to the patient and back. Contact and laws live in the patient, observer,
// bound and clamp at the device; this is the one crossing.
#pragma once

#include "base/field.h"
#include "base/math.h"
#include "base/tr.h"

namespace trephine {

constexpr Range kMapScale{0.01, 100};  // of motion and of force
constexpr Range kMapPlace_mm{-1e9, 1e9, "mm"};

// p_patient_mm = centre_mm + 1000 s R p_device_m;  f_device = g R^T f_patient.
// A tissue damping b is therefore g s b at the arm.
struct WorkspaceMap {
  Vec3 centre_mm{0.0};        // where the device's origin lies in the patient
  Quat rotation{1, 0, 0, 0};  // R, device axes to patient axes
  double motion_scale = 1.0;  // s
  double force_scale = 1.0;   // g

  Pose toPatient_mm(const Pose& device_m) const {
    return {centre_mm + 1000.0 * motion_scale * (rotation * device_m.position),
            rotation * device_m.orientation};
  }
  Vec3 velocityToPatient(const Vec3& device_m_s) const {
    return motion_scale * (rotation * device_m_s);
  }
  Vec3 forceToDevice(const Vec3& patient_N) const {
    return force_scale * (glm::conjugate(rotation) * patient_N);
  }
  // Of equal power, as the force: force and travel are scaled by g and 1/s, turning by nothing.
  Vec3 torqueToDevice(const Vec3& patient_Nm) const {
    return force_scale / motion_scale * (glm::conjugate(rotation) * patient_Nm);
  }
  Vec3 toDevice_m(const Vec3& patient_mm) const {
    return glm::conjugate(rotation) * (patient_mm - centre_mm) / (1000.0 * motion_scale);
  }
  bool operator==(const WorkspaceMap&) const = default;
};

inline constexpr FieldOf<WorkspaceMap> kWorkspaceMapFields[] = {
    {{"centre_mm", kMapPlace_mm, Given::always,
      trLater("where the device's origin lies in the patient")},
     &WorkspaceMap::centre_mm},
    {{"motion_scale", kMapScale, Given::may_be, trLater("the tool's travel by the arm's")},
     &WorkspaceMap::motion_scale},
    {{"force_scale", kMapScale, Given::may_be, trLater("the arm's force by the tissue's")},
     &WorkspaceMap::force_scale},
};

// IMPOSSIBLE_NUMBER, also for a rotation that is no unit quaternion.
Status validate(const WorkspaceMap& map, const std::string& of);

}  // namespace trephine
