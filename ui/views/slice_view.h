// An axial, coronal or sagittal slice of what the mirror holds, as it is cut. It asks for what
// concerns all views (the common point, window, tool) by signals and is told what came of it.
//
// Left drag is the tool's that is in hand; with Shift it moves the common point with any tool.
// Where the window is in hand, a line of another view is dragged to another slice of that view.
// Wheel, Page Up/Down, arrow keys, Home, End go through the slices. Del takes the last measure
// away, Esc gives a tool up.
#pragma once

#include <QImage>
#include <memory>

#include "ui/views/slice_marks.h"
#include "ui/views/slice_pane.h"
#include "ui/views/toolbox.h"

namespace trephine {

class SliceView : public SlicePane {
  Q_OBJECT
 public:
  // `colours` and `tools` outlive the view; coloursChanged() once they were.
  SliceView(SliceAxis axis, std::shared_ptr<VolumeMirror> mirror, const SliceColours& colours,
            Toolbox& tools, QWidget* parent = nullptr);

  // What is new in the mirror. Draws only where the slice shows a voxel that changed.
  void takeChanges();
  void coloursChanged();
  void labelsChanged(const VoxelBox& box) {  // of the mirror's labels
    if (hasSlice() && touches(stack_, slice_, grid(), box)) coloursChanged();
  }
  // All three views show the slice that holds it.
  void setPoint(const Vec3& patient_mm);
  void setTools(const std::vector<ToolView>& tools);  // of the exercise
  // Where arms reach: the chosen one is dragged by its middle.
  void setWorkspaces(const std::vector<WorkspaceBox>& boxes);
  void setSlice(int k);  // asks for the point that lies in it

  int slice() const { return slice_; }
  int slices() const { return stack_.size[2]; }
  const GridGeometry& stack() const { return stack_; }
  const Vec3& point_mm() const { return point_mm_; }
  ShownSlice shown() const { return {axis_, stack_, slice_, target(), size()}; }
  // A place of the widget in the patient, on the slice; and back, along the slice's normal.
  Vec3 toPatient_mm(const QPointF& in_widget) const;
  QPointF fromPatient(const Vec3& patient_mm) const { return shown().at(patient_mm); }
  // HU, tissue and label under the pointer; empty where it is not over the volume.
  QString readout() const;
  const std::vector<Measure>& measures() const { return measures_; }
  void addMeasure(const Measure& measure) { measures_.push_back(measure); }
  void clearMeasures() { measures_.clear(); }

  // ---- For tools, while there is a case.
  const HuWindow& window() const { return colours_.window(); }
  const GridGeometry& grid() const { return mirror_->volume().geometry; }
  // Across which its slices lie.
  int gridAxis() const { return axisAlong(grid(), stack_.direction[2]); }
  // The place of the slice's picture that is nearest to one of its plane.
  Vec3 nearestInSlice_mm(const Vec3& patient_mm) const;
  const std::optional<QPointF>& pointer() const { return pointer_; }
  // What the slice was drawn from, without what lies over it.
  int drawn() const { return drawn_; }  // how often it was, for tests

 signals:
  void pointChosen(const trephine::Vec3& patient_mm);
  void windowChosen(const trephine::HuWindow& window);
  void overlayWanted();  // the next kind of overlay
  // The chosen workspace's middle, dragged in the slice; `done` when it is let go of.
  void workspaceMoved(const trephine::Vec3& centre_mm, bool done);
  void sliceShown(int k);
  void enlargeWanted();
  void focused();

 protected:
  void paintSlice(QPainter& painter) override;
  void paintOver(QPainter& painter) override;
  bool event(QEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;

 private:
  bool handleKey(int key);
  ToolEvent eventAt(const QPointF& in_widget);
  // Along the slice, as far as the pointer went.
  Vec3 draggedWorkspace(const QPointF& to) const {
    return workspace_before_mm_ + toPatient_mm(to) - toPatient_mm(pressed_);
  }
  struct Lines {  // of the other views
    bool across = false, down = false;
    explicit operator bool() const { return across || down; }
  };
  Lines linesAt(const QPointF& in_widget) const;  // that a press there takes hold of
  void dragLines(const QPointF& moved);
  void showCursor(const QPointF& in_widget);

  SliceAxis axis_;
  std::shared_ptr<VolumeMirror> mirror_;
  VolumeMirror::Reader news_;
  const SliceColours& colours_;
  GridGeometry stack_;
  int slice_ = 0;
  Vec3 point_mm_{0.0};
  QImage image_;
  QRect part_;  // of the slice's pixels, in the image
  bool stale_ = true;
  int drawn_ = 0;

  Toolbox& toolbox_;
  ViewTool* used_ = nullptr;  // while the button is down
  std::vector<ToolView> tools_;
  std::vector<Measure> measures_;
  std::optional<QPointF> pointer_;
  QPointF pressed_;
  enum class Drag { none, lines, workspace } drag_ = Drag::none;  // without a tool
  std::vector<WorkspaceBox> workspaces_;
  Vec3 workspace_before_mm_{0.0};  // where it was taken hold of
  Lines held_;
  Vec3 point_before_mm_{0.0};
  int turned_ = 0;  // of the wheel, since the last whole notch
};

}  // namespace trephine
