// How long work of over a few seconds still takes.
#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace trephine {

// From how far work was at which time, on the assumption that it goes on as fast as so far. Nothing
// for the first two seconds, nor where less than one is left.
class TimeLeft {
 public:
  using Clock = std::chrono::steady_clock;
  // Seconds. `fraction` in [0, 1]; one that falls begins anew.
  std::optional<double> at(double fraction, Clock::time_point now);

 private:
  std::optional<Clock::time_point> began_;
  double began_at_ = 0.0, last_ = 0.0;
};

// "about 40 s left", "about 3 min left"
std::string timeLeftWords(double seconds);

// A Progress's report that passes each step on with the time left: "Reading headers, about 3 min
// left". Any thread. A Job does this itself.
std::function<void(double, const std::string&)> withTimeLeft(
    std::function<void(double, const std::string&)> report);

}  // namespace trephine
