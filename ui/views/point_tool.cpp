#include <QPainter>

#include "ui/views/slice_tools.h"
#include "ui/views/slice_view.h"

namespace trephine {

namespace {

class PointTool : public ViewTool {
 public:
  using ViewTool::ViewTool;
  void press(const ToolEvent& event) override { move(event); }
  void move(const ToolEvent& event) override {
    emit event.slice->pointChosen(event.slice->nearestInSlice_mm(event.at_mm));
  }
};

}  // namespace

ViewTool* pointTool(QObject* parent) {
  const auto symbol = [](QPainter& painter) {
    painter.drawLine(QPointF(9, 2), QPointF(9, 16));
    painter.drawLine(QPointF(2, 9), QPointF(16, 9));
    painter.drawEllipse(QPointF(9, 9), 3.0, 3.0);
  };
  return new PointTool(
      {"slicePointTool",
       Qt::Key_X,
       {},
       ViewTool::tr("Point that all slices share: click or drag (X; with any tool Shift and drag)"),
       {},
       symbol},
      parent);
}

}  // namespace trephine
