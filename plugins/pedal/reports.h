// What the reports of foot switches and SpaceMice say. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace trephine::pedal {

constexpr std::size_t kMostBytes = 64;  // of a report: no device here comes near it

// Bytes of each report in, its id included, by that id; 0: there is none.
using ReportSizes = std::array<std::size_t, 256>;
// Of a device whose reports have ids. Longer ones, and what a descriptor does not say to its end,
// are left out.
ReportSizes reportSizes(const std::vector<std::uint8_t>& descriptor);

// The three switches after one read, bit 0 the left one; nothing where that was no whole report.
std::optional<std::uint32_t> switchesOf(const std::uint8_t* bytes, std::size_t count);

// How a SpaceMouse's cap is pushed and turned, as it counts, and its buttons.
struct Cap {
  std::array<std::int16_t, 3> push{}, turn{};
  std::uint32_t buttons = 0;
};

// What the reports of one SpaceMouse have said.
class CapReader {
 public:
  explicit CapReader(const ReportSizes& sizes) : sizes_(sizes) {}
  // Whether such reports tell all six axes.
  bool hasSixAxes() const;
  // Of one read: a whole report, as hidraw keeps them apart. Where there are several, or garbage
  // before them, they are found; one that is cut is left out. True when one of them was of the cap
  // itself, not of its buttons.
  bool take(const std::uint8_t* bytes, std::size_t count);
  const Cap& cap() const { return cap_; }

 private:
  bool believable(const std::uint8_t* report) const;
  bool apply(const std::uint8_t* report);

  ReportSizes sizes_;
  Cap cap_;
};

}  // namespace trephine::pedal
