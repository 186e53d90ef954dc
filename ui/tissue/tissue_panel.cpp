#include "ui/tissue/tissue_panel.h"

#include <QColorDialog>
#include <QFormLayout>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QMenu>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/utf8.h"
#include "ui/common/colours.h"
#include "ui/common/icons.h"
#include "ui/common/placing.h"
#include "ui/common/setting_words.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kOpacitySteps = 1000;
constexpr int kMostLetters = 60;

QToolButton* smallButton(const char* name, Symbol symbol, const QString& tip, QWidget* parent) {
  auto* button = new QToolButton(parent);
  button->setObjectName(name);
  button->setIcon(symbolIcon(symbol));
  button->setToolTip(tip);
  button->setAccessibleName(tip);
  button->setFocusPolicy(Qt::TabFocus);
  button->setAutoRaise(true);
  return button;
}

constexpr FieldOf<Tissue> kSourceFields[] = {
    {{"hu_source", {1, 300}, Given::always, "where the range comes from", "Source"},
     &Tissue::hu_source},
};

}  // namespace

double opacityAtSlider(double position) {
  return position * position;
}
double sliderAtOpacity(double opacity) {
  return std::sqrt(opacity);
}

TissuePanel::TissuePanel(QWidget* parent) : QWidget(parent) {
  build();
  // Without an exercise there is no set.
  editor_->setEnabled(false);
  list_->setLocked(true);
  set_name_->setEnabled(false);
  set_menu_->setEnabled(false);
}

void TissuePanel::build() {
  list_ = new TissueList(this);
  locked_words_ = problemLabel("tissuesLocked", this);
  felt_ = problemLabel("tissueFelt", this);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(10, 10, 10, 10);
  layout->setSpacing(10);
  layout->addLayout(buildSetRow());
  poke_ = new QPushButton(tr("&Poke it"), this);
  poke_->setObjectName("pokeButton");
  poke_->setCheckable(true);
  poke_->setToolTip(tr("Feel the tissue with mouse or arm; nothing is cut (Ctrl+E)"));
  connect(poke_, &QPushButton::clicked, this, &TissuePanel::pokeWanted);
  layout->addWidget(poke_);
  layout->addWidget(list_);
  layout->addWidget(locked_words_);
  layout->addWidget(buildEditor());
  layout->addWidget(felt_);
  layout->addStretch(1);

  connect(list_, &TissueList::chosen, this, [this] {
    showSelected();
    emit chosenChanged();
  });
  connect(list_, &TissueList::looksChosen, this, [this](const TissueLooks& looks) {
    looks_ = looks;
    emit looksChanged(looks_);
  });
  connect(list_, &TissueList::addWanted, this, &TissuePanel::add);
  connect(list_, &TissueList::removeWanted, this, &TissuePanel::remove);
  connect(colour_, &QToolButton::clicked, this, &TissuePanel::chooseColour);
  connect(opacity_, &QSlider::valueChanged, this, [this](int step) {
    if (!current()) return;
    Tissue wanted = *current();
    wanted.opacity = opacityAtSlider(double(step) / kOpacitySteps);
    (void)apply(wanted, "opacity:" + toQt(wanted.id));
  });
  connect(opacity_, &QSlider::sliderReleased, this, &TissuePanel::editEnded);
}

