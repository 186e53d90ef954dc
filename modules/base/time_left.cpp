#include "base/time_left.h"

#include <cmath>
#include <memory>
#include <utility>

#include "base/tr.h"

namespace trephine {

namespace {
constexpr double kFirst_s = 2.0;  // before that the rate is a guess
constexpr double kLeast_s = 1.0;  // what is shorter is over before it is read
constexpr double kLeast = 0.005;  // of the work, from which its rate can be told
constexpr double kJitter = 0.02;  // several threads report, and not always in order
}  // namespace

std::optional<double> TimeLeft::at(double fraction, Clock::time_point now) {
  if (!began_ || fraction < last_ - kJitter) {
    began_ = now;
    began_at_ = fraction;
  }
  last_ = fraction;
  const double taken_s = std::chrono::duration<double>(now - *began_).count();
  const double done = fraction - began_at_;
  if (taken_s < kFirst_s || done < kLeast) return std::nullopt;
  const double left_s = (1.0 - fraction) * taken_s / done;
  return left_s < kLeast_s ? std::nullopt : std::optional(left_s);
}

std::string timeLeftWords(double seconds) {
  // Steps of 5 s, and minutes from 90 s up: an estimate, and no clock that jumps.
  if (seconds < 10.0) return tr("about {} s left", int(std::ceil(seconds)));
  if (seconds < 90.0) return tr("about {} s left", 5 * std::lround(seconds / 5.0));
  return tr("about {} min left", std::lround(seconds / 60.0));
}

std::function<void(double, const std::string&)> withTimeLeft(
    std::function<void(double, const std::string&)> report) {
  struct State {
    std::mutex mutex;
    TimeLeft left;
  };
  return [report = std::move(report), state = std::make_shared<State>()](double fraction,
                                                                         const std::string& step) {
    std::optional<double> left_s;
    {
      const std::lock_guard lock(state->mutex);
      left_s = state->left.at(fraction, TimeLeft::Clock::now());
    }
    report(fraction, left_s ? step + ", " + timeLeftWords(*left_s) : step);
  };
}

}  // namespace trephine
