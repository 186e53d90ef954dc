// Where an arm reaches in the patient, as it is drawn and dragged in the views.
#pragma once

#include <QColor>
#include <array>
#include <utility>

#include "base/math.h"

namespace trephine {

struct WorkspaceBox {
  Vec3 centre_mm{0.0};        // where the device's origin lies
  Quat rotation{1, 0, 0, 0};  // device axes to patient axes
  Vec3 size_mm{0.0};          // full extents, in the patient
  QColor colour;
  bool chosen = false;  // it may be dragged

  std::array<Vec3, 8> corners() const {
    std::array<Vec3, 8> all;
    for (int n = 0; n < 8; ++n) {
      const Vec3 side((n & 1) ? 0.5 : -0.5, (n & 2) ? 0.5 : -0.5, (n & 4) ? 0.5 : -0.5);
      all[std::size_t(n)] = centre_mm + rotation * (side * size_mm);
    }
    return all;
  }
  std::array<std::pair<Vec3, Vec3>, 12> edges() const {
    constexpr std::size_t kEnds[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                                          {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
    const std::array<Vec3, 8> ends = corners();
    std::array<std::pair<Vec3, Vec3>, 12> all;
    for (std::size_t n = 0; n < all.size(); ++n) all[n] = {ends[kEnds[n][0]], ends[kEnds[n][1]]};
    return all;
  }
  friend bool operator==(const WorkspaceBox&, const WorkspaceBox&) = default;
};

}  // namespace trephine
