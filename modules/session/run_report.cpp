#include "session/run_report.h"

#include <cstdio>

#include "base/tr.h"
#include "base/utf8.h"
#include "session/codes.h"

namespace trephine {

namespace {

struct FaultName {
  std::uint32_t fault;
  const char* name;   // in answers
  const char* words;  // what it did to the arm
};
constexpr FaultName kFaultNames[] = {
    {kFaultNonFinite, "non_finite",
     trLater("a pose or a force was not a number: no force from then on")},
    {kFaultLate, "late",
     trLater("a step came more than 20 ms late: no force for a second or more")},
    {kFaultDeviceLost, "lost", trLater("the arm did not answer: no force from then on")},
    {kFaultStalled, "stalled",
     trLater("the third such stall within 30 s, or one of over 2 s: no force from then on")},
    {kFaultDevice, "device_error",
     trLater("the arm reported an error that passes: no force until a second after it")},
    {kFaultDeviceOften, "device_errors",
     trLater("the third such error within 10 s: no force from then on")},
    {kFaultStuck, "stuck", trLater("the arm stopped answering for good and was left behind")},
};

const FaultName& nameOf(std::uint32_t fault) {
  for (const FaultName& name : kFaultNames) {
    if (name.fault == fault) return name;
  }
  return kFaultNames[0];
}

}  // namespace

Error memoryNotLocked(const std::string& reason) {
  return {
      code::kMemoryNotLocked,
      tr("The haptic thread's memory is not held in place ({}), so ticks may come late when the "
         "system is short of memory",
         reason),
      tr("the limit on locked memory"),
      tr("Add the account to the group trephine, which the package gives it, or set 'memlock' to "
         "'unlimited' for it in /etc/security/limits.d, and log in again")};
}

Json toJson(const RunReport& report) {
  Json arms = Json::array();
  for (const RunMetrics::Arm& arm : report.done.arms) {
    arms.push_back({{"name", arm.name},
                    {"max_force_N", arm.max_force_N},
                    {"contact_ticks", arm.contact_ticks},
                    {"energy_out_mJ", arm.energy_out_J * 1e3},
                    {"removed_mm3", arm.removed_mm3}});
  }
  Json removed = Json::object();
  for (const auto& [tissue, mm3] : report.done.removed_mm3) removed[tissue] = mm3;
  Json faults = Json::array();
  for (const ArmFault& f : report.done.faults) {
    faults.push_back({{"tick", f.tick},
                      {"arm", report.done.arms[std::size_t(f.arm)].name},
                      {"fault", nameOf(f.fault).name}});
  }
  Json warnings = Json::array();
  for (const Warning& w : report.warnings) {
    warnings.push_back({{"code", w.code.str()}, {"text", w.text}});
  }
  const auto file = [](const std::string& name) { return name.empty() ? Json(nullptr) : Json(name); };
  return {{"controller", report.done.controllers.back()},
          {"controllers", report.done.controllers},
          {"ticks", report.done.ticks},
          {"rate_hz", report.done.rate_hz},
          {"arms", arms},
          {"removed_mm3", removed},
          {"removed_unnamed_mm3", report.done.removed_unnamed_mm3},
          {"removed_voxels", report.done.removed_voxels},
          {"undos", report.done.undos},
          {"rewinds", report.done.rewinds},
          {"brought_back_mm3", report.done.brought_back_mm3},
          {"structures_cut", toJson(report.structures_cut)},
          {"missed_deadlines", report.machine.missed_deadlines},
          {"faults", faults},
          {"warnings", warnings},
          {"memory_locked",
           report.machine.memory_locked ? Json(*report.machine.memory_locked) : Json(nullptr)},
          {"nonfinite", report.machine.nonfinite},
          {"events_dropped", report.machine.events_dropped},
          {"recorder_behind_ms", report.machine.recorder_behind_ms},
          {"tick_ns",
           {{"median", report.machine.tick_ns.median_ns},
            {"p99", report.machine.tick_ns.p99_ns},
            {"p999", report.machine.tick_ns.p999_ns},
            {"max", report.machine.tick_ns.max_ns}}},
          {"volume_sha256_before", report.volume_sha256_before},
          {"volume_sha256", report.volume_sha256},
          {"recording", file(report.recording)},
          {"picture", file(report.picture)},
          {"volume", file(report.volume)},
          {"table", file(report.table)}};
}

std::string toText(const RunReport& report) {
  char line[256];
  std::string text;
  const auto add = [&](auto... values) {
    std::snprintf(line, sizeof(line), values...);
    text += line;
  };
  add("%.1f s of touch at %.0f Hz, controller '%s'", double(report.done.ticks) / report.done.rate_hz,
      report.done.rate_hz, report.done.controllers.front().c_str());
  constexpr std::size_t kNamed = 4;
  for (std::size_t i = 1; i < report.done.controllers.size() && i < kNamed; ++i) {
    text += tr(", later '{}'", report.done.controllers[i]);
  }
  if (report.done.controllers.size() > kNamed) text += tr(" and so on");
  text += "\n";
  for (const RunMetrics::Arm& arm : report.done.arms) {
    add("  %-6s  in tissue %.1f s, at most %.2f N, removed %.0f mm3\n", arm.name.c_str(),
        double(arm.contact_ticks) / report.done.rate_hz, arm.max_force_N,
        arm.removed_mm3);
  }
  for (const auto& [tissue, mm3] : report.done.removed_mm3) {
    if (mm3 > 0.0) add("  removed of %s: %.1f mm3\n", tissue.c_str(), mm3);
  }
  if (report.done.removed_unnamed_mm3 > 0.0) {
    add("  removed of no tissue of the exercise, or at an edge: %.1f mm3\n",
        report.done.removed_unnamed_mm3);
  }
  if (const std::uint64_t back = report.done.undos + report.done.rewinds; back > 0) {
    add("  taken back %llu times (%llu by undo): %.0f mm3 were cut and put back\n",
        static_cast<unsigned long long>(back), static_cast<unsigned long long>(report.done.undos),
        report.done.brought_back_mm3);
  }
  for (const std::string& cut : linesOf(report.structures_cut)) text += "  " + cut + "\n";
  add("  a tick took %.1f us (median), %.1f us (99 %%); %llu deadlines missed\n",
      report.machine.tick_ns.median_ns / 1e3, report.machine.tick_ns.p99_ns / 1e3,
      static_cast<unsigned long long>(report.machine.missed_deadlines));
  for (const Warning& warning : report.warnings) text += "  " + cleanUtf8(warning.text) + "\n";
  constexpr std::size_t kShown = 10;
  for (std::size_t i = 0; i < report.done.faults.size(); ++i) {
    if (i == kShown) {
      add("  and %zu more faults\n", report.done.faults.size() - kShown);
      break;
    }
    const ArmFault& f = report.done.faults[i];
    add("  FAULT at %.3f s, %s: %s\n", double(f.tick) / report.done.rate_hz,
        report.done.arms[std::size_t(f.arm)].name.c_str(), tr(nameOf(f.fault).words).c_str());
  }
  if (report.machine.memory_locked == false) {
    text += "  " + memoryNotLocked(report.machine.memory_not_locked).sentence() + "\n";
  }
  if (!report.recording.empty()) {
    text += tr("  session: {}\n", cleanUtf8(report.recording));
    constexpr double kUsual_ms = 500.0;  // it is written in slices of 0.25 s
    if (report.machine.recorder_behind_ms > kUsual_ms) {
      add("  the recording was at most %.0f ms behind\n", report.machine.recorder_behind_ms);
    }
  }
  if (!report.picture.empty()) text += tr("  picture: {}\n", cleanUtf8(report.picture));
  if (!report.volume.empty()) text += tr("  volume: {}\n", cleanUtf8(report.volume));
  if (!report.table.empty()) text += tr("  table: {}\n", cleanUtf8(report.table));
  return text;
}

}  // namespace trephine
