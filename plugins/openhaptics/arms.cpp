#include "arms.h"

#include <time.h>

#include <algorithm>
#include <cerrno>

namespace trephine::openhaptics {

using plugin::now_ns;

namespace {

// Without a command for so long the arms get nothing: the host stands still.
constexpr std::int64_t kSilentHost_ns = 50'000'000;
// An arm that is warm says so frame by frame.
constexpr std::int64_t kWarm_ns = 200'000'000;
constexpr int kLastFrames_ms = 20;  // for them when it stops
constexpr int kMostErrors = 16;     // taken in a frame
constexpr int kAttempts = 100;      // to read what another thread writes

bool waitUntil(sem_t& semaphore, std::int64_t ns) {
  const timespec until{time_t(ns / 1'000'000'000), long(ns % 1'000'000'000)};
  int answer;
  do {
    answer = sem_clockwait(&semaphore, CLOCK_MONOTONIC, &until);
  } while (answer != 0 && errno == EINTR);
  return answer == 0;
}

}  // namespace

Arms::Arms(const Library& hd, const plugin::Silence& silence) : hd_(hd), silence_(silence) {
  sem_init(&came_, 0, 0);
  sem_init(&answered_, 0, 0);
}

Arms::~Arms() {
  stop();
  close();
  sem_destroy(&came_);
  sem_destroy(&answered_);
}

void Arms::close() {
  for (HHD handle : handles_) hd_.disableDevice(handle);
  handles_.clear();
  names_.clear();
}

std::string Arms::name(std::size_t arm) const {
  return names_[arm].empty() ? "The default arm" : "The arm '" + names_[arm] + "'";
}

std::string Arms::why(const std::string& what) const {
  const HDErrorInfo error = hd_.getError();
  const char* words = error.code != 0 ? hd_.getErrorString(error.code) : nullptr;
  return what + (words ? std::string(" (") + words + ")." : std::string("."));
}

std::string Arms::open(const std::vector<std::string>& names) {
  close();
  for (const std::string& each : names) {
    names_.push_back(each);
    const HHD handle = hd_.initDevice(each.empty() ? nullptr : each.c_str());
    if (handle == kInvalidHandle) {
      return why(name(names_.size() - 1) +
                 " does not answer: connect it, switch it on, and check its name in the maker's "
                 "set-up");
    }
    handles_.push_back(handle);
  }
  return {};
}

std::string Arms::calibrate(std::size_t arm) {
  hd_.makeCurrentDevice(handles_[arm]);
  HDenum state = hd_.checkCalibration();
  // What the arm does by itself, or with its stylus in the inkwell. A reset of its encoders would
  // take the place where it happens to be for its middle.
  const int styles = integer(arm, kCalibrationStyle);
  if (state == kCalibrationNeedsUpdate && (styles & (kStyleAuto | kStyleInkwell))) {
    hd_.updateCalibration(HDenum(styles & kStyleAuto ? kStyleAuto : kStyleInkwell));
    state = hd_.checkCalibration();
  }
  if (state == kCalibrationOk) return {};
  return name(arm) +
         " is not calibrated: put its stylus into the inkwell or move it through its range, as the "
         "maker's set-up asks, and start again.";
}

double Arms::number(std::size_t arm, HDenum which) {
  hd_.makeCurrentDevice(handles_[arm]);
  double value = 0.0;
  hd_.getDoublev(which, &value);
  return value;
}

int Arms::integer(std::size_t arm, HDenum which) {
  hd_.makeCurrentDevice(handles_[arm]);
  int value = 0;
  hd_.getIntegerv(which, &value);
  return value;
}

std::array<double, 6> Arms::workspace_mm(std::size_t arm) {
  hd_.makeCurrentDevice(handles_[arm]);
  std::array<double, 6> box{};
  hd_.getDoublev(kUsableWorkspace, box.data());
  return box;
}

std::string Arms::start(double rate_hz) {
  for (int i = 0; i < kMostErrors && hd_.getError().code != 0; ++i) {
  }
  hd_.setSchedulerRate((unsigned long)rate_hz);
  if (const HDErrorInfo error = hd_.getError(); error.code != 0) {
    const char* words = hd_.getErrorString(error.code);
    return "The maker's scheduler does not take its rate (" + std::string(words ? words : "") +
           "): give 'rate_hz' as 500, 1000 or 1600, as the arm can.";
  }
  for (std::size_t arm = 0; arm < count(); ++arm) {
    errors_[arm] = lost_[arm] = false;
    warm_ns_[arm] = 0;
    for (std::atomic<double>& along : forces_N_[arm]) along = 0.0;
    hd_.makeCurrentDevice(handles_[arm]);
    hd_.enable(kForceOutput);
  }
  commanded_ns_ = 0;
  number_ = ended_ = 0;
  told_ = Samples{};
  taken_N_ = {};
  answer_ns_ = std::int64_t(0.5e9 / rate_hz);
  while (sem_trywait(&came_) == 0) {
  }
  scheduled_ = hd_.scheduleAsynchronous(&servo, this, kPriority);
  hd_.startScheduler();
  running_ = true;
  if (waitForOther(0, 1.0)) return {};
  stop();
  return why(name(0) + " gives no samples: the maker's scheduler does not run");
}

void Arms::stop() {
  if (!running_) return;
  running_ = false;
  // Two more frames, without a command: the last has sent zero.
  commanded_ns_ = 0;
  const std::uint64_t until = ended_ + 2;
  for (int i = 0; i < kLastFrames_ms && ended_ < until; ++i) {
    const timespec millisecond{0, 1'000'000};
    nanosleep(&millisecond, nullptr);
  }
  hd_.stopScheduler();
  hd_.unschedule(scheduled_);
  for (HHD handle : handles_) {
    hd_.makeCurrentDevice(handle);
    hd_.disable(kForceOutput);
  }
}

const Arms::Samples& Arms::latest() {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Samples out;
    const std::uint64_t before = version_.load(std::memory_order_acquire);
    for (std::size_t arm = 0; arm < count(); ++arm) {
      for (std::size_t i = 0; i < 16; ++i) {
        out.of[arm].transform[i] = transforms_[arm][i].load(std::memory_order_relaxed);
      }
      out.of[arm].buttons = buttons_[arm].load(std::memory_order_relaxed);
      out.of[arm].in_holder = in_holder_[arm].load(std::memory_order_relaxed);
    }
    out.time_ns = time_ns_.load(std::memory_order_relaxed);
    out.number = number_.load(std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_acquire);
    if (before % 2 != 0 || version_.load(std::memory_order_relaxed) != before) continue;
    told_ = out;
    break;
  }
  return told_;
}

