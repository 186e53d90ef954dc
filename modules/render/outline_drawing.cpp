#include "render/outline_drawing.h"

#include <vtkActor.h>
#include <vtkBoundingBox.h>
#include <vtkCellArray.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTubeFilter.h>

#include <algorithm>

namespace trephine {

namespace {

constexpr int kSides = 12;
constexpr double kNearest_mm = 1e-3;  // points that are nearer to each other are one
const Vec3 kColour(0.05, 0.86, 0.93);
const Vec3 kRimColour(0.03, 0.09, 0.12);

// A third of the width on each side.
double rimOf(double width_mm) {
  return width_mm / 3.0;
}

// A round tube, open or closed upon itself.
vtkNew<vtkPolyData> tube(const std::vector<Vec3>& points_mm, bool closed, double radius_mm) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  const vtkIdType count = vtkIdType(points_mm.size());
  lines->InsertNextCell(int(count) + closed);
  for (vtkIdType i = 0; i < count; ++i) {
    points->InsertNextPoint(&points_mm[std::size_t(i)].x);
    lines->InsertCellPoint(i);
  }
  if (closed) lines->InsertCellPoint(0);
  vtkNew<vtkPolyData> line;
  line->SetPoints(points);
  line->SetLines(lines);
  vtkNew<vtkTubeFilter> around;
  around->SetInputData(line);
  around->SetRadius(radius_mm);
  around->SetNumberOfSides(kSides);
  around->SetCapping(!closed);
  around->Update();
  vtkNew<vtkPolyData> made;
  made->ShallowCopy(around->GetOutput());
  return made;
}

// Without those that lie on the one before, which a tube cannot be drawn through.
std::vector<Vec3> different(const std::vector<Vec3>& points_mm, bool closed) {
  std::vector<Vec3> out;
  for (const Vec3& p : points_mm) {
    if (out.empty() || glm::distance(out.back(), p) > kNearest_mm) out.push_back(p);
  }
  while (closed && out.size() > 1 && glm::distance(out.front(), out.back()) <= kNearest_mm) {
    out.pop_back();
  }
  return out;
}

}  // namespace

struct OutlineDrawing::Parts {
  vtkNew<vtkActor> line, rim;
  vtkNew<vtkMatrix4x4> line_place, rim_place;
  vtkRenderer* in = nullptr;
  vtkBoundingBox box;  // of the rim, as it lies
  double width_mm = 0.0;

  Parts() {
    line->SetUserMatrix(line_place);
    rim->SetUserMatrix(rim_place);
    for (const auto& [actor, colour] : {std::pair(line.Get(), kColour), {rim.Get(), kRimColour}}) {
      actor->GetProperty()->LightingOff();
      actor->GetProperty()->SetColor(colour.x, colour.y, colour.z);
      actor->VisibilityOff();
    }
  }

  void setTube(vtkActor* actor, const std::vector<Vec3>& points, bool closed, double radius_mm) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(tube(points, closed, radius_mm));
    actor->SetMapper(mapper);
    actor->VisibilityOn();
  }
};

OutlineDrawing::OutlineDrawing() : parts_(std::make_unique<Parts>()) {}
OutlineDrawing::~OutlineDrawing() = default;

void OutlineDrawing::show(const std::vector<Vec3>& points_mm, bool closed, double width_mm,
                          vtkRenderer& renderer) {
  Parts& p = *parts_;
  if (!p.in) {
    p.in = &renderer;
    renderer.AddActor(p.rim);
    renderer.AddActor(p.line);
  }
  for (vtkActor* actor : {p.line.Get(), p.rim.Get()}) actor->VisibilityOff();
  p.box.Reset();
  const bool finite = isFinite(width_mm) &&
                      std::ranges::all_of(points_mm, [](const Vec3& v) { return isFinite(v); });
  if (!finite || !(width_mm > 0.0)) return;
  const std::vector<Vec3> points = different(points_mm, closed);
  if (points.size() < 2) return;
  const bool ring = closed && points.size() > 2;
  p.width_mm = width_mm;
  p.setTube(p.line, points, ring, 0.5 * width_mm);
  p.setTube(p.rim, points, ring, 0.5 * width_mm + rimOf(width_mm));
  p.box.SetBounds(p.rim->GetMapper()->GetBounds());
}

// Towards the eye, so that each point stays in its pixel: in perspective by making all of it
// smaller around the eye. The line comes more than its rim, which it would lie within.
void OutlineDrawing::lift(const ViewCamera& camera) {
  Parts& p = *parts_;
  if (!p.box.IsValid()) return;
  Vec3 middle;
  p.box.GetCenter(&middle.x);
  const Vec3 eye = camera.eye();
  const double depth_mm = std::max(1.0, glm::dot(middle - eye, camera.forward()));
  const auto place = [&](vtkMatrix4x4* matrix, double by_mm) {
    const double scale = camera.parallel() ? 1.0 : std::max(0.5, 1.0 - by_mm / depth_mm);
    const Vec3 shift = camera.parallel() ? -by_mm * camera.forward() : (1.0 - scale) * eye;
    for (int row = 0; row < 3; ++row) {
      matrix->SetElement(row, row, scale);
      matrix->SetElement(row, 3, shift[row]);
    }
    matrix->Modified();
  };
  place(p.rim_place, kLift_mm);
  place(p.line_place, kLift_mm + 2.0 * rimOf(p.width_mm));
}

std::optional<std::array<Vec3, 8>> OutlineDrawing::box() const {
  if (!parts_->box.IsValid()) return {};
  std::array<Vec3, 8> corners;
  for (int i = 0; i < 8; ++i) parts_->box.GetCorner(i, &corners[std::size_t(i)].x);
  return corners;
}

}  // namespace trephine
