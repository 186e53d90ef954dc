#include "session/tissue_poke.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/codes.h"
#include "base/tr.h"
#include "device/trephine_device.h"
#include "haptics/haptic_core.h"
#include "haptics/soft_pull.h"
#include "volume/grid.h"

namespace trephine {

namespace {

constexpr std::int16_t kHu = 100;                                    // of the block
constexpr double kWide_mm = 24.0, kAbove_mm = 3.0, kBelow_mm = 8.0;  // beside the tool's radius
constexpr double kMostRate_hz = 2000.0;  // the tissue's curve is the same; it takes longer
constexpr double kLasts_mm = 0.2;        // a shorter force is a click that nobody names
constexpr double kShifted_mm = 1.0;
constexpr int kShifts = 10;  // each way

// Wide and deep enough for a tool of this radius.
Grid block(double radius_mm) {
  Volume volume;
  GridGeometry& g = volume.geometry;
  const double spacing_mm = std::max(0.5, 0.1 * radius_mm), wide_mm = kWide_mm + 4.0 * radius_mm;
  const auto count = [=](double mm) { return int(std::ceil(mm / spacing_mm)); };
  const int deep = count(kPokeDepth_mm + kBelow_mm + radius_mm);
  g.size = {count(wide_mm), count(wide_mm), deep + count(kAbove_mm + 2.0 * radius_mm)};
  g.spacing_mm = Vec3(spacing_mm);
  // The face of the topmost voxels of tissue lies on z = 0.
  g.origin_mm = {-0.5 * wide_mm, -0.5 * wide_mm, -(deep - 0.5) * spacing_mm};
  volume.hu.assign(g.voxelCount(), kAirHu);
  std::fill_n(volume.hu.begin(),
              std::size_t(g.size[0]) * std::size_t(g.size[1]) * std::size_t(deep), kHu);
  return Grid(std::move(volume));
}

// The exercise with this tissue alone, wherever its HU lie.
Exercise withOne(const Exercise& exercise, std::size_t tissue) {
  Exercise one = exercise;
  Tissue& only = one.tissues.tissues.front() = exercise.tissues.tissues[tissue];
  one.tissues.tissues.resize(1);
  only.hu_min = only.hu_max = kHu;
  only.label.reset();
  only.structure.clear();
  only.within.clear();
  only.shell.reset();
  return one;
}

WorkspaceMap scalesOf(const ExerciseArm& arm) {
  WorkspaceMap map;
  map.motion_scale = arm.map.fixed ? arm.map.fixed->motion_scale : arm.map.motion_scale;
  map.force_scale = arm.map.fixed ? arm.map.fixed->force_scale : arm.map.force_scale;
  return map;
}

bool names(const Exercise& exercise, LawKind law) {
  return std::ranges::count(exercise.laws, law) > 0;
}

struct Ends {
  double low = 0.0, high = 0.0;
  bool published = false;
  Confidence confidence = Confidence::unstated;
};
Ends endsOf(const std::optional<SourcedNumber>& number) {
  if (!number) return {};
  if (!number->range) return {number->value, number->value};
  return {number->range->low, number->range->high, true, number->confidence()};
}

}  // namespace

PokeCurve pokeOf(const Exercise& exercise, const Rig& rig, std::size_t arm, std::size_t tissue) {
  PokeCurve curve;
  curve.arm = arm;
  curve.tissue = std::int32_t(tissue);
  curve.ended = true;
  const std::string& id = exercise.tissues.tissues[tissue].id;
  const auto& pushing = exercise.touch_by_points;
  if (!pushing.empty() && !std::ranges::count(pushing, id)) return curve;  // it meets nothing
  Exercise one = withOne(exercise, tissue);
  if (!pushing.empty()) one.touch_by_points = {id};
  one.rate_hz = std::min(one.rate_hz, kMostRate_hz);
  HapticParameters parameters = hapticParameters(one, rig);
  ArmParameters own = parameters.arms[arm];
  own.map = scalesOf(exercise.arms[arm]);
  parameters.arms.assign(1, own);
  parameters.journal_voxels = 1u << 16;
  parameters.journal_strokes = 16;
  parameters.journal_seconds = 16;
  const double radius_mm = 1000.0 * own.tool.radius_m;
  Grid grid = block(radius_mm);
  HapticCore core(parameters, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  const double step_mm = kPokeSpeed_mm_s * parameters.period_s;
  for (double z_mm = kAbove_mm + 2.0 * radius_mm; z_mm > -kPokeDepth_mm;
       z_mm -= step_mm, ++input.tick) {
    input.journal = core.journalState();
    input.arms[0] = {Vec3(0.0, 0.0, 1e-3 * z_mm / own.map.motion_scale), Quat(1, 0, 0, 0), 0,
                     TREPHINE_ARM_CALIBRATED};
    core.tick(input, nullptr, 0, record);
    const ArmRecord& now = record.arms[0];
    const double sent_N = glm::length(now.sent_N);
    if (z_mm > 0.0) continue;
    curve.points.push_back({-z_mm, glm::length(now.demanded_N), sent_N});
    curve.most_N = std::max(curve.most_N, sent_N);
  }
  return curve;
}

std::vector<PublishedBand> publishedBands(const Exercise& exercise, std::size_t arm,
                                          std::size_t tissue) {
  const Tissue& t = exercise.tissues.tissues[tissue];
  const Tool& tool = exercise.findTool(exercise.arms[arm].tool)->tool;
  const double width_mm = 2000.0 * tool.radius_m;
  const double at_arm = scalesOf(exercise.arms[arm]).force_scale;
  std::vector<PublishedBand> bands;
  const bool membrane = names(exercise, LawKind::membrane);
  if (t.rupture_N && t.rupture_N->range && (membrane || names(exercise, LawKind::rupture))) {
    const auto felt_N = [&](double rupture_N) {
      TissueClass at;
      at.rupture_N = rupture_N;
      return at_arm * (membrane ? ruptureForce_N(at, width_mm) : rupture_N);
    };
    const double low = felt_N(t.rupture_N->range->low), high = felt_N(t.rupture_N->range->high);
    const double to_mm = !t.rupture_mm         ? kPokeDepth_mm
                         : t.rupture_mm->range ? t.rupture_mm->range->high
                                               : t.rupture_mm->value;
    bands.push_back({PublishedBand::Of::rupture, 0.0, std::min(to_mm, kPokeDepth_mm), low, high,
                     low, high, t.rupture_N->confidence()});
  }
  Ends cutting, shaft;
  if (names(exercise, LawKind::cutting)) cutting = endsOf(t.toughness_J_per_m2);
  if (names(exercise, LawKind::friction)) shaft = endsOf(t.shaft_N_per_mm);
  if (!cutting.published && !shaft.published) return bands;
  const double width_m = 1e-3 * width_mm;
  bands.push_back({PublishedBand::Of::passing, 0.0, kPokeDepth_mm, at_arm * cutting.low * width_m,
                   at_arm * cutting.high * width_m,
                   at_arm * (cutting.low * width_m + shaft.low * kPokeDepth_mm),
                   at_arm * (cutting.high * width_m + shaft.high * kPokeDepth_mm),
                   std::max(cutting.confidence, shaft.confidence)});
  return bands;
}

Result<std::vector<ArmPokes>> pokesOf(const Exercise& exercise, const Rig& rig,
                                      const Progress& progress) {
  std::vector<ArmPokes> pokes;
  const std::size_t tissues = exercise.tissues.tissues.size();
  const double all = double(exercise.arms.size() * tissues);
  for (std::size_t arm = 0; arm < exercise.arms.size(); ++arm) {
    ArmPokes of{arm, 0.0, {}};
    if (arm < rig.arms.size() && rig.arms[arm].dynamics) {
      of.friction_N = rig.arms[arm].dynamics->friction_N;
    }
    for (std::size_t tissue = 0; tissue < tissues; ++tissue) {
      if (progress.cancelled()) {
        return Error{code::kCancelled, tr("The pokes were cancelled"), "", ""};
      }
      progress.at(double(arm * tissues + tissue) / all, tr("Pushing into each tissue"));
      of.curves.push_back(pokeOf(exercise, rig, arm, tissue));
    }
    pokes.push_back(std::move(of));
  }
  return pokes;
}

namespace {
// How much of the way [mm] `holds` is true, of points that lie evenly.
template <class Holds>
double lengthWhere_mm(std::size_t points, Holds holds) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < points; ++i) count += holds(i);
  return points == 0 ? 0.0 : kPokeDepth_mm * double(count) / double(points);
}
}  // namespace

