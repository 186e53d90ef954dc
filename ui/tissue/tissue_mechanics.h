// What a tissue does to a hand: each number with its unit, its range, its source, what was
// published of it and what the arms can show of it, and whether it can be cut and stops a tool.
#pragma once

#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QWidget>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "exercise/arm_limits.h"
#include "haptics/controllers.h"
#include "ui/common/field_rows.h"
#include "ui/common/number_field.h"
#include "ui/common/placing.h"
#include "ui/tissue/limit_bar.h"

namespace trephine {

class TissueMechanics : public QWidget {
  Q_OBJECT
 public:
  explicit TissueMechanics(QWidget* parent = nullptr);

  // Every field as the tissue is; what was typed and refused goes. `declared`: as its file has it.
  void show(const Tissue& tissue, const Tissue& declared);
  // The same, but for what is typed: after another field was taken.
  void update(const Tissue& tissue, const Tissue& declared);
  void setLimits(const std::optional<ArmsLimit>& arms, DemandedOf demanded,
                 const std::vector<LawKind>& laws, RemovalKind removal, ControllerKind in_force);

  // What all laws together demand beyond what these arms show, in lines; empty: nothing.
  QString feltWords() const;
  bool isBounded() const { return in_force_ == ControllerKind::bounded; }

  // A person wants this; `what` is the number's key. The tissue is as it was where it is refused.
  std::function<Status(const Tissue& wanted, const char* what)> wanted;

 private:
  struct Number {
    DecimalField* box;
    LimitBar* bar;
    QLineEdit* source;
    ElidedLabel* known;  // what was published of it
    const TissueNumber* row;
  };
  QLabel* addNumber(const TissueNumber& row);
  void entered(const Number& number);
  void sourceEntered(const Number& number);
  void showOutcome();
  void showKnown(const Number& number);

  std::vector<Number> numbers_;
  std::unique_ptr<FieldRows<Tissue>> cutting_;
  QComboBox* solid_;
  Tissue tissue_, declared_;
  std::optional<ArmsLimit> arms_;
  DemandedOf demanded_;
  std::optional<std::vector<LawKind>> laws_;
  RemovalKind removal_ = RemovalKind::work;
  ControllerKind in_force_ = ControllerKind::bounded;
};

}  // namespace trephine
