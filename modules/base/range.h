// The values that a number of a file or a device may have.
#pragma once

#include <string>

namespace trephine {

struct Range {
  double low;
  double high;  // both ends are allowed
  const char* unit = "";

  // False for what is not a number.
  bool holds(double value) const { return value >= low && value <= high; }
  std::string words() const;  // "between 0 and 1000 mm"
};

std::string plainNumber(double value);  // as people write it: 0.001, 1000000

}  // namespace trephine
