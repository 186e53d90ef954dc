#include "machine/ticks/jitter_measurement.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <future>
#include <iomanip>
#include <iterator>
#include <locale>
#include <sstream>
#include <thread>
#include <utility>

#include "base/codes.h"
#include "base/file.h"
#include "base/rt/alloc_guard.h"
#include "base/rt/thread.h"
#include "base/tr.h"
#include "machine/codes.h"

namespace trephine {

namespace {

using namespace std::chrono_literals;

constexpr double kRates_hz[] = {1000.0, 2000.0, 4000.0};
constexpr int kPriority = 80;  // that of the haptic thread in a session
constexpr auto kReportEvery = 200ms;

// A thread starts with its maker's scheduling, and that may be real-time already (chrt).
bool requestNormal() {
  const sched_param parameters{};
  return sched_setscheduler(0, SCHED_OTHER, &parameters) == 0;  // 0: this thread
}

bool canHaveRealTime() {
  bool granted = false;
  std::thread([&] { granted = rt::requestRealTime(kPriority); }).join();
  return granted;
}

Error noRealTime() {
  const std::string limit = " - rtprio " + std::to_string(kPriority);
  return {code::kNoRealTime,
          tr("Real-time priority was not granted: as root, write the line 'NAME{}' with your "
             "user's name, or '@GROUP{}' with a group of yours, to "
             "/etc/security/limits.d/trephine.conf, then log in again",
             limit, limit),
          "", ""};
}

Error cancelled() {
  return {code::kCancelled, tr("The measurement was cancelled"), tr("measure jitter"), ""};
}

const char* priorityName(bool real_time) {
  return real_time ? "fifo" : "normal";
}

std::string jitterCsv(const JitterMeasurement& measurement) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "rate_hz,priority,median_us,p99_us,p999_us,max_us,missed,ticks\n" << std::fixed;
  for (const JitterRow& row : measurement.rows) {
    text << std::setprecision(0) << row.rate_hz << ',' << priorityName(row.real_time)
         << std::setprecision(3);
    for (double us : {row.median_us, row.p99_us, row.p999_us, row.max_us}) text << ',' << us;
    text << ',' << row.missed << ',' << row.ticks << '\n';
  }
  return text.str();
}

}  // namespace

JitterRow summarizeJitter(double rate_hz, bool real_time, std::vector<std::int64_t> late_ns,
                          std::uint64_t missed) {
  JitterRow row;
  row.rate_hz = rate_hz;
  row.real_time = real_time;
  row.missed = missed;
  row.ticks = late_ns.size();
  if (late_ns.empty()) return row;
  std::sort(late_ns.begin(), late_ns.end());
  const auto quantile_us = [&](std::size_t permille) {
    const std::size_t rank = (late_ns.size() * permille + 999) / 1000;
    return double(late_ns[rank - 1]) / 1e3;
  };
  row.median_us = quantile_us(500);
  row.p99_us = quantile_us(990);
  row.p999_us = quantile_us(999);
  row.max_us = quantile_us(1000);
  return row;
}

Result<JitterRow> measureJitterRow(double rate_hz, bool real_time, double seconds, LoopClock& clock,
                                   const Progress& progress, double from, double to) {
  const std::string step = std::to_string(std::lround(rate_hz)) + " Hz " + priorityName(real_time);
  progress.at(from, step);
  if (progress.cancelled()) return cancelled();

  std::vector<std::int64_t> late_ns(std::size_t(std::llround(seconds * rate_hz)));
  TickSchedule schedule(std::llround(1e9 / rate_hz));
  std::atomic<std::size_t> done{0};
  std::promise<bool> end;
  std::future<bool> granted = end.get_future();
  // Last, so that it has stopped and joined before anything it uses goes away.
  std::jthread thread([&](const std::stop_token& stop) {
    rt::nameThread("jitter");
    rt::sharpenTimers();  // as the haptic thread does
    const bool has_priority = real_time ? rt::requestRealTime(kPriority) : requestNormal();
    if (has_priority) {
      rt::NoAllocation guard;
      for (std::size_t i = 0; i < late_ns.size() && !stop.stop_requested(); ++i) {
        late_ns[i] = schedule.waitForTick(clock);
        done.store(i + 1, std::memory_order_relaxed);
      }
    }
    end.set_value(has_priority);
  });
  for (bool ended = false; !ended;) {
    ended = granted.wait_for(kReportEvery) == std::future_status::ready;
    const double fraction = double(done.load(std::memory_order_relaxed)) / double(late_ns.size());
    progress.at(from + (to - from) * fraction, step);
    if (progress.cancelled()) return cancelled();
  }
  if (!granted.get()) {
    if (real_time) return noRealTime();
    return Error{code::kNoNormalPriority, tr("Real-time priority could not be given up"), step, ""};
  }
  return summarizeJitter(rate_hz, real_time, std::move(late_ns), schedule.missed());
}

Result<JitterMeasurement> measureJitter(const JitterOptions& options,
                                        const std::filesystem::path& out,
                                        const Progress& progress) {
  if (!(options.seconds >= 0.1 && options.seconds <= 600.0)) {
    return Error{code::kBadArgument, tr("The time must lie between 0.1 and 600 seconds"),
                 "--seconds", ""};
  }
  if (!out.empty()) {
    if (Status made = makeFolder(out); !made) return made.error();
  }
  JitterMeasurement result;
  std::vector<bool> priorities{true, false};
  if (!canHaveRealTime()) {
    priorities = {false};
    result.advice = noRealTime().sentence();
  }
  HostClock clock;
  const double share = 1.0 / double(std::size(kRates_hz) * priorities.size());
  for (double rate_hz : kRates_hz) {
    for (bool real_time : priorities) {
      const double from = share * double(result.rows.size());
      Result<JitterRow> row = measureJitterRow(rate_hz, real_time, options.seconds, clock, progress,
                                               from, from + share);
      if (!row) return row.error();
      result.rows.push_back(*row);
    }
  }
  if (!out.empty()) {
    if (Status written = writeTextFile(out / "jitter.csv", jitterCsv(result)); !written) {
      return written.error();
    }
  }
  progress.at(1.0, "done");
  return result;
}

Json toJson(const JitterMeasurement& measurement) {
  Json rows = Json::array();
  for (const JitterRow& row : measurement.rows) {
    rows.push_back({{"rate_hz", row.rate_hz},
                    {"priority", priorityName(row.real_time)},
                    {"late_us",
                     {{"median", row.median_us},
                      {"p99", row.p99_us},
                      {"p999", row.p999_us},
                      {"max", row.max_us}}},
                    {"missed", row.missed},
                    {"ticks", row.ticks}});
  }
  Json advice = nullptr;
  if (!measurement.advice.empty()) advice = measurement.advice;
  return {{"rows", rows}, {"advice", advice}};
}

std::string toText(const JitterMeasurement& measurement) {
  std::string text =
      tr("late by [us]          median      99 %    99.9 %       max    missed     ticks\n");
  for (const JitterRow& row : measurement.rows) {
    char line[160];
    std::snprintf(line, sizeof(line), "%5.0f Hz  %-7s  %9.1f %9.1f %9.1f %9.1f %9llu %9llu\n",
                  row.rate_hz, priorityName(row.real_time), row.median_us, row.p99_us, row.p999_us,
                  row.max_us, static_cast<unsigned long long>(row.missed),
                  static_cast<unsigned long long>(row.ticks));
    text += line;
  }
  if (!measurement.advice.empty()) text += measurement.advice + "\n";
  return text;
}

}  // namespace trephine
