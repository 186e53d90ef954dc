// The arms on the maker's scheduler: one callback for all of them, a thousand times a second. It
// hands their samples to the host, waits a moment for the forces that answer them, and sends those
// in the same frame.
#pragma once

#include <semaphore.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "hd.h"

namespace trephine::openhaptics {

constexpr std::size_t kMostArms = 2;

struct Sample {
  double transform[16] = {};  // mm
  int buttons = 0;
};

class Arms {
 public:
  explicit Arms(const Library& hd);
  ~Arms();
  Arms(const Arms&) = delete;
  Arms& operator=(const Arms&) = delete;

  // By their configured names; an empty one is the default device. Empty, or why not.
  std::string open(const std::vector<std::string>& names);
  // Empty, or why it does not know where it is.
  std::string calibrate(std::size_t arm);
  std::string start(double rate_hz);
  void stop();

  std::size_t count() const { return handles_.size(); }
  double number(std::size_t arm, HDenum which);
  int integer(std::size_t arm, HDenum which);
  std::array<double, 6> workspace_mm(std::size_t arm);

  // ---- Haptic thread.
  // The newest samples, and their number and time.
  std::uint64_t latest(std::array<Sample, kMostArms>& samples, std::int64_t& time_ns) const;
  bool waitForOther(std::uint64_t given, double timeout_s);
  void command(const std::array<std::array<double, 3>, kMostArms>& forces_N);
  // What the arm has reported since this was asked last.
  bool hadError(std::size_t arm) { return errors_[arm].exchange(false); }
  bool warm(std::size_t arm) const;
  bool lost(std::size_t arm) const { return lost_[arm]; }

  // ---- Any thread: no force, whatever is commanded, until `listen`.
  void silence() { silenced_ = true; }
  void listen() { silenced_ = false; }

 private:
  static std::uint32_t servo(void* self);
  void frame();
  void takeErrors();
  std::string why(const std::string& what) const;  // with the library's own last error
  std::string name(std::size_t arm) const;

  const Library& hd_;
  std::vector<std::string> names_;
  std::vector<HHD> handles_;
  unsigned long scheduled_ = 0;
  bool running_ = false;
  // Written by the callback: odd while it writes.
  std::atomic<std::uint64_t> version_{0}, number_{0};
  std::atomic<std::int64_t> time_ns_{0};
  std::array<std::array<std::atomic<double>, 16>, kMostArms> transforms_{};
  std::array<std::atomic<int>, kMostArms> buttons_{};
  // Written by the host: which sample the forces answer.
  std::array<std::array<std::atomic<double>, 3>, kMostArms> forces_N_{};
  std::atomic<std::int64_t> commanded_ns_{0};
  std::array<std::atomic<bool>, kMostArms> errors_{}, lost_{};
  std::array<std::atomic<std::int64_t>, kMostArms> warm_ns_{};
  std::atomic<bool> silenced_{false};
  sem_t came_, answered_;
};

}  // namespace trephine::openhaptics
