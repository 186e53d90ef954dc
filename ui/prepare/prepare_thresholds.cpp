// The tissues over the histogram of the case: counting it, and what is shown while a threshold is
// moved.
#include <algorithm>

#include "exercise/structure_view.h"
#include "ui/prepare/prepare_workspace.h"

namespace trephine {

void PrepareWorkspace::connectThresholds() {
  connect(histogram_, &HistogramView::dragBegan, this, &PrepareWorkspace::thresholdBegan);
  connect(histogram_, &HistogramView::thresholdMoved, this, &PrepareWorkspace::thresholdMoved);
  connect(histogram_, &HistogramView::dragEnded, this, &PrepareWorkspace::thresholdEnded);
  connect(histogram_, &HistogramView::tissueChosen, this,
          [this](std::size_t tissue) { tissues_->select(tissue); });
  connect(tissues_, &TissuePanel::chosenChanged, this, &PrepareWorkspace::showHistogram);
  connect(tissues_, &TissuePanel::overlapsShown, histogram_, &HistogramView::showOverlaps);
  connect(&app_, &AppContext::caseShown, this, &PrepareWorkspace::countVoxels);
  connect(&workstation_, &Workstation::structuresChanged, this, &PrepareWorkspace::countVoxels);
  seen_later_.setSingleShot(true);
  seen_later_.setInterval(0);
  connect(&seen_later_, &QTimer::timeout, this, &PrepareWorkspace::showSeen);
  connect(&counting_, &BackgroundTask::ended, this, &PrepareWorkspace::countVoxels,
          Qt::QueuedConnection);
}

// In the background, and again where the case has other labels meanwhile.
void PrepareWorkspace::countVoxels() {
  const Case* of = workstation_.currentCase();
  if (!of || counting_.busy()) return;
  const std::shared_ptr<const LabelMap>& labels = workstation_.placed()->labels;
  const bool same_voxels = counted_.voxels.lock() == of->volume;
  const bool labelled = labels != nullptr;
  if (same_voxels && counted_.labelled == labelled && counted_.labels.lock() == labels) return;
  if (!same_voxels) histogram_->setHistogram(nullptr);
  counted_ = {of->volume, labels, labelled};
  std::vector<std::string> names;
  if (labels) {
    for (const Structure& s : labels->structures) names.push_back(s.name);
  }
  tissues_->setStructures(names);
  form_->setStructures(names);
  counting_.run(
      [volume = of->volume, labels](const Progress& progress) {
        return histogramOf(*volume, labels.get(), progress);
      },
      [this](Result<HuHistogram> counted) {
        if (!counted) return;
        histogram_->setHistogram(std::make_shared<const HuHistogram>(*std::move(counted)));
        showHistogram();
      });
}

void PrepareWorkspace::showHistogram() {
  if (!workstation_.exercise()) return;
  histogram_->setTissues(workstation_.placedTissues(), tissues_->chosen());
  histogram_->setLocked(tissues_->isLocked());
  tissues_->setShares(histogram_->shares());
}

void PrepareWorkspace::thresholdBegan() {
  if (!workstation_.exercise() || tissues_->isLocked()) return;
  tissues_->thresholdBegan();
  workstation_.closeEdit();
  moving_ = Moving{tissueTable(workstation_.placedTissues()), {}};
}

void PrepareWorkspace::thresholdMoved(std::size_t tissue, RangeEnd end, int hu, bool alone) {
  if (!moving_ || tissue >= tissues_->tissues().tissues.size()) return;
  moving_->tissue = tissues_->tissues().tissues[tissue].id;
  tissues_->moveThreshold(tissue, end, hu, alone);
}

void PrepareWorkspace::thresholdEnded() {
  if (!moving_) return;
  moving_.reset();
  seen_later_.stop();
  views_->setMark({});
  workstation_.closeEdit();
  showSeen();
}

void PrepareWorkspace::markMoving(int tissue) {
  views_->setMark(SliceColours::Mark{moving_->before, tissue, tissue});
}

void PrepareWorkspace::showMoving(const std::vector<Structure>& rows, const TissueLooks& looks) {
  const TissueSet& set = workstation_.placedTissues();
  TissueLooks alone;
  for (const Tissue& tissue : set.tissues) {
    const TissueLook look = lookOf(tissue, looks);
    alone[tissue.id] = tissue.id == moving_->tissue  ? TissueLook::shown
                       : look == TissueLook::hidden ? TissueLook::hidden
                                                    : TissueLook::ghosted;
  }
  SeenTissues seen = withStructures(set, alone, rows, structure_looks_);
  for (Tissue& tissue : seen.tissues.tissues) {
    if (tissue.id == moving_->tissue) tissue.opacity = std::max(tissue.opacity, kSeenOpacity);
  }
  seen_ = std::move(seen);
  view_->setTissues(seen_->tissues, seen_->looks);
}

}  // namespace trephine
