#include "lab/touch/extremes_rows.h"

#include <cmath>
#include <cstdlib>

namespace trephine::extremes {

int voxelsOnTheWay(double spacing_mm) {
  const auto voxel = [&](int tick) {
    return int(std::lround(1000.0 * stroke(tick).position_m.x / spacing_mm));
  };
  return voxel(kTicks - 1) - voxel(0) + 1;
}

Outcome judge(const Run& run, bool as_expected, const std::string& got) {
  if (run.broken.empty()) return {got, as_expected};
  return {got + "; but " + run.broken, false};
}

Outcome ordinary(const Setup& setup, int voxels) {
  const Run r = run(setup);
  const bool as_many = std::llabs(std::int64_t(r.removed) - voxels) <= 2;
  return judge(r, r.largest_N() > kFelt_N && !r.faulty() && as_many, facts(r));
}

Outcome nothingTouched(const Setup& setup) {
  const Run r = run(setup);
  return judge(r, r.touching() == 0 && r.largest_N() == 0.0 && r.removed == 0 && !r.faulty(),
               facts(r) + ", " + std::to_string(r.touching()) + " ticks in tissue");
}

Outcome undisturbed(const Setup& setup) {
  const Run r = run(setup), reference = run({});
  const bool same = sameForces(r, reference);
  return judge(r, same && !r.faulty() && r.largest_N() > kFelt_N,
               facts(r) + (same ? ", the reference's forces" : ", other forces"));
}

Outcome faultThenWork(const Setup& setup, std::uint32_t fault, int tick) {
  const Run r = run(setup);
  const bool stood = r.faultTick(fault) == tick && r.arm(kClear - 1).faults != 0;
  const double after_N = r.largest_N(kClear);
  const int cut = r.cut(kClear);
  const std::string got =
      (stood ? formatted("a fault from tick %d to %d", tick, kClear - 1) : facts(r)) +
      formatted(", then up to %.3g N and %d voxels cut", after_N, cut);
  return judge(r, stood && r.arm(kClear).faults == 0 && after_N > kFelt_N && cut > 0, got);
}

}  // namespace trephine::extremes
