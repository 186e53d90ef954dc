// Real arms, or emulated ones, in a real exercise: what is lost between a sample and the force that
// answers it, and how soon the force goes when a device does.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/progress.h"
#include "base/result.h"
#include "device/device_bench.h"
#include "haptics/arm_dynamics.h"
#include "machine/common/spread.h"

namespace trephine {

struct DeviceOptions {
  std::vector<std::filesystem::path> benches;  // libraries; none: what is plugged in
  double seconds = 60.0;                       // of the closed loop, 1 to 600
  int trials = 20;                             // of each trouble, 0 to 1000; with a bench alone
};

// One order of the loop's calls on the arms, without tissue: from a sample at the arm to the force
// that answers it there, or, where no bench tells, to the end of the plugin's write; and what the
// arm may then show (renderable()), beside what it may with the delay that the plugin states.
struct DelayRow {
  std::string order;  // "send, then wait"; "wait, then send", as before
  Spread delay_ms;
  bool at_the_arm = false;
  std::uint64_t missing = 0, late = 0;  // forces at the arm that no tick sent, or an older one
  double delay_samples = 0.0;           // at p99, the product's own loop's where that is longer
  Renderable most, stated_most;
  double stated_ms = 0.0;
  double encoder_k_max = 0.0;  // without any delay
};

struct DeviceRow {
  std::string plugin;
  std::size_t arms = 0;
  double seconds = 0.0;
  std::uint64_t ticks = 0, missed = 0, faults = 0;
  std::optional<std::uint64_t> reports_lost;  // on their way, as a bench tells
  std::uint64_t reports_skipped = 0;  // that no tick looked at: of two clocks, or a late tick
  Spread report_age_ms;               // when it was looked at
  Spread sample_to_force_ms;          // at the arm where a bench tells, else to the plugin
  bool at_the_arm = false;
  std::optional<std::uint64_t> force_mismatches;  // forces at the arms that no tick sent
  std::uint64_t forces_late = 0;                  // of a tick whose successor was sent 3 ms before
  long page_faults = 0;
  int unplugged = 0, blocked = 0, replayed = 0;  // trials; recordings that replay bit for bit
  int failed = 0;                                // trials that did not come to their end,
  std::string failure;                           // the last of them
  Spread unplug_to_zero_ms, block_to_zero_ms;    // until the loop sends none
  Spread block_at_arm_ms;  // for how long the arm itself still had force, all told
  Spread stop_ms;
  std::vector<DelayRow> delays;
};

struct DeviceMeasurement {
  std::vector<DeviceRow> rows;
};

// One trouble in mid-cut, at a moment that nobody knows, with force on the first arm: how long
// until there is none, how long Stop takes, and whether the recording replays bit for bit.
struct DeviceTrial {
  double zero_ms = 0.0, at_arm_ms = 0.0, stop_ms = 0.0;
  bool replayed = false;
};
struct TrialOptions {
  std::filesystem::path bench;
  bool unplug = true;   // or a call that blocks for a second
  double wait_s = 1.0;  // from the exercise's start
};
// The file of its --out folder in which trephine-measure tells what came of one trial.
inline constexpr const char* kTrialAnswer = "trial.json";
// In a program of its own, since a device that blocked is left behind. Errors: NO_BENCH, NO_DEVICE,
// those of sessions.
Result<DeviceTrial> tryDevice(const TrialOptions& options, const std::filesystem::path& recording);
Json toJson(const DeviceTrial& trial);

// Each trial is this program once more. Writes devices.csv into `out`, and the recordings of trials
// that fail. Errors: NO_DEVICE, BAD_ARGUMENT, CANCELLED, CANNOT_WRITE, those of sessions.
Result<DeviceMeasurement> measureDevices(const DeviceOptions& options,
                                         const std::filesystem::path& out,
                                         const Progress& progress = Progress());

// {rows: [{plugin, arms, seconds, ticks, missed, faults, reports_lost, reports_skipped,
//  report_age_ms: {median, p99, max, count}, sample_to_force_ms: likewise, at_the_arm,
//  force_mismatches (null: not told), forces_late (likewise), page_faults, unplug_to_zero_ms:
//  likewise, block_to_zero_ms, block_at_arm_ms, stop_ms, trials, failed, replayed, delays: [{order,
//  delay_ms, delay_samples, at_the_arm, forces_missing, forces_late, b_max, k_max, encoder_k_max,
//  stated_ms, stated_b_max, stated_k_max}]}]}
Json toJson(const DeviceMeasurement& measurement);
std::string toText(const DeviceMeasurement& measurement);

}  // namespace trephine
