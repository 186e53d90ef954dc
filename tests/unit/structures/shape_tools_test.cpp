#include "structures/shape_tools.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "structures/edit_history.h"
#include "support.h"

namespace trephine {
namespace {

// An oblique grid of voxels that are longer along k.
GridGeometry obliqueGrid(const Index3& size = {60, 50, 30}) {
  GridGeometry g;
  g.size = size;
  g.spacing_mm = {0.7, 0.9, 2.0};
  const double c = std::cos(0.4), s = std::sin(0.4);
  g.direction = Mat3(Vec3(c, s, 0), Vec3(-s, c, 0), Vec3(0, 0, 1));
  g.origin_mm = {-20.0, 5.0, 100.0};
  return g;
}

LabelMap emptyMap(const GridGeometry& g) {
  return {g, std::vector<std::uint8_t>(g.voxelCount())};
}

Vec3 placeOf(const GridGeometry& g, std::size_t voxel) {
  const Index3 at = g.indicesOf(voxel);
  return g.toPatient_mm(Vec3(at[0], at[1], at[2]));
}

// Sets the label where inside(patient mm) says.
template <class Inside>
void paint(LabelMap& map, int label, const Inside& inside) {
  for (std::size_t n = 0; n < map.labels.size(); ++n) {
    if (inside(placeOf(map.geometry, n))) map.labels[n] = std::uint8_t(label);
  }
}

std::size_t countOf(const LabelMap& map, int label) {
  return std::size_t(std::count(map.labels.begin(), map.labels.end(), std::uint8_t(label)));
}

double toSegment_mm(const Vec3& at, const Vec3& from, const Vec3& to) {
  const Vec3 d = to - from;
  const double length2 = glm::dot(d, d);
  const double part = length2 > 0.0 ? std::clamp(glm::dot(at - from, d) / length2, 0.0, 1.0) : 0.0;
  return glm::length(at - from - part * d);
}

// Applies it, after checks of what holds of every edit.
LabelMap applied(const LabelMap& map, const Result<LabelEdit>& edit) {
  EXPECT_TRUE(edit) << edit.error().sentence();
  if (!edit) return map;
  LabelMap after = map;
  apply(after, *edit);
  std::size_t voxels = 0, changed = 0;
  std::uint64_t end = 0;
  for (const LabelEdit::Run& run : edit->runs) {
    EXPECT_GE(run.first, end);
    end = run.first + run.count;
    voxels += run.count;
  }
  Index3 low = map.geometry.size, high{0, 0, 0};
  for (std::size_t n = 0; n < map.labels.size(); ++n) {
    if (after.labels[n] == map.labels[n]) continue;
    ++changed;
    const Index3 at = map.geometry.indicesOf(n);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], at[axis]);
      high[axis] = std::max(high[axis], at[axis] + 1);
    }
  }
  EXPECT_EQ(edit->voxels, voxels);
  EXPECT_EQ(changed, voxels);
  if (changed) {
    EXPECT_EQ(edit->box.low, low);
    EXPECT_EQ(edit->box.high, high);
  }
  LabelMap back = after;
  undo(back, *edit);
  EXPECT_EQ(back.labels, map.labels);
  return after;
}

TEST(Brush, CoversWhatLiesWithinItsRadiusOfThePathInMillimetres) {
  const LabelMap map = emptyMap(obliqueGrid());
  const GridGeometry& g = map.geometry;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-0.1, 1.1);
  for (int turn = 0; turn < 12; ++turn) {
    std::vector<Vec3> path;
    for (int n = 0; n < 1 + turn % 5; ++n) {
      path.push_back(g.toPatient_mm(
          Vec3(part(random) * g.size[0], part(random) * g.size[1], part(random) * g.size[2])));
    }
    // Along rows, along columns and on the spot, too.
    if (turn == 4) path[1] = path[0] + 10.0 * g.direction[0];
    if (turn == 9) path[1] = path[0] + 10.0 * g.direction[1];
    if (turn == 7) path[1] = path[0];
    Brush brush;
    brush.radius_mm = 1.5 + turn;
    const LabelMap after = applied(map, brushEdit(map, 3, path, brush));
    for (std::size_t n = 0; n < map.labels.size(); ++n) {
      double mm = glm::length(placeOf(g, n) - path[0]);
      for (std::size_t at = 0; at + 1 < path.size(); ++at) {
        mm = std::min(mm, toSegment_mm(placeOf(g, n), path[at], path[at + 1]));
      }
      if (std::abs(mm - brush.radius_mm) < 1e-6) continue;
      ASSERT_EQ(after.labels[n] == 3, mm < brush.radius_mm) << turn << ": " << mm;
    }
  }
}

