// The core's state as bytes, and back.
#include "base/codes.h"
#include "base/state_archive.h"
#include "base/tr.h"
#include "haptics/haptic_core.h"

namespace trephine {

namespace {

constexpr std::string_view kStateKind = "core";
// Goes up with every change of what any visitState() below the core names, or of its order.
constexpr std::uint32_t kStateVersion = 7;

Error badState(const std::string& what) {
  return {code::kBadState, what, tr("the state `{}`", kStateKind),
          tr("Take the state, the volume and the log of the same moment of the same exercise")};
}

}  // namespace

// What a loading core must be made of alike.
template <class Archive>
void HapticCore::visitParameters(Archive& archive) const {
  const GridGeometry& geometry = writer_.grid().geometry();
  for (std::int32_t size : geometry.size) archive.same(size);
  for (int axis = 0; axis < 3; ++axis) {
    archive.same(geometry.spacing_mm[axis]);
    archive.same(geometry.origin_mm[axis]);
  }
  archive.same(parameters_.period_s);
  archive.same(parameters_.stroke_gap_s);
  archive.same(parameters_.force_at);
  archive.same(parameters_.removal);
  archive.same(parameters_.touch_by_points);
  archive.same(parameters_.laws.size());
  for (LawKind law : parameters_.laws) archive.same(law);
  archive.same(arms_.size());
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    const ArmParameters& arm = parameters_.arms[i];
    archive.same(arm.max_force_N);
    archive.same(arm.map.motion_scale);
    archive.same(arm.map.force_scale);
    archive.same(arm.dynamics.apparent_mass_kg);
    archive.same(arm.dynamics.encoder_step_m);
    archive.same(arm.dynamics.peak_force_N);
    archive.same(arm.dynamics.delay_s);
    archive.same(arm.dynamics.continuous_force_N);
    archive.same(arm.dynamics.thermal_s);
    archive.same(arms_[i].tools.size());
    for (const ArmTool& tool : arms_[i].tools) {
      const ToolDescription& made_from = tool.made.made_from;  // all that follows is made from it
      archive.same(made_from.kind);
      archive.same(made_from.length_mm);
      archive.same(made_from.points);
      archive.same(made_from.radius_mm);
      archive.same(made_from.shaft_points);
      archive.same(made_from.shape);
      archive.same(made_from.head_mm);
      archive.same(made_from.motor_W);
    }
  }
}

template <class Self, class Archive>
void HapticCore::visitState(Self& self, Archive& archive) {
  archive.within(self.parameters_.controller, 0, std::int64_t(kControllerNames.size()));
  archive(self.parameters_.tissues);
  for (auto& arm : self.parameters_.arms) archive(arm.map.centre_mm, arm.map.rotation);
  if constexpr (Archive::kReads) {
    self.tissue_.use(self.parameters_.tissues);
    self.useTissues();
    for (Arm& arm : self.arms_) {
      arm.controller = arm.controllers[std::size_t(self.parameters_.controller)];
    }
  }
  archive(self.tissue_, self.lateness_, self.arms_);
  archive(self.ticks_, self.paused_, self.reported_full_, self.nonfinite_, self.journal_);
}

std::vector<std::byte> HapticCore::save() const {
  StateWriter writer;
  visitParameters(writer);
  writer.same(journal_.hashOfPlace(writer_.grid()));
  visitState(*this, writer);
  return sealedState(kStateKind, kStateVersion, writer);
}

Status HapticCore::read(std::span<const std::byte> state) {
  StateReader reader(state);
  visitParameters(reader);
  if (!reader.ok()) return badState(tr("The state is of a core with other parameters"));
  reader.same(journal_.hashOfPlace(writer_.grid()));
  if (!reader.ok()) return badState(tr("The state is of another place in the journal"));
  visitState(*this, reader);
  if (!reader.ok() || !reader.atEnd()) return badState(tr("The state holds what no core has"));
  tissue_.findSolid();
  carves_.clear();
  events_.clear();
  return {};
}

Status HapticCore::load(std::span<const std::byte> bytes) {
  const Result<std::span<const std::byte>> state = openedState(kStateKind, kStateVersion, bytes);
  if (!state) return state.error();
  const std::vector<std::byte> before = save();
  const Status loaded = read(*state);
  if (!loaded) (void)read(*openedState(kStateKind, kStateVersion, before));
  return loaded;
}

}  // namespace trephine
