// The shipped exercises as they are run: what their recordings say of tools, bone and force.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "base/file.h"
#include "base/system.h"
#include "case/placement.h"
#include "exercise/entry_point.h"
#include "exercise/exercise_structures.h"
#include "haptics/bounded_controller.h"
#include "session/energy_watch.h"
#include "session/run_report.h"
#include "session/session.h"
#include "support.h"
#include "training/session_reader.h"
#include "uncut_bone.h"

namespace trephine {
namespace {

using test::Inside;
using test::lookInside;

constexpr std::array kShipped{"burr-hole", "cranium", "cranium-one-arm", "liver", "liver-one-arm"};
constexpr double kSeconds = 10.0;

// Each case is opened once.
const Case& caseOf(const Exercise& exercise) {
  static std::map<std::string, Case> all;
  const std::string& source = exercise.case_source;
  if (!all.contains(source)) {
    auto read = readCase(source);
    EXPECT_TRUE(read.ok()) << read.error().sentence();
    all[source] = *read;
  }
  return all[source];
}
Placement placed(const Exercise& exercise) {
  return *place(exercise, caseOf(exercise));
}

Exercise shipped(const std::string& name, const std::string& case_source) {
  Exercise exercise = *readExercise(resourceFolder() / "scenes" / (name + ".json"));
  if (!case_source.empty()) exercise = onCase(exercise, case_source);
  return exercise;
}

// An exercise's first ten seconds, with its own script.
struct Recorded {
  Exercise exercise;  // maps fixed
  Volume before;
  std::shared_ptr<const LabelMap> labels;
  RunReport report;
  std::vector<TickRecord> ticks;
  std::vector<CarveRecord> carves;
};

Recorded record(const std::string& name, const std::string& case_source) {
  const test::TemporaryFolder folder;
  Exercise exercise = shipped(name, case_source);
  Recorded out;
  const Placement of = placed(exercise);
  out.before = *of.patient.volume;
  out.labels = of.labels;
  const SessionOptions options{folder / "s.h5", *readOperatorScript(exercise.operator_file, exercise)};
  auto session = Session::create(of, options);
  EXPECT_TRUE(session.ok()) << session.error().sentence();
  EXPECT_TRUE((*session)->freewheel(kSeconds).ok());
  out.exercise = (*session)->exercise();
  out.report = (*session)->report();
  auto reader = SessionReader::open(folder / "s.h5");
  EXPECT_TRUE(reader.ok()) << reader.error().sentence();
  out.ticks = *(*reader)->ticks(0, (*reader)->tickCount());
  out.carves = *(*reader)->carves();
  return out;
}

// What was removed in the skull of the built-in head, by its formula; and brain and dura by the
// HU of their voxels, as they are felt [mm3].
struct InSkull {
  double truly_mm3 = 0.0, felt_mm3 = 0.0;
  explicit InSkull(const Recorded& run) {
    const PhantomTruth truth = *phantomTruth("cranium");
    const GridGeometry& g = run.before.geometry;
    for (const CarveRecord& carve : run.carves) {
      const Index3 v = g.indicesOf(carve.voxel);
      const PhantomTissue is = truth(g.toPatient_mm(Vec3(v[0], v[1], v[2])));
      const std::string felt = run.exercise.tissues.tissues[std::size_t(carve.tissue_class)].id;
      const double mm3 = g.voxelVolume_mm3();
      if (is >= PhantomTissue::dura && is <= PhantomTissue::ventricle) truly_mm3 += mm3;
      if (felt == "brain" || felt == "dura") felt_mm3 += mm3;
    }
  }
};

TEST(ShippedExercises, NameBrainAndDuraInResultsWhereTheyAreAndNowhereElse) {
  for (const char* name : {"burr-hole", "cranium"}) {
    const Recorded run = record(name, "");
    const InSkull expected(run);
    double brain_mm3 = 0.0, all_mm3 = run.report.done.removed_unnamed_mm3;
    for (const auto& [tissue, mm3] : run.report.done.removed_mm3) {
      if (tissue == "brain" || tissue == "dura") brain_mm3 += mm3;
      all_mm3 += mm3;
    }
    std::printf("%-12s brain and dura %.1f mm3, felt as such %.1f mm3\n", name, brain_mm3,
                expected.felt_mm3);
    EXPECT_NEAR(brain_mm3, expected.truly_mm3, 1e-6) << name;
    EXPECT_GT(std::abs(expected.felt_mm3 - expected.truly_mm3), 20.0) << name << ": by HU alone";
    EXPECT_NEAR(all_mm3, double(run.carves.size()) * run.before.geometry.voxelVolume_mm3(), 1e-6);
  }
}

// What a run's recording says of one arm.
struct Seen {
  std::string arm;
  double removed_mm3 = 0.0;
  double liver_mm3 = 0.0;  // removed by all arms
  int touched = 0;                 // ticks
  Inside inside;                   // uncut solid tissue in the tool where it is drawn, every 50 ms
  int gave_out = 0;                // looks, one every 66 ms, at which that was called a fault
  int differs = 0, unflagged = 0;  // ticks whose sent force is not the demanded one; of these
  int silent = 0, silent_other = 0;  // ticks in which no part acted; of these not equal to the bit
  std::map<std::string, std::pair<double, int>> sent_N;  // by tissue: sum and ticks
  // Of the work: the most by which its parts do not add up, in any tick; the most by which heat
  // fell below what it had been; and at the last tick what all voxels before it cost, with what
  // the arms together say that they cost.
  double unbalanced_J = 0.0, cooled_J = 0.0, voxels_J = 0.0, removal_J = 0.0, heat_J = 0.0;
};

// What a voxel costs the tool that takes it (recording.md).
double voxelCost_J(const Recorded& run, const HapticParameters& p, const CarveRecord& carve) {
  if (p.removal == RemovalKind::instant) return 0.0;
  const TissueClass& t = p.tissues.classes[std::size_t(carve.tissue_class)];
  if (!(t.toughness_J_per_m2 > 0.0)) {
    return t.cutting_J_per_mm3 * run.before.geometry.voxelVolume_mm3();
  }
  const double wide_mm = 2000.0 * p.arms[std::size_t(carve.arm)].tool.radius_m;
  const Vec3 thick_mm = glm::min(run.before.geometry.spacing_mm, Vec3(0.5 * wide_mm / 0.505));
  return t.toughness_J_per_m2 * 1e-6 * thick_mm.x * thick_mm.y * thick_mm.z / wide_mm;
}

std::vector<Seen> see(const Recorded& run) {
  constexpr double kWorthAFlag_N = 0.02;
  const HapticParameters p = hapticParameters(run.exercise);
  std::vector<Seen> seen(p.arms.size());
  Volume volume = run.before;
  std::size_t next = 0;
  std::vector<EnergyWatch> watches(seen.size());
  double voxels_J = 0.0;
  for (const CarveRecord& carve : run.carves) {
    if (carve.tick < run.ticks.back().tick) voxels_J += voxelCost_J(run, p, carve);
  }
  for (Seen& of : seen) {
    of.voxels_J = voxels_J;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      of.removal_J += run.ticks.back().arms[i].removal_work_J;
    }
  }
  for (const TickRecord& tick : run.ticks) {
    for (; next < run.carves.size() && run.carves[next].tick <= tick.tick; ++next) {
      volume.hu[run.carves[next].voxel] = kAirHu;
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const ArmRecord& arm = tick.arms[i];
      Seen& of = seen[i];
      of.arm = run.exercise.arms[i].name;
      of.removed_mm3 = run.report.done.arms[i].removed_mm3;
      for (const auto& [tissue, mm3] : run.report.done.removed_mm3) {
        if (tissue == "liver") of.liver_mm3 = mm3;
      }
      of.touched += arm.tissue_class >= 0;
      const double in_J = std::min(arm.hand_work_J, arm.model_work_J) + arm.motor_work_J;
      of.unbalanced_J = std::max(
          of.unbalanced_J,
          std::abs(in_J - arm.stored_J - arm.removal_work_J - arm.cutting_credit_J - arm.heat_J));
      of.heat_J = std::max(of.heat_J, arm.heat_J);
      of.cooled_J = std::max(of.cooled_J, of.heat_J - arm.heat_J);
      const double apart_N = glm::length(arm.sent_N - arm.demanded_N);
      const bool flagged = (arm.controller_parts & ~std::uint32_t(kPartArmNotAsStated)) != 0;
      if (apart_N > kWorthAFlag_N) ++of.differs, of.unflagged += !flagged;
      if (!flagged) ++of.silent, of.silent_other += arm.sent_N != arm.demanded_N;
      if (arm.tissue_class >= 0) {
        auto& [sum_N, ticks] =
            of.sent_N[run.exercise.tissues.tissues[std::size_t(arm.tissue_class)].id];
        sum_N += glm::length(arm.sent_N);
        ++ticks;
      }
      const WorkspaceMap& map = p.arms[i].map;
      if (tick.tick % 66 == 0) {
        of.gave_out += watches[i].look(arm, map.force_scale / map.motion_scale, false,
                                       double(tick.tick) * p.period_s);
      }
      if (tick.tick % 50 != 49) continue;
      const Pose drawn_mm{arm.proxy_position_mm, arm.proxy_orientation};
      for (const BodyPart& part : p.arms[i].tool.body) {
        lookInside(volume, p.tissues, part, drawn_mm, of.inside);
      }
    }
  }
  return seen;
}

// Each run once for all tests.
const std::vector<Seen>& seenOf(const std::string& name, const std::string& case_source) {
  static std::map<std::string, std::vector<Seen>> all;
  const std::string key = name + " on " + case_source;
  if (!all.contains(key)) all[key] = see(record(name, case_source));
  return all[key];
}

std::string realCase(const std::filesystem::path& data, const std::string& name) {
  const bool liver = name.starts_with("liver");
  return data / (liver ? "abdomen-ct-totalsegmentator/example_ct.nii.gz" : "head-ct-plastic-skull");
}

void expectNoBoneInTheTools(const std::string& name, const std::string& case_source) {
  for (const Seen& seen : seenOf(name, case_source)) {
    EXPECT_EQ(seen.inside.voxels, 0)
        << name << ", " << seen.arm << ": by " << seen.inside.deepest_mm << " mm at most";
    if (name.starts_with("liver")) continue;
    EXPECT_GT(seen.inside.deepest_mm, -1.0) << name << ", " << seen.arm << " was at the bone";
  }
}

void expectEveryDifferenceFlagged(const std::string& name, const std::string& case_source) {
  for (const Seen& seen : seenOf(name, case_source)) {
    EXPECT_GT(seen.differs, 100) << name << ", " << seen.arm;
    EXPECT_EQ(seen.unflagged, 0) << name << ", " << seen.arm << ": of " << seen.differs;
    EXPECT_EQ(seen.silent_other, 0) << name << ", " << seen.arm << ": of " << seen.silent;
  }
}

TEST(ShippedExercises, HaveNoUncutBoneInTheirTools) {
  for (const char* name : kShipped) expectNoBoneInTheTools(name, "");
}
TEST(ShippedExercises, HaveNoUncutBoneInTheirToolsOnRealCases) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  for (const char* name : kShipped) expectNoBoneInTheTools(name, realCase(data, name));
}
// In its first ten seconds, as its own script has it.
void expectTouchesAndRemoves(const std::string& name, const std::string& case_source) {
  for (const Seen& seen : seenOf(name, case_source)) {
    std::printf("%-16s %-5s %-6s %.0f mm3\n", name.c_str(), case_source.empty() ? "own" : "real",
                seen.arm.c_str(), seen.removed_mm3);
    EXPECT_GT(seen.touched, 0) << name << ", " << seen.arm;
    EXPECT_GE(seen.removed_mm3, 50.0) << name << ", " << seen.arm;
  }
}
TEST(ShippedExercises, TouchAndRemoveTissueWithEveryArm) {
  for (const char* name : kShipped) expectTouchesAndRemoves(name, "");
  for (const char* name : {"research/seed-cranium", "research/seed-liver"}) {
    expectTouchesAndRemoves(name, "");
  }
}
TEST(ShippedExercises, TouchAndRemoveTissueOfRealCasesToo) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  for (const char* name : kShipped) expectTouchesAndRemoves(name, realCase(data, name));
}
TEST(ShippedExercises, CutTheLiverInTheLiverExercises) {
  for (const char* name : {"liver", "liver-one-arm"}) {
    EXPECT_EQ(shipped(name, "").tissues.find("liver")->structure, "liver");
    for (const Seen& seen : seenOf(name, "")) {
      EXPECT_GE(seen.liver_mm3, 50.0) << name;
      EXPECT_FALSE(seen.sent_N.contains("bone")) << name << ", " << seen.arm;
    }
  }
}
// Where a patient's case has no liver.
TEST(ShippedExercises, KnowTissueByHuOnOtherCasesThanTheirOwn) {
  Exercise exercise = shipped("liver", "");
  exercise = onCase(exercise, "/some/ct");
  const auto placed = placeStructures(exercise, nullptr);
  ASSERT_TRUE(placed.ok());
  EXPECT_EQ(placed->warnings.size(), 1u);
  ASSERT_TRUE(placed->elsewhere);
  const TissueSet& tissues = *exercise.tissues_elsewhere;
  for (const Tissue& tissue : tissues.tissues) EXPECT_TRUE(tissue.isAnywhere()) << tissue.id;
  EXPECT_TRUE(checkLabels(tissues, nullptr).ok());
}
// How many points of a line are within a millimetre of bone that begins there.
int onBone(const std::vector<Vec3>& points, const Exercise& exercise, const Placement& of) {
  const LandmarkFrame& frame = of.landmarks[0].frame;
  const Vec3 out = frame.rotation * Vec3(0.0, 0.0, 1.0);
  const TissueTable tissues = tissueTable(exercise.tissues);
  const int bone = int(exercise.tissues.find("bone") - exercise.tissues.tissues.data());
  const auto isBone = [&](const Vec3& at_mm) {
    return classify(tissues, sampleHu(*of.patient.volume, at_mm)) == bone;
  };
  const Landmark& vault = *exercise.findLandmarkById("vault");
  const auto surface = ontoSurface(points, out, 5.0, vault, *of.patient.volume, exercise.tissues);
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    count += glm::length(points[i] - surface[i]) < 1.0 && isBone(points[i] - out) &&
             !isBone(points[i] + 2.0 * out);
  }
  return count;
}

