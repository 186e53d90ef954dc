#include "reports.h"

#include <algorithm>

namespace trephine::pedal {

namespace {

constexpr std::uint8_t kPush = 1, kTurn = 2, kButtons = 3;  // ids of a SpaceMouse's reports
constexpr std::size_t kThreeAxes = 7, kSixAxes = 13;        // bytes, id included
constexpr int kMostCount = 1000;  // no cap goes so far: about 350, some 500
constexpr std::uint32_t kCapButtons = 3;
constexpr std::size_t kSwitchBytes = 2;
constexpr unsigned kSwitches = 7;

std::array<std::int16_t, 3> threeAxes(const std::uint8_t* low) {
  std::array<std::int16_t, 3> axes{};
  for (std::size_t i = 0; i < 3; ++i) {
    axes[i] = std::int16_t(std::uint16_t(low[2 * i] | low[2 * i + 1] << 8));
  }
  return axes;
}

}  // namespace

// Items of HID 1.11, section 6.2.2: a byte of size, type and tag, then its data.
ReportSizes reportSizes(const std::vector<std::uint8_t>& descriptor) {
  std::array<std::uint64_t, 256> bits{};
  std::uint32_t id = 0, size = 0, count = 0;
  for (std::size_t at = 0; at < descriptor.size();) {
    const std::uint8_t item = descriptor[at++];
    if (item == 0xFE) break;  // a long item, which nobody uses
    const std::size_t bytes = (item & 3) == 3 ? 4 : item & 3;
    if (at + bytes > descriptor.size()) break;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value |= std::uint32_t(descriptor[at + i]) << (8 * i);
    at += bytes;
    switch (item & 0xFC) {
      case 0x74:
        size = value;
        break;
      case 0x84:
        id = value & 0xFF;
        break;
      case 0x94:
        count = value;
        break;
      case 0x80:  // input
        bits[id] += std::uint64_t(size) * count;
        break;
      default:
        break;
    }
  }
  ReportSizes sizes{};
  for (std::size_t i = 1; i < bits.size(); ++i) {
    const std::uint64_t bytes = (bits[i] + 7) / 8;
    if (bytes > 0 && bytes < kMostBytes) sizes[i] = std::size_t(1 + bytes);
  }
  return sizes;
}

std::optional<std::uint32_t> switchesOf(const std::uint8_t* bytes, std::size_t count) {
  std::optional<std::uint32_t> switches;
  if (count % kSwitchBytes != 0) return switches;
  for (std::size_t at = 0; at < count; at += kSwitchBytes) {
    // What is beside the three bits is padding, always 0: garbage must not press a pedal.
    if (bytes[at] <= kSwitches && bytes[at + 1] == 0) switches = bytes[at];
  }
  return switches;
}

bool CapReader::hasSixAxes() const {
  return sizes_[kPush] >= kSixAxes || (sizes_[kPush] >= kThreeAxes && sizes_[kTurn] >= kThreeAxes);
}

bool CapReader::believable(const std::uint8_t* report) const {
  const std::size_t size = sizes_[report[0]];
  if (report[0] != kPush && report[0] != kTurn) return true;
  const std::size_t axes = size >= kSixAxes ? 6 : size >= kThreeAxes ? 3 : 0;
  for (std::size_t first = 0; first < axes; first += 3) {
    for (std::int16_t count : threeAxes(report + 1 + 2 * first)) {
      if (count > kMostCount || count < -kMostCount) return false;
    }
  }
  return true;
}

bool CapReader::apply(const std::uint8_t* report) {
  const std::size_t size = sizes_[report[0]];
  switch (report[0]) {
    case kPush:
      if (size < kThreeAxes) return false;
      cap_.push = threeAxes(report + 1);
      if (size >= kSixAxes) cap_.turn = threeAxes(report + 7);
      return true;
    case kTurn:
      if (size < kThreeAxes) return false;
      cap_.turn = threeAxes(report + 1);
      return true;
    case kButtons:
      cap_.buttons = report[1] & kCapButtons;
      return false;
    default:
      return false;
  }
}

bool CapReader::take(const std::uint8_t* bytes, std::size_t count) {
  bool moved = false;
  for (std::size_t at = 0; at < count;) {
    const std::size_t size = sizes_[bytes[at]];
    if (size == 0 || at + size > count || !believable(bytes + at)) {
      ++at;
      continue;
    }
    moved = apply(bytes + at) || moved;
    at += size;
  }
  return moved;
}

}  // namespace trephine::pedal
