// The tissues over the histogram of the case: counting it, and moving a threshold there. Between
// the histogram, the panel of tissues, the views and the workstation.
#pragma once

#include <QObject>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ui/common/background_task.h"
#include "ui/prepare/tissue_picture.h"
#include "ui/tissue/histogram_view.h"
#include "ui/tissue/tissue_panel.h"
#include "ui/work/case_views.h"

namespace trephine {

class ThresholdTab : public QObject {
  Q_OBJECT
 public:
  ThresholdTab(Workstation& workstation, CaseViews& case_views, HistogramView& histogram,
               TissuePanel& tissues, TissuePicture& picture, QObject* parent);

  // The histogram shows the tissues as they are.
  void refresh();
  // They were edited: so does the picture, and the slices mark what a moved threshold takes.
  void follow();

 signals:
  void structuresNamed(const std::vector<std::string>& names);  // those of the open case

 private:
  void countVoxels();
  void begin();
  void move(std::size_t tissue, RangeEnd end, int hu, bool alone);
  void end();

  Workstation& workstation_;
  FourUp* views_;
  HistogramView& histogram_;
  TissuePanel& tissues_;
  TissuePicture& picture_;
  struct Counted {  // of which the histogram is, or is being counted
    std::weak_ptr<const Volume> voxels;
    std::weak_ptr<const LabelMap> labels;
    bool labelled = false;
  };
  Counted counted_;
  // A threshold is being moved, of this tissue, since the set was this one.
  struct Moving {
    TissueTable before;
    std::string tissue;
  };
  std::optional<Moving> moving_;
  BackgroundTask counting_;
};

}  // namespace trephine
