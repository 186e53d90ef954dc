#include "lab/touch/tissue_bench.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/codes.h"
#include "haptics/haptic_loop.h"
#include "lab/common/scripted_arm.h"

namespace trephine {

namespace {

constexpr int kFirstHu = 100;  // of the first layer's tissue; the next has the next
constexpr std::int16_t kAbove = -1000;
constexpr double kAboveMm = 4.0;  // of air in the grid
constexpr double kLeastDeep_mm = 12.0;

Volume layeredVolume(const TissueStroke& stroke) {
  double thick_mm = 0.0;
  for (const TissueLayer& layer : stroke.layers) thick_mm += layer.thick_mm;
  const double s = stroke.spacing_mm;
  const double deep_mm = std::max(kLeastDeep_mm, stroke.wide_mm / 3.0);
  Volume volume;
  GridGeometry& g = volume.geometry;
  g.size = {int(std::ceil(stroke.wide_mm / s)), int(std::ceil(deep_mm / s)),
            int(std::ceil((thick_mm + 2.0 * kAboveMm) / s))};
  g.spacing_mm = Vec3(s);
  // Voxel (., ., k) has its centre at origin + k s; a face lies on z = 0.
  const int above = int(std::ceil(kAboveMm / s));
  g.origin_mm = {-0.5 * stroke.wide_mm, -0.5 * deep_mm, -(g.size[2] - above - 0.5) * s};
  volume.hu.assign(g.voxelCount(), kAbove);
  for (int k = 0; k < g.size[2]; ++k) {
    double depth_mm = -(g.origin_mm.z + k * s);
    int at = -1;
    for (std::size_t n = 0; depth_mm > 0.0 && n < stroke.layers.size(); ++n) {
      if (depth_mm < stroke.layers[n].thick_mm) {
        at = int(n);
        break;
      }
      depth_mm -= stroke.layers[n].thick_mm;
    }
    if (at < 0) continue;
    const std::size_t first = g.indexOf(0, 0, k);
    const std::size_t count = std::size_t(g.size[0]) * std::size_t(g.size[1]);
    std::fill_n(volume.hu.begin() + std::ptrdiff_t(first), count, std::int16_t(kFirstHu + at));
  }
  return volume;
}

// Moved by its hand and by the force that is held for a period.
struct HeldMass {
  Vec3 at_m{0.0}, speed_m_s{0.0};