// The set's name, and beside it what is done with sets.
QLayout* TissuePanel::buildSetRow() {
  set_name_ = new QLineEdit(this);
  set_name_->setObjectName("setName");
  set_name_->setAccessibleName(tr("Name of the tissue set"));
  set_name_->setToolTip(tr("What this set of tissues is called"));
  set_name_->setMaxLength(kMostLetters);
  connect(set_name_, &QLineEdit::editingFinished, this, [this] {
    const std::string typed = cleanUtf8(set_name_->text().toStdString());
    set_name_->setModified(false);
    if (typed.empty() || typed == tissues_.name) return set_name_->setText(toQt(tissues_.name));
    TissueSet set = tissues_;
    set.name = typed;
    (void)applySet(set, "set name");
  });
  set_menu_ = new QToolButton(this);
  set_menu_->setObjectName("setMenu");
  set_menu_->setText(tr("&Set"));
  set_menu_->setToolTip(tr("New, duplicate, import, export, revert; the sets of this workstation"));
  set_menu_->setPopupMode(QToolButton::InstantPopup);
  set_menu_->setFocusPolicy(Qt::TabFocus);
  auto* menu = new QMenu(set_menu_);
  const auto add = [&](const char* name, const QString& text, void (TissuePanel::*wanted)()) {
    QAction* action = menu->addAction(text, this, wanted);
    action->setObjectName(name);
  };
  add("newSet", tr("&New"), &TissuePanel::newSetWanted);
  add("duplicateSet", tr("&Duplicate"), &TissuePanel::duplicateWanted);
  sets_ = menu->addMenu(tr("&Take another"));
  sets_->setObjectName("setsMenu");
  add("importSet", tr("&Import\u2026"), &TissuePanel::importWanted);
  add("exportSet", tr("&Export\u2026"), &TissuePanel::exportWanted);
  add("revertSet", tr("&Revert"), &TissuePanel::revertWanted);
  set_menu_->setMenu(menu);
  connect(menu, &QMenu::aboutToShow, this, &TissuePanel::setsWanted);
  undo_ = smallButton("undoEdit", Symbol::undo, tr("Takes back the last edit"), this);
  redo_ = smallButton("redoEdit", Symbol::redo, tr("Does it again"), this);
  connect(undo_, &QToolButton::clicked, this, &TissuePanel::undoWanted);
  connect(redo_, &QToolButton::clicked, this, &TissuePanel::redoWanted);
  auto* row = new QHBoxLayout;
  row->setSpacing(4);
  row->addWidget(set_name_, 1);
  row->addWidget(set_menu_);
  row->addWidget(undo_);
  row->addWidget(redo_);
  return row;
}

QWidget* TissuePanel::buildEditor() {
  editor_ = new QWidget(this);
  colour_ = new QToolButton(editor_);
  colour_->setObjectName("colour");
  colour_->setIconSize({20, 20});
  colour_->setText(tr("Colour\u2026"));
  colour_->setToolTip(tr("Colour of the tissue, in all views"));
  colour_->setAccessibleName(colour_->text());
  colour_->setFocusPolicy(Qt::TabFocus);
  opacity_ = new QSlider(Qt::Horizontal, editor_);
  opacity_->setObjectName("opacity");
  opacity_->setRange(0, kOpacitySteps);
  opacity_->setPageStep(kOpacitySteps / 10);
  opacity_text_ = new QLabel(editor_);
  opacity_text_->setMinimumWidth(fontMetrics().horizontalAdvance("0.000 /mm "));

  auto* form = new QFormLayout;
  form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
  form->setVerticalSpacing(6);
  low_ = new WholeNumberField("huLow", editor_);
  high_ = new WholeNumberField("huHigh", editor_);
  for (WholeNumberField* box : {low_, high_}) {
    box->setLimits(int(kHuRange.low), int(kHuRange.high));
    box->setSingleStep(5);
    box->setSuffix(tr(" HU"));
  }
  label_ = new WholeNumberField("label", editor_);
  label_->setLimits(0, int(kLabelRange.high));
  label_->setWord(0, tr("any"));
  label_->setPrefix(tr("label "));
  for (WholeNumberField* box : {low_, high_, label_}) box->entered = [this] { rangeEntered(); };
  problem_ = problemLabel("tissueProblem", editor_);
  gaps_ = problemLabel("tissueGaps", editor_);
  auto* high_row = high_->withReason();
  high_row->addWidget(problem_);
  high_row->addWidget(gaps_);
  mechanics_ = new TissueMechanics(editor_);
  mechanics_->wanted = [this](const Tissue& wanted, const char* what) {
    const Status applied = apply(wanted, QString(what) + ':' + toQt(wanted.id));
    if (applied) emit editEnded();
    return applied;
  };

  constexpr FieldsOf<Tissue> kFields = kTissueFields;
  const auto fieldsOf = [&](FieldsOf<Tissue> fields, const char* what) {
    auto made = std::make_unique<FieldRows<Tissue>>(fields, *form, editor_, "tissue:");
    made->entered = [this, what](const Tissue& wanted, const char*) {
      if (!current() || current()->id != wanted.id) return;
      if (wanted.structure != current()->structure) return structureChosen(wanted.structure);
      (void)apply(wanted, what);
      emit editEnded();
    };
    return made;
  };
  name_ = fieldsOf(kFields.subspan(1, 1), "name");
  auto* looks = new QHBoxLayout;
  looks->addWidget(opacity_, 1);
  looks->addWidget(opacity_text_);
  looks->addWidget(colour_);
  form->addRow(tr("Opacity"), looks);
  form->addRow(tr("From"), low_->withReason());
  form->addRow(tr("To"), high_row);
  source_ = fieldsOf(kSourceFields, "hu");
  where_ = fieldsOf(kFields.subspan(2, 1), "where");
  form->addRow(tr("Label"), label_->withReason());
  shell_ = std::make_unique<FieldRows<Tissue::Shell>>(FieldsOf<Tissue::Shell>(kShellFields), *form,
                                                      editor_, "shell:");
  shell_->entered = [this](const Tissue::Shell& shell, const char*) { shellEntered(shell); };

  auto* editor_layout = new QVBoxLayout(editor_);
  editor_layout->setContentsMargins(0, 0, 0, 0);
  editor_layout->addLayout(form);
  editor_layout->addWidget(mechanics_);
  return editor_;
}

