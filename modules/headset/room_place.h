// Where the patient lies in the trainee's room, and where an arm stands in it. The room: metres, y
// up, as the headset's software counts it. Pure.
#pragma once

#include <span>

#include "base/eye_view.h"
#include "base/result.h"

namespace trephine {

struct RoomPlace {
  Quat turn{1.0, 0.0, 0.0, 0.0};  // patient axes to room axes
  Vec3 origin_m{0.0};             // of the patient frame, in the room
  double scale = 1.0;             // of the patient's size; 1: as in life

  Vec3 toRoom_m(const Vec3& patient_mm) const {
    return origin_m + turn * (patient_mm * (1e-3 * scale));
  }
  Vec3 toPatient_mm(const Vec3& room_m) const {
    return (glm::conjugate(turn) * (room_m - origin_m)) * (1e3 / scale);
  }
  // Of an eye in the room: where it is in the patient, in mm.
  EyeView toPatient_mm(const EyeView& room_m) const;
};

// What of the patient is looked at, and from where: as the panel's camera has it.
struct Looked {
  Vec3 at_mm{0.0};
  Vec3 forward{0.0, 1.0, 0.0}, up{0.0, 0.0, 1.0};  // of length 1, at right angles
};

// Where a head looks, level, of length 1. Of one that looks straight down, where its top points.
Vec3 levelAhead(const Head& head_m);

// Before the trainee: what is looked at stands so far ahead of the eyes and so far above them
// (negative: below), and is seen from there as the panel's camera sees it, upright. The head's tilt
// counts for nothing, only which way it is turned.
RoomPlace before(const Eyes& eyes_m, const Looked& what, double ahead_m, double above_m,
                 double scale = 1.0);

// How an exercise maps an arm's frame into the patient: mm of the patient's are 1000 `travel` times
// the arm's metres, turned, from where the arm's origin lies.
struct ArmInPatient {
  Vec3 origin_mm{0.0};
  Quat turn{1.0, 0.0, 0.0, 0.0};  // arm axes to patient axes
  double travel = 1.0;            // of the tool, by the arm's
};
// Where the patient lies for the tool to be seen where the arm is felt.
RoomPlace where(const Pose& room_from_device_m, const ArmInPatient& arm);
// How far, then, an arm's tool is seen from where it is felt, at most, within 8 cm of its origin
// along its axes [mm].
double apart_mm(const RoomPlace& place, const Pose& room_from_device_m, const ArmInPatient& arm);

// An arm's frame in the room, from marks that its tip has touched.
struct Registration {
  Pose room_from_device_m;
  double marks_mm = 0.0;  // how far the marks are from the fit, root of the mean square
  double error_mm = 0.0;  // to be expected 10 cm from their middle, likewise
};
// At least three pairs. Errors: TOO_FEW_MARKS, BAD_MARKS (on one line, or not finite).
Result<Registration> registerArm(std::span<const Vec3> device_m, std::span<const Vec3> room_m);

}  // namespace trephine
