// Work of over a second on a thread of its own. One thread, its owner's, starts it, cancels it and
// takes what came of it; no event loop is needed.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

#include "base/codes.h"
#include "base/progress.h"
#include "base/result.h"
#include "base/tr.h"

namespace trephine {

class Job {
 public:
  // `wake` is called on the job's thread when take() has something to do: the work has come
  // further (said at most every 40 ms), or its outcome is there. It returns at once and throws
  // nothing.
  explicit Job(std::function<void()> wake) : wake_(std::move(wake)) {}
  // Cancels and waits; nothing is delivered any more.
  ~Job();
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  // Called on the owner's thread, where they are set: by run() once the work goes on; by take() as
  // the work gets further (`fraction` never falls), and once busy() is over, before the outcome.
  // `step` says how long it still takes, too: withTimeLeft() is in it already.
  std::function<void()> began, ended;
  std::function<void(double fraction, const std::string& step)> progressed;

  // From run() until take() has the outcome.
  bool busy() const { return thread_.joinable(); }
  // Asks the work to end; `done` still gets what the work then returns. Nothing where none goes on.
  void cancel();

  // Runs `work` on a thread of its own; take() then calls `done` with its outcome. `work` returns a
  // Result or a Status; what it throws becomes an Error. One piece of work at a time: while busy()
  // nothing is started and false comes back.
  template <class Work, class Done>
  bool run(Work work, Done done) {
    using Outcome = std::invoke_result_t<Work&, const Progress&>;
    if (busy()) return false;
    prepare();
    thread_ = std::thread([this, work = std::move(work), done = std::move(done)]() mutable {
      auto outcome = std::make_shared<Outcome>(guarded<Outcome>(work, *progress_));
      finish([outcome, done = std::move(done)]() mutable { done(std::move(*outcome)); });
    });
    if (began) began();
    return true;
  }

  // What happened since the last call. Owner's thread.
  void take();

 private:
  struct Report {
    double fraction;
    std::string step;
  };

  template <class Outcome, class Work>
  static Outcome guarded(Work& work, const Progress& progress) {
    try {
      return work(progress);
    } catch (const std::bad_alloc&) {
      return Error{code::kOutOfMemory, tr("There is not enough memory for this"), "",
                   tr("Close other programs or choose a smaller series")};
    } catch (const std::exception& problem) {
      return Error{code::kUnexpected, problem.what(), "",
                   tr("Try again, and report it if it stays")};
    }
  }
  void prepare();
  void finish(std::function<void()> outcome);

  std::function<void()> wake_;
  std::unique_ptr<Progress> progress_;
  double farthest_ = 0.0;  // of this work, as it was said
  std::mutex mutex_;       // of the two below
  std::optional<Report> report_;
  std::function<void()> outcome_;
  std::thread thread_;
};

}  // namespace trephine
