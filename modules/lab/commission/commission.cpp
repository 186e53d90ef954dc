#include "lab/commission/commission.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>

#include "base/file.h"
#include "base/local_time.h"
#include "base/memory.h"
#include "base/release.h"
#include "base/system.h"
#include "device/find_arms.h"
#include "headset/headset.h"
#include "lab/machine/jitter_measurement.h"
#include "lab/render/render_parts.h"
#include "render/display_probe.h"
#include "render/gl_limits.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr double kGB = 1e9, kMB = 1e6;
constexpr std::size_t kDiskTry = 256'000'000;  // bytes

Error stopped() {
  return {"CANCELLED", "The commissioning was cancelled", "commission", ""};
}

std::string machineName() {
  utsname system{};
  ::uname(&system);
  return std::to_string(std::thread::hardware_concurrency()) + " processors, " + system.sysname +
         " " + system.release;
}

class Run {
 public:
  Run(const CommissionOptions& options, const Progress& progress)
      : options_(options), progress_(progress) {}

  Status lateness();
  void memory();
  void disk();
  void clock();
  void devices();
  Status drawing();

  std::vector<CommissionCheck> checks;

 private:
  void add(const std::string& name, double value, std::string remark = "") {
    checks.push_back(judged(name, value, std::move(remark)));
  }
  void add(const std::string& name, Fitness verdict, const Error& why) {
    checks.push_back(notMeasured(name, verdict, why));
  }

  const CommissionOptions& options_;
  const Progress& progress_;
};

Status Run::lateness() {
  JitterOptions options;
  options.seconds = options_.seconds;
  const Result<JitterMeasurement> measured =
      measureJitter(options, {}, Progress(progress_, 0.0, 0.35));
  if (!measured) return measured.error();
  const bool granted = measured->advice.empty();
  add("priority", granted ? 1.0 : 0.0);
  for (const JitterRow& row : measured->rows) {
    const std::string name = "lateness_" + std::to_string(std::lround(row.rate_hz)) + "_" +
                             (row.real_time ? "fifo" : "normal");
    if (!commissionLimit(name)) continue;
    add(name, row.p999_us, std::to_string(row.missed) + " missed of " + std::to_string(row.ticks));
  }
  for (const char* rate : {"1000", "2000", "4000"}) {
    if (granted) continue;
    add(std::string("lateness_") + rate + "_fifo", Fitness::warn,
        {"NO_REAL_TIME", "Real-time priority was not granted", "", ""});
  }
  return {};
}

void Run::memory() {
  rlimit limit{};
  ::getrlimit(RLIMIT_MEMLOCK, &limit);
  constexpr double kEnough_MB = 1e6;  // stands for no limit; none holds root
  const bool unlimited = limit.rlim_cur == RLIM_INFINITY || ::geteuid() == 0;
  add("locked_memory", unlimited ? kEnough_MB : std::min(kEnough_MB, double(limit.rlim_cur) / kMB));
  const double pages = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE));
  add("memory", availableMemoryMb() * kMB / kGB,
      "of " + std::to_string(std::lround(pages / kGB)) + " GB");
}

// Written and held to be on the disk, beside the cases; gone again.
void Run::disk() {
  progress_.at(0.37, "disk");
  std::error_code ec;
  const auto failed = [&](const Error& why) {
    for (const char* name : {"disk_write", "disk_room"}) add(name, Fitness::fail, why);
  };
  fs::path existing = options_.storage;
  while (!fs::exists(existing, ec) && existing.has_parent_path()) existing = existing.parent_path();
  const fs::space_info space = fs::space(existing, ec);
  if (ec) return failed(writeError(options_.storage, ec.value()));
  add("disk_room", double(space.available) / kGB);
  const std::string file =
      (existing / (".trephine-commission-" + std::to_string(::getpid()))).string();
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd < 0) return add("disk_write", Fitness::fail, writeError(existing, errno));
  ::unlink(file.c_str());  // gone whatever happens
  const std::size_t size = std::min<std::size_t>(kDiskTry, space.available / 4);
  std::vector<char> block(4'000'000);
  for (std::size_t i = 0; i < block.size(); ++i) block[i] = char(i * 2654435761U >> 13);
  const auto begun = std::chrono::steady_clock::now();
  std::size_t done = 0;
  int error = 0;
  while (done < size && error == 0 && !progress_.cancelled()) {
    const ssize_t n = ::write(fd, block.data(), std::min(block.size(), size - done));
    if (n < 0 && errno != EINTR) error = errno;
    done += std::size_t(std::max<ssize_t>(n, 0));
  }
  if (error == 0 && ::fsync(fd) != 0) error = errno;
  ::close(fd);
  if (error != 0) return add("disk_write", Fitness::fail, writeError(existing, error));
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  add("disk_write", double(done) / kMB / std::max(seconds, 1e-6));
}

