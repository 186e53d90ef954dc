// The structures in the window: between their panel, the editor, the slices and the workstation.
#include <QFileDialog>
#include <QFileInfo>
#include <QInputDialog>
#include <QMessageBox>
#include <QPushButton>
#include <utility>

#include "base/range.h"
#include "imaging/segmentation/overlap_order.h"
#include "imaging/structure_importer.h"
#include "scene/entry_point.h"
#include "ui/common/question.h"
#include "ui/common/words.h"
#include "ui/frame/main_window.h"
#include "ui/structures/overlap_dialog.h"
#include "ui/structures/structure_report.h"
#include "volume/segmentation.h"

namespace trephine {

namespace {
constexpr int kSettled_ms = 500;  // after the last change the exercise is placed in them
constexpr double kStructureOpacity = 0.4;
}  // namespace

void MainWindow::connectStructures() {
  connect(structures_, &StructurePanel::toolChosen, views_, &FourUp::setTool);
  connect(structures_, &StructurePanel::brushChanged, this,
          [this] { views_->setBrushRadius(structures_->brushRadius_mm()); });
  connect(structures_, &StructurePanel::openWanted, this, &MainWindow::askForLabels);
  connect(structures_, &StructurePanel::saveWanted, this, &MainWindow::askToSaveStructures);
  connectExports();
  connect(views_, &FourUp::toolChanged, this, &MainWindow::structureToolChanged);
  connect(views_, &FourUp::structureClicked, this, [this](SliceTool tool, const Vec3& at_mm) {
    if (tool == SliceTool::grow) {
      editor_.growAt(at_mm, structures_->name(), structures_->growing());
    } else if (tool == SliceTool::piece) {
      editor_.keepPieceAt(at_mm);
    }
  });
  connect(views_, &FourUp::boxDrawn, &editor_, &StructureEditor::limitTo);
  connect(&editor_, &StructureEditor::boxChanged, this, [this] { views_->setBox(editor_.box()); });
  connect(views_, &FourUp::strokeBegan, this, [this](const Vec3& at_mm, int across) {
    const SliceTool tool = views_->tool();
    const Brush brush = structures_->brush(tool, across);
    if (tool == SliceTool::wall) return editor_.beginWall(at_mm, brush);
    editor_.beginStroke(at_mm, brush, structures_->name());
  });
  connect(views_, &FourUp::entryChosen, this, &MainWindow::placeEntry);
  connect(views_, &FourUp::entryLeft, this, &MainWindow::leaveEntry);
  connect(views_, &FourUp::strokeMoved, &editor_, &StructureEditor::moveStroke);
  connect(views_, &FourUp::strokeEnded, &editor_, &StructureEditor::endStroke);
  connect(views_, &FourUp::structureKey, this, &MainWindow::structureKey);
  connect(views_, &FourUp::nothingThere, this, [this] {
    structures_->say(tr("Nothing solid is seen there: ghosts are passed through."));
  });
  connect(structures_, &StructurePanel::lookWanted, this, &MainWindow::structureLookWanted);
  connect(structures_, &StructurePanel::opacityWanted, this, [this](int label, double per_mm) {
    structure_looks_[label].opacity = per_mm;
    showSeen();
  });
  connect(structures_, &StructurePanel::colourChosen, this, [this](int label, const Vec3& colour) {
    structure_looks_[label].colour = colour;
    showSeen();
  });
  connect(structures_, &StructurePanel::decided, this, [this] { view_->setFocus(); });
  connect(&editor_, &StructureEditor::changed, this, [this](const VoxelBox& box) {
    if (views_->mirror().labels() == editor_.map()) views_->labelsChanged(box);
    settled_.start();
  });
  connect(&editor_, &StructureEditor::listChanged, this, [this] {
    if (views_->mirror().labels() == editor_.map()) views_->showLabels(editor_.map());  // colours
    showLabelsInUse();
    settled_.start();
  });
  connect(&editor_, &StructureEditor::stateChanged, this, [this] {
    showUndo();
    settled_.start();
  });
  connect(&editor_, &StructureEditor::failed, this, &MainWindow::report);
  settled_.setSingleShot(true);
  settled_.setInterval(kSettled_ms);
  connect(&settled_, &QTimer::timeout, this, [this] { (void)takeStructures(); });
  connect(&workstation_, &Workstation::structuresChanged, this, &MainWindow::showStructures);
  connect(&workstation_, &Workstation::placingFailed, this, &MainWindow::placingFailed);
  connect(&workstation_, &Workstation::structuresAsked, this, &MainWindow::askAboutStructures);
  connect(&workstation_, &Workstation::overlapAsked, this, &MainWindow::askAboutOverlap);
  connect(&workstation_, &Workstation::thresholdAsked, this, &MainWindow::askForThreshold);
  connect(left_, &QTabWidget::currentChanged, this, [this] { showStructureTab(); });
  views_->setBrushRadius(structures_->brushRadius_mm());
}

bool MainWindow::structuresShown() const {
  return left_->currentIndex() == kStructureTab && editor_.hasCase();
}

// What was made or changed is what the next exercise runs on. True where nothing waits any more.
bool MainWindow::takeStructures() {
  if (!editor_.hasCase() || workstation_.isOpening()) return false;
  if (workstation_.phase() != Workstation::Phase::ready) return true;
  const std::shared_ptr<const LabelMap> made = editor_.takeEdited();
  if (!made) return true;
  own_structures_ = made;
  return workstation_.useStructures(made);
}

// The scene was placed in other structures: made here, or read.
void MainWindow::showStructures() {
  const Case& of = *workstation_.currentCase();
  if (of.structures != own_structures_) {
    structure_looks_.clear();
    editor_.setCase(of.volume, of.structures);
    own_structures_ = of.structures;
    QStringList words;
    for (const Warning& warning : of.structure_warnings) words << toQt(warning.text);
    structures_->say(words.join('\n'));
    left_->setCurrentIndex(kStructureTab);
    showStructureReport();
  }
  if (carved_ && !unsaved_cuts_) showWholeCase();
  tissues_->setLabelsOpen(of.labels != nullptr);
  showCaseCard(of);
  showStructureTab();
  showEntry();
  if (std::exchange(entry_asked_, false)) lookAtCase();
  // Not by a dialog: it would come with every stroke.
  if (of.misfit) structures_->say(toQt(of.misfit->sentence()));
  settled_.start();  // what was changed meanwhile
  if (std::exchange(start_when_placed_, false)) {
    QMetaObject::invokeMethod(this, &MainWindow::start, Qt::QueuedConnection);
  }
}

// Nothing waits for it any more, and nothing that was made is lost.
void MainWindow::placingFailed() {
  entry_asked_ = start_when_placed_ = false;
  own_structures_ = workstation_.currentCase()->structures;
  editor_.giveBack();
  showEntry();
}

// Of those that came from a file: beside the window, which goes on.
void MainWindow::showStructureReport() {
  const Case& of = *workstation_.currentCase();
  if (auto* before = findChild<StructureReport*>()) before->close();  // of another file
  if (of.structure_cards.empty()) return;
  (new StructureReport(of, this))->show();
}

// Of a case that was opened.
void MainWindow::openStructures() {
  const Case& of = *workstation_.currentCase();
  if (of.structures != own_structures_) showStructureReport();
  if (of.structures != own_structures_ || !editor_.isOf(of.volume)) {  // not another exercise alone
    structure_looks_.clear();
    views_->setTool(SliceTool::window);  // what was in hand was for another case
    structures_->suitVoxels(of.volume->geometry.spacing_mm);
    editor_.setCase(of.volume, of.structures);
  }
  own_structures_ = of.structures;
  structures_->setWanted(workstation_.scene()->structures);
  structures_->setSourceAtHand(sourceAtHand());
  warned_ = false;
  showStructureTab();
  showEntry();
  sayWhatIsOpen();
  for (const Warning& warning : of.warnings) {
    if (warning.code == "OTHER_ANATOMY") return;  // another exercise comes first
  }
  for (const Warning& warning : of.warnings) {
    if (warning.code != "LACKS_STRUCTURE") continue;
    // What is missing is offered to be made at once.
    left_->setCurrentIndex(kStructureTab);
    views_->setTool(SliceTool::grow);
    structures_->say(tr("The exercise needs the structure \"%1\", which the case lacks: click into "
                        "it, well inside. Or start at once: tissue is then told by its HU.")
                         .arg(structures_->name()));
  }
}

// Which exercise the case has, where that is news, and that it is for something else.
void MainWindow::sayWhatIsOpen() {
  const QString exercise = scenes_->currentText();
  QString words;
  if (!exercise_said_.isEmpty() && exercise != exercise_said_) {
    words = tr("The exercise is now \"%1\".").arg(exercise);
  }
  exercise_said_ = exercise;
  for (const Warning& warning : workstation_.currentCase()->warnings) {
    if (warning.code != "OTHER_ANATOMY" && warning.code != "NO_VAULT") continue;
    words += (words.isEmpty() ? "" : " ") + toQt(warning.text) + '.';
  }
  if (!words.isEmpty()) say(words);
}

// The slices show what the panel lists while it is in front, else what the exercise runs on.
void MainWindow::showStructureTab() {
  showLabelsInUse();
  showUndo();
  if (structuresShown()) {
    if (views_->colours().overlay() != Overlay::labels) {
      views_->setOverlay(Overlay::labels, kStructureOpacity);
    }
    if (views_->viewLayout().kind == ViewLayout::Kind::single && views_->viewLayout().large == 0) {
      views_->setLayout({ViewLayout::Kind::four, 0});  // they are made in slices
    }
  } else if (isForStructures(views_->tool())) {
    views_->setTool(SliceTool::window);
  }
}

void MainWindow::structureToolChanged(SliceTool tool) {
  if (isForStructures(tool) && left_->currentIndex() != kStructureTab) {
    left_->setCurrentIndex(kStructureTab);
  }
  structures_->showTool(tool);
  if (tool == SliceTool::entry) {
    say(
        tr("Click where the exercise enters; drag to where the instrument comes from. Del: back to "
           "its own place."));
  }
}

// --- The entry point ---

void MainWindow::placeEntry(const Vec3& at_mm, const Vec3& from_mm) {
  const std::optional<Case>& of = workstation_.currentCase();
  if (workstation_.phase() != Workstation::Phase::ready || !of) {
    return say(tr("The entry point cannot be changed while an exercise runs: stop it first."));
  }
  const Scene& scene = *workstation_.scene();
  const Landmark* landmark = entryLandmark(scene);
  if (!landmark) return say(tr("This exercise is fixed in its own patient."));
  Vec3 outward = from_mm - at_mm;
  if (!(glm::length(outward) > 0.0)) {
    const auto out =
        outwardAt(*of->volume, scene.tissues, of->labels.get(), landmark->tissue, at_mm);
    const auto before = workstation_.viewLandmark();
    outward = out ? *out : before ? before->rotation * Vec3(0.0, 0.0, 1.0) : Vec3(0.0, -1.0, 0.0);
  }
  const Landmark entry = placedAt(*landmark, at_mm, glm::normalize(outward));
  unlessCutsAreLost([this, entry] {
    entry_asked_ = workstation_.placeEntry(entry);
    say(entry_asked_ ? tr("The exercise enters here now. Del: back to its own place.")
                     : tr("Busy: try again in a moment."));
  });
}

void MainWindow::leaveEntry() {
  if (!workstation_.entry()) return say(tr("The exercise enters at its own place."));
  unlessCutsAreLost([this] {
    entry_asked_ = workstation_.placeEntry({});
    say(entry_asked_ ? tr("The exercise enters at its own place again.")
                     : tr("Busy: try again in a moment."));
  });
}

void MainWindow::showEntry() {
  const auto frame = workstation_.viewLandmark();
  if (!frame) return views_->setEntry({});
  views_->setEntry(SliceView::Entry{frame->position_mm, frame->rotation * Vec3(0.0, 0.0, 1.0)});
}

void MainWindow::structureKey(int key) {
  switch (key) {
    case Qt::Key_K:
      left_->setCurrentIndex(kStructureTab);
      return editor_.makeSkull();
    case Qt::Key_S:
      left_->setCurrentIndex(kStructureTab);
      return structures_->makeSkin();
    case Qt::Key_V:
      return structures_->nextLook();
    case Qt::Key_Escape:
      return editor_.preview() ? editor_.leavePreview() : views_->setTool(SliceTool::window);
    case Qt::Key_BracketLeft:
    case Qt::Key_BracketRight:
      return structures_->stepRadius(key == Qt::Key_BracketRight ? 1 : -1);
    default:
      editor_.takePreview();
  }
}

// Without an exercise they are the structures', while those are in front. Cuts that an exercise
// left in the view are no step of theirs: there the panel's own buttons serve.
void MainWindow::showUndo() {
  if (workstation_.phase() == Workstation::Phase::running) return;
  const bool serve = structuresShown() && !unsaved_cuts_;
  const auto undo = serve ? editor_.undoText() : std::nullopt;
  const auto redo = serve ? editor_.redoText() : std::nullopt;
  undo_->setEnabled(undo.has_value());
  redo_->setEnabled(redo.has_value());
  undo_->setToolTip(undo            ? tr("Undo: %1").arg(*undo)
                    : unsaved_cuts_ ? tr("The exercise has ended: its cuts stay until Reset")
                                    : tr("Nothing to undo"));
  redo_->setToolTip(redo ? tr("Redo: %1").arg(*redo) : tr("Nothing to redo"));
}

void MainWindow::askAboutStructures(const Error& error, const std::filesystem::path& file,
                                    const Answers& answers, const std::string& option) {
  ask(front(), "structuresQuestion", toQt(error.what) + '.',
      tr("What is used as it is may be felt and cut in the wrong place."),
      tr("&Use it all the same"),
      [this, file, answers = answers, code = error.code, option]() mutable {
        answers[code] = option;
        workstation_.useLabels(file, answers);
      });
}

void MainWindow::askAboutOverlap(const std::vector<std::string>& names,
                                 const std::filesystem::path& file, const Answers& answers) {
  auto* dialog = new OverlapDialog(names, front());
  connect(dialog, &QDialog::accepted, this, [this, dialog, file, answers = answers]() mutable {
    answers["OVERLAP"] = orderAnswer(dialog->order());
    workstation_.useLabels(file, answers);
  });
  dialog->open();
}

void MainWindow::askForThreshold(const std::filesystem::path& file, const Answers& answers) {
  auto* dialog = new QInputDialog(front());
  dialog->setObjectName("thresholdQuestion");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("A fractional segmentation"));
  dialog->setLabelText(
      tr("The file says how much of each voxel a structure has, from 0 to 1.\n"
         "A voxel is the structure's from this share on:"));
  dialog->setInputMode(QInputDialog::DoubleInput);
  dialog->setDoubleRange(0.0, 1.0);
  dialog->setDoubleDecimals(2);
  dialog->setDoubleStep(0.05);
  dialog->setDoubleValue(StructureRequest().threshold);
  connect(dialog, &QInputDialog::doubleValueSelected, this,
          [this, file, answers = answers](double value) mutable {
            answers[Workstation::kThreshold] = plainNumber(value);
            workstation_.useLabels(file, answers);
          });
  dialog->open();
}

