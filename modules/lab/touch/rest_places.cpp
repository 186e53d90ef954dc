#include "lab/touch/rest_places.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lab/touch/placed_exercise.h"

namespace trephine {

namespace {

constexpr double kFrom_mm = 60.0;  // above a landmark: outside the patient
constexpr double kReach_mm = 100.0;
constexpr double kSwing_m = 0.004;

std::string label(const char* tissue, double aside_mm, double press_mm, const Impedance& hand) {
  return std::string(tissue) + (aside_mm > 0.0 ? " aside" : "") + ", pressed " +
         plainNumber(press_mm) + " mm by " + plainNumber(hand.stiffness) + " N/m";
}

HoldCell cellOf(const std::string& name, const PlacedExercise& placed,
                const std::shared_ptr<const Volume>& volume, const Impedance& hand) {
  HoldCell cell;
  cell.exercise = name;
  cell.parameters = withoutMotors(hapticParameters(placed.exercise, placed.rig));
  cell.volume = volume;
  cell.labels = placed.labels;
  for (std::size_t i = 0; i < placed.exercise.arms.size(); ++i) {
    cell.arms.push_back(placed.exercise.arms[i].name);
    cell.tools.push_back(placed.exercise.arms[i].tool);
    cell.rig.push_back(rigArmOf(cell.parameters.arms[i].dynamics, hand));
  }
  return cell;
}

// From outside to `depth_mm` below the start, along the landmark's own axis, in device axes.
HoldPath pathOf(const PlacedExercise& placed, std::size_t arm, const Vec3& start_mm, double depth_mm) {
  const WorkspaceMap map = placed.exercise.arms[arm].map.fixed.value_or(WorkspaceMap{});
  const LandmarkFrame& frame = placed.frames[arm];
  HoldPath path;
  path.start_m = map.toDevice_m(frame.toPatient_mm(start_mm));
  path.held_m = map.toDevice_m(frame.toPatient_mm(start_mm - Vec3(0.0, 0.0, depth_mm)));
  path.swing_m = kSwing_m * glm::normalize(path.held_m - path.start_m);
  return path;
}

void addExercise(const std::string& name, const PlacedExercise& placed, std::vector<HoldCell>& cells) {
  const std::shared_ptr<const Volume>& volume = placed.volume;
  const TissueTable table = tissueTable(placed.exercise.tissues);
  // At the devices' origins, in the window's hand.
  HoldCell origins = cellOf(name, placed, volume, {4.0, 600.0});
  origins.place = "at the device's origin";
  for (std::size_t arm = 0; arm < placed.exercise.arms.size(); ++arm) {
    const Vec3 at_mm = placed.exercise.arms[arm].map.offset_mm;
    origins.paths.push_back(pathOf(placed, arm, {at_mm.x, at_mm.y, kFrom_mm}, kFrom_mm - at_mm.z));
  }
  cells.push_back(std::move(origins));
  for (std::size_t t = 0; t < placed.exercise.tissues.tissues.size(); ++t) {
    for (double aside_mm : {0.0, 7.0}) {
      for (double press_mm : {0.5, 2.0}) {
        for (const Impedance& hand : {Impedance{2.0, 300.0}, {4.0, 600.0}, {10.0, 1000.0}}) {
          HoldCell cell = cellOf(name, placed, volume, hand);
          cell.place = label(placed.exercise.tissues.tissues[t].id.c_str(), aside_mm, press_mm, hand);
          for (std::size_t arm = 0; arm < placed.exercise.arms.size(); ++arm) {
            const ExerciseMap& map = placed.exercise.arms[arm].map;
            const Vec3 start_mm(map.offset_mm.x + aside_mm, map.offset_mm.y - aside_mm, kFrom_mm);
            const LandmarkFrame& frame = placed.frames[arm];
            const auto depth_mm =
                depthOf(*placed.volume, table, int(t), frame.toPatient_mm(start_mm),
                        frame.rotation * Vec3(0.0, 0.0, -1.0), kReach_mm, placed.labels.get());
            if (!depth_mm) break;
            // The press is the hand's own: at the device, whatever its motion is scaled by.
            cell.paths.push_back(
                pathOf(placed, arm, start_mm, *depth_mm + press_mm * map.motion_scale));
          }
          if (cell.paths.size() == placed.exercise.arms.size()) cells.push_back(std::move(cell));
        }
      }
    }
  }
}

struct NamedArm {
  const char* name;
  ArmDynamics dynamics;
};
const NamedArm kArms[] = {{"omni", {0.045, 0.055e-3, 3.3, 0}},
                          {"20 g", {0.020, 0.055e-3, 3.3, 0}},
                          {"coarse", {0.045, 0.110e-3, 3.3, 0}}};  // half the stiffness of an Omni
const std::pair<const char*, std::vector<LawKind>> kSums[] = {
    {"viscous", {LawKind::viscous}},
    {"viscous, coulomb", {LawKind::viscous, LawKind::coulomb}},
    {"viscous, coulomb, elastic", {LawKind::viscous, LawKind::coulomb, LawKind::elastic}},
    {"viscous, coulomb, elastic, rupture",
     {LawKind::viscous, LawKind::coulomb, LawKind::elastic, LawKind::rupture}}};

// 24 mm of one tissue below the plane through the origin, and air above it.
std::shared_ptr<const Volume> blockOf(const Tissue& tissue) {
  Volume volume;
  volume.geometry.size = {32, 32, 48};
  volume.geometry.origin_mm = Vec3(-15.5, -15.5, -23.5);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  const auto hu = std::int16_t((tissue.hu_min + std::min(tissue.hu_max, 1000)) / 2);
  std::fill_n(volume.hu.begin(), std::ptrdiff_t(32 * 32 * 24), hu);
  return std::make_shared<const Volume>(std::move(volume));
}

// All of it is of the tissue's structure; null: the tissue is of none.
std::shared_ptr<const LabelMap> labelsOf(const Tissue& tissue, const GridGeometry& geometry) {
  if (!tissue.label) return nullptr;
  return std::make_shared<const LabelMap>(LabelMap{
      geometry,
      std::vector<std::uint8_t>(geometry.voxelCount(), std::uint8_t(*tissue.label))});
}

// Each tissue of the exercise's set under each of its tools, by each sum of laws and each arm.
void addBlocks(const Exercise& exercise, const std::vector<const ExerciseTool*>& tools,
               std::vector<HoldCell>& cells) {
  for (const Tissue& tissue : exercise.tissues.tissues) {
    const auto volume = blockOf(tissue);
    const auto labels = labelsOf(tissue, volume->geometry);
    for (const ExerciseTool* tool : tools) {
      for (const auto& [sum, laws] : kSums) {
        for (const NamedArm& arm : kArms) {
          HoldCell cell;
          cell.exercise = std::string("block of ") + tissue.id;
          cell.place = sum;
          cell.arms = {arm.name};
          cell.tools = {tool->id};
          cell.volume = volume;
          cell.labels = labels;
          cell.parameters = withoutMotors(hapticParameters(exercise));
          cell.parameters.laws = laws;
          cell.parameters.arms = {{withoutMotor(tool->tool), WorkspaceMap{}, 3.3, arm.dynamics}};
          cell.rig = {rigArmOf(arm.dynamics, {4.0, 600.0})};
          cell.paths = {{Vec3(0.0, 0.0, 0.01), Vec3(0.0, 0.0, -0.002), Vec3(0.0, 0.0, -kSwing_m)}};
          cells.push_back(cell);
          // Of a map that scales the force, what differs is how firm it is at the arm.
          if (&arm != &kArms[0] || laws.size() != 3) continue;
          for (const double scale : {10.0, 100.0}) {
            HoldCell scaled = cell;
            scaled.exercise = std::string("scaled block of ") + tissue.id;
            scaled.place += ", force by " + plainNumber(scale);
            scaled.parameters.arms[0].map.force_scale = scale;
            scaled.kinds = {HoldKind::edge};  // it slides where a scale makes it weak
            cells.push_back(std::move(scaled));
          }
        }
      }
    }
  }
}

// Bone with an edge, a corner, a ridge 2 mm wide, or a comb with teeth of 1.5 mm, below the plane
// through the origin.
enum class Shape { edge, corner, ridge, comb };
const std::pair<const char*, Shape> kShapes[] = {{"edge", Shape::edge},
                                                 {"corner", Shape::corner},
                                                 {"ridge", Shape::ridge},
                                                 {"comb", Shape::comb}};
constexpr double kRidge_mm = 2.0, kTooth_mm = 1.5, kTeeth_mm = 6.0;

bool holds(Shape shape, const Vec3& mm) {
  switch (shape) {
    case Shape::edge:
      return mm.x < 0.0;
    case Shape::corner:
      return mm.x < 0.0 && mm.y < 0.0;
    case Shape::ridge:
      return std::abs(mm.x) < 0.5 * kRidge_mm;
    case Shape::comb:
      return mm.z < -kTeeth_mm || std::fmod(mm.x + 100.0 * kTooth_mm, 2.0 * kTooth_mm) < kTooth_mm;
  }
  return false;
}

std::shared_ptr<const Volume> shapeOf(Shape shape) {
  constexpr double kSpacing_mm = 0.8;
  Volume volume;
  GridGeometry& g = volume.geometry;
  g.size = {48, 48, 48};
  g.spacing_mm = Vec3(kSpacing_mm);
  g.origin_mm = Vec3(-0.5 * kSpacing_mm * 47);
  volume.hu.assign(g.voxelCount(), kAirHu);
  for (std::size_t n = 0; n < volume.hu.size(); ++n) {
    const Index3 v = g.indicesOf(n);
    const Vec3 mm = g.origin_mm + kSpacing_mm * Vec3(v[0], v[1], v[2]);
    if (mm.z < 0.0 && holds(shape, mm)) volume.hu[n] = 1000;
  }
  return std::make_shared<const Volume>(std::move(volume));
}

// Each tool, its motor off, on each of these shapes, at places across the edge and beside it,
// pressed with 0.3 and 1 N by a hand that is light, one that is usual and one that is firm: what
// friction, proxy and controller do there.
void addShapes(const Exercise& exercise, const std::vector<const ExerciseTool*>& tools,
               std::vector<HoldCell>& cells) {
  const auto bone = std::ranges::find(exercise.tissues.tissues, true, &Tissue::solid);
  if (bone == exercise.tissues.tissues.end()) return;
  Exercise of_bone = exercise;
  of_bone.tissues.tissues = {*bone};
  for (const auto& [name, shape] : kShapes) {
    const auto volume = shapeOf(shape);
    for (const ExerciseTool* tool : tools) {
      for (const Impedance& hand : {Impedance{1.0, 50.0}, {2.0, 300.0}, {4.0, 600.0}}) {
        for (const double press_N : {0.3, 1.0}) {
          for (const double beside_mm : {-1.0, -0.3, 0.0, 0.3, 1.0}) {
            const NamedArm& arm = kArms[0];
            HoldCell cell;
            cell.exercise = std::string(name) + " of " + bone->id;
            cell.place = plainNumber(beside_mm) + " mm beside it, pressed with " +
                         plainNumber(press_N) + " N by " + plainNumber(hand.stiffness) + " N/m";
            cell.arms = {arm.name};
            cell.tools = {tool->id};
            cell.volume = volume;
            cell.parameters = withoutMotors(hapticParameters(of_bone));
            cell.parameters.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
            cell.parameters.arms = {{withoutMotor(tool->tool), WorkspaceMap{}, 3.3, arm.dynamics}};
            cell.rig = {rigArmOf(arm.dynamics, hand)};
            cell.kinds = {HoldKind::edge};  // it would slip off where it was moved
            const Vec3 above_m(0.001 * beside_mm, 0.0003, 0.012);
            const Vec3 held_m(above_m.x, above_m.y, -press_N / hand.stiffness);
            cell.paths = {{above_m, held_m, Vec3(0.0, 0.0, -kSwing_m)}};
            cells.push_back(std::move(cell));
          }
        }
      }
    }
  }
}

}  // namespace

Result<std::vector<HoldCell>> restPlaces(const Progress& progress) {
  std::vector<HoldCell> cells;
  std::vector<Exercise> exercises;
  for (const std::string& name : shippedExercises()) {
    progress.at(double(exercises.size()) / double(shippedExercises().size()), name);
    Result<PlacedExercise> placed = placeExercise(name, "", progress);
    if (!placed) return placed.error();
    addExercise(name, *placed, cells);
    exercises.push_back(placed->exercise);
  }
  // Every tool that any shipped exercise has, on every tissue that any has.
  std::vector<const ExerciseTool*> tools;
  std::vector<const Exercise*> sets;
  for (const Exercise& exercise : exercises) {
    for (const ExerciseTool& tool : exercise.tools) {
      const bool known = std::any_of(tools.begin(), tools.end(), [&](const ExerciseTool* t) {
        return t->tool.made_from == tool.tool.made_from;
      });
      if (!known) tools.push_back(&tool);
    }
    const bool known = std::any_of(sets.begin(), sets.end(), [&](const Exercise* s) {
      return s->tissues.name == exercise.tissues.name;
    });
    if (!known) sets.push_back(&exercise);
  }
  for (const Exercise* exercise : sets) addBlocks(*exercise, tools, cells);
  if (!sets.empty()) addShapes(*sets.front(), tools, cells);
  return cells;
}

}  // namespace trephine
