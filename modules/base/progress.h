// Progress and cancel for work of over a second. The caller owns it and may cancel from any thread.
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace trephine {

class Progress {
 public:
  // `report` is called on the working thread with a fraction in [0, 1] and a step's name.
  explicit Progress(std::function<void(double fraction, const std::string& step)> report = {})
      : report_(std::move(report)) {}

  void at(double fraction, const std::string& step) const {
    if (report_) report_(fraction, step);
  }
  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

 private:
  std::function<void(double, const std::string&)> report_;
  std::atomic<bool> cancelled_{false};
};

}  // namespace trephine
