#include "ui/train/running_view.h"

#include <algorithm>

#include "render/tool_view.h"
#include "ui/common/colours.h"
#include "ui/common/preferences.h"
#include "ui/common/words.h"
#include "ui/train/hand_bar.h"
#include "volume/label_map.h"

namespace trephine {

namespace {

constexpr int kPanelEvery_ms = 100;  // numbers that change faster cannot be read
constexpr int kCardsEvery_ms = 200;  // they are pictures
constexpr int kRatesEvery_ms = 1000;
constexpr int kRemovedEvery_ms = 500;
constexpr double kBehind_s = 1.0;  // a kill loses less than this of a recording that keeps up

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

bool isDue(bool all, const QElapsedTimer& since, int every_ms) {
  return all || since.elapsed() >= every_ms;
}

}  // namespace

RunningView::RunningView(AppContext& app, const Panels& panels, const PointerHands& hands,
                         QObject* parent)
    : QObject(parent),
      app_(app),
      workstation_(app.workstation()),
      messages_(app.messages()),
      views_(app.caseViews().views()),
      arms_(panels.arms),
      notice_(panels.notice),
      rewind_(panels.rewind),
      exercise_(panels.exercise),
      hands_(hands) {
  connect(&views_.threeD(), &ViewWidget::framePainted, this, [this] { ++frames_; });
  rate_clock_.start();
  panel_clock_.start();
  cards_clock_.start();
}

RunningView::Tally::Tally(const Case& of, Session& session)
    : before(of.volume),
      labels(session.grid().labels()),
      structures(of.structures),
      tissues(session.exercise().tissues, *before, labels.get(), session.exercise().case_source),
      cut(tissues, *before, structures.get()) {}

void RunningView::begin(Session& session) {
  const Case* of = workstation_.currentCase();
  tally_ = of ? std::make_unique<Tally>(*of, session) : nullptr;
  limits_N_.clear();
  for (const ExerciseArm& arm : session.exercise().arms) limits_N_.push_back(arm.max_force_N);
  going_back_.reset();
  undoing_.reset();
  ticks_shown_ = 0;
  touched_ = paused_ = false;
  worked_at_mm_.reset();
  rate_clock_.restart();
  removed_clock_.restart();
  exercise_.showIdle();
}

void RunningView::end(Session& session) {
  showState(session, session.state(), false);
  // As the result has it: what came after the last look counts too.
  if (!session.isPoke()) {
    exercise_.showTime(double(session.state().seconds));
    showRemoved(session, true);
  }
  if (worked_at_mm_ && !session.isPoke()) views_.setPoint(*worked_at_mm_);
  arms_.showIdle();
  arms_.showController(workstation_.exercise()->controller);
  showTools({});
  tally_.reset();
  emit ratesChanged({});
}

void RunningView::showPicture(Session& session, const LoopState& state) {
  views_.pullChanges(session.grid());
  showTools(toolViews(session.exercise(), state));
}

void RunningView::showNumbers(Session& session, const LoopState& state, bool all) {
  arms_.follow(state);
  if (isDue(all, panel_clock_, kPanelEvery_ms)) {
    panel_clock_.restart();
    showState(session, state, all);
  }
  if (rate_clock_.elapsed() >= kRatesEvery_ms) showRates();
}

void RunningView::showTools(const std::vector<ToolView>& tools) {
  views_.threeD().setTools(tools);
  views_.setTools(tools);
}

void RunningView::showState(Session& session, const LoopState& state, bool all) {
  views_.pullChanges(session.grid());
  constexpr double kOld_s = 0.1;
  LoopState shown = state;
  if (session.standsStillFor_s() > kOld_s) {  // what was sent last is not what is sent now
    for (ArmRecord& arm : shown.record.arms) {
      arm.faults |= kFaultLate;
      arm.sent_N = arm.demanded_N = Vec3(0.0);
    }
  }
  arms_.showState(shown, session.exercise().tissues, limits_N_);
  if (!session.recordingStatus()) arms_.showUnrecorded();
  if (state.ticks > 0 && workstation_.session()) workstation_.noteController(state.controller);
  if (workstation_.session()) {
    for (std::size_t i = 0; i < session.exercise().arms.size(); ++i) {
      if (state.record.arms[i].tissue_class < 0) continue;
      touched_ = true;
      const bool first = !worked_at_mm_;
      worked_at_mm_ = state.record.arms[i].proxy_position_mm;
      // The slices go where work begins; from then on a person may turn their pages.
      if (first && !session.isPoke()) views_.setPoint(*worked_at_mm_);
    }
    touched_ = touched_ || hands_.taken();
    // Whoever pauses looks at what was cut.
    const bool pauses = state.paused && !std::exchange(paused_, state.paused);
    paused_ = state.paused;
    if (pauses && worked_at_mm_ && !session.isPoke()) views_.setPoint(*worked_at_mm_);
    notice_.showState(state, session.exercise(), session.standsStillFor_s(), !touched_);
    if (cards_wanted_ && isDue(all, cards_clock_, kCardsEvery_ms)) tellCards(session, shown);
    if (!session.isPoke()) exercise_.showTime(double(state.seconds));
    exercise_.showTools(session.exercise(), state.tools);
    if (isDue(all, removed_clock_, kRemovedEvery_ms)) showRemoved(session, all);
    emit stateShown(state);
    if (!session.isPoke()) {
      app_.undoAction()->setEnabled(state.can_undo);
      app_.redoAction()->setEnabled(state.can_redo);
      showRewind(state);
    }
  }
}

void RunningView::tellCards(const Session& session, const LoopState& state) {
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

// As the views' copy shows it. With `all` to its end, unless that takes long.
void RunningView::showRemoved(const Session& session, bool all) {
  removed_clock_.restart();
  const VolumeMirror& mirror = views_.mirror();
  if (!tally_) return;
  constexpr qint64 kMost_ms = 200;
  bool whole = false;
  if (all) tally_->cut.beginAgain();
  do {
    whole = tally_->cut.look(mirror.volume(), mirror.touched(), {});
  } while (all && !whole && removed_clock_.elapsed() < kMost_ms);
  if (!whole) return;
  const CutVoxels& cut = tally_->cut.counts();
  const std::vector<Tissue>& tissues = session.exercise().tissues.tissues;
  const double voxel_mm3 = tally_->before->geometry.voxelVolume_mm3();
  std::vector<RemovedOf> removed, of_structures;
  for (std::size_t t = 0; t < tissues.size(); ++t) {
    removed.push_back({toQt(tissues[t].name), colours::of(tissues[t].colour),
                       double(cut.of_tissue[t]) * voxel_mm3});
  }
  removed.push_back(unnamedRemoved(double(cut.unnamed) * voxel_mm3));
  if (tally_->structures) {
    for (const Structure& s : tally_->structures->structures) {
      // That of a tissue that is this structure is said already.
      const bool is_tissue = std::ranges::any_of(tissues, [&](const Tissue& t) {
        return !t.structure.empty() && sameName(t.structure, s.name);
      });
      if (is_tissue) continue;
      of_structures.push_back({toQt(s.name), colours::of(s.colour),
                               double(cut.of_label[std::size_t(s.label)]) * voxel_mm3});
    }
  }
  exercise_.showRemoved(removed, of_structures);
}

void RunningView::showRates() {
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

void RunningView::undo(CommandKind which) {
  Session* session = workstation_.session();
  if (!session || session->isPoke()) return;
  undoing_ = session->state();
  if (!session->send(which)) messages_.say(tr("Busy: try again in a moment."));
}

void RunningView::rewind(std::uint32_t second) {
  Session* session = workstation_.session();
  if (!session) return;
  if (!session->rewind(second)) return messages_.say(tr("Busy: try again in a moment."));
  going_back_ = {second, session->state().ticks};
  showRewind(session->state());
}

void RunningView::showRewind(const LoopState& state) {
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
    rewind_.showStrokes(strokes);
  }
  rewind_.showTime(state.seconds, state.busy || going_back_);
}

}  // namespace trephine
