#include "ui/frame/main_window.h"

#include <QDragEnterEvent>
#include <QFileDialog>
#include <QMessageBox>
#include <QMimeData>
#include <QPushButton>
#include <QSettings>
#include <QStandardPaths>
#include <QStatusBar>
#include <algorithm>

#include "base/system.h"
#include "render/picture.h"
#include "render/tool_view.h"
#include "ui/cases/report_file.h"
#include "ui/common/error_dialog.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kPanelEvery_ms = 66;  // numbers that change faster cannot be read
constexpr int kRatesEvery_ms = 1000;
constexpr int kMessage_ms = 15000;
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

std::filesystem::path ownRecordings() {
  return toPath(QStandardPaths::writableLocation(QStandardPaths::AppDataLocation)) / "sessions";
}

}  // namespace

// --- Opening ---

QWidget* MainWindow::front() {
  return import_->isVisible() ? static_cast<QWidget*>(import_) : this;
}

QFileDialog* MainWindow::fileDialog(const char* name, const QString& title, const QString& filter) {
  auto* dialog = new QFileDialog(front(), title, {}, filter);
  dialog->setObjectName(name);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::ExistingFile);
  // Qt keeps where its dialogs have been, for the next user to read: folders named for patients.
  connect(dialog, &QObject::destroyed, [] {
    QSettings settings(QSettings::UserScope, "QtProject");
    settings.remove("FileDialog/history");
    settings.remove("FileDialog/lastVisited");
  });
  return dialog;
}

void MainWindow::openOnceShown(const std::filesystem::path& path) {
  if (Workstation::isScene(path)) scenes_->setCurrentIndex(-1);
  connect(
      view_, &ViewWidget::framePainted, this,
      [this, path] {
        workstation_.openPath(path);
        if (!workstation_.isOpening()) showInUse();
      },
      Qt::ConnectionType(Qt::QueuedConnection | Qt::SingleShotConnection));
}

void MainWindow::askForFolder() {
  QFileDialog* dialog = fileDialog("folderDialog", tr("Open a folder of CT"));
  dialog->setFileMode(QFileDialog::Directory);
  dialog->setOption(QFileDialog::ShowDirsOnly);
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& folder) { open(toPath(folder)); });
  dialog->open();
}

void MainWindow::askForFile() {
  QFileDialog* dialog =
      fileDialog("fileDialog", tr("Open a file of CT"),
                 tr("Any file (*);;Volumes (*.nii *.nii.gz *.nrrd *.nhdr *.mha *.mhd *.raw)"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& file) { open(toPath(file)); });
  dialog->open();
}

void MainWindow::askForScene() {
  QFileDialog* dialog = fileDialog("sceneDialog", tr("Open a scene"), tr("Scene (*.json)"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this](const QString& file) { open(toPath(file)); });
  dialog->open();
}

void MainWindow::askForLabels() {
  if (workstation_.session()) {
    return say(tr("An exercise is running: stop it, then open structures."));
  }
  QFileDialog* dialog = fileDialog("labelsDialog", tr("Open the case's label map"));
  connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& file) {
    unlessStructuresAreLost([this, file] {
      unlessCutsAreLost([this, file] { workstation_.useLabels(toPath(file)); });
    });
  });
  dialog->open();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  const QList<QUrl> urls = event->mimeData()->urls();
  if (urls.size() == 1 && urls.front().isLocalFile() && open_->isEnabled()) {
    event->acceptProposedAction();
  }
}

void MainWindow::dropEvent(QDropEvent* event) {
  const QList<QUrl> urls = event->mimeData()->urls();
  if (urls.size() != 1 || !urls.front().isLocalFile()) return;
  event->acceptProposedAction();
  open(toPath(urls.front().toLocalFile()));
}

void MainWindow::open(const std::filesystem::path& path) {
  const auto go_on = [this, path] { workstation_.openPath(path); };
  if (Workstation::isScene(path)) {
    return unlessStructuresAreLost([this, go_on] { unlessSceneIsLost(go_on); });
  }
  go_on();
}

