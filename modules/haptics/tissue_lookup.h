// The class of a HU in one load, and which of two tissues is firmer.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tissue/tissue_set.h"

namespace trephine {

class TissueLookup {
 public:
  TissueLookup() : class_of_(65536, -1) {}
  // No allocation; a few microseconds.
  void set(const TissueTable& tissues) {
    std::fill(class_of_.begin(), class_of_.end(), std::int8_t(-1));
    for (int c = tissues.count - 1; c >= 0; --c) {  // the first of two that overlap holds
      const TissueClass& t = tissues.classes[std::size_t(c)];
      for (std::int32_t hu = std::max(t.hu_min, -32768); hu <= std::min(t.hu_max, 32767); ++hu) {
        class_of_[std::size_t(hu + 32768)] = std::int8_t(c);
      }
    }
  }
  int classOf(std::int16_t hu) const { return class_of_[std::size_t(int(hu) + 32768)]; }

 private:
  std::vector<std::int8_t> class_of_;
};

// The firmest tissue is that of the largest friction, then stiffness, then damping. -1 is air.
inline bool firmer(const TissueTable& tissues, int a, int b) {
  if (a < 0 || b < 0) return b < 0 && a >= 0;
  const TissueClass& x = tissues.classes[std::size_t(a)];
  const TissueClass& y = tissues.classes[std::size_t(b)];
  if (x.friction_N != y.friction_N) return x.friction_N > y.friction_N;
  if (x.stiffness_N_per_m != y.stiffness_N_per_m) return x.stiffness_N_per_m > y.stiffness_N_per_m;
  return x.damping_Ns_per_m > y.damping_Ns_per_m;
}

}  // namespace trephine
