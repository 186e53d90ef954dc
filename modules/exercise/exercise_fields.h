// The settings of exercises and tools, a row each: files both ways, their ranges, their place on a
// form and the tables of the schema pages come from them.
//
// To add one: a member with its default in exercise.h, landmark.h, exercise_tool.h or a parameter
// type of haptics, its row here or there, and what uses it. In a list of its own it also needs a
// line in exerciseFieldsPage().
#pragma once

#include <string>

#include "base/field.h"
#include "base/tr.h"
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

// How long a name may be in a form.
constexpr Range kNameLetters{1, 80}, kIdLetters{1, 40};

inline constexpr FieldOf<Exercise> kExerciseFields[] = {
    {{"name", kNameLetters, Given::always, "shown", "",
      trLater("As it stands in the list of exercises.")},
     &Exercise::name},
    {{"anatomy",
      {},
      Given::always,
      trLater("`cranium` or `abdomen`: which cases it fits"),
      trLater("For"),
      trLater("On a case of another part of the body it asks before it starts.")},
     ReferenceIn<Exercise>{&Exercise::anatomy}},
    {{"structures",
      {},
      Given::may_be,
      trLater(
          "names of the structures that the exercise needs. Where the case lacks one, and its "
          "tissues "
          "name another set for `elsewhere`, that is used and a warning says so (LACKS_STRUCTURE); "
          "without such a set the scene is refused (NO_STRUCTURE). Of one by which no tissue is "
          "told "
          "a warning says that it is lacking"),
      trLater("Needs"),
      trLater("A case that lacks one is helped to it first.")},
     ReferencesIn<Exercise>{&Exercise::structures}},
};
inline constexpr FieldOf<Exercise> kTouchFields[] = {
    {{"laws",
      {},
      Given::always,
      trLater(
          "of the force on the arm (`modules/haptics/README.md`); with `elastic` solid tissue is a "
          "barrier, without it a tool is where its arm is")},
     someOf<&Exercise::laws, kLawNames>()},
    {{"controller",
      {},
      Given::always,
      trLater("what keeps the force steady (`modules/haptics/README.md`)"),
      "Control",
      "",
      "controller"},
     oneOf<&Exercise::controller, kControllerNames>()},
    {{"force_at",
      {},
      Given::may_be,
      trLater("`tip`: as if at the tip, in the firmest tissue touched; `distributed`: along the "
              "tool, each "
              "point with its own tissue and velocity"),
      trLater("Force at"),
      trLater("The tip in the firmest tissue, or along the tool, each point in its own.")},
     oneOf<&Exercise::force_at, kForceAtNames>()},
    {{"removal",
      {},
      Given::may_be,
      trLater("`work`: as much as the work of hand and motor pays for; `instant`: whatever the "
              "tool meets"),
      "",
      trLater("As much as the work of hand and motor pays for, or all that is met.")},
     oneOf<&Exercise::removal, kRemovalNames>()},
    {{"rate_hz", kRate_hz, Given::may_be, trLater("of the tick; no more than the devices keep"), "",
      "", "rate"},
     &Exercise::rate_hz},
};
// Of the exercises that follow the seed paper alone: on a form only where an exercise names it.
inline constexpr FieldOf<Exercise> kPointsFields[] = {
    {{"touch_by_points",
      {1, double(kMaxTissues)},
      Given::may_be,
      trLater(
          "the seed paper's own rule of touch, with the ids of the tissues that push: a point of a "
          "tool touches where the voxel that it lies in is of one of them, and that voxel goes at "
          "once; nothing touches while the tip is outside of the case's voxels. Each id is one of "
          "the set, and of the one for elsewhere where there is one. Only with no other law than "
          "`viscous`, with `force_at` `tip` and `removal` `instant`. Without it a tool touches all "
          "tissues, by its points and its solid (`modules/haptics/README.md`)"),
      trLater("Touched by points"),
      trLater("These tissues alone push and go, each voxel that a point of a tool lies in.")},
     ReferencesIn<Exercise>{&Exercise::touch_by_points}},
};
inline constexpr FieldOf<Exercise> kLockFields[] = {
    {{"locks",
      {},
      Given::may_be,
      trLater("what is not changed while this exercise is practised; the workstation may lock more "
              "(`settings.md`)"),
      trLater("What stays"),
      trLater("What a trainee may not change while the exercise is practised.")},
     someOf<&Exercise::locks, kLockNames>()},
};
inline constexpr FieldOf<ExerciseView> kViewFields[] = {
    {{"landmark",
      {},
      Given::may_be,
      trLater("looked at from outside; without one, the whole case from the front"),
      trLater("Look at"),
      trLater("Where the camera begins.")},
     ReferenceIn<ExerciseView>{&ExerciseView::landmark}},
    {{"distance_mm", kViewDistance_mm, Given::may_be, trLater("of the eye from the landmark")},
     &ExerciseView::distance_mm},
};

