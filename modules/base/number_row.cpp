#include "base/number_row.h"

#include <cmath>

namespace trephine {

namespace {

// As schema pages have it: 1e9, not 1e+09, and commas in no number, since tables are searched.
std::string pageNumber(double value) {
  const double size = std::abs(value);
  if (size < 1e6) return plainNumber(value);
  const int power = int(std::log10(size) + 1e-9);
  const double front = value / std::pow(10.0, power);
  return front == std::floor(front) ? plainNumber(front) + "e" + std::to_string(power)
                                    : plainNumber(value);
}

}  // namespace

Status checkNumber(const NumberRow& row, double value, const std::string& of) {
  if (row.range.holds(value)) return {};
  return Error{"IMPOSSIBLE_NUMBER",
               "The value " + plainNumber(value) + " must lie " + row.range.words(),
               of + ": " + row.key, "Correct that value"};
}

std::string schemaHead() {
  return "| of | key | type | range | unit | without it | meaning "
         "|\n|---|---|---|---|---|---|---|\n";
}

std::string schemaLine(std::string_view of, const NumberRow& row, std::string_view type,
                       const std::string& fallback) {
  const auto cell = [](std::string_view text) {
    return text.empty() ? std::string(" |") : " " + std::string(text) + " |";
  };
  return "|" + cell(of) + cell("`" + std::string(row.key) + "`") + cell(type) +
         cell(pageNumber(row.range.low) + " to " + pageNumber(row.range.high)) +
         cell(row.range.unit) + cell(row.given == Given::always ? "refused" : fallback) +
         cell(row.meaning) + "\n";
}

}  // namespace trephine
