#include "ui/tissue/tissue_mechanics.h"

#include <QFormLayout>
#include <QHBoxLayout>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/utf8.h"
#include "tissue/tissue_edits.h"
#include "ui/common/colours.h"
#include "ui/common/making.h"
#include "ui/common/plain_text.h"
#include "ui/common/translations.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

enum Stopping { kByStiffness, kStops, kGoesIn };  // in the order of the list

QString unitOf(const TissueNumber& row) {
  return QString::fromUtf8(row.shown_unit ? row.shown_unit : row.unit);
}

}  // namespace

TissueMechanics::TissueMechanics(QWidget* parent) : QWidget(parent) {
  auto* form = new QFormLayout(this);
  form->setContentsMargins(0, 0, 0, 0);
  form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
  form->setVerticalSpacing(6);
  std::vector<QLabel*> labels;
  for (const TissueNumber& row : kTissueNumbers) labels.push_back(addNumber(row));
  // Longer ones over two lines, as the row is: the numbers need the width.
  int widest_word = 0;
  for (QLabel* label : labels) {
    label->ensurePolished();
    widest_word = std::max(widest_word, label->minimumSizeHint().width());
  }
  for (QLabel* label : labels) label->setFixedWidth(widest_word);
  cutting_ =
      std::make_unique<FieldRows<Tissue>>(FieldsOf<Tissue>(kCuttingFields), *form, this, "tissue:");
  cutting_->entered = [this](const Tissue& other, const char* key) {
    if (wanted) (void)wanted(other, key);
  };
  solid_ = new QComboBox(this);
  solid_->setObjectName("solid");
  solid_->setAccessibleName(tr("Whether it stops a tool"));
  solid_->setToolTip(tr("A tool stays outside of what stops it, as of bone, until it is cut; by "
                        "its stiffness: from %1 N/m on")
                         .arg(kSolidFrom_N_per_m));
  solid_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  solid_->setMinimumContentsLength(3);
  for (int i = 0; i < 3; ++i) solid_->addItem({});
  form->addRow(tr("A tool"), solid_);
  connect(solid_, &QComboBox::activated, this, [this](int chosen) {
    Tissue other = tissue_;
    other.solid.reset();
    if (chosen != kByStiffness) other.solid = chosen == kStops;
    if (wanted) (void)wanted(other, "solid");
  });
}

QLabel* TissueMechanics::addNumber(const TissueNumber& row) {
  Number number{new DecimalField(QString(row.label).toLower(), this), new LimitBar(this),
                new QLineEdit(this), new ElidedLabel(this), &row};
  number.box->setDecimals(row.decimals);
  number.box->setLimits(row.row().range.low, row.most);
  number.box->setSingleStep(row.step);
  number.box->setSuffix(' ' + unitOf(row));
  number.box->setAccessibleName(fromRoom(row.label));
  number.bar->setObjectName(QString(row.label).toLower() + "Limit");
  number.bar->setRange(row.most, row.step, row.decimals);
  number.source->setObjectName(QString(row.label).toLower() + "Source");
  number.source->setAccessibleName(tr("Source of %1").arg(fromRoom(row.label)));
  number.source->setFrame(false);
  number.source->setMaxLength(300);
  QFont small = number.source->font();
  small.setPointSizeF(small.pointSizeF() * 0.88);
  small.setItalic(true);
  number.source->setFont(small);
  number.source->setMinimumWidth(40);
  number.bar->setFont(small);
  number.known->setObjectName(QString(row.label).toLower() + "Known");
  number.known->setFont(small);
  number.box->entered = [this, number] { entered(number); };
  connect(number.source, &QLineEdit::editingFinished, this,
          [this, number] { sourceEntered(number); });
  numbers_.push_back(number);

  auto* below = tight(new QHBoxLayout, 6);
  below->addWidget(number.source, 1);
  below->addWidget(number.bar, 1);
  auto* rows = tight(new QVBoxLayout, 0);
  rows->addLayout(number.box->withReason());
  rows->addLayout(below);
  rows->addWidget(number.known);
  auto* label = wrapped(new QLabel(fromRoom(row.label), this));
  label->setBuddy(number.box);
  static_cast<QFormLayout*>(layout())->addRow(label, rows);
  return label;
}

void TissueMechanics::show(const Tissue& tissue, const Tissue& declared) {
  tissue_ = tissue;
  declared_ = declared;
  for (const Number& n : numbers_) n.box->show(n.row->valueOf(tissue) * n.row->shown_per);
  showOutcome();
}

void TissueMechanics::update(const Tissue& tissue, const Tissue& declared) {
  const Tissue before = std::exchange(tissue_, tissue);
  declared_ = declared;
  // Of the two that say what cutting costs, the one that was not entered has changed as well.
  for (const Number& n : numbers_) {
    const double value = n.row->valueOf(tissue);
    if (n.row->isCutting() && value != n.row->valueOf(before))
      n.box->show(value * n.row->shown_per);
  }
  showOutcome();
}

