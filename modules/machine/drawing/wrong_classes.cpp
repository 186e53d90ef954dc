// What tissue a pixel shows, against the phantoms' truth.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/codes.h"
#include "base/tr.h"
#include "machine/common/on_all_processors.h"
#include "machine/drawing/drawing_parts.h"
#include "render/view_camera.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

// What a label map of the abdomen tells, and no more. A liver with a label is liver whatever its
// HU.
struct Organ {
  PhantomTissue truth;
  const char* id;
  int label;
};
constexpr std::array<Organ, 3> kOrgans{{{PhantomTissue::liver, "liver", 1},
                                        {PhantomTissue::capsule, "capsule", 2},
                                        {PhantomTissue::vessel, "vessel", 3}}};
constexpr int kLeastLabelled_HU = -200, kMostLabelled_HU = 3071;

// Membranes under two voxels: a CT of these phantoms does not hold them.
constexpr std::array<const char*, 2> kMembranes{"dura", "capsule"};

// Corners of the cube of colours: whatever mixture of two a picture holds, the nearer of the two is
// also the nearest of all. Black is nothing.
constexpr std::array<std::array<int, 3>, 7> kCorners{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}};

struct ClassSubject {
  std::string name;
  PhantomTruth truth;
  std::shared_ptr<const Volume> volume;
  std::shared_ptr<const LabelMap> labels;
  TissueSet tissues;         // as measured: visible ones in colours of their own
  std::vector<int> visible;  // the tissue of each corner
  TissueTable table;
};

int labelOf(PhantomTissue tissue) {
  for (const Organ& organ : kOrgans) {
    if (organ.truth == tissue) return organ.label;
  }
  return 0;
}

TissueSet labelled(TissueSet tissues) {
  for (Tissue& tissue : tissues.tissues) {
    tissue.label.reset();
    for (const Organ& organ : kOrgans) {
      if (tissue.id != organ.id) continue;
      tissue.label = organ.label;
      tissue.hu_min = kLeastLabelled_HU;
      tissue.hu_max = kMostLabelled_HU;
    }
  }
  return tissues;
}

Status colourApart(ClassSubject& subject) {
  for (std::size_t n = 0; n < subject.tissues.tissues.size(); ++n) {
    Tissue& tissue = subject.tissues.tissues[n];
    if (std::find(kMembranes.begin(), kMembranes.end(), tissue.id) != kMembranes.end()) {
      tissue.opacity = 0.0;
    }
    if (tissue.opacity == 0.0) continue;
    if (subject.visible.size() == kCorners.size()) {
      return Error{code::kBadArgument, tr("No more than 7 visible tissues can be told apart"),
                   subject.name, ""};
    }
    const auto& corner = kCorners[subject.visible.size()];
    tissue.colour = Vec3(corner[0], corner[1], corner[2]);
    subject.visible.push_back(int(n));
  }
  subject.table = tissueTable(subject.tissues);
  return {};
}

// -1: none.
int shownAt(const Picture& picture, int x, int y, const ClassSubject& subject) {
  const std::uint8_t* rgb =
      picture.rgb.data() + 3 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
  for (std::size_t n = 0; n < subject.visible.size(); ++n) {
    bool here = true;
    for (std::size_t c = 0; c < 3; ++c) here = here && (rgb[c] > 127) == (kCorners[n][c] == 1);
    if (here) return subject.visible[n];
  }
  return -1;
}

// The first tissue along a ray that the set shows, of the truth.
int truthAlong(const ClassSubject& subject, const Vec3& eye, const Vec3& ray) {
  const GridGeometry& g = subject.volume->geometry;
  // Between the faces of the volume, whose axes are the patient's.
  double from = 0.0, to = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = g.origin_mm[axis];
    const double high = low + (g.size[std::size_t(axis)] - 1) * g.spacing_mm[axis];
    const double towards = std::abs(ray[axis]) < 1e-9 ? 1e-9 : ray[axis];
    const double a = (low - eye[axis]) / towards, b = (high - eye[axis]) / towards;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  const double step = 0.25 * std::min({g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z});
  for (double t = from; t <= to; t += step) {
    const PhantomTissue tissue = subject.truth(eye + t * ray);
    if (tissue == PhantomTissue::air) continue;
    const int found =
        classify(subject.table, phantomHu(tissue), subject.labels ? labelOf(tissue) : 0);
    if (found >= 0 && subject.tissues.tissues[std::size_t(found)].opacity > 0.0) return found;
  }
  return -1;
}

struct Count {
  int wrong = 0, counted = 0;
};

