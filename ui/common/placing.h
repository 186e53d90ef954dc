// Sizes and places on the screen, so that nothing lies outside of it.
#pragma once

#include <QLabel>
#include <QScrollArea>

namespace trephine {

// `wanted`, or as much of it as fits on the window's screen together with a frame.
QSize sizeOnScreen(const QSize& wanted, const QWidget& window);

// Puts a dialog in the middle of its window, as far as the screen allows.
void centreOver(QWidget& dialog, const QWidget& window);

// A page that scrolls where the window is small.
QScrollArea* scrolled(QWidget* page, const char* name);

// Room for all lines of a wrapped text in a column of this width: layouts within a form give it
// one.
inline void giveRoom(QLabel& wrapped, int width) {
  wrapped.ensurePolished();  // one that was never shown has not the letters of its style
  wrapped.setMinimumHeight(wrapped.heightForWidth(width));
}

// One line that gives way: where it has too little room it ends in dots and the tip says all.
class ElidedLabel : public QLabel {
 public:
  using QLabel::QLabel;
  QSize minimumSizeHint() const override;
  // What the tip says beside the words themselves, which it has where they are cut.
  void setMore(const QString& more) { more_ = more; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString more_;
};

}  // namespace trephine