bool Arms::waitForOther(std::uint64_t given, double timeout_s) {
  const std::int64_t until_ns = now_ns() + std::int64_t(timeout_s * 1e9);
  while (number_.load(std::memory_order_acquire) == given) {
    if (!waitUntil(came_, until_ns)) return false;
  }
  return true;
}

void Arms::command(const std::array<std::array<double, 3>, kMostArms>& forces_N) {
  forces_version_.fetch_add(1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  for (std::size_t arm = 0; arm < count(); ++arm) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      forces_N_[arm][axis].store(forces_N[arm][axis], std::memory_order_relaxed);
    }
  }
  forces_version_.fetch_add(1, std::memory_order_release);
  commanded_ns_ = now_ns();
  sem_post(&answered_);
}

// The newest command into taken_N_, all of it or none.
void Arms::takeForces() {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::array<std::array<double, 3>, kMostArms> out{};
    const std::uint64_t before = forces_version_.load(std::memory_order_acquire);
    for (std::size_t arm = 0; arm < count(); ++arm) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        out[arm][axis] = forces_N_[arm][axis].load(std::memory_order_relaxed);
      }
    }
    std::atomic_thread_fence(std::memory_order_acquire);
    if (before % 2 != 0 || forces_version_.load(std::memory_order_relaxed) != before) continue;
    taken_N_ = out;
    return;
  }
}

bool Arms::warm(std::size_t arm) const {
  const std::int64_t said_ns = warm_ns_[arm];
  return said_ns != 0 && now_ns() - said_ns < kWarm_ns;
}

std::uint32_t Arms::servo(void* self) {
  static_cast<Arms*>(self)->frame();
  return kCallbackContinue;
}

void Arms::takeErrors() {
  for (int i = 0; i < kMostErrors; ++i) {
    const HDErrorInfo error = hd_.getError();
    if (error.code == 0) return;
    const bool scheduler = error.code >= kFirstScheduler && error.code <= kLastScheduler;
    const bool fault = scheduler || (error.code >= kFirstLost && error.code <= kLastLost);
    const bool of_one = std::find(handles_.begin(), handles_.end(), error.device) != handles_.end();
    for (std::size_t arm = 0; arm < count(); ++arm) {
      // A fault of nobody's is everybody's.
      const bool concerned = handles_[arm] == error.device || scheduler || (fault && !of_one);
      if (!concerned) continue;
      if (error.code == kWarmMotors) warm_ns_[arm] = now_ns();
      if (error.code >= kFirstPassing && error.code <= kLastPassing) errors_[arm] = true;
      if (fault) lost_[arm] = true;
    }
  }
}

void Arms::frame() {
  Sample samples[kMostArms];
  for (std::size_t arm = 0; arm < count(); ++arm) {
    hd_.beginFrame(handles_[arm]);
    hd_.getDoublev(kCurrentTransform, samples[arm].transform);
    hd_.getIntegerv(kCurrentButtons, &samples[arm].buttons);
    hd_.getBooleanv(kCurrentInkwell, &samples[arm].in_holder);
  }
  takeErrors();
  const std::int64_t sampled_ns = now_ns();
  version_.fetch_add(1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  for (std::size_t arm = 0; arm < count(); ++arm) {
    for (std::size_t i = 0; i < 16; ++i) {
      transforms_[arm][i].store(samples[arm].transform[i], std::memory_order_relaxed);
    }
    buttons_[arm].store(samples[arm].buttons, std::memory_order_relaxed);
    in_holder_[arm].store(samples[arm].in_holder, std::memory_order_relaxed);
  }
  time_ns_.store(sampled_ns, std::memory_order_relaxed);
  number_.fetch_add(1, std::memory_order_release);
  version_.fetch_add(1, std::memory_order_release);
  while (sem_trywait(&answered_) == 0) {  // to samples of before
  }
  sem_post(&came_);
  waitUntil(answered_, sampled_ns + answer_ns_);
  // Silence is looked at first: it ends only once zero is what is commanded.
  const bool silent = silence_.holds() || now_ns() - commanded_ns_ > kSilentHost_ns;
  takeForces();
  for (std::size_t arm = 0; arm < count(); ++arm) {
    const double none[3] = {};
    hd_.makeCurrentDevice(handles_[arm]);
    hd_.setDoublev(kCurrentForce, silent || lost_[arm] ? none : taken_N_[arm].data());
  }
  for (std::size_t arm = count(); arm-- > 0;) hd_.endFrame(handles_[arm]);
  ++ended_;
  takeErrors();
}

}  // namespace trephine::openhaptics
