#include "ui/train/train_workspace.h"

#include <QMessageBox>
#include <QPushButton>
#include <QShortcut>
#include <algorithm>

#include "ui/common/actions.h"
#include "ui/common/colours.h"
#include "ui/common/error_dialog.h"
#include "ui/common/placing.h"
#include "ui/common/preferences.h"
#include "ui/common/question.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kFrame_ms = 16;
constexpr int kLeftWidth = 165;

}  // namespace

TrainWorkspace::TrainWorkspace(AppContext& app)
    : Workspace(&app),
      app_(app),
      workstation_(app.workstation()),
      messages_(app.messages()),
      guards_(app.guards()),
      case_views_(app.caseViews()),
      views_(&case_views_.views()),
      view_(&case_views_.view()) {
  buildActions();
  choice_ = new ExerciseChoice(app, this);
  notice_ = new StateNotice(views_, views_->bar());
  rewind_ = new RewindBar;
  arms_ = new ArmsPanel;
  exercise_ = new ExercisePanel;
  exercise_page_ = scrolled(exercise_, "exercisePage");
  exercise_page_->setMinimumWidth(kLeftWidth);
  card_ = new StartCard(*views_);
  result_ = new ResultPage(*views_);
  hand_bar_ = new HandBar(*view_);
  hands_ = new PointerHands(*view_);
  running_ = new RunningView(app, {*arms_, *notice_, *rewind_, *exercise_}, *hands_, this);
  connectParts();
  showPractising();
  choice_->fill();
  frame_timer_.setObjectName("frame");
  frame_timer_.setInterval(kFrame_ms);
  showPhase();
}

Workspace::Parts TrainWorkspace::parts() {
  Parts parts;
  parts.left = exercise_page_;
  parts.right = arms_;
  parts.below = rewind_;
  return parts;
}

void TrainWorkspace::enter() {
  here_ = true;
  showPractising();
  choice_->stayIn(Place::train);
  showCard();
  showHand();
}

void TrainWorkspace::leave() {
  here_ = false;
  showPractising();
  choice_->stayIn(Place::prepare);
  showCard();
  showHand();
}

bool TrainWorkspace::escape() {
  if (!card_->asideButton().isVisible() && !result_->isVisible()) return false;
  putAside(true);
  return true;
}

// What is tried from Prepare is still being made.
void TrainWorkspace::showPractising() {
  workstation_.setPractising(here_ && !app_.trying());
}

void TrainWorkspace::buildActions() {
  QWidget& window = *messages_.window();
  start_ =
      makeAction(window, Symbol::start, "start", tr("Start"), Qt::Key_F5, tr("Start the exercise"));
  stop_ = makeAction(window, Symbol::stop, "stop", tr("Stop"), Qt::CTRL | Qt::Key_Period,
                     tr("End the exercise and its recording"));
  pause_ = makeAction(window, Symbol::pause, "pause", tr("Pause"), Qt::CTRL | Qt::Key_P,
                      tr("Hold: no force and no cutting until it is released; in the view Space"));
  pause_->setCheckable(true);
  pause_->setAutoRepeat(false);
  reset_ = makeAction(window, Symbol::reset, "reset", tr("Reset"), Qt::CTRL | Qt::Key_R,
                      tr("Put all tissue back"));
  other_hand_ = makeAction(window, Symbol::train, "otherHand", tr("Other hand"), {},
                           tr("The mouse takes the other hand; in the view Tab"));
  change_tool_ =
      makeAction(window, Symbol::train, "changeTool", tr("Change tool"), Qt::CTRL | Qt::Key_T,
                 tr("The hand takes the next of its tools, out of the tissue"));
  clutch_ = makeAction(window, Symbol::train, "clutch", tr("Clutch"), Qt::CTRL | Qt::Key_K,
                       tr("The arms move freely and their tools stay, until it is pressed again: "
                          "then a hand's motion follows the view"));
  clutch_->setCheckable(true);
  recentre_ =
      makeAction(window, Symbol::train, "recentre", tr("Re-centre"), Qt::CTRL | Qt::Key_L,
                 tr("The tools are where the exercise starts, with the arms where they are"));
}

