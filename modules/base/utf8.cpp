#include "base/utf8.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace trephine {

namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

// Length of the UTF-8 sequence at the front of `text`; 0 where it is not valid.
std::size_t sequenceLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  // Overlong forms, surrogates and code points past U+10FFFF.
  if (first == 0xE0 && byte(1) < 0xA0) return 0;
  if (first == 0xED && byte(1) > 0x9F) return 0;
  if (first == 0xF0 && byte(1) < 0x90) return 0;
  if (first == 0xF4 && byte(1) > 0x8F) return 0;
  return length;
}

// Of a sequence of that length.
char32_t codePoint(std::string_view text, std::size_t length) {
  constexpr std::array<unsigned char, 5> kFirst{0, 0x7F, 0x1F, 0x0F, 0x07};
  char32_t code = static_cast<unsigned char>(text[0]) & kFirst[length];
  for (std::size_t i = 1; i < length; ++i) {
    code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3F);
  }
  return code;
}

struct CodeRange {
  char32_t first, last;
};

// What has no width of its own: it would make two names look alike.
constexpr CodeRange kUnseen[] = {
    {0xAD, 0xAD},     {0x34F, 0x34F},   {0x61C, 0x61C},   {0x115F, 0x1160}, {0x17B4, 0x17B5},
    {0x180B, 0x180E}, {0x200B, 0x200F}, {0x2060, 0x2065}, {0x206A, 0x206F}, {0x3164, 0x3164},
    {0xFE00, 0xFE0F}, {0xFEFF, 0xFEFF}, {0xFFA0, 0xFFA0}, {0xFFF9, 0xFFFB}, {0xE0000, 0xE0FFF}};

bool isUnseen(char32_t code) {
  return std::ranges::any_of(
      kUnseen, [code](const CodeRange& r) { return code >= r.first && code <= r.last; });
}

// Of C0 and C1, which a terminal obeys; what ends a line; what turns the direction of all that
// follows, which is no part of a text's own line.
bool isControl(char32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

// Between letters of several scripts, of which they tell how these are joined.
bool isJoiner(char32_t code) {
  return code == 0x200C || code == 0x200D;
}

// Of a text's own line, or of lines for a terminal.
std::string cleaned(std::string_view text, bool keep_lines) {
  std::string clean;
  while (!text.empty()) {
    const std::size_t length = sequenceLength(text);
    if (length == 0) {
      clean += kReplacement;
      text.remove_prefix(1);
      continue;
    }
    const char32_t code = codePoint(text, length);
    if (isControl(code) && !(keep_lines && (code == '\n' || code == '\t'))) {
      clean += ' ';
    } else if (!isUnseen(code) || (!keep_lines && isJoiner(code))) {
      clean += text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  return clean;
}

}  // namespace

bool isUtf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = sequenceLength(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

bool isOneLine(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = sequenceLength(text);
    if (length == 0 || isControl(codePoint(text, length))) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::size_t charactersOf(std::string_view text) {
  return std::size_t(
      std::ranges::count_if(text, [](char c) { return (std::uint8_t(c) & 0xC0) != 0x80; }));
}

std::string cleanUtf8(std::string_view text) {
  const std::string clean = cleaned(text, false);
  const std::size_t begin = clean.find_first_not_of(' '), end = clean.find_last_not_of(' ');
  return begin == clean.npos ? "" : clean.substr(begin, end + 1 - begin);
}

std::string cleanLines(std::string_view text) {
  return cleaned(text, true);
}

std::string cutUtf8(const std::string& text, std::size_t most_bytes) {
  if (text.size() <= most_bytes) return text;
  std::size_t end = most_bytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end);
}

}  // namespace trephine
