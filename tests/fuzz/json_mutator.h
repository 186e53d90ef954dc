// Changes one place of a JSON text, so that most of it is still read: bytes alone would hardly ever
// get past the parser.
#pragma once

#include <cstdint>
#include <string>

namespace trephine::fuzz {

// The text after one to three changes; empty where it is no JSON. The same seed does the same.
std::string mutatedJson(const std::string& text, std::uint32_t seed);

}  // namespace trephine::fuzz
