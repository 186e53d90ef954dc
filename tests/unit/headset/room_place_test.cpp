// Where the patient lies before the trainee, and where arms stand in the room.
#include "headset/room_place.h"

#include <gtest/gtest.h>

#include <random>

namespace trephine {
namespace {

Eyes eyesAt(const Pose& head_m) {
  Eyes eyes;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    eyes[eye].pose = head_m;
    eyes[eye].pose.position += head_m.orientation * Vec3(eye == 0 ? -0.032 : 0.032, 0.0, 0.0);
  }
  return eyes;
}

void expectNear(const Vec3& a, const Vec3& b, double within, const char* what) {
  EXPECT_LT(glm::distance(a, b), within) << what << ": " << a.x << ' ' << a.y << ' ' << a.z
                                         << " and " << b.x << ' ' << b.y << ' ' << b.z;
}

TEST(RoomPlace, WhatIsLookedAtStandsAheadOfTheEyesAndIsSeenAsThePanelShowsIt) {
  // The head is turned to the left, tilted and bent: only which way it is turned counts.
  const Quat turned = glm::angleAxis(0.7, Vec3(0, 1, 0));
  const Quat bent =
      turned * glm::angleAxis(-0.5, Vec3(1, 0, 0)) * glm::angleAxis(0.3, Vec3(0, 0, 1));
  for (const Quat& head : {turned, bent}) {
    const Pose head_m{{0.1, 0.2, -0.3}, head};
    Looked what;
    what.at_mm = {10.0, -20.0, 30.0};
    what.forward = glm::normalize(Vec3(0.3, 0.9, -0.2));
    what.up = glm::normalize(glm::cross(glm::cross(what.forward, Vec3(0, 0, 1)), what.forward));
    const RoomPlace place = before(eyesAt(head_m), what, 0.5, -0.2);
    const Vec3 at_m = place.toRoom_m(what.at_mm);
    const Vec3 ahead = turned * Vec3(0, 0, -1);
    EXPECT_NEAR(at_m.y, 0.0, 1e-12);
    EXPECT_NEAR(glm::distance(at_m, head_m.position), std::hypot(0.5, 0.2), 1e-12);
    const Vec3 level = glm::normalize(Vec3(at_m.x - 0.1, 0.0, at_m.z + 0.3));
    EXPECT_GT(glm::dot(level, ahead), 0.98) << "where the head is turned";
    // From the head one looks at it along the panel's line of sight, upright.
    expectNear(place.turn * what.forward, glm::normalize(at_m - head_m.position), 1e-12, "forward");
    EXPECT_GT((place.turn * what.up).y, 0.9);
    EXPECT_NEAR((place.turn * glm::cross(what.forward, what.up)).y, 0.0, 1e-12) << "level";
  }
}

TEST(RoomPlace, ThereAndBackIsTheSamePlaceAndAMetreIsAMetre) {
  RoomPlace place;
  place.turn = glm::normalize(Quat(0.4, -0.3, 0.8, 0.2));
  place.origin_m = {1.0, -2.0, 0.5};
  const Vec3 a_mm(12.0, -7.0, 90.0), b_mm(112.0, -7.0, 90.0);
  expectNear(place.toPatient_mm(place.toRoom_m(a_mm)), a_mm, 1e-9, "back");
  EXPECT_NEAR(glm::distance(place.toRoom_m(a_mm), place.toRoom_m(b_mm)), 0.1, 1e-12);
  place.scale = 2.0;
  EXPECT_NEAR(glm::distance(place.toRoom_m(a_mm), place.toRoom_m(b_mm)), 0.2, 1e-12);
  expectNear(place.toPatient_mm(place.toRoom_m(a_mm)), a_mm, 1e-9, "back, larger than life");
}

TEST(RoomPlace, AnEyeOfTheRoomLooksTheSameWayInThePatient) {
  RoomPlace place;
  place.turn = glm::normalize(Quat(0.4, -0.3, 0.8, 0.2));
  place.origin_m = {1.0, -2.0, 0.5};
  EyeView eye;
  eye.pose = {{0.2, 0.1, 0.4}, glm::normalize(Quat(0.9, 0.1, -0.2, 0.3))};
  eye.sees = {-0.8, 0.6, -0.7, 0.5};
  const EyeView there = place.toPatient_mm(eye);
  const Vec3 ahead_m = eye.pose.position + eye.pose.orientation * Vec3(0, 0, -0.25);
  const Vec3 ahead_mm = there.pose.position + there.pose.orientation * Vec3(0, 0, -250.0);
  expectNear(place.toPatient_mm(ahead_m), ahead_mm, 1e-9, "a quarter of a metre ahead");
  EXPECT_EQ(there.sees, eye.sees);
}

TEST(RoomPlace, WhereAnArmIsRegisteredItsToolIsSeenWhereItIsFelt) {
  const Pose left{{-0.2, 0.9, -0.4}, glm::normalize(Quat(0.9, 0.1, 0.4, -0.1))};
  for (const double travel : {1.0, 0.5}) {
    const ArmInPatient arm{{12.0, -40.0, 80.0}, glm::normalize(Quat(0.7, -0.2, 0.5, 0.3)), travel};
    const RoomPlace place = where(left, arm);
    EXPECT_DOUBLE_EQ(place.scale, 1.0 / travel);
    for (const Vec3& tip_m : {Vec3(0.0), Vec3(0.03, -0.02, 0.05), Vec3(-0.06, 0.04, 0.01)}) {
      const Vec3 tool_mm = arm.origin_mm + 1000.0 * travel * (arm.turn * tip_m);
      expectNear(place.toRoom_m(tool_mm), left.position + left.orientation * tip_m, 1e-12, "a tip");
    }
    EXPECT_NEAR(apart_mm(place, left, arm), 0.0, 1e-9);
    // The other arm stands 3 mm from where its tool is seen then.
    ArmInPatient other = arm;
    other.origin_mm += Vec3(60.0, 0.0, 0.0);
    Pose right = left;
    right.position = place.toRoom_m(other.origin_mm) + Vec3(0.0, 0.003, 0.0);
    EXPECT_NEAR(apart_mm(place, right, other), 3.0, 1e-9);
  }
}

TEST(Registration, FindsWhereAnArmStandsFromThreeMarksAndSaysHowWell) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const Quat turn = glm::normalize(Quat(any(random), any(random), any(random), any(random)));
    const Vec3 at(any(random), any(random), any(random));
    const std::vector<Vec3> device{{0.0, 0.0, 0.0}, {0.1, 0.0, 0.02}, {0.03, 0.08, -0.01}};
    std::vector<Vec3> room;
    for (const Vec3& mark : device) room.push_back(at + turn * mark);
    const auto found = registerArm(device, room);
    ASSERT_TRUE(found);
    EXPECT_LT(found->error_mm, 1e-6);
    for (const Vec3& mark : device) {
      expectNear(found->room_from_device_m.position + found->room_from_device_m.orientation * mark,
                 at + turn * mark, 1e-9, "a mark");
    }
    room[1] += turn * (0.006 * glm::normalize(device[1]));  // farther from the first
    const auto less = registerArm(device, room);
    ASSERT_TRUE(less);
    EXPECT_GT(less->marks_mm, 1.5);
    EXPECT_LT(less->marks_mm, 6.0 / std::sqrt(3.0)) << "no fit is worse than leaving it as it was";
  }
}

