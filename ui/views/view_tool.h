// What the left button does in the views: a tool that a person takes in hand, for slices and, where
// it says so, for the 3-D view. Views tell it what happens in mm of the patient, and paint what it
// shows. Window's thread.
#pragma once

#include <QObject>
#include <QPointF>
#include <limits>

#include "base/math.h"

class QPainter;

namespace trephine {

class SliceView;

// Where something happened: in a slice, or on what is seen in 3-D under the pointer.
struct ToolEvent {
  Vec3 at_mm{0.0};      // LPS
  Vec3 inside_mm{0.0};  // in 3-D below the surface that is seen; in a slice the same place
  int across = 0;       // the axis of the grid along which one looks most
  // How far the pointer went since the last event, on what is seen there. A slice has no edge
  // behind which something else lies.
  double moved_mm = std::numeric_limits<double>::infinity();
  QPointF in_widget;
  bool in_picture = true;      // of the slice, not beside it
  SliceView* slice = nullptr;  // none: in 3-D
};

// Less between press and release is a click.
bool isClick(const QPointF& pressed, const QPointF& released);

class ViewTool : public QObject {
  Q_OBJECT
 public:
  struct Facts {
    const char* name;  // of the object, and of the button that takes it in hand
    Qt::Key key;       // takes it in hand in a slice; 0: none
    QString text;      // on its button
    QString tip;
    QString hint;  // what to do with it
    // Of 18 x 18, for the bar above the slices; null: it is not there.
    void (*symbol)(QPainter&) = nullptr;
  };
  ViewTool(Facts facts, QObject* parent);

  const Facts& facts() const { return facts_; }

  virtual bool worksIn3D() const { return false; }
  // A second click is one more of its own, and enlarges no view.
  virtual bool takesDoubleClicks() const { return worksIn3D(); }
  virtual Qt::CursorShape cursor() const { return Qt::CrossCursor; }
  // Of the ring around the pointer within which it works, as brushes do; 0: none. A drag of one in
  // 3-D goes over what was seen when it began.
  virtual double ring_mm() const { return 0.0; }

  // The left button; move() while it is down, hover() while it is not. In 3-D only where something
  // is seen under the pointer, and release() where that was last.
  virtual void press(const ToolEvent&) {}
  virtual void move(const ToolEvent&) {}
  virtual void release(const ToolEvent&) {}
  virtual void hover(const ToolEvent&) {}
  // Whether it had a use for the key; `point_mm`: the common point, in a slice.
  virtual bool key(int /*key*/, const Vec3* /*point_mm*/) { return false; }
  // Whether something had been begun that is now left.
  virtual bool giveUp() { return false; }
  // Over a slice while it is in hand.
  virtual void paint(QPainter&, const SliceView&) const {}

 signals:
  void changed();  // what it paints, or its ring

 private:
  Facts facts_;
};

}  // namespace trephine
