// Tissues and structures in the 3-D view: whose look is shown, and what is seen of them while a
// threshold is moved.
#pragma once

#include <QObject>
#include <QTimer>
#include <optional>
#include <string>
#include <vector>

#include "exercise/structure_view.h"
#include "ui/structures/structure_panel.h"
#include "ui/tissue/tissue_panel.h"
#include "ui/views/four_up.h"
#include "ui/work/workstation.h"

namespace trephine {

class TissuePicture : public QObject {
  Q_OBJECT
 public:
  TissuePicture(Workstation& workstation, FourUp& views, TissuePanel& tissues,
                StructurePanel& structures, StructureEditor& editor, QObject* parent);

  void show();
  // Once the window has shown what is quicker: slices and histogram.
  void showSoon() { later_.start(); }
  // Looks that a person gives to structures, by label. Of the view alone; kept while the case is.
  void setLook(int label, TissueLook look);
  void setOpacity(int label, double per_mm);
  void setColour(int label, const Vec3& colour);
  void forgetLooks() { structure_looks_.clear(); }
  // An opacity or colour that is now set for a tissue goes before one that was set for its
  // structure.
  void yieldTo(const TissueSet& wanted);
  // The tissue whose threshold is being moved is seen alone, the others as ghosts; empty: none is.
  void followThreshold(std::optional<std::string> tissue);

 private:
  void showMoving(const std::vector<Structure>& rows, const TissueLooks& looks);

  Workstation& workstation_;
  FourUp* views_;
  ViewWidget* view_;
  TissuePanel& tissues_;
  StructurePanel& structures_;
  StructureEditor& editor_;
  QTimer later_;
  StructureLooks structure_looks_;
  std::optional<std::string> moving_;
  std::optional<SeenTissues> seen_;  // what the view was told last
};

}  // namespace trephine
