#include "ui/tissue/tissue_panel.h"

#include <QColorDialog>
#include <QFormLayout>
#include <QPainter>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue/tissue_edits.h"
#include "ui/common/colours.h"
#include "ui/common/placing.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kOpacitySteps = 1000;
const char* const kOwnSource = "tuned here, uncited";

QIcon swatch(const QColor& colour, bool hidden) {
  QPixmap pixmap(32, 32);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(colour, 3));
  painter.setBrush(hidden ? QBrush(Qt::NoBrush) : QBrush(colour));
  painter.drawRoundedRect(QRectF(4, 4, 24, 24), 6, 6);
  QIcon icon(pixmap);
  icon.addPixmap(pixmap, QIcon::Selected);  // a colour must not change by being chosen
  return icon;
}

QString presetWords(ViewPreset preset) {
  switch (preset) {
    case ViewPreset::bone:
      return TissuePanel::tr("Bone");
    case ViewPreset::skin:
      return TissuePanel::tr("Skin");
    case ViewPreset::soft_tissue:
      return TissuePanel::tr("Soft tissue");
    case ViewPreset::liver:
      return TissuePanel::tr("Liver");
  }
  return {};
}

const char* presetName(ViewPreset preset) {
  switch (preset) {
    case ViewPreset::bone:
      return "presetBone";
    case ViewPreset::skin:
      return "presetSkin";
    case ViewPreset::soft_tissue:
      return "presetSoftTissue";
    case ViewPreset::liver:
      return "presetLiver";
  }
  return "";
}

// Stands beside what it speaks of, where there is something to say.
QLabel* notice(const char* name, QWidget* parent) {
  auto* label = new QLabel(parent);
  label->setObjectName(name);
  label->setWordWrap(true);
  colours::setText(*label, colours::kCaution);
  label->hide();
  return label;
}

}  // namespace

double opacityAtSlider(double position) {
  return position * position;
}
double sliderAtOpacity(double opacity) {
  return std::sqrt(opacity);
}

TissuePanel::TissuePanel(QWidget* parent) : QWidget(parent) {
  build();
  editor_->setEnabled(false);
}

void TissuePanel::build() {
  list_ = new QListWidget(this);
  list_->setObjectName("tissueList");
  list_->setIconSize({16, 16});
  list_->setSizeAdjustPolicy(QAbstractScrollArea::AdjustToContents);
  list_->setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Maximum);
  list_->setSpacing(2);

  editor_ = new QWidget(this);
  title_ = new QLabel(editor_);
  title_->setProperty("title", true);
  colour_ = new QToolButton(editor_);
  colour_->setObjectName("colour");
  colour_->setIconSize({20, 20});
  colour_->setText(tr("Colour\u2026"));
  colour_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  opacity_ = new QSlider(Qt::Horizontal, editor_);
  opacity_->setObjectName("opacity");
  opacity_->setRange(0, kOpacitySteps);
  opacity_->setPageStep(kOpacitySteps / 10);
  opacity_text_ = new QLabel(editor_);
  opacity_text_->setMinimumWidth(fontMetrics().horizontalAdvance("0.000 /mm "));

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
  for (WholeNumberField* box : {low_, high_, label_}) box->entered = [this] { rangeEntered(); };
  problem_ = notice("tissueProblem", editor_);
  gaps_ = notice("tissueGaps", editor_);
  auto* high_row = high_->withReason();
  high_row->addWidget(problem_);
  high_row->addWidget(gaps_);

  auto* head = new QHBoxLayout;
  head->addWidget(title_, 1);
  head->addWidget(colour_);
  auto* opacity_row = new QHBoxLayout;
  opacity_row->addWidget(opacity_, 1);
  opacity_row->addWidget(opacity_text_);

  auto* form = new QFormLayout;
  form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
  form->setVerticalSpacing(6);
  form->addRow(tr("From"), low_->withReason());
  form->addRow(tr("To"), high_row);
  form->addRow(tr("Label"), label_->withReason());
  form->addRow(tr("Opacity"), opacity_row);
  for (const TissueNumber& row : kTissueNumbers) {
    if (row.label) form->addRow(tr(row.label), addNumber(row));
  }

  auto* editor_layout = new QVBoxLayout(editor_);
  editor_layout->setContentsMargins(0, 0, 0, 0);
  editor_layout->addLayout(head);
  editor_layout->addLayout(form);

  felt_ = notice("tissueFelt", this);

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(10, 10, 10, 10);
  layout->setSpacing(10);
  layout->addLayout(buildPresets());
  layout->addWidget(list_);
  locked_words_ = notice("tissuesLocked", this);
  layout->addWidget(locked_words_);
  layout->addWidget(editor_);
  layout->addWidget(felt_);
  layout->addStretch(1);

  connect(list_, &QListWidget::currentRowChanged, this, &TissuePanel::showSelected);
  connect(colour_, &QToolButton::clicked, this, &TissuePanel::chooseColour);
  connect(opacity_, &QSlider::valueChanged, this, [this](int step) {
    if (!current()) return;
    Tissue wanted = *current();
    wanted.opacity = opacityAtSlider(double(step) / kOpacitySteps);
    (void)apply(wanted);
  });
}

