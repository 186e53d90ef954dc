// The 3-D view: hosts the exercise renderer and turns mouse and keys into movements of a hand or of
// the camera. It knows no session: what a hand does with its movement is told by a signal.
//
// While an exercise runs the pointer is where the tool goes, and what is over the view is told by
// signals: the wheel or Page Up and Down press, arrow keys move the pointer, with Shift they tilt
// the tool, Shift+Home straightens it, Tab takes the other hand. The squares of the crop box and
// the clip plane are dragged with the left button, and while the light is to be moved, the light.
// Right drag turns the camera, middle drag shifts it, Ctrl+wheel zooms; without an exercise the
// left button, the wheel and the keys move the camera too. With a tool in hand that works in 3-D
// the left button is the tool's, at what is seen under the pointer.
#pragma once

#include <QElapsedTimer>
#include <QLabel>
#include <QTimer>
#include <functional>

#include "base/codes.h"
#include "base/result.h"
#include "base/tr.h"
#include "exercise/landmark.h"
#include "ui/views/opengl_pane.h"
#include "ui/views/tool_in_3d.h"
#include "ui/views/workspace_box.h"

namespace trephine {

class ViewWidget : public OpenGlPane {
  Q_OBJECT
 public:
  explicit ViewWidget(Toolbox& toolbox, QWidget* parent = nullptr);  // which outlives it
  ~ViewWidget() override;

  // What it draws, from now on and at once; not null: an empty mirror is no case. Once what the
  // mirror holds has changed, takeChanges(). All points, poses and rays are in mm of the patient's
  // frame (LPS), all places in the widget's own units.
  void setMirror(std::shared_ptr<VolumeMirror> mirror);
  void takeChanges();
  void setTissues(const TissueSet& tissues, const TissueLooks& looks = {});
  // Looks at a landmark from outside, or at all of the patient from there or from the front.
  void lookAtLandmark(const LandmarkFrame& frame, double distance_mm);
  void lookAtAll(const std::optional<LandmarkFrame>& from);
  // Where the tools are now; draws when something changed.
  void setTools(const std::vector<ToolView>& tools);

  void setTraining(bool training);
  // A line on the tissue; no points: none.
  void setOutline(const std::vector<Vec3>& points_mm, bool closed, double width_mm);

  // Where arms reach, as boxes of lines.
  void setWorkspaces(const std::vector<WorkspaceBox>& boxes);

  // What is seen at a place of the widget.
  std::optional<Picked> pickAt(const QPointF& place) const { return tool_.pickAt(place); }
  // The line of sight there; none without a case.
  std::optional<ViewCamera::Ray> rayAt(const QPointF& place) const { return tool_.rayAt(place); }
  // How many mm one unit of the widget spans at what is seen there, else at what is looked at.
  double mmPerUnitAt(const QPointF& place) const { return tool_.mmPerUnitAt(place); }

  // Standard views, crop box and what else the strip over the view offers.
  const ViewStrip& tools() const { return *strip_; }
  ViewStrip& tools() { return *strip_; }

  const ViewCamera& camera() const { return renderer_.camera(); }
  // The picture is of what there is now, at full quality.
  bool isComplete() const { return renderer_.complete(); }

  // NO_OPENGL until the view could start to draw, and where it could not.
  const Status& canDraw() const { return drawing_; }
  // What is on the screen: the voxels, and the picture at full quality.
  const Volume& shownVolume() const { return renderer_.copy(); }
  Result<Picture> picture();
  std::string openGlDescription() const { return gl_description_; }

  // ---- For pictures that are seen elsewhere.
  // With the view's OpenGL current: its renderer, and what is on the screen as a framebuffer object
  // of this size. Nothing where the view cannot draw.
  using WithGraphics =
      std::function<void(SceneRenderer&, unsigned int framebuffer, int width, int height)>;
  void withGraphics(const WithGraphics& work);
  // The view shows this texture of its context instead of its own picture; 0: its own again. Until
  // then the caller keeps it, of this size in its pixels.
  void showInstead(unsigned int texture, int width, int height);
  void setCards(std::vector<Card> cards) { renderer_.setCards(std::move(cards)); }

 signals:
  // While an exercise runs.
  void pointed(const QPointF& place);
  void pointerStepped(int right, int up);
  void pushStepped(double notches);
  void toolTilted(int right, int up);
  void toolStraightened();
  void otherHandWanted();
  // Something else is under each place now.
  void resized();
  void nothingThere();  // under the pointer, where a tool was to work
  void framePainted(double paint_ms, bool with_volume);
  // It cannot start to draw (NO_OPENGL and the like), or what it should draw was refused.
  void failed(const trephine::Error& error);

 protected:
  void initializeGL() override;
  void resizeGL() override;
  void paintGL() override;
  void couldNotStart() override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  bool focusNextPrevChild(bool next) override;

 private:
  void showNews();  // of the mirror, as a whole
  void releaseGraphics();
  void redraw();  // the volume too: coarse now, refined when still
  void rest();
  void refine();
  void warmUp();
  void showLevel();
  Vec3 turningPoint(const QPointF& place) const;
  void zoomAt(const QPointF& place, double factor);
  void turn(double right_pixels, double down_pixels);
  void fitHint();
  void fitRenderer();
  void paintInstead();

  SceneRenderer renderer_;
  GridGeometry shown_;
  Status drawing_{Error{code::kNoOpengl, trephine::tr("The view has no OpenGL to draw with"),
                        trephine::tr("3-D view"),
                        trephine::tr("Install the graphics driver and start again")}};
  std::string gl_description_;
  QLabel* hint_;
  QLabel* level_;
  ViewStrip* strip_;
  ToolIn3D tool_;
  QTimer still_, refine_, warm_;
  std::vector<ToolView> tools_;  // of the exercise
  std::vector<WorkspaceBox> workspaces_;
  Vec3 turned_about_mm_{0.0};  // by a drag
  std::optional<QPointF> pressed_at_;  // of a click, as long as it may be one
  bool training_ = false;
  bool worked_ = false;  // since the event loop came round
  bool put_off_ = false;  // what is to be warmed
  bool moving_ = false;
  bool refusal_said_ = false;
  struct Instead {
    unsigned int texture = 0;
    int width = 0, height = 0;
  } instead_;
};

}  // namespace trephine
