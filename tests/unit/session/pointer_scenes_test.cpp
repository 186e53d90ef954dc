// All five shipped exercises, done with a pointer: finished, and the same at any rate of events.
#include <cstdio>
#include <map>
#include <set>
#include <string>

#include "base/system.h"
#include "case/placement.h"
#include "pointer_exercises.h"
#include "support.h"
#include "training/session_reader.h"
#include "uncut_bone.h"
#include "volume/phantom.h"

namespace trephine {
namespace {

using test::PointerTask;
using test::PointerUser;

Placement placed(const Exercise& exercise) {
  static std::map<std::string, Case> all;
  if (!all.contains(exercise.case_source))
    all[exercise.case_source] = *readCase(exercise.case_source);
  return *place(exercise, all[exercise.case_source]);
}

struct Done : test::Cut {
  RunReport report;
  Placement of;
  double removed_mm3 = 0.0;
};

Done done(const PointerTask& task, double rate_hz, const std::filesystem::path& recording = {}) {
  Exercise exercise = *readExercise(resourceFolder() / "scenes" / (task.name + ".json"));
  Done out;
  out.of = placed(exercise);
  auto made = Session::create(out.of, {recording, {}, true});
  EXPECT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  out.frame = session.landmarks()[0].frame;
  out.parameters = hapticParameters(session.exercise(), session.rig());
  out.deepest_mm.assign(task.arms.size(), 1e9);
  std::vector<PointerUser> users;
  for (std::size_t i = 0; i < task.arms.size(); ++i) {
    users.emplace_back(session, i, task.arms[i], rate_hz);
  }
  long talks = 0;
  const Progress progress([&](double, const std::string&) {
    const double now_s = 0.256 * double(talks++);
    for (std::size_t i = 0; i < users.size(); ++i) {
      users[i].playUntil(now_s + 0.52);
      const Vec3 tool_mm = session.state().record.arms[i].proxy_position_mm;
      const Vec3 at_mm = glm::conjugate(out.frame.rotation) * (tool_mm - out.frame.position_mm);
      if (talks > 1) out.deepest_mm[i] = std::min(out.deepest_mm[i], at_mm.z);
    }
  });
  EXPECT_TRUE(session.freewheel(users[0].end_s() + 0.5, progress).ok());
  for (const PointerUser& user : users) EXPECT_TRUE(user.allTaken());
  out.report = session.report();
  out.carved = session.carved();
  for (const auto& [tissue, mm3] : out.report.done.removed_mm3) {
    out.of_mm3[tissue] = mm3;
    out.removed_mm3 += mm3;
  }
  for (std::size_t i = 0; i < users.size(); ++i) {
    const ArmRecord arm = session.state().record.arms[i];
    EXPECT_EQ(arm.tool_state & (kToolWaits | kToolHeld), 0u) << task.name << ": it came out";
    EXPECT_LT(glm::length(arm.sent_N), 0.05) << task.name;
    EXPECT_EQ(arm.tissue_class, -1) << task.name;
  }
  for (const auto& arm : out.report.done.arms) EXPECT_LE(arm.max_force_N, 3.3);
  EXPECT_EQ(out.report.machine.events_dropped, 0u);
  EXPECT_EQ(out.report.machine.nonfinite, 0u);
  return out;
}

// No uncut bone deeper than half a voxel in a tool, every 20 ms.
void expectNoBoneInTheTools(const std::string& name, const Done& run,
                            const std::filesystem::path& recording) {
  const auto reader = SessionReader::open(recording);
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  const auto ticks = *(*reader)->ticks(0, (*reader)->tickCount());
  const auto carves = *(*reader)->carves();
  Volume volume = *run.of.patient.volume;
  std::size_t next = 0;
  test::Inside inside;
  for (const TickRecord& tick : ticks) {
    for (; next < carves.size() && carves[next].tick <= tick.tick; ++next) {
      volume.hu[carves[next].voxel] = kAirHu;
    }
    if (tick.tick % 20 != 19) continue;
    for (std::size_t i = 0; i < run.parameters.arms.size(); ++i) {
      const Pose drawn_mm{tick.arms[i].proxy_position_mm, tick.arms[i].proxy_orientation};
      for (const BodyPart& part : run.parameters.arms[i].tool.body) {
        test::lookInside(volume, run.parameters.tissues, part, drawn_mm, inside);
      }
    }
  }
  EXPECT_EQ(inside.voxels, 0) << name << ": by " << inside.deepest_mm << " mm at most";
}

void expectTheSameAtAnyRate(const PointerTask& task) {
  const test::TemporaryFolder folder;
  std::vector<double> removed_mm3;
  for (const double rate_hz : {60.0, 125.0, 1000.0}) {
    const bool recorded = rate_hz == 125.0;
    const std::filesystem::path file = folder / "s.h5";
    const Done run = done(task, rate_hz, recorded ? file : std::filesystem::path());
    std::printf("%-16s %4.0f/s %.1f mm3\n", task.name.c_str(), rate_hz, run.removed_mm3);
    removed_mm3.push_back(run.removed_mm3);
    for (const std::string& what : test::missing(task, run)) ADD_FAILURE() << what;
    if (recorded) expectNoBoneInTheTools(task.name, run, file);
  }
  const auto [least, most] = std::minmax_element(removed_mm3.begin(), removed_mm3.end());
  EXPECT_LT(*most, 1.05 * *least) << task.name;
}

TEST(PointerExercises, TheBurrHoleIsDone) {
  expectTheSameAtAnyRate(test::kBurrHole);
}
TEST(PointerExercises, TheWindowIsCutOutWithOneArm) {
  expectTheSameAtAnyRate(test::kWindowOneArm);
}
TEST(PointerExercises, TheWindowIsCutOutWithBothArms) {
  expectTheSameAtAnyRate(test::kWindow);
}
TEST(PointerExercises, TheLiverIsSlicedWithOneArm) {
  expectTheSameAtAnyRate(test::kLiverOneArm);
}
TEST(PointerExercises, TheLiverIsPuncturedAndSliced) {
  expectTheSameAtAnyRate(test::kLiver);
}

// Of the voxels of tissue on the blade's axis while it was drawn aside, the share that is gone.
double goneWhereTheBladeWas(const SessionReader& recording, const Session& session,
                            const Placement& of, double from_s, double to_s) {
  const auto ticks =
      *recording.ticks(std::uint64_t(1000.0 * from_s), std::uint64_t(1000.0 * (to_s - from_s)));
  const Grid& carved = *session.carved();
  const GridGeometry& g = carved.geometry();
  const Mat4 to_voxel = g.patientToVoxel();
  const TissueTable table = tissueTable(session.exercise().tissues);
  const LabelMap* labels = of.labels.get();
  std::set<std::size_t> crossed, gone;
  for (const TickRecord& tick : ticks) {
    const ArmRecord& arm = tick.arms[0];
    for (double mm = 0.0; mm <= 50.0; mm += 0.5) {
      const Vec3 at_mm = arm.proxy_position_mm + arm.proxy_orientation * Vec3(0.0, 0.0, mm);
      const Vec3 v = glm::round(Vec3(to_voxel * glm::dvec4(at_mm, 1.0)));
      const int i = int(v.x), j = int(v.y), k = int(v.z);
      if (!g.contains(i, j, k)) continue;
      const std::size_t voxel = g.indexOf(i, j, k);
      const int c =
          classify(table, of.patient.volume->hu[voxel], labels ? labels->labels[voxel] : 0);
      if (c < 0 || !table.classes[std::size_t(c)].cuttable) continue;
      crossed.insert(voxel);
      if (carved.hu(i, j, k) == kAirHu) gone.insert(voxel);
    }
  }
  EXPECT_GT(double(crossed.size()) * g.voxelVolume_mm3(), 150.0);
  return double(gone.size()) / double(crossed.size());
}

// 32 mm within a fifth of a second, some 10 mm deep. On a grid as fine as the blade what it swept
// is a slit. On a coarser one a cut is as thick as a voxel, the work of the hand does not pay for
// all of that (removed volume is work / cutting energy), and what is left is told here.
TEST(PointerExercises, AFastStrokeLeavesASlitAndNoDots) {
  const Exercise exercise = *readExercise(resourceFolder() / "scenes" / "liver-one-arm.json");
  const std::map<double, double> least{{1.0, 0.95}, {2.0, 0.8}, {3.0, 0.6}};
  for (const auto& [coarser, least_gone] : least) {
    GridGeometry g = *phantomGeometry("abdomen");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      g.size[axis] = int(double(g.size[axis]) / coarser);
      g.spacing_mm[int(axis)] *= coarser;
    }
    Case of = caseOf(std::make_shared<const Volume>(
        makePhantomOn(*phantomTruth("abdomen"), g, kPhantomNoiseHu)));
    LabelMap labels = phantomLabelsOn(*phantomTruth("abdomen"), g);
    labels.structures = {
        {1, "liver", Vec3(0.5)}, {2, "capsule", Vec3(0.6)}, {3, "vessel", Vec3(0.7)}};
    of.structures = std::make_shared<const LabelMap>(std::move(labels));
    const Result<Placement> placed = place(onCase(exercise, ""), of);
    ASSERT_TRUE(placed.ok()) << placed.error().sentence();
    const test::TemporaryFolder folder;
    auto made = Session::create(*placed, {folder / "s.h5", {}, true});
    ASSERT_TRUE(made.ok()) << made.error().sentence();
    Session& session = **made;
    // In, aside, some time to follow, and out.
    PointerUser user(session, 0,
                     {{0, 8, -60, 0},
                      {0.5, 8, -42, 0},
                      {1.0, 8, -42, 1.25},
                      {2.2, 8, -42, 0.45},
                      {4.0, 8, -42, 0.45},
                      {4.2, 40, -42, 0.45},
                      {6.5, 40, -42, 0.45},
                      {6.7, 40, -42, 0},
                      {8.5, 40, -60, 0}},
                     125.0);
    long talks = 0;
    const Progress progress(
        [&](double, const std::string&) { user.playUntil(0.256 * double(talks++) + 0.52); });
    ASSERT_TRUE(session.freewheel(user.end_s() + 0.5, progress).ok());
    const auto reader = SessionReader::open(folder / "s.h5");
    ASSERT_TRUE(reader.ok()) << reader.error().sentence();
    const double gone = goneWhereTheBladeWas(**reader, session, *placed, 4.0, 4.6);
    std::printf("voxels of %.1f mm: %.1f %% of what the blade was drawn through is gone\n",
                g.spacing_mm.x, 100.0 * gone);
    EXPECT_GE(gone, least_gone) << g.spacing_mm.x;
  }
}

}  // namespace
}  // namespace trephine
