#include "ui/prepare/form_group.h"

#include <QGridLayout>
#include <QVBoxLayout>

#include "ui/common/making.h"
#include "ui/common/setting_words.h"

namespace trephine {

FormGroup::FormGroup(const QString& title, const char* problem, const ExerciseEdited& wanted,
                     QWidget* parent)
    : QWidget(parent), wanted_(wanted) {
  auto* layout = tight(new QVBoxLayout(this));
  problem_ = problemLabel(problem, this);
  fields_ = new QWidget(this);
  form_ = settingForm(fields_);
  layout->addWidget(settingTitle(title, this));
  layout->addWidget(problem_);
  layout->addWidget(fields_);
}

void FormGroup::addAbove(QWidget* widget) {
  auto* column = static_cast<QVBoxLayout*>(layout());
  column->insertWidget(column->count() - 1, widget);
}

void FormGroup::addRow(const QString& label, QWidget* field, const QString& help) {
  form_->addRow(label, withHint(field, help, fields_));
}

void FormGroup::edit(const std::string& what, const ExerciseEdit& edit) {
  const Status done = wanted_ ? wanted_(what, edit) : Status();
  done ? problem_->hide() : refuse(done.error());
}

void FormGroup::refuse(const Error& why) {
  sayNotApplied(*problem_, why);
}

void FormGroup::refuse(const QString& why) {
  problem_->setText(why);
  problem_->show();
}

QWidget* besideEachOther(std::initializer_list<QWidget*> widgets, QWidget* parent) {
  auto* row = new QWidget(parent);
  auto* layout = tight(new QHBoxLayout(row), 4);
  for (QWidget* widget : widgets) layout->addWidget(widget, widget == *widgets.begin() ? 1 : 0);
  return row;
}

QWidget* chosenFile(QLabel* name, QToolButton* choose, QToolButton* none, QWidget* parent) {
  auto* row = new QWidget(parent);
  auto* grid = tight(new QGridLayout(row), 4);
  grid->addWidget(name, 0, 0, 1, 3);
  grid->addWidget(choose, 1, 0);
  grid->addWidget(none, 1, 1);
  grid->setColumnStretch(2, 1);
  return row;
}

}  // namespace trephine
