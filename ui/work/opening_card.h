// Over the views while a case is being opened: what, how far it is, and a way out. The views behind
// it still show the one before.
#pragma once

#include <QLabel>
#include <QProgressBar>

#include "ui/common/floating_card.h"
#include "ui/work/workstation.h"

namespace trephine {

class OpeningCard : public FloatingCard {
  Q_OBJECT
 public:
  OpeningCard(QWidget& over, Workstation& workstation);

 private:
  void show(double fraction, const QString& step);

  Workstation& workstation_;
  QLabel *title_, *step_;
  QProgressBar* progress_;
};

}  // namespace trephine
