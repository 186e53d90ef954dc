#include "machine/commission/commission.h"

#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <thread>

#include "base/codes.h"
#include "base/local_time.h"
#include "base/memory.h"
#include "base/release.h"
#include "base/system.h"
#include "base/tr.h"
#include "headset/headset.h"
#include "machine/codes.h"
#include "machine/commission/arm_checks.h"
#include "machine/commission/disk_check.h"
#include "machine/drawing/drawing_parts.h"
#include "machine/ticks/jitter_measurement.h"
#include "machine/trades/trades_measurement.h"
#include "render/codes.h"
#include "render/display_probe.h"
#include "render/gl_limits.h"

namespace trephine {

namespace {

constexpr double kGB = 1e9, kMB = 1e6;
constexpr std::size_t kDiskTry = 256'000'000;  // bytes
constexpr double kDiskMost_s = 20.0;
constexpr double kRates_hz[] = {1000.0, 2000.0, 4000.0};  // of which lateness is asked

Error stopped() {
  return {code::kCancelled, tr("The commissioning was cancelled"), "commission", ""};
}

std::string machineName() {
  utsname system{};
  ::uname(&system);
  const std::string release = system.release;
  return std::to_string(std::thread::hardware_concurrency()) + " processors, " + system.sysname +
         " " + release.substr(0, release.find('-')) +
         (::geteuid() == 0 ? ", as an administrator" : "");
}

// No limit holds root: what it has says nothing of those who practise.
std::string rootsOwn() {
  return ::geteuid() == 0 ? tr("an administrator always has it: commission as one who practises")
                          : "";
}

class Run {
 public:
  Run(const CommissionOptions& options, const Progress& progress)
      : options_(options), progress_(progress) {}

  Status lateness();
  void memory();
  Status trades();
  void take(std::vector<CommissionCheck> more) {
    checks.insert(checks.end(), more.begin(), more.end());
  }
  Status drawing();

  std::vector<CommissionCheck> checks;
  std::vector<RecommendedSetting> recommended;

 private:
  void add(const std::string& name, double value, std::string remark = "") {
    checks.push_back(judged(name, value, std::move(remark)));
  }
  void add(const std::string& name, Fitness verdict, const Error& why) {
    checks.push_back(notMeasured(name, verdict, why));
  }

  const CommissionOptions& options_;
  const Progress& progress_;
  bool granted_ = false;  // real-time priority
};

std::string latenessName(double rate_hz, bool real_time) {
  return "lateness_" + std::to_string(std::lround(rate_hz)) + (real_time ? "_fifo" : "_normal");
}

Status Run::lateness() {
  JitterOptions options;
  options.seconds = options_.seconds;
  const Result<JitterMeasurement> measured =
      measureJitter(options, {}, Progress(progress_, 0.0, 0.35, tr("How late ticks come")));
  if (!measured) return measured.error();
  granted_ = measured->advice.empty();
  add("priority", granted_ ? 1.0 : 0.0, rootsOwn());
  for (const JitterRow& row : measured->rows) {
    CommissionCheck check = judged(latenessName(row.rate_hz, row.real_time), row.p999_us,
                                   tr("{} missed of {}", row.missed, row.ticks));
    if (granted_ && !row.real_time) {  // an exercise has priority then
      check.verdict = Fitness::pass;
      check.next.clear();
      check.remark += tr("; matters only where priority is not granted");
    }
    checks.push_back(std::move(check));
  }
  for (const double rate_hz : kRates_hz) {
    if (granted_) continue;
    add(latenessName(rate_hz, true), Fitness::warn,
        {code::kNoRealTime, tr("Real-time priority was not granted"), "",
         commissionLimit("priority")->next});
  }
  return {};
}

void Run::memory() {
  rlimit limit{};
  ::getrlimit(RLIMIT_MEMLOCK, &limit);
  constexpr double kEnough_MB = 1e6;  // stands for no limit; none holds root
  const bool unlimited = limit.rlim_cur == RLIM_INFINITY || ::geteuid() == 0;
  add("locked_memory", unlimited ? kEnough_MB : std::min(kEnough_MB, double(limit.rlim_cur) / kMB),
      rootsOwn());
  const double pages = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE));
  add("memory", availableMemoryMb() * kMB / kGB, tr("of {} GB", std::lround(pages / kGB)));
}

// The best of what this machine keeps: a rate whose ticks come late here is not recommended.
Status Run::trades() {
  TradesOptions options;
  options.ray_distances.clear();
  options.strokes = 3;  // the worst of them: costs are what a machine differs in
  // A rate is kept where it and every lower one is; 1000 Hz and less are what exercises have.
  double kept_hz = 1000.0;
  for (const double rate_hz : kRates_hz) {
    const auto of =
        std::ranges::find(checks, latenessName(rate_hz, granted_), &CommissionCheck::name);
    if (of == checks.end() || of->verdict != Fitness::pass) break;
    kept_hz = rate_hz;
  }
  std::erase_if(options.rates_hz, [&](double rate_hz) { return rate_hz > kept_hz; });
  const Result<TradesMeasurement> measured =
      measureTrades(options, {}, Progress(progress_, 0.35, 0.42, tr("What touch costs")));
  if (!measured) return measured.error();
  recommended = recommendedOf(measured->rows);
  std::string words;
  double cost = std::nan("");
  for (const RecommendedSetting& setting : recommended) {
    words += (words.empty() ? "" : ", ") + setting.knob + " " + setting.setting;
    if (setting.knob == "rate_hz") cost = setting.cost;
  }
  add("touch_cost", cost, words);
  return {};
}

