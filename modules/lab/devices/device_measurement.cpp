#include "lab/devices/device_measurement.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <locale>
#include <random>
#include <sstream>
#include <thread>

#include "base/file.h"
#include "base/system.h"
#include "lab/common/child_process.h"
#include "lab/common/quantile.h"
#include "lab/devices/loop_watch.h"
#include "scene/arms_file.h"
#include "session/arm_devices.h"
#include "session/session.h"
#include "training/replay.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr double kRate_hz = 1000.0;
constexpr double kOrder_s = 10.0;  // of each order of the loop's calls, at most
constexpr double kFelt_N = 0.05;   // an arm has force
const char* kSides[] = {"right", "left"};

Error cancelled() {
  return {"CANCELLED", "The measurement was cancelled", "measure devices", ""};
}

// What is measured at once: the arms of one plugin, plugged in or emulated.
struct Subject {
  std::string plugin;
  DeviceBench* bench = nullptr;
  std::vector<FoundArm> arms;
};

std::vector<FoundArm> armsOf(const std::string& plugin) {
  std::vector<FoundArm> arms = findArms(pluginFolder()).arms;
  std::erase_if(arms, [&](const FoundArm& arm) { return arm.plugin != plugin; });
  if (arms.size() > 2) arms.resize(2);
  return arms;
}

std::vector<Subject> pluggedIn() {
  std::vector<Subject> subjects;
  for (const FoundArm& arm : findArms(pluginFolder()).arms) {
    if (arm.plugin == kSimulated) continue;
    if (subjects.empty() || subjects.back().plugin != arm.plugin) {
      subjects.push_back({arm.plugin, nullptr, armsOf(arm.plugin)});
    }
  }
  return subjects;
}

Status plugIn(Subject& subject) {
  if (subject.bench && !subject.bench->plugIn()) {
    return Error{"NO_DEVICE", "The bench cannot emulate '" + subject.plugin + "' here", "",
                 "Run it as its README says"};
  }
  subject.arms = armsOf(subject.plugin);
  if (!subject.arms.empty()) return {};
  return Error{"NO_DEVICE", "No arm of '" + subject.plugin + "' is found", "",
               "Plug it in, or give a bench that emulates it"};
}

// The first moves the right arm.
Status moveBy(Scene& scene, const std::vector<FoundArm>& arms) {
  std::vector<NamedDevice> devices;
  for (std::size_t i = 0; i < arms.size() && i < scene.arms.size(); ++i) {
    const std::string side = scene.arms.size() > 1 ? kSides[i] : scene.arms[0].name;
    devices.push_back({side, {arms[i].plugin, arms[i].place, deviceFile(arms[i].plugin)}});
  }
  return useArms(scene, devices, "the arms");
}

Result<Scene> sceneOn(const std::vector<FoundArm>& arms) {
  const char* name = arms.size() > 1 ? "cranium.json" : "cranium-one-arm.json";
  Result<Scene> scene = readScene(resourceFolder() / "scenes" / name);
  if (!scene) return scene;
  if (Status moved = moveBy(*scene, arms); !moved) return moved.error();
  return scene;
}

std::int64_t hostTime_ns() {
  return HostClock().now_ns();
}

// ---- The closed loop

std::uint64_t skipped(const LoopWatch& watch, std::size_t arm) {
  std::uint64_t count = 0;
  for (std::size_t i = 1; i < watch.ticks(arm); ++i) {
    const std::uint64_t before = watch.tick(arm, i - 1).sequence;
    const std::uint64_t now = watch.tick(arm, i).sequence;
    if (before > 0 && now > before + 1) count += now - before - 1;
  }
  return count;
}

// Forces that the arm never got, or got, by a late tick, after the sample that follows the one that
// they answer.
struct Arrivals {
  std::uint64_t missing = 0, late = 0;
};

