// How late does this machine wake a thread that ticks as the haptic loop does?
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "haptics/loop_clock.h"

namespace trephine {

// The ticks do no work of their own, so that the lateness is the system's alone. A quantile is the
// least lateness seen that so many of the ticks did not exceed; missed is later than half a period.
struct JitterRow {
  double rate_hz = 0.0;
  bool real_time = false;
  double median_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0;
  std::uint64_t missed = 0, ticks = 0;
};

struct JitterMeasurement {
  std::vector<JitterRow> rows;
  std::string advice;  // how to get real-time priority; empty where it was had
};

struct JitterOptions {
  double seconds = 5.0;  // a row, 0.1 to 600
};

JitterRow summarizeJitter(double rate_hz, bool real_time, std::vector<std::int64_t> late_ns,
                          std::uint64_t missed);

// One row on a fresh thread, which takes its priority with it when it ends; the row is the part of
// the progress from `from` to `to`. Errors: CANCELLED, NO_REAL_TIME (says how to get it).
Result<JitterRow> measureJitterRow(double rate_hz, bool real_time, double seconds, LoopClock& clock,
                                   const Progress& progress, double from = 0.0, double to = 1.0);

// 1000, 2000 and 4000 Hz, each with real-time priority, where the system grants it, and without.
// Writes jitter.csv into the folder `out` unless that is empty. Errors: BAD_ARGUMENT, CANCELLED,
// CANNOT_WRITE.
Result<JitterMeasurement> measureJitter(const JitterOptions& options,
                                        const std::filesystem::path& out = {},
                                        const Progress& progress = Progress());

// {rows:[{rate_hz, priority (fifo or normal), late_us:{median, p99, p999, max}, missed, ticks}],
//  advice (null: none needed)}
Json toJson(const JitterMeasurement& measurement);
std::string toText(const JitterMeasurement& measurement);

}  // namespace trephine