TEST(ShippedExercises, HaveTheirOutlineOnTheBoneOfTheirOwnCase) {
  int outlines = 0;
  for (const char* name : {"burr-hole", "cranium", "cranium-one-arm", "liver", "liver-one-arm",
                           "research/seed-cranium", "research/seed-liver"}) {
    Exercise exercise = shipped(name, "");
    if (!exercise.outline) continue;
    ++outlines;
    const Placement of = placed(exercise);
    ASSERT_TRUE(exercise.outline->frame) << name << ": so that it holds on other patients";
    const Vec3 was_mm = exercise.outline->frame->at.position_mm;
    EXPECT_LT(glm::length(was_mm - of.landmarks[0].frame.position_mm), 0.01) << name;
    const std::vector<Vec3>& points = exercise.outline->points_mm;
    EXPECT_EQ(onBone(points, exercise, of), int(points.size())) << name;
    const auto drawn = outlineOn(exercise, of.landmarks, *of.patient.volume);
    EXPECT_GT(drawn.size(), points.size());
    EXPECT_EQ(onBone(drawn, exercise, of), int(drawn.size())) << name;
  }
  EXPECT_EQ(outlines, 3) << "the burr hole and the two windows";
}

TEST(ShippedExercises, HaveTheirOutlineOnTheBoneOfARealCaseToo) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  for (const char* name : {"burr-hole", "cranium", "cranium-one-arm"}) {
    Exercise exercise = shipped(name, realCase(data, name));
    const Placement of = placed(exercise);
    ASSERT_FALSE(of.error) << of.error->sentence();
    const auto drawn = outlineOn(exercise, of.landmarks, *of.patient.volume);
    ASSERT_FALSE(drawn.empty());
    std::printf("%s: %d of %zu points of the outline on bone\n", name, onBone(drawn, exercise, of),
                drawn.size());
    EXPECT_GT(onBone(drawn, exercise, of), 0.95 * double(drawn.size())) << name;
  }
}