// Both count samples, from different ones on: the arm's is `offset` ahead.
Arrivals arrivals(const LoopWatch& watch, std::size_t arm, const std::vector<double>& received_N,
                  std::int64_t offset) {
  constexpr std::int64_t kLatest = 100;  // samples: beyond it the loop has taken the force away
  Arrivals found;
  std::int64_t last = 0;  // they come in the order in which they were sent
  for (std::size_t i = 0; i < watch.ticks(arm); ++i) {
    const LoopWatch::Tick& tick = watch.tick(arm, i);
    if (tick.lost) continue;
    const std::int64_t due = std::int64_t(tick.sequence) + offset;
    std::int64_t at = std::max({due, last, std::int64_t(0)});
    const auto end = std::min(due + kLatest, std::int64_t(received_N.size()));
    while (at < end && std::abs(received_N[std::size_t(at)] - tick.force_N) >= 1e-9) ++at;
    if (at >= end) {
      ++found.missing;
      continue;
    }
    found.late += at > due + 1;
    last = at;
  }
  return found;
}

Arrivals arrivals(const LoopWatch& watch, std::size_t arm, const std::vector<double>& received_N) {
  // Where the first force of any size arrived.
  const std::size_t ticks = watch.ticks(arm);
  std::size_t first = 0;
  while (first < ticks && watch.tick(arm, first).force_N < kFelt_N) ++first;
  Arrivals best{ticks, 0};  // nothing is known of any
  if (first == ticks) return best;
  const LoopWatch::Tick& felt = watch.tick(arm, first);
  for (std::size_t at = 0; at < received_N.size() && best.missing + best.late > 0; ++at) {
    if (std::abs(received_N[at] - felt.force_N) >= 1e-9) continue;
    const Arrivals here =
        arrivals(watch, arm, received_N, std::int64_t(at) - std::int64_t(felt.sequence));
    if (here.missing + here.late < best.missing + best.late) best = here;
  }
  return best;
}

Status runClosedLoop(const Subject& subject, double seconds, DeviceRow& row,
                     const Progress& progress) {
  Result<Scene> scene = sceneOn(subject.arms);
  if (!scene) return scene.error();
  const Result<Case> of = openCase(*scene);
  if (!of) return of.error();
  LoopWatch watch(std::size_t((seconds + 10.0) * kRate_hz));
  SessionOptions options;
  options.probe = &watch;
  Result<std::unique_ptr<Session>> session = Session::create(*scene, *of, options);
  if (!session) return session.error();
  if (Status started = (*session)->start(seconds); !started) return started;
  const std::int64_t begin_ns = hostTime_ns();
  // What found no room before anybody listened is not lost.
  const auto lost_before = subject.bench ? subject.bench->lost() : std::nullopt;
  while (!(*session)->finished() && 1e-9 * double(hostTime_ns() - begin_ns) < seconds + 10.0) {
    const double part = 1e-9 * double(hostTime_ns() - begin_ns) / seconds;
    progress.at(std::min(1.0, part), subject.plugin + ", closed loop");
    if (progress.cancelled()) {
      (void)(*session)->stop();
      return cancelled();
    }
    std::this_thread::sleep_for(50ms);
  }
  if (lost_before) row.reports_lost = *subject.bench->lost() - *lost_before;
  if (Status stopped = (*session)->stop(); !stopped) return stopped;
  const RunReport report = (*session)->report();
  row.ticks = report.ticks;
  row.missed = report.missed_deadlines;
  row.faults = report.faults.size();
  row.page_faults = watch.pageFaults();
  std::vector<double> age_ms, answer_ms;
  for (std::size_t arm = 0; arm < subject.arms.size(); ++arm) {
    row.reports_skipped += skipped(watch, arm);
    for (std::size_t i = 0; i < watch.ticks(arm); ++i) {
      const LoopWatch::Tick& tick = watch.tick(arm, i);
      if (tick.sampled_ns == 0 || tick.lost) continue;
      age_ms.push_back(1e-6 * double(tick.read_ns - tick.sampled_ns));
      answer_ms.push_back(1e-6 * double(tick.sent_ns - tick.sampled_ns));
    }
  }
  row.report_age_ms = spreadOf(std::move(age_ms));
  std::vector<double> at_arm_ms = subject.bench ? subject.bench->answers_ms() : answer_ms;
  row.at_the_arm = subject.bench && !at_arm_ms.empty();
  row.sample_to_force_ms = spreadOf(row.at_the_arm ? std::move(at_arm_ms) : std::move(answer_ms));
  for (std::size_t arm = 0; subject.bench && arm < subject.arms.size(); ++arm) {
    const std::uint32_t of_bench = scene->arms[arm].device.place;
    const std::vector<double> received_N = subject.bench->received_N(of_bench);
    if (received_N.empty()) continue;
    const Arrivals found = arrivals(watch, arm, received_N);
    row.force_mismatches = row.force_mismatches.value_or(0) + found.missing;
    row.forces_late += found.late;
  }
  return {};
}

