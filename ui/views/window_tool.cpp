#include <QPainter>

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
    const QPointF moved = event.in_widget - pressed_;
    if (moved.isNull()) return;
    emit event.slice->windowChosen(draggedWindow(before_, moved.x(), moved.y()));
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