bool isFeltThrough(const PokeCurve& curve, double friction_N) {
  return friction_N <= 0.0 || lengthWhere_mm(curve.points.size(), [&](std::size_t i) {
                                return curve.points[i].sent_N > friction_N;
                              }) > kLasts_mm;
}

bool areToldApart(const PokeCurve& one, const PokeCurve& other, double friction_N) {
  if (friction_N <= 0.0) return true;
  const std::size_t points = std::min(one.points.size(), other.points.size());
  if (points == 0) return false;
  const auto most = std::ptrdiff_t(kShifted_mm / kPokeDepth_mm * double(points));
  const std::ptrdiff_t step = std::max<std::ptrdiff_t>(1, most / kShifts);
  for (std::ptrdiff_t shift = -most; shift <= most; shift += step) {
    const double apart_mm = lengthWhere_mm(points, [&](std::size_t i) {
      const std::ptrdiff_t at = std::ptrdiff_t(i) + shift;
      if (at < 0 || at >= std::ptrdiff_t(points)) return false;
      const double apart_N = one.points[i].sent_N - other.points[std::size_t(at)].sent_N;
      return std::abs(apart_N) > friction_N;
    });
    if (apart_mm <= kLasts_mm) return false;
  }
  return true;
}

std::vector<std::size_t> notToldApart(const ArmPokes& pokes, std::size_t tissue) {
  std::vector<std::size_t> like;
  const PokeCurve& own = pokes.curves[tissue];
  if (!isFeltThrough(own, pokes.friction_N)) return like;
  for (std::size_t other = 0; other < pokes.curves.size(); ++other) {
    const PokeCurve& that = pokes.curves[other];
    if (other != tissue && isFeltThrough(that, pokes.friction_N) &&
        !areToldApart(own, that, pokes.friction_N)) {
      like.push_back(other);
    }
  }
  return like;
}