// ---- The order of the loop's calls

// From each sample to the return of the write of the force that answers it, by an arm that the host
// or its own samples pace.
Result<std::vector<double>> answersTo(const Subject& subject, bool send_first, double seconds,
                                      ArmDynamics& dynamics, const Progress& progress) {
  std::vector<std::uint32_t> places;
  for (const FoundArm& arm : subject.arms) places.push_back(arm.place);
  Result<std::unique_ptr<Device>> device =
      openDevice(subject.plugin, places, deviceFile(subject.plugin));
  if (!device) return device.error();
  const TrephineCapabilities& able = (*device)->capabilities(0);
  dynamics = {able.apparent_mass_kg, able.encoder_step_m, able.peak_force_N, 0.0};
  if (Status started = (*device)->start(); !started) return started.error();
  std::vector<TrephineArmState> states(places.size());
  std::vector<TrephineArmCommand> commands(places.size());
  std::vector<double> answers_ms;
  HostClock clock;
  TickSchedule schedule(std::int64_t(1e9 / kRate_hz));
  std::uint64_t answered = 0;
  std::int64_t computed_from_ns = 0;
  for (std::size_t tick = 0; double(tick) < seconds * kRate_hz; ++tick) {
    if (progress.cancelled()) return cancelled();
    const auto write = [&] {
      (*device)->write(commands.data());
      if (computed_from_ns == 0) return;
      answers_ms.push_back(1e-6 * double(clock.now_ns() - computed_from_ns));
      computed_from_ns = 0;
    };
    if (send_first && (*device)->hasClock()) {
      (*device)->wait(0.005);
    } else {
      schedule.waitForTick(clock);
    }
    if (!send_first) write();
    (*device)->read(1.0 / kRate_hz, states.data());
    if (states[0].sequence != answered && states[0].time_ns > 0) {
      answered = states[0].sequence;
      computed_from_ns = states[0].time_ns;
    }
    if (send_first) write();
  }
  (*device)->stop();
  return answers_ms;
}

Status measureOrders(Subject& subject, double seconds, DeviceRow& row, const Progress& progress) {
  double beyond_ms = 0.0;  // from the plugin to the arm, as the bench sees it
  for (const bool send_first : {true, false}) {
    progress.at(0.0, subject.plugin + (send_first ? ", send, then wait" : ", wait, then send"));
    if (Status there = plugIn(subject); !there) return there;
    DelayRow delay;
    delay.order = send_first ? "send, then wait" : "wait, then send";
    ArmDynamics dynamics;
    Result<std::vector<double>> answers_ms =
        answersTo(subject, send_first, seconds, dynamics, progress);
    if (!answers_ms) return answers_ms.error();
    const double to_plugin_ms = spreadOf(*answers_ms).median;
    const std::vector<double> seen_ms =
        subject.bench && send_first ? subject.bench->answers_ms() : std::vector<double>();
    if (!seen_ms.empty()) beyond_ms = std::max(0.0, spreadOf(seen_ms).median - to_plugin_ms);
    for (double& ms : *answers_ms) ms += beyond_ms;
    delay.delay_ms = spreadOf(std::move(*answers_ms));
    dynamics.delay_s = 1e-3 * delay.delay_ms.p99;
    delay.delay_samples = dynamics.delay_s * kRate_hz;
    delay.most = renderable(dynamics, kRate_hz, delay.delay_samples, WorkspaceMap{});
    row.delays.push_back(delay);
  }
  return {};
}