TEST(Brush, AsADiscStaysInItsSlice) {
  const LabelMap map = emptyMap(obliqueGrid());
  const GridGeometry& g = map.geometry;
  for (int across = 0; across < 3; ++across) {
    Brush brush;
    brush.shape = Brush::Shape::disc;
    brush.across = across;
    brush.radius_mm = 4.0;
    Vec3 from(20, 20, 12), to(32, 27, 17);
    from[across] = 14.3;
    to[across] = 13.8;  // the same slice
    const std::vector<Vec3> path{g.toPatient_mm(from), g.toPatient_mm(to)};
    const LabelMap after = applied(map, brushEdit(map, 1, path, brush));
    from[across] = to[across] = 14.0;
    for (std::size_t n = 0; n < map.labels.size(); ++n) {
      const Index3 at = g.indicesOf(n);
      const double mm = toSegment_mm(placeOf(g, n), g.toPatient_mm(from), g.toPatient_mm(to));
      if (std::abs(mm - 4.0) < 1e-6) continue;
      ASSERT_EQ(after.labels[n] == 1, at[std::size_t(across)] == 14 && mm < 4.0) << across;
    }
  }
}

TEST(Brush, LeavesOtherStructuresAloneUnlessItMayTakeThem) {
  LabelMap map = emptyMap(obliqueGrid());
  const Vec3 middle = map.geometry.centre_mm();
  paint(map, 7, [&](const Vec3& at) { return at.x < middle.x; });
  paint(map, 8, [&](const Vec3& at) { return at.z < middle.z - 3.0; });
  Brush brush;
  brush.radius_mm = 8.0;
  const std::vector<Vec3> path{middle};
  LabelMap after = applied(map, brushEdit(map, 2, path, brush));
  EXPECT_EQ(countOf(after, 7), countOf(map, 7));
  EXPECT_GT(countOf(after, 2), 0u);
  brush.over.set(7);
  after = applied(map, brushEdit(map, 2, path, brush));
  EXPECT_LT(countOf(after, 7), countOf(map, 7));
  EXPECT_EQ(countOf(after, 8), countOf(map, 8));
  // Erasing takes its own alone.
  brush.erase = true;
  const LabelMap erased = applied(after, brushEdit(after, 2, path, brush));
  EXPECT_EQ(countOf(erased, 2), 0u);
  EXPECT_EQ(countOf(erased, 7), countOf(after, 7));
}

TEST(Brush, TakesVoxelsOfItsRangeAlone) {
  const LabelMap map = emptyMap(obliqueGrid());
  Volume volume;
  volume.geometry = map.geometry;
  volume.hu.resize(map.labels.size());
  for (std::size_t n = 0; n < volume.hu.size(); ++n) volume.hu[n] = std::int16_t(n % 100);
  Brush brush;
  brush.hu = HuSpan{20.0, 29.0};
  const std::vector<Vec3> path{map.geometry.centre_mm()};
  const LabelMap after = applied(map, brushEdit(map, 1, path, brush, &volume));
  EXPECT_GT(countOf(after, 1), 10u);
  for (std::size_t n = 0; n < after.labels.size(); ++n) {
    if (after.labels[n]) {
      ASSERT_TRUE(volume.hu[n] >= 20 && volume.hu[n] <= 29);
    }
  }
  EXPECT_EQ(brushEdit(map, 1, path, brush).error().code.str(), "BAD_ARGUMENT");
  volume.geometry.size[0] = 3;
  EXPECT_EQ(brushEdit(map, 1, path, brush, &volume).error().code.str(), "OTHER_GRID");
}

TEST(Brush, OfAnyStrokeHoldsTheVoxelUnderIt) {
  const LabelMap map = emptyMap(obliqueGrid());
  Brush brush;
  brush.radius_mm = 0.05;
  const Vec3 between = map.geometry.toPatient_mm(Vec3(10.4, 11.4, 12.4));
  const LabelMap after = applied(map, brushEdit(map, 1, std::vector<Vec3>{between}, brush));
  EXPECT_EQ(countOf(after, 1), 1u);
  EXPECT_EQ(after.labels[map.geometry.indexOf(10, 11, 12)], 1);
  // Far outside nothing is there to be taken.
  for (const Vec3& far : {Vec3(1e6), Vec3(1e300), Vec3(-1e300, 0, 0)}) {
    const auto none = brushEdit(map, 1, std::vector<Vec3>{far}, brush);
    ASSERT_TRUE(none);
    EXPECT_TRUE(none->empty());
  }
}

