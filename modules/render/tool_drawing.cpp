#include "render/tool_drawing.h"

#include <vtkActor.h>
#include <vtkBoundingBox.h>
#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkIncrementalOctreePointLocator.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/log.h"
#include "base/tr.h"

namespace trephine {

namespace {

constexpr double kBladeWidth_mm = 4.5;
constexpr double kBladeHalfThickness_mm = 0.3;
constexpr double kNeedleRadius_mm = 0.6;
constexpr double kNeedlePoint_mm = 4.0;
constexpr double kBurrRadius_mm = 3.0;
constexpr double kShaftRadius_mm = 1.2;  // of a burr, and less than its ball
constexpr double kHandleLength_mm = 70.0;
constexpr double kHandleRadius_mm = 3.5;
constexpr double kMarkRadius_mm = 1.6;
constexpr int kSides = 24;
constexpr double kFeatureAngle_deg = 32.0;
const Vec3 kMarkColour(1.0, 0.45, 0.1);
const Vec3 kSteel(0.66, 0.69, 0.73);

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

// A flat solid between x = -half and half through an outline in the y-z plane, which runs
// anticlockwise seen from x > 0.
void addFlat(const std::vector<glm::dvec2>& outline, double half, vtkPoints* points,
             vtkCellArray* faces) {
  const auto count = vtkIdType(outline.size());
  const vtkIdType first = points->GetNumberOfPoints();
  for (const double x : {-half, half}) {
    for (const glm::dvec2& yz : outline) points->InsertNextPoint(x, yz.x, yz.y);
  }
  std::vector<vtkIdType> back, front;
  for (vtkIdType i = 0; i < count; ++i) {
    back.push_back(first + count - 1 - i);
    front.push_back(first + count + i);
    const vtkIdType next = (i + 1) % count;
    const vtkIdType side[4] = {first + i, first + next, first + count + next, first + count + i};
    faces->InsertNextCell(4, side);
  }
  faces->InsertNextCell(count, back.data());
  faces->InsertNextCell(count, front.data());
}

// The edge runs along z from the tip; the back of the blade rises from the tip to its width.
void addBlade(double length, double half_thickness, vtkPoints* points, vtkCellArray* faces) {
  const double slope = std::min(3.0 * kBladeWidth_mm, 0.6 * length);
  addFlat({{0.0, 0.0},
           {0.7 * kBladeWidth_mm, 0.5 * slope},
           {kBladeWidth_mm, slope},
           {kBladeWidth_mm, length},
           {0.0, length}},
          half_thickness, points, faces);
}

// A neck and a flat handle with a rounded end, from this z on.
void addFlatHandle(double z, vtkPoints* points, vtkCellArray* faces) {
  constexpr double kHalf_mm = 2.0, kNeck_mm = 12.0, kWide_mm = 5.2;
  const double middle = kBladeWidth_mm / 2.0, end = z + kHandleLength_mm;
  addFlat({{middle - 1.6, z},
           {middle + 1.6, z},
           {middle + 2.2, z + 0.6 * kNeck_mm},
           {middle + kWide_mm, z + kNeck_mm + 6.0},
           {middle + kWide_mm, z + 32.0},
           {middle + 0.8 * kWide_mm, end - 4.0},
           {middle + 0.5 * kWide_mm, end},
           {middle - 0.5 * kWide_mm, end},
           {middle - 0.8 * kWide_mm, end - 4.0},
           {middle - kWide_mm, z + 32.0},
           {middle - kWide_mm, z + kNeck_mm + 6.0},
           {middle - 2.2, z + 0.6 * kNeck_mm}},
          kHalf_mm, points, faces);
}

// A ball, or a rod with round ends, whose far end is the tip, on a shaft.
std::vector<Ring> burr(double length, double radius, double head) {
  const double shaft = std::min(kShaftRadius_mm, 0.6 * radius);
  const double straight = isFinite(head) ? std::max(0.0, head - 2.0 * radius) : 0.0;
  std::vector<Ring> rings;
  for (int band = 0; band < kSides; ++band) {
    const double polar = std::numbers::pi * band / kSides;
    const double across = radius * std::sin(polar);
    const bool behind = 2 * band > kSides;
    if (behind && across < shaft) break;
    rings.push_back({radius * (1.0 - std::cos(polar)) + (behind ? straight : 0.0), across});
    if (straight > 0.0 && 2 * band == kSides) rings.push_back({radius + straight, radius});
  }
  rings.push_back({rings.back().z, shaft});
  rings.push_back({std::max(length, 2.0 * radius + straight), shaft});
  return rings;
}

struct BuiltIn {
  vtkNew<vtkPolyData> work, handle;  // the part that cuts, of steel; what the hand holds
};

BuiltIn builtIn(const ToolView& view) {
  struct Solid {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> faces;
    void into(vtkPolyData* solid) const {
      solid->SetPoints(points);
      solid->SetPolys(faces);
    }
  } work, handle;
  const bool known = isFinite(view.radius_mm) && view.radius_mm > 0.0;
  const auto radius = [&](double usual) { return known ? view.radius_mm : usual; };
  if (view.shape == ToolShape::blade) {
    addBlade(view.length_mm, radius(kBladeHalfThickness_mm), work.points, work.faces);
    addFlatHandle(view.length_mm, handle.points, handle.faces);
  } else if (view.shape == ToolShape::burr) {
    const std::vector<Ring> rings = burr(view.length_mm, radius(kBurrRadius_mm), view.head_mm);
    addRevolved(rings, work.points, work.faces);
    const double from = rings.back().z, end = from + kHandleLength_mm;
    addRevolved({{from, kHandleRadius_mm * 0.6},
                 {from + 6.0, kHandleRadius_mm},
                 {from + 9.0, 1.6 * kHandleRadius_mm},
                 {from + 24.0, 1.6 * kHandleRadius_mm},
                 {from + 30.0, 2.2 * kHandleRadius_mm},
                 {end - 3.0, 2.2 * kHandleRadius_mm},
                 {end, kHandleRadius_mm}},
                handle.points, handle.faces);
  } else {
    const double r = radius(kNeedleRadius_mm), point = std::min(kNeedlePoint_mm, view.length_mm);
    addRevolved({{0.0, 0.0}, {point, r}, {view.length_mm, r}}, work.points, work.faces);
    const double from = view.length_mm, end = from + kHandleLength_mm;
    // A hub, the barrel of a syringe with its rim, and the plunger.
    addRevolved({{from, 1.5},
                 {from + 7.0, 2.1},
                 {from + 7.6, 3.4},
                 {from + 11.0, 6.2},
                 {from + 47.0, 6.2},
                 {from + 47.3, 9.0},
                 {from + 49.5, 9.0},
                 {from + 49.8, 2.4},
                 {end - 2.5, 2.4},
                 {end - 2.3, 7.0},
                 {end, 7.0}},
                handle.points, handle.faces);
  }
  BuiltIn made;
  work.into(made.work);
  handle.into(made.handle);
  return made;
}

// What VTK does for normals grows with the square of the faces around a corner. Beyond this, as
// only damaged files have it, it would take seconds, and the mesh is shaded flat.
constexpr std::int64_t kMostPairsOfFaces = 500'000'000;

// Corners at one place become one, so that VTK knows which faces meet; it parts them again where
// the edge is to stay sharp.
vtkNew<vtkPolyData> withNormals(const ToolMesh& mesh) {
  vtkNew<vtkPoints> points;
  vtkBoundingBox box;
  for (const glm::vec3& p : mesh.corners) box.AddPoint(p.x, p.y, p.z);
  double bounds[6];
  box.GetBounds(bounds);
  // An octree, since a stray corner far off would put all others into one of a grid's cells.
  vtkNew<vtkIncrementalOctreePointLocator> places;
  places->SetTolerance(0.0);
  places->InitPointInsertion(points, bounds);
  vtkNew<vtkCellArray> faces;
  std::vector<std::int64_t> around(mesh.corners.size());
  std::int64_t pairs = 0;
  for (std::size_t i = 0; i + 2 < mesh.corners.size(); i += 3) {
    vtkIdType face[3];
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 p(mesh.corners[i + c]);
      places->InsertUniquePoint(&p.x, face[c]);
      pairs += around[std::size_t(face[c])]++;
    }
    // In floats, a thin triangle may lose its area where it was moved to.
    const bool thin = face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
    if (!thin) faces->InsertNextCell(3, face);
  }
  vtkNew<vtkPolyData> solid;
  solid->SetPoints(points);
  solid->SetPolys(faces);
  if (pairs > kMostPairsOfFaces) return solid;
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(solid);
  normals->SetFeatureAngle(kFeatureAngle_deg);
  normals->SplittingOn();
  normals->ConsistencyOff();  // the file's order of corners holds
  normals->Update();
  solid->ShallowCopy(normals->GetOutput());
  return solid;
}

// The triangles whose middle lies in front of (or behind) this z.
vtkNew<vtkPolyData> partOf(vtkPolyData* solid, double z, bool front) {
  vtkNew<vtkCellArray> faces;
  vtkNew<vtkIdList> face;
  for (vtkIdType i = 0; i < solid->GetNumberOfCells(); ++i) {
    solid->GetPolys()->GetCellAtId(i, face);
    double sum = 0.0;
    for (const vtkIdType corner : *face) sum += solid->GetPoint(corner)[2];
    if ((sum < 3.0 * z) == front) faces->InsertNextCell(face);
  }
  vtkNew<vtkPolyData> part;
  part->SetPoints(solid->GetPoints());
  part->SetPolys(faces);
  part->GetPointData()->SetNormals(solid->GetPointData()->GetNormals());
  return part;
}

bool drawable(const ToolView& tool) {
  return isFinite(tool.pose_mm) && isFinite(tool.length_mm) && tool.length_mm > 0.0 &&
         glm::length(tool.pose_mm.orientation) > 0.0;
}

// Numbers that are not finite count as alike, or they would be drawn anew at each frame.
template <class T>
bool alike(const T& a, const T& b) {
  return a == b || (!isFinite(a) && !isFinite(b));
}

bool sameSolid(const ToolView& a, const ToolView& b) {
  return a.length_mm == b.length_mm && a.shape == b.shape && alike(a.radius_mm, b.radius_mm) &&
         alike(a.head_mm, b.head_mm) && a.mesh_file == b.mesh_file &&
         alike(a.mesh_tip_mm, b.mesh_tip_mm) && alike(a.mesh_axis, b.mesh_axis);
}

// The same in contact, or the hands could not be told apart when it matters most.
void setColour(vtkActor* actor, const Vec3& colour) {
  actor->GetProperty()->SetColor(colour.x, colour.y, colour.z);
}

void setSolid(vtkActor* actor, vtkPolyData* solid) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(solid);
  actor->SetMapper(mapper);
}

}  // namespace

