// Judged cells of a stability grid, made up.
#pragma once

#include "lab/stability/stability_maps.h"

namespace trephine::test {

inline MapCell damper(double period_s, double b, bool stable = true) {
  MapCell cell;
  cell.controller = "direct";
  cell.mass_kg = 0.045;
  cell.period_s = period_s;
  cell.tissue_b = b;
  cell.stable = stable;
  return cell;
}

inline MapCell wall(double period_s, double k, bool stable = true) {
  MapCell cell = damper(period_s, 0.0, stable);
  cell.tissue_k = k;
  return cell;
}

inline MapCell held(MapCell cell, double hand_k, double hand_b) {
  cell.hand_k = hand_k;
  cell.hand_b = hand_b;
  return cell;
}

}  // namespace trephine::test
