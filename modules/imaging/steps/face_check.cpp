#include "imaging/steps/face_check.h"

#include <algorithm>
#include <cmath>

#include "imaging/steps/detail/coarse_parts.h"
#include "imaging/steps/face.h"

namespace trephine {

namespace {

// How far two eyes, and the tip of the nose and the middle between them, lie apart: children's and
// adults', with some room.
constexpr double kEyesLeast_mm = 38.0, kEyesApart_mm = 62.0, kEyesMost_mm = 85.0;
// What of an eye and its lids, of a nose or of lips makes a person known.
constexpr double kEye_mm = 12.0, kNoseReach_mm = 18.0;
constexpr double kLids_mm = 9.0;  // in front of the eye's middle
constexpr double kSharpNose = 0.30;
constexpr double kNoseLeast_mm = 25.0, kNoseMost_mm = 75.0;

// Cells around a place, from the outermost in: what is unlike the whole is met early.
struct Near {
  int a, b, s;
  std::ptrdiff_t step;
  Vec3 mm;  // along the grid's axes a, b, s
};
std::vector<Near> shell(const CoarseGrid& grid, double from_mm, double to_mm, int every = 1) {
  std::vector<Near> found;
  const Vec3& mm = grid.cell_mm;
  const auto reach = [&](int axis) { return int(to_mm / mm[axis]) / every * every; };
  for (int s = -reach(2); s <= reach(2); s += every) {
    for (int b = -reach(1); b <= reach(1); b += every) {
      for (int a = -reach(0); a <= reach(0); a += every) {
        const Vec3 at = Vec3(a, b, s) * mm;
        const double r = glm::length(at);
        if (r < from_mm || r > to_mm) continue;
        found.push_back({a, b, s, (std::ptrdiff_t(s) * grid.size[1] + b) * grid.size[0] + a, at});
      }
    }
  }
  std::ranges::stable_sort(found, std::ranges::greater(),
                           [](const Near& near) { return glm::dot(near.mm, near.mm); });
  return found;
}

struct Cell {
  int a, b, s;
};

// A tip of skin, and how much of a ball of 20 mm around it is not air.
struct NoseTip {
  Vec3 place;
  double solid;
};

class MarkSearch {
 public:
  explicit MarkSearch(const CoarseGrid& grid) : grid_(grid) {}

  // The middles of all that looks like an eyeball, the surest first.
  std::vector<Vec3> eyes() const {
    struct Group {
      Vec3 sum{0.0};
      double cells = 0.0;
      Vec3 middle() const { return sum / cells; }
    };
    std::vector<Group> groups;
    const std::vector<Near> ball = shell(grid_, 0.0, 6.5), around = shell(grid_, 13.0, 20.0, 2);
    const CoarseCells near_air = nearAir(20.0), enclosed = enclosedAir(grid_, kSkinHu);
    forCells([&](const Cell& cell) {
      const std::size_t n = grid_.indexOf(cell.a, cell.b, cell.s);
      if (!near_air[n] || !isEye(cell, ball, around, enclosed)) return;
      const Vec3 p = place(cell);
      for (Group& group : groups) {
        if (glm::distance(group.middle(), p) > 12.0) continue;
        group.sum += p;
        ++group.cells;
        return;
      }
      groups.push_back({p, 1.0});
    });
    std::ranges::stable_sort(groups, std::ranges::greater(), &Group::cells);
    std::vector<Vec3> found;
    for (const Group& group : groups) {
      if (group.cells >= 3.0) found.push_back(group.middle());
    }
    return found;
  }