// In the list of exercises; without a scene, the one that an imported case would get.
void MainWindow::showInUse() {
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

void MainWindow::showScene() {
  const std::optional<Scene>& scene = workstation_.scene();
  if (!scene) return;
  showInUse();
  setWindowTitle(tr("%1 \u2013 Trephine").arg(toQt(scene->name)));
  tissues_->setTissues(scene->tissues, workstation_.declaredTissues());
  structures_->setWanted(scene->structures);
  showRenderable(scene->controller);
  tissues_->setLooks(workstation_.looks());
  editor_.setTissues(scene->tissues);
  views_->setTissues(scene->tissues, workstation_.looks());
  showSeen();
  views_->setAnatomy(scene->anatomy);
  arms_->setScene(*scene);
}

// Until it is open, or cannot be had.
void MainWindow::showOpening(const Scene& scene, const std::filesystem::path& file) {
  scenes_->setPlaceholderText(toQt(scene.name));  // where the list has it not yet
  const int index = scenes_->findData(toQt(file));
  scenes_->setCurrentIndex(index >= 0 ? index : scenes_->findText(toQt(scene.name)));
  arms_->showController(scene.controller);
}

void MainWindow::showCase() {
  const std::optional<Case>& of = workstation_.currentCase();
  if (!of) return;
  carved_ = unsaved_cuts_ = false;
  showTools({});
  if (Volume mirror = workstation_.takeMirror(); !mirror.hu.empty()) {
    views_->showVolume(std::move(mirror), of->labels, of->volume);
  } else {
    views_->refill(of->volume, of->labels);
  }
  showCaseCard(*of);
  tissues_->setLabelsOpen(of->labels != nullptr);
  openStructures();
  lookAtCase();
  showPhase();
}

void MainWindow::showCaseCard(const Case& of) {
  QString about = sizeWords(of.volume->geometry);
  if (!of.name.empty()) about = toQt(of.name) + '\n' + about;
  if (of.anatomy) {
    switch (of.anatomy->region) {
      case BodyRegion::head:
        about += of.anatomy->vault ? tr("\nA head") : tr("\nA head whose vault is not whole");
        break;
      case BodyRegion::abdomen:
        about += tr("\nAn abdomen");
        break;
      case BodyRegion::not_sure:
        about += tr("\nWhat it shows is not known");
    }
  }
  if (of.structures && !of.structures->structures.empty()) {
    QStringList names;
    for (const Structure& s : of.structures->structures) names << toQt(s.name);
    constexpr int kMost = 6;
    const int more = int(names.size()) - kMost;
    about += tr("\nwith %1").arg(QStringList(names.mid(0, kMost)).join(", "));
    if (more > 0) about += tr(" and %1 more").arg(more);
  }
  case_->showCase(about);
}

void MainWindow::lookAtCase() {
  if (const std::optional<LandmarkFrame> landmark = workstation_.viewLandmark()) {
    views_->setPoint(landmark->position_mm);
    view_->lookAtLandmark(*landmark, workstation_.scene()->view.distance_mm);
  } else {
    view_->lookFromFront();
  }
}

// --- The exercise ---

void MainWindow::startExercise(std::optional<OperatorScript> script, double seconds) {
  // What nobody sees moves no arm.
  if (const Status& drawing = view_->canDraw(); !drawing) return report(drawing.error());
  workstation_.start(recordings_.empty() ? ownRecordings() : recordings_, std::move(script),
                     seconds);
}

void MainWindow::showPhase() {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  const bool opening = workstation_.isOpening();
  const bool running = phase == Phase::running, ready = phase == Phase::ready && !opening;
  const bool may_open = ready || (phase == Phase::empty && !opening);
  for (QAction* action : {open_, open_file_, open_scene_}) action->setEnabled(may_open);
  scenes_->setEnabled(may_open);
  case_->setOpeningAllowed(may_open);
  start_->setEnabled(ready);
  editor_.setLocked(phase == Phase::ready || phase == Phase::empty
                        ? QString()
                        : tr("Structures cannot be changed while an exercise runs: it was started "
                             "on them."));
  for (QAction* action : {stop_, pause_}) action->setEnabled(running);
  if (!running) {
    pause_->setChecked(false);
    showUndo();
    rewind_->showIdle();
    notice_->showIdle();
  }
  reset_->setEnabled(running || (ready && carved_));
  for (QAction* action : {picture_, volume_, look_}) action->setEnabled(phase != Phase::empty);
  view_->setTraining(running);
  views_->setTraining(running);
  showLabelsInUse();
  switch (phase) {
    case Phase::starting:
      hint_->setText(tr("Starting\u2026"));
      break;
    case Phase::ending:
      hint_->setText(tr("Ending the recording\u2026"));
      break;
    case Phase::running:
      hint_->setText(
          tr("Space: pause. Drag, arrow keys: right hand. Wheel: depth. Shift: left hand."));
      break;
    default:
      hint_->setText(opening ? tr("Opening a case\u2026")
                     : ready ? tr("Drag: turn. Middle drag: shift. Wheel: zoom. F5: start.")
                             : QString());
  }
}

void MainWindow::sessionStarted() {
  statusBar()->clearMessage();  // of the exercise before
  Session& session = *workstation_.session();
  limits_N_.clear();
  for (const SceneArm& arm : session.scene().arms) limits_N_.push_back(arm.max_force_N);
  going_back_.reset();
  ticks_shown_ = 0;
  rate_clock_.restart();
  // The view has the case already, unless an earlier exercise left its cuts there.
  const Case& of = *workstation_.currentCase();
  if (carved_) views_->refill(of.volume, of.labels);
  carved_ = true;
  unsaved_cuts_ = false;
  placeHandPoints();
  frame_timer_.start();
  view_->setFocus();
}

void MainWindow::sessionEnded(Session& session) {
  frame_timer_.stop();
  showState(session, session.state());
  arms_->showIdle();
  showRenderable(workstation_.scene()->controller);
  arms_->showController(workstation_.scene()->controller);
  showTools({});
  rates_->clear();
  const RunReport report = session.report();
  unsaved_cuts_ = report.removed_voxels > 0;
  QStringList cut;
  for (const std::string& line : linesOf(report.structures_cut)) cut << toQt(line);
  structures_->say(cut.isEmpty() ? QString() : tr("In the last exercise:") + '\n' + cut.join('\n'));
  constexpr int kMost = 2;  // the status bar is one line; the structures' list has them all
  const QString first = QStringList(cut.mid(0, kMost)).join(", ");
  const QString words = session.recordingStatus()
                            ? tr("%1 s, %2 voxels removed%4. Recorded in %3")
                            : tr("%1 s, %2 voxels removed%4. Recorded in part in %3");
  say(words.arg(double(report.ticks) / report.rate_hz, 0, 'f', 1)
          .arg(report.removed_voxels)
          .arg(toQt(std::filesystem::path(report.recording)),
               first.isEmpty() ? QString() : " (" + first + ')'));
}

void MainWindow::tick() {
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

void MainWindow::showTools(const std::vector<ToolView>& tools) {
  view_->setTools(tools);
  views_->setTools(tools);
}

void MainWindow::showState(Session& session, const LoopState& state) {
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
  if (state.ticks > 0 && controller_shown_ != state.controller) showRenderable(state.controller);
  if (workstation_.session()) {
    pause_->setChecked(state.paused);
    notice_->showState(state, session.scene(), session.standsStillFor_s());
    undo_->setEnabled(state.can_undo);
    redo_->setEnabled(state.can_redo);
    showRewind(state);
  }
}

void MainWindow::showRates() {
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
  rates_->setText(rates);
  frames_ = 0;
}

void MainWindow::command(CommandKind kind) {
  Session* session = workstation_.session();
  if (!session) return;
  if (!session->send(kind)) return say(tr("Busy: try again in a moment."));
  placeHandPoints();  // a reset moves the hands
}

void MainWindow::rewind(std::uint32_t second) {
  Session* session = workstation_.session();
  if (!session) return;
  if (!session->rewind(second)) return say(tr("Busy: try again in a moment."));
  going_back_ = {second, session->state().ticks};
  showRewind(session->state());
}

void MainWindow::showRewind(const LoopState& state) {
  if (going_back_ && !state.busy && state.ticks > going_back_->asked_tick + Session::kAnswerTicks) {
    say(backWords(going_back_->second, state, *workstation_.scene()));
    going_back_.reset();
  }
  rewind_->showTime(state.seconds, state.busy || going_back_);
}

std::size_t MainWindow::armOf(Hand hand) const {
  const std::vector<SceneArm>& arms = workstation_.scene()->arms;
  const std::string name = hand == Hand::right ? "right" : "left";
  for (std::size_t i = 0; i < arms.size(); ++i) {
    if (arms[i].name == name) return i;
  }
  return hand == Hand::right ? arms.size() - 1 : 0;  // a lone arm answers to both
}

void MainWindow::moveHand(Hand hand, const Vec3& by_mm) {
  Session* session = workstation_.session();
  if (!session) return;
  session->moveHand(armOf(hand), by_mm);
  placeHandPoints();
}

void MainWindow::placeHandPoints() {
  const Session* session = workstation_.session();
  for (Hand hand : {Hand::left, Hand::right}) {
    view_->setHandPoint(hand, session->handTarget_mm(armOf(hand)));
  }
}

// --- Saving and saying ---

QFileDialog* MainWindow::saveDialog(const QString& title, const QString& suggestion,
                                    const QString& filter) {
  QFileDialog* dialog = fileDialog("saveDialog", title, filter);
  dialog->setFileMode(QFileDialog::AnyFile);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->selectFile(suggestion);
  dialog->setDefaultSuffix(QFileInfo(suggestion).suffix());
  return dialog;
}

void MainWindow::askWhereToSave(const QString& title, const QString& suggestion,
                                const QString& filter, void (MainWindow::*save)(const QString&)) {
  QFileDialog* dialog = saveDialog(title, suggestion, filter);
  connect(dialog, &QFileDialog::fileSelected, this,
          [this, save](const QString& file) { (this->*save)(file); });
  dialog->open();
}

void MainWindow::savePicture(const QString& file) {
  Result<Picture> picture = view_->picture();
  if (!picture) return report(picture.error());
  workstation_.save(tr("The picture is saved."),
                    [picture = *std::move(picture), path = toPath(file)](const Progress&) {
                      return writePng(picture, path);
                    });
}

void MainWindow::saveReport(const QString& file) {
  workstation_.save(tr("The report is saved."),
                    [report = workstation_.import().report(),
                     path = toPath(file)](const Progress&) { return writeReport(report, path); });
}

void MainWindow::say(const QString& text) {
  statusBar()->showMessage(text, kMessage_ms);
  if (import_->isVisible()) import_->say(text);
}

void MainWindow::report(const Error& error) {
  showError(front(), error);
  emit failed(error);
}

// The exercise goes on behind the question.
void MainWindow::askToGoOn(const Error& error) {
  QMessageBox* dialog = showError(front(), error);
  dialog->setObjectName("recordingFailed");
  dialog->setStandardButtons(QMessageBox::NoButton);
  QPushButton* go_on = dialog->addButton(tr("Go on unrecorded"), QMessageBox::AcceptRole);
  QPushButton* stop = dialog->addButton(tr("Stop"), QMessageBox::RejectRole);
  dialog->setDefaultButton(go_on);
  dialog->setEscapeButton(go_on);
  connect(stop, &QPushButton::clicked, &workstation_, &Workstation::stop);
  connect(&workstation_, &Workstation::sessionEnded, dialog, &QMessageBox::close);
}

void MainWindow::showAbout() {
  auto* box = new QMessageBox(this);
  box->setObjectName("aboutDialog");
  box->setAttribute(Qt::WA_DeleteOnClose);
  box->setWindowTitle(tr("About Trephine"));
  box->setText(tr("Trephine %1").arg(toQt(buildName())));
  box->setInformativeText(tr("Turns a CT into a case on which cutting can be practised with two "
                             "hands, and felt.\n\n%1.\n\n"
                             "Graphics: %2")
                              .arg(purposeText(), toQt(view_->openGlDescription())));
  box->open();
}

}  // namespace trephine
