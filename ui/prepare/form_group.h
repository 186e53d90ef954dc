// A group of fields of an exercise: its title, what was refused of it, and its form.
#pragma once

#include <QFormLayout>
#include <QLabel>
#include <QToolButton>
#include <QWidget>
#include <functional>
#include <memory>
#include <string>

#include "exercise/exercise.h"
#include "ui/common/field_rows.h"

namespace trephine {

// A person wants this change of the exercise as it is then; `what` of it.
using ExerciseEdit = std::function<void(Exercise&)>;
using ExerciseEdited = std::function<Status(const std::string& what, const ExerciseEdit& edit)>;

class FormGroup : public QWidget {
 public:
  // What was refused is found by `problem`. `wanted` is called as it is then.
  FormGroup(const QString& title, const char* problem, const ExerciseEdited& wanted,
            QWidget* parent);

  QFormLayout& form() { return *form_; }
  QWidget* fields() { return fields_; }
  // Above the form.
  void addAbove(QWidget* widget);
  // `help` stands below the field.
  void addRow(const QString& label, QWidget* field, const QString& help);
  template <class Owner>
  std::unique_ptr<FieldRows<Owner>> addFields(FieldsOf<Owner> fields, const QString& prefix) {
    return std::make_unique<FieldRows<Owner>>(fields, *form_, fields_, prefix);
  }
  // What is refused is said; the exercise stays as it is.
  void edit(const std::string& what, const ExerciseEdit& edit);
  void refuse(const QString& why);
  void refuse(const Error& why);  // "Not applied.", why, and what to do
  void forgetRefusal() { problem_->hide(); }

 private:
  const ExerciseEdited& wanted_;
  QLabel* problem_;
  QWidget* fields_;
  QFormLayout* form_;
};

// Widgets beside each other, the first of them over all of the width.
QWidget* besideEachOther(std::initializer_list<QWidget*> widgets, QWidget* parent);
// The name of a file, and below it the buttons that choose another and none.
QWidget* chosenFile(QLabel* name, QToolButton* choose, QToolButton* none, QWidget* parent);

}  // namespace trephine
