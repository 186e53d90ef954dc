#include "ui/tissue_panel.h"

#include <QColorDialog>
#include <QFormLayout>
#include <QPainter>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ui/colours.h"
#include "ui/words.h"

namespace trephine {

namespace {

constexpr int kOpacitySteps = 1000;
const char* const kOwnSource = "tuned here, uncited";

QColor toColour(const Vec3& c) {
  return QColor::fromRgbF(float(c.x), float(c.y), float(c.z));
}

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

  low_ = new QSpinBox(editor_);
  low_->setObjectName("huLow");
  high_ = new QSpinBox(editor_);
  high_->setObjectName("huHigh");
  for (QSpinBox* box : {low_, high_}) {
    box->setRange(std::numeric_limits<std::int16_t>::min(),
                  std::numeric_limits<std::int16_t>::max());
    box->setSingleStep(5);
    box->setAccelerated(true);
    box->setSuffix(tr(" HU"));
    box->setKeyboardTracking(false);
    connect(box, &QSpinBox::valueChanged, this, &TissuePanel::edited);
  }

  label_ = new QSpinBox(editor_);
  label_->setObjectName("label");
  label_->setRange(0, 255);
  label_->setSpecialValueText(tr("any"));
  label_->setAccelerated(true);
  label_->setKeyboardTracking(false);
  connect(label_, &QSpinBox::valueChanged, this, &TissuePanel::edited);

  auto* head = new QHBoxLayout;
  head->addWidget(title_, 1);
  head->addWidget(colour_);
  auto* opacity_row = new QHBoxLayout;
  opacity_row->addWidget(opacity_, 1);
  opacity_row->addWidget(opacity_text_);

  auto* form = new QFormLayout;
  form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
  form->setVerticalSpacing(6);
  form->addRow(tr("From"), low_);
  form->addRow(tr("To"), high_);
  form->addRow(tr("Label"), label_);
  form->addRow(tr("Opacity"), opacity_row);
  form->addRow(tr("Damping"),
               addNumber("damping", tr(" N\u00b7s/m"), 1e5, 0.1, &Tissue::damping_Ns_per_m));
  form->addRow(tr("Stiffness"),
               addNumber("stiffness", tr(" N/m"), 1e7, 10.0, &Tissue::stiffness_N_per_m));
  form->addRow(tr("Friction"),
               addNumber("friction", tr(" N"), 100.0, 0.05, &Tissue::friction_N));

  auto* editor_layout = new QVBoxLayout(editor_);
  editor_layout->setContentsMargins(0, 0, 0, 0);
  editor_layout->addLayout(head);
  editor_layout->addLayout(form);

  felt_ = new QLabel(this);
  felt_->setObjectName("tissueFelt");
  felt_->setWordWrap(true);
  felt_->setProperty("quiet", true);
  felt_->hide();
  problem_ = new QLabel(this);
  problem_->setObjectName("tissueProblem");
  problem_->setWordWrap(true);
  QPalette warning = problem_->palette();
  warning.setColor(QPalette::WindowText, colours::kCaution);
  problem_->setPalette(warning);
  problem_->hide();

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(10, 10, 10, 10);
  layout->setSpacing(10);
  layout->addWidget(list_);
  layout->addWidget(editor_);
  layout->addWidget(felt_);
  layout->addWidget(problem_);
  layout->addStretch(1);

