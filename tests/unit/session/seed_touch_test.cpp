// The seed paper's rule of touch, once more and alone: from HU and points of a tool, as the paper
// has it, beside what the program did. No code of contact or removal is asked.
#include <algorithm>
#include <cstdio>
#include <set>
#include <string>

#include "base/system.h"
#include "case/placement.h"
#include "session/session.h"
#include "support.h"
#include "training/replay.h"
#include "training/session_reader.h"

namespace trephine {
namespace {

constexpr std::uint64_t kTicks = 10'000;

// What an arm does in a tick.
struct Touch {
  std::int64_t points = 0;
  const Tissue* firmest = nullptr;  // null: it touches nothing
  Vec3 force_N{0.0};                // at the device
};

// The patient of the paper: voxels that are erased one by one.
class PaperPatient {
 public:
  PaperPatient(const Volume& volume, const LabelMap* labels, const Exercise& exercise)
      : volume_(volume), labels_(labels), exercise_(exercise) {
    pushes_ = {exercise.touch_by_points.begin(), exercise.touch_by_points.end()};
  }

  // Every point k = 0..i of a blade of length L lies k / i of it from the tip.
  Touch touch(std::size_t arm, const ArmRecord& now, const ArmRecord& before) {
    const WorkspaceMap& map = *exercise_.arms[arm].map.fixed;
    const ToolDescription& tool = exercise_.findTool(exercise_.arms[arm].tool)->tool.made_from;
    const Mat3 turn = glm::mat3_cast(map.rotation), lean = glm::mat3_cast(now.device_orientation);
    const auto inPatient_mm = [&](const Vec3& device_m) {
      return map.centre_mm + map.motion_scale * (turn * (1000.0 * device_m));
    };
    const Vec3 tip_mm = inPatient_mm(now.device_position_m);
    Touch out;
    if (voxelAt(tip_mm) < 0) return out;
    for (int k = 0; k < tool.points; ++k) {
      const double from_tip_mm = tool.points > 1 ? tool.length_mm * k / (tool.points - 1) : 0.0;
      const Vec3 point_mm = tip_mm + turn * (lean * Vec3(0.0, 0.0, from_tip_mm));
      const std::int64_t voxel = voxelAt(point_mm);
      const Tissue* in = voxel < 0 ? nullptr : tissueOf(std::size_t(voxel));
      if (!in || !pushes_.contains(in->id)) continue;
      ++out.points;
      if (!out.firmest || isFirmer(*in, *out.firmest)) out.firmest = in;
      to_erase_.insert(std::uint32_t(voxel));
    }
    if (!out.firmest) return out;
    const double b = out.firmest->damping_Ns_per_m.value;
    const Vec3 moved_m = now.device_position_m - before.device_position_m;
    out.force_N = -b * map.motion_scale * map.force_scale * exercise_.rate_hz * moved_m;
    return out;
  }
  // What went in this tick, once all arms have felt it.
  std::set<std::uint32_t> erase() {
    for (std::uint32_t voxel : to_erase_) volume_.hu[voxel] = -1000;
    return std::exchange(to_erase_, {});
  }

 private:
  std::int64_t voxelAt(const Vec3& at_mm) const {
    const GridGeometry& g = volume_.geometry;
    const Vec3 from_mm = at_mm - g.origin_mm;
    std::int64_t index = 0, step = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double along = glm::dot(g.direction[axis], from_mm) / g.spacing_mm[axis];
      const double whole = std::floor(along + 0.5);
      const int size = g.size[std::size_t(axis)];
      if (!(whole >= 0.0 && whole < size)) return -1;
      index += step * std::int64_t(whole);
      step *= size;
    }
    return index;
  }
  // A tissue of the voxel's label goes before those that are anywhere.
  const Tissue* tissueOf(std::size_t voxel) const {
    const int hu = volume_.hu[voxel], label = labels_ ? labels_->labels[voxel] : 0;
    if (hu == -1000) return nullptr;
    const Tissue* anywhere = nullptr;
    for (const Tissue& tissue : exercise_.tissues.tissues) {
      if (hu < tissue.hu_min || hu > tissue.hu_max) continue;
      if (tissue.label && *tissue.label == label) return &tissue;
      if (!tissue.label && !anywhere) anywhere = &tissue;
    }
    return anywhere;
  }
  static bool isFirmer(const Tissue& a, const Tissue& b) {
    const auto numbers = [](const Tissue& t) {
      return std::array{t.friction_N.value, t.stiffness_N_per_m.value, t.damping_Ns_per_m.value};
    };
    return numbers(a) > numbers(b);
  }

