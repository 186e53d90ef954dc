// The shipped exercises must be felt: what an Omni with `bounded` is sent in their tissues at 10
// mm/s.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "base/system.h"
#include "exercise/exercise.h"

namespace trephine {
namespace {

// As resources/devices/omni.json has it.
const ArmDynamics kOmni{0.045, 5.5e-5, 3.3, 0};

struct Slab {
  const char* tissue;
  double thick_mm;
};

// Slabs of the exercise's tissues below z = 0, 0.5 mm voxels, air above.
Volume slabs(const TissueSet& tissues, const std::vector<Slab>& stack) {
  Volume volume;
  volume.geometry.size = {64, 64, 128};
  volume.geometry.spacing_mm = Vec3(0.5);
  volume.geometry.origin_mm = {-15.75, -15.75, -47.75};
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  double top_mm = 0.0;
  for (const Slab& slab : stack) {
    const Tissue& tissue = *tissues.find(slab.tissue);
    const auto hu = std::int16_t((tissue.hu_min + std::min(tissue.hu_max, 1500)) / 2);
    for (int k = 0; k < 128; ++k) {
      const double depth_mm = 47.75 - 0.5 * k;
      if (depth_mm < top_mm || depth_mm >= top_mm + slab.thick_mm) continue;
      std::fill_n(volume.hu.begin() + 64 * 64 * k, 64 * 64, hu);
    }
    top_mm += slab.thick_mm;
  }
  return volume;
}

// The force along the way, into the tissue at 10 mm/s, on an encoder's samples.
std::vector<double> feel(const Exercise& exercise, std::size_t arm, const std::vector<Slab>& stack,
                         double to_mm) {
  HapticParameters p = hapticParameters(exercise);
  p.arms = {p.arms[arm]};
  p.arms[0].map = WorkspaceMap{};
  p.arms[0].map.motion_scale = exercise.arms[arm].map.motion_scale;
  p.arms[0].map.force_scale = exercise.arms[arm].map.force_scale;
  p.arms[0].dynamics = kOmni;
  p.journal_voxels = 1'000'000;
  Grid grid(slabs(exercise.tissues, stack));
  HapticCore core(p, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  std::vector<double> force;
  const double s = p.arms[0].map.motion_scale;
  for (double depth_mm = -5.0; depth_mm <= to_mm; depth_mm += 0.01) {
    const double at_m = -depth_mm / s / 1000.0;
    input.arms[0].position_m.z = std::round(at_m / kOmni.encoder_step_m) * kOmni.encoder_step_m;
    input.journal = core.journalState();
    core.tick(input, nullptr, 0, record);
    ++input.tick;
    force.push_back(record.arms[0].sent_N.z);
  }
  return force;
}

double mean(const std::vector<double>& force, double from_mm, double to_mm) {
  const auto at = [](double mm) { return std::size_t((mm + 5.0) * 100.0); };
  double sum = 0.0;
  for (std::size_t n = at(from_mm); n < at(to_mm); ++n) sum += force[n];
  return sum / double(at(to_mm) - at(from_mm));
}

Exercise shipped(const char* name) { return *readExercise(resourceFolder() / "scenes" / name); }

TEST(Felt, BoneResistsAnOmniByHalfANewtonAndThreeTimesAsMuchAsBrain) {
  for (const char* name : {"cranium.json", "cranium-one-arm.json", "burr-hole.json"}) {
    const Exercise exercise = shipped(name);
    for (std::size_t arm = 0; arm < exercise.arms.size(); ++arm) {
      const double bone_N = mean(feel(exercise, arm, {{"bone", 40.0}}, 12.0), 3.0, 12.0);
      const double brain_N = mean(feel(exercise, arm, {{"brain", 40.0}}, 12.0), 3.0, 12.0);
      EXPECT_GE(bone_N, 0.5) << name;
      EXPECT_GE(bone_N, 3.0 * brain_N) << name;
      EXPECT_GT(brain_N, 0.0) << name;
      RecordProperty(std::string(name) + "_bone_N", std::to_string(bone_N));
      RecordProperty(std::string(name) + "_brain_N", std::to_string(brain_N));
    }
  }
}

TEST(Felt, TheCapsuleOfTheLiverGivesWayBeforeItsParenchyma) {
  Exercise exercise = shipped("liver.json");
  exercise = onCase(exercise, "");
  exercise.tissues = *exercise.tissues_elsewhere;  // known by HU
  for (std::size_t arm = 0; arm < exercise.arms.size(); ++arm) {
    const std::vector<double> force =
        feel(exercise, arm, {{"fat", 6.0}, {"capsule", 2.0}, {"liver", 30.0}}, 20.0);
    const auto from = force.begin() + 1000;  // 5 mm deep, in fat
    const double peak_N = *std::max_element(from, from + 500);
    const double fat_N = mean(force, 3.0, 5.5), liver_N = mean(force, 12.0, 20.0);
    EXPECT_GT(peak_N, 1.5 * liver_N) << arm;
    EXPECT_GT(liver_N, 1.5 * fat_N) << arm;
    RecordProperty("capsule_N_" + std::to_string(arm), std::to_string(peak_N));
    RecordProperty("liver_N_" + std::to_string(arm), std::to_string(liver_N));
  }
}

}  // namespace
}  // namespace trephine