void TissueMechanics::setLimits(const std::optional<ArmsLimit>& arms, DemandedOf demanded,
                                const std::vector<LawKind>& laws, RemovalKind removal,
                                ControllerKind in_force) {
  arms_ = arms;
  demanded_ = std::move(demanded);
  laws_ = laws;
  removal_ = removal;
  in_force_ = in_force;
  showOutcome();
}

void TissueMechanics::showOutcome() {
  for (const Number& n : numbers_) {
    const SourcedNumber* given = n.row->of(tissue_);
    const QString source = given ? toQt(given->source) : QString();
    n.source->setEnabled(given);
    if (!n.source->hasFocus() || !n.source->isModified()) n.source->setText(source);
    n.source->setCursorPosition(0);
    n.source->setToolTip(source);
    n.source->setPlaceholderText(given ? tr("where the number comes from") : tr("not given"));
    showKnown(n);
    n.box->setToolTip(tr("%1. From %2 to %3 %4.")
                          .arg(fromRoom(n.row->meaning))
                          .arg(n.row->row().range.low)
                          .arg(n.row->most, 0, 'g', 6)
                          .arg(unitOf(*n.row)) +
                      '\n' + (given ? tr("Source: %1").arg(source) : tr("It is not given.")) +
                      (n.known->text().isEmpty() ? QString() : '\n' + inLines(n.known->text())));
    n.bar->setFelt(!laws_ || isFelt(*n.row, tissue_, *laws_, removal_));
    n.bar->setWeaker(arms_ && demanded_ && in_force_ == ControllerKind::bounded &&
                     isWeaker(*n.row, tissue_, *arms_, demanded_));
    n.bar->setValue(n.row->valueOf(tissue_) * n.row->shown_per);
    std::optional<double> most;
    if (arms_ && demanded_) most = mostShown(*n.row, tissue_, *arms_, demanded_);
    if (most) *most *= n.row->shown_per;
    n.bar->setLimit(most, isForce(*n.row) || in_force_ == ControllerKind::bounded);
  }
  cutting_->show(tissue_);
  Tissue by_itself = tissue_;
  by_itself.solid.reset();
  solid_->setItemText(kByStiffness, by_itself.isSolid() ? tr("is stopped, by its stiffness")
                                                        : tr("goes in, by its stiffness"));
  solid_->setItemText(kStops, tr("is stopped until it is cut"));
  solid_->setItemText(kGoesIn, tr("goes in"));
  solid_->setCurrentIndex(!tissue_.solid ? kByStiffness : *tissue_.solid ? kStops : kGoesIn);
}

void TissueMechanics::showKnown(const Number& n) {
  const SourcedNumber* given = n.row->of(tissue_);
  const QString words =
      given ? toQt(provenanceWords(*given, unitOf(*n.row).toStdString(), n.row->shown_per))
            : QString();
  n.known->setText(words);
  n.known->setVisible(!words.isEmpty());
  const bool outside = given && given->isOutOfRange();
  colours::setText(*n.known, outside ? colours::kCaution : colours::kQuiet);
}

QString TissueMechanics::feltWords() const {
  if (!arms_) return {};
  QStringList lines;
  const auto line = [&](const QString& what, const QString& unit, double demanded, double most) {
    if (demanded <= most) return;
    const QString words =
        isBounded() ? tr("%1: the exercise's laws together demand %2 %4, these arms show at most "
                         "%3 %4, and that is felt.")
                    : tr("%1: the exercise's laws together demand %2 %4, and nothing bounds it "
                         "under this controller: above %3 %4 these arms may shake.");
    lines << words.arg(what).arg(demanded, 0, 'f', 0).arg(most, 0, 'f', 0).arg(unit);
  };
  const Impedance demanded = demanded_(tissue_);
  line(tr("Damping"), tr("N\u00b7s/m"), demanded.damping, arms_->most.b_max);
  line(tr("Stiffness"), tr("N/m"), demanded.stiffness, arms_->most.k_max);
  return lines.join('\n');
}

void TissueMechanics::entered(const Number& n) {
  const TissueNumber& row = *n.row;
  // Half a digit: what is shown rounded is not another number.
  const double half = 0.5 * std::pow(10.0, -row.decimals);
  const Tissue other =
      withNumber(tissue_, row, n.box->wanted() / row.shown_per, half / row.shown_per, declared_);
  if (wanted && wanted(other, row.key)) n.box->take();
}

void TissueMechanics::sourceEntered(const Number& n) {
  const SourcedNumber* given = n.row->of(tissue_);
  const QString typed = toQt(cleanUtf8(n.source->text().simplified().toStdString()));
  n.source->setModified(false);
  if (!given || typed.isEmpty() || typed == toQt(given->source)) return showOutcome();
  if (wanted) (void)wanted(withSource(tissue_, *n.row, typed.toStdString(), declared_), n.row->key);
}

}  // namespace trephine
