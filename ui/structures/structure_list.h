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

  // How the 3-D view shows them.
  void showLooks(const std::vector<SeenStructure>& seen);
  void nextLook() { nextLook(editor_.current()); }  // shown, ghosted, hidden

 signals:
  void lookWanted(int label, trephine::TissueLook look);
  void opacityWanted(int label, double per_mm);
  void colourChosen(int label, const trephine::Vec3& colour);
  void refused(const QString& words);  // a name

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
  StructureLookRow* look_;
  QLabel *no_room_, *empty_;
  QStackedLayout* listing_;  // the list, or why there is none
  std::vector<SeenStructure> seen_;
  bool filling_ = false;
};

}  // namespace trephine
