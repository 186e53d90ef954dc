// The strip of tools over the 3-D view: standard views, orthographic, crop box, clip plane, light.
// Each is an action with a key of its own while the view has the focus; a menu may list them too.
#pragma once

#include <QAction>
#include <QFrame>
#include <QList>

#include "render/view_camera.h"

class QGridLayout;

namespace trephine {

class ViewStrip : public QFrame {
  Q_OBJECT
 public:
  // Over `view`, at its right upper corner; hidden where the view has no room for it.
  explicit ViewStrip(QWidget* view);

  void place();
  // What the strip holds, a separator (null) between groups.
  const QList<QAction*>& all() const { return all_; }
  QAction* parallel() const { return parallel_; }
  QAction* box() const { return box_; }
  QAction* plane() const { return plane_; }
  QAction* light() const { return light_; }
  // A tool's plane needs a tool.
  void setToolAtHand(bool at_hand) { through_->setEnabled(at_hand); }
  void setUsable(bool usable);

 signals:
  void viewWanted(trephine::StandardView side);
  void parallelWanted(bool on);
  void boxWanted(bool on);
  void planeWanted(bool on);
  void throughToolWanted();
  void planeMoved(double mm);
  void lightWanted(bool on);
  void resetWanted();

 private:
  QAction* make(const char* name, const QString& text, const QString& word, const QKeySequence& key,
                const QString& tip);
  QAction* makeSwitch(const char* name, const QString& text, const QString& word,
                      const QKeySequence& key, const QString& tip);

  QList<QAction*> all_;
  QAction *parallel_, *box_, *plane_, *through_, *light_, *reset_;
  QGridLayout* grid_;
  int cell_ = 0;
};

}  // namespace trephine
