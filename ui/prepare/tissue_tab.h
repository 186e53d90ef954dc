// Tissues: their panel, sets of them in and out, and what can be taken back. Between the panel, the
// views and the workstation.
#pragma once

#include <QAction>
#include <QObject>
#include <filesystem>
#include <utility>
#include <vector>

#include "ui/prepare/tissue_picture.h"
#include "ui/structures/structure_editor.h"
#include "ui/tissue/tissue_panel.h"
#include "ui/work/messages.h"
#include "ui/work/workstation.h"

namespace trephine {

class TissueTab : public QObject {
  Q_OBJECT
 public:
  // `storage`: a person's own sets are in a folder of it. `undo`, `redo`: the window's.
  TissueTab(Workstation& workstation, FourUp& views, Messages& messages,
            const std::filesystem::path& storage, QAction& undo, QAction& redo,
            TissuePanel& tissues, StructureEditor& editor, TissuePicture& picture, QObject* parent);

  // The exercise as it is, in the panel and the views.
  void showExercise();
  // What can be taken back, in the panel, and in the window's actions where they `serve` it.
  void showHistory(bool serve);
  // The product's, then a person's own, each by name.
  std::vector<std::pair<QString, std::filesystem::path>> setsOfWorkstation() const;

 signals:
  void edited();    // the tissues, by a person
  void setTaken();  // another set is the exercise's

 private:
  void connectSets();
  void showRenderable(ControllerKind in_force);
  void edit(const TissueSet& set, const QString& what);
  void takeSet(const TissueSet& set, const char* what);
  void newSet();
  void duplicateSet();
  void askForSet();
  void useSet(const std::filesystem::path& file);
  void askToExportSet();
  void revertSet();
  std::filesystem::path ownSets() const { return storage_ / "tissues"; }

  Workstation& workstation_;
  Messages& messages_;
  std::filesystem::path storage_;
  QAction &undo_, &redo_;
  FourUp* views_;
  TissuePanel& tissues_;
  StructureEditor& editor_;
  TissuePicture& picture_;
};

}  // namespace trephine
