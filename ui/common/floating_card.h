// A frame of words and buttons that lies over another widget, as wide as is asked or as there is
// room, and keeps its place there.
#pragma once

#include <QFrame>

namespace trephine {

class FloatingCard : public QFrame {
  Q_OBJECT
 public:
  enum class At { top, middle, bottom };

  FloatingCard(QWidget& over, At at, int widest);
  // After what it says has changed.
  void place();
  // Its buttons come next when Tab leaves this one.
  void takeTabFrom(QWidget& before);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  // Leaves away what has no room: the card is so wide, and so high at most.
  virtual void fit(int /*width*/, int /*most_height*/) {}
  void showEvent(QShowEvent* event) override;

 private:
  static constexpr int kMargin = 12;
  static constexpr int kCorner = 110, kAboveCorners = 112;  // where a view has its scale and axes
  At at_;
  int widest_;
};

}  // namespace trephine
