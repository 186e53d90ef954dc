// The case in the views, with what exercises cut there, and the ways of both to files. Errors
// become dialogs. Window's thread.
#pragma once

#include <QMainWindow>

#include "ui/views/four_up.h"
#include "ui/work/work_guards.h"

namespace trephine {

class CaseViews : public QObject {
  Q_OBJECT
 public:
  // Guards the cuts, where no recording has them or a person wanted them as a volume, and what was
  // measured in the slices.
  CaseViews(QMainWindow& window, Workstation& workstation, Messages& messages, WorkGuards& guards);

  FourUp& views() { return *views_; }
  ViewWidget& view() { return views_->threeD(); }
  // The views show what an exercise cuts or has cut; and some of it is in no file.
  bool carved() const { return carved_; }
  bool cutsUnsaved() const { return cuts_unsaved_; }
  void exerciseBegan();
  // `recorded`: its recording has what was cut.
  void exerciseEnded(bool anything_cut, bool recorded);
  void showWholeCase();
  // As the exercise looks, or at all of the patient; the slices through what it is about.
  void lookAtCase();
  // As the exercise looks, the slices through where it does; nothing where it has no view.
  void lookAtEntry();
  void lookAtAll();
  // As a PNG; the voxels as they are now.
  void savePicture(const QString& file);
  void saveVolume(const QString& file, WorkGuards::Next then = {});
  void askToSavePicture();
  void askToSaveVolume(WorkGuards::Next then);
  void wantVolume();  // a person asks for it

 signals:
  void caseShown();    // another one, or another exercise on it, in the views
  void cutsChanged();  // carved(), cutsUnsaved()

 private:
  void showCase();
  void unlessCutsAreLost(WorkGuards::Next go_on);
  void unlessMeasuresAreLost(WorkGuards::Next go_on);
  void setCuts(bool carved, bool unsaved);

  QMainWindow& window_;
  Workstation& workstation_;
  Messages& messages_;
  WorkGuards& guards_;
  FourUp* views_;
  bool carved_ = false, cuts_unsaved_ = false;
  bool recorded_ = false;       // the cuts, by the exercise that made them
  bool volume_wanted_ = false;  // of what was cut
  QStringList noted_;           // measures, in a file
};

}  // namespace trephine
