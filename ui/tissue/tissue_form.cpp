#include "ui/tissue/tissue_form.h"

#include <QColorDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <cmath>
#include <utility>

#include "ui/common/colours.h"
#include "ui/common/making.h"
#include "ui/common/placing.h"
#include "ui/common/setting_words.h"
#include "ui/common/words.h"
#include "ui/tissue/look_box.h"
#include "ui/tissue/tissue_list.h"

namespace trephine {

namespace {

constexpr int kOpacitySteps = 1000;

constexpr FieldOf<Tissue> kSourceFields[] = {
    {{"hu_source", {1, 300}, Given::always, "where the range comes from", "Source"},
     &Tissue::hu_source},
};

// Whether a tissue's encloser, or that one's and so on, has this id.
bool liesInside(const TissueSet& set, const Tissue& tissue, const std::string& id) {
  const Tissue* at = &tissue;
  for (std::size_t n = 0; at && n < set.tissues.size(); ++n) {
    if (at->within == id) return true;
    at = at->within.empty() ? nullptr : set.find(at->within);
  }
  return false;
}

}  // namespace

// Made from top to bottom: Tab goes through widgets in the order in which they were made.
TissueForm::TissueForm(QWidget* parent) : QWidget(parent) {
  auto* form = new QFormLayout;
  form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
  form->setVerticalSpacing(6);
  constexpr FieldsOf<Tissue> kFields = kTissueFields;
  name_ = fieldsOf(kFields.subspan(1, 1), *form, "name");
  addLooks(*form);
  addRange(*form);
  source_ = fieldsOf(kSourceFields, *form, "hu");
  where_ = fieldsOf(kFields.subspan(2, 1), *form, "where");
  addLabel(*form);
  within_ = fieldsOf(kFields.subspan(5, 1), *form, "within");
  shell_ = std::make_unique<FieldRows<Tissue::Shell>>(FieldsOf<Tissue::Shell>(kShellFields), *form,
                                                      this, "shell:");
  shell_->entered = [this](const Tissue::Shell& shell, const char*) { shellEntered(shell); };
  mechanics_ = new TissueMechanics(this);
  mechanics_->wanted = [this](const Tissue& wanted, const char* what) {
    const Status applied = apply(wanted, QString(what) + ':' + toQt(wanted.id));
    if (applied) emit editEnded();
    return applied;
  };
  auto* layout = tight(new QVBoxLayout(this));
  layout->addLayout(form);
  layout->addWidget(mechanics_);
}

void TissueForm::addLooks(QFormLayout& form) {
  opacity_ = new QSlider(Qt::Horizontal, this);
  opacity_->setObjectName("opacity");
  opacity_->setRange(0, kOpacitySteps);
  opacity_->setPageStep(kOpacitySteps / 10);
  connect(opacity_, &QSlider::valueChanged, this, [this](int step) {
    if (!current()) return;
    Tissue wanted = *current();
    wanted.opacity = opacityAtSlider(double(step) / kOpacitySteps);
    (void)apply(wanted, "opacity:" + toQt(wanted.id));
  });
  connect(opacity_, &QSlider::sliderReleased, this, &TissueForm::editEnded);
  opacity_text_ = new QLabel(this);
  opacity_text_->setMinimumWidth(fontMetrics().horizontalAdvance("0.000 /mm "));
  colour_ =
      settingButton("colour", tr("Colour\u2026"), tr("Colour of the tissue, in all views"), this);
  colour_->setIconSize({20, 20});
  colour_->setAccessibleName(colour_->text());
  connect(colour_, &QToolButton::clicked, this, &TissueForm::chooseColour);
  auto* looks = new QHBoxLayout;
  looks->addWidget(opacity_, 1);
  looks->addWidget(opacity_text_);
  looks->addWidget(colour_);
  form.addRow(tr("Opacity"), looks);
}

void TissueForm::addRange(QFormLayout& form) {
  low_ = new WholeNumberField("huLow", this);
  high_ = new WholeNumberField("huHigh", this);
  for (WholeNumberField* box : {low_, high_}) {
    box->setLimits(int(kHuRange.low), int(kHuRange.high));
    box->setSingleStep(5);
    box->setSuffix(tr(" HU"));
    box->entered = [this] { rangeEntered(); };
  }
  problem_ = problemLabel("tissueProblem", this);
  gaps_ = problemLabel("tissueGaps", this);
  auto* high_row = high_->withReason();
  high_row->addWidget(problem_);
  high_row->addWidget(gaps_);
  form.addRow(tr("From"), low_->withReason());
  form.addRow(tr("To"), high_row);
}

void TissueForm::addLabel(QFormLayout& form) {
  label_ = new WholeNumberField("label", this);
  label_->setLimits(0, int(kLabelRange.high));
  label_->setWord(0, tr("any"));
  label_->setPrefix(tr("label "));
  label_->entered = [this] { rangeEntered(); };
  form.addRow(tr("Label"), label_->withReason());
}

std::unique_ptr<FieldRows<Tissue>> TissueForm::fieldsOf(FieldsOf<Tissue> fields, QFormLayout& form,
                                                        const char* what) {
  auto made = std::make_unique<FieldRows<Tissue>>(fields, form, this, "tissue:");
  made->entered = [this, what](const Tissue& wanted, const char*) {
    if (!current() || current()->id != wanted.id) return;
    if (wanted.structure != current()->structure) return structureChosen(wanted.structure);
    (void)apply(wanted, what);
    emit editEnded();
  };
  return made;
}

const Tissue* TissueForm::current() const {
  return at_ < tissues_.tissues.size() ? &tissues_.tissues[at_] : nullptr;
}

const Tissue& TissueForm::declared(const Tissue& tissue) const {
  const Tissue* found = declared_.find(tissue.id);
  return found ? *found : tissue;
}

void TissueForm::show(const TissueSet& tissues, std::size_t at, const TissueSet& declared) {
  tissues_ = tissues;
  at_ = at;
  declared_ = declared;
  showAll();
}

void TissueForm::update(const TissueSet& tissues, std::size_t at) {
  tissues_ = tissues;
  at_ = at;
  showOutcome();
}

void TissueForm::showAll() {
  if (!current()) return;
  showRange();
  label_->show(current()->structure.empty() ? current()->label.value_or(0) : 0);
  mechanics_->show(*current(), declared(*current()));
  showOutcome();
}

void TissueForm::showRange() {
  if (!current()) return;
  showProblem(nullptr);
  low_->show(current()->hu_min);
  high_->show(current()->hu_max);
}

void TissueForm::setStructures(const std::vector<std::string>& names) {
  structures_ = names;
  showPlaces();
}

void TissueForm::enterName() {
  (*name_)["name"].setFocus(Qt::TabFocusReason);
}

void TissueForm::showGaps() {
  QStringList ranges;
  for (const HuRange& range : lostHu(tissues_, declared_)) {
    ranges << tr("%1 to %2 HU").arg(range.low).arg(range.high);
  }
  gaps_->setText(tr("Without a tissue: %1. Nothing is drawn, felt or cut there.")
                     .arg(ranges.join(tr(", ", "between ranges of HU"))));
  giveRoom(*gaps_, high_->width());
  gaps_->setVisible(!ranges.isEmpty());
}

// Anywhere, or in one of the case's structures; one that the case lacks stays to be seen. Else, on
// a case without it, nowhere or the outside of another.
void TissueForm::showPlaces() {
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
  FieldEditor::Offers enclosing{{tr("nothing"), ""}};
  for (const Tissue& other : tissues_.tissues) {
    // One that lies inside of this tissue cannot be around it.
    if (!tissue || other.id == tissue->id || liesInside(tissues_, other, tissue->id)) continue;
    enclosing.emplace_back(shownName(other.name), other.id);
  }
  (*within_)["within"].offer(enclosing);
  (*within_)["within"].setToolTip(tr(
      "What was cut is named after this tissue only inside of that one, as brain inside a skull. "
      "Elsewhere results call it \"Not told apart\""));
  if (!tissue) return;
  within_->show(*tissue);
  where_->show(*tissue);
  shell_->show(tissue->shell.value_or(Tissue::Shell{}));
  shell_->setVisible(!tissue->structure.empty());
  (*shell_)["thickness_mm"].setEnabled(tissue->shell.has_value());
}

void TissueForm::showOutcome() {
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
                     : labels_open_             ? tr("Only where the label map has this label")
                                    : tr("Open the case's label map first, on the Structures tab"));
  opacity_text_->setText(tr("%1 /mm").arg(tissue->opacity, 0, 'f', 3));
  mechanics_->update(*tissue, declared(*tissue));
  showGaps();
}

