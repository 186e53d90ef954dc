// What Train shows while an exercise runs, and what is done with one.
#include <algorithm>

#include "device/trephine_device.h"
#include "render/tool_view.h"
#include "ui/common/colours.h"
#include "ui/common/preferences.h"
#include "ui/common/words.h"
#include "ui/train/train_workspace.h"
#include "volume/cut_structures.h"
#include "volume/label_map.h"

namespace trephine {

namespace {

constexpr int kPanelEvery_ms = 66;  // numbers that change faster cannot be read
constexpr int kCardsEvery_ms = 200;  // they are pictures
constexpr int kRatesEvery_ms = 1000;
constexpr int kRemovedEvery_ms = 500;
constexpr std::uint32_t kPedalBack_s = 5;
constexpr double kBehind_s = 1.0;  // a kill loses less than this of a recording that keeps up

QString handName(const ExerciseArm& arm) {
  if (arm.name == "left") return QCoreApplication::translate("trephine", "Left hand");
  if (arm.name == "right") return QCoreApplication::translate("trephine", "Right hand");
  return toQt(arm.name);
}

std::vector<ToolView> toolViews(const Exercise& exercise, const LoopState& state) {
  std::vector<ToolView> tools;
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    const ExerciseTool* tool = exercise.toolOf(i, std::size_t(state.tools[i]));
    const ArmRecord& arm = state.record.arms[i];
    if (!tool || !isFinite(arm.proxy_position_mm)) continue;
    const QColor colour = colours::ofArm(exercise.arms[i], i);
    tools.push_back(toolView(*tool, {arm.proxy_position_mm, arm.proxy_orientation},
                             arm.tissue_class >= 0, colours::rgbOf(colour)));
  }
  return tools;
}

}  // namespace

void TrainWorkspace::showAll() {
  all_is_due_ = true;
  tick();
  all_is_due_ = false;
}

bool TrainWorkspace::isDue(const QElapsedTimer& since, int every_ms) const {
  return all_is_due_ || since.elapsed() >= every_ms;
}

void TrainWorkspace::tick() {
  Session* session = workstation_.session();
  if (!session) return;
  const LoopState& state = session->state();
  views_->pullChanges(session->grid());
  showTools(toolViews(session->exercise(), state));
  followPedal(state);
  hands_->follow();
  arms_->follow(state);
  if (isDue(panel_clock_, kPanelEvery_ms)) {
    panel_clock_.restart();
    showState(*session, state);
  }
  if (rate_clock_.elapsed() >= kRatesEvery_ms) showRates();
  workstation_.checkRecording();
  if (session->finished()) workstation_.stop();
}

void TrainWorkspace::followPedal(const LoopState& state) {
  const PedalSwitches::Asked asked = pedal_.follow(state.record.arms[0].buttons);
  if (asked.recentre) emit recentreWanted();
  if (asked.clutch) {
    clutch_->setChecked(*asked.clutch);
    clutch();
  }
  if (asked.back && !state.busy && !workstation_.session()->isPoke()) {
    rewind(state.seconds - std::min(state.seconds, kPedalBack_s));
  }
}

void TrainWorkspace::showTools(const std::vector<ToolView>& tools) {
  view_->setTools(tools);
  views_->setTools(tools);
}

