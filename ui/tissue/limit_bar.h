// Beside a number of a tissue: where it lies in its range, and what the arms can show of it.
#pragma once

#include <QWidget>
#include <optional>

namespace trephine {

class LimitBar : public QWidget {
  Q_OBJECT
 public:
  explicit LimitBar(QWidget* parent = nullptr);

  // From 0 to `most`, drawn by its logarithm from `least_step` on.
  void setRange(double most, double least_step, int decimals);
  void setValue(double value);
  // False: no law of the exercise uses the number.
  void setFelt(bool felt);
  // A force that comes weaker than it says.
  void setWeaker(bool weaker);
  // `shown`: the most that the arms show; none: they have no say in it. `bounds`: the controller
  // keeps to it, else what lies above may shake.
  void setLimit(std::optional<double> shown, bool bounds);
  std::optional<double> limit() const { return limit_; }

  // "arm 8.3", "any arm", "not felt", "felt weaker", as it is written beside the bar.
  QString words() const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  double at(double value) const;  // 0 to 1
  void tell();

  double most_ = 1.0, step_ = 0.01, value_ = 0.0;
  int decimals_ = 2;
  std::optional<double> limit_;
  bool bounds_ = true, felt_ = true, weaker_ = false;
};

}  // namespace trephine
