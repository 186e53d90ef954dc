#include "imaging/steps/face.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "imaging/steps/detail/coarse_parts.h"
#include "volume/two_threads.h"

namespace trephine {

namespace {

constexpr double kMargin_mm = 8.0;  // from the braincase's inside to the cut: its bone
// From the middle of the braincase: the chin is nearer than kBottom_mm, and the air of the face
// than kNose_mm; without air, where the face's middle is taken to be.
constexpr double kBottom_mm = 175.0, kNose_mm = 110.0;
const Vec3 kNoAir_mm(0.0, -55.0, -55.0);
constexpr double kLeastAir_mL = 6.0;
constexpr double kWholeBraincase_mm = 70.0;  // as high as all of it is seen, a child's too
constexpr double kFace_mm = 90.0;   // from the face's middle to the last of chin, cheeks and brow
constexpr double kFront_mm = 70.0;  // without a braincase: how deep the cut goes
constexpr double kLeastSkin_cm2 = 15.0;

bool isBone(const CoarseGrid& grid, std::size_t n) {
  return grid.mean[n] > kBoneMeanHu || (grid.marks[n] & kBoneCell);
}

// The coarse grid as the patient stands: x across, y from front to back, z upwards.
class Upright {
 public:
  explicit Upright(const CoarseGrid& grid) : grid_(grid) {
    const GridGeometry& g = grid.voxels;
    const auto part = [&](std::size_t n, int lps) { return g.direction[grid.axis[n]][lps]; };
    const bool a_is_y = std::abs(part(0, 1)) > std::abs(part(1, 1));
    const std::array<std::size_t, 3> from{a_is_y ? 1u : 0u, a_is_y ? 0u : 1u, 2u};
    const std::size_t strides[3] = {1, std::size_t(grid.size[0]),
                                    std::size_t(grid.size[0]) * std::size_t(grid.size[1])};
    for (std::size_t n = 0; n < 3; ++n) {
      size[n] = grid.size[from[n]];
      cell_mm[int(n)] = grid.cell_mm[int(from[n])];
      const bool backwards = part(from[n], int(n)) < 0.0;
      stride_[n] = std::ptrdiff_t(strides[from[n]]) * (backwards ? -1 : 1);
      if (backwards) first_ += std::ptrdiff_t(strides[from[n]]) * (size[n] - 1);
    }
    // Cell (0, 0, 0) and the steps from it, in patient mm.
    const auto placeOf = [&](std::size_t n) {
      const auto slice = std::size_t(grid.size[0]) * std::size_t(grid.size[1]);
      const auto row = std::size_t(grid.size[0]);
      return grid.place_mm(double(n % slice % row), double(n % slice / row), double(n / slice));
    };
    origin_ = placeOf(at(0, 0, 0));
    for (int axis = 0; axis < 3; ++axis) {
      step_[axis] = g.direction[grid.axis[from[std::size_t(axis)]]] * cell_mm[axis];
      if (stride_[std::size_t(axis)] < 0) step_[axis] = -step_[axis];
    }
  }

  std::size_t at(int x, int y, int z) const {
    return std::size_t(first_ + stride_[0] * x + stride_[1] * y + stride_[2] * z);
  }
  Vec3 place_mm(double x, double y, double z) const { return origin_ + step_ * Vec3(x, y, z); }
  const CoarseGrid& grid() const { return grid_; }

  Index3 size{0, 0, 0};
  Vec3 cell_mm{1.0};