void TrainWorkspace::showState(Session& session, const LoopState& state) {
  views_->pullChanges(session.grid());
  constexpr double kOld_s = 0.1;
  LoopState shown = state;
  if (session.standsStillFor_s() > kOld_s) {  // what was sent last is not what is sent now
    for (ArmRecord& arm : shown.record.arms) {
      arm.faults |= kFaultLate;
      arm.sent_N = arm.demanded_N = Vec3(0.0);
    }
  }
  arms_->showState(shown, session.exercise().tissues, limits_N_);
  if (!session.recordingStatus()) arms_->showUnrecorded();
  if (state.ticks > 0 && workstation_.session()) workstation_.noteController(state.controller);
  if (workstation_.session()) {
    pause_->setChecked(state.paused);
    for (std::size_t i = 0; i < session.exercise().arms.size(); ++i) {
      touched_ = touched_ || state.record.arms[i].tissue_class >= 0;
    }
    touched_ = touched_ || hands_->taken();
    notice_->showState(state, session.exercise(), session.standsStillFor_s(), !touched_);
    if (cards_wanted_ && isDue(cards_clock_, kCardsEvery_ms)) tellCards(session, shown);
    if (!session.isPoke()) exercise_->showTime(double(state.seconds));
    exercise_->showTools(session.exercise(), state.tools);
    if (isDue(removed_clock_, kRemovedEvery_ms)) showRemoved(session, state);
    showHand();
    if (!session.isPoke()) {
      app_.undoAction()->setEnabled(state.can_undo);
      app_.redoAction()->setEnabled(state.can_redo);
      showRewind(state);
    }
  }
}

void TrainWorkspace::tellCards(const Session& session, const LoopState& state) {
  cards_clock_.restart();
  const Exercise& exercise = session.exercise();
  std::vector<HandForce> hands;
  for (std::size_t i = 0; i < exercise.arms.size() && i < limits_N_.size(); ++i) {
    const ArmRecord& arm = state.record.arms[i];
    HandForce hand;
    hand.name = handName(exercise.arms[i]);
    hand.colour = colours::ofArm(exercise.arms[i], i);
    hand.sent_N = glm::length(arm.sent_N);
    hand.demanded_N = glm::length(arm.demanded_N);
    hand.limit_N = limits_N_[i];
    if (arm.faults != 0) hand.why = faultWords(arm.faults);
    hands.push_back(hand);
  }
  QString goal;
  if (const CardText* card = cardFor(exercise, languageInUse())) {
    goal = toQt(card->goal);
  }
  QString time = timeWords(state.seconds);
  if (state.paused) time = tr("%1, paused").arg(time);
  emit cardsChanged({forceCard(hands), exerciseCard(toQt(exercise.name), time, goal)});
}

// Of the tissues as the session counts them, of the structures as the views' copy shows them.
void TrainWorkspace::showRemoved(Session& session, const LoopState& state) {
  removed_clock_.restart();
  const std::vector<Tissue>& tissues = session.exercise().tissues.tissues;
  const double voxel_mm3 = session.grid().geometry().voxelVolume_mm3();
  std::vector<RemovedOf> removed, of_structures;
  for (std::size_t t = 0; t < tissues.size(); ++t) {
    std::uint64_t voxels = 0;
    for (std::size_t arm = 0; arm < session.exercise().arms.size(); ++arm) {
      voxels += state.removed[arm][t];
    }
    removed.push_back(
        {toQt(tissues[t].name), colours::of(tissues[t].colour), double(voxels) * voxel_mm3});
  }
  const Case* of = workstation_.currentCase();
  const VolumeMirror& mirror = views_->mirror();
  if (of && of->structures && !(mirror.touched() == VoxelBox{})) {
    // That of a tissue that is this structure is said already.
    const auto is_tissue = [&](const Structure& s) {
      return std::ranges::any_of(tissues, [&](const Tissue& t) {
        return !t.structure.empty() && sameName(t.structure, s.name);
      });
    };
    for (const auto& [label, mm3] :
         cutWithin(*of->structures, *of->volume, mirror.volume(), mirror.touched())) {
      if (const Structure* s = of->structures->find(label); s && !is_tissue(*s)) {
        of_structures.push_back({toQt(s->name), colours::of(s->colour), mm3});
      }
    }
  }
  exercise_->showRemoved(removed, of_structures);
}

