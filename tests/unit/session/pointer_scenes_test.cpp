// All five shipped exercises, done with a pointer: finished, and the same at any rate of events.
#include <cstdio>
#include <map>
#include <string>

#include "base/system.h"
#include "pointer_user.h"
#include "session/case.h"
#include "support.h"
#include "training/session_reader.h"
#include "uncut_bone.h"

namespace trephine {
namespace {

using test::Pointed;
using test::PointerUser;

struct Exercise {
  std::string name;
  std::vector<std::vector<Pointed>> arms;  // the scene's order
};

// A push goes in; then a touch of it holds the depth while the pointer goes round.
const Exercise kBurrHole{"burr-hole",
                         {{{0, 20, 20, 0},
                           {0.5, 0, 0, 0},
                           {1.0, 0, 0, 2.5},
                           {5.5, 0, 0, 0},
                           {6.5, 0, 0, 0},
                           {7.0, 20, 0, 0}}}};
const Exercise kWindowOneArm{"cranium-one-arm",
                             {{{0, -30, -9, 0},
                               {0.5, -9, -9, 0},
                               {1.0, -9, -9, 2.0},
                               {3.0, -9, -9, 0.1},
                               {5.0, 9, -9, 0.1},
                               {7.0, 9, 9, 0.1},
                               {9.0, -9, 9, 0.1},
                               {11.0, -9, -9, 0.1},
                               {12.5, -9, -9, 0},
                               {13.5, -30, -9, 0}}}};
const Exercise kWindow{"cranium",
                       {{{0, -30, -10, 0},
                         {0.5, 1, -10, 0},
                         {1.0, 1, -10, 2.0},
                         {3.0, 1, -10, 0.1},
                         {5.0, -15, -10, 0.1},
                         {7.5, -15, 10, 0.1},
                         {9.5, 1, 10, 0.1},
                         {10.5, 1, 10, 0},
                         {11.5, -30, 10, 0}},
                        {{0, 30, -10, 0},
                         {0.5, -1, -10, 0},
                         {1.0, -1, -10, 2.0},
                         {3.0, -1, -10, 0.1},
                         {5.0, 15, -10, 0.1},
                         {7.5, 15, 10, 0.1},
                         {9.5, -1, 10, 0.1},
                         {10.5, -1, 10, 0},
                         {11.5, 30, 10, 0}}}};
const std::vector<Pointed> kSlice{{0, 8, -60, 0},     {0.5, 8, -42, 0},    {1.0, 8, -42, 2.5},
                                  {5.0, 8, -42, 0.2}, {9.0, 40, -42, 0.2}, {10.0, 40, -42, 0},
                                  {11.5, 40, -60, 0}};
const Exercise kLiverOneArm{"liver-one-arm", {kSlice}};
const Exercise kLiver{"liver",
                      {{{0, -5, -60, 0},
                        {0.5, -5, -48, 0},
                        {1.0, -5, -48, 1.5},
                        {5.0, -5, -48, 0},
                        {11.5, -5, -48, 0}},
                       kSlice}};

Case placed(Scene& scene) {
  static std::map<std::string, Case> all;
  if (!all.contains(scene.case_source)) all[scene.case_source] = *readCase(scene.case_source);
  return *placedIn(scene, all[scene.case_source]);
}

struct Done {
  RunReport report;
  LandmarkFrame frame;
  HapticParameters parameters;
  Case of;
  std::shared_ptr<const Grid> carved;
  std::vector<double> deepest_mm;  // of each arm's tool, landmark
  double removed_mm3 = 0.0;
  double removed(const std::string& id) const {
    for (const auto& [tissue, mm3] : report.removed_mm3) {
      if (tissue == id) return mm3;
    }
    return 0.0;
  }
};

Done done(const Exercise& exercise, double rate_hz, const std::filesystem::path& recording = {}) {
  Scene scene = *readScene(resourceFolder() / "scenes" / (exercise.name + ".json"));
  Done out;
  out.of = placed(scene);
  auto made = Session::create(scene, out.of, {recording, {}, true});
  EXPECT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  out.frame = session.landmarks()[0].frame;
  out.parameters = hapticParameters(session.scene());
  out.deepest_mm.assign(exercise.arms.size(), 1e9);
  std::vector<PointerUser> users;
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    users.emplace_back(session, i, exercise.arms[i], rate_hz);
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
  for (const auto& [tissue, mm3] : out.report.removed_mm3) out.removed_mm3 += mm3;
  for (std::size_t i = 0; i < users.size(); ++i) {
    const ArmRecord& arm = session.state().record.arms[i];
    EXPECT_EQ(arm.tool_state & (kToolWaits | kToolHeld), 0u) << exercise.name << ": it came out";
    EXPECT_LT(glm::length(arm.sent_N), 0.05) << exercise.name;
    EXPECT_EQ(arm.tissue_class, -1) << exercise.name;
  }
  for (const auto& arm : out.report.arms) EXPECT_LE(arm.statistics.max_force_N, 3.3);
  EXPECT_EQ(out.report.events_dropped, 0u);
  EXPECT_EQ(out.report.nonfinite, 0u);
  return out;
}

// Whether no bone is left in a column of the vault there.
bool isOpen(const Done& run, double x_mm, double y_mm) {
  const Mat4 to_voxel = run.carved->geometry().patientToVoxel();
  for (double z_mm = 6.0; z_mm > -12.0; z_mm -= 0.2) {
    const Vec3 v =
        glm::round(Vec3(to_voxel * glm::dvec4(run.frame.toPatient_mm({x_mm, y_mm, z_mm}), 1.0)));
    const int c = classify(run.parameters.tissues, run.carved->hu(int(v.x), int(v.y), int(v.z)), 0);
    if (c >= 0 && run.parameters.tissues.classes[std::size_t(c)].solid) return false;
  }
  return true;
}

// Along a side of a window, near where the pointer went.
void expectCutThrough(const Done& run, const Vec3& from_mm, const Vec3& to_mm) {
  const double length_mm = glm::distance(from_mm, to_mm);
  const Vec3 along = (to_mm - from_mm) / length_mm;
  for (double s_mm = 3.0; s_mm < length_mm - 3.0; s_mm += 1.0) {
    bool open = false;
    for (double aside_mm = -1.5; aside_mm <= 1.5; aside_mm += 0.25) {
      const Vec3 at_mm = from_mm + s_mm * along + aside_mm * Vec3(-along.y, along.x, 0.0);
      open = open || isOpen(run, at_mm.x, at_mm.y);
    }
    EXPECT_TRUE(open) << from_mm.x + s_mm * along.x << ", " << from_mm.y + s_mm * along.y;
  }
}

void expectFinished(const Exercise& exercise, const Done& run) {
  if (exercise.name == "burr-hole") {
    EXPECT_TRUE(isOpen(run, 0.0, 0.0));
    EXPECT_LT(run.deepest_mm[0], -9.0) << "the brain's side";
    EXPECT_GT(run.removed("bone"), 150.0);
  } else if (exercise.name == "cranium-one-arm") {
    for (const auto& [a, b] : {std::pair{Vec3(-9, -9, 0), Vec3(9, -9, 0)},
                               {Vec3(9, -9, 0), Vec3(9, 9, 0)},
                               {Vec3(9, 9, 0), Vec3(-9, 9, 0)},
                               {Vec3(-9, 9, 0), Vec3(-9, -9, 0)}}) {
      expectCutThrough(run, a, b);
    }
  } else if (exercise.name == "cranium") {
    for (const auto& [a, b] : {std::pair{Vec3(-15, -10, 0), Vec3(15, -10, 0)},
                               {Vec3(15, -10, 0), Vec3(15, 10, 0)},
                               {Vec3(15, 10, 0), Vec3(-15, 10, 0)},
                               {Vec3(-15, 10, 0), Vec3(-15, -10, 0)}}) {
      expectCutThrough(run, a, b);
    }
  } else {
    EXPECT_GT(run.removed("liver"), 500.0);
    EXPECT_EQ(run.removed("bone"), 0.0);
    EXPECT_LT(run.deepest_mm.back(), -30.0) << "the blade";
    EXPECT_LT(run.deepest_mm.front(), -30.0) << "the needle's target";
  }
}

// No uncut bone deeper than half a voxel in a tool, every 20 ms.
void expectNoBoneInTheTools(const std::string& name, const Done& run,
                            const std::filesystem::path& recording) {
  const auto reader = SessionReader::open(recording);
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  const auto ticks = *(*reader)->ticks(0, (*reader)->tickCount());
  const auto carves = *(*reader)->carves();
  Volume volume = *run.of.volume;
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

void expectTheSameAtAnyRate(const Exercise& exercise) {
  const test::TemporaryFolder folder;
  std::vector<double> removed_mm3;
  for (const double rate_hz : {60.0, 125.0, 1000.0}) {
    const bool recorded = rate_hz == 125.0;
    const std::filesystem::path file = folder / "s.h5";
    const Done run = done(exercise, rate_hz, recorded ? file : std::filesystem::path());
    std::printf("%-16s %4.0f/s %.1f mm3\n", exercise.name.c_str(), rate_hz, run.removed_mm3);
    removed_mm3.push_back(run.removed_mm3);
    expectFinished(exercise, run);
    if (recorded) expectNoBoneInTheTools(exercise.name, run, file);
  }
  const auto [least, most] = std::minmax_element(removed_mm3.begin(), removed_mm3.end());
  EXPECT_LT(*most, 1.05 * *least) << exercise.name;
}

TEST(PointerScenes, TheBurrHoleIsDone) {
  expectTheSameAtAnyRate(kBurrHole);
}
TEST(PointerScenes, TheWindowIsCutOutWithOneArm) {
  expectTheSameAtAnyRate(kWindowOneArm);
}
TEST(PointerScenes, TheWindowIsCutOutWithBothArms) {
  expectTheSameAtAnyRate(kWindow);
}
TEST(PointerScenes, TheLiverIsSlicedWithOneArm) {
  expectTheSameAtAnyRate(kLiverOneArm);
}
TEST(PointerScenes, TheLiverIsPuncturedAndSliced) {
  expectTheSameAtAnyRate(kLiver);
}

}  // namespace
}  // namespace trephine