// ---- Troubles

// The same program, which tells what came of it.
Result<DeviceTrial> trialOf(const TrialOptions& options, const fs::path& out,
                            const fs::path& recording, const Progress& progress) {
  std::error_code ec;
  constexpr double kLongest_s = 60.0;
  const fs::path answer = out / "trial.json";
  const Result<ChildRun> run =
      runChild({{fs::read_symlink("/proc/self/exe", ec).string(), "measure", "devices", "--json",
                 "--bench", options.bench.string(), "--out", out.string(), "--one",
                 options.unplug ? "unplugged" : "blocked", "--wait", plainNumber(options.wait_s),
                 "--recording", recording.string()},
                answer,
                out,
                kLongest_s},
               progress);
  if (!run) return run.error();
  Result<Json> json = readJsonFile(answer);
  const std::string said = json ? json->dump() : json.error().sentence();
  if (run->exit_code != 0 || !json || !json->contains("zero_ms")) {
    return Error{"NOT_MEASURED", "A trial did not come to its end: " + said, "", ""};
  }
  fs::remove(answer, ec);
  return DeviceTrial{json->at("zero_ms"), json->at("at_arm_ms"), json->at("stop_ms"),
                     json->at("replayed")};
}

Status runTrials(const fs::path& bench, int count, const fs::path& out, DeviceRow& row,
                 const Progress& progress) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> wait_s(0.7, 1.7);
  std::vector<double> unplug_ms, block_ms, at_arm_ms, stop_ms;
  for (int n = 0; n < 2 * count; ++n) {
    const bool unplug = n < count;
    const std::string name = unplug ? "-unplugged-" : "-blocked-";
    progress.at(double(n) / (2.0 * count), row.plugin + (unplug ? ", unplugged" : ", blocked"));
    const fs::path recording =
        out / (row.plugin + name + std::to_string(n % std::max(1, count)) + ".h5");
    const Result<DeviceTrial> trial =
        trialOf({bench, unplug, wait_s(random)}, out, recording, progress);
    if (!trial && (progress.cancelled() || trial.error().code != "NOT_MEASURED")) {
      return trial.error();
    }
    if (!trial) {  // the others count all the same
      ++row.failed;
      row.failure = trial.error().what;
      continue;
    }
    (unplug ? unplug_ms : block_ms).push_back(trial->zero_ms);
    if (!unplug) at_arm_ms.push_back(trial->at_arm_ms);
    stop_ms.push_back(trial->stop_ms);
    ++(unplug ? row.unplugged : row.blocked);
    row.replayed += trial->replayed;
    std::error_code ec;
    if (trial->replayed) fs::remove(recording, ec);
  }
  row.unplug_to_zero_ms = spreadOf(std::move(unplug_ms));
  row.block_to_zero_ms = spreadOf(std::move(block_ms));
  row.block_at_arm_ms = spreadOf(std::move(at_arm_ms));
  row.stop_ms = spreadOf(std::move(stop_ms));
  return {};
}

// ---- What is said of it

Json spread(const Spread& of) {
  if (of.count == 0) return nullptr;
  return {{"median", of.median}, {"p99", of.p99}, {"max", of.max}, {"count", of.count}};
}