// One picture from one direction.
Count countWrong(const ClassSubject& subject, const Picture& picture, const SceneRenderer& renderer,
                 int step) {
  const GridGeometry& g = subject.volume->geometry;
  const Vec3 right = renderer.viewRight(), up = renderer.viewUp();
  const Vec3 focus = g.centre_mm();
  const double mm = renderer.mmPerPixelAt(focus);
  const double distance =
      mm * picture.height / (2.0 * std::tan(glm::radians(0.5 * ViewCamera::kViewAngle_deg)));
  const Vec3 eye = focus - distance * renderer.viewForward();
  const double sideways_mm = std::max({g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z});
  const std::size_t rows = std::size_t((picture.height - 1) / step + 1);
  std::vector<Count> counts(rows);
  const auto row = [&](std::size_t n) {
    const int y = int(n) * step;
    for (int x = 0; x < picture.width; x += step) {
      const Vec3 offset = right * ((x + 0.5 - 0.5 * picture.width) * mm) -
                          up * ((y + 0.5 - 0.5 * picture.height) * mm);
      const Vec3 ray = glm::normalize(focus + offset - eye);
      const int shown = shownAt(picture, x, y, subject);
      const int truth = truthAlong(subject, eye, ray);
      if (shown < 0 && truth < 0) continue;
      ++counts[n].counted;
      bool found = shown == truth;
      for (int turn = 0; turn < 8 && !found; ++turn) {
        const double angle = turn * std::acos(-1.0) / 4.0;
        const Vec3 aside = (right * std::cos(angle) + up * std::sin(angle)) * sideways_mm;
        found = shown == truthAlong(subject, eye + aside, ray);
      }
      counts[n].wrong += !found;
    }
  };
  onAllProcessors(rows, "truth", Progress(), row);
  Count all;
  for (const Count& count : counts) {
    all.wrong += count.wrong;
    all.counted += count.counted;
  }
  return all;
}

// From six directions; nothing once cancelled.
std::optional<double> percentWrong(const ClassSubject& subject, SceneRenderer& renderer, int step,
                                   const Progress& progress) {
  constexpr std::array<Vec3, 6> directions{Vec3(1, 0, 0),  Vec3(-1, 0, 0), Vec3(0, 1, 0),
                                           Vec3(0, -1, 0), Vec3(0, 0, 1),  Vec3(0, 0, -1)};
  Count all;
  for (std::size_t n = 0; n < directions.size(); ++n) {
    if (progress.cancelled()) return std::nullopt;
    progress.at(double(n) / double(directions.size()), tr("{}, tissues", subject.name));
    const Vec3 up = std::abs(directions[n].z) > 0.5 ? Vec3(0, -1, 0) : Vec3(0, 0, 1);
    renderer.resetCamera(directions[n], up);
    const Count count = countWrong(subject, renderer.picture(), renderer, step);
    all.wrong += count.wrong;
    all.counted += count.counted;
  }
  return 100.0 * all.wrong / std::max(1, all.counted);
}

Result<std::unique_ptr<SceneRenderer>> rendererOf(const ClassSubject& subject, int edge) {
  auto made = SceneRenderer::offscreen(edge, edge);
  if (!made) return made;
  (*made)->setTissues(subject.tissues);
  (*made)->setVolume(Grid(Volume(*subject.volume), subject.labels));
  UploadProbe::setFirstTissue(**made, true);
  return made;
}

// A picture of tissues is never VTK's own, but without our rule it holds each sample's by its HU,
// as VTK's does.
ShadingOptions byHuWherePlain(bool plain) {
  return {true, !plain};
}

Result<ClassSubject> subjectOf(const std::string& name, std::shared_ptr<const Volume> volume) {
  ClassSubject subject;
  subject.name = phantomSource(name);
  const Result<PhantomTruth> truth = phantomTruth(name);
  if (!truth) return truth.error();
  subject.truth = *truth;
  subject.volume = std::move(volume);
  Result<TissueSet> tissues = shippedTissues(name);
  if (!tissues) return tissues.error();
  subject.tissues = byHuAlone(*std::move(tissues));
  return subject;
}

std::shared_ptr<const LabelMap> organLabels(const ClassSubject& subject) {
  const GridGeometry& g = subject.volume->geometry;
  auto map = std::make_shared<LabelMap>();
  map->geometry = g;
  map->labels.resize(g.voxelCount());
  onAllProcessors(std::size_t(g.size[2]), "labels", Progress(), [&](std::size_t k) {
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i) {
        map->labels[g.indexOf(i, j, int(k))] =
            std::uint8_t(labelOf(subject.truth(g.toPatient_mm(Vec3(i, j, double(k))))));
      }
    }
  });
  return map;
}

}  // namespace

Result<std::vector<double>> wrongClassPercent(const std::string& name,
                                              std::shared_ptr<const Volume> volume, bool by_label,
                                              const std::vector<RaySetting>& settings, int edge,
                                              int step, const Progress& progress) {
  auto subject = subjectOf(name, std::move(volume));
  if (!subject) return subject.error();
  if (by_label) {
    subject->tissues = labelled(subject->tissues);
    subject->labels = organLabels(*subject);
  }
  if (Status apart = colourApart(*subject); !apart) return apart.error();
  auto made = rendererOf(*subject, edge);
  if (!made) return made.error();
  std::vector<double> percents;
  const double share = 1.0 / double(settings.size());
  for (const RaySetting& setting : settings) {
    const double from = share * double(percents.size());
    (*made)->setSampleDistance(setting.distance_voxels);
    (*made)->setShading(byHuWherePlain(setting.plain));
    const auto percent =
        percentWrong(*subject, **made, step, Progress(progress, from, from + share));
    if (!percent) return drawingCancelled();
    percents.push_back(*percent);
  }
  return percents;
}

}  // namespace trephine
