#include "bench/screen_reader.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>

namespace trephine::bench {

namespace {

constexpr std::chrono::milliseconds kEvery(3);
constexpr unsigned long kColour = 0xffffff;

std::optional<std::uint32_t> numberIn(XImage& row) {
  const auto square = [&](int n) {
    return XGetPixel(&row, n * kSquare_pixels + kSquare_pixels / 2, 0) & kColour;
  };
  if (square(0) != 0xff00ff || square(kNumberBits + 1) != 0x00ffff) return {};
  std::uint32_t number = 0;
  for (int bit = 0; bit < kNumberBits; ++bit) {
    const unsigned long colour = square(bit + 1);
    if (colour != 0 && colour != kColour) return {};
    number |= std::uint32_t(colour == kColour) << bit;
  }
  return number;
}

}  // namespace

ScreenReader::ScreenReader(int x, int y) : thread_([this, x, y] { look(x, y); }) {}

ScreenReader::~ScreenReader() {
  ended_ = true;
  if (thread_.joinable()) thread_.join();
}

std::vector<std::pair<std::uint32_t, ScreenReader::Clock::time_point>> ScreenReader::seen() {
  ended_ = true;
  if (thread_.joinable()) thread_.join();
  return seen_;
}

void ScreenReader::look(int x, int y) {
  Display* display = ::XOpenDisplay(nullptr);
  if (!display) return;
  const Window root = DefaultRootWindow(display);
  for (; !ended_; std::this_thread::sleep_for(kEvery)) {
    XImage* row = ::XGetImage(display, root, x, y, kNumber_pixels, 1, AllPlanes, ZPixmap);
    if (!row) continue;
    const auto number = numberIn(*row);
    if (number && (seen_.empty() || seen_.back().first != *number)) {
      seen_.emplace_back(*number, Clock::now());
    }
    XDestroyImage(row);
  }
  ::XCloseDisplay(display);
}

}  // namespace trephine::bench
