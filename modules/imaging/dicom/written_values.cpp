#include "imaging/dicom/detail/written_values.h"

#include <charconv>

#include "base/sha256.h"

namespace trephine {

std::string decimalText(double value) {
  if (value == 0.0) value = 0.0;  // no "-0"
  char buffer[64];
  auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  for (int digits = 16; end - buffer > 16 && digits > 0; --digits) {
    end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits)
              .ptr;
  }
  return std::string(buffer, end);
}

std::string decimalsText(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) {
    if (!text.empty()) text += '\\';
    text += decimalText(value);
  }
  return text;
}

std::string uidOf(const std::string& content) {
  const std::string hex = sha256Hex(content.data(), content.size());
  unsigned __int128 number = 0;
  for (int i = 0; i < 32; ++i) {
    const char c = hex[std::size_t(i)];
    number = number * 16 + unsigned(c <= '9' ? c - '0' : c - 'a' + 10);
  }
  std::string digits;
  do {
    digits.insert(digits.begin(), char('0' + int(number % 10)));
    number /= 10;
  } while (number != 0);
  return "2.25." + digits;
}

}  // namespace trephine