  // Tips that may be a nose's, the sharpest first.
  std::vector<NoseTip> noses() const {
    struct Tip {
      Cell cell;
      double solid;
    };
    const std::vector<Near> ball = shell(grid_, 0.0, 20.0, 2), around = shell(grid_, 0.0, 50.0, 2);
    std::vector<Tip> tips;
    forCells([&](const Cell& cell) {
      if (!isSkin(cell)) return;
      int matter = 0;
      for (const Near& near : ball) matter += !holds(cell, near) || isMatter(at(cell, near));
      const double solid = double(matter) / double(ball.size());
      if (solid < kSharpestNose || solid > kBluntestNose) return;
      tips.push_back({cell, solid});
    });
    std::ranges::stable_sort(tips, {}, &Tip::solid);
    const CoarseCells enclosed = enclosedAir(grid_, kSkinHu);
    const double mL = 8.0 * grid_.cell_mm[0] * grid_.cell_mm[1] * grid_.cell_mm[2] / 1000.0;
    std::vector<Vec3> looked;
    std::vector<NoseTip> found;
    for (const Tip& tip : tips) {
      const Vec3 p = place(tip.cell);
      const auto same = [&](const Vec3& other) { return glm::distance(other, p) < 18.0; };
      if (std::ranges::any_of(looked, same)) continue;
      looked.push_back(p);
      double bone = 0, air = 0, matter = 0, left = 0, right = 0;
      for (const Near& near : around) {
        if (!holds(tip.cell, near)) continue;
        const std::size_t n = at(tip.cell, near);
        air += enclosed[n];
        if (!isMatter(n)) continue;
        ++matter;
        bone += grid_.mean[n] > kBoneMeanHu;
        const double x = toLeft(near.mm);
        left += x > 10.0;
        right += x < -10.0;
      }
      const double less = std::min(left, right), more = std::max(left, right);
      const bool between = less > 0.25 * more && less * mL > kLeastBeside_mL;
      if (between && bone > 0.12 * matter && air * mL > kLeastAir_mL && air * mL < kMostAir_mL) {
        found.push_back({p, tip.solid});
      }
    }
    return found;
  }

  // From `place`, which way is out of the head: from the middle of the matter around it, within the
  // plane that `across` stands on.
  Vec3 outwards(const Vec3& place_mm, double radius_mm, const Vec3& across) const {
    const Index3 middle = grid_.cellAt(place_mm);
    Vec3 sum(0.0);
    for (const Near& near : shell(grid_, 0.0, radius_mm, 2)) {
      const Cell cell{middle[0], middle[1], middle[2]};
      if (holds(cell, near) && isMatter(at(cell, near))) sum += near.mm;
    }
    Vec3 out(0.0);
    for (int n = 0; n < 3; ++n) out -= grid_.voxels.direction[grid_.axis[std::size_t(n)]] * sum[n];
    out -= across * glm::dot(out, across);
    if (glm::dot(out, out) > 0.0) return glm::normalize(out);
    return glm::normalize(
        glm::cross(across, std::abs(across.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0)));
  }

  // `place` where there is skin or flesh around it, nothing where it is beyond the scan or in air.
  std::optional<Vec3> matterAt(const Vec3& place_mm) const {
    const Index3 middle = grid_.cellAt(place_mm);
    const std::vector<Near> ball = shell(grid_, 0.0, kNoseReach_mm);
    int matter = 0;
    for (const Near& near : ball) {
      const Cell cell{middle[0], middle[1], middle[2]};
      matter += holds(cell, near) && isMatter(at(cell, near));
    }
    return 5 * matter > int(ball.size()) ? std::optional(place_mm) : std::nullopt;
  }

 private:
  // Of a ball of 20 mm around a tip the nose fills this much; within 50 mm there are its cavities
  // and head on both sides.
  static constexpr double kSharpestNose = 0.08, kBluntestNose = 0.38;
  static constexpr double kLeastAir_mL = 4.0, kMostAir_mL = 90.0, kLeastBeside_mL = 8.0;

  template <class Work>
  void forCells(const Work& work) const {
    for (int s = 0; s < grid_.size[2]; ++s) {
      for (int b = 0; b < grid_.size[1]; ++b) {
        for (int a = 0; a < grid_.size[0]; ++a) work(Cell{a, b, s});
      }
    }
  }
  bool holds(const Cell& cell, const Near& near) const {
    return grid_.holds(cell.a + near.a, cell.b + near.b, cell.s + near.s);
  }
  std::size_t at(const Cell& cell, const Near& near) const {
    return std::size_t(std::ptrdiff_t(grid_.indexOf(cell.a, cell.b, cell.s)) + near.step);
  }
  bool isMatter(std::size_t n) const { return grid_.mean[n] > kSkinHu; }
  Vec3 place(const Cell& cell) const { return grid_.place_mm(cell.a, cell.b, cell.s); }
  double toLeft(const Vec3& mm) const {
    double x = 0.0;
    for (int n = 0; n < 3; ++n) {
      x += grid_.voxels.direction[grid_.axis[std::size_t(n)]].x * mm[n];
    }
    return x;
  }

