// An axis of a plot: where a value lies on it, where its ticks stand and what they say. Pure.
#pragma once

#include <string>
#include <vector>

namespace trephine::plot {

// At most `digits` significant digits, the same in every locale; 1e6, not 1e+06.
std::string number(double value, int digits = 4);

struct Axis {
  std::string title;  // the quantity: "Sampling period T"
  std::string unit;   // "ms"; empty: none
  bool logarithmic = false;
  double low = 0.0, high = 1.0;  // low < high; decades (log10 of values) where logarithmic
  // Two values or more, ascending, to stand ticks at. If one lies off the axis, or two stand too
  // close, ticks stand at round values instead. Values, not decades, on a logarithmic axis too.
  std::vector<double> at = {};

  // As low and high: the value, or its decades; on a logarithmic axis 0 and less lie at -infinity.
  double position(double value) const;
  double share(double value) const;     // 0 at the low end, 1 at the high one
  bool holds(double value) const;       // share within 0 to 1; false for what is not finite
};

struct Tick {
  double share = 0.0;  // of the axis
  std::string text;
};

struct Ticks {
  std::vector<Tick> ticks;  // ascending; neighbours at least the room apart
  std::string title;        // with the unit that the texts are in: "Force [mN]"
};

// Ticks at round values, neighbours at least `room` apart: a share of the axis above 0, which the
// caller takes from the width of his texts. There may be none. On a linear axis the unit takes the
// prefix that keeps the numbers short (mN, kN/m), or a power of ten in Unicode's raised digits
// where it takes none; on a logarithmic one it stays.
Ticks ticksOf(const Axis& axis, double room);

// 1, 2 or 5 times a power of ten: the smallest that is not below `least`, which is above 0.
double roundStep(double least);

// `unit` made larger by 10^exponent (a multiple of 3) with a prefix of the SI: "N/m" by 10^3 is
// "kN/m", "ms" by 10^-3 is "us" with the micro sign (U+00B5); empty where it takes none ("%", "kg",
// "mm^3").
std::string prefixed(const std::string& unit, int exponent);

}  // namespace trephine::plot
