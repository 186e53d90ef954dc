// A field for a number, which takes whatever a person types and changes none of it in silence: a
// number beyond the limits is refused in words that stand below the field until it is mended, and
// the number in force stays. `Box` is QSpinBox or QDoubleSpinBox.
#pragma once

#include <QCoreApplication>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QVBoxLayout>
#include <algorithm>
#include <functional>
#include <limits>
#include <type_traits>

#include "ui/common/colours.h"
#include "ui/common/placing.h"

namespace trephine {

template <class Box>
class NumberField : public Box {
 public:
  using Number = decltype(std::declval<const Box&>().value());

  // The words of a refusal are found by `name` + "Refused".
  explicit NumberField(const QString& name, QWidget* parent = nullptr) : Box(parent) {
    reason_ = new QLabel(parent);
    reason_->setObjectName(name + "Refused");
    reason_->setWordWrap(true);
    colours::setText(*reason_, colours::kCaution);
    reason_->hide();
    this->setObjectName(name);
    // As far as digits go: what lies beyond the limits is refused, and not kept from being typed.
    constexpr Number far =
        std::is_integral_v<Number> ? Number(std::numeric_limits<int>::max()) : Number(1e12);
    this->setRange(-far, far);
    this->setAccelerated(true);
    this->setKeyboardTracking(false);
    QObject::connect(this, &Box::valueChanged, this, [this] {
      typed_ = true;
      judge();
      if (!isRefused() && entered) entered();
    });
  }

  // A person has entered a number within the limits, or has given up another.
  std::function<void()> entered;

  // Both ends are allowed.
  void setLimits(Number low, Number high) {
    low_ = low;
    high_ = high;
    judge();
    this->updateGeometry();
  }
  // Shows the number in force; what was typed goes.
  void show(Number in_force) {
    in_force_ = in_force;
    typed_ = false;
    const QSignalBlocker quiet(this);
    this->setValue(in_force);
    judge();
  }
  // What the field asks for: the number typed, or the one in force where that is refused.
  Number wanted() const { return typed_ && allowed(this->value()) ? this->value() : in_force_; }
  // From now on that is in force.
  void take() {
    in_force_ = wanted();
    typed_ = typed_ && isRefused();
  }
  bool isRefused() const { return typed_ && !allowed(this->value()); }
  // A number that is shown as a word.
  void setWord(Number number, const QString& word) {
    worded_ = number;
    word_ = word;
    show(in_force_);
  }
  // The field, and below it the words of a refusal.
  QVBoxLayout* withReason() {
    auto* column = new QVBoxLayout;
    column->setSpacing(2);
    column->addWidget(this);
    column->addWidget(reason_);
    return column;
  }

  // From the number in force where another is refused; stops at the limits.
  void stepBy(int steps) override {
    this->interpretText();
    const double from = double(stepsFrom());
    const double to = from + double(steps) * double(this->singleStep());
    this->setValue(
        Number(std::clamp(to, std::min(from, double(low_)), std::max(from, double(high_)))));
    this->selectAll();
  }
  QSize sizeHint() const override { return fitted(Box::sizeHint()); }
  QSize minimumSizeHint() const override { return fitted(Box::minimumSizeHint()); }

 protected:
  QString textFromValue(Number number) const override {
    return !word_.isEmpty() && number == worded_ ? word_ : Box::textFromValue(number);
  }
  QAbstractSpinBox::StepEnabled stepEnabled() const override {
    QAbstractSpinBox::StepEnabled steps;
    steps.setFlag(QAbstractSpinBox::StepUpEnabled, stepsFrom() < high_);
    steps.setFlag(QAbstractSpinBox::StepDownEnabled, stepsFrom() > low_);
    return steps;
  }
  // Esc gives up what was typed; who else wants the key gets it.
  void keyPressEvent(QKeyEvent* event) override {
    if (event->key() != Qt::Key_Escape) return Box::keyPressEvent(event);
    const bool typed = typed_;
    show(in_force_);
    if (typed && entered) entered();
    event->ignore();
  }

 private:
  bool allowed(Number number) const { return number >= low_ && number <= high_; }
  Number stepsFrom() const { return isRefused() ? in_force_ : this->value(); }

  void judge() {
    if (!isRefused()) return reason_->hide();
    const auto words = [this](Number n) { return QString::number(double(n), 'g', 12); };
    reason_->setText(QCoreApplication::translate("NumberField",
                                                 "%1 is refused: between %2 and %3 only. %4 stays.")
                         .arg(words(this->value()) + this->suffix(), words(low_), words(high_),
                              words(in_force_) + this->suffix()));
    giveRoom(*reason_, this->width());
    reason_->show();
  }

  // As wide as the numbers within the limits; Qt would leave room for all that can be typed.
  QSize fitted(const QSize& hint) const {
    constexpr int kFrameAndArrows = 36;
    int text = 0;
    for (const Number number : {low_, high_}) {
      text = std::max(text, this->fontMetrics().horizontalAdvance(textFromValue(number) +
                                                                  this->suffix() + ' '));
    }
    return {std::min(hint.width(), text + kFrameAndArrows), hint.height()};
  }

  QLabel* reason_;
  Number low_ = std::numeric_limits<Number>::lowest(), high_ = std::numeric_limits<Number>::max();
  Number in_force_ = 0, worded_ = 0;
  QString word_;
  bool typed_ = false;  // another number than the one in force, and not yet taken
};

// A form's row of it; the words' mnemonic leads to the field.
template <class Box>
void addRow(QFormLayout& form, const QString& words, NumberField<Box>* field) {
  auto* label = new QLabel(words, form.parentWidget());
  label->setBuddy(field);
  form.addRow(label, field->withReason());
}

using WholeNumberField = NumberField<QSpinBox>;
using DecimalField = NumberField<QDoubleSpinBox>;

}  // namespace trephine
