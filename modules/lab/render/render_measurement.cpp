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
  // What needs most of the machine's parts comes first: where one is missing, it is soon said.
  const Progress exercises(progress, 0.1, 0.2), picture(progress, 0.2, 0.25);
  if (Status done = measureExercises(*subjects, options, exercises, result); !done)
    return done.error();
  if (Status done = measureFirstPicture(options, out, picture, result); !done) return done.error();
  const Progress surface(progress, 0.25, 0.3), classes(progress, 0.3, 0.4);
  if (Status done = measureSurface(options, surface, result); !done) return done.error();
  if (Status done = measureClasses(*subjects, options, classes, result); !done) return done.error();
  const double share = 0.6 / double(subjects->size());
  double from = 0.4;
  for (const RenderSubject& subject : *subjects) {
    const Progress part(progress, from, from + share);
    if (subject.preset != "skin") {
      const Progress turning(part, 0.0, 0.1);
      if (Status done = measureRotation(subject, options, turning, result); !done) {
        return done.error();
      }
    }
    const Progress still(part, 0.1, 1.0);
    if (Status done = measureStills(subject, options, out, still, result); !done) {
      return done.error();
    }
    from += share;
  }
  if (Status done = writeTextFile(out / "render.csv", toCsv(result)); !done) return done.error();
  progress.at(1.0, "done");
  return result;
}

}  // namespace trephine