QLayout* TissuePanel::buildPresets() {
  auto* grid = new QGridLayout;  // two beside each other: the column is narrow
  grid->setSpacing(4);
  presets_title_ = new QLabel(tr("View"), this);
  grid->addWidget(presets_title_, 0, 0);
  for (const ViewPreset preset : kViewPresets) {
    auto* button = new QToolButton(this);
    button->setObjectName(presetName(preset));
    button->setText(presetWords(preset));
    button->setAccessibleName(tr("View preset: %1").arg(button->text()));
    button->setToolTip(tr("A start for the choices below; what is felt and cut stays as it is"));
    button->setFocusPolicy(Qt::StrongFocus);
    button->hide();
    connect(button, &QToolButton::clicked, this, [this, preset] {
      if (const auto looks = presetLooks(tissues_, preset)) lookChosen(*looks);
    });
    const int place = int(presets_.size());
    grid->addWidget(button, place / 2, 1 + place % 2);
    presets_.emplace_back(preset, button);
  }
  grid->setColumnStretch(3, 1);
  return grid;
}

QLayout* TissuePanel::addNumber(const TissueNumber& row) {
  auto* box = new DecimalField(QString(row.label).toLower(), editor_);
  box->setDecimals(2);
  box->setLimits(row.row().range.low, row.most);
  box->setSingleStep(row.step);
  box->setSuffix(' ' + QString::fromUtf8(row.unit));
  const Number number{box, &row};
  box->entered = [this, number] { numberEntered(number); };
  numbers_.push_back(number);
  return box->withReason();
}

void TissuePanel::setTissues(const TissueSet& tissues, const TissueSet& declared) {
  tissues_ = tissues;
  declared_ = declared;
  showList();
  showSelected();
}

void TissuePanel::setLooks(const TissueLooks& looks) {
  looks_ = looks;
  showList();
}

void TissuePanel::lookChosen(const TissueLooks& looks) {
  if (looks == looks_) return;
  setLooks(looks);
  emit looksChanged(looks_);
}

void TissuePanel::setRenderable(const std::optional<Renderable>& most,
                                std::function<Impedance(const Tissue&)> demanded,
                                ControllerKind in_force) {
  renderable_ = most;
  demanded_ = std::move(demanded);
  in_force_ = in_force;
  showFelt();
}

void TissuePanel::showFelt() {
  const Tissue* tissue = current();
  const bool bounded = in_force_ == ControllerKind::bounded;
  QStringList lines;
  if (tissue && renderable_) {
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
    line(tr("Damping"), tr("N\u00b7s/m"), demanded.damping, renderable_->b_max);
    line(tr("Stiffness"), tr("N/m"), demanded.stiffness, renderable_->k_max);
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
    if (tissues_.tissues[i].id == id) list_->setCurrentRow(int(i));
  }
}

void TissuePanel::setLocked(const QString& why) {
  locked_ = why;
  locked_words_->setText(why);
  locked_words_->setVisible(!why.isEmpty());
  editor_->setEnabled(current() && why.isEmpty());
}

void TissuePanel::setLabelsOpen(bool open) {
  labels_open_ = open;
  showSelected();
}

// A row of the list with its choice of looks.
void TissuePanel::addItem() {
  list_->addItem(QString());
  auto* beside = new QWidget;
  auto* layout = new QHBoxLayout(beside);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addStretch(1);
  auto* box = new LookBox(beside);
  layout->addWidget(box);
  const int row = list_->count() - 1;
  box->chosen = [this, row](TissueLook look) {
    TissueLooks looks = looks_;
    looks[tissues_.tissues[std::size_t(row)].id] = look;
    lookChosen(looks);
  };
  list_->item(row)->setSizeHint({0, beside->sizeHint().height()});
  list_->setItemWidget(list_->item(row), beside);
  setTabOrder(look_boxes_.empty() ? static_cast<QWidget*>(list_) : look_boxes_.back(), box);
  look_boxes_.push_back(box);
}

