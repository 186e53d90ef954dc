#include "lab/headset/headset_measurement.h"

#include <QOpenGLExtraFunctions>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "base/codes.h"
#include "base/system.h"
#include "headset/codes.h"
#include "headset/eye_pictures.h"
#include "headset/packed_drawing.h"
#include "headset/stereo_screen.h"
#include "headset/test_runtime.h"
#include "imaging/codes.h"
#include "lab/codes.h"
#include "lab/headset/headset_geometry.h"
#include "lab/headset/headset_rig.h"
#include "machine/codes.h"
#include "machine/common/exercise_view.h"
#include "render/gl_limits.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr double kPatience_s = 10.0;  // for a headset to show something, or to end
constexpr double kHang_s = 2.0;
constexpr int kSmall = 256, kLarge = 1024;
constexpr double kRow_s = 4.0;  // of each row
constexpr double kEyes_mm = 63.0, kScreen_mm = 600.0;  // before a screen

Error stopped() {
  return {code::kCancelled, "The measurement was cancelled", "measure headset", ""};
}

int entriesOf(const char* folder) {
  int count = 0;
  std::error_code problem;
  for (fs::directory_iterator each(folder, problem), end; each != end; each.increment(problem)) {
    ++count;
  }
  return count;
}

// Beside the program; null where XR_RUNTIME_JSON names a real one.
Result<TestRuntime*> findRuntime() {
  if (std::getenv("XR_RUNTIME_JSON")) return nullptr;
  std::error_code problem;
  const fs::path beside = fs::read_symlink("/proc/self/exe", problem).parent_path();
  Result<TestRuntime*> runtime = loadTestRuntime(beside / "libtrephine_openxr_test.so");
  if (!runtime) return runtime.error();
  ::setenv("XR_RUNTIME_JSON", (beside / "trephine_openxr_test.json").c_str(), 1);
  ::setenv("XR_LOADER_DEBUG", "none", 0);
  return runtime;
}

class Measuring {
 public:
  Measuring(HeadsetRig& rig, TestRuntime* runtime, HeadsetMeasurement& to, const Progress& progress)
      : rig_(rig), runtime_(runtime), to_(to), progress_(progress) {}

  Status answers();
  Status rows(const std::vector<int>& sizes);
  Status exercise(double seconds, std::vector<std::pair<std::uint64_t, bool>>& borders);
  Status toggles(int count);
  Status losses(int of_each);
  Status failures();

 private:
  void ready(int size) {
    if (!runtime_) return;
    runtime_->reset();
    runtime_->setSize(std::uint32_t(size), std::uint32_t(size));
    runtime_->setReadBack(false);
  }
  // So that every pair is another one.
  void moveHead(double t_s) {
    if (!runtime_) return;
    const Vec3 at(0.02 * std::sin(2.0 * t_s), 0.01 * std::sin(3.1 * t_s), 0.0);
    runtime_->setHead({at, glm::angleAxis(0.05 * std::sin(1.7 * t_s), Vec3(0, 1, 0))});
  }
  HeadsetOptions options(int size) const {
    HeadsetOptions of;
    of.pace.least_hz = 0.0;  // what is measured is the pair of pictures
    of.most_pixels = size;
    return of;
  }
  Status begin(int size);
  // True where it ended as it was asked to, or because it was lost.
  bool finish();
  // Why a headset is gone that nobody asked to end.
  Error endedByItself() const {
    if (rig_.end() && !rig_.end()->why) return rig_.end()->why.error();
    return {code::kHeadsetEnded, "The headset ended by itself", "", "Try again"};
  }
  Result<HeadsetRow> openXrRow(int size);
  HeadsetRow sideBySideRow(int size);

  HeadsetRig& rig_;
  TestRuntime* runtime_;
  HeadsetMeasurement& to_;
  const Progress& progress_;
};

