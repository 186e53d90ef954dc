#include "ui/structures/structure_look_row.h"

#include <QHBoxLayout>
#include <QSignalBlocker>
#include <cmath>

#include "ui/common/making.h"

namespace trephine {

namespace {
constexpr int kSteps = 100;
}

StructureLookRow::StructureLookRow(QWidget* parent)
    : QWidget(parent),
      look_(new LookBox(this)),
      opacity_(new QSlider(Qt::Horizontal, this)),
      number_(new QLabel(this)) {
  setObjectName("structureLooks");
  look_->setObjectName("structureLook");
  look_->setAccessibleName(tr("Look of the chosen structure in 3-D"));
  look_->setToolTip(tr("In the 3-D view only (V in the list or a view)"));
  opacity_->setObjectName("structureOpacity");
  opacity_->setAccessibleName(tr("Opacity of the chosen structure in 3-D"));
  opacity_->setToolTip(tr("How opaque it is in the 3-D view, per mm of depth"));
  opacity_->setRange(1, kSteps);  // hidden is another choice
  opacity_->setPageStep(kSteps / 10);
  number_->setMinimumWidth(fontMetrics().horizontalAdvance("0.00 /mm"));
  auto* layout = tight(new QHBoxLayout(this));
  layout->addWidget(new QLabel(tr("Look"), this));
  layout->addWidget(look_);
  layout->addWidget(opacity_, 1);
  layout->addWidget(number_);
  look_->chosen = [this](TissueLook look) { emit lookChosen(look); };
  connect(opacity_, &QSlider::valueChanged, this,
          [this](int step) { emit opacityChosen(opacityAtSlider(double(step) / kSteps)); });
}

void StructureLookRow::show(const QString& name, const std::optional<SeenStructure>& seen) {
  setEnabled(seen && seen->takesLook());
  if (!seen) return number_->clear();
  look_->setCurrentIndex(int(seen->look));
  look_->setAccessibleName(tr("Look of %1 in 3-D").arg(name));
  const QSignalBlocker quiet(opacity_);
  opacity_->setValue(int(std::lround(sliderAtOpacity(seen->opacity) * kSteps)));
  opacity_->setEnabled(seen->look == TissueLook::shown);  // a ghost is its outline
  number_->setText(tr("%1 /mm").arg(seen->opacity, 0, 'f', 2));
}

QString StructureLookRow::wordOf(const SeenStructure& seen) {
  if (!seen.takesLook()) return tr("no room");
  switch (seen.look) {
    case TissueLook::shown:
      return tr("shown");
    case TissueLook::ghosted:
      return tr("ghost");
    case TissueLook::hidden:
      return tr("hidden");
  }
  return {};
}

TissueLook StructureLookRow::after(TissueLook look) {
  return look == TissueLook::shown     ? TissueLook::ghosted
         : look == TissueLook::ghosted ? TissueLook::hidden
                                       : TissueLook::shown;
}

}  // namespace trephine
