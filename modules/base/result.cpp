#include "base/result.h"

#include "base/utf8.h"

namespace trephine {

std::string Error::sentence() const {
  std::string text = what;
  if (!where.empty()) text += " (" + where + ")";
  text += ".";
  if (!next.empty()) text += " " + next + ".";
  return cleanUtf8(text);
}

}  // namespace trephine
