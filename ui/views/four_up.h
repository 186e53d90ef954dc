// The case from every side: the 3-D view and the axial, coronal and sagittal slices, all from one
// mirror of the voxels. Four of one size, one large with three small, or one alone; the user's
// choice is remembered from one session to the next.
#pragma once

#include <QAction>
#include <QSlider>
#include <array>

#include "ui/views/slice_bar.h"
#include "ui/views/slice_view.h"
#include "ui/views/view_widget.h"

namespace trephine {

struct ViewLayout {
  enum class Kind { single, four, one_large };
  Kind kind = Kind::single;
  int large = 0;  // 0: 3-D, 1 to 3: axial, coronal, sagittal
  friend bool operator==(const ViewLayout&, const ViewLayout&) = default;
};

class FourUp : public QWidget {
  Q_OBJECT
 public:
  static constexpr int kViews = 4;

  explicit FourUp(QWidget* parent = nullptr);

  ViewWidget& threeD() { return *three_d_; }
  SliceView& slice(SliceAxis axis) { return *slices_[std::size_t(axis)].view; }
  QList<QAction*> layoutActions() const { return {four_, one_large_, single_}; }

  // These voxels from now on, in every view; or all of them again, of the same place. `whole` is
  // what they are before anything is cut: what is cut from then on is shown as cut while it is
  // kept.
  void showVolume(Volume copy, const std::shared_ptr<const LabelMap>& labels,
                  const std::shared_ptr<const Volume>& whole = nullptr);
  void refill(const std::shared_ptr<const Volume>& whole,
              const std::shared_ptr<const LabelMap>& labels);
  // What the writer changed since the last call, once for all views.
  void pullChanges(Grid& grid) {
    if (mirror_->pull(grid)) changed();
  }
  const VolumeMirror& mirror() const { return *mirror_; }

  // Of the slices; the 3-D view has its own.
  void setTissues(const TissueSet& tissues, const TissueLooks& looks = {});
  // While a threshold is moved: which voxels the tissue has, gains and loses, over the slices.
  void setMark(const std::optional<SliceColours::Mark>& mark);
  // Another anatomy than before is looked at with its usual HU window.
  void setAnatomy(const std::string& anatomy) {
    if (std::exchange(anatomy_, anatomy) != anatomy) setWindow(usualWindow(anatomy));
  }
  void setTools(const std::vector<ToolView>& tools) {
    for (const Slices& of : slices_) of.view->setTools(tools);
  }
  // The point that all slices show; outside the case, the nearest in it.
  void setPoint(const Vec3& patient_mm);
  const Vec3& point_mm() const { return point_mm_; }
  const SliceColours& colours() const { return colours_; }
  // While an exercise runs a double click in the 3-D view is a hand's.
  void setTraining(bool training) { training_ = training; }

  // What the mouse does in the slices and in 3-D.
  Toolbox& toolbox() { return toolbox_; }
  // Rulers and angles on the slices, as "Ruler 19.0 mm, Axial 12".
  QStringList measureWords() const;
  // Where arms reach, in all four; the chosen one is dragged in the slices.
  void setWorkspaces(const std::vector<WorkspaceBox>& boxes);
  // Above the views: what lies over them stays below it.
  const QWidget* bar() const { return bar_; }
  void setOverlay(Overlay overlay, double opacity);
  // Other labels of the same voxels; labelsChanged() of each box that is changed in them.
  void showLabels(const std::shared_ptr<const LabelMap>& labels);
  void labelsChanged(const VoxelBox& box);

  // Each workspace has the layout that a person chose in it, `fallback` until then. It comes once
  // the 3-D view has painted for the first time, unless another was set by then.
  void useLayoutOf(const char* workspace, const ViewLayout& fallback);
  // Not remembered: that is the user's choice alone.
  void setLayout(const ViewLayout& layout);
  const ViewLayout& viewLayout() const { return layout_; }

  // While one of these lives the views keep their places: what happens around them changes their
  // room several times, and each time the 3-D view would be drawn anew.
  class Still {
   public:
    explicit Still(FourUp& views) : views_(views) { ++views_.still_; }
    ~Still() {
      if (--views_.still_ == 0) views_.arrange();
    }
    Still(const Still&) = delete;
    Still& operator=(const Still&) = delete;

   private:
    FourUp& views_;
  };

  // What mouse and keys do in the views, for the page of keys: a title and sentences each.
  static QList<QPair<QString, QString>> helpOfViews();

 signals:
  // What mouse and keys do where the focus went; empty in the 3-D view.
  void helpChanged(const QString& words);
  void workspaceMoved(const trephine::Vec3& centre_mm, bool done);  // as SliceView has it

 protected:
  void resizeEvent(QResizeEvent*) override { arrange(); }
  void paintEvent(QPaintEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;
  void takeKeys(QWidget* view);

 private:
  struct Slices {
    QWidget* box;
    SliceView* view;
    QSlider* slider;
  };
  static QString sliceHelp();
  QAction* makeAction(const char* name, const QString& text, Qt::Key key, const QString& tip);
  Slices makeSlices(SliceAxis axis);
  QWidget* box(int view) const;
  void choose(ViewLayout::Kind kind);
  void enlarge(int view);
  void choose(const ViewLayout& layout);
  void restore();
  void arrange();
  void focusLarge();
  void changed();
  void setWindow(const HuWindow& window);

  Toolbox toolbox_;
  int still_ = 0;
  std::shared_ptr<VolumeMirror> mirror_ = std::make_shared<VolumeMirror>();
  SliceColours colours_;
  std::string anatomy_;
  ViewWidget* three_d_;
  std::array<Slices, 3> slices_;
  SliceBar* bar_;
  QAction *four_, *one_large_, *single_;
  Vec3 point_mm_{0.0};
  ViewLayout layout_, before_{ViewLayout::Kind::four, 0};
  QString workspace_{"prepare"};
  ViewLayout fallback_;
  bool layout_used_ = false;  // of a workspace
  bool painted_ = false, restored_ = false;
  bool training_ = false;
};

}  // namespace trephine
