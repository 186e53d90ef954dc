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

#include "../common/plugin.h"
#include "hd.h"

namespace trephine::openhaptics {

constexpr std::size_t kMostArms = 2;

struct Sample {
  double transform[16] = {};  // mm
  int buttons = 0;
  std::uint8_t in_holder = 0;  // the stylus
};

class Arms {
 public:
  // `silence` outlives them.
  Arms(const Library& hd, const plugin::Silence& silence);
  ~Arms();
  Arms(const Arms&) = delete;
  Arms& operator=(const Arms&) = delete;

  // By their configured names, an empty one is the default device; those of before are closed.
  // Empty, or why not.
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
  // The newest samples, those before where the callback is just writing others.
  struct Samples {
    std::array<Sample, kMostArms> of{};
    std::uint64_t number = 0;
    std::int64_t time_ns = 0;
  };
  const Samples& latest();
  bool waitForOther(std::uint64_t given, double timeout_s);
  void command(const std::array<std::array<double, 3>, kMostArms>& forces_N);
  // What the arm has reported since this was asked last.
  bool hadError(std::size_t arm) { return errors_[arm].exchange(false); }
  bool warm(std::size_t arm) const;
  bool lost(std::size_t arm) const { return lost_[arm]; }

 private:
  static std::uint32_t servo(void* self);
  void frame();
  void takeErrors();
  void takeForces();
  void close();
  std::string why(const std::string& what) const;  // with the library's own last error
  std::string name(std::size_t arm) const;

  const Library& hd_;
  const plugin::Silence& silence_;
  std::vector<std::string> names_;
  std::vector<HHD> handles_;
  unsigned long scheduled_ = 0;
  bool running_ = false;
  std::int64_t answer_ns_ = 0;  // for the host's answer in a frame
  // Written by the callback: the version is odd meanwhile.
  std::atomic<std::uint64_t> version_{0}, number_{0}, ended_{0};
  std::atomic<std::int64_t> time_ns_{0};
  std::array<std::array<std::atomic<double>, 16>, kMostArms> transforms_{};
  std::array<std::atomic<int>, kMostArms> buttons_{};
  std::array<std::atomic<std::uint8_t>, kMostArms> in_holder_{};
  std::array<std::atomic<bool>, kMostArms> errors_{}, lost_{};
  std::array<std::atomic<std::int64_t>, kMostArms> warm_ns_{};
  Samples told_;
  // Written by the host, likewise.
  std::atomic<std::uint64_t> forces_version_{0};
  std::array<std::array<std::atomic<double>, 3>, kMostArms> forces_N_{};
  std::atomic<std::int64_t> commanded_ns_{0};
  std::array<std::array<double, 3>, kMostArms> taken_N_{};  // the callback's, whole
  sem_t came_, answered_;
};

}  // namespace trephine::openhaptics
