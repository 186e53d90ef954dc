#include <QPainter>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"
#include "ui/views/slice_tools.h"
#include "ui/views/slice_view.h"

namespace trephine {

namespace {

class WindowTool : public ViewTool {
 public:
  using ViewTool::ViewTool;
  Qt::CursorShape cursor() const override { return Qt::ArrowCursor; }

  void press(const ToolEvent& event) override {
    pressed_ = event.in_widget;
    before_ = event.slice->window();
  }

  void move(const ToolEvent& event) override {
    constexpr double kWidthPerPixel = 0.006;        // natural logarithm
    constexpr double kLevelPerPixel = 1.0 / 300.0;  // of the width
    constexpr double kWidest_HU = 8000.0, kHighest_HU = 4000.0;
    const QPointF moved = event.in_widget - pressed_;
    if (moved.isNull()) return;
    const double width = before_.width_hu * std::exp(kWidthPerPixel * moved.x());
    const double centre = before_.centre_hu + kLevelPerPixel * moved.y() * before_.width_hu;
    emit event.slice->windowChosen({std::round(std::clamp(centre, -kHighest_HU, kHighest_HU)),
                                    std::round(std::clamp(width, 1.0, kWidest_HU))});
  }

 private:
  QPointF pressed_;
  HuWindow before_;
};

}  // namespace

ViewTool* windowTool(QObject* parent) {
  const auto symbol = [](QPainter& painter) {  // half dark, half bright
    painter.drawEllipse(QPointF(9, 9), 6.5, 6.5);
    painter.setBrush(colours::kText);
    painter.drawChord(QRectF(2.5, 2.5, 13, 13), 90 * 16, -180 * 16);
  };
  return new WindowTool({"sliceWindowTool",
                         Qt::Key_W,
                         {},
                         ViewTool::tr("Window by dragging: right is wider, up is brighter (W)"),
                         {},
                         symbol},
                        parent);
}

}  // namespace trephine
