#include "base/range.h"

#include <cstdio>

namespace trephine {

std::string plainNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.10g", value);
  return text;
}

std::string Range::words() const {
  return "between " + plainNumber(low) + " and " + plainNumber(high) + (*unit ? " " : "") + unit;
}

}  // namespace trephine
