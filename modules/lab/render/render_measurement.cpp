#include "lab/render/render_measurement.h"

#include <algorithm>

#include "base/codes.h"
#include "base/file.h"
#include "lab/render/render_parts.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

Status check(const RenderOptions& options) {
  const auto bad = [](const char* what, const char* where) {
    return Error{code::kBadArgument, what, where, ""};
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

DrawingOptions drawingOf(const RenderOptions& options) {
  return {options.moving, options.sample_distances.front(), options.rotate_s, options.cut_s};
}

RenderRow drawnRow(const std::string& of_case, const std::string& preset, const char* mode,
                   const RenderOptions& options) {
  RenderRow row;
  row.of_case = of_case;
  row.preset = preset;
  row.width = options.moving[0];
  row.height = options.moving[1];
  row.mode = mode;
  row.mapper = "trephine";
  row.sample_distance_voxels = options.sample_distances.front();
  return row;
}

Status addExercises(const std::vector<RenderSubject>& subjects, const RenderOptions& options,
                    const Progress& progress, RenderMeasurement& result) {
  const auto drawn = measureCutting(subjects, drawingOf(options), progress);
  if (!drawn) return drawn.error();
  for (const CuttingFigures::Exercise& exercise : drawn->exercises) {
    RenderRow row = drawnRow(exercise.of_case, exercise.preset, "cut", options);
    row.ms_median = exercise.ms_median;
    row.level = exercise.level;
    result.rows.push_back(row);
  }
  result.removal_median_ms = drawn->removal_median_ms;
  result.removal_max_ms = drawn->removal_max_ms;
  result.hand_median_ms = drawn->hand_median_ms;
  result.hand_p99_ms = drawn->hand_p99_ms;
  result.missed_ticks_percent = drawn->missed_ticks_percent;
  return {};
}

// The row of a camera that turns, and how long its picture takes to come to rest.
Status addTurning(const RenderSubject& subject, const RenderOptions& options,
                  const Progress& progress, RenderMeasurement& result) {
  const auto turned = measureTurning(subject, drawingOf(options), progress);
  if (!turned) return turned.error();
  RenderRow row = drawnRow(subject.name, subject.preset, "rotate", options);
  row.ms_median = turned->ms_median;
  row.level = turned->level;
  row.psnr_dB = turned->psnr_dB;
  row.ssim = turned->ssim;
  result.rows.push_back(row);
  result.rests.push_back({subject.name, subject.preset, turned->first_ms, turned->full_ms});
  return {};
}

// VTK's own, then ours.
std::vector<RaySetting> bothMappers(const RenderOptions& options) {
  const double distance = options.sample_distances.front();
  return {{distance, true}, {distance, false}};
}
constexpr const char* kMappers[] = {"stock", "trephine"};

Status addSurface(const RenderOptions& options, const Progress& progress,
                  RenderMeasurement& result) {
  const auto surfaces = shellSurface(bothMappers(options), options.surface_edge, progress);
  if (!surfaces) return surfaces.error();
  for (std::size_t n = 0; n < surfaces->size(); ++n) {
    result.surface.push_back({kMappers[n], (*surfaces)[n]});
  }
  return {};
}

Status addClassesOf(const char* name, bool by_label, const std::vector<RenderSubject>& subjects,
                    const RenderOptions& options, const Progress& progress,
                    std::vector<ClassRow>& rows) {
  const std::string source = phantomSource(name);
  const auto of = std::ranges::find(subjects, source, &RenderSubject::name);  // is among them
  const auto percents = wrongClassPercent(name, of->volume, by_label, bothMappers(options),
                                          options.truth_edge, options.truth_step, progress);
  if (!percents) return percents.error();
  for (std::size_t n = 0; n < percents->size(); ++n) {
    rows.push_back({source, kMappers[n], (*percents)[n]});
  }
  return {};
}

// Both mappers on both phantoms, from six directions.
Status addClasses(const std::vector<RenderSubject>& subjects, const RenderOptions& options,
                  const Progress& progress, RenderMeasurement& result) {
  Status done = addClassesOf("cranium", false, subjects, options, Progress(progress, 0.0, 0.35),
                             result.wrong_class);
  if (done) {
    done = addClassesOf("abdomen", true, subjects, options, Progress(progress, 0.35, 0.7),
                        result.wrong_class);
  }
  if (done) {
    done = addClassesOf("abdomen", false, subjects, options, Progress(progress, 0.7, 1.0),
                        result.wrong_class_hu_only);
  }
  return done;
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
  if (Status done = addExercises(*subjects, options, exercises, result); !done) return done.error();
  if (Status done = measureFirstPicture(options, out, picture, result); !done) return done.error();
  const Progress surface(progress, 0.25, 0.3), classes(progress, 0.3, 0.4);
  if (Status done = addSurface(options, surface, result); !done) return done.error();
  if (Status done = addClasses(*subjects, options, classes, result); !done) return done.error();
  const double share = 0.6 / double(subjects->size());
  double from = 0.4;
  for (const RenderSubject& subject : *subjects) {
    const Progress part(progress, from, from + share);
    if (subject.preset != "skin") {
      const Progress turning(part, 0.0, 0.1);
      if (Status done = addTurning(subject, options, turning, result); !done) {
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