TEST(Brush, RefusesWhatCannotBeMeant) {
  const LabelMap map = emptyMap(obliqueGrid());
  const std::vector<Vec3> path{map.geometry.centre_mm()};
  const auto code = [&](int label, double radius_mm, int across, const Vec3& at) {
    Brush brush;
    brush.radius_mm = radius_mm;
    brush.across = across;
    const auto edit = brushEdit(map, label, std::vector<Vec3>{at}, brush);
    return edit ? std::string() : edit.error().code.str();
  };
  EXPECT_EQ(code(1, 5.0, 2, path[0]), "");
  EXPECT_EQ(code(0, 5.0, 2, path[0]), "BAD_ARGUMENT");
  EXPECT_EQ(code(256, 5.0, 2, path[0]), "BAD_ARGUMENT");
  EXPECT_EQ(code(1, std::nan(""), 2, path[0]), "BAD_ARGUMENT");
  EXPECT_EQ(code(1, 500.0, 2, path[0]), "BAD_ARGUMENT");
  EXPECT_EQ(code(1, 5.0, 3, path[0]), "BAD_ARGUMENT");
  EXPECT_EQ(code(1, 5.0, 2, Vec3(std::nan(""))), "BAD_ARGUMENT");
  LabelMap broken = map;
  broken.labels.pop_back();
  EXPECT_EQ(brushEdit(broken, 1, path, Brush()).error().code.str(), "BAD_ARGUMENT");
}

// A ball of label 1, 12 mm in radius, at the middle, with a hollow that a second structure fills in
// part.
LabelMap hollowBall() {
  LabelMap map = emptyMap(obliqueGrid());
  const Vec3 middle = map.geometry.centre_mm();
  paint(map, 1, [&](const Vec3& at) { return glm::length(at - middle) < 12.0; });
  paint(map, 0, [&](const Vec3& at) { return glm::length(at - middle) < 6.0; });
  paint(map, 5, [&](const Vec3& at) { return glm::length(at - middle) < 3.0; });
  return map;
}

TEST(Holes, AreFilledAndOtherStructuresInThemStay) {
  const LabelMap map = hollowBall();
  const Vec3 middle = map.geometry.centre_mm();
  const LabelMap after = applied(map, holesEdit(map, 1));
  for (std::size_t n = 0; n < map.labels.size(); ++n) {
    const double mm = glm::length(placeOf(map.geometry, n) - middle);
    ASSERT_EQ(after.labels[n], mm < 3.0 ? 5 : mm < 12.0 ? 1 : 0);
  }
  Labels over;
  over.set(5);
  EXPECT_EQ(countOf(applied(map, holesEdit(map, 1, std::nullopt, over)), 5), 0u);
}

TEST(Holes, ThatAreOpenInSpaceAreFilledSliceBySlice) {
  // A tube along each axis: closed in the slices across it alone.
  for (int axis = 0; axis < 3; ++axis) {
    LabelMap map = emptyMap(obliqueGrid());
    const GridGeometry& g = map.geometry;
    for (std::size_t n = 0; n < map.labels.size(); ++n) {
      const Index3 at = g.indicesOf(n);
      const int b = at[std::size_t((axis + 1) % 3)], c = at[std::size_t((axis + 2) % 3)];
      const int most = std::max(std::abs(b - 12), std::abs(c - 14));
      map.labels[n] = most <= 5 && most >= 3;
    }
    EXPECT_TRUE(holesEdit(map, 1)->empty());
    for (int across = 0; across < 3; ++across) {
      const auto edit = holesEdit(map, 1, across);
      applied(map, edit);
      EXPECT_EQ(edit->voxels, across == axis ? std::size_t(25 * g.size[std::size_t(axis)]) : 0u);
    }
  }
}

