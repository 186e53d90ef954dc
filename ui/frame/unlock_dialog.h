// Asks an educator for the PIN that takes the locks off until the program ends.
#pragma once

#include <QDialog>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>

#include "base/pin.h"
#include "ui/common/background_task.h"

namespace trephine {

class UnlockDialog : public QDialog {
  Q_OBJECT
 public:
  UnlockDialog(const Pin& pin, QWidget* parent);

 signals:
  void unlocked();

 private:
  void check();

  Pin pin_;
  QLineEdit* text_;
  QLabel* said_;
  QPushButton* unlock_;
  BackgroundTask checking_;
};

}  // namespace trephine
