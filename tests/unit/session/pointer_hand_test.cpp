// A hand that goes where a pointer is, on the simulated arms of a small head.
#include "session/pointer_hand.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "base/rt/alloc_guard.h"
#include "cases.h"
#include "haptics/loop_clock.h"
#include "pointer_user.h"
#include "session_support.h"
#include "support.h"
#include "training/replay.h"
#include "uncut_bone.h"

namespace trephine {
namespace {

using test::Pointed;
using test::PointerUser;
using test::smallHead;

constexpr std::size_t kArm = 1;

Exercise cranium(bool cuttable) {
  Exercise exercise = test::cranium();
  for (Tissue& tissue : exercise.tissues.tissues) {
    if (tissue.id == "bone") tissue.cuttable = cuttable;
    if (tissue.id == "scalp") {  // shown, so that the tool hovers off it; and hardly felt
      tissue.opacity = 1.0;
      tissue.stiffness_N_per_m.value = tissue.friction_N.value = 0.0;
    }
  }
  return exercise;
}

// What the loop said, every tick: from the recording of a run in which the right hand follows
// `path`, talked to every 256 ticks.
struct Played {
  std::vector<ArmRecord> ticks;
  std::vector<CarveRecord> carves;
  std::vector<Event> events;
  LandmarkFrame frame;
  HapticParameters parameters;
  double limit_N = 0.0;

