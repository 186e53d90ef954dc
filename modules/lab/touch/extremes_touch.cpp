#include "lab/touch/extremes_touch.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/codes.h"
#include "base/formatted.h"
#include "case/case.h"
#include "lab/touch/placed_exercise.h"
#include "lab/touch/rest_measurement.h"
#include "machine/common/on_all_processors.h"
#include "volume/phantom_file.h"

namespace trephine {

namespace {

constexpr int kBoneFrom_hu = 226;
constexpr ArmDynamics kOmni{0.045, 0.055e-3, 3.3, 0};
constexpr double kAccepted = 1.5;  // of what the push allows

// A hand that swings out at half the critical damping of the arm in it.
Impedance handOf(double stiffness) {
  return {std::sqrt(stiffness * kOmni.apparent_mass_kg), stiffness};
}

Quat turned(const Vec3& axis, double angle) {
  return Quat(std::cos(0.5 * angle), std::sin(0.5 * angle) * axis);
}

Vec3 across(const Vec3& n) {
  return glm::normalize(glm::cross(n, std::abs(n.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
}

// The tool points along -z of its own frame.
Quat pointing(const Vec3& along) {
  const Vec3 z = -along, x = across(z);
  return glm::normalize(glm::quat_cast(Mat3(x, glm::cross(z, x), z)));
}

HapticParameters touching(const Tool& tool, const TissueTable& tissues) {
  HapticParameters p;
  p.laws = {LawKind::viscous, LawKind::coulomb, LawKind::elastic};
  p.force_at = ForceAt::distributed;
  p.tissues = tissues;
  p.arms = {{tool, WorkspaceMap{}, kOmni.peak_force_N, kOmni}};
  p.journal_voxels = 1 << 16;
  return p;
}

// Distance from a voxel's centre to where HU crosses `hu_from` towards its six neighbours.
double toSurface_mm(const Grid& grid, int i, int j, int k, int hu_from) {
  const Vec3& spacing_mm = grid.geometry().spacing_mm;
  const double hu = grid.hu(i, j, k);
  double nearest_mm = std::max({spacing_mm.x, spacing_mm.y, spacing_mm.z});
  const int offsets[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int n = 0; n < 6; ++n) {
    const double beside = grid.hu(i + offsets[n][0], j + offsets[n][1], k + offsets[n][2]);
    if (beside >= hu_from) continue;
    nearest_mm = std::min(nearest_mm, (hu - hu_from) / (hu - beside) * spacing_mm[n / 2]);
  }
  return nearest_mm;
}

}  // namespace

TissueTable boneOnly(bool cuttable) {
  TissueTable table;
  table.count = 1;
  table.classes[0] = {{12.0, 900.0, 2.0, 0.0, 0.06}, kBoneFrom_hu, 3071, cuttable, 0, 1, 0};
  return table;
}

double insideSolid_mm(const Tool& tool, const Pose& pose_mm, const Grid& grid, int hu_from) {
  const GridGeometry& g = grid.geometry();
  const Mat4 to_voxel = g.patientToVoxel();
  double inside_mm = 0.0;
  for (const BodyPart& part : tool.body) {
    const auto at = [&](const Vec3& m) {
      return Vec3(to_voxel *
                  glm::dvec4(pose_mm.position + pose_mm.orientation * (1000.0 * m), 1.0));
    };
    const double r_mm = 1000.0 * part.radius_m;
    const Vec3 a = at(part.from_m), b = at(part.to_m), r = r_mm / g.spacing_mm;
    const Vec3 low = glm::ceil(glm::min(a, b) - r), high = glm::floor(glm::max(a, b) + r);
    const Vec3 a_mm = a * g.spacing_mm, axis_mm = b * g.spacing_mm - a_mm;
    const double length2 = glm::dot(axis_mm, axis_mm);
    for (int k = std::max(0, int(low.z)); k <= std::min(g.size[2] - 1, int(high.z)); ++k) {
      for (int j = std::max(0, int(low.y)); j <= std::min(g.size[1] - 1, int(high.y)); ++j) {
        for (int i = std::max(0, int(low.x)); i <= std::min(g.size[0] - 1, int(high.x)); ++i) {
          if (grid.hu(i, j, k) < hu_from) continue;
          const Vec3 from_mm = Vec3(i, j, k) * g.spacing_mm - a_mm;
          const double along =
              length2 > 0.0 ? std::clamp(glm::dot(from_mm, axis_mm) / length2, 0.0, 1.0) : 0.0;
          const double depth_mm = r_mm - glm::length(from_mm - along * axis_mm);
          if (depth_mm <= 0.0) continue;
          inside_mm = std::max(inside_mm, depth_mm + toSurface_mm(grid, i, j, k, hu_from));
        }
      }
    }
  }
  return inside_mm;
}

PressResult pressInto(const Tool& tool, const TissueTable& tissues, const Volume& volume,
                      const Press& press, double seconds) {
  constexpr double kT = 1e-3, kAway_mm = 12.0, kPress_s = 1.5, kMoves_s = 3.0;
  constexpr double kTurn_rad = 0.35, kDrag_mm = 5.0, kSlow_Hz = 0.25, kSlack_mm = 0.5,
                   kLook_mm = 0.25, kSlips_m_s = 0.06, kCaught_s = 0.1;
  TouchRig rig(touching(tool, tissues), volume, {rigArmOf(kOmni, handOf(press.hand_N_per_m))});
  const Vec3 aside = across(press.push);
  const Quat upright = turned(aside, press.tilt_rad) * pointing(press.push);
  Vec3 start_mm = press.surface_mm - kAway_mm * press.push;
  // Further out where the tool's own length lies in bone there.
  for (int i = 0;
       i < 40 && insideSolid_mm(tool, {start_mm, upright}, rig.grid(), kBoneFrom_hu) > 0.0; ++i) {
    start_mm -= 5.0 * press.push;
  }
  const double stiffness = std::min(tissues.classes[0].stiffness_N_per_m,
                                    renderable(kOmni, 1.0 / kT, delaySamples(kOmni, kT), {}).k_max);
  const double sink_mm = 1000.0 * press.force_N * (1.0 / press.hand_N_per_m + 1.0 / stiffness);
  const Vec3 held_mm = press.surface_mm + sink_mm * press.push;
  rig.place(0, 0.001 * start_mm);
  rig.turnHand(0, upright);
  PressResult result;
  Vec3 looked_mm = start_mm;
  double slipped_s = 0.0;
  const int ticks = int(seconds / kT + 0.5);
  for (int n = 0; n < ticks; ++n) {
    const double t = (n + 1) * kT;
    Vec3 rest_mm = start_mm + std::min(1.0, t / kPress_s) * (held_mm - start_mm);
    if (press.moves && t > kMoves_s) {
      const double wave = std::sin(6.283185307179586 * kSlow_Hz * (t - kMoves_s));
      rest_mm += kDrag_mm * wave * aside;
      rig.turnHand(0, turned(glm::cross(aside, press.push), kTurn_rad * wave) * upright);
    }
    rig.moveHand(0, 0.001 * rest_mm);
    const ArmRecord& arm = rig.step().arms[0];
    result.held = result.held || (arm.tool_state & kToolHeld);
    // So often that no bone is passed between two looks.
    if (n % 10 == 0 || glm::length(arm.proxy_position_mm - looked_mm) > kLook_mm) {
      looked_mm = arm.proxy_position_mm;
      const Pose proxy{arm.proxy_position_mm, arm.proxy_orientation};
      result.inside_mm =
          std::max(result.inside_mm, insideSolid_mm(tool, proxy, rig.grid(), kBoneFrom_hu));
    }
    const double push_N = press.hand_N_per_m * glm::length(0.001 * rest_mm - rig.position_m(0));
    // While it slips, and as it is caught, its own mass pushes as well.
    if (glm::length(arm.velocity_m_s) > kSlips_m_s) slipped_s = t;
    if (t < 0.5 * seconds || t - slipped_s < kCaught_s || !(arm.tool_state & kToolHeld)) continue;
    if (push_N > kOmni.peak_force_N) continue;
    const double beyond_mm = glm::length(arm.proxy_position_mm - arm.patient_position_mm);
    const double allowed_mm = 1000.0 * push_N / stiffness + kSlack_mm;
    if (beyond_mm / allowed_mm <= result.beyond_share) continue;
    result.beyond_share = beyond_mm / allowed_mm;
    result.beyond_mm = beyond_mm;
    result.push_N = push_N;
    result.learnt = arm.learnt_scale;
  }
  return result;
}

namespace {

struct Target {
  std::string name;
  Volume volume;
};

// Into the middle from each of six sides: where bone begins there; and where it does beside the
// middle, near an edge of what there is.
std::vector<std::pair<Vec3, Vec3>> surfacesOf(const Volume& volume, bool edge) {
  std::vector<std::pair<Vec3, Vec3>> found;
  const GridGeometry& g = volume.geometry;
  const Vec3 size_mm = Vec3(g.size[0], g.size[1], g.size[2]) * g.spacing_mm;
  const double reach_mm = glm::length(size_mm);
  for (int side = 0; side < 6; ++side) {
    Vec3 push(0.0);
    push[side / 2] = side % 2 ? -1.0 : 1.0;
    const Vec3 aside = across(push);
    const auto surface = [&](double aside_mm) -> std::optional<Vec3> {
      const Vec3 from_mm = g.centre_mm() + aside_mm * aside - 0.6 * reach_mm * push;
      const auto depth_mm = depthOf(volume, boneOnly(false), 0, from_mm, push, 1.2 * reach_mm);
      if (!depth_mm) return {};
      return from_mm + *depth_mm * push;
    };
    std::optional<Vec3> at = surface(0.0);
    if (edge) {
      double out_mm = 0.0;  // the last way aside at which there is bone
      for (double mm = 0.0; mm < reach_mm && surface(mm); mm += 0.5) out_mm = mm;
      at = surface(out_mm);
    }
    if (at) found.push_back({*at, push});
  }
  return found;
}

struct Dive {
  std::size_t row = 0;
  const Volume* volume = nullptr;
  const Tool* tool = nullptr;
  bool cuttable = false;
  Press press;
  PressResult result;
};

void addDives(std::size_t row, const Volume& volume, const Tool& tool, bool cuttable,
              std::vector<Dive>& dives) {
  constexpr double kTilt_rad = 1.2;
  const auto faces = surfacesOf(volume, false), edges = surfacesOf(volume, true);
  int turn = 0;
  for (double force_N : {0.5, 2.0, 3.3}) {
    for (double hand : {5.0, 50.0, 300.0, 1000.0}) {
      for (std::size_t side = 0; side < faces.size(); ++side, ++turn) {
        // Straight, leaning, over an edge, turned and dragged: each of them from every side.
        const int way = (turn + turn / int(std::max<std::size_t>(1, faces.size()))) % 4;
        const auto& [at_mm, push] = way == 2 && side < edges.size() ? edges[side] : faces[side];
        Press press{at_mm, push, force_N, hand, way == 1 ? kTilt_rad : 0.0, way == 3, way == 2};
        dives.push_back({row, &volume, &tool, cuttable, press, {}});
      }
    }
  }
}

const char* wayOf(const Press& press) {
  if (press.moves) return "turned and dragged";
  return press.tilt_rad > 0.0 ? "leaning" : press.at_edge ? "over an edge" : "straight";
}

ExtremeRow barrierRow(const std::string& tool, const Target& target, const std::vector<Dive>& dives,
                      std::size_t row) {
  PressResult worst;
  const Press* where = nullptr;
  std::size_t runs = 0, over = 0, accepted = 0, not_held = 0;
  double inside_mm = 0.0;
  for (const Dive& dive : dives) {
    if (dive.row != row) continue;
    ++runs;
    over += dive.result.beyond_share > 1.0;
    accepted += dive.result.beyond_share <= kAccepted;
    not_held += !dive.result.held;
    inside_mm = std::max(inside_mm, dive.result.inside_mm);
    if (!where || dive.result.beyond_share > worst.beyond_share) {
      worst = dive.result;
      where = &dive.press;
    }
  }
  const Vec3& spacing_mm = target.volume.geometry.spacing_mm;
  const double half_mm = 0.5 * std::min({spacing_mm.x, spacing_mm.y, spacing_mm.z});
  ExtremeRow out;
  out.name = "barrier: " + tool + ", " + target.name;
  out.input = formatted(
      "%zu times pressed at 0.5, 2 and 3.3 N by hands of 5 to 1000 N/m for 10 s, from "
      "every side, leaning, over edges, turning; cuts nothing",
      runs);
  out.expected = formatted(
      "proxy inside bone by at most %.3g mm; arm beyond it by at most 1.5 times push / "
      "renderable stiffness + 0.5 mm",
      half_mm);
  out.got = formatted(
      "inside by %.3f mm; arm at most %.2f mm beyond, %.2f times what %.2f N allow (%s of "
      "%.1f N by %.0f N/m, learnt scale %.2f), over once that in %zu, over 1.5 times in %zu",
      inside_mm, worst.beyond_mm, worst.beyond_share, worst.push_N, where ? wayOf(*where) : "",
      where ? where->force_N : 0.0, where ? where->hand_N_per_m : 0.0, worst.learnt, over,
      runs - accepted);
  if (not_held > 0) out.got += formatted(", never held in %zu", not_held);
  out.pass = runs > 0 && inside_mm <= half_mm && accepted == runs && not_held < runs;
  return out;
}

// 48 mm of bone in 12 mm of air all around.
Volume bonyBlock() {
  Volume volume;
  volume.geometry.size = {72, 72, 72};
  volume.geometry.origin_mm = Vec3(-35.5);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  for (int k = 12; k < 60; ++k) {
    for (int j = 12; j < 60; ++j) {
      std::fill_n(volume.hu.begin() + std::ptrdiff_t(volume.geometry.indexOf(12, j, k)), 48,
                  std::int16_t(1000));
    }
  }
  return volume;
}

// ---- what does not shake, soften or stay away

ExtremeRow atRest(const PlacedExercise& liver) {
  HapticParameters parameters = withoutMotors(hapticParameters(liver.exercise, liver.rig));
  std::vector<RigArm> arms;
  std::vector<HoldPath> paths;
  const TissueTable tissues = tissueTable(liver.exercise.tissues);
  const Tissue* organ = liver.exercise.tissues.find("liver");
  for (std::size_t i = 0; i < liver.exercise.arms.size(); ++i) {
    const WorkspaceMap map = liver.exercise.arms[i].map.fixed.value_or(WorkspaceMap{});
    arms.push_back(rigArmOf(parameters.arms[i].dynamics, {4.0, 600.0}));
    const Vec3 in = liver.frames[i].rotation * Vec3(0, 0, -1);
    const Vec3 below_ribs = liver.frames[i].rotation * Vec3(0, -42, 0);  // as its script goes
    const Vec3 out_mm = map.centre_mm + below_ribs - 50.0 * in;
    const auto to_mm = depthOf(*liver.volume, tissues,
                               int(organ - liver.exercise.tissues.tissues.data()), out_mm, in, 150.0,
                               liver.labels.get());
    constexpr double kIn_mm = 10.0;
    const Vec3 held_mm = out_mm + (to_mm.value_or(0.0) + kIn_mm) * in;
    paths.push_back({map.toDevice_m(out_mm), map.toDevice_m(held_mm), Vec3(0.0)});
  }
  const std::vector<HoldResult> held = hold(parameters, *liver.volume, arms, paths, HoldKind::rest,
                                            kRest_s, false, liver.labels);
  ExtremeRow row{
      "at rest in the liver", "needle and blade held for 60 s, 10 mm in it",
      "above 2 Hz no more than a count of the encoder, at most 0.2 mJ given out", "", true};
  for (std::size_t i = 0; i < held.size(); ++i) {
    row.pass = row.pass && held[i].touched && !held[i].waited &&
               !faultsOf(HoldKind::rest, held[i], arms[i].encoder_m).any();
    row.got += formatted("%s%s: %.0f um at %.0f Hz, %.3f mJ", i ? "; " : "",
                         liver.exercise.arms[i].tool.c_str(), 1e6 * held[i].cycle_m, held[i].cycle_Hz,
                         1e3 * held[i].energy_out_J);
  }
  return row;
}

// A weight of 3 N on a spring of 5 N/m falls by 1 mm onto bone. How deep the arm is after 8 s.
double fallenDepth_mm(const Tool& burr, ControllerKind controller) {
  HapticParameters p = touching(burr, boneOnly(true));
  p.controller = controller;
  constexpr double kSpring_N_per_m = 5.0, kWeight_N = 3.0, kFall_mm = 1.0, kTop_mm = 24.0;
  TouchRig rig(p, bonyBlock(), {rigArmOf(kOmni, {0.0, kSpring_N_per_m})});
  rig.place(0, Vec3(0.0, 0.0, 0.001 * (kTop_mm + kFall_mm)));
  const Vec3 rest_m(0.0, 0.0, 0.001 * kTop_mm - kWeight_N / kSpring_N_per_m);
  for (int n = 0; n < 8000; ++n) {
    rig.moveHand(0, rest_m);
    rig.step();
  }
  return kTop_mm - 1000.0 * rig.position_m(0).z;
}

ExtremeRow softens(const Tool& burr) {
  const double bounded_mm = fallenDepth_mm(burr, ControllerKind::bounded);
  const double off_mm = fallenDepth_mm(burr, ControllerKind::off);
  const double k = std::min(900.0, renderable(kOmni, 1000.0, 0, {}).k_max);
  const double allowed_mm = 3000.0 / k + 0.5;
  return {"3 N through a spring of 5 N/m", "a burr without its motor falls by 1 mm onto bone, 8 s",
          formatted(
              "under bounded at most %.1f mm deep, 1.5 times push / renderable stiffness + 0.5 mm",
              kAccepted * allowed_mm),
          formatted("%.1f mm under bounded, %.1f mm under off", bounded_mm, off_mm),
          bounded_mm <= kAccepted * allowed_mm && bounded_mm > 0.0};
}

// A burr on bone by a hand of 600 N/m at about 1 N; at 3 s `before`, at 4 s `after`.
ExtremeRow comesBack(const std::string& name, const Tool& burr, ControllerKind first,
                     const std::optional<Command>& before, const Command& after) {
  HapticParameters p = touching(burr, boneOnly(true));
  p.controller = first;
  TouchRig rig(p, bonyBlock(), {rigArmOf(kOmni, {4.0, 600.0})});
  rig.place(0, Vec3(0.0, 0.0, 0.030));
  double step_N = 0.0, share = 0.0, last_N = 0.0, was_up_N = 0.0;
  bool turned_back = false;
  int alternations = 0;
  for (int n = 0; n < 5000; ++n) {
    const double t = 0.001 * (n + 1);
    if (before && n == 3000) rig.command(*before);
    if (n == 4000) rig.command(after);
    rig.moveHand(0, Vec3(0.0, 0.0, 0.030 + std::min(1.0, t) * (0.0212 - 0.030)));
    const ArmRecord& arm = rig.step().arms[0];
    const double sent_N = glm::length(arm.sent_N);
    if (n >= 4000) {
      step_N = std::max(step_N, sent_N - last_N);
      // To and fro and to again, each time by more than 0.02 N.
      const double up_N = sent_N - last_N;
      const bool turns =
          up_N * was_up_N < 0.0 && std::min(std::abs(up_N), std::abs(was_up_N)) > 0.02;
      alternations += turns && turned_back;
      turned_back = turns;
      was_up_N = up_N;
    }
    if (n == 4500) {
      share = glm::dot(arm.sent_N, arm.demanded_N) / glm::dot(arm.demanded_N, arm.demanded_N);
    }
    last_N = sent_N;
  }
  return {
      name, "a burr without its motor pressed onto bone by 600 N/m, about 1 N",
      "0.8 to 1.2 of what is demanded after 0.5 s, at most 0.05 N more in a tick, no alternation",
      formatted("%.2f of what is demanded, at most %.3f N more in a tick, %d alternations", share,
                step_N, alternations),
      share >= 0.8 && share <= 1.2 && step_N <= 0.05 + 1e-9 && alternations == 0};
}

}  // namespace

Result<std::vector<ExtremeRow>> measureTouchExtremes(const std::string& case_source,
                                                     const Progress& progress) {
  // The shipped tools that are pressed, none of which can cut: bone is not cuttable, or, for a
  // burr, the motor is off.
  struct Pressed {
    const char *name, *exercise;
    bool cuttable;
    Tool tool;
  };
  std::vector<Pressed> pressed = {{"needle", "liver", false, {}},
                                  {"blade", "cranium", false, {}},
                                  {"burr", "burr-hole", true, {}}};
  std::optional<PlacedExercise> liver;
  for (Pressed& p : pressed) {
    progress.at(0.0, p.exercise);
    Result<PlacedExercise> placed = placeExercise(p.exercise, "", progress);
    if (!placed) return placed.error();
    p.tool = withoutMotor(placed->exercise.findTool(p.name)->tool);
    if (!liver) liver = *std::move(placed);
  }
  std::vector<Target> targets;
  targets.push_back({"block", bonyBlock()});
  Result<Phantom> phantom = openPhantom("cranium", progress);
  if (!phantom) return phantom.error();
  targets.push_back({"phantom", std::move(phantom->volume)});
  if (!case_source.empty()) {
    const Result<Case> real = readCase(case_source, progress);
    if (!real) return real.error();
    targets.push_back({"real case", *real->volume});
  }

  std::vector<Dive> dives;
  std::vector<std::pair<const Pressed*, const Target*>> rows;
  for (const Target& target : targets) {
    for (const Pressed& p : pressed) {
      addDives(rows.size(), target.volume, p.tool, p.cuttable, dives);
      rows.push_back({&p, &target});
    }
  }
  const bool finished = onAllProcessors(dives.size(), "Barrier", progress, [&](std::size_t i) {
    Dive& dive = dives[i];
    dive.result = pressInto(*dive.tool, boneOnly(dive.cuttable), *dive.volume, dive.press);
  });
  if (!finished)
    return Error{code::kCancelled, "The measurement was cancelled", "measure extremes", ""};

  std::vector<ExtremeRow> out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out.push_back(barrierRow(rows[i].first->name, *rows[i].second, dives, i));
  }
  out.push_back(atRest(*liver));
  const Tool& burr = pressed.back().tool;
  out.push_back(softens(burr));
  const Command pause{CommandKind::pause, 0, {}}, resume{CommandKind::resume, 0, {}};
  const Command to_bounded{CommandKind::controller, std::int32_t(ControllerKind::bounded), {}};
  TissueTable softer = boneOnly(true);
  softer.classes[0].stiffness_N_per_m = 700.0;
  const Command tissue{CommandKind::tissues, 0, &softer};
  out.push_back(comesBack("resume inside bone", burr, ControllerKind::bounded, pause, resume));
  out.push_back(
      comesBack("switch to bounded inside bone", burr, ControllerKind::off, {}, to_bounded));
  out.push_back(comesBack("another tissue inside bone", burr, ControllerKind::bounded, {}, tissue));
  return out;
}

}  // namespace trephine
