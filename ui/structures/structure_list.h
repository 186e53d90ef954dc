// The structures that there are, with mL, colour and look, and what is done with one of them: it is
// chosen, renamed, given a colour, deleted, shown, ghosted or hidden in 3-D.
#pragma once

#include <QLabel>
#include <QStackedLayout>
#include <QTreeWidget>
#include <QWidget>

#include "ui/structures/structure_editor.h"
#include "ui/structures/structure_look_row.h"

namespace trephine {

class StructureList : public QWidget {
  Q_OBJECT
 public:
  // The editor outlives it.
  explicit StructureList(StructureEditor& editor, QWidget* parent = nullptr);

  // How the 3-D view shows them; it is copied. One that is not among them has no look and takes
  // none.
  void showLooks(const std::vector<SeenStructure>& seen);
  // The look after the present one (shown, ghosted, hidden) is asked for, for the structure chosen
  // in the editor; nothing where none is, or the view has no room for it.
  void nextLook() { nextLook(editor_.current()); }

 signals:
  // By a person, of a structure's label. Looks and opacities are wishes: nothing changes here until
  // showLooks().
  void lookWanted(int label, trephine::TissueLook look);
  void opacityWanted(int label, double per_mm);  // [0, 1] per mm of depth
  // Red, green, blue, 0 to 1; the editor has it already.
  void colourChosen(int label, const trephine::Vec3& colour);
  void refused(const QString& words);  // why a name was not taken, in sentences

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void buildList();
  void buildMenu();
  void showList();
  void showLooks();
  void nextLook(int label);
  std::optional<SeenStructure> seen(int label) const;
  void rename(QTreeWidgetItem* item);
  void chooseColour();

  StructureEditor& editor_;
  QTreeWidget* list_;
  QPoint pressed_at_;  // in the list
  StructureLookRow* look_;
  // What the 3-D view tells no more apart (SeenStructure::has_room); that there is none.
  QLabel *no_room_, *empty_;
  QStackedLayout* listing_;  // the list, or why there is none
  std::vector<SeenStructure> seen_;
  bool filling_ = false;
};

}  // namespace trephine
