// The longest time that a test's window did not answer, test by test, and the bar for it. The tests
// print it; bench/bench_stalls.py, on a machine with nothing else to do, judges it.
#pragma once

#include <QFile>
#include <QTest>
#include <cstdio>
#include <map>
#include <string>

#include "ui/common/stall_meter.h"

namespace trephine::test {

class Stalls {
 public:
  static constexpr double kBar_ms = 100.0;
  // Of the processors. A stall while other programs have more of them says nothing of the product,
  // unless the window's thread computed all that time itself.
  static constexpr double kQuiet = 0.1;

  explicit Stalls(TimedApplication& application) : application_(application) {
    application_.setWatcher([this](const Stall& stall) {
      const char* now = QTest::currentTestFunction();
      auto& [quiet, busy] = longest_[now ? now : "start"];
      Stall& most = stall.others_share > kQuiet && stall.cpu_ms <= kBar_ms ? busy : quiet;
      if (stall.ms > most.ms) most = stall;
    });
  }
  ~Stalls() { application_.setWatcher({}); }

  // Prints them, the longest first, and leaves them in the artefacts.
  void report(const char* program) const {
    std::multimap<double, std::string, std::greater<>> lines;
    for (const auto& [test, stalls] : longest_) {
      const auto& [quiet, busy] = stalls;
      const bool judged = quiet.ms >= busy.ms || quiet.ms > kBar_ms;
      const Stall& stall = judged ? quiet : busy;
      const bool beyond = quiet.ms > kBar_ms;
      const char* mark = beyond ? "STALL" : stall.ms > kBar_ms ? "busy " : "     ";
      char line[600];
      std::snprintf(line, sizeof line, "%s %4.0f ms (computing %4.0f; others had %2.0f %%) %s: %s",
                    mark, stall.ms, stall.cpu_ms, 100.0 * stall.others_share, test.c_str(),
                    stall.by.toUtf8().constData());
      lines.emplace(stall.ms, line);
    }
    QFile file(QString(TREPHINE_ARTEFACTS "/stalls-%1.txt").arg(program));
    const bool kept = file.open(QIODevice::WriteOnly);
    std::printf(
        "Longest stall of the event loop in each test of %s; bar %.0f ms. STALL: beyond it; busy: "
        "not judged, other programs had over %.0f %% of the processors\n",
        program, kBar_ms, 100.0 * kQuiet);
    for (const auto& [ms, line] : lines) {
      std::printf("%s\n", line.c_str());
      if (kept) file.write((line + '\n').c_str());
    }
    std::fflush(stdout);
  }

 private:
  struct Of {
    Stall quiet, busy;
  };
  TimedApplication& application_;
  std::map<std::string, Of> longest_;
};

}  // namespace trephine::test
