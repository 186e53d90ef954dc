#include "ui/views/slice_bar.h"

#include <QCoreApplication>
#include <QHBoxLayout>
#include <QPainter>
#include <QSignalBlocker>
#include <QStandardItemModel>
#include <QToolButton>
#include <cmath>

#include "ui/common/colours.h"
#include "ui/common/making.h"

namespace trephine {

namespace {

constexpr int kSymbol = 18;

// Outlines as those of the tool bar.
QIcon iconOf(const ViewTool& tool) {
  QPixmap pixmap(kSymbol * 2, kSymbol * 2);
  pixmap.setDevicePixelRatio(2.0);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(colours::kText, 1.6, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  tool.facts().symbol(painter);
  return pixmap;
}

}  // namespace

SliceBar::SliceBar(Toolbox& toolbox, QWidget* parent)
    : QWidget(parent), toolbox_(toolbox), row_(new QHBoxLayout), tools_(new QButtonGroup(this)) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(4, 3, 4, 3);
  layout->setSpacing(3);
  layout->addLayout(row_);
  for (ViewTool* tool : toolbox.tools()) addTool(tool);
  showTool();
  connect(&toolbox, &Toolbox::added, this, &SliceBar::addTool);
  connect(&toolbox, &Toolbox::taken, this, &SliceBar::showTool);

  const auto list = [&](const char* name, const QString& tip) {
    auto* box = named(new QComboBox(this), name);
    box->setToolTip(tip);
    box->setAccessibleName(tip);
    box->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
    box->setMinimumWidth(64);
    box->setMaximumWidth(110);
    layout->addWidget(box, 1);
    return box;
  };
  windows_ = list("sliceWindow", tr("HU window (keys 1 to 5). Only the picture changes."));
  for (std::size_t i = 0; i < kWindowPresets.size(); ++i) {
    windows_->addItem(QCoreApplication::translate("HuWindow", kWindowPresets[i].name));
    windows_->setItemData(int(i),
                          tr("Width %1 HU around %2 HU (key %3)")
                              .arg(kWindowPresets[i].window.width_hu)
                              .arg(kWindowPresets[i].window.centre_hu)
                              .arg(i + 1),
                          Qt::ToolTipRole);
  }
  windows_->setPlaceholderText(tr("Custom"));
  overlays_ = list("sliceOverlay", tr("What is coloured over the slices (O)"));
  overlays_->addItems({tr("Plain"), tr("Tissues"), tr("Structures")});
  opacity_ = named(new QSlider(Qt::Horizontal, this), "sliceOpacity");
  opacity_->setRange(0, 100);
  opacity_->setPageStep(10);
  opacity_->setMinimumWidth(36);
  opacity_->setMaximumWidth(120);
  opacity_->setToolTip(tr("How much the colours cover"));
  opacity_->setAccessibleName(opacity_->toolTip());
  layout->addWidget(opacity_, 1);
  layout->addStretch(1);

  connect(windows_, &QComboBox::activated, this,
          [this](int i) { emit windowChosen(kWindowPresets[std::size_t(i)].window); });
  const auto overlay = [this] {
    emit overlayChosen(Overlay(overlays_->currentIndex()), opacity_->value() / 100.0);
  };
  connect(overlays_, &QComboBox::activated, this, overlay);
  connect(opacity_, &QSlider::valueChanged, this, overlay);
}

void SliceBar::addTool(ViewTool* tool) {
  const ViewTool::Facts& facts = tool->facts();
  if (!facts.symbol) return;
  auto* button = named(new QToolButton(this), facts.name);
  button->setIcon(iconOf(*tool));
  button->setIconSize({kSymbol, kSymbol});
  button->setToolTip(facts.tip);
  button->setAccessibleName(facts.tip);
  button->setCheckable(true);
  button->setFocusPolicy(Qt::TabFocus);
  tools_->addButton(button);
  row_->addWidget(button);
  connect(button, &QToolButton::clicked, tool, [this, tool] { toolbox_.take(*tool); });
}

// Those that have their buttons elsewhere leave none down here.
void SliceBar::showTool() {
  tools_->setExclusive(false);
  for (QAbstractButton* button : tools_->buttons()) {
    button->setChecked(button->objectName() == toolbox_.inHand().objectName());
  }
  tools_->setExclusive(true);
}

void SliceBar::showWindow(const HuWindow& window) {
  const auto preset = std::ranges::find(kWindowPresets, window, &WindowPreset::window);
  const bool own = preset == kWindowPresets.end();
  windows_->setCurrentIndex(own ? -1 : int(preset - kWindowPresets.begin()));
}

void SliceBar::setLabelsAtHand(bool at_hand) {
  auto* items = qobject_cast<QStandardItemModel*>(overlays_->model());
  items->item(int(Overlay::labels))->setEnabled(at_hand);
}

void SliceBar::showOverlay(Overlay overlay, double opacity) {
  const QSignalBlocker quiet(opacity_);
  overlays_->setCurrentIndex(int(overlay));
  opacity_->setValue(int(std::lround(opacity * 100.0)));
  opacity_->setEnabled(overlay != Overlay::none);
}

}  // namespace trephine
