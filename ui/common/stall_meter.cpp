#include "ui/common/stall_meter.h"

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <QAbstractEventDispatcher>
#include <QMetaEnum>
#include <QThread>
#include <algorithm>
#include <cstdlib>
#include <thread>

namespace trephine {

namespace {

// Events that follow each other faster were not waited between.
constexpr std::int64_t kAtOnce_ns = 1'000'000;

std::int64_t clock_ns(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::int64_t(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

constexpr std::int64_t kTold_ns = 5'000'000;  // what took less is not named

QEvent::Type roundEvent() {
  static const auto type = QEvent::Type(QEvent::registerEventType());
  return type;
}

QString described(const QEvent::Type type, const char* of, const QString& name) {
  const char* key = QMetaEnum::fromType<QEvent::Type>().valueToKey(type);
  const QString what = key ? QString(key) : QString("event %1").arg(int(type));
  return what + " to " + of + (name.isEmpty() ? QString() : ' ' + name);
}

}  // namespace

TimedApplication::TimedApplication(int& argc, char** argv)
    : QApplication(argc, argv),
      schedule_(::open("/proc/thread-self/schedstat", O_RDONLY | O_CLOEXEC)) {
  // A loop within an event, of a menu or a drag.
  const QAbstractEventDispatcher* dispatcher = QAbstractEventDispatcher::instance();
  connect(dispatcher, &QAbstractEventDispatcher::aboutToBlock, this, [this] {
    if (!inner_ns_.empty()) add(began_);
    comeRound();
  });
  connect(dispatcher, &QAbstractEventDispatcher::awake, this, [this] {
    if (!inner_ns_.empty()) began_ = now();
  });
}

TimedApplication::~TimedApplication() {
  if (schedule_ >= 0) ::close(schedule_);
}

TimedApplication::Times TimedApplication::now() const {
  Times times{clock_ns(CLOCK_MONOTONIC), 0, clock_ns(CLOCK_THREAD_CPUTIME_ID),
              clock_ns(CLOCK_PROCESS_CPUTIME_ID)};
  char text[80] = {};
  if (schedule_ >= 0 && ::pread(schedule_, text, sizeof text - 1, 0) > 0) {
    char* second = nullptr;
    (void)std::strtoll(text, &second, 10);  // on a processor
    times.waited_ns = std::strtoll(second, nullptr, 10);
  }
  return times;
}

void TimedApplication::add(const Times& from) {
  const Times to = now();
  round_.wall_ns += to.wall_ns - from.wall_ns;
  round_.waited_ns += to.waited_ns - from.waited_ns;
  round_.cpu_ns += to.cpu_ns - from.cpu_ns;
  round_.program_ns += to.program_ns - from.program_ns;
  ended_ns_ = to.wall_ns;
  if (!watcher_) return;
  // While the thread waited all processors were busy: with this program's other threads as far as
  // those ran at all in the stall, and for the rest with other programs.
  const double beside_ns =
      double(round_.program_ns - round_.cpu_ns) / double(std::thread::hardware_concurrency());
  watcher_({double(round_.wall_ns) * 1e-6, double(round_.cpu_ns) * 1e-6,
            double(round_.waited_ns) * 1e-6,
            std::max(0.0, double(round_.waited_ns) - beside_ns) * 1e-6,
            by_.join("; ")});
}

void TimedApplication::comeRound() {
  round_ = {};
  by_.clear();
}

bool TimedApplication::notify(QObject* receiver, QEvent* event) {
  if (QThread::currentThread() != thread()) return QApplication::notify(receiver, event);
  const QEvent::Type type = event->type();
  if (type == roundEvent() && receiver == &probe_) {
    asked_ = false;
    if (inner_ns_.empty()) comeRound();
    return true;
  }
  // It may be gone afterwards.
  const QObject* named = receiver->inherits("QTimer") && receiver->parent() ? receiver->parent()
                                                                            : receiver;
  const char* of = named->metaObject()->className();
  const QString name = named->objectName();
  const bool outermost = inner_ns_.empty();
  if (outermost) {
    began_ = now();
    if (began_.wall_ns - ended_ns_ > kAtOnce_ns) comeRound();
  }
  const std::int64_t from_ns = clock_ns(CLOCK_MONOTONIC);
  inner_ns_.push_back(0);
  const bool taken = QApplication::notify(receiver, event);
  const std::int64_t all_ns = clock_ns(CLOCK_MONOTONIC) - from_ns;
  const std::int64_t own_ns = all_ns - inner_ns_.back();
  inner_ns_.pop_back();
  if (!inner_ns_.empty()) inner_ns_.back() += all_ns;
  if (own_ns > kTold_ns) {
    by_ << QString("%1, %2 ms").arg(described(type, of, name)).arg(double(own_ns) * 1e-6, 0, 'f', 0);
  }
  if (!outermost) return taken;
  add(began_);
  if (!asked_) QCoreApplication::postEvent(&probe_, new QEvent(roundEvent()), Qt::LowEventPriority);
  asked_ = true;
  return taken;
}

}  // namespace trephine
