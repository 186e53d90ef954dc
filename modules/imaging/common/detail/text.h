// Text as it stands in files, made safe to show: always valid UTF-8, numbers free of the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/tr.h"
#include "base/utf8.h"

namespace trephine {

// For text whose character set cannot be decoded: UTF-8 where it is that, ISO 2022 escapes dropped
// and what they encoded shown as U+FFFD, anything else read as Latin-1. Never fails.
std::string guessUtf8(std::string_view text);

// The values of a DICOM DS or IS ("1\ -2.5 \3e2"); nothing when one of them is no finite number.
std::optional<std::vector<double>> parseDecimals(std::string_view text);
// A single value; nothing when there are none, several or a bad one.
std::optional<double> parseDecimal(std::string_view text);
std::optional<int> parseInteger(std::string_view text);

// "12.50" for (12.5, 2), whatever the locale.
std::string fixedText(double value, int digits);

// "1 slice", "3 slices".
std::string slicesText(std::uint64_t count);

// A term as the standard's short strings hold them ("B30f", "AXIAL"): at most 16 letters, digits
// and " _-+./" in each value. Other text, which could name somebody, becomes "another".
std::string shownTerm(const std::string& text);

// "size", "size and kernel", "size, kernel and kVp"
std::string listed(const std::vector<std::string>& words, const std::string& last = tr("and"));

std::vector<std::string> splitValues(std::string_view text);  // at backslashes, trimmed

}  // namespace trephine