// The window's hands, which no script moves.
TEST(ShippedExercises, BeginWithTheToolsOutsideOfTissueInTheWindow) {
  for (const char* name : {"burr-hole", "cranium", "cranium-one-arm", "liver", "liver-one-arm",
                           "research/seed-cranium", "research/seed-liver"}) {
    Exercise exercise = shipped(name, "");
    const Placement of = placed(exercise);
    auto session = Session::create(of, {{}, {}, true});
    ASSERT_TRUE(session.ok()) << session.error().sentence();
    ASSERT_TRUE((*session)->freewheel(0.5).ok());
    EXPECT_EQ((*session)->report().done.removed_voxels, 0u) << name;
    const TickRecord record = (*session)->state().record;
    for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
      EXPECT_EQ(record.arms[i].tissue_class, -1) << name << ", " << exercise.arms[i].name;
      EXPECT_EQ(record.arms[i].tool_state, 0u) << name << ", " << exercise.arms[i].name;
      const double moved_mm = 1000.0 * glm::length(record.arms[i].device_position_m);
      if (exercise.anatomy != "cranium") continue;
      EXPECT_LT(moved_mm, 0.5) << name << ": it is in air as it is";
    }
  }
}

TEST(ShippedExercises, GiveOutNoEnergyThatTheWindowWouldCallAFault) {
  for (const char* name : kShipped) {
    for (const Seen& seen : seenOf(name, ""))
      EXPECT_EQ(seen.gave_out, 0) << name << ", " << seen.arm;
  }
}