// False, and said, where writing there would take a file of the case.
bool MainWindow::keepsTheCase(const std::filesystem::path& target) {
  const std::string scene_case = workstation_.scene() ? workstation_.scene()->case_source : "";
  for (const std::string& source : {case_source_.string(), scene_case}) {
    const Status kept = keepsCase(target, source);
    if (kept) continue;
    report(kept.error());
    return false;
  }
  return true;
}

// What was grown and reaches too far, perhaps, before an exercise runs on it.
void MainWindow::askAboutPreview() {
  QMessageBox* question = ask(
      this, "previewQuestion", tr("What was grown does not count yet, and may be too large."),
      tr("Look at it in the slices first, or start with it or without."), tr("&Take it"), [this] {
        editor_.takePreview();
        start();
      });
  auto* without = question->addButton(tr("Start &without it"), QMessageBox::AcceptRole);
  without->setObjectName("startWithout");
  connect(
      without, &QPushButton::clicked, this,
      [this] {
        editor_.leavePreview();
        start();
      },
      Qt::QueuedConnection);
}

void MainWindow::askToSaveStructures() {
  saveStructuresThen({});
}

void MainWindow::saveStructuresThen(std::function<void()> then) {
  // As they are now: another case may come while the dialog stands.
  const std::shared_ptr<const LabelMap> copy = editor_.finished();
  if (!copy) return say(tr("There is no structure to save."));
  const std::uint64_t changes = editor_.changes();
  QFileDialog* dialog = saveDialog(
      tr("Save structures"), "structures.nii.gz",
      tr("NIfTI with names beside it (*.nii.gz *.nii);;3D Slicer (*.seg.nrrd *.nrrd);;MetaImage "
         "with names beside it (*.mha)"));
  connect(dialog, &QFileDialog::fileSelected, this,
          [this, copy, changes, then = std::move(then)](const QString& file) {
            if (!keepsTheCase(structuresFile(toPath(file))) || !keepsTheCase(toPath(file))) return;
            workstation_.save(
                tr("The structures are saved as %1.").arg(QFileInfo(file).fileName()),
                [copy, path = toPath(file)](const Progress& progress) {
                  return writeSegmentation(*copy, path, false, progress);
                },
                [this, changes, then] {
                  editor_.markSaved(changes);
                  if (then) then();
                });
          });
  dialog->open();
}

