#include "ui/structures/structure_shaping.h"
#include "ui/structures/structure_tool.h"

namespace trephine {

namespace {

class PieceTool : public StructureTool {
 public:
  using StructureTool::StructureTool;
  void press(const ToolEvent& event) override {
    if (event.in_picture) keepPieceAt(editor_, event.at_mm);
  }
};

}  // namespace

ViewTool* pieceTool(StructureEditor& editor, StructurePanel& panel) {
  return new PieceTool({"structurePiece", Qt::Key_P, ViewTool::tr("Keep piece"),
                        ViewTool::tr("Click the piece that stays; the rest of the chosen one goes "
                                     "(P)"),
                        ViewTool::tr("Click the piece that stays.")},
                       editor, panel);
}

}  // namespace trephine