 private:
  const CoarseGrid& grid_;
  std::array<std::ptrdiff_t, 3> stride_{};
  std::ptrdiff_t first_ = 0;
  Vec3 origin_{0.0};
  Mat3 step_{1.0};
};

// The inside of a closed ring of bone, filled with brain, in one slice of cells.
struct Ring {
  double area_cm2 = 0.0;
  std::uint32_t piece = 0;
};

// Cells within a braincase: bone around them in their own slice, brain inside, in slices that add
// up to 20 mm or more. Empty where there is none. Gaps in the bone (sutures, foramina, holes of an
// operation) are closed up to twice `closing` cells; larger ones cost a few slices.
CoarseCells braincase(const CoarseGrid& grid, int closing) {
  CoarseCells open(grid.count());
  for (std::size_t n = 0; n < open.size(); ++n) open[n] = isBone(grid, n);
  for (int n = 0; n < closing; ++n) dilateAcross(grid.size, open);
  for (auto& cell : open) cell ^= 1;
  const CoarseParts found = coarseParts(grid.size, open);

  struct Filling {
    std::uint32_t cells = 0, brain = 0;
  };
  std::vector<Filling> fillings(found.pieces.size());
  for (const CellRun& run : found.runs) {
    const CoarsePiece& piece = found.pieces[run.piece];
    if (piece.first_a == 0 || piece.first_b == 0) continue;  // the outside
    Filling& filling = fillings[run.piece];
    for (int a = run.first; a <= run.last; ++a) {
      const int hu = grid.mean[grid.indexOf(a, run.b, run.s)];
      filling.brain += hu > -40 && hu < 120;
    }
    filling.cells += std::uint32_t(run.last - run.first + 1);
  }

  const double cell_cm2 = grid.cell_mm[0] * grid.cell_mm[1] / 100.0;
  std::vector<Ring> rings(std::size_t(grid.size[2]));
  for (std::uint32_t p = 0; p < found.pieces.size(); ++p) {
    const CoarsePiece& piece = found.pieces[p];
    const double area = fillings[p].cells * cell_cm2;
    const bool brain = fillings[p].brain * 5 > fillings[p].cells * 4;
    const bool border = piece.last_a == grid.size[0] - 1 || piece.last_b == grid.size[1] - 1;
    Ring& ring = rings[std::size_t(piece.s)];
    if (brain && !border && area > 30.0 && area < 300.0 && area > ring.area_cm2) ring = {area, p};
  }

  // The stretch with most rings; two of them are at most 40 mm apart.
  struct Stretch {
    int first = 0, last = -1, rings = 0;
  };
  Stretch best, current;
  for (int s = 0; s < grid.size[2]; ++s) {
    if (rings[std::size_t(s)].area_cm2 == 0.0) continue;
    if (current.rings == 0 || (s - current.last) * grid.cell_mm[2] > 40.0) current = {s, s, 0};
    current.last = s;
    ++current.rings;
    if (current.rings > best.rings) best = current;
  }
  if (best.rings * grid.cell_mm[2] < 20.0) return {};
  CoarseCells inside(grid.count());
  for (const CellRun& run : found.runs) {
    const Ring& ring = rings[std::size_t(run.s)];
    if (run.s < best.first || run.s > best.last || ring.area_cm2 == 0.0) continue;
    if (ring.piece != run.piece) continue;
    std::fill_n(inside.begin() + std::ptrdiff_t(grid.indexOf(run.first, run.b, run.s)),
                run.last - run.first + 1, std::uint8_t(1));
  }
  // Back to the bone, from which the closing of gaps kept away.
  for (int n = 0; n < closing; ++n) dilateAcross(grid.size, inside);
  return inside;
}

// What the front of the head shows: skin, or bone and what the field of view cuts open.
struct Seen {
  double skin_cm2 = 0.0, other_cm2 = 0.0;
};

class FaceSearch {
 public:
  explicit FaceSearch(const Upright& head) : head_(head), grid_(head.grid()) {}