  Volume volume_;
  const LabelMap* labels_;
  const Exercise& exercise_;
  std::set<std::string> pushes_;
  std::set<std::uint32_t> to_erase_;
};

struct Counts {
  std::array<std::uint64_t, kMaxArms> touching{};
  std::uint64_t erased = 0;
  std::uint64_t other_touch = 0, other_force = 0, other_voxels = 0;  // ticks
};

Counts compare(PaperPatient& paper, const Exercise& exercise, const SessionReader& recording) {
  Counts out;
  const std::vector<TickRecord> ticks = *recording.ticks(0, recording.tickCount());
  const std::vector<CarveRecord> carves = *recording.carves();
  std::size_t next = 0;
  for (std::size_t n = 0; n < ticks.size(); ++n) {
    bool same_touch = true, same_force = true;
    for (std::size_t arm = 0; arm < exercise.arms.size(); ++arm) {
      const ArmRecord& now = ticks[n].arms[arm];
      const Touch touch = paper.touch(arm, now, ticks[n > 0 ? n - 1 : 0].arms[arm]);
      const Tissue* felt =
          now.tissue_class < 0 ? nullptr : &exercise.tissues.tissues[std::size_t(now.tissue_class)];
      out.touching[arm] += touch.points > 0;
      same_touch = same_touch && felt == touch.firmest && now.points_in_tissue == touch.points;
      const double rounding_N = 1e-12 * (1.0 + glm::length(touch.force_N));
      same_force = same_force && glm::length(now.demanded_N - touch.force_N) <= rounding_N;
    }
    std::set<std::uint32_t> gone;
    for (; next < carves.size() && carves[next].tick == ticks[n].tick; ++next) {
      gone.insert(carves[next].voxel);
    }
    const std::set<std::uint32_t> erased = paper.erase();
    out.erased += erased.size();
    out.other_touch += !same_touch;
    out.other_force += !same_force;
    out.other_voxels += erased != gone;
  }
  EXPECT_EQ(next, carves.size());
  return out;
}

class SeedTouch : public testing::TestWithParam<const char*> {};

TEST_P(SeedTouch, IsThePapersOwnTickByTickAndSoIsItsReplay) {
  const test::TemporaryFolder folder;
  const std::string name = GetParam();
  const auto file = resourceFolder() / "scenes" / "research" / (name + ".json");
  const Exercise exercise = *readExercise(file);
  const Placement placed = *place(exercise, *readCase(exercise.case_source));
  ASSERT_FALSE(placed.error) << placed.error->sentence();
  const SessionOptions options{folder / "s.h5",
                               *readOperatorScript(exercise.operator_file, exercise)};
  auto session = Session::create(placed, options);
  ASSERT_TRUE(session.ok()) << session.error().sentence();
  ASSERT_TRUE((*session)->freewheel(kTicks / exercise.rate_hz).ok());
  const Exercise run = (*session)->exercise();
  session->reset();

  const auto recording = *SessionReader::open(folder / "s.h5");
  ASSERT_EQ(recording->tickCount(), kTicks);
  PaperPatient paper(*placed.patient.volume, placed.labels.get(), run);
  const Counts counts = compare(paper, run, *recording);
  for (std::size_t arm = 0; arm < run.arms.size(); ++arm) {
    std::printf("%s, %s: touches in %llu of %llu ticks\n", name.c_str(), run.arms[arm].name.c_str(),
                (unsigned long long)counts.touching[arm], (unsigned long long)kTicks);
    EXPECT_GT(counts.touching[arm], 20u) << run.arms[arm].name;
  }
  std::printf("%s: %llu voxels erased\n", name.c_str(), (unsigned long long)counts.erased);
  EXPECT_GT(counts.erased, 50u);
  EXPECT_EQ(counts.other_touch, 0u) << "ticks";
  EXPECT_EQ(counts.other_force, 0u) << "ticks";
  EXPECT_EQ(counts.other_voxels, 0u) << "ticks";

  const auto again = replay(*recording, *placed.patient.volume, placed.patient.structures.get());
  ASSERT_TRUE(again.ok()) << again.error().sentence();
  EXPECT_EQ(again->ticks, kTicks);
  EXPECT_TRUE(again->identical) << again->first_difference->field;
}

INSTANTIATE_TEST_SUITE_P(All, SeedTouch, testing::Values("seed-cranium", "seed-liver"),
                         [](const auto& of) { return std::string(of.param + 5); });

}  // namespace
}  // namespace trephine
