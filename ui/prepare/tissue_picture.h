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

// Window's thread. All that it is given outlives it.
class TissuePicture : public QObject {
  Q_OBJECT
 public:
  TissuePicture(Workstation& workstation, FourUp& views, TissuePanel& tissues,
                StructurePanel& structures, StructureEditor& editor, QObject* parent);

  void show();
  // Once the window has shown what is quicker: slices and histogram.
  void showSoon() { later_.start(); }
  // Looks that a person gives to structures, by label; a colour is r, g, b in [0, 1]. Of the view
  // alone. Each is shown at once. They are kept until forgetLooks(), which shows nothing: who opens
  // another case or other structures calls it.
  void setLook(int label, TissueLook look);
  void setOpacity(int label, double per_mm);
  void setColour(int label, const Vec3& colour);
  void forgetLooks() { structure_looks_.clear(); }
  // An opacity or colour that is now set for a tissue goes before one that was set for its
  // structure. It is called before the workstation takes `wanted`, and shows nothing.
  void yieldTo(const TissueSet& wanted);
  // The tissue of this id, whose threshold is being moved, is seen alone, the others as ghosts. "":
  // which one is not known yet, and all are ghosts. nullopt: none is moved any more. The next
  // show() or showSoon() shows it, the end too.
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
