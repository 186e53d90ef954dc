#include "ui/tissue/tissue_list.h"

#include <QGridLayout>
#include <QHBoxLayout>
#include <QPainter>
#include <QPainterPath>
#include <QVBoxLayout>
#include <algorithm>
#include <iterator>

#include "ui/common/colours.h"
#include "ui/common/making.h"
#include "ui/common/setting_words.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

struct PresetButton {
  ViewPreset preset;
  const char *name, *words;
};
constexpr PresetButton kPresetButtons[] = {
    {ViewPreset::bone, "presetBone", QT_TRANSLATE_NOOP("trephine::TissueList", "Bone")},
    {ViewPreset::skin, "presetSkin", QT_TRANSLATE_NOOP("trephine::TissueList", "Skin")},
    {ViewPreset::soft_tissue, "presetSoftTissue",
     QT_TRANSLATE_NOOP("trephine::TissueList", "Soft tissue")},
    {ViewPreset::liver, "presetLiver", QT_TRANSLATE_NOOP("trephine::TissueList", "Liver")},
};
static_assert(std::size(kPresetButtons) == kViewPresets.size());

}  // namespace

QIcon tissueSwatch(const QColor& colour, double share) {
  QPixmap pixmap(32, 32);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF square(4, 4, 24, 24);
  QPainterPath frame;
  frame.addRoundedRect(square, 6, 6);
  painter.save();
  painter.setClipPath(frame);
  QRectF filled = square;
  filled.setTop(square.bottom() - std::clamp(share, 0.0, 1.0) * square.height());
  painter.fillRect(filled, colour);
  painter.restore();
  painter.setPen(QPen(colour, 3));
  painter.drawPath(frame);
  QIcon icon(pixmap);
  icon.addPixmap(pixmap, QIcon::Selected);  // a colour must not change by being chosen
  return icon;
}

TissueList::TissueList(QWidget* parent) : QWidget(parent) {
  list_ = new QListWidget(this);
  list_->setObjectName("tissueList");
  list_->setAccessibleName(tr("Tissues"));
  list_->setIconSize({16, 16});
  list_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list_->setSpacing(1);
  add_ = settingButton("addTissue", tr("Add a tissue"), tr("One more, in HU that have none"), this);
  remove_ = settingButton("removeTissue", tr("Remove it"),
                          tr("The chosen tissue goes from the set"), this);
  auto* below = new QHBoxLayout;
  below->addWidget(add_);
  below->addWidget(remove_);
  below->addStretch(1);
  auto* layout = tight(new QVBoxLayout(this));
  layout->addLayout(buildPresets());
  layout->addWidget(list_);
  layout->addLayout(below);
  connect(list_, &QListWidget::currentRowChanged, this, [this] {
    if (!listing_) emit chosen();
  });
  connect(add_, &QToolButton::clicked, this, &TissueList::addWanted);
  connect(remove_, &QToolButton::clicked, this, &TissueList::removeWanted);
}

QLayout* TissueList::buildPresets() {
  auto* grid = new QGridLayout;  // two beside each other: the column is narrow
  grid->setSpacing(4);
  presets_title_ = new QLabel(tr("View"), this);
  grid->addWidget(presets_title_, 0, 0);
  for (const auto& [preset, name, words] : kPresetButtons) {
    auto* button = settingButton(
        name, tr(words), tr("A start for the choices below; what is felt and cut stays as it is"),
        this);
    button->setAccessibleName(tr("View preset: %1").arg(button->text()));
    button->setFocusPolicy(Qt::StrongFocus);
    button->hide();
    connect(button, &QToolButton::clicked, this, [this, preset = preset] {
      if (const auto looks = presetLooks(tissues_, preset)) lookChosen(*looks);
    });
    const int place = int(presets_.size());
    grid->addWidget(button, place / 2, 1 + place % 2);
    presets_.emplace_back(preset, button);
  }
  grid->setColumnStretch(3, 1);
  return grid;
}