struct ToolDrawing::Tool {
  vtkNew<vtkActor> body;    // the working part, of steel
  vtkNew<vtkActor> handle;  // in the arm's colour
  vtkNew<vtkActor> mark;
  vtkNew<vtkMatrix4x4> place;
  std::optional<ToolView> solid;  // what the actors hold

  Tool() {
    for (vtkActor* actor : {body.Get(), handle.Get(), mark.Get()}) actor->SetUserMatrix(place);
    vtkProperty* steel = body->GetProperty();
    steel->SetAmbient(0.1);
    steel->SetDiffuse(0.68);
    steel->SetSpecular(0.6);
    steel->SetSpecularPower(40.0);
    handle->GetProperty()->SetAmbient(0.2);
    handle->GetProperty()->SetDiffuse(0.8);
    handle->GetProperty()->SetSpecular(0.25);
    handle->GetProperty()->SetSpecularPower(20.0);
    vtkNew<vtkSphereSource> sphere;
    sphere->SetRadius(kMarkRadius_mm);
    sphere->SetThetaResolution(kSides);
    sphere->SetPhiResolution(kSides);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(sphere->GetOutputPort());
    mark->SetMapper(mapper);
    mark->GetProperty()->SetAmbient(0.7);
    mark->GetProperty()->SetColor(kMarkColour.x, kMarkColour.y, kMarkColour.z);
  }

