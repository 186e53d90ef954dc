#include "imaging/common/text.h"

#include <charconv>
#include <cmath>

namespace trephine {

namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\0')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.remove_suffix(1);
  return text;
}

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

}  // namespace

bool isUtf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = sequenceLength(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string cleanUtf8(std::string_view text) {
  std::string clean;
  while (!text.empty()) {
    const std::size_t length = sequenceLength(text);
    const auto first = static_cast<unsigned char>(text.front());
    // What turns the direction of all that follows is no part of a text's own line.
    const bool turns =
        length == 3 && ((text.starts_with("\xE2\x80") && text[2] >= '\xAA' && text[2] <= '\xAE') ||
                        (text.starts_with("\xE2\x81") && text[2] >= '\xA6' && text[2] <= '\xA9'));
    if (turns) {
      clean += ' ';
    } else if (length == 0) {
      clean += kReplacement;
    } else if (first < 0x20 || first == 0x7F) {
      clean += ' ';
    } else {
      clean += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return std::string(trimmed(clean));
}

std::string guessUtf8(std::string_view text) {
  constexpr char kEscape = 0x1B;
  std::string guess;
  bool escaped = false;  // past the first escape, the bytes' meaning is not known
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == kEscape) {
      // ESC, intermediate bytes 0x20-0x2F, one final byte.
      while (i + 1 < text.size() && text[i + 1] >= 0x20 && text[i + 1] <= 0x2F) ++i;
      if (i + 1 < text.size()) escaped = !(text[++i] == 'B' && text[i - 1] == '(');
      if (escaped) guess += kReplacement;
    } else if (!escaped) {
      guess += text[i];
    }
  }
  if (isUtf8(guess)) return cleanUtf8(guess);
  std::string latin;
  for (const char c : guess) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      latin += c;
    } else {
      latin += static_cast<char>(0xC0 | byte >> 6);
      latin += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return cleanUtf8(latin);
}

std::string counted(std::uint64_t count, std::string_view thing, std::string_view one_does,
                    std::string_view many_do) {
  std::string text = std::to_string(count) + " " + std::string(thing) + (count == 1 ? "" : "s");
  const std::string_view verb = count == 1 ? one_does : many_do;
  return verb.empty() ? text : text + " " + std::string(verb);
}

std::string shownTerm(const std::string& text) {
  constexpr std::size_t kLongest = 16;
  std::size_t length = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool fits = std::isalnum(byte) || std::string_view("_-+./ ").find(c) != text.npos;
    length = c == '\\' ? 0 : length + 1;
    if ((!fits && c != '\\') || byte > 0x7E || length > kLongest) return "another";
  }
  return text;
}

std::string listed(const std::vector<std::string>& words, std::string_view last) {
  std::string text;
  for (std::size_t n = 0; n < words.size(); ++n) {
    if (n > 0) text += n + 1 == words.size() ? " " + std::string(last) + " " : ", ";
    text += words[n];
  }
  return text;
}

std::vector<std::string> splitValues(std::string_view text) {
  std::vector<std::string> values;
  while (true) {
    const std::size_t end = text.find('\\');
    values.emplace_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return values;
    text.remove_prefix(end + 1);
  }
}

std::optional<std::vector<double>> parseDecimals(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string& value : splitValues(text)) {
    const char* first = value.data() + (!value.empty() && value.front() == '+' ? 1 : 0);
    const char* last = value.data() + value.size();
    double number = 0.0;
    const auto [end, error] = std::from_chars(first, last, number);
    if (error != std::errc() || end != last || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
  }
  return numbers;
}

std::optional<double> parseDecimal(std::string_view text) {
  const auto numbers = parseDecimals(text);
  if (!numbers || numbers->size() != 1) return std::nullopt;
  return numbers->front();
}

std::optional<int> parseInteger(std::string_view text) {
  const auto number = parseDecimal(text);
  if (!number || std::abs(*number) > 2e9 || *number != std::floor(*number)) return std::nullopt;
  return static_cast<int>(*number);
}

std::string fixedText(double value, int digits) {
  if (std::abs(value) < 0.5 * std::pow(10.0, -digits)) value = 0.0;  // no "-0.00"
  char buffer[400];
  const auto result =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, digits);
  return std::string(buffer, result.ptr);
}

}  // namespace trephine
