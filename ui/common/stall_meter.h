// How long events kept the window's event loop from coming round, and which did.
#pragma once

#include <QApplication>
#include <QStringList>
#include <cstdint>
#include <functional>
#include <vector>

namespace trephine {

struct Stall {
  double ms = 0.0;            // no other event could be handled
  double cpu_ms = 0.0;        // of it: the window's thread computed
  double others_share = 0.0;  // of all processors, about then: what other programs had of them
  QString by;                 // the events that took most of it: what, to whom, how long
};

// An application that times what it delivers. Events that are handled one after the other before
// the loop comes round, which is when it looks for input, count as one stall; what runs between
// events (a test's own code, waiting) counts as none. A loop within an event, of a dialog or a
// drag, comes round as well.
class TimedApplication : public QApplication {
 public:
  using Watcher = std::function<void(const Stall&)>;
  TimedApplication(int& argc, char** argv);
  ~TimedApplication() override;

  // Called after each event with the stall as it is then; on the window's thread.
  void setWatcher(Watcher watcher) { watcher_ = std::move(watcher); }
  bool notify(QObject* receiver, QEvent* event) override;

 private:
  struct Times {
    std::int64_t wall_ns, cpu_ns;
  };
  struct Processors {  // since the machine started
    std::int64_t wall_ns, busy_ns, program_ns;
  };
  static Times now();
  Processors processors() const;
  double othersShare() const;
  void add();
  void comeRound();

  Watcher watcher_;
  int processors_file_ = -1;
  Processors before_{};
  std::vector<std::int64_t> inner_ns_;  // of each event being handled: that of events within it
  std::size_t loop_depth_ = 0;          // events within which the innermost loop runs
  Times began_{}, round_{};
  QStringList by_;
};

}  // namespace trephine