  // A cut that touches the braincase from below and in front.
  FaceFinding belowBraincase(const CoarseCells& inside) {
    Vec3 low(1e9), high(-1e9);
    std::vector<Vec3> outline;  // the lowest and the highest cell of each column
    for (int x = 0; x < head_.size[0]; ++x) {
      for (int y = 0; y < head_.size[1]; ++y) {
        int bottom = -1, top = -1;
        for (int z = 0; z < head_.size[2]; ++z) {
          if (!inside[head_.at(x, y, z)]) continue;
          if (bottom < 0) bottom = z;
          top = z;
        }
        if (bottom < 0) continue;
        for (const int z : {bottom, top}) {
          outline.push_back(head_.place_mm(x, y, z));
          low = glm::min(low, outline.back());
          high = glm::max(high, outline.back());
        }
      }
    }
    const Vec3 middle = 0.5 * (low + high);
    FaceFinding finding;
    finding.braincase = true;
    finding.back_mm = middle.y + 10.0;
    finding.bottom_mm = middle.z - kBottom_mm;
    finding.offset_mm = -1e9;
    // From the middle of the braincase to that of the air of the face, whichever way the head is
    // turned and the neck bent.
    const auto near = [&](std::size_t n, const Vec3& p) {
      return !inside[n] && glm::distance(p, middle) < kNose_mm;
    };
    const std::optional<Vec3> air = middleOfAir(
        [&](std::size_t n, const Vec3& p) { return near(n, p) && p.y < finding.back_mm; });
    finding.middle_mm = air.value_or(middle + kNoAir_mm);
    finding.normal = glm::normalize(finding.middle_mm - middle);
    if (high.z - low.z < kWholeBraincase_mm) finding.normal = asIfUpright(finding.normal);
    for (const Vec3& p : outline) {
      finding.offset_mm = std::max(finding.offset_mm, glm::dot(finding.normal, p) + kMargin_mm);
    }
    const Seen seen = look(finding, middle.x);
    finding.skin_cm2 = seen.skin_cm2;
    finding.found = isFace(seen);
    if (!air && !finding.found) {
      // The air of a face behind the ears: the scan says wrongly which side is the front.
      const std::optional<Vec3> behind = middleOfAir(near);
      finding.found = behind && glm::normalize(*behind - middle).y > 0.5;
    }
    return finding;
  }

  // The front of whatever is there.
  FaceFinding frontOnly() {
    FaceFinding finding;
    double front = 1e9, middle = 0.0, top = -1e9, bottom = 1e9;
    std::uint64_t cells = 0;
    forMatter([&](int x, int y, int z) {
      const Vec3 p = head_.place_mm(x, y, z);
      middle += p.x;
      top = std::max(top, p.z);
      bottom = std::min(bottom, p.z);
      ++cells;
      front = std::min(front, p.y);
    });
    if (cells == 0) return finding;
    finding.offset_mm = -(front + kFront_mm);
    finding.back_mm = front + kFront_mm;
    finding.bottom_mm = std::max(bottom - 10.0, top - 300.0);
    const Seen seen = look(finding, middle / double(cells));
    finding.skin_cm2 = seen.skin_cm2;
    finding.found = isFace(seen);
    if (!finding.found) return finding;
    finding.middle_mm =
        middleOfAir([&](std::size_t, const Vec3& p) {
          return finding.clears(p);
        }).value_or(Vec3(middle / double(cells), front + 0.5 * kFront_mm, 0.5 * (top + bottom)));
    return finding;
  }

  // Facial bone around air, as much as a nose and its sinuses hold, in something of a head's size.
  bool hasFacialBones() const {
    double air_cm3 = 0.0;
    std::uint64_t matter = 0, bone = 0;
    int low_x = head_.size[0], high_x = -1, low_y = head_.size[1], high_y = -1;
    for (int z = 0; z < head_.size[2]; ++z) {
      for (int y = 0; y < head_.size[1]; ++y) {
        int first_bone = -1, last_bone = -1;
        for (int x = 0; x < head_.size[0]; ++x) {
          const std::size_t n = head_.at(x, y, z);
          if (isBone(grid_, n)) {
            if (first_bone < 0) first_bone = x;
            last_bone = x;
            ++bone;
          }
          if (grid_.mean[n] < kSkinHu) continue;
          ++matter;
          if (!(grid_.marks[n] & kSolidCell)) continue;
          low_x = std::min(low_x, x);
          high_x = std::max(high_x, x);
          low_y = std::min(low_y, y);
          high_y = std::max(high_y, y);
        }
        for (int x = first_bone + 1; x < last_bone; ++x) {
          if (grid_.mean[head_.at(x, y, z)] < kSkinHu) air_cm3 += 1.0;
        }
      }
    }
    air_cm3 *= head_.cell_mm.x * head_.cell_mm.y * head_.cell_mm.z / 1000.0;
    const double wide = (high_x - low_x + 1) * head_.cell_mm.x;
    const double deep = (high_y - low_y + 1) * head_.cell_mm.y;
    return wide > 90.0 && wide < 260.0 && deep > 70.0 && deep < 300.0 && bone * 12 > matter &&
           air_cm3 > 6.0 && air_cm3 < 250.0;
  }

