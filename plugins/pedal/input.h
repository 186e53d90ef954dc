// One foot switch or SpaceMouse over USB HID. A thread of its own reads its reports from opening to
// closing, since they say only what changes; what the haptic thread calls neither waits nor
// allocates.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "reports.h"

struct hid_device_;

namespace trephine::pedal {

enum class Kind { foot_switch, space_mouse };

struct Found {
  Kind kind = Kind::foot_switch;
  std::string node;  // of the system, now
  std::string port;  // of USB, e.g. "1-2.3": the same for the same socket
  std::string serial, model;
};
// Those that are plugged in, foot switches first, then by their ports; one for each port, however
// many interfaces it has there.
std::vector<Found> findInputs();

class Input {
 public:
  Input() = default;
  ~Input();
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  // Empty, or why not.
  std::string open(const Found& found);
  const Found& found() const { return found_; }

  // ---- Haptic thread.
  bool lost() const { return lost_; }
  std::uint32_t buttons() const { return buttons_; }
  // At rest where its last report is so old that it does not say how the cap is held now.
  Cap cap() const;

 private:
  void readReports();
  void take(const std::uint8_t* bytes, std::size_t count);

  Found found_;
  hid_device_* device_ = nullptr;
  std::unique_ptr<CapReader> reader_;  // none of a foot switch
  std::thread thread_;
  std::atomic<bool> ending_{false}, lost_{false};
  std::atomic<std::uint32_t> buttons_{0};
  // Each three int16, packed; they come in reports of their own, so that they need not fit
  // together.
  std::atomic<std::uint64_t> push_{0}, turn_{0};
  std::atomic<std::int64_t> moved_ns_{0};  // when the cap's last report was here
};

}  // namespace trephine::pedal
