// Whether the host has asked for no force and not yet answered that it knows (safe_stop).
#pragma once

#include <atomic>
#include <cstdint>

namespace trephine::woodenhaptics {

class Silence {
 public:
  void ask() { asked_.fetch_add(1); }  // any thread
  bool holds() const { return asked_ != answered_; }
  std::uint32_t asked() const { return asked_; }
  // With what asked() was before the command that answers it.
  void answer(std::uint32_t asked) { answered_ = asked; }

 private:
  std::atomic<std::uint32_t> asked_{0}, answered_{0};
};

}  // namespace trephine::woodenhaptics
