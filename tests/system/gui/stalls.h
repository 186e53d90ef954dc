// The longest time that a test's window did not answer, test by test, and the bar for it.
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

  explicit Stalls(TimedApplication& application) : application_(application) {
    application_.setWatcher([this](const Stall& stall) {
      const char* now = QTest::currentTestFunction();
      Stall& most = longest_[now ? now : "start"];
      if (stall.own_ms() > most.own_ms()) most = stall;
    });
  }
  ~Stalls() { application_.setWatcher({}); }

  // Prints them, the longest first, and leaves them in the artefacts. False where the product kept
  // the window for longer than the bar: the time in which other programs had the processors is not
  // the product's.
  bool report(const char* program) const {
    std::multimap<double, std::string, std::greater<>> lines;
    bool within = true;
    for (const auto& [test, stall] : longest_) {
      char line[400];
      std::snprintf(line, sizeof line, "%s %4.0f ms (computing %3.0f, waiting for a processor %3.0f; %4.0f with other "
                    "programs') %s: %s",
                    stall.own_ms() > kBar_ms ? "STALL" : "     ", stall.own_ms(), stall.cpu_ms,
                    stall.waited_ms, stall.ms, test.c_str(), stall.by.toUtf8().constData());
      lines.emplace(stall.own_ms(), line);
      within = within && stall.own_ms() <= kBar_ms;
    }
    QFile file(QString(TREPHINE_ARTEFACTS "/stalls-%1.txt").arg(program));
    const bool kept = file.open(QIODevice::WriteOnly);
    std::printf("Longest stall of the event loop in each test of %s; bar %.0f ms\n", program, kBar_ms);
    for (const auto& [ms, line] : lines) {
      std::printf("%s\n", line.c_str());
      if (kept) file.write((line + '\n').c_str());
    }
    std::fflush(stdout);
    return within;
  }

 private:
  TimedApplication& application_;
  std::map<std::string, Stall> longest_;
};

}  // namespace trephine::test
