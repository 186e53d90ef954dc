#include "pedal_hid.h"

#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <random>

namespace trephine::test {

HidDescription footSwitch() {
  return {0x05F3, 0x00FF, "VEC USB Footpedal", "", {0x05, 0x0C, 0x09, 0x03, 0xA1, 0x01, 0x05, 0x09,
                                                    0x19, 0x01, 0x29, 0x03, 0x15, 0x00, 0x25, 0x01,
                                                    0x75, 0x01, 0x95, 0x03, 0x81, 0x02, 0x75, 0x0D,
                                                    0x95, 0x01, 0x81, 0x01, 0xC0}};
}

HidDescription spaceMouse(bool wireless) {
  HidDescription of{0x256F,
                    std::uint16_t(wireless ? 0xC62E : 0xC635),
                    wireless ? "SpaceMouse Wireless" : "SpaceMouse Compact",
                    wireless ? "W1" : "",
                    {}};
  std::vector<std::uint8_t>& text = of.report_descriptor;
  const auto put = [&text](std::initializer_list<std::uint8_t> bytes) {
    text.insert(text.end(), bytes);
  };
  put({0x05, 0x01, 0x09, 0x08, 0xA1, 0x01});  // a multi-axis controller
  put({0xA1, 0x00, 0x85, 0x01, 0x16, 0xA2, 0xFE, 0x26, 0x5E, 0x01, 0x75, 0x10});
  put({0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x95, 0x03, 0x81, 0x06});
  if (!wireless) put({0xC0, 0xA1, 0x00, 0x85, 0x02});
  put({0x09, 0x33, 0x09, 0x34, 0x09, 0x35, 0x95, 0x03, 0x81, 0x06, 0xC0});
  put({0xA1, 0x02, 0x85, 0x03, 0x05, 0x09, 0x19, 0x01, 0x29, 0x02, 0x15, 0x00, 0x25, 0x01});
  put({0x75, 0x01, 0x95, 0x02, 0x81, 0x02, 0x95, 0x0E, 0x81, 0x03, 0xC0});          // buttons
  put({0x85, 0x04, 0x05, 0x08, 0x09, 0x4B, 0x75, 0x08, 0x95, 0x01, 0x91, 0x02});    // its light
  if (wireless) put({0x85, 0x17, 0x09, 0x20, 0x75, 0x08, 0x95, 0x01, 0x81, 0x02});  // its battery
  put({0xC0, 0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x85, 0x05, 0x09, 0x20, 0xB1, 0x02, 0xC0});
  return of;
}

void CapFirmware::send(const std::vector<std::uint8_t>& bytes) {
  std::lock_guard lock(mutex_);
  [[maybe_unused]] const ssize_t sent = ::write(fd_, bytes.data(), bytes.size());
}

void CapFirmware::run() {
  inRealTime(60);
  std::minstd_rand random(1);
  while (!ending_) {
    std::this_thread::sleep_for(std::chrono::milliseconds(8));  // the cap's own clock
    if (garbage_) {
      std::vector<std::uint8_t> bytes(1 + random() % 20);
      for (std::uint8_t& byte : bytes) byte = std::uint8_t(random() >> 8);
      send(bytes);
      continue;
    }
    CapAxes axes;
    {
      std::lock_guard lock(mutex_);
      const bool held = axes_ != CapAxes{};
      if (silent_ || (!held && said_)) continue;
      said_ = !held;
      axes = axes_;
    }
    std::vector<std::uint8_t> report{1};
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (i == 3 && !wireless_) {
        send(report);
        report = {2};
      }
      report.push_back(std::uint8_t(std::uint16_t(axes[i]) & 0xFF));
      report.push_back(std::uint8_t(std::uint16_t(axes[i]) >> 8));
    }
    send(report);
  }
}

void HostTicks::await() {
  next_ += std::chrono::milliseconds(1);
  std::this_thread::sleep_until(next_);  // the host's clock, beside the devices' own
}

void inRealTime(int of) {
  sched_param priority{};
  priority.sched_priority = of;
  pthread_setschedparam(pthread_self(), of > 0 ? SCHED_FIFO : SCHED_OTHER, &priority);
}

}  // namespace trephine::test
