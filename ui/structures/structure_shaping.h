// Tools that need no place, or one click: what makes a structure of the whole scan, and what mends
// the current one. Each is a step of the editor's, works in the background where that takes over a
// second, and says what came of it.
#pragma once

#include "ui/structures/structure_editor.h"

namespace trephine {

// Skull and skin, as structures of those names; what had these names is replaced.
void makeSkull(StructureEditor& editor);
void makeSkin(StructureEditor& editor, double thickness_mm);
// The outermost layer of the current one becomes a structure of that name.
void makeShell(StructureEditor& editor, double thickness_mm, const QString& name);
void fillHoles(StructureEditor& editor);
void smooth(StructureEditor& editor, double radius_mm);
void keepPieceAt(StructureEditor& editor, const Vec3& patient_mm);

}  // namespace trephine
