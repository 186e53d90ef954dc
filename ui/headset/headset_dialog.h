// How the patient is seen by both eyes: in a headset, and on another screen. What is entered takes
// effect at once, since somebody may be looking.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QLineEdit>

#include "ui/common/number_field.h"

namespace trephine {

class HeadsetDialog : public QDialog {
  Q_OBJECT
 public:
  explicit HeadsetDialog(QWidget* parent);
  // The lens's file; empty: none.
  void setLens(const QString& file);

 signals:
  void headsetChanged();
  void screenChanged();
  void lensWanted();  // a file is to be chosen

 private:
  QWidget* buildHeadset();
  QWidget* buildScreen();
  DecimalField* number(const char* name, const QString& unit, double least, double most,
                       double step, int decimals);

  DecimalField *ahead_, *below_, *scale_, *eyes_, *away_;
  QCheckBox* mirror_;
  QComboBox *screen_, *packing_;
  QLineEdit* lens_;
};

}  // namespace trephine
