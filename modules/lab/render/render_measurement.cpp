#include "lab/render/render_measurement.h"

#include <algorithm>

#include "base/file.h"
#include "lab/render/render_parts.h"

namespace trephine {

namespace {

Status check(const RenderOptions& options) {
  const auto bad = [](const char* what, const char* where) {
    return Error{"BAD_ARGUMENT", what, where, ""};
  };
  if (options.sample_distances.empty()) {
    return bad("There must be a sample distance", "sample_distances");
  }
  for (const double distance : options.sample_distances) {
    if (!(distance >= 0.1 && distance <= 8.0)) {
      return bad("Samples lie 0.1 to 8 voxels apart", "sample_distances");
    }
  }
  if (options.repeats < 1 || options.repeats > 100)
    return bad("There are 1 to 100 repeats", "repeats");
  for (const auto& size : {options.still, options.moving}) {
    if (std::min(size[0], size[1]) < 16 || std::max(size[0], size[1]) > 8192) {
      return bad("A picture has 16 to 8192 pixels along an edge", "size");
    }
  }
  return {};
}

}  // namespace

Result<RenderMeasurement> measureRender(const RenderOptions& options,
                                        const std::filesystem::path& out,
                                        const Progress& progress) {
  if (Status good = check(options); !good) return good.error();
  if (auto display = SceneRenderer::offscreen(16, 16); !display) return display.error();
  if (Status made = makeFolder(out); !made) return made.error();
  RenderMeasurement result;
  const auto subjects = renderSubjects(options.case_source, Progress(progress, 0.0, 0.1));
  if (!subjects) return subjects.error();
  const double share = 0.5 / double(subjects->size());
  double from = 0.1;
  for (const RenderSubject& subject : *subjects) {
    const Progress part(progress, from, from + share);
    if (Status done = measureStills(subject, options, out, part, result); !done)
      return done.error();
    from += share;
  }
  for (const RenderSubject& subject : *subjects) {
    if (subject.preset == "skin") continue;
    const Progress part(progress, from, from + 0.02);
    if (Status done = measureRotation(subject, options, part, result); !done) return done.error();
    from += 0.02;
  }
  using Part = Status (*)(const RenderOptions&, const Progress&, RenderMeasurement&);
  for (const Part part : {measureSurface, measureClasses, measureExercises}) {
    const Progress its(progress, from, from + 0.08);
    if (Status done = part(options, its, result); !done) return done.error();
    from += 0.08;
  }
  const Progress last(progress, from, 1.0);
  if (Status done = measureFirstPicture(options, out, last, result); !done) return done.error();
  if (Status done = writeTextFile(out / "render.csv", toCsv(result)); !done) return done.error();
  progress.at(1.0, "done");
  return result;
}

}  // namespace trephine
