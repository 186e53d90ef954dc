// What plugins of HID devices share beside hidapi: the USB port of a node, its texts, and threads
// that answer a device.
#pragma once

#include <pthread.h>
#include <signal.h>

#include <filesystem>
#include <string>
#include <thread>

namespace trephine::plugin {

// The USB port of /dev/hidrawN: the folder above the interface ("1-2.3:1.0") that holds it.
inline std::string usbPort(const std::string& node) {
  std::error_code ec;
  const auto device = std::filesystem::canonical(
      "/sys/class/hidraw/" + node.substr(node.rfind('/') + 1) + "/device", ec);
  for (auto folder = device; !ec && folder.has_relative_path(); folder = folder.parent_path()) {
    const std::string name = folder.filename().string();
    const auto colon = name.find(':');
    if (colon != std::string::npos && name.find('-') < colon &&
        name.find('.', colon) != std::string::npos) {
      return name.substr(0, colon);
    }
  }
  return node;
}

inline std::string narrow(const wchar_t* text) {
  std::string out;
  for (; text && *text && out.size() < 60; ++text) out += *text < 128 ? char(*text) : '?';
  return out;
}

// A thread that answers a device takes a few microseconds each time, and goes before the haptic
// one, which may wait for it. Where the system does not allow it, it does with what it gets. No
// signal is handled on it: one would look like a device that went away.
template <class Work>
std::thread inFront(Work work) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread;
  try {
    thread = std::thread(work);
  } catch (...) {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  sched_param priority{};
  priority.sched_priority = 85;
  pthread_setschedparam(thread.native_handle(), SCHED_FIFO, &priority);
  return thread;
}

}  // namespace trephine::plugin