void TissuePanel::setTissues(const TissueSet& tissues, const TissueSet& declared) {
  tissues_ = tissues;
  declared_ = declared;
  list_->setLocked(!locked_.isEmpty());
  set_name_->setEnabled(locked_.isEmpty());
  set_menu_->setEnabled(locked_.isEmpty());
  set_name_->setText(toQt(tissues_.name));
  list_->show(tissues_, looks_);
  showSelected();
}

void TissuePanel::setLooks(const TissueLooks& looks) {
  looks_ = looks;
  list_->show(tissues_, looks_);
}

void TissuePanel::setRenderable(const std::optional<ArmsLimit>& most,
                                std::function<Impedance(const Tissue&)> demanded,
                                const std::vector<LawKind>& laws, RemovalKind removal,
                                ControllerKind in_force) {
  arms_ = most;
  demanded_ = std::move(demanded);
  in_force_ = in_force;
  mechanics_->setLimits(arms_, demanded_, laws, removal, in_force_);
  showFelt();
}

void TissuePanel::setSets(const std::vector<std::pair<QString, std::filesystem::path>>& sets) {
  sets_->clear();
  for (const auto& [name, file] : sets) {
    sets_->addAction(name, this, [this, file = file] { emit setWanted(file); });
  }
  sets_->setEnabled(!sets.empty());
}

void TissuePanel::showHistory(const QString& undo, const QString& redo) {
  undo_->setEnabled(!undo.isEmpty());
  redo_->setEnabled(!redo.isEmpty());
}

void TissuePanel::showPoke(bool possible, bool poking) {
  poke_->setEnabled(possible);
  poke_->setChecked(poking);
  poke_->setText(poking ? tr("Stop &poking") : tr("&Poke it"));
}

