#include "ui/train/train_workspace.h"

#include <QMessageBox>
#include <QPushButton>
#include <QShortcut>
#include <algorithm>

#include "base/system.h"
#include "render/tool_view.h"
#include "ui/common/actions.h"
#include "ui/common/error_dialog.h"
#include "ui/common/question.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kFrame_ms = 16;
constexpr int kPanelEvery_ms = 66;  // numbers that change faster cannot be read
constexpr int kRatesEvery_ms = 1000;
constexpr double kBehind_s = 1.0;  // a kill loses less than this of a recording that keeps up

std::vector<ToolView> toolViews(const Scene& scene, const LoopState& state) {
  std::vector<ToolView> tools;
  for (std::size_t i = 0; i < scene.arms.size(); ++i) {
    const SceneTool* tool = scene.findTool(scene.arms[i].tool);
    const ArmRecord& arm = state.record.arms[i];
    if (!tool || !isFinite(arm.proxy_position_mm)) continue;
    const QColor colour = armColour(scene.arms[i], i);
    tools.push_back(toolView(*tool, {arm.proxy_position_mm, arm.proxy_orientation},
                             arm.tissue_class >= 0,
                             Vec3(colour.redF(), colour.greenF(), colour.blueF())));
  }
  return tools;
}

}  // namespace

TrainWorkspace::TrainWorkspace(Bench& bench)
    : Workspace(&bench),
      bench_(bench),
      workstation_(bench.workstation()),
      views_(&bench.views()),
      view_(&bench.view()) {
  buildActions();
  scenes_ = new QComboBox;
  scenes_->setObjectName("scenes");
  scenes_->setToolTip(tr("The exercise"));
  scenes_->setAccessibleName(tr("Exercise"));
  scenes_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  notice_ = new StateNotice(views_);
  rewind_ = new RewindBar;
  arms_ = new ArmsPanel;
  arms_->setMinimumWidth(240);
  connectParts();
  fillScenes();
  frame_timer_.setInterval(kFrame_ms);
  rate_clock_.start();
  panel_clock_.start();
  showPhase();
}

Workspace::Parts TrainWorkspace::parts() {
  Parts parts;
  parts.right = arms_;
  parts.below = rewind_;
  return parts;
}

void TrainWorkspace::buildActions() {
  QWidget& window = *bench_.window();
  start_ = makeAction(window, Symbol::start, "start", tr("Start"), QKeySequence(Qt::Key_F5),
                      tr("Start the exercise"));
  stop_ = makeAction(window, Symbol::stop, "stop", tr("Stop"),
                     QKeySequence(Qt::CTRL | Qt::Key_Period),
                     tr("End the exercise and its recording"));
  pause_ =
      makeAction(window, Symbol::pause, "pause", tr("Pause"), QKeySequence(Qt::CTRL | Qt::Key_P),
                 tr("Hold: no force and no cutting until it is released; in the view Space"));
  pause_->setCheckable(true);
  pause_->setAutoRepeat(false);
  reset_ = makeAction(window, Symbol::reset, "reset", tr("Reset"),
                      QKeySequence(Qt::CTRL | Qt::Key_R), tr("Put all tissue back"));
}

void TrainWorkspace::connectParts() {
  connect(start_, &QAction::triggered, this, &TrainWorkspace::start);
  connect(stop_, &QAction::triggered, &workstation_, &Workstation::stop);
  connect(pause_, &QAction::triggered, this,
          [this](bool on) { command(on ? CommandKind::pause : CommandKind::resume); });
  connect(notice_, &StateNotice::goOnWanted, this, [this] { command(CommandKind::resume); });
  connect(notice_, &StateNotice::forceWanted, this, [this] { command(CommandKind::clear_faults); });
  connect(bench_.undoAction(), &QAction::triggered, this, [this] { command(CommandKind::undo); });
  connect(bench_.redoAction(), &QAction::triggered, this, [this] { command(CommandKind::redo); });
  connect(reset_, &QAction::triggered, this, &TrainWorkspace::reset);
  connect(rewind_, &RewindBar::rewindAsked, this, &TrainWorkspace::rewind);
  // Space belongs to buttons and lists where they have the focus.
  auto* space = new QShortcut(Qt::Key_Space, view_, nullptr, nullptr, Qt::WidgetShortcut);
  space->setAutoRepeat(false);
  connect(space, &QShortcut::activated, pause_, &QAction::trigger);
  connect(arms_, &ArmsPanel::controllerWanted, this, [this](ControllerKind kind) {
    workstation_.setController(kind);
    view_->setFocus();
  });
  connect(scenes_, &QComboBox::activated, this, &TrainWorkspace::chooseScene);
  connect(view_, &ViewWidget::handMoved, this, &TrainWorkspace::moveHand);
  connect(view_, &ViewWidget::framePainted, this, [this] { ++frames_; });

  connect(&bench_, &Bench::caseShown, this, [this] {
    warned_ = false;
    sayWhatIsOpen();
  });
  connect(&bench_, &Bench::cutsChanged, this, &TrainWorkspace::showReset);
  connect(&workstation_, &Workstation::openingEnded, this, &TrainWorkspace::showInUse);
  connect(&workstation_, &Workstation::sceneOpening, this, &TrainWorkspace::showOpening);
  connect(&workstation_, &Workstation::sceneChanged, this, &TrainWorkspace::showScene);
  connect(&workstation_, &Workstation::phaseChanged, this, &TrainWorkspace::showPhase);
  connect(&workstation_, &Workstation::sessionStarted, this, &TrainWorkspace::sessionStarted);
  connect(&workstation_, &Workstation::sessionEnded, this, &TrainWorkspace::sessionEnded);
  connect(&workstation_, &Workstation::recordingFailed, this, &TrainWorkspace::askToGoOn);
  connect(&frame_timer_, &QTimer::timeout, this, &TrainWorkspace::tick);
}