Status Run::drawing() {
  progress_.at(0.5, tr("Pictures"));
  const char* const kDrawn[] = {"screen",     "opengl",           "volume_edge",
                                "frame_time", "removal_to_pixel", "hand_to_tool"};
  if (const Status display = probeDisplay(); !display) {
    Error why = display.error();
    // A virtual screen would be measured in the place of the one that is looked at.
    if (why.code == code::kNoDisplay) why.next = tr("Commission inside a desktop session");
    for (const char* name : kDrawn) add(name, Fitness::fail, why);
    return {};
  }
  DrawingOptions options;
  options.rotate_s = std::min(3.0, options_.seconds);
  options.cut_s = std::min(6.0, std::max(2.0, options_.seconds));
  auto renderer = SceneRenderer::offscreen(64, 64);
  if (!renderer) {
    for (const char* name : kDrawn) add(name, Fitness::fail, renderer.error());
    return {};
  }
  (*renderer)->paint(0);
  checks.push_back(judgedScreen((*renderer)->screenSize()));
  checks.push_back(judgedCard((*renderer)->openGlDescription()));
  checks.push_back(judged("volume_edge", largestVolumeEdge(), "", options_.largest_edge));
  renderer->reset();
  Result<std::vector<RenderSubject>> subjects =
      renderSubjects("", Progress(progress_, 0.5, 0.58, tr("Pictures")));
  if (!subjects) return subjects.error();
  const auto turned = measureTurning(subjects->front(), options,
                                     Progress(progress_, 0.58, 0.72, tr("A camera that turns")));
  if (progress_.cancelled()) return stopped();
  turned ? add("frame_time", turned->ms_median) : add("frame_time", Fitness::fail, turned.error());
  const auto cut = measureCutting(
      *subjects, options, Progress(progress_, 0.72, 1.0, tr("Exercises as they are drawn")));
  if (progress_.cancelled()) return stopped();
  if (!cut) {
    add("removal_to_pixel", Fitness::fail, cut.error());
    add("hand_to_tool", Fitness::fail, cut.error());
    return {};
  }
  add("removal_to_pixel", cut->removal_max_ms);
  add("hand_to_tool", cut->hand_p99_ms);
  return {};
}

}  // namespace

CommissionCheck judgedClock(std::time_t now, const std::string& shown) {
  std::tm made{};
  ::strptime(kReleased, "%Y-%m-%d", &made);
  const double seconds = std::difftime(now, ::timegm(&made));
  constexpr double kYear_s = 365.25 * 86400.0, kDay_s = 86400.0;  // a day for time zones
  return judged("clock", std::floor((seconds + kDay_s) / kYear_s * 100.0) / 100.0, shown);
}

Fitness fitnessOf(const Commissioning& of) {
  Fitness worst = Fitness::pass;
  for (const CommissionCheck& check : of.checks) worst = std::max(worst, check.verdict);
  return worst;
}

Result<Commissioning> commission(const CommissionOptions& options, const Progress& progress) {
  if (!(options.seconds >= 0.2 && options.seconds <= 60.0)) {
    return Error{code::kBadOption, tr("Seconds are from 0.2 to 60"), "commission",
                 tr("Give others")};
  }
  if (!(options.patience_s >= 0.0 && options.patience_s <= 600.0)) {
    return Error{code::kBadOption, tr("Arms are waited for from 0 to 600 s"), "commission",
                 tr("Give others")};
  }
  Commissioning result{{}, localTime("%Y-%m-%d %H:%M"), buildName(), machineName(), {}};
  Run run(options, progress);
  if (Status late = run.lateness(); !late) {
    return late.error().code == code::kCancelled ? stopped() : late.error();
  }
  if (Status traded = run.trades(); !traded) {
    return traded.error().code == code::kCancelled ? stopped() : traded.error();
  }
  run.memory();
  progress.at(0.42, tr("The disk"));
  run.take(checkDisk(options.storage, kDiskTry, kDiskMost_s, progress, options.storage_is_set));
  run.take({judgedClock(std::time(nullptr), localTime("%Y-%m-%d %H:%M"))});
  run.take(checkArms(options.patience_s, Progress(progress, 0.44, 0.5)));
  run.take({judged("headset", openXrInstalled() ? 1.0 : 0.0)});
  if (progress.cancelled()) return stopped();
  if (Status drawn = run.drawing(); !drawn) {
    return drawn.error().code == code::kCancelled ? stopped() : drawn.error();
  }
  result.checks = std::move(run.checks);
  result.recommended = std::move(run.recommended);
  progress.at(1.0, "done");
  return result;
}

std::vector<CommissionChange> changesSince(const Commissioning& before, const Commissioning& now) {
  // A disk is twice as fast from one minute to the next; of ticks the verdict alone is told.
  constexpr double kMuchWorse = 1.25, kTwice = 2.0;
  std::vector<CommissionChange> changes;
  for (const CommissionCheck& check : now.checks) {
    const auto same = std::ranges::find(before.checks, check.name, &CommissionCheck::name);
    if (same == before.checks.end()) continue;
    const CommissionLimit* by = commissionLimit(check.name);
    bool worse = false;
    const double times = check.name == "disk_write" ? kTwice : kMuchWorse;
    const bool ticks = check.name.starts_with("lateness");
    if (by && !ticks && same->value && check.value) {
      worse = by->at_least ? *check.value * times < *same->value
                           : *check.value > times * std::max(*same->value, 0.1 * by->warn);
    }
    if (same->verdict == check.verdict && !(worse && check.verdict != Fitness::pass)) continue;
    changes.push_back(
        {check.words, same->verdict, check.verdict, same->value, check.value, check.unit});
  }
  return changes;
}

}  // namespace trephine