// Until it shows a pair.
Status Measuring::begin(int size) {
  if (Status started = rig_.startHeadset(options(size)); !started) return started;
  const bool shows =
      rig_.until([&] { return !rig_.headset() || rig_.headset()->state().fresh > 1; }, kPatience_s);
  if (rig_.headset() && shows) return {};
  if (!rig_.headset() && rig_.end() && !rig_.end()->why) return rig_.end()->why;
  if (rig_.headset()) {
    rig_.stopHeadset();
    finish();
  }
  return Error{code::kNoPicture, "The headset took no picture within 10 s", "",
               "Put it on, and see whether its own software shows something"};
}

bool Measuring::finish() {
  const bool ended = rig_.until([&] { return rig_.headset() == nullptr; }, kPatience_s);
  if (!runtime_) return ended;
  for (const std::string& what : runtime_->violations()) to_.violations.push_back(what);
  return ended;
}

Result<HeadsetRow> Measuring::openXrRow(int size) {
  ready(size);
  if (Status begun = begin(size); !begun) return begun.error();
  rig_.pass(0.5);  // the level of detail finds its place
  if (!rig_.headset()) return endedByItself();
  HeadsetRow row;
  row.kind = "openxr";
  std::vector<double> eyes_ms, age_ms;
  const HeadsetState before = rig_.headset()->state();
  const std::int64_t from_ns = monotonic_ns();
  std::uint64_t pairs = rig_.pairs(), frames = before.fresh;
  rig_.until(
      [&] {
        moveHead(1e-9 * double(monotonic_ns() - from_ns));
        if (!rig_.headset()) return true;
        if (std::exchange(pairs, rig_.pairs()) != rig_.pairs()) eyes_ms.push_back(rig_.pair_ms());
        const HeadsetState now = rig_.headset()->state();
        if (std::exchange(frames, now.fresh) != now.fresh) age_ms.push_back(now.pose_age_ms);
        return progress_.cancelled();
      },
      kRow_s);
  if (!rig_.headset()) return endedByItself();
  const HeadsetState after = rig_.headset()->state();
  const double all = double(after.fresh + after.repeated + after.held) -
                     double(before.fresh + before.repeated + before.held);
  row.width = after.width;
  row.height = after.height;
  row.eyes_ms = spreadOf(eyes_ms);
  row.pose_age_ms = spreadOf(age_ms);
  row.pairs_hz = double(after.fresh - before.fresh) / kRow_s;
  row.repeats_percent = 100.0 * double(after.repeated - before.repeated) / std::max(1.0, all);
  row.held_percent = 100.0 * double(after.held - before.held) / std::max(1.0, all);
  rig_.stopHeadset();
  if (!finish()) return Error{code::kHeadsetStuck, "The headset does not end", "", "Try again"};
  return row;
}

// Both eyes before a screen, and both pictures on it.
HeadsetRow Measuring::sideBySideRow(int size) {
  HeadsetRow row;
  row.kind = "side-by-side";
  row.width = row.height = size;
  QOpenGLExtraFunctions& gl = rig_.gl();
  EyePictures eye_pictures, whole;
  PackedDrawing packed;
  std::vector<double> eyes_ms;
  const std::int64_t from_ns = monotonic_ns();
  int pairs = 0;
  rig_.until(
      [&] {
        const ViewCamera& camera = rig_.renderer().camera();
        const double t_s = 1e-9 * double(monotonic_ns() - from_ns);
        const StereoScreen screen =
            screenThrough(camera.distance_mm(), camera.halfHeight_mm(), 1.0, kEyes_mm, kScreen_mm);
        Pose head_mm = camera.pose_mm();
        head_mm.position += camera.right() * (10.0 * std::sin(2.0 * t_s));
        const Eyes eyes = eyesBefore(screen, head_mm);
        const std::int64_t begun_ns = monotonic_ns();
        for (std::size_t eye = 0; eye < 2; ++eye) {
          rig_.renderer().paintEye(eyes[eye], eye_pictures.framebuffer(eye, size, size), size,
                                   size);
        }
        gl.glBindFramebuffer(GL_FRAMEBUFFER, whole.framebuffer(0, 2 * size, size));
        packed.draw(eye_pictures.textures(), Packing::full, {}, 2 * size, size);
        gl.glFinish();
        if (t_s > 0.5) {
          eyes_ms.push_back(1e-6 * double(monotonic_ns() - begun_ns));
          ++pairs;
        }
        return progress_.cancelled();
      },
      kRow_s);
  packed.release();
  eye_pictures.release();
  whole.release();
  rig_.renderer().releaseEyes();
  row.eyes_ms = row.pose_age_ms = spreadOf(eyes_ms);  // it is shown as soon as it is drawn
  row.pairs_hz = pairs / (kRow_s - 0.5);
  return row;
}