// --- Which exercise ---

void TrainWorkspace::fillScenes() {
  std::vector<std::filesystem::path> files;
  std::error_code ec;
  for (std::filesystem::directory_iterator it(resourceFolder() / "scenes", ec), end;
       !ec && it != end; it.increment(ec)) {
    if (it->path().extension() == ".json") files.push_back(it->path());
  }
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    if (Result<Scene> scene = readScene(file)) scenes_->addItem(toQt(scene->name), toQt(file));
  }
  showInUse();
}

void TrainWorkspace::chooseScene(int index) {
  const auto file = toPath(scenes_->itemData(index).toString());
  showInUse();  // until the other is on its way: it may be asked about, or not be had
  // A built-in case changes with the exercise, and its structures with it.
  const std::optional<Case>& of = workstation_.currentCase();
  std::vector<Bench::Loss> losses{Bench::Loss::cuts, Bench::Loss::tissues};
  if (of && of->built_in) losses.insert(losses.begin(), Bench::Loss::structures);
  bench_.unlessLost(losses, [this, file] { workstation_.useScene(file); });
  view_->setFocus();
}

// In the list of exercises; without a scene, the one that an imported case would get.
void TrainWorkspace::showInUse() {
  const std::optional<Scene>& scene = workstation_.scene();
  if (!scene) {
    scenes_->setCurrentIndex(scenes_->findData(toQt(defaultScene("cranium"))));
    return arms_->showController({});
  }
  const QString file = toQt(workstation_.sceneFile());
  int index = scenes_->findData(file);
  if (index < 0) index = scenes_->findText(toQt(scene->name));
  if (index < 0) {
    scenes_->addItem(toQt(scene->name), file);
    index = scenes_->count() - 1;
  }
  scenes_->setCurrentIndex(index);
  arms_->showController(scene->controller);
}

void TrainWorkspace::showScene() {
  const std::optional<Scene>& scene = workstation_.scene();
  if (!scene) return;
  showInUse();
  arms_->setScene(*scene);
}

// Until it is open, or cannot be had.
void TrainWorkspace::showOpening(const Scene& scene, const std::filesystem::path& file) {
  scenes_->setPlaceholderText(toQt(scene.name));  // where the list has it not yet
  const int index = scenes_->findData(toQt(file));
  scenes_->setCurrentIndex(index >= 0 ? index : scenes_->findText(toQt(scene.name)));
  arms_->showController(scene.controller);
}

// Which exercise the case has, where that is news, and that it is for something else.
void TrainWorkspace::sayWhatIsOpen() {
  const QString exercise = toQt(workstation_.scene()->name);
  QString words;
  if (!exercise_said_.isEmpty() && exercise != exercise_said_) {
    words = tr("The exercise is now \"%1\".").arg(exercise);
  }
  exercise_said_ = exercise;
  for (const Warning& warning : workstation_.currentCase()->warnings) {
    if (warning.code != "OTHER_ANATOMY" && warning.code != "NO_VAULT") continue;
    words += (words.isEmpty() ? "" : " ") + toQt(warning.text) + '.';
  }
  if (!words.isEmpty()) bench_.say(words);
}