void TissuePanel::showFelt() {
  const Tissue* tissue = current();
  const bool bounded = in_force_ == ControllerKind::bounded;
  QStringList lines;
  if (tissue && arms_) {
    const auto line = [&](const QString& what, const QString& unit, double demanded, double most) {
      if (demanded <= most) return;
      const QString words =
          bounded ? tr("%1: the exercise's laws together demand %2 %4, these arms show at most "
                       "%3 %4, and that is felt.")
                  : tr("%1: the exercise's laws together demand %2 %4, and nothing bounds it under "
                       "this controller: above %3 %4 these arms may shake.");
      lines << words.arg(what).arg(demanded, 0, 'f', 0).arg(most, 0, 'f', 0).arg(unit);
    };
    const Impedance demanded = demanded_(*tissue);
    line(tr("Damping"), tr("N\u00b7s/m"), demanded.damping, arms_->most.b_max);
    line(tr("Stiffness"), tr("N/m"), demanded.stiffness, arms_->most.k_max);
  }
  colours::setText(*felt_, bounded ? colours::kQuiet : colours::kCaution);
  felt_->setText(lines.join('\n'));
  felt_->setVisible(!lines.isEmpty());
}

// Between the lowest and the highest HU that a tissue has here or had in the file.
void TissuePanel::showGaps() {
  HuRange span{std::numeric_limits<int>::max(), std::numeric_limits<int>::lowest()};
  for (const TissueSet* set : {&tissues_, &declared_}) {
    for (const Tissue& tissue : set->tissues) {
      if (!tissue.isAnywhere()) continue;
      span = {std::min(span.low, tissue.hu_min), std::max(span.high, tissue.hu_max)};
    }
  }
  QStringList ranges;
  if (span.low <= span.high) {
    for (const HuRange& range : freeHu(tissues_, span)) {
      ranges << tr("%1 to %2 HU").arg(range.low).arg(range.high);
    }
  }
  gaps_->setText(tr("Without a tissue: %1. Nothing is drawn, felt or cut there.")
                     .arg(ranges.join(tr(", ", "between ranges of HU"))));
  giveRoom(*gaps_, high_->width());
  gaps_->setVisible(!ranges.isEmpty());
}

void TissuePanel::select(const std::string& id) {
  for (std::size_t i = 0; i < tissues_.tissues.size(); ++i) {
    if (tissues_.tissues[i].id == id) list_->select(int(i));
  }
}

void TissuePanel::setLocked(const QString& why) {
  locked_ = why;
  locked_words_->setText(why);
  locked_words_->setVisible(!why.isEmpty());
  editor_->setEnabled(current() && why.isEmpty());
  list_->setLocked(!why.isEmpty());
  set_name_->setEnabled(why.isEmpty());
  set_menu_->setEnabled(why.isEmpty());
}

void TissuePanel::setLabelsOpen(bool open) {
  labels_open_ = open;
  showSelected();
}

void TissuePanel::setStructures(const std::vector<std::string>& names) {
  structures_ = names;
  showPlaces();
}

const Tissue* TissuePanel::current() const {
  const int row = list_->current();
  if (row < 0 || std::size_t(row) >= tissues_.tissues.size()) return nullptr;
  return &tissues_.tissues[std::size_t(row)];
}

const Tissue& TissuePanel::declared(const Tissue& tissue) const {
  const Tissue* found = declared_.find(tissue.id);
  return found ? *found : tissue;
}

void TissuePanel::showSelected() {
  const Tissue* tissue = current();
  editor_->setEnabled(tissue && locked_.isEmpty());
  if (!tissue) return;
  low_->show(tissue->hu_min);
  high_->show(tissue->hu_max);
  label_->show(tissue->structure.empty() ? tissue->label.value_or(0) : 0);
  showProblem(nullptr, {});
  mechanics_->show(*tissue, declared(*tissue));
  showOutcome();
}