std::vector<std::string> hiddenWords(const Exercise& exercise, const ArmPokes& pokes,
                                     std::size_t tissue) {
  std::vector<std::string> lines;
  const auto fixed = [](double newtons) { return plainNumber(0.01 * std::round(100.0 * newtons)); };
  const std::string& arm = exercise.arms[pokes.arm].name;
  const auto nameOf = [&](std::size_t t) {
    const Tissue& of = exercise.tissues.tissues[t];
    const bool blank = of.name.find_first_not_of(' ') == std::string::npos;
    return blank ? of.id : of.name;
  };
  const PokeCurve& own = pokes.curves[tissue];
  if (!isFeltThrough(own, pokes.friction_N)) {
    lines.push_back(
        tr("{}: at most {} N in a poke at the {} arm, which is lost in that arm's own friction, "
           "stated as {} N",
           nameOf(tissue), fixed(own.most_N), arm, fixed(pokes.friction_N)));
    return lines;
  }
  for (std::size_t other : notToldApart(pokes, tissue)) {
    lines.push_back(
        tr("{} and {} are hard to tell apart at the {} arm: in a poke they differ by less than "
           "that arm's own friction, stated as {} N",
           nameOf(tissue), nameOf(other), arm, fixed(pokes.friction_N)));
  }
  return lines;
}

}  // namespace trephine
