// Progress and cancel for work of over a second. The caller owns it and may cancel from any thread.
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace trephine {

class Progress {
 public:
  // `report` is called on the working thread with a fraction in [0, 1] and a step's name; where the
  // work has several threads, on several at once.
  explicit Progress(std::function<void(double fraction, const std::string& step)> report = {})
      : report_(std::move(report)) {}
  // A part of `whole`, between two of its fractions; cancelled with it. `whole` outlives it. All of
  // it is one step where that has a `name`.
  Progress(const Progress& whole, double from, double to, const std::string& name = {})
      : report_([&whole, from, to, name](double fraction, const std::string& step) {
          whole.at(from + fraction * (to - from), name.empty() ? step : name);
        }),
        whole_(&whole) {}

  void at(double fraction, const std::string& step) const {
    if (report_) report_(fraction, step);
  }
  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const {
    return cancelled_.load(std::memory_order_relaxed) || (whole_ && whole_->cancelled());
  }

 private:
  std::function<void(double, const std::string&)> report_;
  const Progress* whole_ = nullptr;
  std::atomic<bool> cancelled_{false};
};

}  // namespace trephine