  Vec3 tool_mm(std::size_t tick) const {
    return glm::conjugate(frame.rotation) * (ticks[tick].proxy_position_mm - frame.position_mm);
  }
  double sent_N(std::size_t tick) const { return glm::length(ticks[tick].sent_N); }
};

using Talk = std::function<void(Session&, double)>;

Played run(const std::vector<Pointed>& path, bool cuttable, const Talk& talk = {}) {
  const test::TemporaryFolder folder;
  const Exercise exercise = cranium(cuttable);
  auto made = Session::create(test::placed(exercise, smallHead()), {folder / "s.h5", {}, true});
  EXPECT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  Played out;
  out.frame = session.landmarks()[0].frame;
  out.parameters = hapticParameters(session.exercise(), session.rig());
  out.limit_N = session.exercise().arms[kArm].max_force_N;
  PointerUser user(session, kArm, path, 125.0);
  const std::uint64_t allocated = rt::guardedAllocations();
  int talks = 0;
  const Progress progress([&](double, const std::string&) {
    const double now_s = 0.256 * talks++;
    user.playUntil(std::min(now_s + 0.52, path.back().t_s));
    if (talk) talk(session, now_s);
  });
  EXPECT_TRUE(session.freewheel(path.back().t_s, progress).ok());
  EXPECT_EQ(rt::guardedAllocations(), allocated) << "the tick allocates nothing";
  const auto reader = SessionReader::open(folder / "s.h5");
  const auto ticks = *(*reader)->ticks(0, (*reader)->tickCount());
  for (const TickRecord& tick : ticks) {
    out.ticks.push_back(tick.arms[kArm]);
    EXPECT_LE(glm::length(tick.arms[kArm].sent_N), out.limit_N + 1e-9);
  }
  out.carves = *(*reader)->carves();
  out.events = *(*reader)->events();
  const auto replayed = replay(**reader, smallHead());
  EXPECT_TRUE(replayed.ok() && replayed->identical)
      << (replayed.ok() ? replayed->first_difference->field : replayed.error().sentence());
  return out;
}

// In mm a tick, the fastest that the arm went: what is let go is not thrown. (Where a wall gives
// way, the tool itself is at its arm a tick or two later.)
double fastest_mm(const Played& of) {
  double most_mm = 0.0;
  for (std::size_t n = 1; n < of.ticks.size(); ++n) {
    const Vec3& before_mm = of.ticks[n - 1].patient_position_mm;
    most_mm = std::max(most_mm, glm::distance(of.ticks[n].patient_position_mm, before_mm));
  }
  return most_mm;
}

TEST(PointerHand, HoversOffWhatIsSeenWithoutForceAndFollowsThePointer) {
  const Played hover = run({{0, 0, 0, 0}, {1.0, 0, 0, 0}, {1.5, 12, 0, 0}, {2.5, 12, 0, 0}}, true);
  EXPECT_NEAR(hover.tool_mm(2499).x, 12.0, 0.5);
  EXPECT_TRUE(hover.carves.empty());
  for (std::size_t n = 1000; n < 2500; ++n) {
    ASSERT_EQ(hover.ticks[n].tissue_class, -1) << n;
    EXPECT_EQ(hover.sent_N(n), 0.0);
  }
  EXPECT_LT(fastest_mm(hover), 0.35) << "0.25 m/s aside, 0.1 m/s along, and their swing";
}

// Of a hand's push the arm's own friction takes its part, one way or the other.
constexpr double kFriction_N = 0.26;

TEST(PointerHand, PressesWithTheForceThatIsSetAndStopsAtWhatItCannotCut) {
  const Played pressed =
      run({{0, 4, 0, 0}, {0.5, 4, 0, 1.0}, {3.0, 4, 0, 2.5}, {5.0, 4, 0, 2.5}}, false);
  EXPECT_NEAR(pressed.sent_N(2990), 1.0, kFriction_N + 0.1);
  EXPECT_NEAR(pressed.sent_N(4990), 2.5, kFriction_N + 0.1);
  EXPECT_TRUE(pressed.ticks[4990].tool_state & kToolHeld);
  EXPECT_NEAR(pressed.tool_mm(4990).z, pressed.tool_mm(2990).z, 0.2) << "no deeper for it";
  test::Inside inside;
  for (std::size_t n = 0; n < pressed.ticks.size(); n += 20) {
    const Pose drawn_mm{pressed.ticks[n].proxy_position_mm, pressed.ticks[n].proxy_orientation};
    for (const BodyPart& part : pressed.parameters.arms[kArm].tool.body) {
      test::lookInside(smallHead(), pressed.parameters.tissues, part, drawn_mm, inside);
    }
  }
  EXPECT_EQ(inside.voxels, 0);
}

// A burr of 6 mm instead of the blade: it stops at its own surface, not at the blade's.
TEST(PointerHand, StopsWithTheToolThatItWasGivenAtWhatThatCannotCut) {
  const auto give = [](Session& session, double now_s) {
    if (now_s > 0.0 && now_s < 0.3) {
      EXPECT_TRUE(session.changeTool(kArm, 2));
    }
    if (now_s > 1.0) {
      EXPECT_EQ(session.state().tools[kArm], 2);
    }
  };
  const Played pressed =
      run({{0, 4, 0, 0}, {1.0, 4, 0, 1.0}, {3.0, 12, 0, 2.5}, {5.0, 12, 0, 2.5}}, false, give);
  EXPECT_NEAR(pressed.sent_N(4990), 2.5, 0.3);
  EXPECT_TRUE(pressed.ticks[4990].tool_state & kToolHeld);
  test::Inside inside;
  for (std::size_t n = 1000; n < pressed.ticks.size(); n += 20) {
    const Pose drawn_mm{pressed.ticks[n].proxy_position_mm, pressed.ticks[n].proxy_orientation};
    for (const BodyPart& part : pressed.parameters.arms[kArm].other_tools[1].body) {
      test::lookInside(smallHead(), pressed.parameters.tissues, part, drawn_mm, inside);
    }
  }
  EXPECT_EQ(inside.voxels, 0);
  EXPECT_LT(fastest_mm(pressed), 0.35);
}

TEST(PointerHand, TheOtherToolCutsItsOwnHole) {
  std::array<std::size_t, 2> cut{};
  for (const std::size_t tool : {0, 2}) {
    const auto give = [&](Session& session, double now_s) {
      if (now_s > 0.0 && now_s < 0.3) {
        EXPECT_TRUE(session.changeTool(kArm, tool));
      }
    };
    const Played pressed =
        run({{0, 4, 0, 0}, {1.0, 4, 0, 2.0}, {4.0, 4, 0, 0}, {5.0, 4, 0, 0}}, true, give);
    cut[tool / 2] = pressed.carves.size();
  }
  EXPECT_GT(cut[0], 20u);
  EXPECT_GT(double(cut[1]), 1.3 * double(cut[0]));
}

TEST(PointerHand, DraggedAsideInAHoleGrindsItsWallAndIsNotThrown) {
  const Played dragged = run({{0, 4, 0, 0},
                              {0.5, 4, 0, 2.0},
                              {2.5, 4, 0, 0.3},
                              {3.0, 4, 0, 0.3},
                              {3.2, 34, 0, 0.3},
                              {4.5, 34, 0, 0.3}},
                             true);
  const double in_hole_mm = dragged.tool_mm(3000).x;
  EXPECT_NEAR(in_hole_mm, 4.0, 1.0);
  EXPECT_LT(dragged.tool_mm(3000).z, -2.0);
  EXPECT_GT(dragged.tool_mm(4490).x, in_hole_mm + 2.0) << "it grinds on";
  EXPECT_LT(dragged.tool_mm(4490).x, 33.0) << "and is not yet there";
  std::size_t before = 0, after = 0;
  for (const CarveRecord& carve : dragged.carves) (carve.tick < 3000 ? before : after)++;
  EXPECT_GT(after, 20u);
  EXPECT_LT(fastest_mm(dragged), 0.35);
  double most_N = 0.0, farthest_mm = 0.0;
  for (std::size_t n = 3000; n < dragged.ticks.size(); ++n) {
    const ArmRecord& arm = dragged.ticks[n];
    most_N = std::max(most_N, dragged.sent_N(n));
    farthest_mm =
        std::max(farthest_mm, glm::distance(arm.patient_position_mm, arm.proxy_position_mm));
  }
  EXPECT_LT(most_N, 3.15) << "as hard as a hand pulls, and not with all that the arm has";
  EXPECT_LT(farthest_mm, 8.0);
}

TEST(PointerHand, AtNoPushComesOutAndGoesWhereThePointerIsWithoutAJolt) {
  const Played out = run({{0, 4, 0, 0},
                          {0.5, 4, 0, 2.0},
                          {2.5, 4, 0, 0},
                          {2.6, 4, 0, 0},
                          {2.8, 20, 0, 0},
                          {5.0, 20, 0, 0}},
                         true);
  EXPECT_LT(out.tool_mm(2500).z, -2.0);
  EXPECT_EQ(out.ticks[4990].tissue_class, -1);
  EXPECT_NEAR(out.tool_mm(4990).x, 20.0, 0.5);
  for (std::size_t n = 2530; n < 5000; ++n) {
    EXPECT_LT(out.sent_N(n), out.sent_N(n - 1) + 0.5) << n;
  }
  EXPECT_LT(fastest_mm(out), 0.3);
  // It left the bone before it went aside.
  for (std::size_t n = 2700; n < 5000; ++n) {
    if (std::abs(out.tool_mm(n).x - 4.0) > 3.0) {
      EXPECT_GT(out.tool_mm(n).z, 1.0) << n;
    }
  }
}

// From beside the head, where it was pushed down in air, onto the head.
TEST(PointerHand, LedOntoTissueThatIsHigherItRisesFirstAndTouchesNothing) {
  const Played out = run({{0, 0, 0, 0},
                          {0.5, 0, 70, 0},
                          {1.5, 0, 70, 3.0},
                          {4.0, 0, 70, 3.0},
                          {4.1, 0, 70, 0},
                          {4.2, 0, 20, 0},
                          {7.0, 0, 20, 0}},
                         true);
  ASSERT_EQ(out.ticks[3990].tissue_class, -1);
  for (std::size_t n = 4000; n < 7000; ++n) ASSERT_EQ(out.ticks[n].tissue_class, -1) << n;
  EXPECT_TRUE(out.carves.empty());
  EXPECT_NEAR(out.tool_mm(6990).y, 20.0, 0.5);
}

TEST(PointerHand, SentBackFromTheEdgeOfItsReachItReachesWhereItBegan) {
  // To the side until the arm's workspace ends; then back to where it began, and on from there.
  const Played back = run({{0, 0, 0, 0},
                           {0.5, 0, 0, 0},
                           {2.0, 300, 0, 0},
                           {3.0, 300, 0, 0},
                           {3.1, 4, 0, 0},
                           {4.0, 4, 0, 1.0},
                           {6.0, 4, 0, 1.0}},
                          false, [](Session& session, double now_s) {
                            if (now_s > 2.4 && now_s < 2.6) {
                              EXPECT_TRUE(session.recentre(kArm));
                            }
                          });
  EXPECT_GT(back.tool_mm(2300).x, 40.0);
  EXPECT_NEAR(back.tool_mm(5990).x, 4.0, 0.5);
  EXPECT_NEAR(back.sent_N(5990), 1.0, kFriction_N + 0.1);
}

TEST(PointerHand, InAirGoesNoFartherThanItsReach) {
  // Beside the head.
  const Played air =
      run({{0, 0, 0, 0}, {0.5, 0, 70, 0}, {1.5, 0, 70, 3.0}, {5.0, 0, 70, 3.0}}, false);
  const double before_mm = air.tool_mm(1500).z;
  EXPECT_EQ(air.ticks[4990].tissue_class, -1);
  EXPECT_GT(air.tool_mm(4990).z, before_mm - PointerHand::kReach_mm - PointerHand::kHover_mm - 1.0);
}

TEST(PointerHand, ThatIsPutDownInAKerfIsTakenUpSmoothly) {
  bool released = false;
  const Played rest = run({{0, 4, 0, 0}, {0.5, 4, 0, 2.0}, {5.0, 4, 0, 2.0}, {6.0, 4, 0, 0}}, true,
                          [&](Session& session, double now_s) {
                            if (now_s < 2.0 || now_s > 2.3 || released) return;
                            // What waits is played first; from then on it is not in use.
                            released = session.releaseHand(kArm);
                            EXPECT_EQ(session.handPush_N(kArm), 0.0);
                          });
  ASSERT_TRUE(released);
  EXPECT_LT(fastest_mm(rest), 0.3);
}

// As a needle is held still in the liver while the other hand cuts: from 2.5 s on.
struct PutDown {
  double deepest_mm = 0.0;  // of the tip before
  std::vector<double> depth_mm, sent_N;
  std::vector<Vec3> at_mm;
};

PutDown putDown(double seconds, const Talk& talk = {}) {
  const Exercise exercise = cranium(true);
  auto made = Session::create(test::placed(exercise, smallHead()), {{}, {}, true});
  EXPECT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  PointerUser user(session, kArm, {{0, 4, 0, 0}, {0.5, 4, 0, 2.0}, {2.0, 4, 0, 2.0}}, 125.0);
  const LandmarkFrame frame = session.landmarks()[0].frame;
  PutDown out;
  int talks = 0;
  const Progress progress([&](double, const std::string&) {
    const double now_s = 0.256 * talks++;
    if (now_s < 2.0) user.playUntil(std::min(now_s + 0.52, 2.0));
    if (now_s > 2.3 && now_s < 2.6) {
      EXPECT_TRUE(session.releaseHand(kArm));
    }
    if (talk) talk(session, now_s);
    if (talks == 1) return;  // nothing has been felt yet
    const ArmRecord arm = session.state().record.arms[kArm];
    const double depth_mm =
        (glm::conjugate(frame.rotation) * (arm.proxy_position_mm - frame.position_mm)).z;
    if (now_s < 2.5) out.deepest_mm = std::min(out.deepest_mm, depth_mm);
    if (now_s < 3.0) return;
    out.depth_mm.push_back(depth_mm);
    out.sent_N.push_back(glm::length(arm.sent_N));
    out.at_mm.push_back(arm.proxy_position_mm);
  });
  EXPECT_TRUE(session.freewheel(seconds, progress).ok());
  EXPECT_LT(out.deepest_mm, -2.0);
  return out;
}

// No force but what the arm's own friction holds.
TEST(PointerHand, AToolThatWasPutDownStaysInTheTissueWithoutForce) {
  const PutDown rest = putDown(8.0);
  ASSERT_GT(rest.at_mm.size(), 10u);
  for (std::size_t n = 0; n < rest.at_mm.size(); ++n) {
    EXPECT_LT(rest.depth_mm[n], rest.deepest_mm + 2.0);
    EXPECT_LT(rest.sent_N[n], kFriction_N + 0.05);
    EXPECT_LT(glm::distance(rest.at_mm[n], rest.at_mm.front()), 0.1) << "it does not creep";
  }
}

TEST(PointerHand, AToolThatWasPutDownComesOutWhereTissueComesBackAroundIt) {
  bool undone = false;
  const PutDown rest = putDown(8.0, [&](Session& session, double now_s) {
    if (now_s > 4.0 && !std::exchange(undone, true)) {
      EXPECT_TRUE(session.send(CommandKind::undo));
    }
  });
  ASSERT_GT(rest.at_mm.size(), 10u);
  EXPECT_LT(rest.depth_mm.front(), -1.0);
  EXPECT_GT(rest.depth_mm.back(), 0.0);
  EXPECT_EQ(rest.sent_N.back(), 0.0);
}

TEST(PointerHand, TurnsTheToolInATenthOfASecondWithinBoundsAndBack) {
  const test::TemporaryFolder folder;
  const Exercise exercise = cranium(true);
  auto made = Session::create(test::placed(exercise, smallHead()), {{}, {}, true});
  ASSERT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  PointerUser user(session, kArm, {{0, 4, 0, 0}, {9.0, 4, 0, 0}}, 125.0);
  const auto turned_rad = [&] {
    const ArmRecord arm = session.state().record.arms[kArm];
    return 2.0 * std::acos(std::min(1.0, std::abs(arm.device_orientation.w)));
  };
  int talks = 0;
  const Progress progress([&](double, const std::string&) {
    const int n = talks++;
    user.playUntil(0.256 * n + 0.52);
    if (n == 4) session.turnHand(kArm, Vec3(1, 0, 0), 0.3);
    if (n == 5) {
      EXPECT_NEAR(turned_rad(), 0.3, 0.01);
      for (int k = 0; k < 50; ++k) session.turnHand(kArm, Vec3(1, 0, 0), 0.1);
    }
    if (n == 6) {
      EXPECT_NEAR(turned_rad(), Session::kMostTurn_rad, 0.11);
      EXPECT_LE(turned_rad(), Session::kMostTurn_rad + 1e-6);
      session.straightenHand(kArm);
    }
    if (n == 7) {
      EXPECT_NEAR(turned_rad(), 0.0, 0.01);
    }
  });
  ASSERT_TRUE(session.freewheel(2.5, progress).ok());
  EXPECT_GE(talks, 8);
}

TEST(PointerHand, AnUndoTakesThePushAwayAndTheToolComesOut) {
  bool undone = false;
  const test::TemporaryFolder folder;
  const Exercise exercise = cranium(true);
  auto made = Session::create(test::placed(exercise, smallHead()), {{}, {}, true});
  ASSERT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  PointerUser user(session, kArm, {{0, 4, 0, 0}, {0.5, 4, 0, 2.0}, {2.0, 4, 0, 2.0}}, 125.0);
  int talks = 0;
  const Progress progress([&](double, const std::string&) {
    const double now_s = 0.256 * talks++;
    if (now_s < 2.0) user.playUntil(std::min(now_s + 0.52, 2.0));
    if (now_s > 2.5 && !undone) {
      EXPECT_TRUE(session.state().can_undo);
      undone = session.send(CommandKind::reset);
      EXPECT_EQ(session.handPush_N(kArm), 0.0);
    }
  });
  ASSERT_TRUE(session.freewheel(5.0, progress).ok());
  EXPECT_TRUE(undone);
  const ArmRecord arm = session.state().record.arms[kArm];
  EXPECT_EQ(arm.tool_state, 0u) << "out, and ready";
  EXPECT_EQ(arm.tissue_class, -1);
  EXPECT_EQ(session.report().done.removed_voxels, 0u) << "and cut nothing since";
}

TEST(PointerHand, InTissueThatCameBackItComesOutFirstHoweverItIsPushed) {
  bool reset = false;
  const Played again = run({{0, 4, 0, 0}, {0.5, 4, 0, 2.0}, {2.0, 4, 0, 2.0}, {6.0, 4, 0, 2.0}},
                           true, [&](Session& session, double now_s) {
                             if (now_s < 2.5 || reset) return;
                             reset = session.send(CommandKind::reset);
                             EXPECT_TRUE(session.setPush(kArm, 2.0));
                           });
  ASSERT_TRUE(reset);
  std::size_t waited = 0;
  for (const ArmRecord& arm : again.ticks) waited += (arm.tool_state & kToolWaits) != 0;
  EXPECT_GT(waited, 50u);
  EXPECT_LT(waited, 1500u);
}

TEST(PointerHand, PressesAsHardAfterAPauseAsBeforeAndStaysInIt) {
  std::vector<double> device_z;
  const Played paused =
      run({{0, 4, 0, 0}, {0.5, 4, 0, 1.5}, {6.0, 4, 0, 1.5}}, false,
          [&](Session& session, double now_s) {
            if (now_s > 2.5 && now_s < 2.8) session.send(CommandKind::pause);
            if (now_s > 3.5 && now_s < 3.8) session.send(CommandKind::resume);
            if (now_s > 3.0 && now_s < 3.5) {
              EXPECT_EQ(session.state().record.arms[kArm].sent_N, Vec3(0.0));
              device_z.push_back(session.state().record.arms[kArm].device_position_m.z);
            }
          });
  ASSERT_GE(device_z.size(), 2u);
  EXPECT_NEAR(device_z.front(), device_z.back(), 1e-4);
  EXPECT_NEAR(paused.sent_N(5990), 1.5, kFriction_N + 0.1);
  for (std::size_t n = 3600; n < 6000; ++n) {
    EXPECT_LT(paused.sent_N(n), paused.sent_N(n - 1) + 0.05 + 1e-9) << n;
  }
}

TEST(PointerHand, WithTurnsHandsAndClutchesReplaysBitForBit) {
  const Quat view = glm::angleAxis(0.4, Vec3(0, 0, 1));
  const Played all =
      run({{0, 4, 0, 0}, {0.5, 4, 0, 2.0}, {2.0, 8, 0, 0.3}, {3.0, 12, 4, 0}, {6.0, 12, 4, 1.0}},
          true, [&](Session& session, double now_s) {
            const auto at = [&](double t_s) { return now_s <= t_s && t_s < now_s + 0.256; };
            if (at(0.8)) session.turnHand(kArm, Vec3(0, 1, 0), 0.2);
            if (at(1.5)) {
              EXPECT_TRUE(session.clutch(kArm, true));
            }
            if (at(2.2)) {
              EXPECT_TRUE(session.clutch(kArm, false));
            }
            if (at(3.5)) {
              EXPECT_TRUE(session.clutch(kArm, true));
            }
            if (at(4.0)) {
              EXPECT_TRUE(session.clutch(kArm, false, view));
            }
            if (at(4.5)) {
              EXPECT_TRUE(session.recentre(kArm));
            }
            if (at(5.0)) {
              EXPECT_TRUE(session.releaseHand(kArm));
            }
          });
  int of_the_arm = 0;
  for (const Event& event : all.events) of_the_arm += event.command.arm == int(kArm);
  EXPECT_EQ(of_the_arm, 5);
  EXPECT_FALSE(all.carves.empty());
}

TEST(PointerHand, OfARunningSessionTakesTheHostsTimes) {
  const Exercise exercise = cranium(true);
  auto made = Session::create(test::placed(exercise, smallHead()), {{}, {}, true});
  ASSERT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  PointerUser user(session, kArm, {{0, 12, 0, 0}, {9.0, 12, 0, 0}}, 125.0);
  ASSERT_TRUE(session.start().ok());
  ASSERT_TRUE(test::waitUntil([&] { return session.state().ticks > 0; }));
  HostClock clock;
  const LandmarkFrame& frame = session.landmarks()[0].frame;
  EXPECT_TRUE(test::waitUntil([&] {
    PointerSample sample = user.at(0.0);
    sample.time_ns = clock.now_ns();
    EXPECT_TRUE(session.point(kArm, sample));
    const Vec3 tool_mm = session.state().record.arms[kArm].proxy_position_mm - frame.position_mm;
    return std::abs((glm::conjugate(frame.rotation) * tool_mm).x - 12.0) < 1.0;
  }));
  ASSERT_TRUE(session.stop().ok());
  PointerSample none = user.at(0.0);
  none.direction = Vec3(0.0);
  EXPECT_FALSE(session.point(kArm, none));
}

}  // namespace
}  // namespace trephine