// Before a case is read for nothing.
Status Measuring::answers() {
  if (Status started = rig_.startHeadset(options(kSmall)); !started) return started;
  rig_.until([&] { return !rig_.headset() || rig_.headset()->state().located; }, kPatience_s);
  if (!rig_.headset()) return rig_.end()->why;
  rig_.stopHeadset();
  return finish() ? Status()
                  : Error{code::kHeadsetStuck, "The headset does not end", "", "Try again"};
}

Status Measuring::rows(const std::vector<int>& sizes) {
  for (const int size : sizes) {
    progress_.at(0.1, "rows");
    if (progress_.cancelled()) return stopped();
    Result<HeadsetRow> row = openXrRow(size);
    if (!row) return row.error();
    to_.rows.push_back(*row);
    to_.rows.push_back(sideBySideRow(size));
  }
  return {};
}

// In turns, so that what else the machine does meets both. `borders`: from this tick on it was so.
Status Measuring::exercise(double seconds, std::vector<std::pair<std::uint64_t, bool>>& borders) {
  constexpr int kTurns = 4;  // of each
  double ticks[2] = {}, missed[2] = {};
  for (int turn = 0; turn < 2 * kTurns; ++turn) {
    const bool with = turn % 2 == 1;
    progress_.at(0.2 + 0.2 * turn / (2 * kTurns), "exercise");
    if (progress_.cancelled()) return stopped();
    if (with) {
      ready(kSmall);
      if (Status begun = begin(kSmall); !begun) return begun;
    }
    (void)rig_.takeLongestTurn_ms();
    const LoopState before = rig_.session().state();
    borders.emplace_back(before.ticks, with);
    const std::int64_t from_ns = monotonic_ns();
    rig_.until(
        [&] {
          moveHead(1e-9 * double(monotonic_ns() - from_ns));
          return progress_.cancelled();
        },
        seconds / kTurns);
    const LoopState after = rig_.session().state();
    double& gap_ms = with ? to_.gap_ms : to_.gap_without_ms;
    gap_ms = std::max(gap_ms, rig_.takeLongestTurn_ms());
    borders.emplace_back(after.ticks, false);
    ticks[with] += double(after.ticks - before.ticks);
    missed[with] += double(after.missed - before.missed);
    if (with) {
      if (!rig_.headset()) return endedByItself();
      rig_.stopHeadset();
      if (!finish()) return Error{code::kHeadsetStuck, "The headset does not end", "", "Try again"};
    }
  }
  to_.missed_without_percent = 100.0 * missed[0] / std::max(1.0, ticks[0]);
  to_.missed_with_percent = 100.0 * missed[1] / std::max(1.0, ticks[1]);
  return {};
}

Status Measuring::toggles(int count) {
  (void)rig_.takeLongestTurn_ms();
  for (int i = 0; i < count; ++i) {
    progress_.at(0.4 + 0.1 * i / count, "on and off");
    if (progress_.cancelled()) return stopped();
    ready(96);
    if (Status begun = begin(96); !begun) return begun;
    rig_.stopHeadset();
    to_.toggles += finish() && rig_.end()->why.ok() ? 1 : 0;
  }
  to_.gap_ms = std::max(to_.gap_ms, rig_.takeLongestTurn_ms());
  return {};
}

