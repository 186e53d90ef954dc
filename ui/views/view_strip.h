// The strip over the 3-D view and what it does to the picture: standard views, orthographic, and
// what is cut away and where the light comes from, which are dragged in the view as well: the
// squares of the crop box and the clip plane, and the light. Each is an action with a key of its
// own while the view has the focus; a menu may list them too. Window's thread.
#pragma once

#include <QAction>
#include <QFrame>
#include <QList>
#include <optional>

#include "render/clip_tools.h"
#include "render/scene_renderer.h"

class QGridLayout;

namespace trephine {

class ViewStrip : public QFrame {
  Q_OBJECT
 public:
  // Over `view`, which shows the renderer's picture, at its right upper corner; hidden where the
  // view has no room for it.
  ViewStrip(SceneRenderer& renderer, QWidget* view);

  int covered() const;  // pixels of the view from its edge; 0: it is hidden
  void place();
  // What the strip holds, a separator (null) between groups.
  const QList<QAction*>& all() const { return all_; }
  QAction* parallel() const { return parallel_; }
  QAction* box() const { return box_; }
  QAction* plane() const { return plane_; }
  QAction* light() const { return light_; }

  // Of another place than before everything is shown, with the light in its own place.
  void setVolume(const GridGeometry& geometry);
  // A tool's plane needs a tool: the right hand's, where there are two.
  void setTools(const std::vector<ToolView>& tools);
  // Whether the exercise has a view of its own.
  void setExerciseView(bool has);
  std::vector<ClipPlane> planes() const { return clip_.planes(); }
  bool movesLight() const { return light_->isChecked(); }
  // What a drag of the left button moves: the handle that it took, within reach of that place of
  // the view, or the light.
  bool take(const QPointF& place);
  void letGo() { dragged_.reset(); }
  bool dragsAnything() const { return dragged_ || movesLight(); }
  void drag(const QPointF& moved);
  void addLines(ScreenLines& to) const;

 signals:
  void changed();       // the picture of the volume
  void lightToggled();  // movesLight()
  void exerciseViewWanted();

 private:
  QAction* make(const char* name, const QString& text, const QString& word, const QKeySequence& key,
                const QString& tip);
  QAction* makeSwitch(const char* name, const QString& text, const QString& word,
                      const QKeySequence& key, const QString& tip);
  void showClip();
  void throughTool();
  void reset();

  SceneRenderer& renderer_;
  QList<QAction*> all_;
  QAction *parallel_, *box_, *plane_, *through_, *light_, *exercise_;
  QGridLayout* grid_;
  int cell_ = 0;
  ClipTools clip_;
  std::optional<ClipTools::Handle> dragged_;
  std::optional<Pose> tool_mm_;
  bool along_tool_ = false;  // how the plane through the tool lies next
  Vec3 light_from_ = SceneRenderer::kLight;
};

}  // namespace trephine