void TrainWorkspace::connectParts() {
  connect(start_, &QAction::triggered, this, &TrainWorkspace::start);
  connect(stop_, &QAction::triggered, &workstation_, [this] { workstation_.stop(); });
  // By what the session does, which the action shows a moment later.
  connect(pause_, &QAction::triggered, this, [this] {
    Session* session = workstation_.session();
    if (!session) return;
    command(session->state().paused ? CommandKind::resume : CommandKind::pause);
  });
  connect(notice_, &StateNotice::goOnWanted, this, [this] { command(CommandKind::resume); });
  connect(notice_, &StateNotice::forceWanted, this, [this] { command(CommandKind::clear_faults); });
  connect(app_.undoAction(), &QAction::triggered, running_,
          [this] { running_->undo(CommandKind::undo); });
  connect(app_.redoAction(), &QAction::triggered, running_,
          [this] { running_->undo(CommandKind::redo); });
  connect(reset_, &QAction::triggered, this, &TrainWorkspace::reset);
  connect(rewind_, &RewindBar::rewindAsked, running_, &RunningView::rewind);
  // Space belongs to buttons and lists where they have the focus.
  auto* space = new QShortcut(Qt::Key_Space, view_, nullptr, nullptr, Qt::WidgetShortcut);
  space->setAutoRepeat(false);
  connect(space, &QShortcut::activated, pause_, &QAction::trigger);
  connect(arms_, &ArmsPanel::controllerWanted, this, [this](ControllerKind kind) {
    workstation_.setController(kind);
    view_->setFocus();
  });
  connect(choice_, &ExerciseChoice::controllerShown, arms_, &ArmsPanel::showController);
  connect(choice_, &ExerciseChoice::structureWanted, this, &TrainWorkspace::structureWanted);
  connect(running_, &RunningView::ratesChanged, this, &TrainWorkspace::ratesChanged);
  connect(running_, &RunningView::cardsChanged, this, &TrainWorkspace::cardsChanged);
  connect(running_, &RunningView::stateShown, this, [this](const LoopState& state) {
    pause_->setChecked(state.paused);
    showHand();
  });
  connect(hands_, &PointerHands::changed, this, &TrainWorkspace::showHand);
  connect(other_hand_, &QAction::triggered, hands_, &PointerHands::takeOther);
  connect(change_tool_, &QAction::triggered, this, &TrainWorkspace::nextTool);
  connect(arms_, &ArmsPanel::toolWanted, this, &TrainWorkspace::giveTool);
  connect(clutch_, &QAction::triggered, this, &TrainWorkspace::clutch);
  connect(recentre_, &QAction::triggered, this, &TrainWorkspace::recentre);
  connect(card_, &StartCard::startWanted, start_, &QAction::trigger);
  connect(card_, &StartCard::fitted, this, &TrainWorkspace::showSaid);
  connect(card_, &StartCard::caseWanted, this, [this] { app_.go(Place::cases); });
  connect(card_, &StartCard::asideWanted, this, [this] { putAside(true); });
  connect(&app_, &AppContext::tryingChanged, this, [this] {
    exercise_->offerBack(app_.trying());
    showPractising();
  });
  connect(exercise_, &ExercisePanel::backWanted, this, [this] {
    // Of a trial nothing is kept but its recording.
    if (workstation_.session()) {
      back_from_trial_ = true;
      workstation_.stop();
      app_.setTrying(false);
      return app_.go(Place::prepare);
    }
    guards_.unlessLost({UnsavedWork::cuts}, [this] {
      if (case_views_.carved()) case_views_.showWholeCase();
      app_.setTrying(false);
      app_.go(Place::prepare);
    });
  });
  connect(exercise_, &ExercisePanel::cardWanted, this, [this] { putAside(false); });
  card_->takeTabFrom(*view_);
  result_->takeTabFrom(*view_);
  connect(result_, &ResultPage::againWanted, this, &TrainWorkspace::tryAgain);
  connect(result_, &ResultPage::replayWanted, this, &TrainWorkspace::replayWanted);
  connect(result_, &ResultPage::lookWanted, this, [this] { putAside(true); });
  connect(&workstation_, &Workstation::locksChanged, this, &TrainWorkspace::showLocks);
  connect(&workstation_, &Workstation::structuresChanged, this, &TrainWorkspace::showOutline);

  connect(&case_views_, &CaseViews::caseShown, this, [this] {
    result_shown_ = aside_ = false;
    exercise_->showIdle();  // of the exercise before
    showOutline();
    showCard();
  });
  connect(&case_views_, &CaseViews::cutsChanged, this, &TrainWorkspace::showReset);
  connect(&workstation_, &Workstation::exerciseOpening, this, [this] {
    if (!result_shown_) aside_ = false;
  });
  connect(&workstation_, &Workstation::exerciseChanged, this, &TrainWorkspace::showChosen);
  connect(&workstation_, &Workstation::phaseChanged, this, &TrainWorkspace::showPhase);
  connect(&workstation_, &Workstation::sessionStarted, this, &TrainWorkspace::sessionStarted);
  connect(&workstation_, &Workstation::sessionEnded, this, &TrainWorkspace::sessionEnded);
  connect(&workstation_, &Workstation::controllerChanged, this, [this] {
    if (workstation_.exercise()) arms_->showController(workstation_.controllerInForce());
  });
  connect(&workstation_, &Workstation::recordingFailed, this, &TrainWorkspace::askToGoOn);
  connect(&frame_timer_, &QTimer::timeout, this, &TrainWorkspace::tick);
}