// Anywhere, or in one of the case's structures; one that the case lacks stays to be seen. Else, on
// a case without it, nowhere or the outside of another.
void TissuePanel::showPlaces() {
  const Tissue* tissue = current();
  FieldEditor::Offers places{{tr("Anywhere"), ""}}, shells{{tr("nowhere without it"), ""}};
  bool is_here = !tissue || tissue->structure.empty();
  for (const std::string& name : structures_) {
    places.emplace_back(tr("In %1").arg(shownName(name)), name);
    if (tissue && tissue->structure == name) {
      is_here = true;
    } else {
      shells.emplace_back(tr("the outside of %1").arg(shownName(name)), name);
    }
  }
  if (!is_here) {
    places.emplace_back(tr("In %1 (not in this case)").arg(shownName(tissue->structure)),
                        tissue->structure);
  }
  FieldEditor& structure = (*where_)["structure"];
  structure.offer(places);
  structure.setEnabled(places.size() > 1);
  structure.setToolTip(places.size() > 1
                           ? tr("Only voxels of this structure are this tissue")
                           : tr("The case has no structure; they are made on the Structures tab"));
  (*shell_)["of"].offer(shells);
  if (!tissue) return;
  where_->show(*tissue);
  shell_->show(tissue->shell.value_or(Tissue::Shell{}));
  shell_->setVisible(!tissue->structure.empty());
  (*shell_)["thickness_mm"].setEnabled(tissue->shell.has_value());
}

void TissuePanel::showOutcome() {
  const Tissue* tissue = current();
  if (!tissue) return;
  const bool same = std::exchange(shown_, tissue->id) == tissue->id;
  name_->show(*tissue, same);
  source_->show(*tissue, same);
  colour_->setIcon(tissueSwatch(colours::of(tissue->colour), 1.0));
  {
    const QSignalBlocker quiet(opacity_);
    opacity_->setValue(int(std::lround(sliderAtOpacity(tissue->opacity) * kOpacitySteps)));
  }
  showPlaces();
  const bool by_label = tissue->structure.empty() && tissue->label;
  label_->setEnabled((labels_open_ || by_label) && tissue->structure.empty());
  label_->setToolTip(!tissue->structure.empty() ? tr("It is known by a structure's name")
                     : labels_open_ ? tr("Only where the label map has this label")
                                    : tr("Open the case's label map first, on the Structures tab"));
  opacity_text_->setText(tr("%1 /mm").arg(tissue->opacity, 0, 'f', 3));
  mechanics_->update(*tissue, declared(*tissue));
  showGaps();
  showFelt();
}

