#include "wooden_firmware.h"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

namespace trephine::test {

namespace {
constexpr std::size_t kOut = 9;  // a report id and 8 bytes
constexpr std::size_t kIn = 8, kKept = 64;
constexpr std::int16_t kMost_mA = 3000;
}  // namespace

void WoodenFirmware::take(const std::uint8_t* report) {
  std::array<std::int16_t, 3> asked;
  std::memcpy(asked.data(), report + 1, 6);
  for (std::int16_t& motor : asked) motor = std::clamp<std::int16_t>(motor, -kMost_mA, kMost_mA);
  std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  milliamps_ = asked;
  told_.push_back({now, asked});
  if (!first_out_) first_out_ = now;
  last_out_ = now;
  if (unanswered_) {
    answers_us_.push_back(std::chrono::duration<double, std::micro>(now - *unanswered_).count());
    unanswered_.reset();
  }
}

int WoodenFirmware::neverWaits(int fd) {
  ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
  return fd;
}

// A system keeps 64 reports for a program that does not read them; its terminal would keep
// thousands. A program that reads says something every 50 ms, and then has room.
bool WoodenFirmware::hasRoom(Clock::time_point now) const {
  if (last_out_ && now - *last_out_ < std::chrono::milliseconds(100)) return true;
  return waitingBytes(fd_) < kKept * kIn;
}

void WoodenFirmware::run() {
  sched_param priority{};
  priority.sched_priority = 60;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
  Clock::time_point due = Clock::now();
  std::uint16_t number = 0;
  while (!ending_) {
    // Reports out, until the next one in is due.
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(due - Clock::now());
    timespec until{0, std::max<long>(0, left.count())};
    pollfd node{fd_, POLLIN, 0};
    if (::ppoll(&node, 1, &until, nullptr) > 0) {
      std::uint8_t bytes[256];
      const ssize_t got = ::read(fd_, bytes, sizeof(bytes));
      if (got > 0) out_.insert(out_.end(), bytes, bytes + got);
      // Nobody has it open: the board's own clock goes on.
      if (got <= 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
      while (out_.size() >= kOut) {
        take(out_.data());
        out_.erase(out_.begin(), out_.begin() + kOut);
      }
    }
    const Clock::time_point now = Clock::now();
    if (now < due) continue;
    due += std::chrono::milliseconds(1);
    if (now - due > std::chrono::milliseconds(20)) due = now;
    std::uint8_t report[kIn];
    {
      std::lock_guard lock(mutex_);
      if (last_out_ && now - *last_out_ > std::chrono::milliseconds(500)) milliamps_ = {};
      std::memcpy(report, counts_.data(), 6);
      if (first_out_ && !unanswered_) unanswered_ = now;
    }
    ++number;
    std::memcpy(report + 6, &number, 2);
    if (state_ == State::silent) continue;
    const std::size_t bytes = state_ == State::garbage ? 3 : sizeof(report);
    if (!isOpen(fd_)) continue;  // for nobody is anything kept
    if (!rest_.empty() || !hasRoom(now)) {
      ++lost_;
      if (rest_.empty()) continue;
    } else {
      rest_.assign(report, report + bytes);
    }
    // What went in by half goes on there.
    const ssize_t written = ::write(fd_, rest_.data(), rest_.size());
    if (written > 0) rest_.erase(rest_.begin(), rest_.begin() + written);
    if (!rest_.empty()) continue;
    ++sent_;
    std::lock_guard lock(mutex_);
    reports_.push_back(now);
  }
}

}  // namespace trephine::test