Status Measuring::losses(int of_each) {
  using Loss = TestRuntime::Loss;
  constexpr int kHangs = 4;  // the last kind
  std::vector<double> cleaned_ms;
  int done = 0;
  (void)rig_.takeLongestTurn_ms();
  for (int i = 0; i < 5 * of_each; ++i) {
    progress_.at(0.5 + 0.3 * i / (5 * of_each), "losses");
    if (progress_.cancelled()) return stopped();
    ready(96);
    if (Status begun = begin(96); !begun) return begun;
    const int kind = i % 5;
    std::int64_t lost_ns = monotonic_ns();
    if (kind == kHangs) {
      runtime_->hang(kHang_s);
      // Where our own turns were slower than that, it may be over before we look.
      rig_.until([&] { return !rig_.headset() || rig_.headset()->stuck_s() > 0.2; }, kPatience_s);
      if (rig_.headset()) {
        lost_ns = monotonic_ns() + std::int64_t(1e9 * (kHang_s - rig_.headset()->stuck_s()));
      }
    } else {
      constexpr Loss kKinds[] = {Loss::instance, Loss::session, Loss::pending, Loss::event};
      runtime_->lose(kKinds[kind]);
    }
    if (!finish())
      return Error{code::kHeadsetStuck, "A lost headset does not end", "", "Try again"};
    done += !rig_.end()->why.ok() ? 1 : 0;
    cleaned_ms.push_back(1e-6 * double(monotonic_ns() - lost_ns));
  }
  to_.gap_lost_ms = rig_.takeLongestTurn_ms();
  to_.losses = done;
  to_.cleaned_ms = spreadOf(cleaned_ms);
  return {};
}

// Each call of OpenXR gives an error for good from its first or its third time on.
Status Measuring::failures() {
  int tried = 0, ended = 0;
  for (const std::string& function : runtime_->functions()) {
    for (const int after : {0, 2}) {
      progress_.at(0.8, "failures");
      if (progress_.cancelled()) return stopped();
      constexpr int kRuntimeFailure = -2;
      ready(32);
      runtime_->setPeriod(3.0);
      runtime_->fail(function, kRuntimeFailure, after, -1);
      if (Status started = rig_.startHeadset(options(32)); !started) return started;
      rig_.until([&] { return !rig_.headset() || rig_.headset()->state().fresh > 4; }, kPatience_s);
      if (rig_.headset()) rig_.stopHeadset();
      ++tried;
      const bool over = finish();
      // It was told, unless the call is one of the end, after which there is nothing to tell.
      const bool of_the_end = function.starts_with("xrDestroy") || function == "xrEndSession" ||
                              function == "xrRequestExitSession";
      const bool told =
          of_the_end || runtime_->calls(function) <= after || (rig_.end() && !rig_.end()->why.ok());
      ended += over && told && !runtime_->alive().any() ? 1 : 0;
    }
  }
  ready(96);
  to_.failures = tried;
  to_.failures_ended = ended;
  return {};
}

// What each eye sees of an exercise after its first moment, side by side.
Status savePictures(HeadsetRig& rig, const fs::path& out, const Progress& progress) {
  constexpr int kSize = 512;
  constexpr double kMoment_s = 1.0;
  for (const char* name : {"burr-hole", "cranium", "cranium-one-arm", "liver", "liver-one-arm",
                           "research/seed-cranium", "research/seed-liver"}) {
    progress.at(0.95, std::string("pictures, ") + name);
    if (progress.cancelled()) return stopped();
    const fs::path file = resourceFolder() / "scenes" / (std::string(name) + ".json");
    if (Status opened = rig.open(file, {}, Progress()); !opened) return opened;
    // Both hands where the script has them after a moment.
    if (Status run = rig.session().freewheel(kMoment_s, Progress()); !run) return run;
    rig.renderer().pullChanges(rig.session().grid());
    rig.renderer().setTools(toolsOf(rig.session()));
    StereoScreen screen;  // the middle of what a headset shows: 50 degrees each way
    screen.distance = 0.6;
    screen.separation = 0.063;
    screen.height = 2.0 * 0.6 * std::tan(glm::radians(25.0));
    screen.aspect = 1.0;
    Eyes eyes = eyesBefore(screen);
    // The head looks at the patient, which stands before it and below.
    const Vec3 at_m = rig.place().toRoom_m(rig.renderer().camera().focus());
    const Quat down = glm::angleAxis(std::atan2(at_m.y, -at_m.z), Vec3(1, 0, 0));
    eyes = eyesBefore(screen, {Vec3(0.0), down});
    Picture both;
    both.width = 2 * kSize;
    both.height = kSize;
    both.rgb.resize(std::size_t(both.width) * kSize * 3);
    for (std::size_t eye = 0; eye < 2; ++eye) {
      const Picture one =
          rig.renderer().eyePicture(rig.place().toPatient_mm(eyes[eye]), kSize, kSize);
      for (std::size_t row = 0; row < std::size_t(one.height); ++row) {
        std::copy_n(one.rgb.begin() + std::ptrdiff_t(row * kSize * 3), kSize * 3,
                    both.rgb.begin() + std::ptrdiff_t((row * 2 + eye) * kSize * 3));
      }
    }
    if (Status written = writePng(both, out / ("eyes-" + file.stem().string() + ".png"));
        !written) {
      return written;
    }
  }
  return {};
}

}  // namespace

