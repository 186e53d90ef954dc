#include <QPainter>
#include <utility>

#include "ui/views/slice_tools.h"
#include "ui/views/slice_view.h"

namespace trephine {

namespace {

void drawRuler(QPainter& painter) {
  painter.drawLine(QPointF(2.5, 15.5), QPointF(15.5, 2.5));
  for (double at : {4.0, 7.5, 11.0, 14.5}) {
    painter.drawLine(QPointF(at, 18.0 - at), QPointF(at + 2.2, 20.2 - at));
  }
}

void drawAngle(QPainter& painter) {
  painter.drawPolyline(QPolygonF({{14.0, 3.0}, {3.0, 15.0}, {16.0, 15.0}}));
  painter.drawArc(QRectF(-4, 8, 14, 14), 0, 47 * 16);
}

// What is complete is the slice's.
class MeasureTool : public ViewTool {
 public:
  MeasureTool(Measure::Kind kind, Facts facts, QObject* parent)
      : ViewTool(std::move(facts), parent), kind_(kind) {}
  bool takesDoubleClicks() const override { return kind_ == Measure::Kind::angle; }

  void press(const ToolEvent& event) override {
    // Twice at one place is no ruler.
    const bool again = drawing_ && slice_ == event.slice && isClick(pressed_, event.in_widget);
    pressed_ = event.in_widget;
    if (again && kind_ == Measure::Kind::ruler) return drawing_.reset();
    addPoint(event);
  }
  void move(const ToolEvent& event) override { hover(event); }
  void hover(const ToolEvent& event) override {
    if (drawing_ && event.slice == slice_) drawing_->points_mm.back() = event.at_mm;
  }
  // A ruler by a drag, or by two clicks.
  void release(const ToolEvent& event) override {
    if (kind_ != Measure::Kind::ruler || !drawing_) return;
    if (!isClick(pressed_, event.in_widget)) addPoint(event);
  }
  bool key(int key, const Vec3*) override {
    return (key == Qt::Key_Delete || key == Qt::Key_Backspace) && giveUp();
  }
  bool giveUp() override { return std::exchange(drawing_, {}).has_value(); }
  void paint(QPainter& painter, const SliceView& on) const override {
    if (drawing_ && &on == slice_) paintMeasure(painter, on.shown(), *drawing_);
  }

 private:
  void addPoint(const ToolEvent& event) {
    if (std::exchange(slice_, event.slice) != event.slice || !drawing_) {
      drawing_ = Measure{kind_, {event.at_mm}};
    }
    drawing_->points_mm.back() = event.at_mm;
    if (drawing_->complete()) {
      event.slice->addMeasure(*std::exchange(drawing_, {}));
    } else {
      drawing_->points_mm.push_back(event.at_mm);
    }
  }

  Measure::Kind kind_;
  std::optional<Measure> drawing_;  // its last point follows the pointer
  const SliceView* slice_ = nullptr;
  QPointF pressed_;
};

}  // namespace

ViewTool* measureTool(Measure::Kind kind, QObject* parent) {
  if (kind == Measure::Kind::ruler) {
    const QString tip = ViewTool::tr(
        "Ruler: drag from end to end, or click both ends (M; Del removes the one at the pointer)");
    return new MeasureTool(kind, {"sliceRulerTool", Qt::Key_M, {}, tip, {}, drawRuler}, parent);
  }
  const QString tip = ViewTool::tr(
      "Angle: click an end, the corner, the other end (N; Del removes the one at the pointer)");
  return new MeasureTool(kind, {"sliceAngleTool", Qt::Key_N, {}, tip, {}, drawAngle}, parent);
}

}  // namespace trephine
