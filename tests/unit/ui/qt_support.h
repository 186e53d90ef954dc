#pragma once

#include <QApplication>
#include <QElapsedTimer>
#include <QtGlobal>
#include <functional>

namespace trephine::test {

// One for the whole program, drawing nowhere.
inline QApplication& application() {
  static int argc = 1;
  static char name[] = "test_ui";
  static char* argv[] = {name, nullptr};
  qputenv("QT_QPA_PLATFORM", "offscreen");
  // Never destroyed: Qt's own statics go before it and it needs them.
  static auto* instance = new QApplication(argc, argv);
  return *instance;
}

// Runs the event loop until `done`, ten seconds at most.
inline bool waitFor(const std::function<bool()>& done) {
  QElapsedTimer timer;
  timer.start();
  while (!done() && timer.elapsed() < 60000) {
    QCoreApplication::processEvents(QEventLoop::AllEvents, 20);
  }
  return done();
}

}  // namespace trephine::test