  connect(list_, &QListWidget::currentRowChanged, this, &TissuePanel::showSelected);
  connect(colour_, &QToolButton::clicked, this, &TissuePanel::chooseColour);
  connect(opacity_, &QSlider::valueChanged, this, &TissuePanel::edited);
}

QDoubleSpinBox* TissuePanel::addNumber(const char* name, const QString& unit, double most,
                                       double step, SourcedNumber Tissue::*field) {
  auto* box = new QDoubleSpinBox(editor_);
  box->setObjectName(name);
  box->setRange(0.0, most);
  box->setDecimals(2);
  box->setSingleStep(step);
  box->setSuffix(unit);
  box->setKeyboardTracking(false);
  connect(box, &QDoubleSpinBox::valueChanged, this, &TissuePanel::edited);
  numbers_.push_back({box, field});
  return box;
}

void TissuePanel::setTissues(const TissueSet& tissues) {
  edited_ = applied_ = tissues;
  problem_->hide();
  showList();
}

void TissuePanel::setRenderable(const std::optional<Renderable>& most,
                                std::function<Impedance(const Tissue&)> demanded) {
  renderable_ = most;
  demanded_ = std::move(demanded);
  showFelt();
}

void TissuePanel::showFelt() {
  const Tissue* tissue = current();
  QStringList lines;
  if (tissue && renderable_) {
    const auto line = [&](const QString& what, const QString& unit, double demanded, double most) {
      if (demanded <= most) return;
      lines << tr("%1: the exercise's laws together demand %2 %4, these arms show at most %3 %4, "
                  "and that is felt.")
                   .arg(what)
                   .arg(demanded, 0, 'f', 0)
                   .arg(most, 0, 'f', 0)
                   .arg(unit);
    };
    const Impedance demanded = demanded_(*tissue);
    line(tr("Damping"), tr("N\u00b7s/m"), demanded.damping, renderable_->b_max);
    line(tr("Stiffness"), tr("N/m"), demanded.stiffness, renderable_->k_max);
  }
  felt_->setText(lines.join('\n'));
  felt_->setVisible(!lines.isEmpty());
}

void TissuePanel::select(const std::string& id) {
  for (std::size_t i = 0; i < edited_.tissues.size(); ++i) {
    if (edited_.tissues[i].id == id) list_->setCurrentRow(int(i));
  }
}

void TissuePanel::setLabelsOpen(bool open) {
  labels_open_ = open;
  showSelected();
}

void TissuePanel::showList() {
  const int row = std::max(0, list_->currentRow());
  showing_ = true;
  while (list_->count() > int(edited_.tissues.size())) delete list_->takeItem(list_->count() - 1);
  while (list_->count() < int(edited_.tissues.size())) list_->addItem(QString());
  for (int i = 0; i < list_->count(); ++i) {
    const Tissue& tissue = edited_.tissues[std::size_t(i)];
    QListWidgetItem& item = *list_->item(i);
    item.setText(toQt(tissue.name));
    item.setIcon(swatch(toColour(tissue.colour), tissue.opacity == 0.0));
    item.setToolTip(tr("%1 to %2 HU%3%4")
                        .arg(tissue.hu_min)
                        .arg(tissue.hu_max)
                        .arg(tissue.label ? tr(", label %1").arg(*tissue.label) : QString())
                        .arg(tissue.opacity == 0.0 ? tr(", not drawn") : QString()));
  }
  showing_ = false;
  list_->setCurrentRow(std::min(row, list_->count() - 1));
  showSelected();
}

Tissue* TissuePanel::current() {
  const int row = list_->currentRow();
  if (row < 0 || std::size_t(row) >= edited_.tissues.size()) return nullptr;
  return &edited_.tissues[std::size_t(row)];
}

void TissuePanel::showSelected() {
  if (showing_) return;
  const Tissue* tissue = current();
  editor_->setEnabled(tissue);
  if (!tissue) return;
  showing_ = true;
  title_->setText(toQt(tissue->name));
  colour_->setIcon(swatch(toColour(tissue->colour), false));
  low_->setValue(tissue->hu_min);
  high_->setValue(tissue->hu_max);
  for (QSpinBox* box : {low_, high_})
    box->setToolTip(tr("Source: %1").arg(toQt(tissue->hu_source)));
  label_->setValue(tissue->label.value_or(0));
  label_->setEnabled(labels_open_ || tissue->label);
  label_->setToolTip(labels_open_ ? tr("Only where the label map has this label")
                                  : tr("Open the case's label map first, on the Case tab"));
  opacity_->setValue(int(std::lround(sliderAtOpacity(tissue->opacity) * kOpacitySteps)));
  opacity_text_->setText(tr("%1 /mm").arg(tissue->opacity, 0, 'f', 3));
  for (const Number& number : numbers_) {
    const SourcedNumber& value = tissue->*number.field;
    number.box->setValue(value.value);
    number.box->setToolTip(tr("Source: %1").arg(toQt(value.source)));
  }
  showing_ = false;
  showFelt();
}

void TissuePanel::chooseColour() {
  Tissue* tissue = current();
  if (!tissue) return;
  auto* dialog = new QColorDialog(toColour(tissue->colour), this);
  dialog->setObjectName("colourDialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("Colour of %1").arg(toQt(tissue->name)));
  connect(dialog, &QColorDialog::colorSelected, this, [this](const QColor& colour) {
    if (Tissue* chosen = current()) {
      chosen->colour = {colour.redF(), colour.greenF(), colour.blueF()};
      edited();
    }
  });
  dialog->open();
}

void TissuePanel::edited() {
  Tissue* tissue = current();
  if (showing_ || !tissue) return;
  if (low_->value() != tissue->hu_min || high_->value() != tissue->hu_max) {
    tissue->hu_min = low_->value();
    tissue->hu_max = high_->value();
    tissue->hu_source = kOwnSource;
  }
  tissue->label.reset();
  if (label_->value() > 0) tissue->label = label_->value();
  // Only what was moved: a slider's step must not round a number that a file gave.
  if (opacity_->value() != int(std::lround(sliderAtOpacity(tissue->opacity) * kOpacitySteps))) {
    tissue->opacity = opacityAtSlider(double(opacity_->value()) / kOpacitySteps);
  }
  for (const Number& number : numbers_) {
    SourcedNumber& value = tissue->*number.field;
    if (std::abs(number.box->value() - value.value) < 0.005) continue;
    value = {number.box->value(), kOwnSource};
  }
  showList();
  const Status valid = validate(edited_, "");
  problem_->setVisible(!valid.ok());
  if (!valid) {
    problem_->setText(
        tr("Not applied. %1. %2.").arg(toQt(valid.error().what), toQt(valid.error().next)));
    return;
  }
  applied_ = edited_;
  emit tissuesChanged(applied_);
}

}  // namespace trephine
