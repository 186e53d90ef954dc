// Text from elsewhere, made safe to show and to write.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace trephine {

bool isUtf8(std::string_view text);

// Valid UTF-8 without a character that a terminal obeys, that ends a line or that turns the
// direction of what follows.
bool isOneLine(std::string_view text);

// Characters of valid UTF-8.
std::size_t charactersOf(std::string_view text);

// `text` as valid UTF-8 in one line: bytes that are none become U+FFFD, control characters (C0, C1)
// a space, characters without a width go but for those that join letters (U+200C, U+200D), and so
// do spaces around it.
std::string cleanUtf8(std::string_view text);

// The same of several lines: newlines, tabs and spaces stay. What a terminal gets.
std::string cleanLines(std::string_view text);

// Its first characters, in at most so many bytes.
std::string cutUtf8(const std::string& text, std::size_t most_bytes);

}  // namespace trephine