void TissuePanel::showList() {
  const int row = std::max(0, list_->currentRow());
  listing_ = true;
  while (list_->count() > int(tissues_.tissues.size())) {
    delete list_->takeItem(list_->count() - 1);
    look_boxes_.pop_back();
  }
  while (list_->count() < int(tissues_.tissues.size())) addItem();
  bool any = false;
  for (const auto& [preset, button] : presets_) {
    button->setVisible(presetLooks(tissues_, preset).has_value());
    any = any || !button->isHidden();
  }
  presets_title_->setVisible(any);
  for (int i = 0; i < list_->count(); ++i) {
    const Tissue& tissue = tissues_.tissues[std::size_t(i)];
    QListWidgetItem& item = *list_->item(i);
    item.setText(toQt(tissue.name));
    const TissueLook look = lookOf(tissue, looks_);
    look_boxes_[std::size_t(i)]->show(tissue, look);
    item.setIcon(swatch(colours::of(tissue.colour), look == TissueLook::hidden));
    item.setToolTip(tr("%1 to %2 HU%3%4")
                        .arg(tissue.hu_min)
                        .arg(tissue.hu_max)
                        .arg(tissue.label ? tr(", label %1").arg(*tissue.label) : QString())
                        .arg(look == TissueLook::hidden ? tr(", not drawn") : QString()));
  }
  list_->setCurrentRow(std::min(row, list_->count() - 1));
  listing_ = false;
}

const Tissue* TissuePanel::current() const {
  const int row = list_->currentRow();
  if (row < 0 || std::size_t(row) >= tissues_.tissues.size()) return nullptr;
  return &tissues_.tissues[std::size_t(row)];
}

const Tissue& TissuePanel::declared(const Tissue& tissue) const {
  const Tissue* found = declared_.find(tissue.id);
  return found ? *found : tissue;
}

void TissuePanel::showSelected() {
  if (listing_) return;
  const Tissue* tissue = current();
  editor_->setEnabled(tissue && locked_.isEmpty());
  if (!tissue) return;
  title_->setText(toQt(tissue->name));
  low_->show(tissue->hu_min);
  high_->show(tissue->hu_max);
  label_->show(tissue->label.value_or(0));
  problem_->hide();
  {
    const QSignalBlocker quiet(opacity_);
    opacity_->setValue(int(std::lround(sliderAtOpacity(tissue->opacity) * kOpacitySteps)));
  }
  for (const Number& number : numbers_) number.box->show(number.row->valueOf(*tissue));
  showOutcome();
}

void TissuePanel::showOutcome() {
  const Tissue* tissue = current();
  if (!tissue) return;
  colour_->setIcon(swatch(colours::of(tissue->colour), false));
  for (QSpinBox* box : {low_, high_}) {
    box->setToolTip(tr("Source: %1").arg(toQt(tissue->hu_source)));
  }
  label_->setEnabled(labels_open_ || tissue->label);
  label_->setToolTip(labels_open_ ? tr("Only where the label map has this label")
                                  : tr("Open the case's label map first, on the Case tab"));
  opacity_text_->setText(tr("%1 /mm").arg(tissue->opacity, 0, 'f', 3));
  for (const Number& number : numbers_) {
    const SourcedNumber* given = number.row->of(*tissue);
    number.box->setToolTip(given ? tr("Source: %1").arg(toQt(given->source)) : QString());
  }
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
    (void)apply(wanted);
  });
  dialog->open();
}

// HU and label together decide whether two tissues claim the same voxels.
void TissuePanel::rangeEntered() {
  if (!current()) return;
  Tissue wanted = *current();
  wanted.hu_min = low_->wanted();
  wanted.hu_max = high_->wanted();
  const Tissue& cited = declared(wanted);
  if (wanted.hu_min == cited.hu_min && wanted.hu_max == cited.hu_max) {
    wanted.hu_source = cited.hu_source;
  } else if (wanted.hu_min != current()->hu_min || wanted.hu_max != current()->hu_max) {
    wanted.hu_source = kOwnSource;
  }
  wanted.label.reset();
  if (label_->wanted() > 0) wanted.label = label_->wanted();
  const Status valid = apply(wanted);
  if (!valid) {
    problem_->setText(
        tr("Not applied. %1. %2.").arg(toQt(valid.error().what), toQt(valid.error().next)));
    giveRoom(*problem_, high_->width());
    return problem_->show();
  }
  problem_->hide();
  for (WholeNumberField* box : {low_, high_, label_}) box->take();
}

void TissuePanel::numberEntered(const Number& number) {
  if (!current()) return;
  Tissue wanted = *current();
  const auto shown = [&](double other) { return std::abs(number.box->wanted() - other) < 0.005; };
  if (!shown(number.row->valueOf(wanted))) {
    const SourcedNumber* cited = number.row->of(declared(*current()));
    const SourcedNumber own{number.box->wanted(), kOwnSource};
    number.row->set(wanted, cited && shown(cited->value) ? *cited : own);
  }
  if (apply(wanted)) number.box->take();
}

Status TissuePanel::apply(const Tissue& wanted) {
  TissueSet set = tissues_;
  set.tissues[std::size_t(list_->currentRow())] = wanted;
  if (sameSet(set, tissues_)) return {};
  if (Status valid = validate(set, ""); !valid) return valid;
  tissues_ = std::move(set);
  showList();
  showOutcome();
  emit tissuesChanged(tissues_);
  return {};
}

}  // namespace trephine
