#include "ui/common/stall_meter.h"

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <QMetaEnum>
#include <QThread>
#include <algorithm>
#include <cstdlib>
#include <thread>
#include <utility>

#include "ui/common/event_loop.h"

namespace trephine {

namespace {

std::int64_t clock_ns(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::int64_t(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

constexpr std::int64_t kShort_ns = 30'000'000;
constexpr std::int64_t kTold_ns = 5'000'000;  // what took less is not named

QString described(const QEvent::Type type, const char* of, const QString& name) {
  const char* key = QMetaEnum::fromType<QEvent::Type>().valueToKey(type);
  const QString what = key ? QString(key) : QString("event %1").arg(int(type));
  return what + " to " + of + (name.isEmpty() ? QString() : ' ' + name);
}

}  // namespace

TimedApplication::TimedApplication(int& argc, char** argv)
    : QApplication(argc, argv), processors_file_(::open("/proc/stat", O_RDONLY | O_CLOEXEC)) {
  onEachTurn(this, &TimedApplication::comeRound);
}

TimedApplication::~TimedApplication() {
  if (processors_file_ >= 0) ::close(processors_file_);
}

TimedApplication::Times TimedApplication::now() {
  return {clock_ns(CLOCK_MONOTONIC), clock_ns(CLOCK_THREAD_CPUTIME_ID)};
}

// Of /proc/stat the first line: "cpu" and the ticks in user, nice, system, idle, iowait, irq,
// softirq and steal.
TimedApplication::Processors TimedApplication::processors() const {
  Processors all{clock_ns(CLOCK_MONOTONIC), 0, clock_ns(CLOCK_PROCESS_CPUTIME_ID)};
  char text[200] = {};
  if (processors_file_ < 0 || ::pread(processors_file_, text, sizeof text - 1, 0) < 5) return all;
  const std::int64_t tick_ns = 1'000'000'000 / ::sysconf(_SC_CLK_TCK);
  char* at = text + 3;
  for (int field = 0; field < 8; ++field) {
    const std::int64_t ticks = std::strtoll(at, &at, 10);
    if (field != 3 && field != 4) all.busy_ns += ticks * tick_ns;
  }
  return all;
}

double TimedApplication::othersShare() const {
  const Processors to = processors();
  const double all_ns =
      double(to.wall_ns - before_.wall_ns) * double(std::thread::hardware_concurrency());
  const double others_ns =
      double(to.busy_ns - before_.busy_ns) - double(to.program_ns - before_.program_ns);
  return std::clamp(others_ns / all_ns, 0.0, 1.0);
}

void TimedApplication::add() {
  const Times to = now();
  round_.wall_ns += to.wall_ns - began_.wall_ns;
  round_.cpu_ns += to.cpu_ns - began_.cpu_ns;
  began_ = to;
  if (!watcher_) return;
  // The ticks of the processors are 10 ms long: of what was shorter nothing is known.
  const double share = round_.wall_ns > kShort_ns ? othersShare() : 0.0;
  watcher_({double(round_.wall_ns) * 1e-6, double(round_.cpu_ns) * 1e-6, share, by_.join("; ")});
}

void TimedApplication::comeRound() {
  if (inner_ns_.size() > loop_depth_) {  // a loop begins within an event
    add();
    loop_depth_ = inner_ns_.size();
  }
  if (clock_ns(CLOCK_MONOTONIC) - before_.wall_ns > kShort_ns) before_ = processors();
  began_ = now();
  round_ = {};
  by_.clear();
}

bool TimedApplication::notify(QObject* receiver, QEvent* event) {
  if (QThread::currentThread() != thread()) return QApplication::notify(receiver, event);
  const QEvent::Type type = event->type();
  // It may be gone afterwards.
  const QObject* named =
      receiver->inherits("QTimer") && receiver->parent() ? receiver->parent() : receiver;
  const char* of = named->metaObject()->className();
  const QString name = named->objectName();
  const std::size_t depth = inner_ns_.size(), loop_depth = loop_depth_;
  if (depth == loop_depth) began_ = now();
  const std::int64_t from_ns = clock_ns(CLOCK_MONOTONIC);
  inner_ns_.push_back(0);
  const bool taken = QApplication::notify(receiver, event);
  const std::int64_t all_ns = clock_ns(CLOCK_MONOTONIC) - from_ns;
  const std::int64_t own_ns = all_ns - inner_ns_.back();
  inner_ns_.pop_back();
  if (!inner_ns_.empty()) inner_ns_.back() += all_ns;
  const bool looped = std::exchange(loop_depth_, loop_depth) != loop_depth;
  if (!looped && own_ns > kTold_ns) {
    by_ << QString("%1, %2 ms")
               .arg(described(type, of, name))
               .arg(double(own_ns) * 1e-6, 0, 'f', 0);
  }
  if (depth == loop_depth) add();
  return taken;
}

}  // namespace trephine