// As often as a person may touch three marks.
TEST(Registration, SaysHowWrongAPlaceTenCentimetresOffIsOnTheWhole) {
  std::mt19937 random(5);
  std::normal_distribution<double> off_m(0.0, 0.002), any;
  const std::vector<Vec3> marks{{-0.04, 0.0, 0.023}, {0.04, 0.0, 0.023}, {0.0, 0.0, -0.046}};
  double said = 0.0, was = 0.0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Vec3> touched;
    for (const Vec3& mark : marks)
      touched.push_back(mark + Vec3(off_m(random), off_m(random), off_m(random)));
    const auto found = registerArm(touched, marks);
    ASSERT_TRUE(found);
    const Vec3 place_m = 0.1 * glm::normalize(Vec3(any(random), any(random), any(random)));
    const Pose& pose = found->room_from_device_m;
    const double error_mm =
        1e3 * glm::distance(pose.position + pose.orientation * place_m, place_m);
    said += found->error_mm * found->error_mm / kTrials;
    was += error_mm * error_mm / kTrials;
  }
  EXPECT_NEAR(std::sqrt(said), std::sqrt(was), 0.1 * std::sqrt(was));
  EXPECT_GT(std::sqrt(was), 4.0);
}

TEST(RoomPlace, TheHeadLooksBetweenItsEyes) {
  Eyes eyes = eyesAt({{0.0, 1.0, 0.0}, Quat(1, 0, 0, 0)});
  eyes[0].pose.orientation = glm::angleAxis(0.09, Vec3(0, 1, 0));  // displays turned outwards
  eyes[1].pose.orientation = glm::angleAxis(-0.09, Vec3(0, 1, 0));
  const RoomPlace place = before(eyes, {}, 0.4, -0.2);
  EXPECT_NEAR(place.toRoom_m(Vec3(0.0)).x, 0.0, 1e-12);
}

TEST(RoomPlace, ASecondArmThatIsTurnedIsFoundToBeApart) {
  const ArmInPatient arm{{12.0, -40.0, 80.0}, Quat(1, 0, 0, 0), 1.0};
  const RoomPlace place = where({}, arm);
  EXPECT_NEAR(apart_mm(place, {Vec3(0.0), glm::angleAxis(glm::radians(15.0), Vec3(0, 1, 0))}, arm),
              2.0 * 80.0 * std::sin(glm::radians(7.5)), 1e-9);
}

TEST(Registration, RefusesMarksThatSayNothing) {
  const std::vector<Vec3> good{{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.1, 0.0}};
  const std::vector<Vec3> line{{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.2, 0.0, 0.0}};
  std::vector<Vec3> no_number = good;
  no_number[2].y = std::nan("");
  EXPECT_EQ(registerArm(std::span(good).first(2), std::span(good).first(2)).error().code.str(),
            "TOO_FEW_MARKS");
  for (const auto& bad : {line, no_number, std::vector<Vec3>(3, Vec3(0.1))}) {
    EXPECT_EQ(registerArm(bad, good).error().code.str(), "BAD_MARKS");
    EXPECT_EQ(registerArm(good, bad).error().code.str(), "BAD_MARKS");
  }
}

}  // namespace
}  // namespace trephine
