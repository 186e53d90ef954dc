#include "ui/prepare/structure_tab.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QPushButton>
#include <algorithm>
#include <array>
#include <utility>

#include "desk/fit_question.h"
#include "structures/compare.h"
#include "ui/common/question.h"
#include "ui/common/words.h"
#include "ui/structures/structure_report.h"
#include "ui/structures/structure_shaping.h"
#include "volume/segmentation.h"

namespace trephine {

namespace {
constexpr int kSettled_ms = 500;  // after the last change the exercise is placed in them
constexpr double kStructureOpacity = 0.4;
}  // namespace

StructureTab::StructureTab(Workstation& workstation, Messages& messages, WorkGuards& guards,
                           CaseViews& case_views, std::shared_ptr<CaseLibrary> library,
                           const std::filesystem::path& storage, StructurePanel& structures,
                           StructureEditor& editor, TissuePicture& picture, QObject* parent)
    : QObject(parent),
      workstation_(workstation),
      messages_(messages),
      guards_(guards),
      case_views_(case_views),
      library_(std::move(library)),
      views_(&case_views.views()),
      toolbox_(case_views.views().toolbox()),
      view_(&case_views.view()),
      structures_(structures),
      editor_(editor),
      picture_(picture),
      exports_(workstation, messages, guards, storage, structures, editor),
      questions_(workstation, *messages.window()),
      entry_(workstation, toolbox_, messages, guards) {
  for (ViewTool* tool : structures_.tools()) toolbox_.add(*tool);
  toolbox_.other_keys = [this](int of) { return key(of); };
  connect(&structures_, &StructurePanel::toolChosen, this,
          [this](ViewTool* tool) { tool ? toolbox_.take(*tool) : toolbox_.putDown(); });
  connect(&toolbox_, &Toolbox::taken, this, &StructureTab::toolTaken);
  connect(&structures_, &StructurePanel::openWanted, this, &StructureTab::askForLabels);
  connect(&structures_, &StructurePanel::saveWanted, this, [this] { saveThen({}); });
  connect(&structures_, &StructurePanel::keepWanted, this,
          [this] { isStored() ? saveInCase({}) : saveThen({}); });
  connect(view_, &ViewWidget::nothingThere, this, [this] {
    structures_.say(tr("Nothing solid is seen there: ghosts are passed through."));
  });
  StructureList* list = &structures_.list();
  connect(list, &StructureList::lookWanted, &picture_, &TissuePicture::setLook);
  connect(list, &StructureList::opacityWanted, &picture_, &TissuePicture::setOpacity);
  connect(list, &StructureList::colourChosen, &picture_, &TissuePicture::setColour);
  connect(&structures_.notices(), &StructureNotices::decided, view_,
          qOverload<>(&QWidget::setFocus));
  connect(&editor_, &StructureEditor::changed, this, [this](const VoxelBox& box) {
    if (views_->mirror().labels() == editor_.map()) views_->labelsChanged(box);
    settled_.start();
  });
  connect(&editor_, &StructureEditor::listChanged, this, [this] {
    if (views_->mirror().labels() == editor_.map()) views_->showLabels(editor_.map());  // colours
    showLabels();
    settled_.start();
  });
  connect(&editor_, &StructureEditor::stateChanged, this, [this] {
    emit undoChanged();
    settled_.start();
  });
  connect(&editor_, &StructureEditor::failed, &messages_, &Messages::report);
  settled_.setParent(this);
  settled_.setObjectName("structuresSettled");
  settled_.setSingleShot(true);
  settled_.setInterval(kSettled_ms);
  connect(&settled_, &QTimer::timeout, this, [this] { (void)take(); });
  guards_.setGuard(UnsavedWork::structures,
                   [this](WorkGuards::Next go_on) { unlessLost(std::move(go_on)); });
  guards_.setBeforeStart([this](WorkGuards::Next go_on) { beforeStart(std::move(go_on)); });
  connect(&case_views_, &CaseViews::caseShown, this, &StructureTab::showOpened);
  connect(&workstation_, &Workstation::phaseChanged, this, [this] {
    const Workstation::Phase phase = workstation_.phase();
    editor_.setLocked(phase == Workstation::Phase::ready || phase == Workstation::Phase::empty
                          ? QString()
                          : tr("Structures cannot be changed while an exercise runs: it was "
                               "started on them."));
    emit undoChanged();
    showLabels();
  });
  connect(&workstation_, &Workstation::exerciseReported, this, [this](const RunReport& report) {
    QStringList cut;
    for (const std::string& line : linesOf(report.structures_cut)) cut << toQt(line);
    structures_.say(cut.isEmpty() ? QString()
                                   : tr("In the last exercise:") + '\n' + cut.join('\n'));
  });
  connect(&workstation_, &Workstation::structuresChanged, this, &StructureTab::showPlaced);
  connect(&workstation_, &Workstation::placingFailed, this, &StructureTab::placingFailed);
}

void StructureTab::show(bool here, bool in_front) {
  here_ = here;
  in_front_ = in_front;
  showViews();
}

// What was made or changed is what the next exercise runs on. True where nothing waits any more.
bool StructureTab::take() {
  if (!editor_.hasCase() || workstation_.isOpening()) return false;
  if (workstation_.phase() != Workstation::Phase::ready) return true;
  const std::shared_ptr<const LabelMap> made = editor_.takeEdited();
  if (!made) return true;
  own_structures_ = made;
  return workstation_.useStructures(made);
}

// The exercise was placed in other structures: made here, or read.
void StructureTab::showPlaced() {
  const Case& of = *workstation_.currentCase();
  if (of.structures != own_structures_) {
    picture_.forgetLooks();
    editor_.setCase(of.volume, of.structures);
    in_case_.reset();
    own_structures_ = of.structures;
    QStringList words;
    for (const Warning& warning : of.structure_warnings) words << toQt(warning.text);
    structures_.say(words.join('\n'));
    emit frontWanted();
    showReport();
  }
  if (case_views_.carved() && !case_views_.cutsUnsaved()) case_views_.showWholeCase();
  showViews();
  emit entry_.changed();
  if (entry_.takeAsked()) case_views_.lookAtEntry();
  // Not by a dialog: it would come with every stroke.
  if (const auto& why = workstation_.placed()->error) structures_.say(toQt(why->sentence()));
  settled_.start();  // what was changed meanwhile
  if (WorkGuards::Next start = std::exchange(start_when_placed_, {})) {
    QMetaObject::invokeMethod(
        this, [this, start] { beforeStart(start); }, Qt::QueuedConnection);
  }
}

// Nothing waits for it any more, and nothing that was made is lost.
void StructureTab::placingFailed() {
  (void)entry_.takeAsked();
  start_when_placed_ = {};
  own_structures_ = workstation_.currentCase()->structures;
  editor_.giveBack();
  emit entry_.changed();
}

// Of those that came from a file: beside the window, which goes on.
void StructureTab::showReport() {
  const Case& of = *workstation_.currentCase();
  if (auto* before = messages_.window()->findChild<StructureReport*>())
    before->close();  // of another file
  if (of.structure_cards.empty()) return;
  (new StructureReport(of, messages_.window()))->show();
}

// Of a case that was opened.
void StructureTab::showOpened() {
  const Case& of = *workstation_.currentCase();
  // Of a case that came with its exercise they are as they were sent.
  if (of.structures != own_structures_ && of.source.empty()) showReport();
  if (of.structures != own_structures_ || !editor_.isOf(of.volume)) {  // not another exercise alone
    picture_.forgetLooks();
    toolbox_.putDown();  // what was in hand was for another case
    structures_.suitVoxels(of.volume->geometry.spacing_mm);
    editor_.setCase(of.volume, of.structures);
    in_case_ = editor_.version();
    of_case_ = of.structures;
    tissues_touched_ = false;
  }
  own_structures_ = of.structures;
  structures_.setWanted(workstation_.exercise()->structures);
  structures_.setSourceAtHand(exports_.sourceAtHand());
  showViews();
  emit entry_.changed();
  if (here_) (void)offerMissing();
}

// What is missing is offered to be made at once. False: the exercise lacks nothing that could be.
bool StructureTab::offerMissing() {
  if (!workstation_.placed() || workstation_.session() || workstation_.opensAnotherCase())
    return false;
  const std::optional<FitQuestion> question = fitQuestion(*workstation_.placed());
  if (!question || question->mend != FitQuestion::Mend::make_structure) return false;
  emit frontWanted();
  toolbox_.take(*structures_.tools()[0]);
  structures_.say(tr("The exercise needs the structure \"%1\", which the case lacks: click into "
                      "it, well inside. Or start at once: tissue is then told by its HU.")
                       .arg(structures_.name()));
  return true;
}

void StructureTab::makeMissing() {
  emit frontWanted();
  toolbox_.take(*structures_.tools()[0]);
  structures_.offerWanted();
}

// The views show what the panel of structures lists while it is in front, else what the exercise
// runs on, with the shells that its tissues asked for.
void StructureTab::showLabels() {
  const Case* of = workstation_.currentCase();
  if (!of || !(views_->mirror().volume().geometry == of->volume->geometry)) return;
  const bool practising = workstation_.phase() != Workstation::Phase::ready;
  const std::shared_ptr<const LabelMap> wanted =
      shown() && !practising ? editor_.map() : workstation_.placed()->labels;
  if (wanted != views_->mirror().labels()) views_->showLabels(wanted);
  picture_.show();
}

// The slices show what the panel lists while it is in front, else what the exercise runs on.
void StructureTab::showViews() {
  showLabels();
  emit undoChanged();
  if (shown()) {
    if (views_->colours().overlay() != Overlay::labels) {
      views_->setOverlay(Overlay::labels, kStructureOpacity);
    }
    if (views_->viewLayout().kind == ViewLayout::Kind::single && views_->viewLayout().large == 0) {
      views_->setLayout({ViewLayout::Kind::four, 0});  // they are made in slices
    }
  } else if (structures_.holds(toolbox_.inHand())) {
    toolbox_.putDown();
  }
}

void StructureTab::toolTaken(ViewTool* tool) {
  const bool ours = structures_.holds(*tool);
  if (ours && !here_) {
    toolbox_.putDown();
    return messages_.say(tr("Structures are made in Prepare (Ctrl+2)."));
  }
  if (ours) emit frontWanted();
  structures_.showTool(*tool);
  if (!ours && !tool->facts().hint.isEmpty()) messages_.say(tool->facts().hint);
}

bool StructureTab::key(int key) {
  constexpr std::array kKeys{Qt::Key_K,           Qt::Key_S,     Qt::Key_V,
                             Qt::Key_Return,      Qt::Key_Enter, Qt::Key_BracketLeft,
                             Qt::Key_BracketRight};
  if (std::ranges::count(kKeys, key) == 0) return false;
  if (!here_ && key != Qt::Key_V) {
    messages_.say(tr("Structures are made in Prepare (Ctrl+2)."));
    return true;
  }
  switch (key) {
    case Qt::Key_K:
      emit frontWanted();
      makeSkull(editor_);
      break;
    case Qt::Key_S:
      emit frontWanted();
      structures_.makeSkin();
      break;
    case Qt::Key_V:
      structures_.list().nextLook();
      break;
    case Qt::Key_BracketLeft:
    case Qt::Key_BracketRight:
      structures_.stepRadius(key == Qt::Key_BracketRight ? 1 : -1);
      break;
    default:
      editor_.takePreview();
  }
  return true;
}

// What was grown and reaches too far, perhaps, before an exercise runs on it.
void StructureTab::askAboutPreview(WorkGuards::Next go_on) {
  QMessageBox* question = ask(messages_.window(), "previewQuestion",
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
void StructureTab::beforeStart(WorkGuards::Next go_on) {
  if (editor_.busy()) {
    return messages_.say(
        tr("A structure is being made: wait for it, or cancel it, and start then."));
  }
  if (editor_.preview() && editor_.preview()->leaked) return askAboutPreview(std::move(go_on));
  if (editor_.preview()) editor_.takePreview();
  if (!take()) {
    return messages_.say(tr("The structures are being put in place: try again in a moment."));
  }
  if (workstation_.isOpening()) {
    start_when_placed_ = std::move(go_on);
    return;
  }
  go_on();
}

void StructureTab::askForLabels() {
  if (workstation_.session()) {
    return messages_.say(tr("An exercise is running: stop it, then open structures."));
  }
  QFileDialog* dialog = messages_.fileDialog("labelsDialog", tr("Open structures of the case"));
  connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& file) {
    guards_.unlessLost({UnsavedWork::structures, UnsavedWork::cuts},
                       [this, file] { workstation_.useLabels(toPath(file)); });
  });
  dialog->open();
}

void StructureTab::saveThen(WorkGuards::Next then) {
  // As they are now: another case may come while the dialog stands.
  const std::shared_ptr<const LabelMap> copy = editor_.finished();
  if (!copy) return messages_.say(tr("There is no structure to save."));
  const auto made = [this, version = editor_.version(), of = workstation_.currentCase()->volume] {
    if (editor_.isOf(of)) editor_.markSaved(version);
  };
  QFileDialog* dialog = messages_.saveDialog(
      tr("Save structures"), "structures.nii.gz",
      tr("NIfTI with names beside it (*.nii.gz *.nii);;3D Slicer (*.seg.nrrd *.nrrd);;MetaImage "
         "with names beside it (*.mha)"));
  connect(
      dialog, &QFileDialog::fileSelected, this,
      [this, copy, made, then = std::move(then)](const QString& file) {
        if (!guards_.keepsTheCase(structuresFile(toPath(file))) ||
            !guards_.keepsTheCase(toPath(file)))
          return;
        workstation_.save(
            tr("The structures are saved as %1.").arg(QFileInfo(file).fileName()),
            [copy, path = toPath(file)](const Progress& progress) {
              return writeSegmentation(*copy, path, false, progress);
            },
            [made, then] {
              made();
              if (then) then();
            });
      });
  dialog->open();
}

bool StructureTab::isStored() const {
  const Case* of = workstation_.currentCase();
  return of && !of->stored.empty();
}

void StructureTab::saveInCase(WorkGuards::Next then) {
  if (!isStored()) {
    return messages_.say(tr("This case is not one of the library's: save to a file instead."));
  }
  editor_.takePreview();
  std::shared_ptr<const LabelMap> map;  // null: as it was
  if (in_case_ != editor_.version()) {
    map = editor_.finished();
    if (!map) {  // none is left
      LabelMap none;
      none.geometry = workstation_.currentCase()->volume->geometry;
      map = std::make_shared<const LabelMap>(std::move(none));
    }
  }
  const std::uint64_t version = editor_.version();
  std::optional<TissueSet> tissues;
  if (tissues_touched_ || workstation_.tissuesEdited()) tissues = workstation_.tissues();
  if (!map && !tissues) {
    messages_.say(tr("Nothing of it has changed since it was saved."));
    if (then) then();
    return;
  }
  workstation_.save(
      map && tissues ? tr("Structures and tissues are saved in the case.")
      : map          ? tr("The structures are saved in the case.")
                     : tr("The tissues are saved in the case."),
      [library = library_, id = workstation_.currentCase()->stored, map,
       tissues](const Progress& progress) -> Status {
        if (map) {
          const auto saved = library->saveStructures(id, *map, progress);
          if (!saved) return saved.error();
        }
        return tissues ? library->saveTissues(id, toJson(*tissues)) : Status();
      },
      [this, version, map, tissues, of = workstation_.currentCase()->volume,
       then = std::move(then)] {
        if (editor_.isOf(of)) {
          editor_.markSaved(version);
          in_case_ = version;
          if (map) of_case_ = map;
        }
        if (tissues) {
          workstation_.tissuesSaved(*tissues);
          tissues_touched_ = *tissues != workstation_.tissues();
        }
        if (then) then();
      });
}

// "liver, spleen, and 3 more"
static QString firstOf(QStringList names) {
  constexpr qsizetype kMost = 6;
  const qsizetype more = names.size() - kMost;
  if (more > 0) names = names.mid(0, kMost) << StructureTab::tr("and %1 more").arg(more);
  return names.join(QStringLiteral(", "));
}

// Empty: there are none.
QString StructureTab::names() const {
  QStringList names;
  if (const std::shared_ptr<const LabelMap> map = editor_.map()) {
    for (const Structure& one : map->structures) {
      const bool any = editor_.millilitres(one.label) > 0.0 && !editor_.isWall(one.label);
      if (any) names << toQt(one.name);
    }
  }
  return firstOf(names);
}

// Those that are other in the case.
QString StructureTab::changedNames() const {
  const auto [changed, gone] = changedStructures(of_case_.get(), editor_.map().get());
  QStringList names;
  for (const std::string& name : changed) names << toQt(name);
  for (const std::string& name : gone) names << tr("%1 (deleted)").arg(toQt(name));
  return names.isEmpty() ? this->names() : firstOf(names);
}

bool StructureTab::unsaved() const {
  if (editor_.preview()) return true;
  const bool case_has_any = of_case_ && !of_case_->structures.empty();
  if (names().isEmpty() && !(isStored() && case_has_any)) return false;  // nothing could go
  return isStored() ? !inCase() : editor_.edited();
}

void StructureTab::unlessLost(WorkGuards::Next go_on) {
  if (!unsaved()) return go_on();
  const QString what = names();
  QMessageBox* question =
      ask(messages_.window(), "structuresUnsaved",
          what.isEmpty() ? tr("All structures have been deleted, and the case still has them.")
          : isStored()
              ? tr("The case does not hold its structures as they are now: %1.").arg(changedNames())
              : tr("The structures have been made or changed and not saved: %1.").arg(what),
          what.isEmpty() ? tr("Going on leaves the case as it was saved.")
          : isStored()   ? tr("Going on leaves the case as it was saved. A file that they were "
                                "exported to, or came from, is a copy.")
                         : tr("Going on takes them away."),
          tr("&Go on without them"), go_on);
  if (isStored()) {
    orElse(*question, "saveInCaseFirst", tr("Save in the &case"),
           [this, go_on] { saveInCase(go_on); });
  }
  orElse(*question, "saveFirst", tr("&Save structures\u2026"),
         [this, go_on = std::move(go_on)] { saveThen(go_on); });
}

}  // namespace trephine