// Before an exercise starts on a case that is not what it is for, once a case and exercise.
void TrainWorkspace::unlessItDoesNotFit(Bench::Next go_on) {
  const std::optional<Case>& of = workstation_.currentCase();
  if (!of || of->warnings.empty() || warned_) return go_on();
  QStringList words;
  bool lacks = false, no_place = false;
  std::string fits;
  for (const Warning& warning : of->warnings) {
    words << toQt(warning.text) + (warning.text.ends_with('.') ? "" : ".");
    lacks = lacks || warning.code == "LACKS_STRUCTURE";
    no_place = no_place || warning.code == "NO_LANDMARK";
    if (warning.code == "OTHER_ANATOMY") fits = exerciseAnatomy(of->anatomy->region);
  }
  const QString next = !fits.empty() ? tr("Choose an exercise that fits, or go on as it is.")
                       : lacks    ? tr("Make the structure in the slices first, or go on as it is.")
                       : no_place ? tr("Click where it is to enter (I) first, or go on as it is.")
                                  : tr("Choose an exercise that fits, or go on as it is.");
  QMessageBox* question =
      ask(bench_.window(), "misfitQuestion", words.join('\n'), next, tr("&Go on as it is"), [this, go_on] {
        warned_ = true;
        go_on();
      });
  if (!fits.empty()) {
    const std::filesystem::path file = defaultScene(fits);
    const int index = scenes_->findData(toQt(file));
    auto* other = question->addButton(tr("&Change to \"%1\"").arg(scenes_->itemText(index)),
                                      QMessageBox::AcceptRole);
    other->setObjectName("changeExercise");
    connect(
        other, &QPushButton::clicked, this,
        [this, file] {
          bench_.unlessLost({Bench::Loss::cuts, Bench::Loss::tissues},
                            [this, file] { workstation_.useScene(file); });
        },
        Qt::QueuedConnection);
  } else if (lacks) {
    auto* make = question->addButton(tr("&Make it"), QMessageBox::AcceptRole);
    make->setObjectName("makeStructure");
    connect(make, &QPushButton::clicked, this, &TrainWorkspace::structureWanted,
            Qt::QueuedConnection);
  }
}

// --- The exercise ---

void TrainWorkspace::startExercise(std::optional<OperatorScript> script, double seconds) {
  // What nobody sees moves no arm.
  bench_.go(Place::train);
  if (const Status& drawing = view_->canDraw(); !drawing) return bench_.report(drawing.error());
  workstation_.start(bench_.recordings(), std::move(script),
                     seconds);
}

void TrainWorkspace::start() {
  bench_.beforeStart([this] {
    unlessItDoesNotFit([this] { bench_.unlessLost({Bench::Loss::cuts}, [this] { startExercise(); }); });
  });
}

void TrainWorkspace::showReset() {
  const Workstation::Phase phase = workstation_.phase();
  const bool ready = phase == Workstation::Phase::ready && !workstation_.isOpening();
  reset_->setEnabled(phase == Workstation::Phase::running || (ready && bench_.carved()));
}

void TrainWorkspace::showPhase() {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  const bool opening = workstation_.isOpening();
  const bool running = phase == Phase::running, ready = phase == Phase::ready && !opening;
  scenes_->setEnabled(ready || (phase == Phase::empty && !opening));
  start_->setEnabled(ready);
  for (QAction* action : {stop_, pause_}) action->setEnabled(running);
  if (!running) {
    pause_->setChecked(false);
    rewind_->showIdle();
    notice_->showIdle();
  }
  showReset();
  view_->setTraining(running);
  views_->setTraining(running);
  switch (phase) {
    case Phase::starting:
      return bench_.hint(tr("Starting\u2026"));
    case Phase::ending:
      return bench_.hint(tr("Ending the recording\u2026"));
    case Phase::running:
      return bench_.hint(
          tr("Space: pause. Drag, arrow keys: right hand. Wheel: depth. Shift: left hand."));
    default:
      bench_.hint(opening ? tr("Opening a case\u2026")
                  : ready ? tr("Drag: turn. Middle drag: shift. Wheel: zoom. F5: start.")
                          : QString());
  }
}

void TrainWorkspace::reset() {
  if (Session* session = workstation_.session()) {
    const LoopState& state = session->state();
    if (!state.can_undo && !state.can_redo) return;  // nothing was cut
    ask(bench_.window(), "resetQuestion", tr("Put all tissue back?"),
        tr("Undo cannot bring the cuts again; the bar of seconds still leads back to them. Hands "
           "that mouse and keys move go back to where they began."),
        tr("&Put back"), [this] { command(CommandKind::reset); });
  } else if (workstation_.phase() == Workstation::Phase::ready) {
    bench_.unlessLost({Bench::Loss::cuts}, [this] { bench_.showWholeCase(); });
  }
}

void TrainWorkspace::sessionStarted() {
  bench_.say({});  // of the exercise before
  Session& session = *workstation_.session();
  limits_N_.clear();
  for (const SceneArm& arm : session.scene().arms) limits_N_.push_back(arm.max_force_N);
  going_back_.reset();
  ticks_shown_ = 0;
  rate_clock_.restart();
  bench_.exerciseBegan();
  placeHandPoints();
  frame_timer_.start();
  view_->setFocus();
}

