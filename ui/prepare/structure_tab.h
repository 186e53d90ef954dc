// Structures: between their panel, their editor, the slices, the case and the workstation.
#pragma once

#include <QObject>
#include <QTimer>
#include <cstdint>
#include <memory>
#include <optional>

#include "library/case_library.h"
#include "ui/prepare/entry_tool.h"
#include "ui/prepare/structure_exports.h"
#include "ui/prepare/structure_questions.h"
#include "ui/prepare/tissue_picture.h"
#include "ui/structures/structure_panel.h"
#include "ui/work/case_views.h"

namespace trephine {

class StructureTab : public QObject {
  Q_OBJECT
 public:
  StructureTab(Workstation& workstation, Messages& messages, WorkGuards& guards,
               CaseViews& case_views, std::shared_ptr<CaseLibrary> library,
               const std::filesystem::path& storage, StructurePanel& structures,
               StructureEditor& editor, TissuePicture& picture, QObject* parent);

  // `here`: its workspace is shown; `in_front`: so is its panel. The views show what the panel
  // lists while it is in front.
  void show(bool here, bool in_front);
  bool shown() const { return here_ && in_front_ && editor_.hasCase(); }
  // The structure that the exercise needs and the case lacks: with the tool that makes it. False:
  // it lacks nothing that could be made.
  bool offerMissing();
  void makeMissing();
  EntryTool& entry() { return entry_; }

  // Structures and tissues, where they have been changed, into the case of the library.
  bool isStored() const;
  bool inCase() const { return in_case_ == editor_.version(); }
  // Made, changed or read and in no place from where they come back by themselves: the case of the
  // library, or, of a case that has none, a file. What was exported is a copy.
  bool unsaved() const;
  void saveInCase(WorkGuards::Next then);
  void noteTissues(bool touched) { tissues_touched_ = touched; }
  void askForLabels();

 signals:
  void frontWanted();  // its panel
  void undoChanged();  // of the editor, or whether it is the editor's turn

 private:
  bool take();
  void beforeStart(WorkGuards::Next go_on);
  void showOpened();
  void showPlaced();
  void placingFailed();
  void showReport();
  void showLabels();
  void showViews();
  void toolTaken(ViewTool* tool);
  bool key(int key);
  void askAboutPreview(WorkGuards::Next go_on);
  void saveThen(WorkGuards::Next then);
  void unlessLost(WorkGuards::Next go_on);
  QString names() const;
  QString changedNames() const;

  Workstation& workstation_;
  Messages& messages_;
  WorkGuards& guards_;
  CaseViews& case_views_;
  std::shared_ptr<CaseLibrary> library_;
  FourUp* views_;
  Toolbox& toolbox_;
  ViewWidget* view_;
  StructurePanel& structures_;
  StructureEditor& editor_;
  TissuePicture& picture_;
  StructureExports exports_;
  StructureQuestions questions_;
  EntryTool entry_;
  std::shared_ptr<const LabelMap> own_structures_;  // of the case, as the editor gave or got them
  // What the library's case has, whatever was saved to files: the editor's version() then, nothing
  // for structures of another file; and whether tissues have been edited since.
  std::optional<std::uint64_t> in_case_ = 0;
  std::shared_ptr<const LabelMap> of_case_;  // as it was opened or saved; null: it has none
  bool tissues_touched_ = false;
  QTimer settled_;
  WorkGuards::Next start_when_placed_;  // an exercise waits for its structures
  bool here_ = false, in_front_ = false;
};

}  // namespace trephine