  void shape(const ToolView& view, const std::optional<ToolMesh>& mesh) {
    solid = view;
    if (mesh) {
      const vtkNew<vtkPolyData> whole = withNormals(*mesh);
      setSolid(body, partOf(whole, view.length_mm, true));
      setSolid(handle, partOf(whole, view.length_mm, false));
    } else {
      const BuiltIn made = builtIn(view);
      setSolid(body, made.work);
      setSolid(handle, made.handle);
    }
  }

  void update(const ToolView& view) {
    const Mat3 axes = glm::mat3_cast(glm::normalize(view.pose_mm.orientation));
    for (int row = 0; row < 3; ++row) {
      for (int axis = 0; axis < 3; ++axis) place->SetElement(row, axis, axes[axis][row]);
      place->SetElement(row, 3, view.pose_mm.position[row]);
    }
    place->Modified();
    setColour(body, glm::mix(kSteel, view.colour, 0.15));
    setColour(handle, view.colour);
  }

  void setVisible(bool shown, bool contact) {
    body->SetVisibility(shown);
    handle->SetVisibility(shown);
    mark->SetVisibility(shown && contact);
  }
};

ToolDrawing::ToolDrawing() = default;
ToolDrawing::~ToolDrawing() = default;

void ToolDrawing::warn(const ToolView& view, const Error& why) {
  if (!warned_.insert(view.mesh_file).second) return;
  // A log names neither folder nor file: a scene may lie beside a patient's scan.
  const char* tool = view.shape == ToolShape::needle  ? "the mesh of a needle"
                     : view.shape == ToolShape::blade ? "the mesh of a blade"
                                                      : "the mesh of a burr";
  const Error said{why.code, why.what, tool, why.next};
  spdlog::warn("{} The built-in shape is drawn instead.", said.sentence());
}