TEST(ShippedExercises, SayWhereAllWorkWent) {
  for (const char* name : kShipped) {
    for (const Seen& seen : seenOf(name, "")) {
      std::printf("%-16s %-6s removal %.1f mJ, heat %.1f mJ, which fell by %.3f mJ at most\n", name,
                  seen.arm.c_str(), 1e3 * seen.removal_J, 1e3 * seen.heat_J, 1e3 * seen.cooled_J);
      EXPECT_LT(seen.unbalanced_J, 1e-9) << name << ", " << seen.arm;
      EXPECT_NEAR(seen.removal_J, seen.voxels_J, 1e-9 + 1e-6 * seen.voxels_J) << name;
      EXPECT_GT(seen.removal_J, 0.0) << name;
      EXPECT_LT(seen.cooled_J, 0.02 * seen.heat_J + 1e-3) << name << ", " << seen.arm;
    }
  }
}

// A hand that presses lightly on the vault, by an arm without friction, which would still it.
TEST(ShippedExercises, GiveOutEnergyWhereAnArmShakesOnFirmBone) {
  const test::TemporaryFolder folder;
  Json arm = *readJsonFile(usualArmFile());
  arm["arm"].erase("friction_N");
  ASSERT_TRUE(writeTextFile(folder / "arm.json", arm.dump()));
  SessionOptions options{{}, {}, true};
  options.rig.arms.push_back({{kSimulated, 0, (folder / "arm.json").string()}, {}});
  for (const ControllerKind controller : {ControllerKind::off, ControllerKind::bounded}) {
    Exercise exercise = shipped("cranium-one-arm", "");
    exercise.controller = controller;
    for (Tissue& tissue : exercise.tissues.tissues) {
      tissue.cuttable = false;
      if (tissue.id == "bone") tissue.stiffness_N_per_m.value = 10000.0;
    }
    auto session = Session::create(placed(exercise), options);
    ASSERT_TRUE(session.ok()) << session.error().sentence();
    const Vec3 down = (*session)->exercise().arms[0].map.fixed->rotation * Vec3(0.0, 0.0, -1.0);
    EnergyWatch watch;
    int gave_out = 0, pressed = 0;
    double last_J = 0.0;
    const Progress progress([&](double, const std::string&) {
      const LoopState& state = (*session)->state();
      const ArmRecord& arm = state.record.arms[0];
      gave_out += watch.look(arm, 1.0, state.paused, double(state.ticks) / exercise.rate_hz);
      last_J = arm.energy_out_J.x + arm.energy_out_J.y + arm.energy_out_J.z;
      if (arm.tool_state & kToolHeld) ++pressed;
      if (pressed < 2) (*session)->moveHand(0, 0.5 * down);
    });
    ASSERT_TRUE((*session)->freewheel(25.0, progress).ok());
    EXPECT_GT(pressed, 10);
    if (controller == ControllerKind::off) {
      EXPECT_GT(gave_out, 5) << 1e3 * last_J << " mJ";
    } else {
      EXPECT_EQ(gave_out, 0) << 1e3 * last_J << " mJ";
    }
  }
}

