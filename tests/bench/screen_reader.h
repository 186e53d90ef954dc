// Reads numbers off the screen that were drawn into a window as a row of squares, black or white,
// the lowest bit first, after a magenta and before a cyan one.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace trephine::bench {

constexpr int kNumberBits = 16, kSquare_pixels = 6;
constexpr int kNumber_pixels = (kNumberBits + 2) * kSquare_pixels;

// Looks at one place of the screen every 3 ms, on a thread and a connection of its own.
class ScreenReader {
 public:
  using Clock = std::chrono::steady_clock;
  // The left edge of the squares and a row through them, in the screen's pixels.
  ScreenReader(int x, int y);
  ~ScreenReader();
  // What was seen, each number once, with when it was seen first. Ends the looking.
  std::vector<std::pair<std::uint32_t, Clock::time_point>> seen();

 private:
  void look(int x, int y);
  std::vector<std::pair<std::uint32_t, Clock::time_point>> seen_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace trephine::bench
