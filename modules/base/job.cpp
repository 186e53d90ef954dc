#include "base/job.h"

#include <algorithm>
#include <atomic>
#include <chrono>

#include "base/time_left.h"

namespace trephine {

namespace {
// More often than the eye sees would only fill the owner's queue.
constexpr std::chrono::milliseconds kReportEvery{40};
}  // namespace

Job::~Job() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

void Job::cancel() {
  if (progress_) progress_->cancel();
}

void Job::prepare() {
  // Several threads of the work may report at once, so the time of the last report is atomic.
  auto last = std::make_shared<std::atomic<std::chrono::steady_clock::rep>>(0);
  farthest_ = 0.0;
  report_.reset();
  progress_ = std::make_unique<Progress>(
      withTimeLeft([this, last](double fraction, const std::string& step) {
        const auto now = std::chrono::steady_clock::now().time_since_epoch();
        auto before = last->load();
        if (now - std::chrono::steady_clock::duration(before) < kReportEvery) return;
        if (!last->compare_exchange_strong(before, now.count())) return;
        {
          const std::lock_guard lock(mutex_);
          report_ = {fraction, step};
        }
        wake_();
      }));
}

void Job::finish(std::function<void()> outcome) {
  {
    const std::lock_guard lock(mutex_);
    outcome_ = std::move(outcome);
  }
  wake_();
}

void Job::take() {
  std::optional<Report> report;
  std::function<void()> outcome;
  {
    const std::lock_guard lock(mutex_);
    report = std::exchange(report_, {});
    outcome = std::exchange(outcome_, nullptr);
  }
  if (report && progressed) {
    farthest_ = std::max(farthest_, report->fraction);  // a step that counts anew goes on from here
    progressed(farthest_, report->step);
  }
  if (!outcome) return;
  thread_.join();
  if (ended) ended();
  outcome();
}

}  // namespace trephine
