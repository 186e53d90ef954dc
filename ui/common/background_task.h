// Work of over a second, off the window's thread. The window's thread owns the task; what the work
// returns, and how far it is, arrive there through the event loop.
#pragma once

#include <QObject>
#include <QString>
#include <functional>
#include <memory>
#include <new>
#include <thread>
#include <type_traits>

#include "base/progress.h"
#include "base/result.h"

namespace trephine {

class BackgroundTask : public QObject {
  Q_OBJECT
 public:
  explicit BackgroundTask(QObject* parent = nullptr);
  // Cancels and waits; nothing is delivered any more.
  ~BackgroundTask() override;

  bool busy() const { return thread_.joinable(); }
  void cancel();

  // Runs `work` on a thread of its own, then `done` with its outcome on the window's. `work`
  // returns a Result or a Status; what it throws becomes an Error. One piece of work at a time:
  // while busy() nothing is started and false comes back.
  template <class Work, class Done>
  bool run(Work work, Done done) {
    using Outcome = std::invoke_result_t<Work&, const Progress&>;
    if (busy()) return false;
    prepare();
    thread_ = std::thread(
        [this, work = std::move(work), done = std::move(done), progress = progress_]() mutable {
          auto outcome = std::make_shared<Outcome>(guarded<Outcome>(work, *progress));
          QMetaObject::invokeMethod(
              this,
              [this, outcome, done = std::move(done)]() mutable {
                end();
                done(std::move(*outcome));
              },
              Qt::QueuedConnection);
        });
    emit began();
    return true;
  }

 signals:
  void began();  // busy() from here to ended()
  void progressed(double fraction, const QString& step);  // never back
  void ended();

 private:
  template <class Outcome, class Work>
  static Outcome guarded(Work& work, const Progress& progress) {
    try {
      return work(progress);
    } catch (const std::bad_alloc&) {
      return Error{"OUT_OF_MEMORY", "There is not enough memory for this", "",
                   "Close other programs or choose a smaller series"};
    } catch (const std::exception& problem) {
      return Error{"UNEXPECTED", problem.what(), "", "Try again, and report it if it stays"};
    }
  }
  void prepare();
  void end();

  std::shared_ptr<Progress> progress_;
  std::thread thread_;
  double farthest_ = 0.0;  // of this work, as it was said
};

}  // namespace trephine