  bool isSkin(const Cell& cell) const {
    if (!isMatter(grid_.indexOf(cell.a, cell.b, cell.s))) return false;
    const auto isAir = [&](int a, int b, int s) {
      const Near near{a, b, s, (std::ptrdiff_t(s) * grid_.size[1] + b) * grid_.size[0] + a, {}};
      return holds(cell, near) && !isMatter(at(cell, near));
    };
    return isAir(-1, 0, 0) || isAir(1, 0, 0) || isAir(0, -1, 0) || isAir(0, 1, 0) ||
           isAir(0, 0, -1) || isAir(0, 0, 1);
  }

  CoarseCells nearAir(double mm) const {
    CoarseCells cells(grid_.count());
    std::ranges::transform(grid_.mean, cells.begin(), [](int hu) { return hu < kSkinHu; });
    for (double reached = 0.0; reached < mm; reached += grid_.cell_mm[0]) {
      dilate(grid_.size, cells);
    }
    return cells;
  }

  // An even ball of water HU; beside it some fat and bone, air that is open to the outside, and
  // little flesh: the wall of a belly has as much flesh as fat (0.4 and more, eyes under 0.2).
  bool isEye(const Cell& cell, const std::vector<Near>& ball, const std::vector<Near>& around,
             const CoarseCells& enclosed) const {
    constexpr int kWaterLow = -40, kWaterHigh = 90, kFatLow = -200, kFatHigh = -25;
    constexpr double kMeanLow = -15.0, kMeanHigh = 34.0, kUneven = 30.0;
    const int own = grid_.mean[grid_.indexOf(cell.a, cell.b, cell.s)];
    if (own < kWaterLow || own > kWaterHigh) return false;
    double sum = 0.0, squares = 0.0;
    int odd = 0;
    for (const Near& near : ball) {
      if (!holds(cell, near)) return false;
      const int hu = grid_.mean[at(cell, near)];
      odd += hu < kWaterLow || hu > kWaterHigh;
      if (odd * 20 > int(ball.size())) return false;
      sum += hu;
      squares += double(hu) * hu;
    }
    const double mean = sum / double(ball.size());
    const double variance = squares / double(ball.size()) - mean * mean;
    if (mean < kMeanLow || mean > kMeanHigh || variance > kUneven * kUneven) return false;
    int fat = 0, flesh = 0, open = 0, bone = 0, in = 0;
    for (const Near& near : around) {
      if (!holds(cell, near)) continue;
      const std::size_t n = at(cell, near);
      const int hu = grid_.mean[n];
      ++in;
      fat += hu > kFatLow && hu < kFatHigh;
      flesh += hu >= kFatHigh && hu < kBoneMeanHu;
      open += hu < kSkinHu && !enclosed[n];
      bone += hu > kBoneMeanHu;
    }
    return fat > 0.12 * in && flesh < 0.36 * in && open > 0.05 * in && open < 0.5 * in &&
           bone > 0.04 * in;
  }

