// What the hands do in Train: the mouse's, the arms', and the feet.
#include <algorithm>

#include "device/trephine_device.h"
#include "ui/common/colours.h"
#include "ui/common/words.h"
#include "ui/train/train_workspace.h"

namespace trephine {

namespace {

constexpr std::uint32_t kPedalBack_s = 5;

}  // namespace

void TrainWorkspace::followPedal(const LoopState& state) {
  const PedalSwitches::Asked asked = pedal_.follow(state.record.arms[0].buttons);
  if (asked.recentre) emit recentreWanted();
  if (asked.clutch) {
    clutch_->setChecked(*asked.clutch);
    clutch();
  }
  if (asked.back && !state.busy && !workstation_.session()->isPoke()) {
    running_->rewind(state.seconds - std::min(state.seconds, kPedalBack_s));
  }
}

void TrainWorkspace::showHand() {
  showChangeTool();
  Session* session = workstation_.session();
  const bool shown = session && (here_ || session->isPoke()) && hands_->taken();
  if (!shown) return hand_bar_->hide();
  const std::size_t active = hands_->active();
  const ExerciseArm& arm = session->exercise().arms[active];
  const LoopState state = session->state();
  const ExerciseTool& tool = *session->exercise().toolOf(active, std::size_t(state.tools[active]));
  hand_bar_->showHand(handName(arm), colours::ofArm(arm, active), toolWord(tool),
                      state.wanted_tools[active] != state.tools[active], hands_->push_N(),
                      hands_->mostPush_N(),
                      touchedName(state.record.arms[active], session->exercise().tissues),
                      state.record.arms[active].flags & TREPHINE_ARM_AT_LIMIT);
}

// Of the hand that the mouse and the keys have.
void TrainWorkspace::showChangeTool() {
  const Session* session = workstation_.session();
  const bool alone = session && session->exercise().arms[hands_->active()].other_tools.empty();
  change_tool_->setEnabled(session && !alone);
  const QString key = change_tool_->shortcut().toString(QKeySequence::NativeText);
  const QString tip = alone ? tr("The exercise has one tool for this hand")
                            : tr("The hand takes the next of its tools, out of the tissue");
  change_tool_->setToolTip(tr("%1 (%2)").arg(tip, key));
}

void TrainWorkspace::giveTool(std::size_t arm, std::size_t tool) {
  Session* session = workstation_.session();
  if (session && !session->changeTool(arm, tool)) messages_.say(tr("Busy: try again in a moment."));
  view_->setFocus();
}

void TrainWorkspace::nextTool() {
  Session* session = workstation_.session();
  if (!session) return;
  const std::size_t arm = hands_->active();
  const std::size_t tools = 1 + session->exercise().arms[arm].other_tools.size();
  giveTool(arm, (std::size_t(session->state().wanted_tools[arm]) + 1) % tools);
}

// All arms at once: whoever clutches one wants to find room for both hands.
void TrainWorkspace::clutch() {
  Session* session = workstation_.session();
  if (!session) return;
  const ViewCamera& camera = view_->camera();
  // A device's x is to the right, its y up, its z towards the hand. Mouse and keys follow the view
  // as it is: the tool that they hold is not turned.
  const Quat rotation = glm::quat_cast(Mat3(camera.right(), camera.up(), -camera.forward()));
  for (std::size_t i = 0; i < session->exercise().arms.size(); ++i) {
    const bool on = clutch_->isChecked();
    const bool sent = on || session->isSimulated(i) ? session->clutch(i, on)
                                                    : session->clutch(i, false, rotation);
    if (!sent) messages_.say(tr("Busy: try again in a moment."));
  }
}

void TrainWorkspace::recentre() {
  Session* session = workstation_.session();
  if (!session) return;
  for (std::size_t i = 0; i < session->exercise().arms.size(); ++i) {
    if (!session->recentre(i)) messages_.say(tr("Busy: try again in a moment."));
  }
  hands_->goneBack();
}

}  // namespace trephine