TEST(Smoothing, RoundsOffAndKeepsTheVolume) {
  LabelMap map = emptyMap(obliqueGrid());
  const Vec3 middle = map.geometry.centre_mm();
  std::mt19937 random(5);
  const auto ball = [&](double radius_mm) {
    return [=](const Vec3& at) { return glm::length(at - middle) < radius_mm; };
  };
  paint(map, 1, ball(13.0));
  const LabelMap smooth = map;
  // Its surface is eaten at and grown upon.
  for (std::size_t n = 0; n < map.labels.size(); ++n) {
    const double mm = glm::length(placeOf(map.geometry, n) - middle);
    if (std::abs(mm - 13.0) < 2.0 && random() % 4 == 0) map.labels[n] = !map.labels[n];
  }
  const auto unlike = [&](const LabelMap& a) {
    std::size_t count = 0;
    for (std::size_t n = 0; n < a.labels.size(); ++n) count += a.labels[n] != smooth.labels[n];
    return count;
  };
  const LabelMap after = applied(map, smoothEdit(map, 1, 4.0));
  EXPECT_LT(unlike(after), unlike(map) / 2);
  EXPECT_NEAR(double(countOf(after, 1)), double(countOf(map, 1)), 0.03 * double(countOf(map, 1)));
  // What is smooth already hardly changes.
  EXPECT_LT(smoothEdit(smooth, 1, 2.0)->voxels, countOf(smooth, 1) / 25);
  // A neighbour is not eaten.
  LabelMap beside = map;
  paint(beside, 9, [&](const Vec3& at) { return at.x > middle.x; });
  EXPECT_EQ(countOf(applied(beside, smoothEdit(beside, 1, 4.0)), 9), countOf(beside, 9));
}

TEST(Pieces, OneIsKeptOrRemovedByAClick) {
  LabelMap map = emptyMap(obliqueGrid());
  const GridGeometry& g = map.geometry;
  const auto block = [&](const Index3& low, const Index3& high) {
    for (int k = low[2]; k < high[2]; ++k) {
      for (int j = low[1]; j < high[1]; ++j) {
        for (int i = low[0]; i < high[0]; ++i) map.labels[g.indexOf(i, j, k)] = 1;
      }
    }
  };
  block({5, 5, 5}, {10, 10, 10});     // 125
  block({10, 10, 10}, {12, 12, 12});  // 8, at a corner of the first
  block({30, 30, 20}, {34, 34, 24});  // 64
  map.labels[g.indexOf(50, 5, 5)] = 2;
  const Vec3 click = g.toPatient_mm(Vec3(7, 7, 7));
  EXPECT_EQ(countOf(applied(map, keepPieceEdit(map, 1, click)), 1), 125u);
  EXPECT_EQ(countOf(applied(map, keepPieceEdit(map, 1, click, Touching::corners)), 1), 133u);
  EXPECT_EQ(countOf(applied(map, removePieceEdit(map, 1, click)), 1), 72u);
  const LabelMap without = applied(map, removePieceEdit(map, 1, click, Touching::corners));
  EXPECT_EQ(countOf(without, 1), 64u);
  EXPECT_EQ(countOf(without, 2), 1u);
  // Beside it is as good as on it, farther away is not.
  EXPECT_EQ(countOf(applied(map, keepPieceEdit(map, 1, g.toPatient_mm(Vec3(36, 32, 22)))), 1), 64u);
  EXPECT_EQ(keepPieceEdit(map, 1, g.toPatient_mm(Vec3(45, 40, 5))).error().code.str(),
            "NOTHING_THERE");
  EXPECT_EQ(keepPieceEdit(map, 1, Vec3(1e9)).error().code.str(), "NOTHING_THERE");
  EXPECT_EQ(keepPieceEdit(map, 3, click).error().code.str(), "NO_STRUCTURE");
}

TEST(Shell, BecomesAStructureOfItsOwn) {
  LabelMap map = emptyMap(obliqueGrid());
  const Vec3 middle = map.geometry.centre_mm();
  paint(map, 1, [&](const Vec3& at) { return glm::length(at - middle) < 12.0; });
  const LabelMap after = applied(map, shellEdit(map, 1, 1.0, 2));
  EXPECT_GT(countOf(after, 2), 100u);
  EXPECT_EQ(countOf(after, 1) + countOf(after, 2), countOf(map, 1));
  const std::vector<std::uint8_t> layer = shellOf(map, 1, 1.0);
  for (std::size_t n = 0; n < layer.size(); ++n) ASSERT_EQ(after.labels[n] == 2, layer[n] == 1);
  // As shellOf() has it, over several slabs, with a structure inside and one that is cut off.
  LabelMap tall = emptyMap(obliqueGrid({40, 36, 90}));
  const Vec3 centre = tall.geometry.centre_mm();
  paint(tall, 1,
        [&](const Vec3& at) { return std::hypot(at.x - centre.x, at.y - centre.y) < 9.0; });
  paint(tall, 3, [&](const Vec3& at) { return glm::length(at - centre) < 8.6; });
  paint(tall, 4, [&](const Vec3& at) { return at.x > centre.x + 6.0; });
  for (const double mm : {0.5, 2.5, 5.0}) {
    const LabelMap with = applied(tall, shellEdit(tall, 1, mm, 2));
    const std::vector<std::uint8_t> expected = shellOf(tall, 1, mm);
    for (std::size_t n = 0; n < expected.size(); ++n) {
      ASSERT_EQ(with.labels[n] == 2, expected[n] == 1) << mm;
    }
  }
  Progress stopped;
  stopped.cancel();
  EXPECT_EQ(shellEdit(map, 1, 1.0, 2, stopped).error().code.str(), "CANCELLED");
  EXPECT_EQ(shellEdit(map, 1, 1.0, 1).error().code.str(), "BAD_ARGUMENT");
  EXPECT_EQ(shellEdit(map, 4, 1.0, 2).error().code.str(), "NO_STRUCTURE");
}