void TissueList::show(const TissueSet& tissues, const TissueLooks& looks) {
  tissues_ = tissues;
  looks_ = looks;
  if (shares_.voxels.size() != tissues_.tissues.size()) shares_ = {};
  showItems();
}

void TissueList::setShares(const TissueShares& shares) {
  shares_ = shares;
  if (shares_.voxels.size() != tissues_.tissues.size()) shares_ = {};
  for (int i = 0; i < list_->count(); ++i) list_->item(i)->setText(wordsOf(std::size_t(i)));
}

void TissueList::setLocked(bool locked) {
  add_->setEnabled(!locked);
  remove_->setEnabled(!locked);
}

void TissueList::lookChosen(const TissueLooks& looks) {
  if (looks == looks_) return;
  looks_ = looks;
  showItems();
  emit looksChosen(looks_);
}

// A row of the list with its choice of looks.
void TissueList::addItem() {
  list_->addItem(QString());
  auto* beside = new QWidget;
  auto* layout = tight(new QHBoxLayout(beside));
  layout->addStretch(1);
  auto* box = new LookBox(beside);
  box->setIconAlone();
  layout->addWidget(box);
  const int row = list_->count() - 1;
  box->chosen = [this, row](TissueLook look) {
    TissueLooks looks = looks_;
    looks[tissues_.tissues[std::size_t(row)].id] = look;
    lookChosen(looks);
  };
  const int height = std::max(beside->sizeHint().height(), 2 * fontMetrics().height() + 4);
  list_->item(row)->setSizeHint({0, height});
  list_->setItemWidget(list_->item(row), beside);
  setTabOrder(look_boxes_.empty() ? static_cast<QWidget*>(list_) : look_boxes_.back(), box);
  look_boxes_.push_back(box);
}

// "Bone", and below it "226 to 3071 · 0.90 · 12.3 %".
QString TissueList::wordsOf(std::size_t row) const {
  const Tissue& tissue = tissues_.tissues[row];
  QString words = shownName(tissue.name) + '\n' +
                  tr("%1 to %2 HU").arg(tissue.hu_min).arg(tissue.hu_max);
  if (row < shares_.voxels.size()) {
    const double ml = shares_.millilitres(row);
    words += tr(" \u00b7 %1 mL").arg(ml, 0, 'f', ml < 10.0 ? 1 : 0);
  }
  return words;
}

void TissueList::showItems() {
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
    item.setText(wordsOf(std::size_t(i)));
    const TissueLook look = lookOf(tissue, looks_);
    look_boxes_[std::size_t(i)]->show(tissue, look);
    // As finely as the slider: where tissues are nearly clear.
    const double share = look == TissueLook::hidden ? 0.0 : sliderAtOpacity(tissue.opacity);
    item.setIcon(tissueSwatch(colours::of(tissue.colour), share));
    const QString where =
        !tissue.structure.empty() ? tr(", in %1").arg(shownName(tissue.structure))
        : tissue.label            ? tr(", label %1").arg(*tissue.label)
                                  : QString();
    item.setToolTip(tr("%1 to %2 HU%3, opacity %4 per mm%5")
                        .arg(tissue.hu_min)
                        .arg(tissue.hu_max)
                        .arg(where)
                        .arg(tissue.opacity, 0, 'g', 3)
                        .arg(look == TissueLook::hidden ? tr(", not drawn") : QString()));
  }
  list_->setCurrentRow(std::min(row, list_->count() - 1));
  constexpr int kMostRows = 8;
  int height = 2 * list_->frameWidth() + 2;
  for (int i = 0; i < std::min(list_->count(), kMostRows); ++i) {
    height += list_->item(i)->sizeHint().height() + 2 * list_->spacing();
  }
  list_->setFixedHeight(height);
  listing_ = false;
}

}  // namespace trephine
