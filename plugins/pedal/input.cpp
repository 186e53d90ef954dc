#include "input.h"

#include <hidapi/hidapi.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <tuple>

#include "../common/hid.h"
#include "../common/plugin.h"

namespace trephine::pedal {

using plugin::inFront;
using plugin::narrow;
using plugin::now_ns;
using plugin::usbPort;

namespace {

constexpr unsigned short kFootSwitch[] = {0x05F3, 0x00FF};  // VEC Infinity
// 3Dconnexion, and Logitech for them: there 0xC6.. alone.
constexpr unsigned short kConnexion = 0x256F, kLogitech = 0x046D;
constexpr unsigned short kDesktop = 0x01, kMultiAxis = 0x08;  // usage page and usage
constexpr int kLook_ms = 20;  // how often the reader looks whether it is to end
// A cap that is held away from rest repeats itself every 8 to 16 ms.
constexpr std::int64_t kFresh_ns = 300'000'000;

bool isFootSwitch(const hid_device_info& of) {
  return of.vendor_id == kFootSwitch[0] && of.product_id == kFootSwitch[1];
}

bool isSpaceMouse(const hid_device_info& of) {
  const bool maker = of.vendor_id == kConnexion ||
                     (of.vendor_id == kLogitech && (of.product_id & 0xFF00) == 0xC600);
  const bool unknown = of.usage_page == 0 && of.usage == 0;
  return maker && (unknown || (of.usage_page == kDesktop && of.usage == kMultiAxis));
}

// As the system keeps it beside the node; empty where it does not.
std::vector<std::uint8_t> descriptorOf(const std::string& node) {
  std::ifstream file(
      "/sys/class/hidraw/" + node.substr(node.rfind('/') + 1) + "/device/report_descriptor",
      std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::uint64_t pack(const std::array<std::int16_t, 3>& three) {
  std::uint64_t packed = 0;
  std::memcpy(&packed, three.data(), 6);
  return packed;
}

std::array<std::int16_t, 3> unpack(std::uint64_t packed) {
  std::array<std::int16_t, 3> three{};
  std::memcpy(three.data(), &packed, 6);
  return three;
}

}  // namespace

std::vector<Found> findInputs() {
  std::vector<Found> inputs;
  hid_device_info* list = hid_enumerate(0, 0);
  for (const hid_device_info* of = list; of; of = of->next) {
    if (!isFootSwitch(*of) && !isSpaceMouse(*of)) continue;
    const Kind kind = isFootSwitch(*of) ? Kind::foot_switch : Kind::space_mouse;
    std::string model = narrow(of->product_string);
    if (model.empty()) model = kind == Kind::foot_switch ? "Foot switch" : "SpaceMouse";
    inputs.push_back(
        {kind, of->path, usbPort(of->path), narrow(of->serial_number), std::move(model)});
  }
  hid_free_enumeration(list);
  const auto place = [](const Found& of) { return std::tie(of.kind, of.port, of.node); };
  std::sort(inputs.begin(), inputs.end(),
            [&](const Found& a, const Found& b) { return place(a) < place(b); });
  const auto same = [](const Found& a, const Found& b) {
    return a.kind == b.kind && a.port == b.port;
  };
  inputs.erase(std::unique(inputs.begin(), inputs.end(), same), inputs.end());
  return inputs;
}

Input::~Input() {
  ending_ = true;
  if (thread_.joinable()) thread_.join();
  if (device_) hid_close(device_);
}

std::string Input::open(const Found& found) {
  found_ = found;
  if (found.kind == Kind::space_mouse) {
    reader_ = std::make_unique<CapReader>(reportSizes(descriptorOf(found.node)));
    if (!reader_->hasSixAxes()) {
      return "The " + found.model + " on USB port " + found.port +
             " does not report six axes: use another one.";
    }
  }
  device_ = hid_open_path(found.node.c_str());
  if (!device_) {
    return "The " + found.model + " on USB port " + found.port + " cannot be opened (" +
           narrow(hid_error(nullptr)) +
           "): unplug it and plug it in again, or install Trephine's udev rules.";
  }
  thread_ = inFront([this] { readReports(); });
  return {};
}

Cap Input::cap() const {
  if (now_ns() - moved_ns_ > kFresh_ns) return {};
  return {unpack(push_), unpack(turn_), buttons_};
}

void Input::take(const std::uint8_t* bytes, std::size_t count) {
  if (!reader_) {
    if (const auto switches = switchesOf(bytes, count)) buttons_ = *switches;
    return;
  }
  const bool moved = reader_->take(bytes, count);
  const Cap& cap = reader_->cap();
  buttons_ = cap.buttons;
  push_ = pack(cap.push);
  turn_ = pack(cap.turn);
  if (moved) moved_ns_ = now_ns();
}

void Input::readReports() {
  std::uint8_t bytes[4 * kMostBytes];
  while (!ending_) {
    const int count = hid_read_timeout(device_, bytes, sizeof(bytes), kLook_ms);
    if (count < 0) {
      lost_ = true;
      return;
    }
    take(bytes, std::size_t(count));
  }
}

}  // namespace trephine::pedal