void TissuePanel::chooseColour() {
  const Tissue* tissue = current();
  if (!tissue) return;
  auto* dialog = new QColorDialog(colours::of(tissue->colour), this);
  dialog->setObjectName("colourDialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("Colour of %1").arg(toQt(tissue->name)));
  connect(dialog, &QColorDialog::colorSelected, this, [this](const QColor& colour) {
    if (!current()) return;
    Tissue wanted = *current();
    wanted.colour = colours::rgbOf(colour);
    (void)apply(wanted, "colour");
    emit editEnded();
  });
  dialog->open();
}

void TissuePanel::showProblem(const Error* why, const std::vector<HuOverlap>& overlaps) {
  if (why) {
    sayNotApplied(*problem_, *why);
    QString words = problem_->text();  // by the names that a person knows
    for (const Tissue& tissue : tissues_.tissues) {
      words.replace('\'' + toQt(tissue.id) + '\'', '"' + shownName(tissue.name) + '"');
    }
    problem_->setText(words);
    giveRoom(*problem_, high_->width());
  }
  problem_->setVisible(why);
  emit overlapsShown(overlaps);
}

// HU and label together decide whether two tissues claim the same voxels.
void TissuePanel::rangeEntered() {
  if (!current()) return;
  Tissue wanted = *current();
  wanted.hu_min = low_->wanted();
  wanted.hu_max = high_->wanted();
  if (wanted.hu_min != current()->hu_min || wanted.hu_max != current()->hu_max) {
    const Tissue& cited = declared(wanted);
    const bool as_cited = wanted.hu_min == cited.hu_min && wanted.hu_max == cited.hu_max;
    wanted.hu_source = as_cited ? cited.hu_source : kOwnSource;
  }
  if (wanted.structure.empty()) {
    wanted.label.reset();
    if (label_->wanted() > 0) wanted.label = label_->wanted();
  }
  const Status valid = apply(wanted, "hu:" + toQt(wanted.id));
  if (!valid) {
    const Error why = valid.error();
    return showProblem(&why, overlapsOf(tissues_, chosen(), wanted));
  }
  showProblem(nullptr, {});
  emit editEnded();
  for (WholeNumberField* box : {low_, high_, label_}) box->take();
}

void TissuePanel::structureChosen(const std::string& name) {
  Tissue wanted = *current();
  wanted.structure = name;
  wanted.label.reset();
  if (wanted.structure.empty()) wanted.shell.reset();
  const Tissue& cited = declared(wanted);
  if (cited.structure == wanted.structure) wanted.shell = cited.shell;
  // Alone in a structure it is all of it; HU may be narrowed again.
  const bool alone = std::ranges::none_of(tissues_.tissues, [&](const Tissue& other) {
    return other.id != wanted.id && other.structure == wanted.structure;
  });
  if (!wanted.structure.empty() && alone) {
    wanted.hu_min = kRemovedHu + 1;
    wanted.hu_max = kCtHu.high;
    wanted.hu_source = "whatever HU, where the structure is";
  }
  const Status valid = apply(wanted, "where");
  emit editEnded();
  if (valid) return showSelected();
  const Error why = valid.error();
  showPlaces();
  showProblem(&why, overlapsOf(tissues_, chosen(), wanted));
}

// One of no structure: nothing stands in.
void TissuePanel::shellEntered(const Tissue::Shell& shell) {
  if (!current()) return;
  Tissue wanted = *current();
  wanted.shell.reset();
  if (!shell.of.empty()) wanted.shell = shell;
  const Status valid = apply(wanted, "where");
  emit editEnded();
  if (valid) return;
  const Error why = valid.error();
  showProblem(&why, {});
}

void TissuePanel::add() {
  source_->takeTyped();  // a click of a button leaves the field as it was typed
  const Result<TissueSet> more = withNewTissue(tissues_);
  if (!more) {
    const Error why = more.error();
    return showProblem(&why, {});
  }
  (void)applySet(*more, "add tissue");
  emit editEnded();
  list_->select(0);
  showSelected();
  emit chosenChanged();
  (*name_)["name"].setFocus(Qt::TabFocusReason);  // with its text selected
}

void TissuePanel::remove() {
  if (!current()) return;
  source_->takeTyped();
  const Result<TissueSet> less = withoutTissue(tissues_, chosen());
  if (!less) {
    const Error why = less.error();
    return showProblem(&why, {});
  }
  (void)applySet(*less, "remove tissue");
  emit editEnded();
  showSelected();
  emit chosenChanged();
}

void TissuePanel::moveThreshold(std::size_t tissue, RangeEnd end, int hu, bool alone) {
  if (!locked_.isEmpty() || tissue >= tissues_.tissues.size() ||
      before_.tissues.size() != tissues_.tissues.size()) {
    return;
  }
  TissueSet moved = withThreshold(before_, tissue, end, hu, !alone, declared_);
  // What was changed meanwhile of the rest stays.
  for (std::size_t i = 0; i < moved.tissues.size(); ++i) {
    Tissue now = tissues_.tissues[i];
    now.hu_min = moved.tissues[i].hu_min;
    now.hu_max = moved.tissues[i].hu_max;
    now.hu_source = moved.tissues[i].hu_source;
    moved.tissues[i] = std::move(now);
  }
  const Status applied = applySet(moved, "threshold");
  if (!applied || !current()) return;
  showProblem(nullptr, {});
  low_->show(current()->hu_min);
  high_->show(current()->hu_max);
}

Status TissuePanel::apply(const Tissue& wanted, const QString& what) {
  TissueSet set = tissues_;
  set.tissues[std::size_t(list_->current())] = wanted;
  return applySet(set, what);
}

Status TissuePanel::applySet(const TissueSet& set, const QString& what) {
  if (set == tissues_) return {};
  if (Status valid = validate(set, ""); !valid) return valid;
  tissues_ = set;
  set_name_->setText(toQt(tissues_.name));
  list_->show(tissues_, looks_);
  showOutcome();
  emit tissuesChanged(tissues_, what);
  return {};
}

}  // namespace trephine