  void move(const TissueHand& hand, const Vec3& wanted_m, const Vec3& force_N, double period_s) {
    constexpr int kParts = 20;
    const double dt = period_s / kParts;
    for (int n = 0; n < kParts; ++n) {
      Vec3 pull_N = hand.stiffness_N_per_m * (wanted_m - at_m) - hand.damping_Ns_per_m * speed_m_s;
      if (hand.push_N > 0.0) pull_N.z = -hand.push_N - hand.damping_Ns_per_m * speed_m_s.z;
      speed_m_s += (dt / hand.mass_kg) * (pull_N + force_N);
      at_m += dt * speed_m_s;
    }
  }
};

TissueTable tableOf(const TissueStroke& stroke) {
  TissueSet set;
  for (std::size_t n = 0; n < stroke.layers.size(); ++n) {
    Tissue tissue = stroke.layers[n].tissue;
    tissue.id += std::to_string(n);
    tissue.hu_min = tissue.hu_max = kFirstHu + int(n);
    tissue.label.reset();
    tissue.structure.clear();
    tissue.shell.reset();
    set.tissues.push_back(std::move(tissue));
  }
  return tissueTable(set);
}

std::function<Vec3(double)> wayThrough(std::vector<Vec3> places_mm, double mm_per_s) {
  return [places = std::move(places_mm), mm_per_s](double t_s) {
    double left_mm = std::max(0.0, t_s) * mm_per_s;
    for (std::size_t n = 0; n + 1 < places.size(); ++n) {
      const Vec3 step = places[n + 1] - places[n];
      const double length = glm::length(step);
      if (left_mm < length) return places[n] + (left_mm / length) * step;
      left_mm -= length;
    }
    return places.back();
  };
}

double secondsThrough(const std::vector<Vec3>& places_mm, double mm_per_s) {
  double length_mm = 0.0;
  for (std::size_t n = 0; n + 1 < places_mm.size(); ++n) {
    length_mm += glm::length(places_mm[n + 1] - places_mm[n]);
  }
  return length_mm / mm_per_s;
}

}  // namespace

void goThrough(TissueStroke& stroke, const std::vector<Vec3>& places_mm, double mm_per_s) {
  stroke.way = wayThrough(places_mm, mm_per_s);
  stroke.seconds = secondsThrough(places_mm, mm_per_s);
}

TissueStroke softStroke(std::vector<TissueLayer> layers, const Tool& tool,
                        const std::vector<Vec3>& places_mm, double mm_per_s) {
  TissueStroke stroke;
  stroke.layers = std::move(layers);
  stroke.tool = tool;
  stroke.laws = {LawKind::viscous, LawKind::friction, LawKind::elastic, LawKind::membrane,
                 LawKind::cutting};
  stroke.wide_mm = 16.0;
  stroke.peak_force_N = 20.0;
  goThrough(stroke, places_mm, mm_per_s);
  return stroke;
}

Tool needleOf(double width_mm, int points) {
  return *makeTool({ToolKind::needle, 60.0, points, 0.5 * width_mm});
}

double firstTouch_mm(const std::vector<TissueSample>& samples) {
  for (const TissueSample& s : samples) {
    if (s.demanded_N.z > 0.0) return s.arm_mm.z;
  }
  return 0.0;
}

Result<TissueTrace> runStroke(const TissueStroke& stroke) {
  if (stroke.layers.empty() || !stroke.way || !(stroke.seconds > 0.0) || !(stroke.rate_hz > 0.0)) {
    return Error{code::kBadArgument, "A stroke needs tissue, a way and a time", "the stroke", ""};
  }
  const auto ticks = int(std::ceil(stroke.seconds * stroke.rate_hz));
  TrephineCapabilities capabilities = omniCapabilities();
  capabilities.peak_force_N = stroke.peak_force_N;
  capabilities.continuous_force_N = stroke.peak_force_N;
  capabilities.encoder_step_m = 0.0;
  capabilities.rate_hz = stroke.rate_hz;
  HeldMass mass;
  mass.at_m = 0.001 * stroke.way(0.0);
  const ScriptedArm* given = nullptr;
  ScriptedArm arm(
      [&](int tick) {
        ScriptedArm::Sample sample;
        const Vec3 way_m = 0.001 * stroke.way(tick / stroke.rate_hz);
        if (!stroke.hand) {
          sample.position_m = way_m;
          return sample;
        }
        const Vec3 force_N = tick > 0 ? given->commanded_N().back() : Vec3(0.0);
        mass.move(*stroke.hand, way_m, force_N, 1.0 / stroke.rate_hz);
        sample.position_m = mass.at_m;
        return sample;
      },
      capabilities, std::size_t(ticks));
  given = &arm;
  Result<std::unique_ptr<Device>> device = arm.open();
  if (!device) return device.error();

  HapticParameters p;
  p.period_s = 1.0 / stroke.rate_hz;
  ArmDynamics dynamics;
  dynamics.peak_force_N = dynamics.continuous_force_N = stroke.peak_force_N;
  WorkspaceMap map;
  map.force_scale = stroke.force_scale;
  p.arms.push_back({stroke.tool, map, stroke.peak_force_N, dynamics});
  p.laws = stroke.laws;
  p.force_at = ForceAt::distributed;
  p.removal = stroke.removal;
  p.controller = stroke.controller;
  p.tissues = tableOf(stroke);
  p.journal_voxels = 1u << 20;
  p.journal_strokes = 64;

  Grid grid(layeredVolume(stroke));
  HapticCore core(p, *grid.takeWriter());
  std::vector<LoopDevice> devices;
  devices.push_back({*std::move(device), {0}});
  HapticLoop loop(core, std::move(devices), nullptr);
  if (Status started = loop.startDevices(); !started) return started.error();
  TissueTrace trace;
  trace.samples.reserve(std::size_t(ticks));
  for (int tick = 0; tick < ticks; ++tick) {
    loop.step(0);
    for (TickRecord record; loop.records().pop(record);) {
      const ArmRecord& r = record.arms[0];
      trace.samples.push_back({double(record.tick) / stroke.rate_hz, r.patient_position_mm,
                               r.proxy_position_mm, r.demanded_N / stroke.force_scale, r.sent_N,
                               r.removed_voxels});
    }
    for (CarveRecord carve; loop.carves().pop(carve);) trace.carves.push_back(carve);
    for (Event event; loop.events().pop(event);) {
    }
  }
  loop.stopDevices();
  trace.removed_mm3 = double(trace.carves.size()) * grid.geometry().voxelVolume_mm3();
  return trace;
}

}  // namespace trephine
