#include "render/tool_drawing.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trephine {

namespace {

constexpr double kBladeWidth_mm = 3.0;
constexpr double kBladeThickness_mm = 0.6;
constexpr double kNeedleRadius_mm = 0.6;
constexpr double kNeedlePoint_mm = 4.0;
constexpr double kHandleLength_mm = 70.0;
constexpr double kHandleRadius_mm = 3.5;
constexpr double kMarkRadius_mm = 1.6;
constexpr int kSides = 24;
const Vec3 kMarkColour(1.0, 0.45, 0.1);

// A ring of a solid of revolution about z.
struct Ring {
  double z;
  double radius;
};

// Appends the solid through these rings, closed at both ends. A radius of 0 makes a point.
void addRevolved(const std::vector<Ring>& rings, vtkPoints* points, vtkCellArray* faces) {
  const vtkIdType first = points->GetNumberOfPoints();
  for (const Ring& ring : rings) {
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2.0 * std::numbers::pi * side / kSides;
      points->InsertNextPoint(ring.radius * std::cos(angle), ring.radius * std::sin(angle), ring.z);
    }
  }
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    for (int side = 0; side < kSides; ++side) {
      const vtkIdType a = first + vtkIdType(r) * kSides + side;
      const vtkIdType b = first + vtkIdType(r) * kSides + (side + 1) % kSides;
      const vtkIdType face[4] = {a, b, b + kSides, a + kSides};
      faces->InsertNextCell(4, face);
    }
  }
  vtkIdType cap[kSides];
  for (int side = 0; side < kSides; ++side) cap[side] = first + kSides - 1 - side;
  faces->InsertNextCell(kSides, cap);
  const vtkIdType last = first + vtkIdType(rings.size() - 1) * kSides;
  for (int side = 0; side < kSides; ++side) cap[side] = last + side;
  faces->InsertNextCell(kSides, cap);
}

// A flat bar in the y-z plane, its end ground to an edge at the tip.
void addBlade(double length, vtkPoints* points, vtkCellArray* faces) {
  const double half_width = kBladeWidth_mm / 2.0, half_thickness = kBladeThickness_mm / 2.0;
  const double bevel = std::min(3.0, length / 3.0);
  const double outline[5][2] = {{0.0, 0.0},
                                {half_width, bevel},
                                {half_width, length},
                                {-half_width, length},
                                {-half_width, bevel}};
  const vtkIdType first = points->GetNumberOfPoints();
  for (const double x : {-half_thickness, half_thickness}) {
    for (const auto& [y, z] : outline) points->InsertNextPoint(x, y, z);
  }
  vtkIdType back[5], front[5];
  for (vtkIdType i = 0; i < 5; ++i) {
    back[i] = first + 4 - i;
    front[i] = first + 5 + i;
    const vtkIdType next = (i + 1) % 5;
    const vtkIdType side[4] = {first + i, first + next, first + 5 + next, first + 5 + i};
    faces->InsertNextCell(4, side);
  }
  faces->InsertNextCell(5, back);
  faces->InsertNextCell(5, front);
}

bool drawable(const ToolView& tool) {
  return isFinite(tool.pose_mm) && isFinite(tool.length_mm) && tool.length_mm > 0.0 &&
         glm::length(tool.pose_mm.orientation) > 0.0;
}

}  // namespace

struct ToolDrawing::Tool {
  vtkNew<vtkActor> body;
  vtkNew<vtkActor> mark;
  vtkNew<vtkMatrix4x4> place;
  double length_mm = -1.0;
  bool blade = false;

  Tool() {
    body->SetUserMatrix(place);
    body->GetProperty()->SetAmbient(0.25);
    body->GetProperty()->SetDiffuse(0.8);
    body->GetProperty()->SetSpecular(0.4);
    body->GetProperty()->SetSpecularPower(30.0);
    vtkNew<vtkSphereSource> sphere;
    sphere->SetRadius(kMarkRadius_mm);
    sphere->SetThetaResolution(kSides);
    sphere->SetPhiResolution(kSides);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(sphere->GetOutputPort());
    mark->SetMapper(mapper);
    mark->SetUserMatrix(place);
    mark->GetProperty()->SetAmbient(0.7);
    mark->GetProperty()->SetColor(kMarkColour.x, kMarkColour.y, kMarkColour.z);
  }

  void shape(const ToolView& view) {
    if (view.length_mm == length_mm && view.blade == blade) return;
    length_mm = view.length_mm;
    blade = view.blade;
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> faces;
    if (blade) {
      addBlade(length_mm, points, faces);
    } else {
      const double point = std::min(kNeedlePoint_mm, length_mm);
      addRevolved({{0.0, 0.0}, {point, kNeedleRadius_mm}, {length_mm, kNeedleRadius_mm}}, points,
                  faces);
    }
    const double end = length_mm + kHandleLength_mm;
    addRevolved({{length_mm, kHandleRadius_mm * 0.6},
                 {length_mm + 6.0, kHandleRadius_mm},
                 {end - 3.0, kHandleRadius_mm},
                 {end, kHandleRadius_mm * 0.7}},
                points, faces);
    vtkNew<vtkPolyData> solid;
    solid->SetPoints(points);
    solid->SetPolys(faces);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(solid);
    body->SetMapper(mapper);
  }

  void update(const ToolView& view) {
    shape(view);
    const Mat3 axes = glm::mat3_cast(glm::normalize(view.pose_mm.orientation));
    for (int row = 0; row < 3; ++row) {
      for (int axis = 0; axis < 3; ++axis) place->SetElement(row, axis, axes[axis][row]);
      place->SetElement(row, 3, view.pose_mm.position[row]);
    }
    place->Modified();
    const Vec3 colour = view.contact ? glm::mix(view.colour, kMarkColour, 0.45) : Vec3(view.colour);
    body->GetProperty()->SetColor(colour.x, colour.y, colour.z);
    mark->SetVisibility(view.contact);
  }
};

ToolDrawing::ToolDrawing() = default;
ToolDrawing::~ToolDrawing() = default;

void ToolDrawing::show(const std::vector<ToolView>& tools, vtkRenderer& renderer) {
  while (tools_.size() < tools.size()) {
    tools_.push_back(std::make_unique<Tool>());
    renderer.AddActor(tools_.back()->body);
    renderer.AddActor(tools_.back()->mark);
  }
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const bool shown = i < tools.size() && drawable(tools[i]);
    tools_[i]->body->SetVisibility(shown);
    tools_[i]->mark->SetVisibility(shown);
    if (shown) tools_[i]->update(tools[i]);
  }
}

}  // namespace trephine