 private:
  template <class Work>
  void forMatter(const Work& work) const {
    for (int z = 0; z < head_.size[2]; ++z) {
      for (int y = 0; y < head_.size[1]; ++y) {
        for (int x = 0; x < head_.size[0]; ++x) {
          if (grid_.marks[head_.at(x, y, z)] & kSolidCell) work(x, y, z);
        }
      }
    }
  }

  // Part of a braincase does not say where its middle is: 35 to 70 degrees below the horizon, where
  // upright heads have the face.
  static Vec3 asIfUpright(const Vec3& towards_face) {
    const double across = std::hypot(towards_face.x, towards_face.y);
    const double below = std::clamp(std::atan2(-towards_face.z, across), 0.61, 1.22);
    const Vec3 level =
        across > 0.1 ? Vec3(towards_face.x, towards_face.y, 0.0) / across : Vec3(0, -1, 0);
    return level * std::cos(below) - Vec3(0, 0, std::sin(below));
  }

  // The middle of the air in nose, sinuses, mouth and throat that `counts`; nothing of a few cells.
  template <class Counts>
  std::optional<Vec3> middleOfAir(const Counts& counts) const {
    const CoarseCells enclosed = enclosedAir(grid_, kSkinHu);
    Vec3 sum(0.0);
    double cells = 0.0;
    for (int z = 0; z < head_.size[2]; ++z) {
      for (int y = 0; y < head_.size[1]; ++y) {
        for (int x = 0; x < head_.size[0]; ++x) {
          const std::size_t n = head_.at(x, y, z);
          if (!enclosed[n]) continue;
          const Vec3 p = head_.place_mm(x, y, z);
          if (!counts(n, p)) continue;
          sum += p;
          ++cells;
        }
      }
    }
    const double cell_mL = head_.cell_mm.x * head_.cell_mm.y * head_.cell_mm.z / 1000.0;
    if (cells * cell_mL < kLeastAir_mL) return std::nullopt;
    return sum / cells;
  }

  // What someone in front of the patient sees of what the cut takes, 70 mm to both sides.
  Seen look(const FaceFinding& cut, double middle_x) const {
    Seen seen;
    const double column_cm2 = head_.cell_mm.x * head_.cell_mm.z / 100.0;
    int front = head_.size[1];
    std::vector<std::pair<int, bool>> columns;  // its first cell, and whether not skin
    for (int z = 0; z < head_.size[2]; ++z) {
      for (int x = 0; x < head_.size[0]; ++x) {
        if (std::abs(head_.place_mm(x, 0, z).x - middle_x) > 70.0) continue;
        int y = 0;
        while (y < head_.size[1] && grid_.mean[head_.at(x, y, z)] < kSkinHu) ++y;
        if (y == head_.size[1] || !cut.clears(head_.place_mm(x, y, z))) continue;
        bool other = y == 0;
        const int deep = std::max(1, int(4.0 / head_.cell_mm.y));
        for (int n = 0; n <= deep && y + n < head_.size[1]; ++n) {
          other |= isBone(grid_, head_.at(x, y + n, z));
        }
        columns.emplace_back(y, other);
        front = std::min(front, y);
      }
    }
    const int reach = int(kFront_mm / head_.cell_mm.y);
    for (const auto& [y, other] : columns) {
      if (y > front + reach) continue;
      (other ? seen.other_cm2 : seen.skin_cm2) += column_cm2;
    }
    return seen;
  }