TEST(Growing, AndShrinkingMoveTheSurfaceByMillimetres) {
  // As high as several slabs, so that their seams are met.
  LabelMap map = emptyMap(obliqueGrid({40, 36, 90}));
  const Vec3 middle = map.geometry.centre_mm();
  paint(map, 1, [&](const Vec3& at) {
    const Vec3 d = at - middle;
    return std::hypot(d.x, d.y) < 8.0 * std::abs(std::sin(d.z / 5.0)) && std::abs(d.z) < 60.0;
  });
  paint(map, 6, [&](const Vec3& at) { return at.z > middle.z + 61.0; });
  for (const double mm : {1.0, 3.1}) {
    const LabelMap more = applied(map, growEdit(map, 1, mm));
    const LabelMap less = applied(map, shrinkEdit(map, 1, mm));
    EXPECT_EQ(countOf(more, 6), countOf(map, 6));
    const GridGeometry& g = map.geometry;
    const int reach = int(mm / 0.7) + 1;
    for (std::size_t n = 0; n < map.labels.size(); ++n) {
      const Index3 at = g.indicesOf(n);
      bool in_near = false, out_near = false;
      for (int c = -reach; c <= reach; ++c) {
        for (int b = -reach; b <= reach; ++b) {
          for (int a = -reach; a <= reach; ++a) {
            if (!g.contains(at[0] + a, at[1] + b, at[2] + c)) continue;
            if (glm::length(Vec3(a, b, c) * g.spacing_mm) > mm) continue;
            const bool in = map.labels[g.indexOf(at[0] + a, at[1] + b, at[2] + c)] == 1;
            in_near |= in;
            out_near |= !in;
          }
        }
      }
      if (map.labels[n] == 6) continue;
      ASSERT_EQ(more.labels[n] == 1, in_near);
      ASSERT_EQ(less.labels[n] == 1, map.labels[n] == 1 && !out_near);
    }
  }
}

TEST(Tools, SayWhatTheyCannotDo) {
  const LabelMap map = hollowBall();
  EXPECT_EQ(growEdit(map, 1, 0.0).error().code.str(), "BAD_ARGUMENT");
  EXPECT_EQ(shrinkEdit(map, 1, 21.0).error().code.str(), "BAD_ARGUMENT");
  EXPECT_EQ(smoothEdit(map, 1, std::nan("")).error().code.str(), "BAD_ARGUMENT");
  EXPECT_EQ(holesEdit(map, 1, 3).error().code.str(), "BAD_ARGUMENT");
  EXPECT_EQ(holesEdit(map, 77).error().code.str(), "NO_STRUCTURE");
  EXPECT_EQ(smoothEdit(map, 77, 2.0).error().code.str(), "NO_STRUCTURE");
  EXPECT_EQ(growEdit(map, 77, 2.0).error().code.str(), "NO_STRUCTURE");
  Progress stopped;
  stopped.cancel();
  EXPECT_EQ(holesEdit(map, 1, std::nullopt, {}, stopped).error().code.str(), "CANCELLED");
  EXPECT_EQ(smoothEdit(map, 1, 2.0, {}, stopped).error().code.str(), "CANCELLED");
  EXPECT_EQ(growEdit(map, 1, 2.0, {}, stopped).error().code.str(), "CANCELLED");
  EXPECT_EQ(shrinkEdit(map, 1, 2.0, stopped).error().code.str(), "CANCELLED");
}