void TrainWorkspace::showHand() {
  showChangeTool();
  Session* session = workstation_.session();
  const bool shown = session && (here_ || session->isPoke()) && hands_->taken();
  if (!shown) return hand_bar_->hide();
  const std::size_t active = hands_->active();
  const ExerciseArm& arm = session->exercise().arms[active];
  const LoopState& state = session->state();
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

void TrainWorkspace::showResult(Session& session, const RunReport& report) {
  ExerciseResult result;
  result.exercise = toQt(session.exercise().name);
  if (const CardText* card = cardFor(session.exercise(), languageInUse())) {
    result.goal = toQt(card->goal);
  }
  result.seconds = session.state().seconds;
  for (const auto& [id, mm3] : report.done.removed_mm3) {
    const Tissue* tissue = session.exercise().tissues.find(id);
    if (tissue) result.tissues.push_back({toQt(tissue->name), colours::of(tissue->colour), mm3});
  }
  result.structures = report.structures_cut;
  for (std::size_t i = 0; i < report.done.arms.size(); ++i) {
    result.ways.push_back({handName(session.exercise().arms[i]), report.done.arms[i].path_mm,
                           report.done.arms[i].max_force_N});
  }
  result.recorded = session.recordingStatus() && report.machine.events_dropped == 0;
  result.late = report.machine.missed_deadlines;
  recorded_ = result.recorded;
  result_shown_ = true;
  aside_ = false;
  result_->setResult(result);
  showCard();
}

void TrainWorkspace::showRates() {
  const double seconds = double(rate_clock_.restart()) / 1000.0;
  Session* session = workstation_.session();
  if (!session) return;
  const LoopState& state = session->state();
  const double haptic_hz = double(state.ticks - ticks_shown_) / seconds;
  ticks_shown_ = state.ticks;
  QString rates = tr("%1 forces a second").arg(haptic_hz, 0, 'f', 0);
  if (frames_ > 0) {  // a picture in which nothing moves is not drawn again
    rates = tr("%1 pictures and %2 forces a second")
                .arg(double(frames_) / seconds, 0, 'f', 0)
                .arg(haptic_hz, 0, 'f', 0);
  }
  if (const double behind_s = session->recorderBehind_s(); behind_s >= kBehind_s) {
    rates += tr(" \u00b7 recording %1 s behind").arg(behind_s, 0, 'f', 1);
  }
  emit ratesChanged(rates);
  frames_ = 0;
}

void TrainWorkspace::command(CommandKind kind) {
  Session* session = workstation_.session();
  if (!session) return;
  if (!session->send(kind)) return messages_.say(tr("Busy: try again in a moment."));
}

// Or a redo.
void TrainWorkspace::undo(CommandKind which) {
  Session* session = workstation_.session();
  if (!session || session->isPoke()) return;
  undoing_ = session->state();
  command(which);
}

void TrainWorkspace::rewind(std::uint32_t second) {
  Session* session = workstation_.session();
  if (!session) return;
  if (!session->rewind(second)) return messages_.say(tr("Busy: try again in a moment."));
  going_back_ = {second, session->state().ticks};
  showRewind(session->state());
}

void TrainWorkspace::showRewind(const LoopState& state) {
  if (going_back_ && !state.busy && state.ticks > going_back_->asked_tick + Session::kAnswerTicks) {
    messages_.say(backWords(going_back_->second, state, *workstation_.exercise()));
    going_back_.reset();
  }
  const auto answered = [&](std::uint64_t asked_tick) {
    return !state.busy && state.ticks > asked_tick + Session::kAnswerTicks;
  };
  if (undoing_ && answered(undoing_->ticks)) {
    Session* session = workstation_.session();
    const double voxel_mm3 = session ? session->grid().geometry().voxelVolume_mm3() : 0.0;
    messages_.say(undoneWords(*undoing_, state, *workstation_.exercise(), voxel_mm3));
    undoing_.reset();
  }
  if (const Session* session = workstation_.session()) {
    std::vector<RewindBar::Stroke> strokes;
    for (const StrokeBegin& stroke : session->strokes()) {
      const auto arm = std::size_t(stroke.arm);
      strokes.push_back({stroke.second, colours::ofArm(session->exercise().arms[arm], arm)});
    }
    rewind_->showStrokes(strokes);
  }
  rewind_->showTime(state.seconds, state.busy || going_back_);
}

}  // namespace trephine
