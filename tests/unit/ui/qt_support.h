#pragma once

#include <QElapsedTimer>
#include <QtGlobal>
#include <functional>

#include "ui/common/stall_meter.h"

namespace trephine::test {

// One for the whole program, drawing nowhere.
inline TimedApplication& application() {
  static int argc = 1;
  static char name[] = "test_ui";
  static char* argv[] = {name, nullptr};
  qputenv("QT_QPA_PLATFORM", "offscreen");
  // Never destroyed: Qt's own statics go before it and it needs them.
  static auto* instance = new TimedApplication(argc, argv);
  return *instance;
}

// Runs the event loop until `done`, a minute at most.
inline bool waitFor(const std::function<bool()>& done) {
  QElapsedTimer timer;
  timer.start();
  while (!done() && timer.elapsed() < 60000) {
    QCoreApplication::processEvents(QEventLoop::AllEvents, 20);
  }
  return done();
}

}  // namespace trephine::test
