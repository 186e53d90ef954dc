// Where the hands begin that mouse and keys move, and how they come through a pause.
#include <algorithm>
#include <functional>

#include "base/system.h"
#include "cases.h"
#include "exercise/exercise_structures.h"
#include "session/hand_start.h"
#include "session/session.h"
#include "shells.h"
#include "support.h"

namespace trephine {
namespace {

// Tissue below z = 40 mm (patient), and between `ceiling_mm` and 80.
Volume slab(int ceiling_mm = 80) {
  Volume v;
  GridGeometry& g = v.geometry;
  g.size = {40, 40, 80};
  g.spacing_mm = Vec3(1.0);
  v.hu.assign(g.voxelCount(), kAirHu);
  for (std::size_t i = 0; i < v.hu.size(); ++i) {
    const int z = g.indicesOf(i)[2];
    if (z < 40 || z >= ceiling_mm) v.hu[i] = 60;
  }
  return v;
}

// How far a needle of 8 mm is drawn back whose tip the arm's origin puts at `tip_mm`.
double drawnBackFrom(double tip_mm, const Volume& volume, double reach_mm) {
  HapticParameters p;
  p.tissues.count = 1;
  p.tissues.classes[0].hu_min = 0;
  p.tissues.classes[0].hu_max = 200;
  ArmParameters arm;
  arm.tool = makeNeedle(0.008, 5);
  arm.map.centre_mm = Vec3(20.0, 20.0, tip_mm);
  p.arms = {arm};
  return drawnBack_mm(p, Grid(volume), {reach_mm}).at(0);
}

TEST(HandStart, AToolInAirStaysWhereItsArmIs) {
  EXPECT_EQ(drawnBackFrom(45.0, slab(), 50.0), 0.0);
  EXPECT_EQ(drawnBackFrom(400.0, slab(), 50.0), 0.0) << "outside of the case";
}

TEST(HandStart, AToolInTissueIsDrawnBackUntilAllOfItIsOutWithSomeToSpare) {
  const double by_mm = drawnBackFrom(25.0, slab(), 50.0);
  EXPECT_GT(25.0 + by_mm, 42.0);
  EXPECT_LT(25.0 + by_mm, 48.0);
}

TEST(HandStart, NoFartherThanTheArmReaches) {
  EXPECT_LE(drawnBackFrom(25.0, slab(), 16.0), 16.0);
  EXPECT_GT(drawnBackFrom(25.0, slab(), 16.0), 14.0) << "but as far as there is air";
  EXPECT_EQ(drawnBackFrom(25.0, slab(), 10.0), 0.0) << "of no use";
}

TEST(HandStart, WhatLiesFartherOutDoesNotKeepItFromTheAirBetween) {
  const double by_mm = drawnBackFrom(25.0, slab(60), 50.0);
  EXPECT_GT(25.0 + by_mm, 42.0);
  EXPECT_LT(25.0 + by_mm, 52.0) << "8 mm of needle fit below 60";
}

Exercise liver() {
  Exercise exercise = *readExercise(resourceFolder() / "scenes" / "liver-one-arm.json");
  exercise = onCase(exercise, "");
  EXPECT_TRUE(placeStructures(exercise, nullptr).ok());  // by HU: it has no labels
  Landmark& landmark = exercise.landmarks[0];  // found by a ray, in a belly that is quick to make
  landmark.bulk_radius_mm = 0.0;
  landmark.from = {0.5, -0.2, 0.5};
  return exercise;
}

// Liver within muscle within skin: enough for the shipped exercise.
Volume smallBelly() {
  return test::shells(80, 1.5, {{44, 75}, {30, 50}});
}

// A freewheeling session that is spoken to every 256 ticks, as a window would.
void freewheelTalking(Session& session, double seconds, const std::function<void()>& talk) {
  const Progress progress([&](double, const std::string&) { talk(); });
  ASSERT_TRUE(session.freewheel(seconds, progress).ok());
}

TEST(Hands, BeginOutsideOfTheTissueThatTheExercisePutsThemIn) {
  for (const bool outside : {false, true}) {
    auto made = Session::create(test::placed(liver(), smallBelly()), {{}, {}, outside});
    ASSERT_TRUE(made.ok()) << made.error().sentence();
    ASSERT_TRUE((*made)->freewheel(0.3).ok());
    const ArmRecord arm = (*made)->state().record.arms[0];
    EXPECT_EQ((arm.tool_state & kToolWaits) == 0, outside);
    EXPECT_EQ(arm.tissue_class < 0, outside);
    EXPECT_LT(glm::distance((*made)->handTarget_mm(0), arm.patient_position_mm), 0.5)
        << "the hand is where its tool is";
  }
}

// Hands that begin outside of the tissue.
struct BesideTheBelly {
  std::unique_ptr<Session> session =
      *Session::create(test::placed(liver(), smallBelly()), {{}, {}, true});
  Vec3 begin_mm = session->handTarget_mm(0);  // of the first
  Vec3 in = glm::normalize(session->landmarks()[0].frame.position_mm - begin_mm);
};

TEST(Hands, AreBackWhereTheyBeganAfterAReset) {
  BesideTheBelly hands;
  Session& session = *hands.session;
  int talks = 0;
  freewheelTalking(session, 8.0, [&] {
    ++talks;
    if (talks < 24) session.moveHand(0, 4.0 * hands.in);
    if (talks != 24) return;
    EXPECT_GE(session.state().record.arms[0].tissue_class, 0);
    EXPECT_TRUE(session.send(CommandKind::reset));
  });
  ASSERT_GT(talks, 26);
  EXPECT_LT(glm::distance(session.handTarget_mm(0), hands.begin_mm), 1e-9);
  const ArmRecord arm = session.state().record.arms[0];
  EXPECT_LT(glm::distance(arm.patient_position_mm, hands.begin_mm), 0.5);
  EXPECT_EQ(arm.tool_state & kToolWaits, 0u);
}

// The tissue comes back around the tools in the pause, before they push or cut again.
TEST(Hands, AreBackWhereTheyBeganAfterAResetInAPause) {
  BesideTheBelly hands;
  Session& session = *hands.session;
  const auto arm = [&] { return session.state().record.arms[0]; };
  int talks = 0;
  freewheelTalking(session, 9.0, [&] {
    ++talks;
    if (talks < 24) session.moveHand(0, 4.0 * hands.in);
    if (talks == 24) {
      EXPECT_GE(arm().tissue_class, 0);
      EXPECT_TRUE(session.send(CommandKind::pause));
    }
    if (talks == 26) {
      EXPECT_TRUE(session.send(CommandKind::reset));
    }
    if (talks != 30) return;
    EXPECT_TRUE(session.state().paused);
    EXPECT_LT(arm().tissue_class, 0) << "it is in the air before it goes on";
    EXPECT_LT(glm::distance(arm().patient_position_mm, hands.begin_mm), 0.5);
    EXPECT_TRUE(session.send(CommandKind::resume));
  });
  ASSERT_GT(talks, 32);
  EXPECT_FALSE(session.state().paused);
  EXPECT_LT(glm::distance(arm().patient_position_mm, hands.begin_mm), 0.5);
  EXPECT_EQ(session.report().done.removed_voxels, 0u);
}

TEST(Hands, AScriptsHandsBeginWhereTheScriptSays) {
  const Exercise exercise = liver();
  auto script = readOperatorScript(exercise.operator_file, exercise);
  ASSERT_TRUE(script.ok()) << script.error().sentence();
  Vec3 first_mm[2];
  for (const bool outside : {false, true}) {
    auto made = Session::create(test::placed(exercise, smallBelly()), {{}, *script, outside});
    ASSERT_TRUE(made.ok()) << made.error().sentence();
    ASSERT_TRUE((*made)->freewheel(0.001).ok());
    first_mm[outside] = (*made)->state().record.arms[0].patient_position_mm;
  }
  EXPECT_EQ(first_mm[0], first_mm[1]);
}

TEST(Hands, PressAsHardAfterAPauseAsBefore) {
  Exercise exercise = liver();
  for (Tissue& tissue : exercise.tissues_elsewhere->tissues) {  // one firm thing that nothing cuts
    tissue.cuttable = false;
    tissue.solid = true;
    tissue.stiffness_N_per_m.value = 800.0;
  }
  auto made = Session::create(test::placed(exercise, smallBelly()), {{}, {}, true});
  ASSERT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  const Vec3 out = session.exercise().arms[0].map.fixed->rotation * Vec3(0.0, 0.0, 1.0);
  const auto sent_N = [&] { return glm::length(session.state().record.arms[0].sent_N); };
  std::vector<double> pressed_N;
  int touched = 0, talks = 0;  // since
  freewheelTalking(session, 40.0, [&] {
    if (touched == 0 && sent_N() < 0.7) return session.moveHand(0, -0.5 * out);
    ++touched;
    ++talks;
    if (talks == 10) {  // after 2.5 s
      pressed_N.push_back(sent_N());
      session.send(CommandKind::pause);
    }
    if (talks == 14) {
      EXPECT_EQ(sent_N(), 0.0);
      session.send(CommandKind::resume);
      talks = 0;
    }
  });
  ASSERT_GE(pressed_N.size(), 4u);
  EXPECT_GT(pressed_N[0], 0.5);
  for (double force_N : pressed_N) EXPECT_NEAR(force_N, pressed_N[0], 0.05 * pressed_N[0]);
}

}  // namespace
}  // namespace trephine
