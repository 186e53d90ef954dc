// The exercise's tissues: the set and what is done with it (tissue_set_row.h), its list, and the
// one that is chosen (tissue_form.h). A set that is not possible is not applied.
#pragma once

#include <QLabel>
#include <QPushButton>
#include <QWidget>
#include <functional>
#include <optional>

#include "exercise/arm_limits.h"
#include "haptics/controllers.h"
#include "tissue/tissue_edits.h"
#include "tissue/tissue_look.h"
#include "tissue/tissue_set.h"
#include "ui/tissue/tissue_form.h"
#include "ui/tissue/tissue_list.h"
#include "ui/tissue/tissue_set_row.h"

namespace trephine {

class TissuePanel : public QWidget {
  Q_OBJECT
 public:
  explicit TissuePanel(QWidget* parent = nullptr);

  // `declared` is the set as its file has it: which HU had a tissue, and where numbers come from.
  void setTissues(const TissueSet& tissues, const TissueSet& declared);
  void setTissues(const TissueSet& tissues) { setTissues(tissues, tissues); }
  const TissueSet& tissues() const { return tissues_; }
  // How the view shows them; a preset that the set has nothing for is not offered.
  void setLooks(const TissueLooks& looks);
  void select(const std::string& id);
  void select(std::size_t tissue) { list_->select(int(tissue)); }
  std::size_t chosen() const { return std::size_t(std::max(0, list_->current())); }
  // How much of the case each has.
  void setShares(const TissueShares& shares) { list_->setShares(shares); }
  // Why numbers, colours and opacities may not be changed; empty: they may.
  void setLocked(const QString& why);
  bool isLocked() const { return !locked_.isEmpty(); }
  // Without a label map a tissue can be freed from a label, but not restricted to one.
  void setLabelsOpen(bool open);
  // Of the case: a tissue can be restricted to one.
  void setStructures(const std::vector<std::string>& names) { form_->setStructures(names); }
  // What the arms show, and what the exercise's `laws` together demand of a tissue: what lies above
  // is said to be felt as that under `bounded`, and to be bounded by nothing under the others.
  // `in_force` is the controller now.
  void setRenderable(const std::optional<ArmsLimit>& most,
                     std::function<Impedance(const Tissue&)> demanded,
                     const std::vector<LawKind>& laws, RemovalKind removal,
                     ControllerKind in_force);
  // What the arms' own friction hides of the chosen one, in lines; empty: nothing.
  void setHidden(const QString& words);
  TissueSetRow& sets() { return *sets_; }
  void showPoke(bool possible, bool poking);

  // --- The thresholds over the histogram ---
  void thresholdBegan() { before_ = tissues_; }
  void moveThreshold(std::size_t tissue, RangeEnd end, int hu, bool alone);

 signals:
  // A possible set, changed by a person; `what`: edits of the same that follow one another are one,
  // until editEnded().
  void tissuesChanged(const trephine::TissueSet& tissues, const QString& what);
  void editEnded();
  // Looks chosen by a person: no change of a tissue.
  void looksChanged(const trephine::TissueLooks& looks);
  void chosenChanged();
  // Of a range that was refused; empty: none is.
  void overlapsShown(const std::vector<trephine::HuOverlap>& overlaps);
  void pokeWanted();

 private:
  void showSelected();
  void showFelt();
  void add();
  void remove();
  Status applySet(const TissueSet& set, const QString& what);
  const Tissue* current() const;

  TissueSet tissues_, declared_, before_;
  TissueLooks looks_;
  QString locked_;
  TissueSetRow* sets_;
  QPushButton* poke_;
  TissueList* list_;
  TissueForm* form_;
  QLabel *locked_words_, *felt_, *hidden_;
};

}  // namespace trephine
