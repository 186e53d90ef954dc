#include "machine/ticks/law_costs.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "base/codes.h"
#include "base/tr.h"
#include "exercise/codes.h"
#include "haptics/haptic_core.h"
#include "machine/common/quantile.h"

namespace trephine {

namespace {

constexpr int kEdge = 96;  // voxels
constexpr double kVoxel_mm = 0.5;
constexpr int kRounds = 9;
constexpr int kTicks = 2500;     // of a variant in a round
constexpr int kApproach = 1000;  // ticks from the air into the tissue
constexpr double kAbove_mm = 8.0, kWithin_mm = -1.0;

// Half a box of this tissue.
Volume halfFull(std::int16_t hu) {
  Volume volume;
  volume.geometry.size = {kEdge, kEdge, kEdge};
  volume.geometry.spacing_mm = Vec3(kVoxel_mm);
  volume.geometry.origin_mm = Vec3(-0.5 * kVoxel_mm * (kEdge - 1));
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  std::fill_n(volume.hu.begin(), volume.hu.size() / 2, hu);
  return volume;
}

// Of any voxel, so that no label map is needed, and uncut: the cost is of touch.
HapticParameters costParameters(const Exercise& exercise, const Tissue& firmest) {
  HapticParameters parameters = hapticParameters(exercise);
  Tissue alone = firmest;
  alone.label.reset();
  alone.structure.clear();
  alone.shell.reset();
  alone.cuttable = false;
  parameters.tissues = tissueTable({"", {alone}});
  if (parameters.touch_by_points != 0) parameters.touch_by_points = 1;
  parameters.arms.resize(1);
  parameters.arms[0].map = WorkspaceMap{};
  parameters.arms[0].other_tools.clear();
  parameters.journal_voxels = 1000;
  return parameters;
}

// One of what is compared: a core of its own that goes on where it was.
class Variant {
 public:
  Variant(const HapticParameters& parameters, std::int16_t hu)
      : grid_(halfFull(hu)), core_(parameters, *grid_.takeWriter()) {
    // Out of the air, or the tool would wait to be drawn out of what it starts in.
    for (int n = 0; n < kApproach; ++n) step(kAbove_mm + (kWithin_mm - kAbove_mm) * n / kApproach);
  }

  // Mean ns of a tick. 10 mm to and fro along the surface, 1 mm within it.
  double run() {
    const auto begin = std::chrono::steady_clock::now();
    for (int n = 0; n < kTicks; ++n) step(kWithin_mm);
    const auto took = std::chrono::steady_clock::now() - begin;
    return std::chrono::duration<double, std::nano>(took).count() / kTicks;
  }
  bool touches() const { return record_.arms[0].tissue_class >= 0; }
  bool waits() const { return record_.arms[0].tool_state & kToolWaits; }

 private:
  void step(double height_mm) {
    input_.tick = std::uint64_t(tick_);
    input_.arms[0].position_m =
        1e-3 * Vec3(5.0 * std::sin(2e-3 * tick_), 3.0 * std::cos(1.3e-3 * tick_), height_mm);
    core_.tick(input_, nullptr, 0, record_);
    ++tick_;
  }

  Grid grid_;
  HapticCore core_;
  TickInput input_;
  TickRecord record_;
  int tick_ = 0;
};

}  // namespace

Result<LawCosts> measureLawCosts(const Exercise& exercise, const Progress& progress) {
  if (exercise.arms.empty() || exercise.tissues.tissues.empty() ||
      !exercise.findTool(exercise.arms[0].tool)) {
    return Error{code::kBadScene,
                 tr("The exercise has no arm, no tool or no tissue to measure with"), "",
                 tr("Give it one of each")};
  }
  const Tissue& firmest = *std::ranges::max_element(
      exercise.tissues.tissues, {},
      [](const Tissue& tissue) { return tissue.stiffness_N_per_m.value; });
  const auto hu = std::int16_t(std::clamp((firmest.hu_min + firmest.hu_max) / 2, -999, 3000));
  const HapticParameters own = costParameters(exercise, firmest);
  std::vector<HapticParameters> wanted{own};
  for (const auto& [name, law] : kLawNames) {
    HapticParameters toggled = own;
    if (std::erase(toggled.laws, law) == 0) toggled.laws.push_back(law);
    wanted.push_back(toggled);
  }
  for (const auto& [name, kind] : kControllerNames) {
    HapticParameters other = own;
    other.controller = kind;
    wanted.push_back(other);
  }
  std::vector<std::unique_ptr<Variant>> variants;
  for (const HapticParameters& parameters : wanted) {
    variants.push_back(std::make_unique<Variant>(parameters, hu));
    (void)variants.back()->run();  // to warm it
    if (progress.cancelled()) return Error{code::kCancelled, tr("It was cancelled"), "", ""};
  }
  std::vector<std::vector<double>> ns(variants.size());
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t v = 0; v < variants.size(); ++v) {
      ns[v].push_back(variants[v]->run());
      if (progress.cancelled()) return Error{code::kCancelled, tr("It was cancelled"), "", ""};
    }
    progress.at(double(round + 1) / kRounds, tr("Measuring the laws"));
  }
  const auto quantileOf = [](std::vector<double> values, int thousandths) {
    std::ranges::sort(values);
    return quantile(values, thousandths);
  };
  LawCosts costs;
  costs.touched = std::ranges::all_of(
      variants, [](const auto& variant) { return variant->touches() && !variant->waits(); });
  costs.tick_ns = quantileOf(ns[0], 500);
  std::size_t v = 1;
  for (const auto& [name, law] : kLawNames) {
    // Round by round: what slows the machine slows both.
    std::vector<double> more_ns;
    const double sign = names(exercise.laws, law) ? -1.0 : 1.0;
    for (int round = 0; round < kRounds; ++round) {
      more_ns.push_back(sign * (ns[v][std::size_t(round)] - ns[0][std::size_t(round)]));
    }
    ++v;
    costs.law_ns.emplace_back(law, quantileOf(more_ns, 500));
    costs.noise_ns =
        std::max(costs.noise_ns, 0.5 * (quantileOf(more_ns, 750) - quantileOf(more_ns, 250)));
  }
  for (const auto& [name, kind] : kControllerNames) {
    costs.controller_ns.emplace_back(kind, quantileOf(ns[v++], 500));
  }
  return costs;
}

}  // namespace trephine
