#include "imaging/common/detail/text.h"

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

}  // namespace

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

std::string slicesText(std::uint64_t count) {
  return trCount(count, "{} slice", "{} slices");
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

std::string listed(const std::vector<std::string>& words, const std::string& last) {
  std::string text;
  for (std::size_t n = 0; n < words.size(); ++n) {
    if (n > 0) text += n + 1 == words.size() ? " " + last + " " : ", ";
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
