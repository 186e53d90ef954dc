// Bytes as hexadecimal digits, two each.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trephine {

// In lower case.
std::string hexOf(std::span<const std::uint8_t> bytes);

// In either case; nothing for what is not hex.
std::optional<std::vector<std::uint8_t>> bytesOfHex(std::string_view hex);

}  // namespace trephine