// --- The exercise ---

void TrainWorkspace::startExercise(std::optional<OperatorScript> script, double seconds) {
  // What nobody sees moves no arm.
  app_.go(Place::train);
  if (const Status& drawing = view_->canDraw(); !drawing) return messages_.report(drawing.error());
  workstation_.start(app_.recordings(), std::move(script), seconds);
}

void TrainWorkspace::startUnlessLost(const std::vector<UnsavedWork>& losses) {
  guards_.beforeStart([this, losses] {
    choice_->unlessItDoesNotFit(
        [this, losses] { guards_.unlessLost(losses, [this] { startExercise(); }); });
  });
}

void TrainWorkspace::showChosen() {
  const std::optional<Exercise>& exercise = workstation_.exercise();
  if (!exercise) return;
  choice_->showInUse();
  arms_->setExercise(*exercise);
  exercise_->setExercise(*exercise, toQt(languageInUse()));
  showOutline();
  showCard();
}

void TrainWorkspace::showCard() {
  putCard();
  showSaid();
}

// In the panel, what no card over the views says.
void TrainWorkspace::showSaid() {
  exercise_->setSaidOnCard(!card_->isHidden() || !result_->isHidden(), card_->saysAll());
}

// What is said before it starts; nothing while one runs, or once one has ended and is looked at.
void TrainWorkspace::putCard() {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  const bool idle = phase == Phase::ready || phase == Phase::empty;
  const bool result = result_shown_ && phase == Phase::ready;
  const bool card = !result_shown_ && phase == Phase::ready && !case_views_.carved();
  exercise_->offerCard(!here_ || !aside_ ? QString()
                       : result          ? tr("Show the &result")
                       : card            ? tr("Show &what to do")
                                         : QString());
  const bool opening = workstation_.opensAnotherCase();
  if (!idle || !here_ || opening) {
    card_->hide();
    if (opening || !here_ || phase == Phase::running) result_->hide();
    return;
  }
  if (phase == Phase::empty) return card_->showNoCase();
  result_->setVisible(result && !aside_);
  if (!card || aside_) return card_->hide();
  card_->showExercise(*workstation_.exercise(), toQt(languageInUse()), start_->isEnabled());
}

void TrainWorkspace::putAside(bool aside) {
  aside_ = aside;
  showCard();
  view_->setFocus();
}

void TrainWorkspace::showOutline() {
  const std::optional<Placement>& placed = workstation_.placed();
  if (!placed || !placed->exercise.outline) return view_->setOutline({}, false, 1.0);
  const Exercise& exercise = placed->exercise;
  view_->setOutline(
      outlineOn(exercise, placed->landmarks, *placed->patient.volume, placed->labels.get()),
      exercise.outline->closed, exercise.outline->width_mm);
}

void TrainWorkspace::showLocks() {
  arms_->setLocked(!workstation_.isLocked(Lock::controller) ? QString()
                   : workstation_.policy().isLocked(Lock::controller)
                       ? tr("Locked. %1.").arg(unlockWords(workstation_.policy()))
                       : tr("This exercise keeps its controller. It is changed in Prepare."));
}

void TrainWorkspace::showReset() {
  const Workstation::Phase phase = workstation_.phase();
  const bool ready = phase == Workstation::Phase::ready && !workstation_.isOpening();
  reset_->setEnabled(phase == Workstation::Phase::running || (ready && case_views_.carved()));
}

void TrainWorkspace::showPhase() {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  const bool opening = workstation_.isOpening();
  const bool running = phase == Phase::running, ready = phase == Phase::ready && !opening;
  start_->setEnabled(ready);
  for (QAction* action : {stop_, pause_}) action->setEnabled(running);
  if (!running) {
    pause_->setChecked(false);
    clutch_->setChecked(false);
    rewind_->showIdle();
    notice_->showIdle();
  }
  for (QAction* action : handActions()) action->setEnabled(running);
  showChangeTool();
  showCard();
  showReset();
  view_->setTraining(running);
  views_->setTraining(running);
  switch (phase) {
    case Phase::starting:
      return messages_.hint(tr("Starting\u2026"));
    case Phase::ending:
      return messages_.hint(tr("Ending the recording\u2026"));
    case Phase::running:
      if (workstation_.isPoke()) {
        return messages_.hint(
            tr("Poking: nothing is cut. Mouse: the tool. Wheel up: press. Tab: other "
               "hand. Right drag: turn."));
      }
      if (!pointerHasAHand()) {
        return messages_.hint(
            tr("Space: pause. The arms move the tools. Right drag: turn. Ctrl+wheel: zoom."));
      }
      return messages_.hint(
          tr("Space: pause. Mouse: the tool. Wheel up: press. Tab: other hand. Right drag: turn."));
    default:
      messages_.hint(opening ? tr("Opening a case\u2026")
                     : ready ? tr("Drag: turn. Middle drag: shift. Wheel: zoom. F5: start.")
                             : QString());
  }
}

