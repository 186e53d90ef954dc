#include "base/range.h"

#include <cstdio>

#include "base/tr.h"

namespace trephine {

std::string plainNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.10g", value);
  return text;
}

std::string Range::words() const {
  return tr("between {} and {}{}{}", plainNumber(low), plainNumber(high), (*unit ? " " : ""), unit);
}

}  // namespace trephine
