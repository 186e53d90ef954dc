// The numbers of exercises and tools, a row each: files both ways, their ranges and the tables of
// the schema pages come from them.
//
// To add one: a member with its default in exercise.h, landmark.h, exercise_tool.h or a parameter
// type of haptics, its row here or there, and what uses it. In a list of its own it also needs a
// line in exerciseNumbersPage().
#pragma once

#include <string>

#include "base/number_row.h"
#include "exercise/exercise.h"

namespace trephine {

// Wider than any exercise needs, and narrow enough that all that follows from them is finite.
constexpr Range kBoxFraction{-10, 10};
constexpr Range kBulkRadius_mm{3, 300, "mm"};
constexpr Range kRun_mm{0.01, 300, "mm"};
constexpr Range kPlace_mm{-10'000, 10'000, "mm"};
constexpr Range kOffset_mm{-1000, 1000, "mm"};
constexpr Range kRate_hz{100, 20'000, "Hz"};
constexpr Range kViewDistance_mm{10, 5000, "mm"};
constexpr Range kOutlineWidth_mm{0.2, 10, "mm"};
constexpr Range kTip_mm{-10'000, 10'000, "mm"};

inline constexpr NumberOf<Exercise> kExerciseNumbers[] = {
    {{"rate_hz", kRate_hz, Given::may_be, "of the tick; no more than the devices keep"},
     &Exercise::rate_hz},
};
inline constexpr NumberOf<ExerciseView> kViewNumbers[] = {
    {{"distance_mm", kViewDistance_mm, Given::may_be, "of the eye from the landmark"},
     &ExerciseView::distance_mm},
};

inline constexpr NumberOf<ExerciseOutline> kOutlineNumbers[] = {
    {{"width_mm", kOutlineWidth_mm, Given::may_be, "of the line"}, &ExerciseOutline::width_mm},
};
inline constexpr NumberOf<LandmarkFrame> kOutlineFrameNumbers[] = {
    {{"centre_mm", kMapPlace_mm, Given::always, "where the landmark was when the line was drawn"},
     &LandmarkFrame::position_mm},
};

inline constexpr NumberOf<Landmark> kRayNumbers[] = {
    {{"from", kBoxFraction, Given::always,
      "where the ray begins, in fractions of the box that holds the tissue"},
     &Landmark::from},
    {{"towards", kBoxFraction, Given::always, "where it goes, likewise"}, &Landmark::towards},
};
inline constexpr NumberOf<Landmark> kBulkNumbers[] = {
    {{"bulk_radius_mm", kBulkRadius_mm, Given::always,
      "the ray goes to the place with most of the tissue within this radius"},
     &Landmark::bulk_radius_mm},
};
inline constexpr NumberOf<Landmark> kPlaceNumbers[] = {
    {{"at_mm", kPlace_mm, Given::always, "the place itself, in the patient's LPS frame"},
     &Landmark::at_mm},
};
inline constexpr NumberOf<Landmark> kLandmarkNumbers[] = {
    {{"run_mm", kRun_mm, Given::may_be, "how long the ray must stay in the tissue"},
     &Landmark::run_mm},
};

inline constexpr NumberOf<ArmDevice> kDeviceNumbers[] = {
    {{"arm", {0, kMaxArmsOfAPlugin - 1}, Given::may_be, "place in the plugin's list"},
     &ArmDevice::place},
};
inline constexpr NumberOf<ExerciseArm> kArmNumbers[] = {
    {{"max_force_N", kPeakForce_N, Given::may_be, "sent at most; never more than the device gives"},
     &ExerciseArm::max_force_N},
};
// Of a map at a landmark; kWorkspaceMapNumbers are those of one that is fixed in the patient.
inline constexpr NumberOf<ExerciseMap> kExerciseMapNumbers[] = {
    {{"offset_mm", kOffset_mm, Given::may_be, "of the device's origin, landmark axes"},
     &ExerciseMap::offset_mm},
    {{"motion_scale", kMapScale, Given::may_be, "the tool's travel by the arm's"},
     &ExerciseMap::motion_scale},
    {{"force_scale", kMapScale, Given::may_be, "the arm's force by the tissue's"},
     &ExerciseMap::force_scale},
};

// The rotation of a fixed map for people: the device turned about the patient's axes, LPS, first
// about x, then y, then z.
struct MapTurn {
  Vec3 turned_deg{0.0};
};
inline constexpr NumberOf<MapTurn> kMapTurnNumbers[] = {
    {{"turned_deg", {-180, 180, "\u00b0"}, Given::always, "about the patient's x, then y, then z"},
     &MapTurn::turned_deg},
};
// Where y is 90 degrees away from none, x and z turn about one axis, and z is 0.
MapTurn turnOf(const Quat& rotation);
Quat rotationOf(const MapTurn& turn);

inline constexpr NumberOf<ToolDescription> kToolNumbers[] = {
    {{"length_mm", kToolLength_mm, Given::always,
      "from the tip to the handle; of a blade, its edge; of a burr, at least its head"},
     &ToolDescription::length_mm},
    {{"points", kToolPoints, Given::may_be,
      "how many points touch: along a needle or blade (a needle of one point touches with its tip, "
      "a blade of one point is its tip), on a burr's shell (there 64)"},
     &ToolDescription::points},
    {{"radius_mm", kToolRadius_mm, Given::may_be,
      "of the solid that cuts: half the width of a slot or hole"},
     &ToolDescription::radius_mm},
    {{"motor_W", kToolMotor_W, Given::may_be,
      "work that the motor does on tissue; 0: driven by hand, and a burr then cuts nothing where "
      "the scene has a barrier"},
     &ToolDescription::motor_W},
};
inline constexpr NumberOf<ToolDescription> kBurrNumbers[] = {
    {{"radius_mm", kToolRadius_mm, Given::always, "of its head"}, &ToolDescription::radius_mm},
    {{"shaft_points", kToolShaftPoints, Given::may_be,
      "how many points of the shaft touch; they do not cut"},
     &ToolDescription::shaft_points},
};
inline constexpr NumberOf<ToolDescription> kCylinderNumbers[] = {
    {{"head_mm", kToolLength_mm, Given::always, "length of its head: at least twice the radius"},
     &ToolDescription::head_mm},
};
inline constexpr NumberOf<ToolLook> kLookNumbers[] = {
    {{"tip_mm", kTip_mm, Given::may_be, "the tip, in the mesh's frame"}, &ToolLook::tip_mm},
};

// `rotation_wxyz`, a unit quaternion.
Quat readRotation(JsonReader& item);

// The tables of resources/schemas/scene.md and tool.md.
std::string exerciseNumbersPage();
std::string toolNumbersPage();

}  // namespace trephine
