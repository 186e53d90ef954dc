#include "ui/prepare/threshold_tab.h"

#include <algorithm>

namespace trephine {

ThresholdTab::ThresholdTab(Workstation& workstation, CaseViews& case_views,
                           HistogramView& histogram, TissuePanel& tissues, TissuePicture& picture,
                           QObject* parent)
    : QObject(parent),
      workstation_(workstation),
      views_(&case_views.views()),
      histogram_(histogram),
      tissues_(tissues),
      picture_(picture) {
  connect(&histogram_, &HistogramView::dragBegan, this, &ThresholdTab::begin);
  connect(&histogram_, &HistogramView::thresholdMoved, this, &ThresholdTab::move);
  connect(&histogram_, &HistogramView::dragEnded, this, &ThresholdTab::end);
  connect(&histogram_, &HistogramView::tissueChosen, this,
          [this](std::size_t tissue) { tissues_.select(tissue); });
  connect(&tissues_, &TissuePanel::chosenChanged, this, &ThresholdTab::refresh);
  connect(&tissues_, &TissuePanel::overlapsShown, &histogram_, &HistogramView::showOverlaps);
  connect(&case_views, &CaseViews::caseShown, this, &ThresholdTab::countVoxels);
  connect(&workstation_, &Workstation::structuresChanged, this, &ThresholdTab::countVoxels);
  connect(&counting_, &BackgroundTask::ended, this, &ThresholdTab::countVoxels,
          Qt::QueuedConnection);
}

// In the background, and again where the case has other labels meanwhile.
void ThresholdTab::countVoxels() {
  const Case* of = workstation_.currentCase();
  if (!of || counting_.busy()) return;
  const std::shared_ptr<const LabelMap>& labels = workstation_.placed()->labels;
  const bool same_voxels = counted_.voxels.lock() == of->volume;
  const bool labelled = labels != nullptr;
  if (same_voxels && counted_.labelled == labelled && counted_.labels.lock() == labels) return;
  if (!same_voxels) histogram_.setHistogram(nullptr);
  counted_ = {of->volume, labels, labelled};
  std::vector<std::string> names;
  if (labels) {
    for (const Structure& s : labels->structures) names.push_back(s.name);
  }
  tissues_.setStructures(names);
  emit structuresNamed(names);
  counting_.run(
      [volume = of->volume, labels](const Progress& progress) {
        return histogramOf(*volume, labels.get(), progress);
      },
      [this](Result<HuHistogram> counted) {
        if (!counted) return;
        histogram_.setHistogram(std::make_shared<const HuHistogram>(*std::move(counted)));
        refresh();
      });
}

void ThresholdTab::refresh() {
  if (!workstation_.exercise()) return;
  histogram_.setTissues(workstation_.placedTissues(), tissues_.chosen());
  histogram_.setLocked(tissues_.isLocked());
  tissues_.setShares(histogram_.shares());
}

void ThresholdTab::begin() {
  if (!workstation_.exercise() || tissues_.isLocked()) return;
  tissues_.thresholdBegan();
  workstation_.closeEdit();
  moving_ = Moving{tissueTable(workstation_.placedTissues()), {}};
  picture_.followThreshold("");
}

void ThresholdTab::move(std::size_t tissue, RangeEnd end, int hu, bool alone) {
  if (!moving_ || tissue >= tissues_.tissues().tissues.size()) return;
  moving_->tissue = tissues_.tissues().tissues[tissue].id;
  picture_.followThreshold(moving_->tissue);
  tissues_.moveThreshold(tissue, end, hu, alone);
}

void ThresholdTab::end() {
  if (!moving_) return;
  moving_.reset();
  picture_.followThreshold({});
  views_->setMark({});
  workstation_.closeEdit();
  picture_.show();
}

void ThresholdTab::follow() {
  if (moving_) {
    const auto& all = workstation_.placedTissues().tissues;
    const auto at = std::ranges::find(all, moving_->tissue, &Tissue::id);
    const int tissue = int(at - all.begin());
    if (at != all.end()) views_->setMark(SliceColours::Mark{moving_->before, tissue, tissue});
  }
  refresh();
  // A moved threshold is seen in slices and histogram first: the 3-D picture takes its time.
  moving_ ? picture_.showSoon() : picture_.show();
}

}  // namespace trephine
