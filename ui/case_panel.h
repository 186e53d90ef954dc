// Where the case comes from: open a folder, choose among its series by their verdicts, or take a
// built-in case. Shows how far opening is and lets it be cancelled.
#pragma once

#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QTreeWidget>
#include <QWidget>

#include "imaging/importer.h"

namespace trephine {

class CasePanel : public QWidget {
  Q_OBJECT
 public:
  explicit CasePanel(QWidget* parent = nullptr);

  void showReport(const ImportReport& report);
  void showChosen(const QString& uid);
  void forgetReport();  // a built-in case has none
  void showCase(const QString& what);
  void showProgress(double fraction, const QString& step);
  void endProgress();
  // While an exercise runs no other case can be opened.
  void setOpeningAllowed(bool allowed);

 signals:
  void folderWanted();
  void phantomWanted(const QString& name);
  void seriesWanted(const QString& uid);
  void cancelWanted();
  void labelsWanted();

 private:
  void showDetails();
  void showButtons();
  const SeriesReport* selected() const;

  ImportReport report_;
  QString chosen_;
  bool allowed_ = true, busy_ = false;
  QPushButton *folder_, *cranium_, *abdomen_, *labels_, *use_series_, *cancel_;
  QLabel *case_, *skipped_, *details_;
  QTreeWidget* series_;
  QProgressBar* progress_;
  QLabel* step_;
  QWidget* progress_box_;
};

}  // namespace trephine
