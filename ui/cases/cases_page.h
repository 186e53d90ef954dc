// What there is to practise on, as cards; the chosen one at length, with what can be done with it;
// and on top the next step. It shows what it is given and says what is wanted.
#pragma once

#include <QFrame>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QToolButton>
#include <QWidget>
#include <optional>
#include <vector>

#include "training/recording_list.h"
#include "ui/cases/case_entry.h"

namespace trephine {

class CasesPage : public QWidget {
  Q_OBJECT
 public:
  explicit CasesPage(QWidget* parent = nullptr);

  void showCases(const std::vector<CaseEntry>& entries);
  // What was done on them, the newest first; not `all` of it while it is still being read.
  void showRecordings(std::vector<ListedRecording> rows, bool all);
  // None of it could be read.
  void showNoRecordings(const QString& why);
  std::vector<ListedRecording> exercisesOn(const CaseEntry& entry) const;
  bool allRecordingsRead() const { return all_recordings_; }
  void select(const std::string& id);
  void selectOnceThere(const std::string& id) { to_select_ = id; }  // with the next list
  // Which is open (an id), and a few lines about it; `saved`: the library has it.
  void showOpen(const std::string& id, const QString& about, bool saved);
  // The one that was open last, by id; empty: none.
  void setRecent(const std::string& id);
  // Said in the strip of the next step until another case is opened.
  void sayInStrip(const QString& words);
  // A folder is at hand, so that another series of it can be used.
  void setSeriesAtHand(bool at_hand);
  // In a dialog, which begins with this one: renameWanted().
  void askForName(const CaseEntry& entry, const QString& name);
  // While an exercise runs, or a case is being opened, no other can be.
  void setOpeningAllowed(bool allowed);

 signals:
  void folderWanted();
  void seriesWanted();
  void trainWanted(const trephine::CaseEntry& entry);
  void prepareWanted(const trephine::CaseEntry& entry);
  void goOnWanted(bool train);  // with the open case
  void saveWanted();            // it
  void renameWanted(const trephine::CaseEntry& entry, const QString& name);
  void reportWanted(const trephine::CaseEntry& entry);
  void deleteWanted(const trephine::CaseEntry& entry);
  void exercisesWanted(const trephine::CaseEntry& entry);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  QWidget* buildStrip();
  QWidget* buildDetails();
  const CaseEntry* chosen() const;
  const CaseEntry* find(const std::string& id) const;
  void showChosen();
  void showExercises(const CaseEntry& entry);
  void showStrip();
  void takeNextStep(bool train);

  std::vector<CaseEntry> entries_;
  std::vector<ListedRecording> recordings_;
  bool all_recordings_ = false;
  QString no_recordings_;  // why there are none
  std::string open_, recent_, to_select_;
  bool open_saved_ = true, any_open_ = false;
  QString open_about_, said_;
  bool at_hand_ = false, allowed_ = true;
  QLabel *strip_title_, *strip_words_;
  QPushButton *strip_train_, *strip_prepare_, *strip_save_, *folder_, *series_;
  QListWidget* cards_;
  QWidget* details_;
  QLabel *picture_, *name_, *about_, *done_;
  QPushButton *train_, *prepare_, *rename_, *report_, *delete_, *exercises_;
};

}  // namespace trephine