Result<HeadsetMeasurement> measureHeadset(const HeadsetMeasureOptions& options, const fs::path& out,
                                          const Progress& progress) {
  if (!(options.seconds >= 2.0 && options.seconds <= 600.0) || options.toggles < 0 ||
      options.toggles > 1000 || options.losses < 0 || options.losses > 1000) {
    return Error{code::kBadOption, "Seconds are from 2 to 600, toggles and losses from 0 to 1000",
                 "measure headset", "Give others"};
  }
  std::error_code problem;
  fs::create_directories(out, problem);
  if (problem)
    return Error{code::kCannotWrite, problem.message(), out.string(), "Choose another folder"};
  Result<TestRuntime*> runtime = findRuntime();
  if (!runtime) return runtime.error();
  Result<std::unique_ptr<HeadsetRig>> made = HeadsetRig::create();
  if (!made) return made.error();
  HeadsetRig& rig = **made;
  HeadsetMeasurement measured;
  measured.real_runtime = *runtime == nullptr;
  measured.opengl = rig.renderer().openGlDescription();
  Measuring measuring(rig, *runtime, measured, progress);
  if (measured.real_runtime) {
    if (Status answers = measuring.answers(); !answers) return answers.error();
  }
  progress.at(0.02, "case");
  const fs::path recording = out / "headset.trephine";
  fs::remove(recording, problem);
  const fs::path exercise = resourceFolder() / "scenes" / "cranium.json";
  if (Status opened = rig.open(exercise, recording, Progress(progress, 0.02, 0.1)); !opened) {
    return opened.error();
  }
  std::vector<int> sizes{kSmall};
  if (!isSoftware(measured.opengl)) sizes.push_back(kLarge);
  if (Status done = measuring.rows(sizes); !done) return done.error();
  const int textures = rig.textures(), threads = entriesOf("/proc/self/task"),
            descriptors = entriesOf("/proc/self/fd");
  std::vector<std::pair<std::uint64_t, bool>> borders;
  if (Status done = measuring.exercise(options.seconds, borders); !done) return done.error();
  if (Status done = measuring.toggles(options.toggles); !done) return done.error();
  if (*runtime) {
    if (Status done = measuring.losses(options.losses); !done) return done.error();
    if (Status done = measuring.failures(); !done) return done.error();
  }
  measured.leaked_textures = rig.textures() - textures;
  measured.leaked_fds = entriesOf("/proc/self/fd") - descriptors;
  measured.leaked_threads = entriesOf("/proc/self/task") - threads;
  if (Status ended = rig.endExercise(); !ended) return ended.error();
  const RunReport report = rig.session().report();
  for (const ArmFault& fault : report.done.faults) {
    if (fault.fault != kFaultLate) continue;
    for (std::size_t i = 0; i + 1 < borders.size(); i += 2) {
      if (fault.tick < borders[i].first || fault.tick >= borders[i + 1].first) continue;
      ++(borders[i].second ? measured.late_with : measured.late_without);
    }
  }
  progress.at(0.85, "replay");
  measured.recording_replays = rig.replays(Progress(progress, 0.85, 0.93));
  const EyeGeometry geometry = measureEyeGeometry(rig.renderer());
  measured.disparity_error_px = geometry.disparity_error_px;
  measured.vertical_error_px = geometry.vertical_error_px;
  measured.psnr_to_crop_db = geometry.psnr_to_crop_db;
  if (options.pictures) {
    if (Status saved = savePictures(rig, out, progress); !saved) return saved.error();
  }
  return measured;
}

