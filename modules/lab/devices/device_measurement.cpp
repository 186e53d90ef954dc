#include "lab/devices/device_measurement.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <locale>
#include <random>
#include <sstream>
#include <thread>

#include "base/child_process.h"
#include "base/codes.h"
#include "base/file.h"
#include "base/system.h"
#include "device/codes.h"
#include "exercise/arms_file.h"
#include "lab/devices/loop_watch.h"
#include "machine/codes.h"
#include "machine/common/quantile.h"
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
  return {code::kCancelled, "The measurement was cancelled", "measure devices", ""};
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
    return Error{code::kNoDevice, "The bench cannot emulate '" + subject.plugin + "' here", "",
                 "Run it as its README says"};
  }
  subject.arms = armsOf(subject.plugin);
  if (!subject.arms.empty()) return {};
  return Error{code::kNoDevice, "No arm of '" + subject.plugin + "' is found", "",
               "Plug it in, or give a bench that emulates it"};
}

// The first moves the right arm.
Result<Rig> rigOf(const Exercise& exercise, const std::vector<FoundArm>& arms) {
  std::vector<NamedDevice> devices;
  for (std::size_t i = 0; i < arms.size() && i < exercise.arms.size(); ++i) {
    const std::string side = exercise.arms.size() > 1 ? kSides[i] : exercise.arms[0].name;
    devices.push_back({side, {arms[i].plugin, arms[i].place, deviceFile(arms[i].plugin)}});
  }
  return rigWith(exercise, devices, "the arms");
}