void TrainWorkspace::sessionEnded(Session& session) {
  frame_timer_.stop();
  showState(session, session.state());
  arms_->showIdle();
  arms_->showController(workstation_.scene()->controller);
  showTools({});
  emit ratesChanged({});
  const RunReport report = session.report();
  bench_.exerciseEnded(report.removed_voxels > 0);
  QStringList cut;
  for (const std::string& line : linesOf(report.structures_cut)) cut << toQt(line);
  constexpr int kMost = 2;  // the status bar is one line; the structures' list has them all
  const QString first = QStringList(cut.mid(0, kMost)).join(", ");
  const QString words = session.recordingStatus()
                            ? tr("%1 s, %2 voxels removed%4. Recorded in %3")
                            : tr("%1 s, %2 voxels removed%4. Recorded in part in %3");
  bench_.say(words.arg(double(report.ticks) / report.rate_hz, 0, 'f', 1)
                 .arg(report.removed_voxels)
                 .arg(toQt(std::filesystem::path(report.recording)),
                      first.isEmpty() ? QString() : " (" + first + ')'));
}

void TrainWorkspace::tick() {
  Session* session = workstation_.session();
  if (!session) return;
  const LoopState& state = session->state();
  views_->pullChanges(session->grid());
  showTools(toolViews(session->scene(), state));
  if (panel_clock_.elapsed() >= kPanelEvery_ms) {
    panel_clock_.restart();
    showState(*session, state);
  }
  if (rate_clock_.elapsed() >= kRatesEvery_ms) showRates();
  workstation_.checkRecording();
  if (session->finished()) workstation_.stop();
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
  arms_->showState(shown, session.scene().tissues, limits_N_);
  if (state.ticks > 0 && workstation_.session()) workstation_.noteController(state.controller);
  if (workstation_.session()) {
    pause_->setChecked(state.paused);
    notice_->showState(state, session.scene(), session.standsStillFor_s());
    bench_.undoAction()->setEnabled(state.can_undo);
    bench_.redoAction()->setEnabled(state.can_redo);
    showRewind(state);
  }
}

void TrainWorkspace::showRates() {
  const double seconds = double(rate_clock_.restart()) / 1000.0;
  Session* session = workstation_.session();
  if (!session) return;
  const LoopState& state = session->state();
  const double haptic_hz = double(state.ticks - ticks_shown_) / seconds;
  ticks_shown_ = state.ticks;
  QString rates = tr("%1 pictures/s \u00b7 touch %2 Hz, %3 missed")
                      .arg(double(frames_) / seconds, 0, 'f', 0)
                      .arg(haptic_hz, 0, 'f', 0)
                      .arg(state.missed);
  if (const double behind_s = session->recorderBehind_s(); behind_s >= kBehind_s) {
    rates += tr(" \u00b7 recording %1 s behind").arg(behind_s, 0, 'f', 1);
  }
  emit ratesChanged(rates);
  frames_ = 0;
}

void TrainWorkspace::command(CommandKind kind) {
  Session* session = workstation_.session();
  if (!session) return;
  if (!session->send(kind)) return bench_.say(tr("Busy: try again in a moment."));
  placeHandPoints();  // a reset moves the hands
}

void TrainWorkspace::rewind(std::uint32_t second) {
  Session* session = workstation_.session();
  if (!session) return;
  if (!session->rewind(second)) return bench_.say(tr("Busy: try again in a moment."));
  going_back_ = {second, session->state().ticks};
  showRewind(session->state());
}

void TrainWorkspace::showRewind(const LoopState& state) {
  if (going_back_ && !state.busy && state.ticks > going_back_->asked_tick + Session::kAnswerTicks) {
    bench_.say(backWords(going_back_->second, state, *workstation_.scene()));
    going_back_.reset();
  }
  rewind_->showTime(state.seconds, state.busy || going_back_);
}

// The exercise goes on behind the question.
void TrainWorkspace::askToGoOn(const Error& error) {
  QMessageBox* dialog = showError(bench_.window(), error);
  dialog->setObjectName("recordingFailed");
  dialog->setStandardButtons(QMessageBox::NoButton);
  QPushButton* go_on = dialog->addButton(tr("Go on unrecorded"), QMessageBox::AcceptRole);
  QPushButton* stop = dialog->addButton(tr("Stop"), QMessageBox::RejectRole);
  dialog->setDefaultButton(go_on);
  dialog->setEscapeButton(go_on);
  connect(stop, &QPushButton::clicked, &workstation_, &Workstation::stop);
  connect(&workstation_, &Workstation::sessionEnded, dialog, &QMessageBox::close);
}

}  // namespace trephine
