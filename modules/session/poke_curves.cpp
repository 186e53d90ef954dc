#include "session/poke_curves.h"

#include <algorithm>
#include <cmath>

namespace trephine {

PokeCurves::PokeCurves(std::size_t arms, double rate_hz)
    : arms_(arms), end_ticks_(std::size_t(std::lround(kEnd_s * rate_hz))) {}

void PokeCurves::tick(const TickRecord& record) {
  for (std::size_t arm = 0; arm < arms_; ++arm) {
    const ArmRecord& now = record.arms[arm];
    if (!isFinite(now.patient_position_mm)) continue;
    Poke& poke = pokes_[arm];
    const bool touches = now.tissue_class >= 0 && (now.tool_state & (kToolWaits | kToolClutched)) == 0;
    if (touches && !poke.open) begin(arm, now);
    last_mm_[arm] = now.patient_position_mm;
    if (!poke.open) continue;
    const double depth_mm = glm::dot(now.patient_position_mm - poke.from_mm, poke.into);
    if (PokeCurve* curve = openOf(arm)) {
      const double sent_N = glm::length(now.sent_N);
      addPoint(*curve, {depth_mm, glm::length(now.demanded_N), sent_N});
      if (sent_N > curve->most_N && now.tissue_class >= 0) {
        curve->most_N = sent_N;
        curve->tissue = now.tissue_class;
      }
    }
    poke.out_ticks = touches ? 0 : poke.out_ticks + 1;
    if (poke.out_ticks >= end_ticks_) end(arm);
  }
}

PokeCurve* PokeCurves::openOf(std::size_t arm) {
  for (PokeCurve& curve : curves_) {
    if (!curve.ended && curve.arm == arm) return &curve;
  }
  return nullptr;
}

void PokeCurves::begin(std::size_t arm, const ArmRecord& now) {
  Poke& poke = pokes_[arm];
  poke.from_mm = last_mm_[arm].value_or(now.patient_position_mm);
  poke.into = now.proxy_orientation * Vec3(0.0, 0.0, -1.0);
  poke.out_ticks = 0;
  poke.open = true;
  PokeCurve curve;
  curve.arm = arm;
  curve.tissue = now.tissue_class;
  curves_.push_back(std::move(curve));
}

void PokeCurves::end(std::size_t arm) {
  pokes_[arm].open = false;
  PokeCurve* curve = openOf(arm);
  if (!curve) return;
  double deepest_mm = 0.0;
  for (const PokePoint& point : curve->points) deepest_mm = std::max(deepest_mm, point.depth_mm);
  const double most_N = curve->most_N;
  PokeCurve ended = std::move(*curve);
  curves_.erase(curves_.begin() + (curve - curves_.data()));
  if (deepest_mm < kLeast_mm || most_N < kLeast_N) return;
  ended.ended = true;
  const auto first_open = std::ranges::find(curves_, false, &PokeCurve::ended);
  curves_.insert(first_open, std::move(ended));
  const auto count = std::size_t(std::ranges::count(curves_, true, &PokeCurve::ended));
  if (count > kKept) curves_.erase(curves_.begin());
}

void PokeCurves::addPoint(PokeCurve& curve, const PokePoint& point) {
  std::vector<PokePoint>& points = curve.points;
  if (!points.empty()) {
    const PokePoint& last = points.back();
    if (std::abs(point.depth_mm - last.depth_mm) < kStep_mm &&
        std::abs(point.sent_N - last.sent_N) < kStep_N &&
        std::abs(point.demanded_N - last.demanded_N) < kStep_N) {
      return;
    }
  }
  if (points.size() >= kMostPoints) {
    for (std::size_t i = 0; 2 * i < points.size(); ++i) points[i] = points[2 * i];
    points.resize((points.size() + 1) / 2);
  }
  points.push_back(point);
}

}  // namespace trephine
