#include <algorithm>

#include "ui/common/colours.h"
#include "ui/structures/structure_tool.h"
#include "ui/views/slice_view.h"

namespace trephine {

namespace {

class BrushTool : public StructureTool {
 public:
  BrushTool(Stroke stroke, Facts facts, StructureEditor& editor, StructurePanel& panel)
      : StructureTool(std::move(facts), editor, panel), stroke_(stroke) {
    connect(&panel_, &StructurePanel::brushChanged, this, &ViewTool::changed);
  }
  double ring_mm() const override { return panel_.brushRadius_mm(); }

  void press(const ToolEvent& event) override {
    last_mm_ = event.at_mm;
    const Brush brush = panel_.brush(stroke_ == Stroke::eraser, event.across);
    if (stroke_ == Stroke::wall) return editor_.beginWall(event.at_mm, brush);
    editor_.beginStroke(event.at_mm, brush, panel_.name());
  }
  // What is beside an edge may lie far behind it: there another stroke begins, or a bar would run
  // through the air.
  void move(const ToolEvent& event) override {
    if (glm::distance(event.at_mm, last_mm_) > 3.0 * event.moved_mm + ring_mm()) {
      if (stroke_ == Stroke::wall) return;  // its end grows the preview anew
      editor_.endStroke();
      return press(event);
    }
    last_mm_ = event.at_mm;
    editor_.moveStroke(event.at_mm);
  }
  void release(const ToolEvent&) override { editor_.endStroke(); }

  // As large as what it takes.
  void paint(QPainter& painter, const SliceView& on) const override {
    if (!on.pointer()) return;
    const double pixels = std::max(1.5, ring_mm() * on.pixelsPerMm());
    const QColor colour = stroke_ == Stroke::eraser ? colours::kCaution : colours::kOnPicture;
    drawRimmed(painter, {colour, 1.2}, 1.8,
               [&] { painter.drawEllipse(*on.pointer(), pixels, pixels); });
  }

 private:
  Stroke stroke_;
  Vec3 last_mm_{0.0};
};

ViewTool::Facts factsOf(Stroke stroke) {
  const QString hint =
      ViewTool::tr("Drag in a slice or over what is seen in 3-D; [ and ] change the size.");
  switch (stroke) {
    case Stroke::brush:
      return {"structureBrush", Qt::Key_B, ViewTool::tr("Brush"),
              ViewTool::tr("Paint the chosen structure (B)"), hint};
    case Stroke::eraser:
      return {"structureEraser", Qt::Key_E, ViewTool::tr("Eraser"),
              ViewTool::tr("Take away from the chosen one (E)"), hint};
    case Stroke::wall:
      break;
  }
  return {"structureWall", Qt::Key_L, ViewTool::tr("Wall"),
          ViewTool::tr("Paint where growing stops; it is in no exercise and no file (L)"),
          ViewTool::tr("Paint where growing has to stop, then grow again (G).")};
}

}  // namespace

ViewTool* brushTool(Stroke stroke, StructureEditor& editor, StructurePanel& panel) {
  return new BrushTool(stroke, factsOf(stroke), editor, panel);
}

}  // namespace trephine
