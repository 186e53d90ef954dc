#include <optional>
#include <utility>

#include "ui/common/colours.h"
#include "ui/structures/structure_tool.h"
#include "ui/views/slice_view.h"

namespace trephine {

namespace {

class GrowTool : public StructureTool {
 public:
  GrowTool(Facts facts, StructureEditor& editor, StructurePanel& panel)
      : StructureTool(std::move(facts), editor, panel) {
    connect(&editor_, &StructureEditor::boxChanged, this, &ViewTool::changed);
  }

  void press(const ToolEvent& event) override {
    if (!event.slice) return grow(event.inside_mm);
    if (event.in_picture) pressed_ = event;
  }
  void release(const ToolEvent& event) override {
    const std::optional<ToolEvent> from = std::exchange(pressed_, {});
    if (!from) return;
    if (isClick(from->in_widget, event.in_widget)) return grow(from->at_mm);
    editor_.limitTo(from->at_mm, event.at_mm, event.across);
  }
  bool giveUp() override { return std::exchange(pressed_, {}).has_value(); }

  // The box, dotted in slices outside of it, and the one that is being drawn.
  void paint(QPainter& painter, const SliceView& on) const override {
    const auto draw = [&](const QRectF& sides, Qt::PenStyle style) {
      drawRimmed(painter, QPen(colours::kOnPicture, 1.2, style), 1.8,
                 [&] { painter.drawRect(sides.normalized()); });
    };
    const std::optional<QPointF>& pointer = on.pointer();
    if (pressed_ && pressed_->slice == &on && pointer && !isClick(pressed_->in_widget, *pointer)) {
      draw(QRectF(pressed_->in_widget, *pointer), Qt::DashLine);
    }
    const std::optional<VoxelBox>& box = editor_.box();
    if (!box) return;
    const GridGeometry& grid = on.grid();
    const Vec3 low = Vec3(box->low[0], box->low[1], box->low[2]) - 0.5;
    const Vec3 high = Vec3(box->high[0], box->high[1], box->high[2]) - 0.5;
    const int axis = on.gridAxis();
    const double here = toVoxel(grid, on.stack().toPatient_mm(Vec3(0.0, 0.0, on.slice())))[axis];
    draw(QRectF(on.fromPatient(grid.toPatient_mm(low)), on.fromPatient(grid.toPatient_mm(high))),
         here >= low[axis] && here <= high[axis] ? Qt::DashLine : Qt::DotLine);
  }

 private:
  void grow(const Vec3& at_mm) { editor_.growAt(at_mm, panel_.name(), panel_.growing()); }

  std::optional<ToolEvent> pressed_;
};

}  // namespace

ViewTool* growTool(StructureEditor& editor, StructurePanel& panel) {
  return new GrowTool(
      {"structureGrow", Qt::Key_G, ViewTool::tr("Grow"),
       ViewTool::tr("Click into an organ: what hangs together with it is taken. Drag a box that it "
                    "keeps to (G)"),
       ViewTool::tr("Click into the organ, well inside. Drag a box first where it runs on.")},
      editor, panel);
}

}  // namespace trephine
