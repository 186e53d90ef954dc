#include "ui/tissue/tissue_panel.h"

#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "ui/common/colours.h"
#include "ui/common/making.h"
#include "ui/common/setting_words.h"

namespace trephine {

TissuePanel::TissuePanel(QWidget* parent) : QWidget(parent) {
  list_ = new TissueList(this);
  locked_words_ = problemLabel("tissuesLocked", this);
  felt_ = problemLabel("tissueFelt", this);
  hidden_ = problemLabel("tissueHidden", this);
  auto* layout = tight(new QVBoxLayout(this), 10, {10, 10, 10, 10});
  sets_ = new TissueSetRow(this);
  connect(sets_, &TissueSetRow::renamed, this, [this](const std::string& name) {
    TissueSet set = tissues_;
    set.name = name;
    (void)applySet(set, "set name");
  });
  layout->addWidget(sets_);
  poke_ = namedButton("pokeButton", tr("&Poke it"), false, this);
  poke_->setCheckable(true);
  poke_->setToolTip(tr("Feel the tissue with mouse or arm; nothing is cut (Ctrl+E)"));
  connect(poke_, &QPushButton::clicked, this, &TissuePanel::pokeWanted);
  layout->addWidget(poke_);
  layout->addWidget(list_);
  layout->addWidget(locked_words_);
  layout->addWidget(hidden_);
  form_ = new TissueForm(this);
  form_->apply = [this](const Tissue& wanted, const QString& what) {
    TissueSet set = tissues_;
    set.tissues[chosen()] = wanted;
    return applySet(set, what);
  };
  connect(form_, &TissueForm::editEnded, this, &TissuePanel::editEnded);
  connect(form_, &TissueForm::overlapsShown, this, &TissuePanel::overlapsShown);
  layout->addWidget(form_);
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
  // Without an exercise there is no set.
  form_->setEnabled(false);
  list_->setLocked(true);
  sets_->setOpen(false);
}

void TissuePanel::setTissues(const TissueSet& tissues, const TissueSet& declared) {
  tissues_ = tissues;
  declared_ = declared;
  list_->setLocked(isLocked());
  sets_->setOpen(!isLocked());
  sets_->show(tissues_.name);
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
  form_->mechanics().setLimits(most, std::move(demanded), laws, removal, in_force);
  showFelt();
}

void TissuePanel::showPoke(bool possible, bool poking) {
  poke_->setEnabled(possible);
  poke_->setChecked(poking);
  poke_->setText(poking ? tr("Stop &poking") : tr("&Poke it"));
}

void TissuePanel::showFelt() {
  const TissueMechanics& mechanics = form_->mechanics();
  colours::setText(*felt_, mechanics.isBounded() ? colours::kQuiet : colours::kCaution);
  felt_->setText(current() ? mechanics.feltWords() : QString());
  felt_->setVisible(!felt_->text().isEmpty());
}

void TissuePanel::setHidden(const QString& words) {
  hidden_->setText(words);
  hidden_->setVisible(!words.isEmpty());
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
  form_->setEnabled(current() && why.isEmpty());
  list_->setLocked(!why.isEmpty());
  sets_->setOpen(why.isEmpty());
}

void TissuePanel::setLabelsOpen(bool open) {
  form_->setLabelsOpen(open);
  showSelected();
}

const Tissue* TissuePanel::current() const {
  const int row = list_->current();
  if (row < 0 || std::size_t(row) >= tissues_.tissues.size()) return nullptr;
  return &tissues_.tissues[std::size_t(row)];
}

void TissuePanel::showSelected() {
  form_->setEnabled(current() && !isLocked());
  if (!current()) return;
  form_->show(tissues_, chosen(), declared_);
  showFelt();
}

void TissuePanel::add() {
  form_->takeTypedSource();
  const Result<TissueSet> more = withNewTissue(tissues_);
  if (!more) {
    const Error why = more.error();
    return form_->showProblem(&why);
  }
  (void)applySet(*more, "add tissue");
  emit editEnded();
  list_->select(0);
  showSelected();
  emit chosenChanged();
  form_->enterName();
}

void TissuePanel::remove() {
  if (!current()) return;
  form_->takeTypedSource();
  const Result<TissueSet> less = withoutTissue(tissues_, chosen());
  if (!less) {
    const Error why = less.error();
    return form_->showProblem(&why);
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
  const TissueSet moved = withThreshold(before_, tissue, end, hu, !alone, declared_);
  // What was changed meanwhile of the rest stays.
  if (applySet(withRangesOf(tissues_, moved), "threshold")) form_->showRange();
}

Status TissuePanel::applySet(const TissueSet& set, const QString& what) {
  if (set == tissues_) return {};
  if (Status valid = validate(set, ""); !valid) return valid;
  tissues_ = set;
  sets_->show(tissues_.name);
  list_->show(tissues_, looks_);
  if (current()) {
    form_->update(tissues_, chosen());
    showFelt();
  }
  emit tissuesChanged(tissues_, what);
  return {};
}

}  // namespace trephine