bool TrainWorkspace::pointerHasAHand() const {
  const Session* session = workstation_.session();
  if (!session) return false;
  for (std::size_t i = 0; i < session->exercise().arms.size(); ++i) {
    if (session->isSimulated(i)) return true;
  }
  return false;
}

void TrainWorkspace::reset() {
  if (Session* session = workstation_.session()) {
    const LoopState state = session->state();
    if (!state.can_undo && !state.can_redo) return;  // nothing was cut
    ask(messages_.window(), "resetQuestion", tr("Put all tissue back?"),
        tr("Undo cannot bring the cuts again; the bar of seconds still leads back to them. Hands "
           "that mouse and keys move go back to where they began."),
        tr("&Put back"), [this] {
          command(CommandKind::reset);
          rewind_->noteReset();
        });
  } else if (workstation_.phase() == Workstation::Phase::ready) {
    guards_.unlessLost({UnsavedWork::cuts}, [this] {
      case_views_.showWholeCase();
      result_shown_ = aside_ = false;
      showCard();
    });
  }
}

void TrainWorkspace::sessionStarted() {
  pedal_ = {};
  messages_.say({});  // of the exercise before
  Session& session = *workstation_.session();
  running_->begin(session);
  if (!session.isPoke()) case_views_.exerciseBegan();
  result_shown_ = aside_ = false;
  hand_bar_->setTissues(session.exercise().tissues);
  hands_->begin(&session);
  frame_timer_.start();
  view_->setFocus();
}

void TrainWorkspace::follow(bool all) {
  Session* session = workstation_.session();
  if (!session) return;
  const LoopState state = session->state();
  running_->showPicture(*session, state);
  followPedal(state);
  hands_->follow();
  running_->showNumbers(*session, state, all);
  workstation_.checkRecording();
  if (session->finished()) workstation_.stop();
}

void TrainWorkspace::command(CommandKind kind) {
  Session* session = workstation_.session();
  if (!session) return;
  if (!session->send(kind)) return messages_.say(tr("Busy: try again in a moment."));
}

bool TrainWorkspace::isRecorded(const Session& session, const RunReport& report) {
  return session.recordingStatus() && report.machine.events_dropped == 0;
}

void TrainWorkspace::sessionEnded(Session& session) {
  frame_timer_.stop();
  hands_->begin(nullptr);
  running_->end(session);
  if (session.isPoke()) return;
  const RunReport report = session.report();
  const bool recorded = isRecorded(session, report);
  case_views_.exerciseEnded(report.done.removed_voxels > 0, recorded);
  if (std::exchange(back_from_trial_, false) && recorded) case_views_.showWholeCase();
  std::error_code ec;
  const bool any = std::filesystem::exists(report.recording, ec);
  messages_.say(session.recordingStatus() ? QString()
                : any                     ? tr("The exercise is recorded in part only.")
                                          : tr("The exercise is not recorded."));
  showResult(session, report);
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
  result.unnamed_mm3 = report.done.removed_unnamed_mm3;
  result.structures = report.structures_cut;
  for (std::size_t i = 0; i < report.done.arms.size(); ++i) {
    result.ways.push_back({handName(session.exercise().arms[i]), report.done.arms[i].path_mm,
                           report.done.arms[i].max_force_N});
  }
  result.recorded = isRecorded(session, report);
  result.late = report.machine.missed_deadlines;
  result.undos = report.done.undos;
  result.rewinds = report.done.rewinds;
  result.brought_back_mm3 = report.done.brought_back_mm3;
  recorded_ = result.recorded;
  result_shown_ = true;
  aside_ = false;
  result_->setResult(result);
  showCard();
}

// The exercise goes on behind the question.
void TrainWorkspace::askToGoOn(const Error& error) {
  QMessageBox* dialog = showError(messages_.window(), error);
  dialog->setObjectName("recordingFailed");
  dialog->setStandardButtons(QMessageBox::NoButton);
  QPushButton* go_on = dialog->addButton(tr("Go on unrecorded"), QMessageBox::AcceptRole);
  QPushButton* stop = dialog->addButton(tr("Stop"), QMessageBox::RejectRole);
  dialog->setDefaultButton(go_on);
  dialog->setEscapeButton(go_on);
  connect(stop, &QPushButton::clicked, &workstation_, [this] { workstation_.stop(); });
  connect(&workstation_, &Workstation::sessionEnded, dialog, &QMessageBox::close);
}

}  // namespace trephine
