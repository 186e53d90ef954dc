// Slots that a driven tool cuts in bone, in any place and direction of any grid, beside their
// geometry.
#pragma once

#include <algorithm>

#include "strokes_support.h"

namespace trephine::test {

struct Slot {
  double cut_mm3 = 0.0, geometry_mm3 = 0.0;
  double share() const { return cut_mm3 / geometry_mm3; }
};

// The part of bone within the tool's cutting solid on the straight way between places, counted on
// a lattice of 0.1 mm. `up`: of the bone's plane through the origin.
inline double slotGeometry_mm3(const Stroke& stroke, const Vec3& up, const Quat& turn) {
  const Vec3 from_mm = 1000.0 * (turn * stroke.tool.solid_from_m);
  const Vec3 to_mm = 1000.0 * (turn * stroke.tool.solid_to_m);
  const double radius_mm = 1000.0 * stroke.tool.radius_m, step_mm = 0.1;
  Vec3 low(1e9), high(-1e9);
  for (const Place& place : stroke.way) {
    for (const Vec3& end : {place.at_mm + from_mm, place.at_mm + to_mm}) {
      low = glm::min(low, end - radius_mm);
      high = glm::max(high, end + radius_mm);
    }
  }
  // Of its way, places a tenth of the radius apart.
  std::vector<Capsule> places;
  for (std::size_t n = 0; n + 1 < stroke.way.size(); ++n) {
    const Vec3 a = stroke.way[n].at_mm, b = stroke.way[n + 1].at_mm;
    const int steps = std::max(1, int(glm::length(b - a) / (0.1 * radius_mm)));
    for (int i = 0; i <= steps; ++i) {
      const Vec3 at = a + double(i) / steps * (b - a);
      if (glm::dot(at, up) > 2.0 * radius_mm) continue;  // in air
      places.push_back({at + from_mm, at + to_mm, radius_mm});
    }
  }
  double inside = 0.0;
  for (double z = low.z; z <= high.z; z += step_mm) {
    for (double y = low.y; y <= high.y; y += step_mm) {
      for (double x = low.x; x <= high.x; x += step_mm) {
        const Vec3 p(x, y, z);
        if (!(glm::dot(p, up) < 0.0)) continue;
        inside += std::any_of(places.begin(), places.end(), [&](const Capsule& c) {
          const Vec3 axis = c.to - c.from, away = p - c.from;
          const double length2 = glm::dot(axis, axis);
          const double on =
              length2 > 0.0 ? std::clamp(glm::dot(away, axis) / length2, 0.0, 1.0) : 0.0;
          const Vec3 apart = away - on * axis;
          return glm::dot(apart, apart) <= radius_mm * radius_mm;
        });
      }
    }
  }
  return inside * step_mm * step_mm * step_mm;
}

// 4 mm into bone, 8 mm along, and out, the tool upright on the bone's plane, which is turned at
// random in the grid; so slow that the motor has work to spare.
inline Slot randomSlot(const Tool& tool, const Vec3& spacing_mm, unsigned seed) {
  Random random(seed);
  Stroke s;
  s.tool = tool;
  s.tissues.count = 1;
  s.tissues.classes[0] = bone();
  s.block.spacing_mm = spacing_mm;
  const Vec3 axis = glm::normalize(Vec3(random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)) +
                                   Vec3(0.0, 0.0, 1e-6));
  const Vec3 turn_rad = random.in(0.0, 3.1) * axis;
  const Quat turn = turned(turn_rad);
  const Vec3 up = turn * Vec3(0, 0, 1), along = turn * Vec3(1, 0, 0), side = turn * Vec3(0, 1, 0);
  const Vec3 start = random.in(-1, 1) * side + random.in(-1, 1) * along - 4.0 * along;
  s.block.up = up;
  s.block.half_mm = Vec3(13.0);
  // No deeper than that a round head leaves room for its shaft.
  const double depth_mm =
      std::min(4.0, 1500.0 * tool.radius_m + (tool.blunt ? 0.0 : 4.0) +
                        1000.0 * glm::length(tool.solid_to_m - tool.solid_from_m));
  s.way = {{0.0, start + 4.0 * up, turn_rad},
           {1.5, start - depth_mm * up, turn_rad},
           {4.5, start - depth_mm * up + 8.0 * along, turn_rad},
           {5.5, start + 8.0 * along + 4.0 * up, turn_rad}};
  Slot slot;
  slot.cut_mm3 = cut(s).removed_mm3;
  slot.geometry_mm3 = slotGeometry_mm3(s, up, turn);
  return slot;
}

struct Slots {
  double mean = 0.0, least = 1e9, most = 0.0;  // shares of the geometry
};

inline Slots randomSlots(const Tool& tool, const Vec3& spacing_mm, unsigned count) {
  Slots out;
  double cut_mm3 = 0.0, geometry_mm3 = 0.0;
  for (unsigned seed = 1; seed <= count; ++seed) {
    const Slot slot = randomSlot(tool, spacing_mm, seed);
    cut_mm3 += slot.cut_mm3;
    geometry_mm3 += slot.geometry_mm3;
    out.least = std::min(out.least, slot.share());
    out.most = std::max(out.most, slot.share());
  }
  out.mean = cut_mm3 / geometry_mm3;
  return out;
}

struct DrivenTool {
  const char* name;
  Tool tool;
};
// Those that ship, as their files say, and a blade of 1.2 mm with a motor, as the shipped exercise
// of the cranium gives it.
inline std::vector<DrivenTool> drivenTools() {
  Tool craniotome = *makeTool({ToolKind::burr, 30.0, 48, 1.2, 8, BurrShape::cylinder, 10.0, 6.0});
  return {{"blade 1.2 mm", tool(ToolKind::blade, 16.0, 0.6, 6.0)},
          {"craniotome 2.4 mm", craniotome},
          {"burr 4 mm", tool(ToolKind::burr, 30.0, 2.0, 4.0)},
          {"burr 6 mm", tool(ToolKind::burr, 30.0, 3.0, 4.0)}};
}

}  // namespace trephine::test
