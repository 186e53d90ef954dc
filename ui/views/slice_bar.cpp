#include "ui/views/slice_bar.h"

#include <QCoreApplication>
#include <QHBoxLayout>
#include <QPainter>
#include <QSignalBlocker>
#include <QStandardItemModel>
#include <QToolButton>
#include <cmath>

#include "ui/common/colours.h"

namespace trephine {

namespace {

constexpr int kSymbol = 18;

// Outlines as those of the tool bar.
QIcon toolIcon(SliceTool tool) {
  QPixmap pixmap(kSymbol * 2, kSymbol * 2);
  pixmap.setDevicePixelRatio(2.0);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(colours::kText, 1.6, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  switch (tool) {
    case SliceTool::window:  // half dark, half bright
      painter.drawEllipse(QPointF(9, 9), 6.5, 6.5);
      painter.setBrush(colours::kText);
      painter.drawChord(QRectF(2.5, 2.5, 13, 13), 90 * 16, -180 * 16);
      break;
    case SliceTool::point:
      painter.drawLine(QPointF(9, 2), QPointF(9, 16));
      painter.drawLine(QPointF(2, 9), QPointF(16, 9));
      painter.drawEllipse(QPointF(9, 9), 3.0, 3.0);
      break;
    case SliceTool::ruler:
      painter.drawLine(QPointF(2.5, 15.5), QPointF(15.5, 2.5));
      for (double at : {4.0, 7.5, 11.0, 14.5}) {
        painter.drawLine(QPointF(at, 18.0 - at), QPointF(at + 2.2, 20.2 - at));
      }
      break;
    case SliceTool::angle:
      painter.drawPolyline(QPolygonF({{14.0, 3.0}, {3.0, 15.0}, {16.0, 15.0}}));
      painter.drawArc(QRectF(-4, 8, 14, 14), 0, 47 * 16);
      break;
    case SliceTool::entry:  // an arrow into a surface
      painter.drawArc(QRectF(-1.0, 10.0, 20.0, 20.0), 30 * 16, 120 * 16);
      painter.drawLine(QPointF(9, 1.5), QPointF(9, 9));
      painter.drawPolyline(QPolygonF({{6.0, 6.0}, {9.0, 9.5}, {12.0, 6.0}}));
      break;
    default:  // of structures: in their panel
      break;
  }
  return pixmap;
}

}  // namespace

SliceBar::SliceBar(QWidget* parent) : QWidget(parent) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(4, 3, 4, 3);
  layout->setSpacing(3);
  tools_ = new QButtonGroup(this);
  const auto tool = [&](SliceTool of, const char* name, const QString& tip) {
    auto* button = new QToolButton(this);
    button->setObjectName(name);
    button->setIcon(toolIcon(of));
    button->setIconSize({kSymbol, kSymbol});
    button->setToolTip(tip);
    button->setAccessibleName(tip);
    button->setCheckable(true);
    button->setFocusPolicy(Qt::TabFocus);
    tools_->addButton(button, int(of));
    layout->addWidget(button);
  };
  tool(SliceTool::window, "sliceWindowTool",
       tr("Window by dragging: right is wider, up is brighter (W)"));
  tool(SliceTool::point, "slicePointTool",
       tr("Point that all slices share: click or drag (X; with any tool Shift and drag)"));
  tool(SliceTool::ruler, "sliceRulerTool", tr("Ruler: drag from end to end (M; Del removes it)"));
  tool(SliceTool::angle, "sliceAngleTool",
       tr("Angle: click an end, the corner, the other end (N; Del removes it)"));
  tool(SliceTool::entry, "sliceEntryTool",
       tr("Where the exercise enters: click, and drag to where the instrument comes from (I)"));

  const auto list = [&](const char* name, const QString& tip) {
    auto* box = new QComboBox(this);
    box->setObjectName(name);
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
  windows_->setPlaceholderText(tr("own"));
  overlays_ = list("sliceOverlay", tr("What is coloured over the slices (O)"));
  overlays_->addItems({tr("Plain"), tr("Tissues"), tr("Structures")});
  opacity_ = new QSlider(Qt::Horizontal, this);
  opacity_->setObjectName("sliceOpacity");
  opacity_->setRange(0, 100);
  opacity_->setPageStep(10);
  opacity_->setMinimumWidth(36);
  opacity_->setMaximumWidth(120);
  opacity_->setToolTip(tr("How much the colours cover"));
  opacity_->setAccessibleName(opacity_->toolTip());
  layout->addWidget(opacity_, 1);
  layout->addStretch(1);

  connect(tools_, &QButtonGroup::idClicked, this,
          [this](int id) { emit toolChosen(SliceTool(id)); });
  connect(windows_, &QComboBox::activated, this,
          [this](int i) { emit windowChosen(kWindowPresets[std::size_t(i)].window); });
  const auto overlay = [this] {
    emit overlayChosen(Overlay(overlays_->currentIndex()), opacity_->value() / 100.0);
  };
  connect(overlays_, &QComboBox::activated, this, overlay);
  connect(opacity_, &QSlider::valueChanged, this, overlay);
}

void SliceBar::showTool(SliceTool tool) {
  // Those for structures are in their panel: then none here is down.
  tools_->setExclusive(false);
  for (QAbstractButton* button : tools_->buttons()) {
    button->setChecked(tools_->id(button) == int(tool));
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
