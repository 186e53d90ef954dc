// A Job of the window's thread: what its work returns, and how far it is, arrive there through the
// event loop.
#pragma once

#include <QObject>
#include <QString>
#include <utility>

#include "base/job.h"

namespace trephine {

class BackgroundTask : public QObject {
  Q_OBJECT
 public:
  explicit BackgroundTask(QObject* parent = nullptr);

  bool busy() const { return job_.busy(); }
  void cancel() { job_.cancel(); }
  // As Job::run().
  template <class Work, class Done>
  bool run(Work work, Done done) {
    return job_.run(std::move(work), std::move(done));
  }

 signals:
  void began();  // busy() from here to ended()
  void progressed(double fraction, const QString& step);  // never back
  void ended();

 private:
  Job job_;
};

}  // namespace trephine
