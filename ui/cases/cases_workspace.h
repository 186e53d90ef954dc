// Cases: what there is to practise on, and how it gets here: the library's page and the page of the
// importer, and all that is asked on the way. Between these, the import task and the workstation.
#pragma once

#include <QStackedWidget>

#include "ui/cases/cases_page.h"
#include "ui/cases/import_page.h"
#include "ui/work/bench.h"

namespace trephine {

class CasesWorkspace : public Workspace {
  Q_OBJECT
 public:
  explicit CasesWorkspace(Bench& bench);

  QString title() const override { return tr("Cases"); }
  Symbol symbol() const override { return Symbol::cases; }
  Parts parts() override;

  // A folder or file of CT, or a scene, which asks first where it takes what is not saved.
  void open(const std::filesystem::path& path);
  bool mayOpen() const { return open_->isEnabled(); }
  QList<QAction*> openActions() const { return {open_, open_file_, open_scene_}; }
  // Of the folder that was scanned last: PDF or HTML.
  void saveReport(const QString& file);

 private:
  void connectParts();
  void askForFolder();
  void askForFile();
  void askForScene();
  void openPhantom(const std::string& name);
  void caseRead(const Case& read, const std::filesystem::path& labels);
  void showCase();
  void showPhase();

  Bench& bench_;
  Workstation& workstation_;
  QAction *open_, *open_file_, *open_scene_;
  QStackedWidget* pages_;
  CasesPage* page_;
  ImportPage* import_;
  bool train_wanted_ = false;  // once the case that opens is there
};

}  // namespace trephine
