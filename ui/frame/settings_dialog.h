// How a person likes to work: the settings of common/settings.h that are a person's, in one place.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QLineEdit>

#include "ui/common/number_field.h"

namespace trephine {

class SettingsDialog : public QDialog {
  Q_OBJECT
 public:
  // `storage`: where cases and exercises are kept now; `storage_locked`: the administrator says so.
  SettingsDialog(const QString& storage, bool storage_locked, QWidget* parent);

 signals:
  void changed();  // what can take effect at once does

 private:
  void save();
  void chooseFolder();

  QLineEdit* storage_;
  QComboBox *language_, *theme_, *hand_;
  WholeNumberField* text_;
  DecimalField *push_, *step_, *arm_limit_;
  QLabel* later_;
};

}  // namespace trephine
