// How the patient is seen by both eyes: in a headset, and on another screen. What is entered takes
// effect at once, since somebody may be looking.
#pragma once

#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QLineEdit>

#include "ui/common/field_rows.h"
#include "ui/common/preferences.h"

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
  using Rows = FieldRows<Preferences>;
  std::unique_ptr<Rows> rows(FieldsOf<Preferences> fields, QFormLayout& form,
                             void (HeadsetDialog::*changed)());

  std::unique_ptr<Rows> of_headset_, of_screen_;
  QComboBox* screen_;
  QLineEdit* lens_;
};

}  // namespace trephine