// Of a language.
inline constexpr FieldOf<CardText> kCardFields[] = {
    {{"goal",
      {1, 0},
      Given::always,
      trLater("at most 300 characters"),
      "",
      trLater("What is to be reached."),
      "",
      0.0,
      -1,
      "",
      1.0,
      4},
     &CardText::goal},
    {{"steps",
      {1, double(kCardSteps)},
      Given::always,
      trLater("1 to 12 texts of at most 200 characters"),
      "",
      trLater("One a line, in their order.")},
     &CardText::steps},
    {{"hands",
      {1, 0},
      Given::always,
      trLater("which tool in which hand and how to move it, at most 300 characters"),
      "",
      trLater("Which tool in which hand, and how to move it."),
      "",
      0.0,
      -1,
      "",
      1.0,
      3},
     &CardText::hands},
};

inline constexpr FieldOf<ExerciseOutline> kOutlineFields[] = {
    {{"closed",
      {},
      Given::may_be,
      trLater("the last point is joined to the first"),
      "",
      trLater("The last point is joined to the first.")},
     &ExerciseOutline::closed},
    {{"width_mm", kOutlineWidth_mm, Given::may_be, trLater("of the line")},
     &ExerciseOutline::width_mm},
};
inline constexpr FieldOf<LandmarkFrame> kOutlineFrameFields[] = {
    {{"centre_mm", kMapPlace_mm, Given::always,
      trLater("where the landmark was when the line was drawn")},
     &LandmarkFrame::position_mm},
};

inline bool isRay(const Landmark& of) { return !of.is_place && !(of.bulk_radius_mm > 0.0); }
inline bool isBulk(const Landmark& of) { return !of.is_place && of.bulk_radius_mm > 0.0; }
inline constexpr FieldOf<Landmark> kLandmarkFields[] = {
    {{"id", kIdLetters, Given::always, trLater("by it arms and view name the landmark"),
      trLater("Called"), trLater("By this name arms and view have it.")},
     &Landmark::id},
    {{"tissue",
      {},
      Given::always,
      trLater("the id of the tissue that its ray meets first"),
      "On",
      trLater("The tissue that its ray meets first.")},
     ReferenceIn<Landmark>{&Landmark::tissue}},
    {{"from", kBoxFraction, Given::always,
      trLater("where the ray begins, in fractions of the box that holds the tissue")},
     &Landmark::from,
     {"landmark, ray", isRay}},
    {{"towards", kBoxFraction, Given::always, trLater("where it goes, likewise")},
     &Landmark::towards,
     {"landmark, ray", isRay}},
    {{"bulk_radius_mm", kBulkRadius_mm, Given::always,
      trLater("the ray goes to the place with most of the tissue within this radius")},
     &Landmark::bulk_radius_mm,
     {"landmark, organ", isBulk}},
    {{"at_mm", kPlace_mm, Given::always, trLater("the place itself, in the patient's LPS frame")},
     &Landmark::at_mm,
     {"landmark, place", [](const Landmark& of) { return of.is_place; }}},
    {{"outward",
      {-1, 1},
      Given::always,
      trLater("the patient's direction from which the ray comes; its length from 0.001 to 1000"),
      "",
      trLater("Out of the patient: left, back, up.")},
     DirectionIn<Landmark>{&Landmark::outward},
     {trLater("landmark, organ or place"), [](const Landmark& of) { return !isRay(of); }}},
    {{"run_mm", kRun_mm, Given::may_be, trLater("how long the ray must stay in the tissue")},
     &Landmark::run_mm},
};

inline constexpr FieldOf<ArmDevice> kDeviceFields[] = {
    {{"arm", {0, kMaxArmsOfAPlugin - 1}, Given::may_be, trLater("place in the plugin's list")},
     &ArmDevice::place},
};
inline constexpr FieldOf<ExerciseArm> kArmFields[] = {
    {{"name", kIdLetters, Given::always,
      trLater("`left` and `right` are those that the workstation has devices for"),
      trLater("Called"), trLater("Left and right are the hands that people have.")},
     &ExerciseArm::name},
    {{"tool",
      {},
      Given::always,
      trLater("the id of the one in hand at first"),
      trLater("In hand"),
      trLater("What it holds at first.")},
     ReferenceIn<ExerciseArm>{&ExerciseArm::tool}},
    {{"other_tools",
      {0, double(kMostTools - 1)},
      Given::may_be,
      trLater(
          "ids of at most 3 further tools that it may be given while the exercise runs, each once"),
      trLater("Others"),
      trLater("What may be taken meanwhile (Ctrl+T).")},
     ReferencesIn<ExerciseArm>{&ExerciseArm::other_tools}},
    {{"max_force_N", kPeakForce_N, Given::may_be,
      trLater("sent at most; never more than the device gives")},
     &ExerciseArm::max_force_N},
};
// Of a map at a landmark; kWorkspaceMapFields are those of one that is fixed in the patient.
inline bool isAtLandmark(const ExerciseMap& map) { return !map.fixed; }
inline constexpr FieldOf<ExerciseMap> kExerciseMapFields[] = {
    {{"landmark",
      {},
      Given::always,
      trLater("the id of the landmark that it goes with"),
      "",
      trLater("The place that it goes with, on any patient; or none, in this one.")},
     ReferenceIn<ExerciseMap>{&ExerciseMap::landmark}},
    {{"offset_mm", kOffset_mm, Given::may_be, trLater("of the device's origin, landmark axes")},
     &ExerciseMap::offset_mm,
     {"", isAtLandmark}},
    {{"motion_scale", kMapScale, Given::may_be, trLater("the tool's travel by the arm's")},
     &ExerciseMap::motion_scale,
     {"", isAtLandmark}},
    {{"force_scale", kMapScale, Given::may_be, trLater("the arm's force by the tissue's")},
     &ExerciseMap::force_scale,
     {"", isAtLandmark}},
};

