#include "plot/axis.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <string_view>

namespace trephine::plot {

namespace {

constexpr double kMostTicks = 12.0;

// The names of the values, short, but no two the same.
std::vector<std::string> namesOf(const std::vector<double>& values) {
  std::vector<std::string> names;
  for (int digits = 6; digits < 16; ++digits) {
    names.clear();
    for (const double value : values) names.push_back(number(value, digits));
    if (std::set<std::string>(names.begin(), names.end()).size() == names.size()) break;
  }
  return names;
}

bool apart(const Axis& axis, const std::vector<double>& values, double room) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    // A hair less, since values that stand exactly so far apart have been rounded.
    if (axis.share(values[i]) - axis.share(values[i - 1]) < room * (1.0 - 1e-9)) return false;
  }
  return true;
}

std::vector<double> multiples(const Axis& axis, double low, double high, double step) {
  std::vector<double> values;
  const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
  for (int i = 0; i <= last - first; ++i) {
    const double value = first + i == 0.0 ? 0.0 : (first + i) * step;
    if (std::isfinite(axis.position(value))) values.push_back(value);
  }
  return values;
}

// As many as have room; may be none.
std::vector<double> roundValues(const Axis& axis, double low, double high, double room) {
  const double most = std::clamp(std::floor(1.0 / room), 1.0, kMostTicks);
  double step = roundStep((high - low) / most);
  // On a logarithmic axis the upper ones lie closer.
  for (int wider = 0; wider < 6; ++wider, step = roundStep(1.1 * step)) {
    const std::vector<double> values = multiples(axis, low, high, step);
    if (apart(axis, values, room)) return values;
  }
  return {};
}

std::vector<double> inDecades(const Axis& axis, const std::vector<double>& digits, int every) {
  std::vector<double> values;
  for (int decade = int(std::floor(axis.low)); decade <= int(std::floor(axis.high)); ++decade) {
    if (decade % every != 0) continue;
    for (const double digit : digits) {
      const double value = digit * std::pow(10.0, decade);
      if (axis.holds(value)) values.push_back(value);
    }
  }
  return values;
}

std::vector<double> logarithmicValues(const Axis& axis, double room) {
  // The last ones where a decade of its own would be the only tick, which is no scale.
  for (const std::vector<double>& digits :
       std::vector<std::vector<double>>{{1, 2, 5}, {1}, {1, 3}, {2, 5}}) {
    const std::vector<double> values = inDecades(axis, digits, 1);
    if (values.size() > 1 && double(values.size()) <= 2.0 * kMostTicks &&
        apart(axis, values, room)) {
      return values;
    }
  }
  if (axis.high - axis.low < 1.5) {
    return roundValues(axis, std::pow(10.0, axis.low), std::pow(10.0, axis.high), room);
  }
  return inDecades(axis, {1}, std::max(1, int(std::ceil(room * (axis.high - axis.low)))));
}

struct Prefix {
  std::string_view text;
  int exponent;
};
constexpr std::array<Prefix, 9> kPrefixes{{{"p", -12},
                                           {"n", -9},
                                           {"\u00b5", -6},
                                           {"m", -3},
                                           {"", 0},
                                           {"k", 3},
                                           {"M", 6},
                                           {"G", 9},
                                           {"T", 12}}};
constexpr std::array<std::string_view, 8> kUnits{"s", "m", "N", "J", "W", "Hz", "Pa", "V"};

std::string raised(int exponent) {
  constexpr std::array<const char*, 10> kDigits{"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                                "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = exponent < 0 ? "10\u207b" : "10";
  for (const char digit : std::to_string(std::abs(exponent)))
    text += kDigits[std::size_t(digit - '0')];
  return text;
}

// The power of ten that is left out of an axis' numbers, and the unit with it.
struct Scaled {
  int exponent = 0;
  std::string unit;
};
Scaled scaled(const Axis& axis) {
  const double largest = std::max(std::abs(axis.low), std::abs(axis.high));
  const int exponent = 3 * int(std::floor(std::log10(largest) / 3.0 + 1e-9));
  const std::string with = prefixed(axis.unit, exponent);
  if (!with.empty() && (largest < 0.1 || largest >= 1e4)) return {exponent, with};
  if (largest >= 1e-3 && largest < 1e6) return {0, axis.unit};
  return {exponent, raised(exponent) + (axis.unit.empty() ? "" : " " + axis.unit)};
}

}  // namespace

std::string number(double value, int digits) {
  char text[40];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits);
  std::string result(text, end.ptr);
  const std::size_t e = result.find('e');
  if (e == std::string::npos) return result;
  const bool negative = result[e + 1] == '-';
  std::size_t first = e + 2;
  while (first + 1 < result.size() && result[first] == '0') ++first;
  return result.substr(0, e + 1) + (negative ? "-" : "") + result.substr(first);
}

double Axis::position(double value) const {
  if (!logarithmic) return value;
  return value <= 0.0 ? -std::numeric_limits<double>::infinity() : std::log10(value);
}

double Axis::share(double value) const {
  return (position(value) - low) / (high - low);
}

bool Axis::holds(double value) const {
  const double at_share = share(value);
  return at_share >= 0.0 && at_share <= 1.0;
}

double roundStep(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * decade >= least * (1.0 - 1e-9)) return digit * decade;
  }
  return 10.0 * decade;
}

std::string prefixed(const std::string& unit, int exponent) {
  const std::size_t end = unit.find_first_of(" /");
  const std::string_view first = std::string_view(unit).substr(0, end);
  for (const std::string_view base : kUnits) {
    if (!first.ends_with(base)) continue;
    const std::string_view before = first.substr(0, first.size() - base.size());
    const auto now = std::find_if(kPrefixes.begin(), kPrefixes.end(),
                                  [&](const Prefix& p) { return p.text == before; });
    if (now == kPrefixes.end()) continue;
    const auto then = std::find_if(kPrefixes.begin(), kPrefixes.end(), [&](const Prefix& p) {
      return p.exponent == now->exponent + exponent;
    });
    if (then == kPrefixes.end()) return {};
    return std::string(then->text) + std::string(base) +
           (end == std::string::npos ? "" : unit.substr(end));
  }
  return {};
}

Ticks ticksOf(const Axis& axis, double room) {
  Scaled scale{0, axis.unit};
  if (!axis.logarithmic) scale = scaled(axis);
  std::vector<double> values;
  for (const double value : axis.at) {
    if (axis.holds(value)) values.push_back(value);
  }
  if (values.size() < 2 || values.size() < axis.at.size() || !apart(axis, values, room)) {
    values = axis.logarithmic ? logarithmicValues(axis, room)
                              : roundValues(axis, axis.low, axis.high, room);
  }
  Ticks result;
  result.title = axis.title;
  if (!scale.unit.empty()) result.title += " [" + scale.unit + "]";
  std::vector<double> shown;
  for (const double value : values) {
    shown.push_back(scale.exponent == 0 ? value : value * std::pow(10.0, -scale.exponent));
  }
  const std::vector<std::string> names = namesOf(shown);
  for (std::size_t i = 0; i < values.size(); ++i) {
    result.ticks.push_back({axis.share(values[i]), names[i]});
  }
  return result;
}

}  // namespace trephine::plot