Json toJson(const HeadsetMeasurement& of) {
  Json rows = Json::array();
  for (const HeadsetRow& row : of.rows) {
    rows.push_back({{"kind", row.kind},
                    {"size", {row.width, row.height}},
                    {"eyes_ms", toJson(row.eyes_ms)},
                    {"pose_age_ms", toJson(row.pose_age_ms)},
                    {"pairs_hz", row.pairs_hz},
                    {"repeats_percent", row.repeats_percent},
                    {"held_percent", row.held_percent}});
  }
  // Equal pictures have no noise at all, which is no number.
  const double psnr = std::min(of.psnr_to_crop_db, 999.0);
  return {{"opengl", of.opengl},
          {"real_runtime", of.real_runtime},
          {"rows", rows},
          {"geometry",
           {{"disparity_error_px", of.disparity_error_px},
            {"vertical_error_px", of.vertical_error_px},
            {"psnr_to_crop_db", psnr}}},
          {"toggles", of.toggles},
          {"losses", orNull(of.losses)},
          {"failures", {{"tried", orNull(of.failures)}, {"ended", orNull(of.failures_ended)}}},
          {"leaked_textures", of.leaked_textures},
          {"leaked_fds", of.leaked_fds},
          {"leaked_threads", of.leaked_threads},
          {"cleaned_ms", toJson(of.cleaned_ms)},
          {"panel_longest_gap_ms", of.gap_ms},
          {"panel_longest_gap_lost_ms", of.gap_lost_ms},
          {"panel_longest_gap_without_ms", of.gap_without_ms},
          {"haptic_missed",
           {{"with_percent", of.missed_with_percent},
            {"without_percent", of.missed_without_percent},
            {"late_with", of.late_with},
            {"late_without", of.late_without}}},
          {"recording_replays", of.recording_replays},
          {"violations", of.violations}};
}

std::string toText(const HeadsetMeasurement& of) {
  std::string text = of.opengl + "\n";
  char line[300];
  const auto add = [&]<class... Args>(const char* format, Args... args) {
    std::snprintf(line, sizeof line, format, args...);
    text += line;
  };
  for (const HeadsetRow& row : of.rows) {
    add("%-12s %4d x %-4d  both eyes %6.2f ms (p99 %.2f), %5.1f pairs a second, pose %.1f ms old "
        "(most %.1f), repeated %.1f %%, held %.1f %%\n",
        row.kind.c_str(), row.width, row.height, row.eyes_ms.median, row.eyes_ms.p99, row.pairs_hz,
        row.pose_age_ms.median, row.pose_age_ms.max, row.repeats_percent, row.held_percent);
  }
  add("geometry      disparity %.3f px, vertical %.3f px, %.1f dB against a crop\n",
      of.disparity_error_px, of.vertical_error_px, of.psnr_to_crop_db);
  add("on and off    %d; ", of.toggles);
  if (of.losses) {
    add("lost %d; cleaned up within %.0f ms (median %.0f); %d of %d failing calls ended\n",
        *of.losses, of.cleaned_ms.max, of.cleaned_ms.median, of.failures_ended.value_or(0),
        of.failures.value_or(0));
  } else {
    text += "a real runtime cannot be lost on purpose\n";
  }
  add("left behind   %d textures, %d descriptors, %d threads; %zu of OpenXR's rules broken\n",
      of.leaked_textures, of.leaked_fds, of.leaked_threads, of.violations.size());
  add("panel         longest turn %.0f ms with, %.0f without, %.0f while it is lost or hangs\n",
      of.gap_ms, of.gap_without_ms, of.gap_lost_ms);
  add("haptics       %.4f %% of ticks missed with, %.4f %% without; late %d and %d times; the "
      "recording %s\n",
      of.missed_with_percent, of.missed_without_percent, of.late_with, of.late_without,
      of.recording_replays ? "replays" : "DOES NOT REPLAY");
  return text;
}

}  // namespace trephine
