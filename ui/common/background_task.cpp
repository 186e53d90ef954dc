#include "ui/common/background_task.h"

#include <algorithm>
#include <chrono>

#include "base/time_left.h"

namespace trephine {

namespace {
// More often than the eye sees would only fill the window's event queue.
constexpr std::chrono::milliseconds kReportEvery{40};
}  // namespace

BackgroundTask::BackgroundTask(QObject* parent) : QObject(parent) {}

BackgroundTask::~BackgroundTask() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

void BackgroundTask::cancel() {
  if (progress_) progress_->cancel();
}

void BackgroundTask::prepare() {
  // Several threads of the work may report at once, so the time of the last report is atomic.
  auto last = std::make_shared<std::atomic<std::chrono::steady_clock::rep>>(0);
  farthest_ = 0.0;
  progress_ = std::make_shared<Progress>(withTimeLeft([this, last](double fraction,
                                                                   const std::string& step) {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    auto before = last->load();
    if (now - std::chrono::steady_clock::duration(before) < kReportEvery) return;
    if (!last->compare_exchange_strong(before, now.count())) return;
    QMetaObject::invokeMethod(
        this,
        [this, fraction, text = QString::fromStdString(step)] {
          if (!busy()) return;
          farthest_ = std::max(farthest_, fraction);  // a step that counts anew goes on from here
          emit progressed(farthest_, text);
        },
        Qt::QueuedConnection);
  }));
}

void BackgroundTask::end() {
  thread_.join();
  emit ended();
}

}  // namespace trephine