std::string devicesCsv(const DeviceMeasurement& measurement) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "plugin,arms,seconds,ticks,missed,reports_lost,reports_skipped,report_age_median_ms,"
          "report_age_p99_ms,"
          "sample_to_force_median_ms,sample_to_force_p99_ms,force_mismatches,forces_late,page_"
          "faults,"
          "unplug_to_zero_max_ms,block_to_zero_max_ms,block_at_arm_max_ms,stop_max_ms,replayed,"
          "trials,failed\n";
  for (const DeviceRow& row : measurement.rows) {
    text << row.plugin << ',' << row.arms << ',' << row.seconds << ',' << row.ticks << ','
         << row.missed << ',';
    if (row.reports_lost) text << *row.reports_lost;
    text << ',' << row.reports_skipped << ',' << row.report_age_ms.median << ','
         << row.report_age_ms.p99 << ',' << row.sample_to_force_ms.median << ','
         << row.sample_to_force_ms.p99 << ',';
    const auto known = [&](bool is, auto value) {
      if (is) text << value;
      text << ',';
    };
    known(row.force_mismatches.has_value(), row.force_mismatches.value_or(0));
    known(row.force_mismatches.has_value(), row.forces_late);
    text << row.page_faults << ',';
    known(row.unplug_to_zero_ms.count > 0, row.unplug_to_zero_ms.max);
    known(row.block_to_zero_ms.count > 0, row.block_to_zero_ms.max);
    known(row.block_at_arm_ms.count > 0, row.block_at_arm_ms.max);
    known(row.stop_ms.count > 0, row.stop_ms.max);
    text << row.replayed << ',' << row.unplugged + row.blocked << ',' << row.failed << '\n';
  }
  return text.str();
}

}  // namespace

Spread spreadOf(std::vector<double> figures) {
  std::sort(figures.begin(), figures.end());
  return {quantile(figures, 500), quantile(figures, 990), quantile(figures, 1000), figures.size()};
}

Result<DeviceTrial> tryDevice(const TrialOptions& options, const fs::path& recording) {
  const Result<DeviceBench*> bench = loadDeviceBench(options.bench);
  if (!bench) return bench.error();
  Subject subject{(*bench)->plugin(), *bench, {}};
  if (Status there = plugIn(subject); !there) return there.error();
  Result<Scene> scene = sceneOn(subject.arms);
  if (!scene) return scene.error();
  const Result<Case> of = openCase(*scene);
  if (!of) return of.error();
  LoopWatch watch(std::size_t(40.0 * kRate_hz));
  SessionOptions session_options;
  session_options.probe = &watch;
  session_options.recording = recording;
  Result<std::unique_ptr<Session>> session = Session::create(*scene, *of, session_options);
  if (!session) return session.error();
  if (Status started = (*session)->start(30.0); !started) return started.error();
  std::this_thread::sleep_for(std::chrono::duration<double>(options.wait_s));
  const std::uint32_t arm = subject.arms[0].place;
  const auto named = std::ranges::find(scene->arms, std::string(kSides[0]), &SceneArm::name);
  const std::size_t of_scene =
      named == scene->arms.end() ? 0 : std::size_t(named - scene->arms.begin());
  const auto force_N = [&] {
    const std::size_t ticks = watch.ticks(of_scene);
    return ticks == 0 ? 0.0 : watch.tick(of_scene, ticks - 1).force_N;
  };
  const std::int64_t deadline_ns = hostTime_ns() + 10'000'000'000;
  while (force_N() < kFelt_N && hostTime_ns() < deadline_ns) std::this_thread::sleep_for(200us);
  if (force_N() < kFelt_N) {
    (void)(*session)->stop();
    return Error{"NOT_MEASURED", "The arm was given no force within 10 s", "", ""};
  }
  const std::int64_t at_ns = hostTime_ns();
  // Stop is asked for while the call blocks; the arm is looked at until after it.
  constexpr double kBlock_s = 1.5;
  constexpr std::int64_t kLook_ns = 700'000'000, kLookAtArm_ns = 1'900'000'000;
  options.unplug ? subject.bench->unplug(arm) : subject.bench->block(kBlock_s);
  std::int64_t last_ns = at_ns, last_at_arm_ns = at_ns;
  const auto lookUntil = [&](std::int64_t until_ns) {
    while (hostTime_ns() < until_ns) {
      if (!options.unplug && subject.bench->force_N(arm) > 1e-6) last_at_arm_ns = hostTime_ns();
      std::this_thread::sleep_for(200us);
    }
  };
  lookUntil(at_ns + kLook_ns);
  // A loop that stands still sends nothing, and takes nothing away.
  const std::size_t ticks = watch.ticks(of_scene);
  const LoopWatch::Tick& newest = watch.tick(of_scene, ticks - 1);
  if (newest.sent_ns < at_ns + kLook_ns / 2 || newest.force_N > 0.0) {
    (void)(*session)->stop();
    return Error{"NOT_MEASURED", "The loop stood still, or the force stayed", "", ""};
  }
  for (std::size_t i = ticks; i-- > 0;) {
    const LoopWatch::Tick& tick = watch.tick(of_scene, i);
    if (tick.sent_ns < at_ns) break;
    if (tick.force_N <= 0.0) continue;
    last_ns = tick.sent_ns;
    break;
  }
  DeviceTrial trial;
  trial.zero_ms = 1e-6 * double(last_ns - at_ns);
  const std::int64_t stop_ns = hostTime_ns();
  (void)(*session)->stop();
  trial.stop_ms = 1e-6 * double(hostTime_ns() - stop_ns);
  if (!options.unplug) lookUntil(at_ns + kLookAtArm_ns);
  trial.at_arm_ms = 1e-6 * double(last_at_arm_ns - at_ns);
  session->reset();
  const auto reader = SessionReader::open(recording);
  if (!reader) return trial;
  const Result<ReplayResult> again =
      replay(**reader, *of->volume, of->labels.get(), Progress(), of->sha256);
  trial.replayed = again && again->identical && !again->cut_short;
  return trial;
}