Result<Exercise> exerciseOn(const std::vector<FoundArm>& arms) {
  const char* name = arms.size() > 1 ? "cranium.json" : "cranium-one-arm.json";
  return readExercise(resourceFolder() / "scenes" / name);
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

// What came of forces that were sent.
struct Answers {
  std::vector<double> ms;     // from a sample at the arm to the force that answers it there
  std::uint64_t told = 0;     // forces that the bench says the arm had: of them
  std::uint64_t missing = 0;  // sent by no tick,
  std::uint64_t late = 0;     // sent by one whose successor was sent long before,
  std::uint64_t felt = 0;     // sent by a tick, and of any size
};

// Each force that the arm had is to be that of the newest tick that was sent before, in size and
// direction, or of one just before or after, on its way.
void addAnswers(const std::vector<LoopWatch::Tick>& ticks, DeviceBench& bench, std::uint32_t arm,
                Answers& to) {
  constexpr std::int64_t kWay_ns = 3'000'000;
  constexpr std::size_t kOldest = 100;  // ticks: beyond it the loop has taken the force away
  constexpr double kShare = 0.03;       // of the force, for the arm's way meanwhile
  const double tolerance_N = bench.tolerance_N();
  const std::vector<std::int64_t> samples_ns = bench.samples_ns(arm);
  if (ticks.empty()) return;
  std::size_t newest = 0, answered = ticks.size();
  for (const DeviceBench::Given& given : bench.given(arm)) {
    if (given.at_ns < ticks.front().sent_ns || given.at_ns > ticks.back().sent_ns) continue;
    ++to.told;
    while (newest + 1 < ticks.size() && ticks[newest + 1].sent_ns <= given.at_ns) ++newest;
    const auto is = [&](std::size_t k) {
      const Vec3& sent_N = ticks[k].force_N;
      const double share = tolerance_N > 1e-6 ? kShare * glm::length(sent_N) : 0.0;
      return glm::distance(sent_N, given.force_N) <= tolerance_N + share;
    };
    std::optional<std::size_t> found;
    const std::size_t next = newest + 1;
    for (std::size_t back = 0; !found && back <= std::min(newest, kOldest); ++back) {
      if (is(newest - back)) found = newest - back;
      if (back > 0 || found || next >= ticks.size()) continue;
      // Its write had not returned yet.
      if (ticks[next].read_ns <= given.at_ns && is(next)) found = next;
    }
    if (!found) {
      ++to.missing;
      continue;
    }
    to.felt += glm::length(given.force_N) > kFelt_N;
    to.late += *found < newest && ticks[*found + 1].sent_ns < given.at_ns - kWay_ns;
    if (found == answered || ticks[*found].sampled_ns == 0) continue;
    answered = *found;
    std::int64_t sampled_ns = ticks[*found].sampled_ns;
    const auto after = std::upper_bound(samples_ns.begin(), samples_ns.end(), sampled_ns);
    if (after != samples_ns.begin()) sampled_ns = *(after - 1);  // as the arm has it
    to.ms.push_back(1e-6 * double(given.at_ns - sampled_ns));
  }
}

Status runClosedLoop(const Subject& subject, double seconds, DeviceRow& row,
                     const Progress& progress) {
  Result<Exercise> exercise = exerciseOn(subject.arms);
  if (!exercise) return exercise.error();
  const Result<Placement> of = openCase(*exercise);
  if (!of) return of.error();
  LoopWatch watch(std::size_t((seconds + 10.0) * kRate_hz));
  Result<Rig> rig = rigOf(*exercise, subject.arms);
  if (!rig) return rig.error();
  SessionOptions options;
  options.probe = &watch;
  options.rig = *rig;
  Result<std::unique_ptr<Session>> session = Session::create(*of, options);
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
  row.ticks = report.done.ticks;
  row.missed = report.machine.missed_deadlines;
  row.faults = report.done.faults.size();
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
  Answers answers;
  for (std::size_t arm = 0; subject.bench && arm < subject.arms.size(); ++arm) {
    std::vector<LoopWatch::Tick> ticks;
    for (std::size_t i = 0; i < watch.ticks(arm); ++i) ticks.push_back(watch.tick(arm, i));
    addAnswers(ticks, *subject.bench, rig->arms[arm].device.place, answers);
  }
  const bool told = answers.told > 0;
  row.at_the_arm = answers.felt > 0;
  row.sample_to_force_ms = spreadOf(row.at_the_arm ? std::move(answers.ms) : std::move(answer_ms));
  if (told) {
    row.force_mismatches = answers.missing;
    row.forces_late = answers.late;
  }
  return {};
}

// ---- The order of the loop's calls

// Eight forces in turns, which a look at the arm tells apart.
Vec3 patternOf(std::size_t tick) {
  return Vec3(0.1 + 0.08 * double(tick % 8), 0.0, 0.0);
}

// Ticks of a loop without tissue, by an arm that the host or its own samples pace.
Result<std::vector<LoopWatch::Tick>> exchange(const Subject& subject, bool send_first,
                                              double seconds, ArmDynamics& dynamics,
                                              const Progress& progress) {
  std::vector<std::uint32_t> places;
  for (const FoundArm& arm : subject.arms) places.push_back(arm.place);
  Result<std::unique_ptr<Device>> device =
      openDevice(subject.plugin, places, deviceFile(subject.plugin));
  if (!device) return device.error();
  const TrephineCapabilities& able = (*device)->capabilities(0);
  dynamics = {able.apparent_mass_kg, able.encoder_step_m, able.peak_force_N, able.latency_s};
  if (Status started = (*device)->start(); !started) return started.error();
  std::vector<TrephineArmState> states(places.size());
  std::vector<TrephineArmCommand> commands(places.size());
  for (TrephineArmCommand& each : commands) each.size = sizeof(TrephineArmCommand);
  std::vector<LoopWatch::Tick> ticks;
  HostClock clock;
  TickSchedule schedule(std::int64_t(1e9 / kRate_hz));
  LoopWatch::Tick now;
  for (std::size_t tick = 0; double(tick) < seconds * kRate_hz; ++tick) {
    if (progress.cancelled()) {
      (*device)->stop();
      return cancelled();
    }
    const auto write = [&] {
      for (int axis = 0; axis < 3; ++axis) commands[0].force_N[axis] = now.force_N[axis];
      (*device)->write(commands.data());
      now.sent_ns = clock.now_ns();
      if (now.sampled_ns > 0) ticks.push_back(now);
    };
    if (send_first && (*device)->hasClock()) {
      (*device)->wait(0.005);
    } else {
      schedule.waitForTick(clock);
    }
    if (!send_first) write();
    (*device)->read(1.0 / kRate_hz, states.data());
    now.sequence = states[0].sequence;
    now.sampled_ns = states[0].time_ns;
    now.read_ns = clock.now_ns();
    now.force_N = patternOf(tick);
    if (send_first) write();
  }
  (*device)->stop();
  return ticks;
}

Status measureOrders(Subject& subject, double seconds, DeviceRow& row, const Progress& progress) {
  for (const bool send_first : {true, false}) {
    progress.at(0.0, subject.plugin + (send_first ? ", send, then wait" : ", wait, then send"));
    if (Status there = plugIn(subject); !there) return there;
    DelayRow delay;
    delay.order = send_first ? "send, then wait" : "wait, then send";
    ArmDynamics dynamics;
    const Result<std::vector<LoopWatch::Tick>> ticks =
        exchange(subject, send_first, seconds, dynamics, progress);
    if (!ticks) return ticks.error();
    Answers answers;
    if (subject.bench) addAnswers(*ticks, *subject.bench, subject.arms[0].place, answers);
    delay.at_the_arm = answers.felt > 0;
    if (!delay.at_the_arm) {
      for (const LoopWatch::Tick& tick : *ticks) {
        answers.ms.push_back(1e-6 * double(tick.sent_ns - tick.sampled_ns));
      }
    }
    delay.missing = answers.missing;
    delay.late = answers.late;
    delay.delay_ms = spreadOf(std::move(answers.ms));
    const auto mostAt = [&](double delay_s) {
      dynamics.delay_s = delay_s;
      return renderable(dynamics, kRate_hz, delay_s * kRate_hz, WorkspaceMap{});
    };
    delay.stated_ms = 1e3 * dynamics.delay_s;
    delay.stated_most = mostAt(dynamics.delay_s);
    delay.encoder_k_max = mostAt(0.0).k_max;
    // With the product's own loop, which also computes.
    const bool worse =
        send_first && row.at_the_arm && row.sample_to_force_ms.p99 > delay.delay_ms.p99;
    const double p99_ms = worse ? row.sample_to_force_ms.p99 : delay.delay_ms.p99;
    delay.delay_samples = 1e-3 * p99_ms * kRate_hz;
    delay.most = mostAt(1e-3 * p99_ms);
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
  const fs::path answer = out / kTrialAnswer, said_file = out / "trial.txt";
  fs::remove(answer, ec);
  const Result<ChildRun> run =
      runChild({{measureProgram().string(), "devices", "--json", "--bench", options.bench.string(),
                 "--out", out.string(), "--one", options.unplug ? "unplugged" : "blocked", "--wait",
                 plainNumber(options.wait_s), "--recording", recording.string()},
                said_file,
                out,
                kLongest_s},
               progress);
  if (!run) return run.error();
  Result<Json> json = readJsonFile(answer);
  const Error ended{Code(), "it ended with code " + std::to_string(run->exit_code), "", ""};
  const Error why = errorSaid(said_file).value_or(json ? ended : json.error());
  fs::remove(said_file, ec);
  if (run->exit_code != 0 || !json || !json->contains("zero_ms")) {
    return Error{code::kNotMeasured, "A trial did not come to its end: " + why.what, why.where,
                 why.next};
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
    if (!trial && (progress.cancelled() || trial.error().code != code::kNotMeasured)) {
      return trial.error();
    }
    if (!trial) {  // the others count all the same
      ++row.failed;
      row.failure = trial.error().sentence();
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

Result<DeviceTrial> tryDevice(const TrialOptions& options, const fs::path& recording) {
  const Result<DeviceBench*> bench = loadDeviceBench(options.bench);
  if (!bench) return bench.error();
  Subject subject{(*bench)->plugin(), *bench, {}};
  if (Status there = plugIn(subject); !there) return there.error();
  Result<Exercise> exercise = exerciseOn(subject.arms);
  if (!exercise) return exercise.error();
  const Result<Placement> of = openCase(*exercise);
  if (!of) return of.error();
  LoopWatch watch(std::size_t(40.0 * kRate_hz));
  SessionOptions session_options;
  session_options.probe = &watch;
  session_options.recording = recording;
  Result<Rig> rig = rigOf(*exercise, subject.arms);
  if (!rig) return rig.error();
  session_options.rig = *std::move(rig);
  Result<std::unique_ptr<Session>> session = Session::create(*of, session_options);
  if (!session) return session.error();
  if (Status started = (*session)->start(30.0); !started) return started.error();
  std::this_thread::sleep_for(std::chrono::duration<double>(options.wait_s));
  const std::uint32_t arm = subject.arms[0].place;
  const auto named = std::ranges::find(exercise->arms, std::string(kSides[0]), &ExerciseArm::name);
  const std::size_t of_exercise =
      named == exercise->arms.end() ? 0 : std::size_t(named - exercise->arms.begin());
  const auto force_N = [&] {
    const std::size_t ticks = watch.ticks(of_exercise);
    return ticks == 0 ? 0.0 : glm::length(watch.tick(of_exercise, ticks - 1).force_N);
  };
  const std::int64_t deadline_ns = hostTime_ns() + 10'000'000'000;
  while (force_N() < kFelt_N && hostTime_ns() < deadline_ns) std::this_thread::sleep_for(200us);
  if (force_N() < kFelt_N) {
    (void)(*session)->stop();
    return Error{code::kNotMeasured, "The arm was given no force within 10 s", "", ""};
  }
  const std::int64_t at_ns = hostTime_ns();
  // Stop is asked for while the call blocks; the arm is looked at until after it.
  constexpr double kBlock_s = 1.5;
  constexpr std::int64_t kLook_ns = 700'000'000, kLookAtArm_ns = 1'900'000'000;
  options.unplug ? subject.bench->unplug(arm) : subject.bench->block(kBlock_s);
  std::int64_t last_ns = at_ns;
  // For how long, all told: what was on its way when the call blocked is at the arm once it
  // returns.
  std::int64_t with_force_ns = 0;
  std::thread looks([&] {
    std::int64_t before_ns = at_ns;
    while (!options.unplug && before_ns < at_ns + kLookAtArm_ns) {
      const bool has_force = subject.bench->force_N(arm) > 1e-6;
      const std::int64_t now_ns = hostTime_ns();
      if (has_force) with_force_ns += now_ns - before_ns;
      before_ns = now_ns;
      std::this_thread::sleep_for(200us);
    }
  });
  while (hostTime_ns() < at_ns + kLook_ns) std::this_thread::sleep_for(200us);
  // A loop that stands still sends nothing, and takes nothing away.
  const std::size_t ticks = watch.ticks(of_exercise);
  const LoopWatch::Tick& newest = watch.tick(of_exercise, ticks - 1);
  if (newest.sent_ns < at_ns + kLook_ns / 2 || glm::length(newest.force_N) > 0.0) {
    (void)(*session)->stop();
    looks.join();
    return Error{code::kNotMeasured, "The loop stood still, or the force stayed", "", ""};
  }
  for (std::size_t i = ticks; i-- > 0;) {
    const LoopWatch::Tick& tick = watch.tick(of_exercise, i);
    if (tick.sent_ns < at_ns) break;
    if (glm::length(tick.force_N) <= 0.0) continue;
    last_ns = tick.sent_ns;
    break;
  }
  DeviceTrial trial;
  trial.zero_ms = 1e-6 * double(last_ns - at_ns);
  const std::int64_t stop_ns = hostTime_ns();
  (void)(*session)->stop();
  trial.stop_ms = 1e-6 * double(hostTime_ns() - stop_ns);
  looks.join();
  trial.at_arm_ms = 1e-6 * double(with_force_ns);
  session->reset();
  const auto reader = SessionReader::open(recording);
  if (!reader) return trial;
  const Result<ReplayResult> again =
      replay(**reader, *of->patient.volume, of->labels.get(), Progress(), of->patient.sha256);
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
    return Error{code::kBadArgument,
                 "The time must lie between 1 and 600 s, the trials from 0 to 1000",
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
    return Error{code::kNoDevice, "No arm is plugged in", "",
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
                        {"delay_ms", toJson(delay.delay_ms)},
                        {"delay_samples", delay.delay_samples},
                        {"at_the_arm", delay.at_the_arm},
                        {"forces_missing", delay.missing},
                        {"forces_late", delay.late},
                        {"b_max", delay.most.b_max},
                        {"k_max", delay.most.k_max},
                        {"encoder_k_max", delay.encoder_k_max},
                        {"stated_ms", delay.stated_ms},
                        {"stated_b_max", delay.stated_most.b_max},
                        {"stated_k_max", delay.stated_most.k_max}});
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
         {"report_age_ms", toJson(row.report_age_ms)},
         {"sample_to_force_ms", toJson(row.sample_to_force_ms)},
         {"at_the_arm", row.at_the_arm},
         {"force_mismatches", row.force_mismatches ? Json(*row.force_mismatches) : Json(nullptr)},
         {"forces_late", row.force_mismatches ? Json(row.forces_late) : Json(nullptr)},
         {"page_faults", row.page_faults},
         {"unplug_to_zero_ms", toJson(row.unplug_to_zero_ms)},
         {"block_to_zero_ms", toJson(row.block_to_zero_ms)},
         {"block_at_arm_ms", toJson(row.block_at_arm_ms)},
         {"stop_ms", toJson(row.stop_ms)},
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
      text << "  forces at the arm that no tick sent: " << *row.force_mismatches
           << "; of an older tick: " << row.forces_late << "\n";
    for (const DelayRow& delay : row.delays) {
      text << "  " << delay.order << ": " << delay.delay_ms.median << " ms, p99 "
           << delay.delay_ms.p99 << (delay.at_the_arm ? " at the arm" : " to the plugin");
      if (delay.missing + delay.late > 0) {
        text << " (" << delay.missing << " forces of no tick, " << delay.late << " late)";
      }
      text << "; shows " << std::setprecision(0) << delay.most.b_max << " N s/m and "
           << delay.most.k_max << " N/m"
           << (delay.most.k_max > 0.999 * delay.encoder_k_max ? ", all that its encoders allow"
                                                              : "")
           << "; as stated, " << std::setprecision(2) << delay.stated_ms << " ms, "
           << std::setprecision(0) << delay.stated_most.b_max << " and " << delay.stated_most.k_max
           << std::setprecision(2) << "\n";
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
