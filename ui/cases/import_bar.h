// The bottom of the import page: how far it is, and how it goes on from each of its steps.
#pragma once

#include <QProgressBar>
#include <QPushButton>
#include <QWidget>

#include "ui/common/placing.h"

namespace trephine {

// Empty: nothing scanned. Asking: read, and something is to be said or asked before it opens.
enum class ImportStep { empty, scanning, choosing, reading, asking };
inline bool isWorking(ImportStep step) {
  return step == ImportStep::scanning || step == ImportStep::reading;
}

class ImportBar : public QWidget {
  Q_OBJECT
 public:
  explicit ImportBar(QWidget* parent = nullptr);

  // `has_report`: of the folder, which can be saved.
  void show(ImportStep step, bool has_report);
  void say(const QString& words);
  void showProgress(double fraction, const QString& step);
  // Whether the series may be read, or why not.
  void setImportable(bool may, const QString& why);
  bool isImportable() const { return import_->isEnabled(); }
  void setFoundEnough(bool may) { take_found_->setEnabled(may); }
  void setAnswered(bool all) { open_case_->setEnabled(all); }
  void focusOpenCase() { open_case_->setFocus(); }
  void goOn();  // as the step's own button does

 signals:
  void reportWanted();
  void backWanted();
  void foundTaken();
  void cancelWanted();
  void closeWanted();
  void importWanted();
  void openCaseWanted();

 private:
  ImportStep step_ = ImportStep::empty;
  ElidedLabel* status_;
  QProgressBar* progress_;
  QPushButton *report_, *back_, *take_found_, *cancel_, *close_, *import_, *open_case_;
};

}  // namespace trephine