void Run::clock() {
  std::tm made{};
  ::strptime(kReleased, "%Y-%m-%d", &made);
  const double seconds = std::difftime(std::time(nullptr), ::timegm(&made));
  constexpr double kYear_s = 365.25 * 86400.0, kDay_s = 86400.0;  // a day for time zones
  add("clock", std::floor((seconds + kDay_s) / kYear_s * 100.0) / 100.0,
      localTime("%Y-%m-%d %H:%M"));
}

void Run::devices() {
  progress_.at(0.42, "devices");
  const FoundArms found = findArms(pluginFolder());
  std::size_t arms = 0;
  std::string models;
  for (const FoundArm& arm : found.arms) {
    if (arm.plugin == "simulated") continue;
    ++arms;
    models += (models.empty() ? "" : ", ") + arm.model;
  }
  add("arms", double(arms), models);
  add("headset", openXrInstalled() ? 1.0 : 0.0);
}

Status Run::drawing() {
  progress_.at(0.45, "pictures");
  const char* const kDrawn[] = {"opengl", "volume_edge", "frame_time", "removal_to_pixel",
                                "hand_to_tool"};
  if (const Status display = probeDisplay(); !display) {
    for (const char* name : kDrawn) add(name, Fitness::fail, display.error());
    return {};
  }
  RenderOptions options;
  options.rotate_s = std::min(3.0, options_.seconds);
  options.cut_s = std::min(6.0, std::max(2.0, options_.seconds));
  auto renderer = SceneRenderer::offscreen(64, 64);
  if (!renderer) {
    for (const char* name : kDrawn) add(name, Fitness::fail, renderer.error());
    return {};
  }
  (*renderer)->paint(0);
  const std::string driver = (*renderer)->openGlDescription();
  add("opengl", isSoftware(driver) ? 0.0 : 1.0, driver);
  checks.push_back(judged("volume_edge", largestVolumeEdge(), "", options_.largest_edge));
  renderer->reset();
  Result<std::vector<RenderSubject>> subjects = renderSubjects("", Progress(progress_, 0.45, 0.55));
  if (!subjects) return subjects.error();
  RenderMeasurement measured;
  const Status turned =
      measureRotation(subjects->front(), options, Progress(progress_, 0.55, 0.7), measured);
  if (progress_.cancelled()) return stopped();
  turned ? add("frame_time", measured.rows.back().ms_median)
         : add("frame_time", Fitness::fail, turned.error());
  const Status cut = measureExercises(*subjects, options, Progress(progress_, 0.7, 1.0), measured);
  if (progress_.cancelled()) return stopped();
  if (!cut) {
    add("removal_to_pixel", Fitness::fail, cut.error());
    add("hand_to_tool", Fitness::fail, cut.error());
    return {};
  }
  add("removal_to_pixel", measured.removal_max_ms);
  add("hand_to_tool", measured.hand_p99_ms);
  return {};
}

}  // namespace

Fitness fitnessOf(const Commissioning& of) {
  Fitness worst = Fitness::pass;
  for (const CommissionCheck& check : of.checks) worst = std::max(worst, check.verdict);
  return worst;
}

Result<Commissioning> commission(const CommissionOptions& options, const Progress& progress) {
  if (!(options.seconds >= 0.2 && options.seconds <= 60.0)) {
    return Error{"BAD_OPTION", "Seconds are from 0.2 to 60", "commission", "Give others"};
  }
  Commissioning result{{}, localTime("%Y-%m-%d %H:%M"), buildName(), machineName()};
  Run run(options, progress);
  if (Status late = run.lateness(); !late) {
    return late.error().code == "CANCELLED" ? stopped() : late.error();
  }
  run.memory();
  run.disk();
  run.clock();
  run.devices();
  if (progress.cancelled()) return stopped();
  if (Status drawn = run.drawing(); !drawn) {
    return drawn.error().code == "CANCELLED" ? stopped() : drawn.error();
  }
  result.checks = std::move(run.checks);
  progress.at(1.0, "done");
  return result;
}

std::vector<CommissionChange> changesSince(const Commissioning& before, const Commissioning& now) {
  constexpr double kWorse = 1.25;
  std::vector<CommissionChange> changes;
  for (const CommissionCheck& check : now.checks) {
    const auto same = std::ranges::find(before.checks, check.name, &CommissionCheck::name);
    if (same == before.checks.end()) continue;
    const CommissionLimit* by = commissionLimit(check.name);
    bool worse = false;
    if (by && same->value && check.value) {
      worse = by->at_least ? *check.value * kWorse < *same->value
                           : *check.value > kWorse * std::max(*same->value, 0.1 * by->warn);
    }
    if (same->verdict == check.verdict && !(worse && check.verdict != Fitness::pass)) continue;
    changes.push_back(
        {check.words, same->verdict, check.verdict, same->value, check.value, check.unit});
  }
  return changes;
}

}  // namespace trephine
