#include "ui/structures/structure_shaping.h"

#include <algorithm>

#include "structures/skin.h"
#include "structures/skull.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

QString nameOf(StructureEditor& editor, int label) {
  return toQt(editor.structures().find(label)->name);
}

// A mask of 0 and 1 as a structure of that name, which is made or replaced.
void putMask(StructureEditor& editor, const LabelMap& mask, const std::string& name,
             const std::string& like, const QString& more = {}) {
  const int label = editor.addStructure(name, like);
  if (label != 0) {
    const Labels over = editor.structures().overWall();
    editor.put(toQt(name), maskEdit(*editor.map(), mask.labels, label, over));
    editor.setCurrent(label);
  }
  const int made = editor.current();
  if (!editor.structures().find(made)) return;
  emit editor.said(StructureEditor::tr("%1: %2 mL.")
                       .arg(nameOf(editor, made))
                       .arg(editor.millilitres(made), 0, 'f', 0) +
                   more);
}

// A layer is a voxel thick at least.
QString wordsIfThin(const StructureEditor& editor, double thickness_mm) {
  const Vec3& mm = editor.volume()->geometry.spacing_mm;
  const double voxel_mm = std::max({mm.x, mm.y, mm.z});
  if (thickness_mm >= voxel_mm) return {};
  return ' ' + StructureEditor::tr("It is one voxel thick, which is up to %1 mm on this CT.")
                   .arg(voxel_mm, 0, 'f', 1);
}

// A preview may have been the one that is current, and it goes: that is said.
bool beginOnCurrent(StructureEditor& editor) {
  const bool any = editor.current() != 0;
  if (!editor.begin() || !any) return false;
  if (editor.current() != 0) return true;
  emit editor.said(StructureEditor::tr(
      "What was grown was not taken, and is gone. Grow it again and take it first."));
  return false;
}

// What `make` makes of the current one's map and label.
template <class Make>
void mend(StructureEditor& editor, const QString& step, Make make) {
  if (!beginOnCurrent(editor)) return;
  const int of = editor.current();
  editor.inBackground(
      [map = editor.map(), of, make](const Progress& progress) { return make(*map, of, progress); },
      [&editor, step](LabelEdit edit) { editor.put(step, std::move(edit)); });
}

}  // namespace

void makeSkull(StructureEditor& editor) {
  if (!editor.begin()) return;
  editor.inBackground(
      [volume = editor.volume()](const Progress& progress) { return skullOf(*volume, progress); },
      [&editor](const Skull& made) { putMask(editor, made.mask, "skull", "bone"); });
}

void makeSkin(StructureEditor& editor, double thickness_mm) {
  if (!editor.begin()) return;
  editor.inBackground(
      [volume = editor.volume(), thickness_mm](const Progress& progress) {
        return skinOf(*volume, thickness_mm, progress);
      },
      [&editor, thickness_mm](const Skin& made) {
        putMask(editor, made.mask, "skin", "scalp", wordsIfThin(editor, thickness_mm));
      });
}

void makeShell(StructureEditor& editor, double thickness_mm, const QString& name) {
  if (!beginOnCurrent(editor)) return;
  const int of = editor.current();
  const int into = editor.addStructure(editor.freeName(name));
  if (into == 0) return;
  editor.inBackground(
      [map = editor.map(), of, thickness_mm, into](const Progress& progress) {
        return shellEdit(*map, of, thickness_mm, into, progress);
      },
      [&editor, of, into, thickness_mm](LabelEdit edit) {
        const bool any = !edit.empty();
        editor.put(StructureEditor::tr("Shell"), std::move(edit));
        if (!any) return;
        editor.structures().noteLayer(into, of);
        emit editor.said(StructureEditor::tr("\"%1\" has %2 mL of \"%3\", which keeps %4 mL. "
                                             "Deleting it gives them back.")
                             .arg(nameOf(editor, into))
                             .arg(editor.millilitres(into), 0, 'f', 0)
                             .arg(nameOf(editor, of))
                             .arg(editor.millilitres(of), 0, 'f', 0) +
                         wordsIfThin(editor, thickness_mm));
      });
}

void fillHoles(StructureEditor& editor) {
  mend(editor, StructureEditor::tr("Fill holes"),
       [](const LabelMap& map, int of, const Progress& progress) {
         return holesEdit(map, of, std::nullopt, {}, progress);
       });
}

void smooth(StructureEditor& editor, double radius_mm) {
  mend(editor, StructureEditor::tr("Smooth"),
       [radius_mm](const LabelMap& map, int of, const Progress& progress) {
         return smoothEdit(map, of, radius_mm, {}, progress);
       });
}

void keepPieceAt(StructureEditor& editor, const Vec3& patient_mm) {
  mend(editor, StructureEditor::tr("Keep the piece"),
       [patient_mm](const LabelMap& map, int of, const Progress&) {
         return keepPieceEdit(map, of, patient_mm);
       });
}

}  // namespace trephine
