// The structures: between their panel, the editor, the slices and the workstation.
#include <QFileDialog>
#include <QFileInfo>
#include <QInputDialog>
#include <QMessageBox>
#include <QPushButton>
#include <utility>

#include "base/range.h"
#include "exercise/entry_point.h"
#include "imaging/segmentation/overlap_order.h"
#include "imaging/structure_importer.h"
#include "tissue/tissue_edits.h"
#include "ui/common/question.h"
#include "ui/common/words.h"
#include "ui/prepare/prepare_workspace.h"
#include "ui/structures/overlap_dialog.h"
#include "ui/structures/structure_report.h"
#include "volume/segmentation.h"

namespace trephine {

namespace {
constexpr int kSettled_ms = 500;  // after the last change the exercise is placed in them
constexpr double kStructureOpacity = 0.4;
}  // namespace

void PrepareWorkspace::connectStructures() {
  connect(structures_, &StructurePanel::toolChosen, views_, &FourUp::setTool);
  connect(structures_, &StructurePanel::brushChanged, this,
          [this] { views_->setBrushRadius(structures_->brushRadius_mm()); });
  connect(structures_, &StructurePanel::openWanted, this, &PrepareWorkspace::askForLabels);
  connect(structures_, &StructurePanel::saveWanted, this, &PrepareWorkspace::askToSaveStructures);
  connect(views_, &FourUp::toolChanged, this, &PrepareWorkspace::structureToolChanged);
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
  connect(views_, &FourUp::entryChosen, this, &PrepareWorkspace::placeEntry);
  connect(views_, &FourUp::entryLeft, this, &PrepareWorkspace::leaveEntry);
  connect(views_, &FourUp::strokeMoved, &editor_, &StructureEditor::moveStroke);
  connect(views_, &FourUp::strokeEnded, &editor_, &StructureEditor::endStroke);
  connect(views_, &FourUp::structureKey, this, &PrepareWorkspace::structureKey);
  connect(views_, &FourUp::nothingThere, this, [this] {
    structures_->say(tr("Nothing solid is seen there: ghosts are passed through."));
  });
  connect(structures_, &StructurePanel::lookWanted, this, &PrepareWorkspace::structureLookWanted);
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
  connect(&editor_, &StructureEditor::failed, &app_, &AppContext::report);
  settled_.setParent(this);
  settled_.setObjectName("structuresSettled");
  settled_.setSingleShot(true);
  settled_.setInterval(kSettled_ms);
  connect(&settled_, &QTimer::timeout, this, [this] { (void)takeStructures(); });
  app_.setGuard(AppContext::UnsavedWork::structures,
                [this](AppContext::Next go_on) { unlessStructuresAreLost(std::move(go_on)); });
  app_.setBeforeStart([this](AppContext::Next go_on) { beforeStart(std::move(go_on)); });
  connect(app_.undoAction(), &QAction::triggered, this, [this] {
    if (editsServe()) return workstation_.undoEdit();
    if (!workstation_.session()) editor_.undo();
  });
  connect(app_.redoAction(), &QAction::triggered, this, [this] {
    if (editsServe()) return workstation_.redoEdit();
    if (!workstation_.session()) editor_.redo();
  });
  connect(&app_, &AppContext::cutsChanged, this, &PrepareWorkspace::showUndo);
  connect(&app_, &AppContext::caseShown, this, [this] {
    tissues_->setLabelsOpen(workstation_.placed()->labels != nullptr);
    openStructures();
  });
  connect(&workstation_, &Workstation::phaseChanged, this, [this] {
    const Workstation::Phase phase = workstation_.phase();
    editor_.setLocked(phase == Workstation::Phase::ready || phase == Workstation::Phase::empty
                          ? QString()
                          : tr("Structures cannot be changed while an exercise runs: it was "
                               "started on them."));
    showUndo();
    showLabelsInUse();
  });
  connect(&workstation_, &Workstation::exerciseReported, this, [this](const RunReport& report) {
    QStringList cut;
    for (const std::string& line : linesOf(report.structures_cut)) cut << toQt(line);
    structures_->say(cut.isEmpty() ? QString()
                                   : tr("In the last exercise:") + '\n' + cut.join('\n'));
  });
  connect(&workstation_, &Workstation::structuresChanged, this, &PrepareWorkspace::showStructures);
  connect(&workstation_, &Workstation::placingFailed, this, &PrepareWorkspace::placingFailed);
  connect(&workstation_, &Workstation::asked, this, &PrepareWorkspace::askAboutStructures);
  connect(tabs_, &QTabWidget::currentChanged, this, [this] {
    showTab();
    showStructureTab();
  });
  views_->setBrushRadius(structures_->brushRadius_mm());
}

bool PrepareWorkspace::structuresShown() const {
  return here_ && tabs_->currentIndex() == kStructureTab && editor_.hasCase();
}

// What was made or changed is what the next exercise runs on. True where nothing waits any more.
bool PrepareWorkspace::takeStructures() {
  if (!editor_.hasCase() || workstation_.isOpening()) return false;
  if (workstation_.phase() != Workstation::Phase::ready) return true;
  const std::shared_ptr<const LabelMap> made = editor_.takeEdited();
  if (!made) return true;
  own_structures_ = made;
  return workstation_.useStructures(made);
}

// The exercise was placed in other structures: made here, or read.
void PrepareWorkspace::showStructures() {
  const Case& of = *workstation_.currentCase();
  if (of.structures != own_structures_) {
    structure_looks_.clear();
    editor_.setCase(of.volume, of.structures);
    in_case_.reset();
    own_structures_ = of.structures;
    QStringList words;
    for (const Warning& warning : of.structure_warnings) words << toQt(warning.text);
    structures_->say(words.join('\n'));
    tabs_->setCurrentIndex(kStructureTab);
    showStructureReport();
  }
  if (app_.carved() && !app_.cutsUnsaved()) app_.showWholeCase();
  tissues_->setLabelsOpen(workstation_.placed()->labels != nullptr);
  showStructureTab();
  showEntry();
  if (std::exchange(entry_asked_, false)) app_.lookAtCase();
  // Not by a dialog: it would come with every stroke.
  if (const auto& why = workstation_.placed()->error) structures_->say(toQt(why->sentence()));
  settled_.start();  // what was changed meanwhile
  if (AppContext::Next start = std::exchange(start_when_placed_, {})) {
    QMetaObject::invokeMethod(
        this, [this, start] { beforeStart(start); }, Qt::QueuedConnection);
  }
}

// Nothing waits for it any more, and nothing that was made is lost.
void PrepareWorkspace::placingFailed() {
  entry_asked_ = false;
  start_when_placed_ = {};
  own_structures_ = workstation_.currentCase()->structures;
  editor_.giveBack();
  showEntry();
}

// Of those that came from a file: beside the window, which goes on.
void PrepareWorkspace::showStructureReport() {
  const Case& of = *workstation_.currentCase();
  if (auto* before = app_.window()->findChild<StructureReport*>())
    before->close();  // of another file
  if (of.structure_cards.empty()) return;
  (new StructureReport(of, app_.window()))->show();
}

// Of a case that was opened.
void PrepareWorkspace::openStructures() {
  const Case& of = *workstation_.currentCase();
  if (of.structures != own_structures_) showStructureReport();
  if (of.structures != own_structures_ || !editor_.isOf(of.volume)) {  // not another exercise alone
    structure_looks_.clear();
    views_->setTool(SliceTool::window);  // what was in hand was for another case
    structures_->suitVoxels(of.volume->geometry.spacing_mm);
    editor_.setCase(of.volume, of.structures);
    in_case_ = editor_.changes();
    tissues_touched_ = false;
  }
  own_structures_ = of.structures;
  structures_->setWanted(workstation_.exercise()->structures);
  structures_->setSourceAtHand(sourceAtHand());
  showStructureTab();
  showEntry();
  if (here_) (void)offerMissing();
}

// What is missing is offered to be made at once. False: the exercise lacks nothing that could be.
bool PrepareWorkspace::offerMissing() {
  const std::optional<Placement>& of = workstation_.placed();
  if (!of || workstation_.session()) return false;
  bool lacks = false;
  for (const Warning& warning : of->warnings) {
    if (warning.code == "OTHER_ANATOMY") return false;  // another exercise comes first
    lacks = lacks || warning.code == "LACKS_STRUCTURE";
  }
  if (!lacks) return false;
  tabs_->setCurrentIndex(kStructureTab);
  views_->setTool(SliceTool::grow);
  structures_->say(tr("The exercise needs the structure \"%1\", which the case lacks: click into "
                      "it, well inside. Or start at once: tissue is then told by its HU.")
                       .arg(structures_->name()));
  return true;
}

void PrepareWorkspace::makeMissing() {
  app_.go(Place::prepare);
  tabs_->setCurrentIndex(kStructureTab);
  views_->setTool(SliceTool::grow);
  structures_->offerWanted();
}

// The slices show what the panel lists while it is in front, else what the exercise runs on.
void PrepareWorkspace::showStructureTab() {
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

void PrepareWorkspace::structureToolChanged(SliceTool tool) {
  if (isForStructures(tool) && !here_) {
    views_->setTool(SliceTool::window);
    return app_.say(tr("Structures are made in Prepare (Ctrl+2)."));
  }
  if (isForStructures(tool)) tabs_->setCurrentIndex(kStructureTab);
  structures_->showTool(tool);
  if (tool == SliceTool::entry) {
    app_.say(
        tr("Click where the exercise enters; drag to where the instrument comes from. Del: back to "
           "its own place."));
  }
}

// --- The entry point ---

void PrepareWorkspace::placeEntry(const Vec3& at_mm, const Vec3& from_mm) {
  const Case* of = workstation_.currentCase();
  if (workstation_.phase() != Workstation::Phase::ready || !of) {
    return app_.say(tr("The entry point cannot be changed while an exercise runs: stop it first."));
  }
  const Exercise& exercise = *workstation_.exercise();
  const Landmark* landmark = entryLandmark(exercise);
  if (!landmark) return app_.say(tr("This exercise is fixed in its own patient."));
  Vec3 outward = from_mm - at_mm;
  if (!(glm::length(outward) > 0.0)) {
    const auto out = outwardAt(*of->volume, workstation_.placedTissues(),
                               workstation_.placed()->labels.get(), landmark->tissue, at_mm);
    const auto before = workstation_.viewLandmark();
    outward = out ? *out : before ? before->rotation * Vec3(0.0, 0.0, 1.0) : Vec3(0.0, -1.0, 0.0);
  }
  const Landmark entry = placedAt(*landmark, at_mm, glm::normalize(outward));
  app_.unlessLost({AppContext::UnsavedWork::cuts}, [this, entry] {
    entry_asked_ = workstation_.placeEntry(entry);
    if (entry_asked_ && exercise_->wantsOneEntry()) views_->setTool(SliceTool::window);
    app_.say(entry_asked_ ? tr("The exercise enters here now. Del: back to its own place.")
                          : tr("Busy: try again in a moment."));
  });
}

void PrepareWorkspace::leaveEntry() {
  if (!workstation_.entry()) return app_.say(tr("The exercise enters at its own place."));
  app_.unlessLost({AppContext::UnsavedWork::cuts}, [this] {
    entry_asked_ = workstation_.placeEntry({});
    app_.say(entry_asked_ ? tr("The exercise enters at its own place again.")
                          : tr("Busy: try again in a moment."));
  });
}

void PrepareWorkspace::showEntry() {
  const auto frame = workstation_.viewLandmark();
  if (!frame) return views_->setEntry({});
  views_->setEntry(SliceView::Entry{frame->position_mm, frame->rotation * Vec3(0.0, 0.0, 1.0)});
}

void PrepareWorkspace::structureKey(int key) {
  if (!here_ && key != Qt::Key_V && key != Qt::Key_Escape) {
    return app_.say(tr("Structures are made in Prepare (Ctrl+2)."));
  }
  switch (key) {
    case Qt::Key_K:
      tabs_->setCurrentIndex(kStructureTab);
      return editor_.makeSkull();
    case Qt::Key_S:
      tabs_->setCurrentIndex(kStructureTab);
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
void PrepareWorkspace::showUndo() {
  if (editsServe()) return showHistory();
  if (workstation_.phase() == Workstation::Phase::running) return;
  const bool serve = structuresShown() && !app_.cutsUnsaved();
  const auto undo = serve ? editor_.undoText() : std::nullopt;
  const auto redo = serve ? editor_.redoText() : std::nullopt;
  QAction *undo_action = app_.undoAction(), *redo_action = app_.redoAction();
  undo_action->setEnabled(undo.has_value());
  redo_action->setEnabled(redo.has_value());
  undo_action->setToolTip(undo ? tr("Undo: %1").arg(*undo)
                          : app_.cutsUnsaved()
                              ? tr("The exercise has ended: its cuts stay until Reset")
                              : tr("Takes back the last change; there is none"));
  redo_action->setToolTip(redo ? tr("Redo: %1").arg(*redo)
                               : tr("Brings back what was taken back; there is nothing"));
}

// Without an answer nothing changes.
void PrepareWorkspace::askAboutStructures(const StructureQuestion& question) {
  switch (question.asked.kind) {
    case StructureAsked::Kind::option: return askForOption(question.asked.choice);
    case StructureAsked::Kind::order: return askForOrder(question.asked.names);
    case StructureAsked::Kind::threshold: return askForThreshold();
  }
}

void PrepareWorkspace::askForOption(const Choice& choice) {
  const auto use = [this](const std::string& option) {
    return [this, option] { workstation_.answer(option); };
  };
  const auto words = [](const std::string& option) {
    return option == "ct"       ? tr("&Put it on the CT, voxel by voxel")
           : option == "sform"  ? tr("Take its &sform")
           : option == "qform"  ? tr("Take its &qform")
           : option == "pixdim" ? tr("Take the steps of its &pixdim")
                                : tr("&Use it all the same");
  };
  const std::vector<std::string>& options = choice.options;
  QMessageBox* question =
      ask(app_.window(), "structuresQuestion", toQt(choice.question) + '.',
          tr("What is used as it is may be felt and cut in the wrong place."),
          words(options.front()), use(options.front()));
  for (std::size_t n = 1; n < options.size(); ++n) {
    orElse(*question, "otherForm", words(options[n]), use(options[n]));
  }
}

void PrepareWorkspace::askForOrder(const std::vector<std::string>& names) {
  auto* dialog = new OverlapDialog(names, app_.window());
  connect(dialog, &QDialog::accepted, this,
          [this, dialog] { workstation_.answer(orderAnswer(dialog->order())); });
  dialog->open();
}

void PrepareWorkspace::askForThreshold() {
  auto* dialog = new QInputDialog(app_.window());
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
          [this](double value) { workstation_.answer(plainNumber(value)); });
  dialog->open();
}

// What was grown and reaches too far, perhaps, before an exercise runs on it.
void PrepareWorkspace::askAboutPreview(AppContext::Next go_on) {
  QMessageBox* question = ask(app_.window(), "previewQuestion",
                              tr("What was grown does not count yet, and may be too large."),
                              tr("Look at it in the slices first, or start with it or without."),
                              tr("&Take it"), [this, go_on] {
                                editor_.takePreview();
                                beforeStart(go_on);
                              });
  orElse(*question, "startWithout", tr("Start &without it"), [this, go_on = std::move(go_on)] {
    editor_.leavePreview();
    beforeStart(go_on);
  });
}

// An exercise runs on what was made a moment ago.
void PrepareWorkspace::beforeStart(AppContext::Next go_on) {
  if (editor_.busy()) {
    return app_.say(tr("A structure is being made: wait for it, or cancel it, and start then."));
  }
  if (editor_.preview() && editor_.preview()->leaked) return askAboutPreview(std::move(go_on));
  if (editor_.preview()) editor_.takePreview();
  if (!takeStructures()) {
    return app_.say(tr("The structures are being put in place: try again in a moment."));
  }
  if (workstation_.isOpening()) {
    start_when_placed_ = std::move(go_on);
    return;
  }
  go_on();
}

void PrepareWorkspace::askForLabels() {
  if (workstation_.session()) {
    return app_.say(tr("An exercise is running: stop it, then open structures."));
  }
  QFileDialog* dialog = app_.fileDialog("labelsDialog", tr("Open structures of the case"));
  connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& file) {
    app_.unlessLost({AppContext::UnsavedWork::structures, AppContext::UnsavedWork::cuts},
                    [this, file] { workstation_.useLabels(toPath(file)); });
  });
  dialog->open();
}

void PrepareWorkspace::askToSaveStructures() {
  saveStructuresThen({});
}

void PrepareWorkspace::saveStructuresThen(AppContext::Next then) {
  // As they are now: another case may come while the dialog stands.
  const std::shared_ptr<const LabelMap> copy = editor_.finished();
  if (!copy) return app_.say(tr("There is no structure to save."));
  const std::uint64_t changes = editor_.changes();
  QFileDialog* dialog = app_.saveDialog(
      tr("Save structures"), "structures.nii.gz",
      tr("NIfTI with names beside it (*.nii.gz *.nii);;3D Slicer (*.seg.nrrd *.nrrd);;MetaImage "
         "with names beside it (*.mha)"));
  connect(
      dialog, &QFileDialog::fileSelected, this,
      [this, copy, changes, then = std::move(then)](const QString& file) {
        if (!app_.keepsTheCase(structuresFile(toPath(file))) || !app_.keepsTheCase(toPath(file)))
          return;
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

bool PrepareWorkspace::isStored() const {
  const Case* of = workstation_.currentCase();
  return of && !of->stored.empty();
}

void PrepareWorkspace::saveInCase(AppContext::Next then) {
  if (!isStored()) {
    return app_.say(tr("This case is not one of the library's: save to a file instead."));
  }
  std::shared_ptr<const LabelMap> map;  // null: as it was
  if (in_case_ != editor_.changes()) {
    map = editor_.finished();
    if (!map) {  // none is left
      LabelMap none;
      none.geometry = workstation_.currentCase()->volume->geometry;
      map = std::make_shared<const LabelMap>(std::move(none));
    }
  }
  const std::uint64_t changes = editor_.changes();
  std::optional<TissueSet> tissues;
  if (tissues_touched_ || workstation_.tissuesEdited()) tissues = workstation_.tissues();
  if (!map && !tissues) {
    app_.say(tr("Nothing of it has changed since it was saved."));
    if (then) then();
    return;
  }
  workstation_.save(
      tr("Structures and tissues are saved in the case."),
      [library = app_.library(), id = workstation_.currentCase()->stored, map,
       tissues](const Progress& progress) -> Status {
        if (map) {
          const auto saved = library->saveStructures(id, *map, progress);
          if (!saved) return saved.error();
        }
        return tissues ? library->saveTissues(id, toJson(*tissues)) : Status();
      },
      [this, changes, tissues, then = std::move(then)] {
        editor_.markSaved(changes);
        in_case_ = changes;
        if (tissues) {
          workstation_.tissuesSaved(*tissues);
          tissues_touched_ = *tissues != workstation_.tissues();
        }
        if (then) then();
      });
}

void PrepareWorkspace::unlessStructuresAreLost(AppContext::Next go_on) {
  if (!editor_.edited()) return go_on();
  QMessageBox* question = ask(app_.window(), "structuresUnsaved",
                              tr("The structures have been made or changed and not saved."),
                              tr("Going on takes them away."), tr("&Go on without them"), go_on);
  if (isStored()) {
    orElse(*question, "saveInCaseFirst", tr("Save in the &case"),
           [this, go_on] { saveInCase(go_on); });
  }
  orElse(*question, "saveFirst", tr("&Save structures\u2026"),
         [this, go_on = std::move(go_on)] { saveStructuresThen(go_on); });
}

}  // namespace trephine
