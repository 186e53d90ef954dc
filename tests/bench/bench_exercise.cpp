// An exercise in the real window, its script over and over, run after run: how many ticks were
// missed, how often lateness took force away, and how often a bare thread that ticks beside it, at
// the same rate and priority and with nothing to do, was as late. Needs a screen (Xvfb will do).
//   bench_exercise SCENE [SECONDS [RUNS]]      60 seconds, five times
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "base/json.h"
#include "base/rt/thread.h"
#include "bench/repeated_exercise.h"
#include "haptics/loop_clock.h"
#include "haptics/safety.h"
#include "training/session_reader.h"

namespace trephine {
namespace {

constexpr int kPriority = 80;         // of the haptic thread
constexpr double kAllowed_s = 120.0;  // for what is not the exercise

struct Lateness {
  std::uint64_t ticks = 0, missed = 0, reduced = 0, away = 0;
  double longest_ms = 0.0;
  bool reducing = false;
  // `reduced` counts the times that ticks more than 5 ms late came in a row, not the ticks.
  void add(std::int64_t late_ns, std::int64_t period_ns) {
    ++ticks;
    missed += late_ns > period_ns / 2;
    const bool reduces = late_ns > kHoldLate_ns;
    reduced += reduces && !reducing;
    reducing = reduces;
    away += late_ns > kStallLate_ns;
    longest_ms = std::max(longest_ms, double(late_ns) * 1e-6);
  }
  double kept_percent() const {
    return ticks == 0 ? 0.0 : 100.0 * double(ticks - missed) / double(ticks);
  }
};

// A thread that wakes as the haptic thread does.
class BareTimer {
 public:
  BareTimer(std::int64_t period_ns, double longest_s)
      : began_ns_(clock_.now_ns()),
        late_ns_(std::size_t(longest_s * 1e9 / double(period_ns))),
        at_ns_(late_ns_.size()),
        thread_([this, period_ns](const std::stop_token& stop) {
          rt::sharpenTimers();
          real_time_ = rt::requestRealTime(kPriority);
          HostClock clock;
          TickSchedule schedule(period_ns);
          for (; done_ < late_ns_.size() && !stop.stop_requested(); ++done_) {
            late_ns_[done_] = schedule.waitForTick(clock);
            at_ns_[done_] = clock.now_ns();
          }
        }) {}
  void stop() {
    thread_.request_stop();
    thread_.join();
  }
  bool realTime() const { return real_time_; }
  // Of its ticks in these seconds since it began.
  Lateness between(double from_s, double to_s, std::int64_t period_ns) const {
    Lateness lateness;
    for (std::size_t i = 0; i < done_; ++i) {
      const double s = double(at_ns_[i] - began_ns_) * 1e-9;
      if (s >= from_s && s < to_s) lateness.add(late_ns_[i], period_ns);
    }
    return lateness;
  }

 private:
  HostClock clock_;
  std::int64_t began_ns_;
  std::vector<std::int64_t> late_ns_, at_ns_;
  std::size_t done_ = 0;
  bool real_time_ = false;
  std::jthread thread_;
};

std::string answerOf(const std::string& command) {
  std::string text;
  FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) return text;
  char part[4096];
  while (const std::size_t n = std::fread(part, 1, sizeof part, pipe)) text.append(part, n);
  ::pclose(pipe);
  return text;
}

Lateness recorded(const std::string& file, std::int64_t period_ns) {
  Lateness lateness;
  const auto reader = SessionReader::open(file);
  if (!reader) return lateness;
  constexpr std::uint64_t kAtOnce = 10000;
  for (std::uint64_t from = 0; from < (*reader)->tickCount(); from += kAtOnce) {
    const auto ticks = (*reader)->ticks(from, std::min(kAtOnce, (*reader)->tickCount() - from));
    if (!ticks) break;
    for (const TickRecord& tick : *ticks) lateness.add(tick.late_ns, period_ns);
  }
  return lateness;
}

int run(const std::string& file, double seconds, int runs) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("bench-exercise-" + std::to_string(::getpid()));
  std::error_code ec;
  std::filesystem::create_directories(folder, ec);
  const std::string exercise = bench::repeated(file, seconds, folder).string();
  std::printf("%-4s %-9s %8s %9s %8s %6s %10s %8s %9s %7s\n", "run", "thread", "ticks", "on time",
              "reduced", "away", "longest ms", "frames/s", "frame p99", "stall");
  bool within = true;
  for (int i = 1; i <= runs; ++i) {
    const std::filesystem::path out = folder / std::to_string(i);
    BareTimer bare(1'000'000, seconds + kAllowed_s);
    const std::string text =
        answerOf(TREPHINE_PROGRAM " --exercise '" + exercise + "' --seconds " +
                 std::to_string(seconds) + " --out '" + out.string() + "' --json");
    bare.stop();
    const Json answer = Json::parse(text, nullptr, false);
    if (answer.is_discarded() || !answer.contains("session_ms")) {
      std::printf("%s\n", text.c_str());
      return 1;
    }
    const auto period_ns = std::int64_t(1e9 / answer["rate_hz"].get<double>());
    const double from_s = 1e-3 * answer["session_ms"].get<double>();
    const Lateness loop = recorded(answer["recording"].get<std::string>(), period_ns);
    const Lateness beside = bare.between(from_s, from_s + seconds, 1'000'000);
    std::printf("%-4d %-9s %8llu %7.3f %% %8llu %6llu %10.2f %8.1f %6.0f ms %4.0f ms\n", i,
                "haptic", (unsigned long long)loop.ticks, loop.kept_percent(),
                (unsigned long long)loop.reduced, (unsigned long long)loop.away, loop.longest_ms,
                answer["frames"].get<double>() / seconds, answer["frame_ms"]["p99"].get<double>(),
                answer["longest_stall_ms"].get<double>());
    std::printf("%-4s %-9s %8llu %7.3f %% %8llu %6llu %10.2f%s\n", "", "bare",
                (unsigned long long)beside.ticks, beside.kept_percent(),
                (unsigned long long)beside.reduced, (unsigned long long)beside.away,
                beside.longest_ms, bare.realTime() ? "" : "   without real-time priority");
    std::fflush(stdout);
    within = within && loop.kept_percent() >= 99.9 && loop.reduced <= beside.reduced &&
             loop.away <= beside.away;
  }
  std::filesystem::remove_all(folder, ec);
  std::printf(
      "bar: at least 99.9 %% on time, force reduced (over 5 ms late) and taken away (over "
      "20 ms) no more often than the bare thread is as late: %s\n",
      within ? "met" : "missed");
  return within ? 0 : 1;
}

}  // namespace
}  // namespace trephine

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    std::fprintf(stderr, "bench_exercise SCENE [SECONDS [RUNS]]\n");
    return 1;
  }
  return trephine::run(argv[1], argc > 2 ? std::atof(argv[2]) : 60.0,
                       argc > 3 ? std::atoi(argv[3]) : 5);
}