std::optional<ToolMesh> ToolDrawing::meshOf(const ToolView& view) {
  if (view.mesh_file.empty()) return std::nullopt;
  const auto [at, fresh] = meshes_.try_emplace(view.mesh_file);
  if (fresh) {
    Result<ToolMesh> mesh = readToolMesh(view.mesh_file);
    if (mesh) {
      at->second = std::move(*mesh);
    } else {
      warn(view, mesh.error());
    }
  }
  if (!at->second) return std::nullopt;
  Result<ToolMesh> placed = inToolFrame(*at->second, view.mesh_tip_mm, view.mesh_axis);
  if (placed) return std::move(*placed);
  warn(view, placed.error());
  return std::nullopt;
}

void ToolDrawing::show(const std::vector<ToolView>& tools, vtkRenderer& renderer) {
  while (tools_.size() < tools.size()) {
    tools_.push_back(std::make_unique<Tool>());
    renderer.AddActor(tools_.back()->body);
    renderer.AddActor(tools_.back()->handle);
    renderer.AddActor(tools_.back()->mark);
  }
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    Tool& tool = *tools_[i];
    const bool shown = i < tools.size() && drawable(tools[i]);
    if (shown) {
      const ToolView& view = tools[i];
      if (!tool.solid || !sameSolid(*tool.solid, view)) tool.shape(view, meshOf(view));
      tool.update(view);
    }
    tool.setVisible(shown, shown && tools[i].contact);
  }
}

std::vector<std::array<Vec3, 8>> ToolDrawing::boxes() const {
  std::vector<std::array<Vec3, 8>> boxes;
  for (const auto& tool : tools_) {
    vtkBoundingBox box;  // in the tool's frame
    for (vtkActor* actor : {tool->body.Get(), tool->handle.Get(), tool->mark.Get()}) {
      if (actor->GetVisibility()) box.AddBounds(actor->GetMapper()->GetBounds());
    }
    if (!box.IsValid()) continue;
    std::array<Vec3, 8> corners;
    for (int i = 0; i < 8; ++i) {
      double corner[4], placed[4];
      box.GetCorner(i, corner);
      corner[3] = 1.0;
      tool->place->MultiplyPoint(corner, placed);
      corners[std::size_t(i)] = Vec3(placed[0], placed[1], placed[2]);
    }
    boxes.push_back(corners);
  }
  return boxes;
}

}  // namespace trephine