void TissueForm::chooseColour() {
  const Tissue* tissue = current();
  if (!tissue) return;
  // Not of this one, which is locked at times.
  auto* dialog = new QColorDialog(colours::of(tissue->colour), parentWidget());
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

void TissueForm::showProblem(const Error* why, const std::vector<HuOverlap>& overlaps) {
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
void TissueForm::rangeEntered() {
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
    return showProblem(&why, overlapsOf(tissues_, at_, wanted));
  }
  showProblem(nullptr);
  emit editEnded();
  for (WholeNumberField* box : {low_, high_, label_}) box->take();
}

void TissueForm::structureChosen(const std::string& name) {
  const Tissue wanted = inStructure(tissues_, *current(), name, declared_);
  const Status valid = apply(wanted, "where");
  emit editEnded();
  if (valid) return showAll();
  const Error why = valid.error();
  showPlaces();
  showProblem(&why, overlapsOf(tissues_, at_, wanted));
}

// One of no structure: nothing stands in.
void TissueForm::shellEntered(const Tissue::Shell& shell) {
  if (!current()) return;
  Tissue wanted = *current();
  wanted.shell.reset();
  if (!shell.of.empty()) wanted.shell = shell;
  const Status valid = apply(wanted, "where");
  emit editEnded();
  if (valid) return;
  const Error why = valid.error();
  showProblem(&why);
}

}  // namespace trephine