Json toJson(const DeviceTrial& trial) {
  return {{"zero_ms", trial.zero_ms},
          {"at_arm_ms", trial.at_arm_ms},
          {"stop_ms", trial.stop_ms},
          {"replayed", trial.replayed}};
}

Result<DeviceMeasurement> measureDevices(const DeviceOptions& options, const fs::path& out,
                                         const Progress& progress) {
  if (!(options.seconds >= 1.0 && options.seconds <= 600.0) || options.trials < 0 ||
      options.trials > 1000) {
    return Error{"BAD_ARGUMENT", "The time must lie between 1 and 600 s, the trials from 0 to 1000",
                 "--seconds, --trials", ""};
  }
  if (Status made = makeFolder(out); !made) return made.error();
  std::vector<Subject> subjects;
  for (const fs::path& library : options.benches) {
    const Result<DeviceBench*> bench = loadDeviceBench(library);
    if (!bench) return bench.error();
    subjects.push_back({(*bench)->plugin(), *bench, {}});
  }
  if (options.benches.empty()) subjects = pluggedIn();
  if (subjects.empty()) {
    return Error{"NO_DEVICE", "No arm is plugged in", "",
                 "Plug one in, or give a bench that emulates one (--bench)"};
  }
  DeviceMeasurement measurement;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    Subject& subject = subjects[i];
    const double from = double(i) / double(subjects.size()), share = 1.0 / double(subjects.size());
    if (Status there = plugIn(subject); !there) return there.error();
    DeviceRow row;
    row.plugin = subject.plugin;
    row.arms = subject.arms.size();
    row.seconds = options.seconds;
    const Progress loop(progress, from, from + 0.4 * share);
    if (Status ran = runClosedLoop(subject, options.seconds, row, loop); !ran) return ran.error();
    const Progress orders(progress, from + 0.4 * share, from + 0.5 * share);
    if (Status ran = measureOrders(subject, std::min(kOrder_s, options.seconds), row, orders); !ran)
      return ran.error();
    const Progress trials(progress, from + 0.5 * share, from + share);
    if (subject.bench) {
      const Status ran = runTrials(options.benches[i], options.trials, out, row, trials);
      if (!ran) return ran.error();
    }
    measurement.rows.push_back(std::move(row));
  }
  if (Status written = writeTextFile(out / "devices.csv", devicesCsv(measurement)); !written) {
    return written.error();
  }
  return measurement;
}