void MainWindow::unlessStructuresAreLost(std::function<void()> go_on) {
  if (!editor_.edited()) return go_on();
  QMessageBox* question = ask(front(), "structuresUnsaved",
                              tr("The structures have been made or changed and not saved."),
                              tr("Going on takes them away."), tr("&Go on without them"), go_on);
  auto* save = question->addButton(tr("&Save structures\u2026"), QMessageBox::AcceptRole);
  save->setObjectName("saveFirst");
  connect(
      save, &QPushButton::clicked, this,
      [this, go_on = std::move(go_on)] { saveStructuresThen(go_on); }, Qt::QueuedConnection);
}

// Before an exercise starts on a case that is not what it is for, once a case and exercise.
void MainWindow::unlessItDoesNotFit(std::function<void()> go_on) {
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
      ask(this, "misfitQuestion", words.join('\n'), next, tr("&Go on as it is"), [this, go_on] {
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
        [this, file] { unlessSceneIsLost([this, file] { workstation_.useScene(file); }); },
        Qt::QueuedConnection);
  } else if (lacks) {
    auto* make = question->addButton(tr("&Make it"), QMessageBox::AcceptRole);
    make->setObjectName("makeStructure");
    connect(
        make, &QPushButton::clicked, this,
        [this] {
          left_->setCurrentIndex(kStructureTab);
          views_->setTool(SliceTool::grow);
          structures_->offerWanted();
        },
        Qt::QueuedConnection);
  }
}

}  // namespace trephine
