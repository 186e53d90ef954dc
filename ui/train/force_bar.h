// One arm's force against its limit: the bar is what was sent, the tick mark what the laws
// demanded.
#pragma once

#include <QWidget>

namespace trephine {

class ForceBar : public QWidget {
  Q_OBJECT
 public:
  explicit ForceBar(QWidget* parent = nullptr);
  // Newtons. `demanded_N` may lie above the limit: then the bar's end says so.
  void setForce(double sent_N, double demanded_N, double limit_N);
  QSize sizeHint() const override { return {160, 18}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  double sent_N_ = 0.0, demanded_N_ = 0.0, limit_N_ = 1.0;
};

}  // namespace trephine
