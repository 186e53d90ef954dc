#include "render/orientation_cue.h"

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <vector>

namespace trephine {

namespace {

using Stroke = std::vector<glm::dvec2>;

// Letters as strokes in a box of -1..1, y up.
struct Letter {
  Vec3 direction;  // patient frame, LPS
  std::vector<Stroke> strokes;
};

const std::vector<Letter>& letters() {
  static const std::vector<Letter> all = {
      {{1, 0, 0}, {{{-0.6, 1}, {-0.6, -1}, {0.6, -1}}}},
      {{-1, 0, 0},
       {{{-0.6, -1}, {-0.6, 1}, {0.3, 1}, {0.6, 0.7}, {0.6, 0.3}, {0.3, 0}, {-0.6, 0}},
        {{0, 0}, {0.6, -1}}}},
      {{0, -1, 0}, {{{-0.7, -1}, {0, 1}, {0.7, -1}}, {{-0.4, -0.3}, {0.4, -0.3}}}},
      {{0, 1, 0}, {{{-0.6, -1}, {-0.6, 1}, {0.3, 1}, {0.6, 0.7}, {0.6, 0.3}, {0.3, 0}, {-0.6, 0}}}},
      {{0, 0, 1},
       {{{0.6, 0.7},
         {0.3, 1},
         {-0.3, 1},
         {-0.6, 0.7},
         {-0.6, 0.3},
         {-0.3, 0},
         {0.3, 0},
         {0.6, -0.3},
         {0.6, -0.7},
         {0.3, -1},
         {-0.3, -1},
         {-0.6, -0.7}}}},
      {{0, 0, -1}, {{{0, -1}, {0, 1}}, {{-0.4, 1}, {0.4, 1}}, {{-0.4, -1}, {0.4, -1}}}},
  };
  return all;
}

}  // namespace

struct OrientationCue::Parts {
  vtkNew<vtkActor2D> actor;
  vtkNew<vtkPolyData> lines;
};

OrientationCue::OrientationCue(vtkRenderer& renderer) : parts_(std::make_unique<Parts>()) {
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(parts_->lines);
  parts_->actor->SetMapper(mapper);
  parts_->actor->GetProperty()->SetLineWidth(1.5F);
  renderer.AddActor2D(parts_->actor);
}

OrientationCue::~OrientationCue() = default;

void OrientationCue::update(const Vec3& right, const Vec3& up, const Vec3& forward, int width,
                            int height) {
  const bool room = std::min(width, height) >= 240;
  parts_->actor->SetVisibility(room);
  if (!room) return;
  const double radius = std::clamp(0.05 * height, 22.0, 60.0);
  const double letter_size = 0.17 * radius;
  const glm::dvec2 centre(1.7 * radius, 1.7 * radius);

  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  const auto addStroke = [&](const Stroke& stroke, unsigned char shade) {
    cells->InsertNextCell(int(stroke.size()));
    for (const glm::dvec2& p : stroke) cells->InsertCellPoint(points->InsertNextPoint(p.x, p.y, 0));
    const unsigned char grey[3] = {shade, shade, shade};
    colours->InsertNextTypedTuple(grey);
  };
  for (const Letter& letter : letters()) {
    const glm::dvec2 way(glm::dot(letter.direction, right), glm::dot(letter.direction, up));
    // What points away from the eye is dimmer.
    const double away = glm::dot(letter.direction, forward);
    const auto shade = static_cast<unsigned char>(std::clamp(185.0 - 65.0 * away, 0.0, 255.0));
    addStroke({centre, centre + way * radius}, static_cast<unsigned char>(shade / 2));
    const glm::dvec2 at = centre + way * (radius + 1.9 * letter_size);
    if (glm::length(way) < 0.2) continue;  // seen end on: it would lie on the cross
    for (const Stroke& stroke : letter.strokes) {
      Stroke placed;
      for (const glm::dvec2& p : stroke) placed.push_back(at + p * letter_size);
      addStroke(placed, shade);
    }
  }
  parts_->lines->SetPoints(points);
  parts_->lines->SetLines(cells);
  parts_->lines->GetCellData()->SetScalars(colours);
}

}  // namespace trephine
