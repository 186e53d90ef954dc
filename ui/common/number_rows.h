// Fields for the numbers of an element of an exercise, made of their rows (base/number_row.h): each
// with its name, unit and range, and a line that says what it does.
#pragma once

#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "base/number_row.h"
#include "ui/common/number_field.h"
#include "ui/common/setting_words.h"

namespace trephine {

template <class Owner>
class NumberRows {
 public:
  // Fields are called `prefix` and the row's key; of three numbers "X", "Y" and "Z" follow.
  NumberRows(std::span<const NumberOf<Owner>> rows, QFormLayout& form, QWidget* parent,
             const QString& prefix)
      : form_(form) {
    for (const NumberOf<Owner>& row : rows) addRow(row, parent, prefix);
  }

  // A person wants this; `key` is the number's.
  std::function<void(const Owner& wanted, const char* key)> entered;

  void show(const Owner& owner) {
    owner_ = owner;
    for (const Field& field : fields_) field.box->show(valueOf(field));
  }
  // Rows that do not count for this one are not shown.
  void setVisible(bool visible) {
    for (const Field& field : fields_) {
      if (field.part <= 0) form_.setRowVisible(field.line, visible);
    }
  }
  // They stay where they are, for nothing that could be changed.
  void setEnabled(bool enabled) {
    for (const Field& field : fields_) field.box->setEnabled(enabled);
  }

 private:
  struct Field {
    DecimalField* box;
    const NumberOf<Owner>* row;
    int part;  // of three numbers; -1: of one
    QWidget* line;
  };

  void addRow(const NumberOf<Owner>& row, QWidget* parent, const QString& prefix) {
    auto* line = new QWidget(parent);
    auto* column = new QVBoxLayout(line);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(1);
    const bool three = std::holds_alternative<Vec3 Owner::*>(row.member);
    if (three) {
      auto* beside = new QHBoxLayout;
      beside->setSpacing(3);
      for (int part = 0; part < 3; ++part) {
        const char* const names[] = {"X", "Y", "Z"};
        beside->addLayout(addField(row, part, prefix + row.row.key + names[part], line), 1);
      }
      column->addLayout(beside);
    } else {
      column->addLayout(addField(row, -1, prefix + row.row.key, line));
    }
    column->addWidget(settingHint(shortMeaningOf(row.row), line));
    form_.addRow(nameOfSetting(row.row.key), line);
  }

  QLayout* addField(const NumberOf<Owner>& row, int part, const QString& name, QWidget* line) {
    auto* box = new DecimalField(name, line);
    const bool whole = std::holds_alternative<int Owner::*>(row.member) ||
                       std::holds_alternative<std::uint32_t Owner::*>(row.member);
    box->setDecimals(whole ? 0 : part < 0 || row.row.range.high <= 10.0 ? 3 : 1);
    box->setLimits(row.row.range.low, row.row.range.high);
    box->setSingleStep(whole ? 1.0 : stepOfUnit(row.row.range.unit));
    if (part < 0 && *row.row.range.unit) box->setSuffix(' ' + QString(row.row.range.unit));
    if (part >= 0) box->setButtonSymbols(QAbstractSpinBox::NoButtons);
    constexpr int kLeast_px = 34;  // of a narrow column, three beside each other
    box->setMinimumWidth(kLeast_px);
    box->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
    box->setAccessibleName(nameOfSetting(row.row.key));
    box->setToolTip(meaningOf(row.row));
    const Field field{box, &row, part, line};
    box->entered = [this, field] { take(field); };
    fields_.push_back(field);
    return box->withReason();
  }

  double valueOf(const Field& field) const {
    return std::visit(
        [&](auto member) {
          const auto& value = owner_.*member;
          if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, Vec3>) {
            return double(value[field.part]);
          } else {
            return double(value);
          }
        },
        field.row->member);
  }

  void take(const Field& field) {
    // What is shown rounded and was not typed stays to the digit.
    if (std::abs(field.box->wanted() - valueOf(field)) < 0.5 * std::pow(10.0, -field.box->decimals()))
      return;
    Owner wanted = owner_;
    std::visit(
        [&](auto member) {
          auto& value = wanted.*member;
          using Value = std::remove_cvref_t<decltype(value)>;
          if constexpr (std::is_same_v<Value, Vec3>) {
            value[field.part] = field.box->wanted();
          } else {
            value = Value(field.box->wanted());
          }
        },
        field.row->member);
    if (entered) entered(wanted, field.row->row.key);
  }

  QFormLayout& form_;
  Owner owner_{};
  std::vector<Field> fields_;
};

}  // namespace trephine
