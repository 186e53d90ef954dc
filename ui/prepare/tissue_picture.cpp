#include "ui/prepare/tissue_picture.h"

#include <algorithm>

#include "tissue/tissue_edits.h"

namespace trephine {

TissuePicture::TissuePicture(Workstation& workstation, FourUp& views, TissuePanel& tissues,
                             StructurePanel& structures, StructureEditor& editor, QObject* parent)
    : QObject(parent),
      workstation_(workstation),
      views_(&views),
      view_(&views.threeD()),
      tissues_(tissues),
      structures_(structures),
      editor_(editor) {
  later_.setSingleShot(true);
  later_.setInterval(0);
  connect(&later_, &QTimer::timeout, this, &TissuePicture::show);
}

void TissuePicture::show() {
  if (!workstation_.exercise()) return;
  const std::shared_ptr<const LabelMap>& map = views_->mirror().labels();
  std::vector<Structure> rows;
  for (const Structure& s : map ? map->structures : std::vector<Structure>{}) {
    // One that has no voxel needs no room, unless it is about to be painted.
    const bool any = map != editor_.map() || editor_.millilitres(s.label) > 0.0;
    if (any || s.label == editor_.current()) rows.push_back(s);
  }
  const TissueSet& set = workstation_.placedTissues();
  // A label of the exercise's map may be another structure's: a shell has what the wall gave up.
  const std::shared_ptr<const LabelMap> own = editor_.map();
  std::erase_if(structure_looks_, [&](const auto& of) { return own && !own->find(of.first); });
  if (map != own) {
    std::erase_if(rows, [&](const Structure& s) {
      const Structure* there = own ? own->find(s.label) : nullptr;
      return structure_looks_.contains(s.label) && !(there && sameName(there->name, s.name));
    });
  }
  TissueLooks looks = workstation_.looks();
  if (moving_) return showMoving(rows, looks);
  handToTissues(structure_looks_, looks, set, rows);
  if (looks != workstation_.looks()) {
    workstation_.setLooks(looks);
    tissues_.setLooks(looks);
    views_->setTissues(set, looks);
  }
  SeenTissues seen = withStructures(set, looks, rows, structure_looks_, editor_.current());
  structures_.list().showLooks(seen.structures);
  if (seen_ && seen_->tissues == seen.tissues && seen_->looks == seen.looks) return;
  seen_ = std::move(seen);
  view_->setTissues(seen_->tissues, seen_->looks);
}

void TissuePicture::setLook(int label, TissueLook look) {
  structure_looks_[label].look = look;
  show();  // which hands it to a tissue of the exercise, where one is of it
}

void TissuePicture::setOpacity(int label, double per_mm) {
  structure_looks_[label].opacity = per_mm;
  show();
}

void TissuePicture::setColour(int label, const Vec3& colour) {
  structure_looks_[label].colour = colour;
  show();
}

void TissuePicture::yieldTo(const TissueSet& set) {
  const std::shared_ptr<const LabelMap> map = editor_.map();
  for (auto& [label, look] : structure_looks_) {
    const Structure* of = map ? map->find(label) : nullptr;
    if (!of) continue;
    for (const std::string& id : tissuesOf(set, *of)) {
      const Tissue* before = workstation_.tissues().find(id);
      if (!before) continue;
      if (before->opacity != set.find(id)->opacity) look.opacity.reset();
      if (before->colour != set.find(id)->colour) look.colour.reset();
    }
  }
}

void TissuePicture::followThreshold(std::optional<std::string> tissue) {
  moving_ = std::move(tissue);
  if (!moving_) later_.stop();
}

void TissuePicture::showMoving(const std::vector<Structure>& rows, const TissueLooks& looks) {
  const TissueSet& set = workstation_.placedTissues();
  TissueLooks alone;
  for (const Tissue& tissue : set.tissues) {
    const TissueLook look = lookOf(tissue, looks);
    alone[tissue.id] = tissue.id == *moving_        ? TissueLook::shown
                       : look == TissueLook::hidden ? TissueLook::hidden
                                                    : TissueLook::ghosted;
  }
  SeenTissues seen = withStructures(set, alone, rows, structure_looks_, editor_.current());
  for (Tissue& tissue : seen.tissues.tissues) {
    if (tissue.id == *moving_) tissue.opacity = std::max(tissue.opacity, kSeenOpacity);
  }
  seen_ = std::move(seen);
  view_->setTissues(seen_->tissues, seen_->looks);
}

}  // namespace trephine
