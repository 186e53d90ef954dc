// How a view shows a tissue. It changes neither what is felt nor what is cut.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace trephine {

enum class TissueLook : std::uint8_t {
  shown,    // in its colour, with its opacity
  ghosted,  // its outline alone, so that what lies behind it is seen
  hidden
};

// By tissue id; a tissue that is not named is shown.
using TissueLooks = std::map<std::string, TissueLook>;

}  // namespace trephine
