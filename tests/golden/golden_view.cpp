#include "golden_view.h"

#include <algorithm>
#include <cmath>

#include "case/codes.h"
#include "golden_cases.h"
#include "render/scene_renderer.h"
#include "ui/views/slice_view.h"

namespace trephine::test {

namespace {

constexpr int kWidth = 320, kHeight = 240;

Volume without(const std::string& tissue, const Exercise& exercise, const Placement& of) {
  Volume volume = *of.patient.volume;
  TissueLookup lookup;
  lookup.set(tissueTable(exercise.tissues));
  for (std::size_t i = 0; i < volume.hu.size(); ++i) {
    const int c = lookup.classOf(volume.hu[i], of.labels ? of.labels->labels[i] : 0);
    if (c >= 0 && exercise.tissues.tissues[std::size_t(c)].id == tissue) volume.hu[i] = kAirHu;
  }
  return volume;
}

const LandmarkFrame* landmarkOf(const GoldenCase& shown) {
  for (const PlacedLandmark& landmark : shown.of.landmarks) {
    if (landmark.id == shown.exercise.view.landmark) return &landmark.frame;
  }
  return nullptr;
}

// As an exercise cuts: by a writer of a grid that is shown already.
void carve(Grid& grid, const LandmarkFrame& at, double radius_mm, double depth_mm) {
  auto writer = grid.takeWriter();
  const GridGeometry& g = grid.geometry();
  for (std::size_t index = 0; index < g.voxelCount(); ++index) {
    const Index3 v = g.indicesOf(index);
    const Vec3 in =
        glm::conjugate(at.rotation) * (g.toPatient_mm(Vec3(v[0], v[1], v[2])) - at.position_mm);
    const Vec3 off = in - Vec3(0.0, 0.0, std::clamp(in.z, radius_mm - depth_mm, 10.0));
    if (glm::length(off) < radius_mm) writer->store(index, kAirHu);
  }
}

Result<Picture> drawnVolume(const GoldenLine& line, const GoldenCase& shown, Volume volume,
                            Change change) {
  Result<std::unique_ptr<SceneRenderer>> made = SceneRenderer::offscreen(kWidth, kHeight);
  if (!made) return made.error();
  SceneRenderer& renderer = **made;
  TissueLooks looks = shown.exercise.view.looks;
  if (line.preset) {
    const auto preset = presetLooks(shown.exercise.tissues, *line.preset);
    if (!preset) return Error{Code("NO_PRESET"), "The scene has no such preset", line.name, ""};
    looks = *preset;
  }
  renderer.setTissues(shown.exercise.tissues, looks);
  Grid grid(std::move(volume), shown.of.labels);
  renderer.setVolume(grid);
  const LandmarkFrame* landmark = landmarkOf(shown);
  if (line.side || !landmark) {
    renderer.resetCamera(Vec3(0, 1, 0), Vec3(0, 0, 1));
    if (line.side) {  // as near as from the front
      const ViewCamera::Direction from = ViewCamera::from(*line.side);
      const ViewCamera& camera = renderer.camera();
      renderer.lookAt(camera.focus(), from.forward, from.up, camera.distance_mm());
    }
  } else {
    renderer.lookAt(landmark->position_mm, landmark->viewDirection(), landmark->viewUp(),
                    shown.exercise.view.distance_mm);
  }
  renderer.orbit(line.orbit_deg[0] + (change == Change::view ? 12.0 : 0.0), line.orbit_deg[1]);
  renderer.zoom(line.zoom);
  if (line.outline && change != Change::colours) {
    const ExerciseOutline& outline = *shown.exercise.outline;
    renderer.setOutline(outlineOn(shown.exercise, shown.of.landmarks, *shown.of.patient.volume),
                        outline.closed, outline.width_mm);
  }
  if (change == Change::driver) renderer.setSampleDistance(0.9 * SceneRenderer::kSampleDistance);
  if (line.carved_mm[0] > 0.0) {
    if (!landmark) return Error{code::kNoLandmark, "There is no place for the hole", line.name, ""};
    renderer.picture();
    carve(grid, *landmark, line.carved_mm[0], line.carved_mm[1]);
    renderer.pullChanges(grid);
  }
  return renderer.picture();
}

Picture drawnSlice(const GoldenLine& line, const GoldenCase& shown, Volume volume, Change change) {
  SliceColours colours;
  const std::size_t next = (line.window + 1) % kWindowPresets.size();
  colours.setWindow(kWindowPresets[change == Change::window ? next : line.window].window);
  colours.setTissues(shown.exercise.tissues);
  colours.setOverlay(change == Change::colours ? Overlay::none : line.overlay, 0.5);
  const auto mirror = std::make_shared<VolumeMirror>();
  mirror->show(std::move(volume), shown.of.labels);
  Toolbox toolbox;
  SliceView view(*line.slice, mirror, colours, toolbox);
  if (change == Change::driver) view.setFont(QFont("DejaVu Serif"));
  view.resize(kWidth, kHeight);
  view.takeChanges();
  const Vec3 across = view.stack().direction[2] * (change == Change::view ? 12.0 : 0.0);
  view.setPoint(line.at_mm + across);
  view.zoomAt(QRectF(view.rect()).center(), line.zoom);
  return pictureOf(view.grab().toImage());
}

}  // namespace

Result<Picture> drawn(const GoldenLine& line, Change change) {
  const Result<GoldenCase> shown = goldenCase(line);
  if (!shown) return shown.error();
  Volume volume = change == Change::tissue ? without(line.shows, shown->exercise, shown->of)
                                           : Volume(*shown->of.patient.volume);
  if (line.slice) return drawnSlice(line, *shown, std::move(volume), change);
  return drawnVolume(line, *shown, std::move(volume), change);
}

double likeness(const Picture& a, const Picture& b) {
  double least = 1.0;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const auto grey = [&](Picture picture) {
      for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
        picture.rgb[i] = picture.rgb[i - i % 3 + channel];
      }
      return picture;
    };
    least = std::min(least, ssim(grey(a), grey(b)));
  }
  return least;
}

Picture pictureOf(const QImage& image) {
  const QImage rgb = image.convertToFormat(QImage::Format_RGB888);
  Picture picture{rgb.width(), rgb.height(), {}};
  for (int y = 0; y < rgb.height(); ++y) {
    const uchar* row = rgb.constScanLine(y);
    picture.rgb.insert(picture.rgb.end(), row, row + rgb.width() * 3);
  }
  return picture;
}

Picture mirrored(const Picture& picture) {
  Picture out = picture;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const auto at = [&](int column) {
        return 3 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(column));
      };
      std::copy_n(picture.rgb.data() + at(picture.width - 1 - x), 3, out.rgb.data() + at(x));
    }
  }
  return out;
}

}  // namespace trephine::test
