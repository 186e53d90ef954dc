// Where the case comes from: a folder or file of CT, another series of it, or a built-in case;
// which one is open; how far opening is.
#pragma once

#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QWidget>

#include "session/case.h"

namespace trephine {

class CasesPage : public QWidget {
  Q_OBJECT
 public:
  explicit CasesPage(QWidget* parent = nullptr);

  void showCase(const QString& what);
  // A folder is at hand, so that another series of it can be used.
  void setSeriesAtHand(bool at_hand);
  void showProgress(double fraction, const QString& step);
  void endProgress();
  // While an exercise runs no other case can be opened.
  void setOpeningAllowed(bool allowed);

 signals:
  void folderWanted();
  void phantomWanted(const QString& name);
  void seriesWanted();
  void cancelWanted();

 private:
  void showButtons();

  bool at_hand_ = false, allowed_ = true, busy_ = false;
  QPushButton *folder_, *series_, *cranium_, *abdomen_, *cancel_;
  QLabel *case_, *step_;
  QProgressBar* progress_;
  QWidget* progress_box_;
};

// What a case is and shows, in a few lines.
QString caseWords(const Case& of);

}  // namespace trephine