// The rotation of a fixed map for people: the device turned about the patient's axes, LPS, first
// about x, then y, then z.
struct MapTurn {
  Vec3 turned_deg{0.0};
};
inline constexpr FieldOf<MapTurn> kMapTurnFields[] = {
    {{"turned_deg",
      {-180, 180, "\u00b0"},
      Given::always,
      trLater("about the patient's x, then y, then z")},
     &MapTurn::turned_deg},
};
// Where y is 90 degrees away from none, x and z turn about one axis, and z is 0.
MapTurn turnOf(const Quat& rotation);
Quat rotationOf(const MapTurn& turn);

inline bool isBurr(const ToolDescription& of) { return of.kind == ToolKind::burr; }
inline bool isNoBurr(const ToolDescription& of) { return !isBurr(of); }
inline constexpr FieldOf<ToolDescription> kToolFields[] = {
    {{"kind",
      {},
      Given::always,
      trLater("a needle punctures, a blade slices, a burr grinds"),
      "",
      trLater("A needle punctures, a blade slices, a burr grinds.")},
     oneOf<&ToolDescription::kind, kToolNames>()},
    {{"shape",
      {},
      Given::may_be,
      trLater("of the burr's head: a ball, or a rod with round ends"),
      "",
      trLater("A ball, or a rod with round ends.")},
     oneOf<&ToolDescription::shape, kShapeNames>(),
     {"burr", isBurr}},
    {{"length_mm", kToolLength_mm, Given::always,
      trLater("from the tip to the handle; of a blade, its edge; of a burr, at least its head")},
     &ToolDescription::length_mm},
    {{"points", kToolPoints, Given::may_be,
      trLater("how many points touch: along a needle or blade (a needle of one point touches with "
              "its tip, "
              "a blade of one point is its tip), on a burr's shell (there 64)")},
     &ToolDescription::points},
    {{"radius_mm", kToolRadius_mm, Given::may_be,
      trLater("of the solid that cuts: half the width of a slot or hole")},
     &ToolDescription::radius_mm,
     {"needle, blade", isNoBurr}},
    {{"radius_mm", kToolRadius_mm, Given::always, trLater("of its head")},
     &ToolDescription::radius_mm,
     {"burr", isBurr}},
    {{"motor_W", kToolMotor_W, Given::may_be,
      trLater("work that the motor does on tissue; 0: driven by hand, and a burr then cuts nothing "
              "where "
              "the scene has a barrier")},
     &ToolDescription::motor_W},
    {{"shaft_points", kToolShaftPoints, Given::may_be,
      trLater("how many points of the shaft touch; they do not cut")},
     &ToolDescription::shaft_points,
     {"burr", isBurr}},
    {{"head_mm", kToolLength_mm, Given::always,
      trLater("length of its head: at least twice the radius")},
     &ToolDescription::head_mm,
     {"cylinder",
      [](const ToolDescription& of) { return isBurr(of) && of.shape == BurrShape::cylinder; }}},
};
// Of an exercise's tool alone.
inline constexpr FieldOf<ExerciseTool> kToolIdFields[] = {
    {{"id", kIdLetters, Given::always, trLater("by it the arms name the tool"), trLater("Name"),
      trLater("By it the arms name the tool.")},
     &ExerciseTool::id},
};
inline constexpr FieldOf<ToolLook> kLookFields[] = {
    {{"tip_mm", kTip_mm, Given::may_be, trLater("the tip, in the mesh's frame")},
     &ToolLook::tip_mm},
    {{"axis",
      {-1, 1},
      Given::may_be,
      trLater("from the tip to the handle, in the mesh's frame; its length from 0.001 to 1000")},
     DirectionIn<ToolLook>{&ToolLook::axis}},
};

// `rotation_wxyz`, a unit quaternion.
Quat readRotation(JsonReader& item);

// The tables of resources/schemas/scene.md and tool.md.
std::string exerciseFieldsPage();
std::string toolFieldsPage();

}  // namespace trephine
