// The tool in hand in the 3-D view: it works at what is seen under the pointer. Window's thread.
#pragma once

#include <memory>
#include <optional>

#include "render/pick.h"
#include "ui/views/toolbox.h"
#include "ui/views/view_strip.h"

namespace trephine {

class ToolIn3D : public QObject {
  Q_OBJECT
 public:
  // `view` shows the renderer's picture, as the strip over it cuts it. All outlive it.
  ToolIn3D(Toolbox& toolbox, const SceneRenderer& renderer, const ViewStrip& strip, QWidget& view);

  // What is seen.
  void setMirror(std::shared_ptr<const VolumeMirror> mirror) { mirror_ = std::move(mirror); }
  void setTissues(const TissueSet& tissues, const TissueLooks& looks);
  // While an exercise runs the left button is a hand's.
  void setTraining(bool training);

  // As ViewWidget has them.
  std::optional<ViewCamera::Ray> rayAt(const QPointF& place) const;
  std::optional<Picked> pickAt(const QPointF& place) const;
  double mmPerUnitAt(const QPointF& place) const;

  // One that works in 3-D, and may.
  bool isInHand() const {
    return toolbox_.inHand().worksIn3D() && !training_ && !strip_.movesLight();
  }
  // A brush works while it is dragged; any other by a click, and a drag turns the view.
  bool isDragged() const { return isInHand() && toolbox_.inHand().ring_mm() > 0.0; }
  // Where the pointer is; returns how far it went.
  QPointF setPointer(const QPointF& place) { return place - std::exchange(pointer_, place); }
  const QPointF& pointer() const { return pointer_; }
  void showCursor();
  // A brush's cursor is as large as what it paints on, which is looked up.
  void followRing() {
    if (toolbox_.inHand().ring_mm() > 0.0) showCursor();
  }
  void press();
  bool move(const QPointF& moved);  // whether it is pressed
  void release();
  bool key(int key);

 signals:
  void nothingThere();  // under the pointer, where it was to work

 private:
  std::optional<ToolEvent> eventHere(const QPointF& moved = {}) const;

  Toolbox& toolbox_;
  const SceneRenderer& renderer_;
  const ViewStrip& strip_;
  QWidget& view_;
  std::shared_ptr<const VolumeMirror> mirror_ = std::make_shared<VolumeMirror>();
  TissueSet tissues_;
  TissueLooks looks_;
  bool training_ = false;
  QPointF pointer_;
  int ring_ = 0;                                   // pixels of the radius that the pointer shows
  ViewTool* used_ = nullptr;                       // while the button is down
  ToolEvent last_use_;                             // of it
  std::shared_ptr<const LabelMap> stroke_labels_;  // as they were when a brush's drag began
};

}  // namespace trephine
