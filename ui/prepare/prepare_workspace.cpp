#include "ui/prepare/prepare_workspace.h"

#include "ui/common/placing.h"

namespace trephine {

PrepareWorkspace::PrepareWorkspace(Bench& bench)
    : Workspace(&bench),
      bench_(bench),
      workstation_(bench.workstation()),
      views_(&bench.views()),
      view_(&bench.view()) {
  tissues_ = new TissuePanel;
  structures_ = new StructurePanel(editor_);
  tabs_ = new QTabWidget;
  tabs_->setObjectName("prepareTabs");
  tabs_->setDocumentMode(true);
  tabs_->insertTab(kTissueTab, scrolled(tissues_, "tissuePage"), tr("Tissues"));
  tabs_->insertTab(kStructureTab, scrolled(structures_, "structurePage"), tr("Structures"));
  tabs_->setMinimumWidth(275);
  connectTissues();
  connectStructures();
  connectExports();
  showUndo();
}

Workspace::Parts PrepareWorkspace::parts() {
  Parts parts;
  parts.left = tabs_;
  return parts;
}

void PrepareWorkspace::enter() {
  here_ = true;
  showStructureTab();
  (void)offerMissing();
}

void PrepareWorkspace::leave() {
  here_ = false;
  showStructureTab();
}

}  // namespace trephine