Json toJson(const DeviceMeasurement& measurement) {
  Json rows = Json::array();
  for (const DeviceRow& row : measurement.rows) {
    Json delays = Json::array();
    for (const DelayRow& delay : row.delays) {
      delays.push_back({{"order", delay.order},
                        {"delay_ms", spread(delay.delay_ms)},
                        {"delay_samples", delay.delay_samples},
                        {"b_max", delay.most.b_max},
                        {"k_max", delay.most.k_max}});
    }
    rows.push_back(
        {{"plugin", row.plugin},
         {"arms", row.arms},
         {"seconds", row.seconds},
         {"ticks", row.ticks},
         {"missed", row.missed},
         {"faults", row.faults},
         {"reports_lost", row.reports_lost ? Json(*row.reports_lost) : Json(nullptr)},
         {"reports_skipped", row.reports_skipped},
         {"report_age_ms", spread(row.report_age_ms)},
         {"sample_to_force_ms", spread(row.sample_to_force_ms)},
         {"at_the_arm", row.at_the_arm},
         {"force_mismatches", row.force_mismatches ? Json(*row.force_mismatches) : Json(nullptr)},
         {"forces_late", row.force_mismatches ? Json(row.forces_late) : Json(nullptr)},
         {"page_faults", row.page_faults},
         {"unplug_to_zero_ms", spread(row.unplug_to_zero_ms)},
         {"block_to_zero_ms", spread(row.block_to_zero_ms)},
         {"block_at_arm_ms", spread(row.block_at_arm_ms)},
         {"stop_ms", spread(row.stop_ms)},
         {"trials", row.unplugged + row.blocked},
         {"failed", row.failed},
         {"replayed", row.replayed},
         {"delays", delays}});
  }
  return {{"rows", rows}};
}

std::string toText(const DeviceMeasurement& measurement) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(2);
  for (const DeviceRow& row : measurement.rows) {
    text << row.plugin << ", " << row.arms << " arms, " << std::setprecision(0) << row.seconds
         << " s: " << std::setprecision(2) << row.ticks << " ticks, " << row.missed << " late, "
         << (row.reports_lost ? std::to_string(*row.reports_lost) : std::string("?"))
         << " reports lost, " << row.reports_skipped << " that no tick looked at, "
         << row.page_faults << " page faults\n"
         << "  a report is " << row.report_age_ms.median << " ms old, p99 " << row.report_age_ms.p99
         << "; from it to the force " << (row.at_the_arm ? "at the arm " : "") << "in "
         << row.sample_to_force_ms.median << " ms, p99 " << row.sample_to_force_ms.p99 << "\n";
    if (row.force_mismatches)
      text << "  forces that did not arrive: " << *row.force_mismatches
           << "; by a late tick: " << row.forces_late << "\n";
    for (const DelayRow& delay : row.delays) {
      text << "  " << delay.order << ": " << delay.delay_ms.median << " ms, p99 "
           << delay.delay_ms.p99 << "; shows " << delay.most.b_max << " N s/m and "
           << std::setprecision(0) << delay.most.k_max << std::setprecision(2) << " N/m\n";
    }
    if (row.failed > 0) {
      text << "  " << row.failed << " trials did not come to their end, the last: " << row.failure
           << "\n";
    }
    if (row.unplugged + row.blocked == 0) continue;
    text << "  no force after an unplug within " << row.unplug_to_zero_ms.median << " ms, at most "
         << row.unplug_to_zero_ms.max << "; after a call that blocks "
         << row.block_to_zero_ms.median << ", at most " << row.block_to_zero_ms.max
         << " (at the arm itself " << row.block_at_arm_ms.max << ")"
         << "; Stop within " << row.stop_ms.max << " ms; " << row.replayed << " of "
         << row.unplugged + row.blocked << " recordings replay\n";
  }
  return text.str();
}

}  // namespace trephine
