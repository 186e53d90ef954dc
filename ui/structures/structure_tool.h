// The tools for structures. They work in every view, with the settings of the panel, and Esc takes
// away what was grown before it puts them down.
#pragma once

#include "ui/structures/structure_panel.h"
#include "ui/views/view_tool.h"

namespace trephine {

class StructureTool : public ViewTool {
 public:
  // The editor outlives it. The panel deletes it as its QObject child, when the panel's own members
  // are gone: no destructor uses `panel_`.
  StructureTool(Facts facts, StructureEditor& editor, StructurePanel& panel)
      : ViewTool(std::move(facts), &panel), editor_(editor), panel_(panel) {}

  bool worksIn3D() const override { return true; }
  bool key(int key, const Vec3*) override {
    if (key != Qt::Key_Escape || !editor_.preview()) return false;
    editor_.leavePreview();
    return true;
  }

 protected:
  StructureEditor& editor_;
  StructurePanel& panel_;
};

// Grows a structure from a click; a drag in a slice draws the box that growing keeps to.
ViewTool* growTool(StructureEditor& editor, StructurePanel& panel);
// Strokes over a slice, or over what is seen in 3-D.
enum class Stroke { brush, eraser, wall };
ViewTool* brushTool(Stroke stroke, StructureEditor& editor, StructurePanel& panel);
// Keeps the piece of the chosen structure that is clicked.
ViewTool* pieceTool(StructureEditor& editor, StructurePanel& panel);

}  // namespace trephine