  static bool isFace(const Seen& seen) {
    return seen.skin_cm2 > kLeastSkin_cm2 && seen.skin_cm2 > 0.7 * seen.other_cm2;
  }

  const Upright& head_;
  const CoarseGrid& grid_;
};

// Whether the scan's own words speak of a head.
bool namesHead(std::string_view words) {
  std::string upper(words);
  for (char& c : upper) c = char(std::toupper(static_cast<unsigned char>(c)));
  for (const char* word : {"HEAD", "BRAIN", "SKULL", "CRAN", "FACE", "FACIAL", "SINUS", "ORBIT",
                           "NOSE", "NASAL", "JAW", "MAXILL", "MANDIB", "DENT", "TEETH", "NECK"}) {
    if (upper.find(word) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

FaceFinding findFace(const Volume& volume, std::string_view body_part_examined) {
  return findFace(coarseGrid(volume), body_part_examined);
}

FaceFinding findFace(const CoarseGrid& grid, std::string_view body_part_examined) {
  if (grid.count() == 0) return {};
  const Upright head(grid);
  FaceSearch search(head);
  CoarseCells inside = braincase(grid, 1);
  if (inside.empty()) {
    const bool words = !body_part_examined.empty();
    if (!(words ? namesHead(body_part_examined) : search.hasFacialBones())) return {};
    inside = braincase(grid, 3);
  }
  return inside.empty() ? search.frontOnly() : search.belowBraincase(inside);
}

BeyondFace beyondFace(const CoarseGrid& grid, const FaceFinding& finding, const VoxelBox& kept) {
  BeyondFace beyond;
  const double cell_mL = grid.cell_mm[0] * grid.cell_mm[1] * grid.cell_mm[2] / 1000.0;
  for (int s = 0; s < grid.size[2]; ++s) {
    for (int b = 0; b < grid.size[1]; ++b) {
      for (int a = 0; a < grid.size[0]; ++a) {
        const std::size_t n = grid.indexOf(a, b, s);
        if (grid.mean[n] < kSkinHu || !grid.isIn(kept, a, b, s)) continue;
        const Vec3 p = grid.place_mm(a, b, s), from = p - finding.middle_mm;
        if (!finding.clears(p) || glm::length(from) < kFace_mm) continue;
        const bool below = from.z < 0.0 && std::abs(from.x) < kFace_mm;
        (below ? beyond.throat_mL : beyond.beside_mL) += cell_mL;
        if (isBone(grid, n)) beyond.bone_mL += cell_mL;
      }
    }
  }
  return beyond;
}

std::uint64_t deface(Volume& volume, const FaceFinding& finding, TakenVoxels* taken) {
  if (!finding.found) return 0;
  const GridGeometry& g = volume.geometry;
  const Vec3 step = g.direction[0] * g.spacing_mm[0];
  std::atomic<std::uint64_t> gone{0};
  if (taken) taken->assign(std::size_t(g.size[2]), {});
  onTwoThreads(g.size[2], [&](int k) {
    std::uint64_t in_slice = 0;
    for (int j = 0; j < g.size[1]; ++j) {
      const Vec3 first = g.toPatient_mm(Vec3(0, j, k));
      std::int16_t* row = volume.hu.data() + g.indexOf(0, j, k);
      for (int i = 0; i < g.size[0]; ++i) {
        if (!finding.clears(first + step * double(i))) continue;
        in_slice += row[i] > -900;
        if (taken) (*taken)[std::size_t(k)].emplace_back(g.indexOf(i, j, k), row[i]);
        row[i] = kAirHu;
      }
    }
    gone += in_slice;
  });
  return gone;
}

}  // namespace trephine