  const CoarseGrid& grid_;
};

// The surest two that may be one person's.
std::vector<Vec3> pairOf(const std::vector<Vec3>& eyes) {
  for (std::size_t n = 1; n < eyes.size(); ++n) {
    for (std::size_t m = 0; m < n; ++m) {
      const double apart = glm::distance(eyes[n], eyes[m]);
      if (apart > kEyesLeast_mm && apart < kEyesMost_mm) return {eyes[m], eyes[n]};
    }
  }
  return {};
}

// `from`: an eye, or the middle between two.
bool isNoseNear(const Vec3& from, const Vec3& tip) {
  const double apart = glm::distance(from, tip);
  return apart > kNoseLeast_mm && apart < kNoseMost_mm;
}

// Perpendicular to both, towards the patient's front and feet: with the neck extended by up to 100
// degrees, and bent by 40.
Vec3 downOf(const Vec3& forwards, const Vec3& across) {
  const Vec3 down = glm::normalize(glm::cross(forwards, across));
  return glm::dot(down, Vec3(0, -1, -1)) < 0.0 ? -down : down;
}

// The lips below the tip of a nose, or what is behind them: how far a nose stands out before the
// lips is its own, and a head that is turned shows the way forwards by some degrees only.
std::optional<Vec3> mouthBelow(const MarkSearch& search, const Vec3& nose, const Vec3& forwards,
                               const Vec3& down, double eyes_mm) {
  for (const double behind : {0.12, 0.24, 0.36}) {
    const auto mouth = search.matterAt(nose + eyes_mm * (0.45 * down - behind * forwards));
    if (mouth) return mouth;
  }
  return std::nullopt;
}

}  // namespace

CoarseGrid faceGrid(const Volume& volume) {
  return coarseGrid(volume, {2.0, 3.0, 8'000'000});
}

FaceMarks findFaceMarks(const CoarseGrid& grid) {
  FaceMarks marks;
  if (grid.count() == 0) return marks;
  const MarkSearch search(grid);
  const std::vector<Vec3> eyes = search.eyes();
  const std::vector<NoseTip> tips = search.noses();
  marks.eyes = pairOf(eyes);
  if (marks.eyes.empty()) {
    // A sharp nose is believed alone, and one eye beside it.
    if (tips.empty() || tips.front().solid > kSharpNose) return marks;
    const Vec3 nose = tips.front().place, across(1, 0, 0);
    marks.nose = nose;
    for (const Vec3& eye : eyes) {
      if (marks.eyes.empty() && isNoseNear(eye, nose)) marks.eyes = {eye};
    }
    marks.forwards = search.outwards(nose, 40.0, across);
    const Vec3 down = downOf(marks.forwards, across);
    marks.mouth = mouthBelow(search, nose, marks.forwards, down, kEyesApart_mm);
    return marks;
  }
  const double apart = glm::distance(marks.eyes[0], marks.eyes[1]);
  const Vec3 middle = 0.5 * (marks.eyes[0] + marks.eyes[1]);
  const Vec3 across = (marks.eyes[1] - marks.eyes[0]) / apart;
  marks.forwards = search.outwards(middle, 45.0, across);
  Vec3 down = downOf(marks.forwards, across);
  // Lips and chin stand out as well: a nose lies about where the eyes expect it, whichever way is
  // down.
  const auto tip = std::ranges::find_if(tips, [&](const NoseTip& one) {
    const Vec3 from = one.place - middle;
    const double below = std::abs(glm::dot(from, down)) - 0.5 * apart;
    const double before = glm::dot(from, marks.forwards) - 0.5 * apart;
    return isNoseNear(middle, one.place) && std::abs(glm::dot(from, across)) < 15.0 &&
           std::hypot(below, before) < 0.3 * apart;
  });
  if (tip != tips.end() && glm::dot(tip->place - middle, down) < 0.0) down = -down;
  // A bandaged or cut nose is looked for where the eyes say.
  const Vec3 nose =
      tip != tips.end() ? tip->place : middle + apart * (0.5 * marks.forwards + 0.55 * down);
  marks.nose = tip != tips.end() ? nose : search.matterAt(nose);
  marks.mouth = mouthBelow(search, nose, marks.forwards, down, apart);
  return marks;
}

FaceLeft faceLeft(const FaceMarks& marks, const CoarseGrid& before, const CoarseGrid& after) {
  const auto left = [&](const Vec3& mark, double radius_mm) {
    int matter = 0, same = 0;
    const Index3 middle = before.cellAt(mark);
    for (const Near& near : shell(before, 0.0, radius_mm)) {
      const int a = middle[0] + near.a, b = middle[1] + near.b, s = middle[2] + near.s;
      if (!before.holds(a, b, s)) continue;
      const std::size_t n = before.indexOf(a, b, s);
      if (before.mean[n] <= kSkinHu) continue;
      ++matter;
      same += after.mean[n] == before.mean[n];
    }
    return matter > 0 ? double(same) / matter : 0.0;
  };
  FaceLeft found;
  for (const Vec3& eye : marks.eyes) {
    found.eyes = std::max(found.eyes, left(eye + kLids_mm * marks.forwards, kEye_mm));
  }
  if (marks.nose) found.nose = left(*marks.nose, kNoseReach_mm);
  if (marks.mouth) found.mouth = left(*marks.mouth, kNoseReach_mm);
  return found;
}

}  // namespace trephine
