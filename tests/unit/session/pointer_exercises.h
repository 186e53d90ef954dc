// The five shipped exercises as a person does them with the pointer, and how one sees that they are
// finished. For the session alone and for the real window.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "haptics/haptic_types.h"
#include "session/session.h"
#include "unit/session/pointer_user.h"

namespace trephine::test {

struct PointerTask {
  std::string name;
  std::vector<std::vector<Pointed>> arms;  // the exercise's order
};

// A push goes in, at the arm, of which its friction takes 0.26 N; then a touch of it holds the
// depth while the pointer goes round; a tool comes out before it goes aside, or it cuts as much of
// that as it was late. A blade cuts what lies within some 0.65 mm of it, and rows of voxels are 0.8
// mm apart: the sides of the windows lie between two rows, 0.3 to 0.5 mm from each, which are then
// both cut, and no other by a hand that is a little aside.
inline const PointerTask kBurrHole{"burr-hole",
                                   {{{0, 20, 20, 0},
                                     {0.5, 0, 0, 0},
                                     {1.0, 0, 0, 2.5},
                                     {5.5, 0, 0, 0},
                                     {6.5, 0, 0, 0},
                                     {7.0, 20, 0, 0}}}};
inline const PointerTask kWindowOneArm{"cranium-one-arm",
                                       {{{0, -30, -8.55, 0},
                                         {0.5, -8.05, -8.55, 0},
                                         {1.0, -8.05, -8.55, 2.0},
                                         {3.0, -8.05, -8.55, 0.1},
                                         {5.0, 7.95, -8.55, 0.1},
                                         {7.0, 7.95, 8.25, 0.1},
                                         {9.0, -8.05, 8.25, 0.1},
                                         {11.0, -8.05, -8.55, 0.1},
                                         {12.5, -8.05, -8.55, 0},
                                         {13.5, -8.05, -8.55, 0},
                                         {14.5, -30, -8.55, 0}}}};
inline const std::vector<Pointed> kLeftHalf{
    {0, -30, -9.35, 0},        {0.5, 1, -9.35, 0},       {1.0, 1, -9.35, 2.0}, {3.0, 1, -9.35, 0.1},
    {5.0, -14.45, -9.35, 0.1}, {7.5, -14.45, 9.85, 0.1}, {9.5, 1, 9.85, 0.1},  {10.5, 1, 9.85, 0},
    {11.5, 1, 9.85, 0},        {12.5, -30, 9.85, 0}};
inline std::vector<Pointed> otherSide(std::vector<Pointed> path) {
  for (Pointed& at : path) at.x_mm = -at.x_mm;
  return path;
}
inline const PointerTask kWindow{"cranium", {kLeftHalf, otherSide(kLeftHalf)}};
inline const std::vector<Pointed> kSlice{
    {0, 8, -60, 0},      {0.5, 8, -42, 0},   {1.0, 8, -42, 1.25}, {2.2, 8, -42, 0.45},
    {9.0, 40, -42, 0.45}, {10.0, 40, -42, 0}, {11.5, 40, -60, 0}};
inline const PointerTask kLiverOneArm{"liver-one-arm", {kSlice}};
inline const PointerTask kLiver{"liver",
                                {{{0, -5, -60, 0},
                                  {0.5, -5, -48, 0},
                                  {1.0, -5, -48, 1.8},
                                  {5.0, -5, -48, 0},
                                  {11.5, -5, -48, 0}},
                                 kSlice}};

// What was made of a case.
struct Cut {
  LandmarkFrame frame;
  HapticParameters parameters;
  std::shared_ptr<const Grid> carved;
  std::map<std::string, double> of_mm3;  // by tissue
  std::vector<double> deepest_mm;        // of each arm's tool, in the landmark's axes
  double of(const std::string& tissue) const {
    const auto found = of_mm3.find(tissue);
    return found == of_mm3.end() ? 0.0 : found->second;
  }
};

// Whether no bone is left in a column of the vault there.
inline bool isOpen(const Cut& cut, double x_mm, double y_mm) {
  const Mat4 to_voxel = cut.carved->geometry().patientToVoxel();
  for (double z_mm = 6.0; z_mm > -12.0; z_mm -= 0.2) {
    const Vec3 v =
        glm::round(Vec3(to_voxel * glm::dvec4(cut.frame.toPatient_mm({x_mm, y_mm, z_mm}), 1.0)));
    const int c = classify(cut.parameters.tissues, cut.carved->hu(int(v.x), int(v.y), int(v.z)), 0);
    if (c >= 0 && cut.parameters.tissues.classes[std::size_t(c)].solid) return false;
  }
  return true;
}

// Along a side of a window, near where the pointer went.
inline bool isCutThrough(const Cut& cut, const Vec3& from_mm, const Vec3& to_mm) {
  const double length_mm = glm::distance(from_mm, to_mm);
  const Vec3 along = (to_mm - from_mm) / length_mm;
  for (double s_mm = 3.0; s_mm < length_mm - 3.0; s_mm += 1.0) {
    bool open = false;
    for (double aside_mm = -1.5; aside_mm <= 1.5; aside_mm += 0.25) {
      const Vec3 at_mm = from_mm + s_mm * along + aside_mm * Vec3(-along.y, along.x, 0.0);
      open = open || isOpen(cut, at_mm.x, at_mm.y);
    }
    if (!open) return false;
  }
  return true;
}

// What is not as the exercise's card asks for; nothing where it is finished.
inline std::vector<std::string> missing(const PointerTask& task, const Cut& cut) {
  std::vector<std::string> words;
  const auto need = [&](bool there, const std::string& what) {
    if (!there) words.push_back(task.name + ": " + what);
  };
  const auto needWindow = [&](double x_mm, double y_mm) {
    need(isCutThrough(cut, {-x_mm, -y_mm, 0}, {x_mm, -y_mm, 0}), "the window's low side");
    need(isCutThrough(cut, {x_mm, -y_mm, 0}, {x_mm, y_mm, 0}), "the window's right side");
    need(isCutThrough(cut, {x_mm, y_mm, 0}, {-x_mm, y_mm, 0}), "the window's high side");
    need(isCutThrough(cut, {-x_mm, y_mm, 0}, {-x_mm, -y_mm, 0}), "the window's left side");
  };
  if (task.name == "burr-hole") {
    need(isOpen(cut, 0.0, 0.0), "the hole");
    need(cut.deepest_mm[0] < -9.0, "the brain's side");
    need(cut.of("bone") > 150.0, "its size");
  } else if (task.name == "cranium-one-arm") {
    needWindow(9.0, 9.0);
  } else if (task.name == "cranium") {
    needWindow(15.0, 10.0);
  } else {
    // As wide as a voxel, some 3 cm long and about 1 cm deep: deeper than that a hand cannot draw
    // it.
    need(cut.of("liver") + cut.of("capsule") > 150.0, "the slice");
    need(cut.of("bone") == 0.0, "whole bone");
    need(cut.deepest_mm.back() < -5.0, "the blade's depth");
    if (cut.deepest_mm.size() > 1) need(cut.deepest_mm[0] < -30.0, "the needle's target");
  }
  return words;
}

}  // namespace trephine::test