TEST(ShippedExercises, FlagEveryDifferenceOfTheSentForceFromTheDemandedOne) {
  for (const char* name : kShipped) expectEveryDifferenceFlagged(name, "");
}
TEST(ShippedExercises, FlagEveryDifferenceOfTheSentForceOnRealCasesToo) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  for (const char* name : kShipped) expectEveryDifferenceFlagged(name, realCase(data, name));
}

// What an arm is sent at 10 mm/s straight in along the exercise's landmark, by tissue [N].
struct Probed {
  std::string arm;
  std::map<std::string, double> mean_N, most_N;
};

Probed probe(const Exercise& placed, const Rig& rig, std::size_t arm, const LandmarkFrame& frame, const Vec3& aside_mm,
             const Placement& of) {
  HapticParameters p = hapticParameters(placed, rig);
  p.arms = {p.arms[arm]};
  p.journal_voxels = 1'000'000;
  Grid grid{Volume(*of.patient.volume), of.labels};
  HapticCore core(p, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  std::map<std::string, int> ticks;
  Probed out;
  out.arm = placed.arms[arm].name;
  const double count_m = p.arms[0].dynamics.encoder_step_m;
  for (double z_mm = 60.0; z_mm > -30.0; z_mm -= 10.0 * p.period_s) {
    const Vec3 at_m = p.arms[0].map.toDevice_m(frame.toPatient_mm(aside_mm + Vec3(0, 0, z_mm)));
    input.arms[0].position_m = count_m * glm::round(at_m / count_m);
    input.journal = core.journalState();
    core.tick(input, nullptr, 0, record);
    ++input.tick;
    const int c = record.arms[0].tissue_class;
    if (c < 0) continue;
    const std::string& id = placed.tissues.tissues[std::size_t(c)].id;
    const double sent_N = glm::length(record.arms[0].sent_N);
    out.mean_N[id] += (sent_N - out.mean_N[id]) / ++ticks[id];
    out.most_N[id] = std::max(out.most_N[id], sent_N);
  }
  return out;
}

std::vector<Probed> probesOf(const std::string& name, const std::string& case_source) {
  Exercise exercise = shipped(name, case_source);
  const Placement of = placed(exercise);
  auto session = Session::create(of, {});
  EXPECT_TRUE(session.ok()) << session.error().sentence();
  const LandmarkFrame& frame = (*session)->landmarks()[0].frame;
  const Vec3 aside_mm = name.starts_with("liver") ? Vec3(8, -34, 0) : Vec3(0.0);  // below the ribs
  std::vector<Probed> out;
  for (std::size_t arm = 0; arm < exercise.arms.size(); ++arm) {
    out.push_back(probe((*session)->exercise(), (*session)->rig(), arm, frame, aside_mm, of));
    for (const auto& [tissue, mean_N] : out.back().mean_N) {
      std::printf("%-16s %-5s %-6s %-8s mean %.2f N, most %.2f N\n", name.c_str(),
                  case_source.empty() ? "own" : "real", out.back().arm.c_str(), tissue.c_str(),
                  mean_N, out.back().most_N[tissue]);
    }
  }
  return out;
}

void expectBoneFelt(const std::string& name, const std::string& case_source, double least_N) {
  for (const Probed& probed : probesOf(name, case_source)) {
    EXPECT_GE(probed.mean_N.at("bone"), least_N) << name << ", " << probed.arm;
  }
}

constexpr std::array kCranial{"burr-hole", "cranium", "cranium-one-arm"};

TEST(ShippedExercises, LetBoneBeFeltByHalfANewton) {
  for (const char* name : kCranial) expectBoneFelt(name, "", 0.5);
}
// The vault of the real skull is thinner than the blade is long: from the first touch to the last
// it is sent a little less on average.
TEST(ShippedExercises, LetBoneBeFeltOnTheRealSkull) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  for (const std::string name : kCranial) {
    expectBoneFelt(name, realCase(data, name), name == "burr-hole" ? 0.5 : 0.45);
  }
}
TEST(ShippedExercises, LetTheCapsuleOfTheLiverBeToldFromItsParenchyma) {
  for (const char* name : {"liver", "liver-one-arm"}) {
    for (const Probed& probed : probesOf(name, "")) {
      // A blade lies across the capsule all the way in: there it is the click that stands out.
      const auto inside = probed.mean_N.find("liver");
      const double after_N =
          inside != probed.mean_N.end() ? inside->second : probed.mean_N.at("capsule");
      EXPECT_GT(probed.most_N.at("capsule"), 1.5 * after_N) << name << ", " << probed.arm;
    }
  }
}