TEST(Tools, WorkOnScansThatAreHardlyAny) {
  for (const Index3& size : {Index3{1, 1, 1}, Index3{9, 1, 1}, Index3{1, 9, 5}}) {
    GridGeometry g;
    g.size = size;
    LabelMap map = emptyMap(g);
    const LabelMap after = applied(map, brushEdit(map, 1, std::vector<Vec3>{Vec3(0.0)}, Brush()));
    EXPECT_GT(countOf(after, 1), 0u);
    for (const auto& edit :
         {holesEdit(after, 1), smoothEdit(after, 1, 2.0), growEdit(after, 1, 2.0),
          shrinkEdit(after, 1, 2.0), keepPieceEdit(after, 1, Vec3(0.0))}) {
      applied(after, edit);
    }
  }
}

TEST(History, GoesBackAndForthExactly) {
  LabelMap map = hollowBall();
  EditHistory history;
  std::mt19937 random(11);
  std::vector<std::vector<std::uint8_t>> states{map.labels};
  const auto stroke = [&](int label) {
    std::vector<Vec3> path;
    for (int n = 0; n < 3; ++n) path.push_back(placeOf(map.geometry, random() % map.labels.size()));
    Brush brush;
    brush.radius_mm = 6.0;
    brush.over.set();
    brush.erase = label == 0;
    return *brushEdit(map, label ? label : 1, path, brush);
  };
  for (int step = 0; step < 20; ++step) {
    for (int part = 0; part < 3; ++part) {  // a stroke of three pieces is one step
      LabelEdit edit = stroke((step + part) % 4);
      apply(map, edit);
      history.add("step " + std::to_string(step), std::move(edit), part > 0);
    }
    states.push_back(map.labels);
  }
  ASSERT_EQ(history.steps(), 20u);
  for (int turn = 0; turn < 2; ++turn) {
    for (std::size_t n = 20; n-- > 0;) {
      ASSERT_EQ(*history.toUndo(), "step " + std::to_string(n));
      ASSERT_TRUE(history.undo(map));
      ASSERT_EQ(map.labels, states[n]);
    }
    EXPECT_EQ(history.toUndo(), nullptr);
    EXPECT_FALSE(history.undo(map));
    for (std::size_t n = 1; n <= 20; ++n) {
      ASSERT_EQ(*history.toRedo(), "step " + std::to_string(n - 1));
      const auto box = history.redo(map);
      ASSERT_TRUE(box);
      ASSERT_EQ(map.labels, states[n]);
    }
    EXPECT_FALSE(history.redo(map));
  }
  // Something new ends what could be redone.
  history.undo(map);
  LabelEdit edit = stroke(9);
  apply(map, edit);
  history.add("new", std::move(edit));
  EXPECT_EQ(history.toRedo(), nullptr);
  EXPECT_EQ(*history.toUndo(), "new");
  EXPECT_EQ(history.steps(), 20u);
  EXPECT_EQ(history.dropped(), 0u);
}

TEST(History, DropsTheOldestBeyondItsCapAndSaysSo) {
  LabelMap map = emptyMap(obliqueGrid());
  EditHistory history(20000);
  std::vector<std::vector<std::uint8_t>> states{map.labels};
  Brush brush;
  for (int step = 0; step < 60; ++step) {
    brush.erase = step % 2;
    LabelEdit edit = *brushEdit(map, 1, std::vector<Vec3>{map.geometry.centre_mm()}, brush);
    apply(map, edit);
    history.add("brush", std::move(edit));
    states.push_back(map.labels);
    ASSERT_LE(history.bytes(), 20000u);
  }
  EXPECT_GT(history.dropped(), 0u);
  EXPECT_GT(history.steps(), 2u);
  EXPECT_EQ(history.steps() + history.dropped(), 60u);
  std::size_t at = 60;
  while (history.undo(map)) ASSERT_EQ(map.labels, states[--at]);
  EXPECT_EQ(at, history.dropped());
  // What alone is larger leaves nothing to undo, and an edit of nothing is no step.
  EditHistory small(100);
  LabelEdit edit = *brushEdit(states.empty() ? map : emptyMap(map.geometry), 1,
                              std::vector<Vec3>{map.geometry.centre_mm()}, Brush());
  small.add("brush", std::move(edit));
  EXPECT_EQ(small.steps(), 0u);
  EXPECT_EQ(small.dropped(), 1u);
  EXPECT_EQ(small.bytes(), 0u);
  small.add("nothing", LabelEdit());
  EXPECT_EQ(small.steps(), 0u);
  small.clear();
  EXPECT_EQ(small.dropped(), 0u);
}

}  // namespace
}  // namespace trephine
