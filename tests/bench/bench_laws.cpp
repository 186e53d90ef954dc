// The time of a tick of an exercise with two laws, viscous and elastic: median ns over many ticks
// of a burr that slides in bone. `without_law.sh` compares it with a build from which a law was
// removed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "haptics/haptic_core.h"

int main() {
  using namespace trephine;
  Volume volume;
  volume.geometry.size = {128, 128, 128};
  volume.geometry.spacing_mm = Vec3(0.4);
  volume.geometry.origin_mm = Vec3(-25.4);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  std::fill_n(volume.hu.begin(), volume.hu.size() / 2, std::int16_t(1000));
  HapticParameters p;
  p.arms.resize(1);
  p.arms[0].tool = makeBurr(0.003, 64, 8, 0.03);
  p.arms[0].max_force_N = 3.3;
  p.laws = {LawKind::viscous, LawKind::elastic};
  p.tissues.count = 1;
  TissueClass& bone = p.tissues.classes[0];
  bone.hu_min = 226;
  bone.hu_max = 3071;
  bone.damping_Ns_per_m = 12.0;
  bone.stiffness_N_per_m = 900.0;
  p.journal_voxels = 1000;
  Grid grid(std::move(volume));
  HapticCore core(p, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  std::vector<double> ns;
  for (int n = 0; n < 200000; ++n) {
    input.tick = std::uint64_t(n);
    input.arms[0].position_m = 0.001 * Vec3(8.0 * std::sin(1e-3 * n), 5.0 * std::cos(7e-4 * n), -1.0);
    const auto begin = std::chrono::steady_clock::now();
    core.tick(input, nullptr, 0, record);
    ns.push_back(
        std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count());
  }
  std::nth_element(ns.begin(), ns.begin() + std::ptrdiff_t(ns.size() / 2), ns.end());
  std::printf("%.1f\n", ns[ns.size() / 2]);
}