// The built-in liver and its capsule, and the same in every second block of 16 voxels alone:
// borders across the tool's way, where HU go on as they were. What is known by HU alone is not to
// be cut.
TEST(ShippedExercises, CutByStructureRemoveNoVoxelOutsideOfIt) {
  for (const bool in_blocks : {false, true}) {
    Exercise exercise = shipped("liver", "");
    const Case bare = caseOf(exercise);
    auto structures = std::make_shared<LabelMap>(*bare.structures);
    for (std::size_t v = 0; in_blocks && v < structures->labels.size(); ++v) {
      const Index3 at = structures->geometry.indicesOf(v);
      if ((at[0] / 16 + at[1] / 16 + at[2] / 16) % 2 == 0) structures->labels[v] = 0;
    }
    // Where the whole liver is met.
    const Placement whole = *place(exercise, bare);
    const LandmarkFrame& enters = whole.landmarks.front().frame;
    exercise.landmarks.front() = placedAt(exercise.landmarks.front(), enters.position_mm,
                                       enters.rotation * Vec3(0.0, 0.0, 1.0));
    Placement of = *place(exercise, withStructures(bare, structures));
    ASSERT_FALSE(of.error) << of.error->sentence();
    std::array<bool, 256> to_cut{};
    for (Tissue& tissue : of.exercise.tissues.tissues) {
      if (tissue.isAnywhere()) tissue.cuttable = false;
      if (tissue.cuttable && tissue.label) to_cut[std::size_t(*tissue.label)] = true;
    }
    const test::TemporaryFolder folder;
    const SessionOptions options{folder / "s.h5", *readOperatorScript(exercise.operator_file, exercise)};
    auto session = Session::create(of, options);
    ASSERT_TRUE(session) << session.error().sentence();
    ASSERT_TRUE((*session)->freewheel(kSeconds).ok());
    std::size_t inside = 0, outside = 0;
    for (std::size_t v = 0; v < of.patient.volume->hu.size(); ++v) {
      if ((*session)->grid().hu(v) == of.patient.volume->hu[v]) continue;
      ++(to_cut[of.labels->labels[v]] ? inside : outside);
    }
    std::printf("cut by structure%s: %zu voxels inside, %zu outside\n",
                in_blocks ? ", in blocks" : "", inside, outside);
    EXPECT_GT(inside, 20u);
    EXPECT_EQ(outside, 0u);
  }
}

}  // namespace
}  // namespace trephine
