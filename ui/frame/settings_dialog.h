// How a person likes to work: the settings of common/settings.h that are a person's, in one place.
#pragma once

#include <QCheckBox>
#include <QDialog>
#include <QLabel>
#include <QLineEdit>

#include "ui/common/field_rows.h"
#include "ui/common/preferences.h"

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
  Preferences wanted_ = preferences();
  std::unique_ptr<FieldRows<Preferences>> rows_;
  QLabel* later_;
};

}  // namespace trephine
