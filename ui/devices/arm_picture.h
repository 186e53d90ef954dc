// An arm while it is tried: where its tip is within its reach, seen from the front, with a bar for
// the depth and an arrow for the force. Or what to do with it until it knows where it is.
#pragma once

#include <QWidget>

#include "base/math.h"

namespace trephine {

class ArmPicture : public QWidget {
  Q_OBJECT
 public:
  explicit ArmPicture(QWidget* parent = nullptr);

  // In the device frame; the reach is the full extent along each axis.
  void showTip(const Vec3& tip_m, const Vec3& reach_m, double force_N);
  // Its stylus belongs into the holder.
  void showHolder();
  void clear();

  QSize sizeHint() const override { return {260, 190}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  enum class Shows { nothing, tip, holder } shows_ = Shows::nothing;
  Vec3 tip_m_{0.0}, reach_m_{1.0};
  double force_N_ = 0.0;
};

}  // namespace trephine
