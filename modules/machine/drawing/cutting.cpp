// Exercises drawn as they run: how long from what happened to what is seen.
#include <algorithm>
#include <cmath>
#include <thread>

#include "base/system.h"
#include "machine/common/exercise_view.h"
#include "machine/common/quantile.h"
#include "machine/drawing/drawing_parts.h"
#include "session/session.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

// When what was read for a picture was read, and when the picture was there.
struct Seen {
  double read_ms = 0.0, there_ms = 0.0;
};

// The delays of things that happen at any time between two readings: each is seen in the picture of
// the reading that follows it. So many moments stand for all of an interval.
constexpr int kMoments = 10;
void addDelays(double last_read_ms, const Seen& seen, std::vector<double>& delays) {
  for (int n = 0; n <= kMoments; ++n) {
    const double when = last_read_ms + (seen.read_ms - last_read_ms) * n / kMoments;
    delays.push_back(seen.there_ms - when);
  }
}

std::uint64_t removedVoxels(const LoopState& state, std::size_t arms) {
  std::uint64_t voxels = 0;
  for (std::size_t arm = 0; arm < arms; ++arm) {
    for (const std::uint64_t of_tissue : state.removed[arm]) voxels += of_tissue;
  }
  return voxels;
}

struct Delays {
  std::vector<double> removal_ms, hand_ms;
  std::uint64_t ticks = 0, missed = 0;
};

Status measureExercise(const char* file, const RenderSubject& subject,
                       const DrawingOptions& options, const Progress& progress, Delays& delays,
                       CuttingFigures& result) {
  Result<Exercise> exercise = readExercise(resourceFolder() / "scenes" / file);
  if (!exercise) return exercise.error();
  Case known = caseOf(subject.volume);
  known.built_in = true;
  known.structures = subject.labels;
  const Result<Placement> of = place(*exercise, std::move(known), Progress(progress, 0.0, 0.2));
  if (!of) return of.error();
  Result<OperatorScript> script = readOperatorScript(exercise->operator_file, *exercise);
  if (!script) return script.error();
  Result<std::unique_ptr<Session>> made = Session::create(*of, {"", *script});
  if (!made) return made.error();
  Session& session = **made;
  auto renderer_made = SceneRenderer::offscreen(options.size[0], options.size[1]);
  if (!renderer_made) return renderer_made.error();
  SceneRenderer& renderer = **renderer_made;
  // As the window in an exercise: a picture at most this long, and so long for a finer one between.
  constexpr double kFrame_ms = 20.0, kBetween_ms = 10.0;
  renderer.setSampleDistance(options.sample_distance);
  renderer.setTissues(of->exercise.tissues, exercise->view.looks);
  renderer.setVolume(session.grid());
  lookAtExercise(renderer, session);
  for (int n = 0; n < 2; ++n) renderer.paint(0);  // the first one sends the volume
  Picture last = UploadProbe::painted(renderer);

  if (Status started = session.start(options.cut_s); !started) return started;
  const auto begin = RenderClock::now();
  std::vector<double> ms, levels, of_all_ms;
  std::uint64_t removed_before = 0;
  double last_pull_ms = 0.0, last_hands_ms = 0.0;
  while (!session.finished()) {
    if (progress.cancelled()) break;
    progress.at(0.2 + 0.8 * std::min(1.0, msSince(begin) / (1000.0 * options.cut_s)), file);
    Seen hands, removal;
    const double start_ms = msSince(begin);
    removal.read_ms = start_ms;
    const bool cut = renderer.pullChanges(session.grid());
    hands.read_ms = msSince(begin);
    const LoopState& state = session.state();
    const std::uint64_t removed = removedVoxels(state, session.exercise().arms.size());
    renderer.setTools(toolsOf(session));
    renderer.paint(0, kFrame_ms);
    hands.there_ms = removal.there_ms = msSince(begin);
    // Outside of the time: that the picture is another is the evidence that it was drawn.
    Picture picture = UploadProbe::painted(renderer);
    of_all_ms.push_back(removal.there_ms - start_ms);
    const bool drawn = !(picture == last);
    last = std::move(picture);
    if (removed > removed_before && drawn) {
      ms.push_back(removal.there_ms - start_ms);
      levels.push_back(UploadProbe::level(renderer));
      addDelays(last_hands_ms, hands, delays.hand_ms);
      if (cut) addDelays(last_pull_ms, removal, delays.removal_ms);
    }
    renderer.refine(kBetween_ms);
    removed_before = removed;
    last_pull_ms = removal.read_ms;
    last_hands_ms = hands.read_ms;
  }
  if (Status stopped = session.stop(); !stopped) return stopped;
  if (progress.cancelled()) return drawingCancelled();
  const RunReport report = session.report();
  delays.ticks += report.done.ticks;
  delays.missed += report.machine.missed_deadlines;

  // Too short a run cuts nothing.
  result.exercises.push_back({exercise->case_source, subject.preset,
                              medianOf(ms.empty() ? of_all_ms : ms),
                              levels.empty() ? UploadProbe::level(renderer) : medianOf(levels)});
  return {};
}

}  // namespace

Result<CuttingFigures> measureCutting(const std::vector<RenderSubject>& subjects,
                                      const DrawingOptions& options, const Progress& progress) {
  CuttingFigures result;
  Delays delays;
  double from = 0.0;
  for (const RenderSubject& subject : subjects) {
    const char* file = subject.name == phantomSource("cranium") && subject.preset == "bone"
                           ? "cranium.json"
                       : subject.preset == "liver" ? "liver.json"
                                                   : nullptr;
    if (!file || from > 0.75) continue;
    const Progress part(progress, from, from + 0.5);
    if (Status run = measureExercise(file, subject, options, part, delays, result); !run) {
      return run.error();
    }
    from += 0.5;
  }
  for (std::vector<double>* all : {&delays.removal_ms, &delays.hand_ms}) {
    std::sort(all->begin(), all->end());
  }
  result.removal_median_ms = quantile(delays.removal_ms, 500);
  result.removal_max_ms = quantile(delays.removal_ms, 1000);
  result.hand_median_ms = quantile(delays.hand_ms, 500);
  result.hand_p99_ms = quantile(delays.hand_ms, 990);
  result.missed_ticks_percent =
      100.0 * double(delays.missed) / double(std::max<std::uint64_t>(1, delays.ticks));
  return result;
}

}  // namespace trephine
