// The exercise's tissues: the set and what is done with it, its list, and the numbers of the one
// that is chosen. What is not a possible number or set is refused in words beside the field and not
// applied; HU that have lost their tissue are mentioned. It keeps no set: who shows one does.
#pragma once

#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>
#include <QSlider>
#include <QToolButton>
#include <QWidget>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "exercise/arm_limits.h"
#include "haptics/controllers.h"
#include "tissue/tissue_edits.h"
#include "tissue/tissue_look.h"
#include "tissue/tissue_set.h"
#include "ui/common/field_rows.h"
#include "ui/common/number_field.h"
#include "ui/tissue/tissue_list.h"
#include "ui/tissue/tissue_mechanics.h"

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
  void setStructures(const std::vector<std::string>& names);
  // What the arms show, and what the exercise's `laws` together demand of a tissue: what lies above
  // is said to be felt as that under `bounded`, and to be bounded by nothing under the others.
  // `in_force` is the controller now.
  void setRenderable(const std::optional<ArmsLimit>& most,
                     std::function<Impedance(const Tissue&)> demanded,
                     const std::vector<LawKind>& laws, RemovalKind removal,
                     ControllerKind in_force);
  // Sets of this workstation, to be taken: a name and a file.
  void setSets(const std::vector<std::pair<QString, std::filesystem::path>>& sets);
  // What the last edit was; empty: there is none.
  void showHistory(const QString& undo, const QString& redo);
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
  void newSetWanted();
  void duplicateWanted();
  void importWanted();
  void exportWanted();
  void revertWanted();
  void setWanted(const std::filesystem::path& file);
  void setsWanted();  // the menu opens: setSets()
  void pokeWanted();
  void undoWanted();
  void redoWanted();

 private:
  void build();
  QLayout* buildSetRow();
  QWidget* buildEditor();
  // Every field as the selected tissue is; what was typed and refused goes.
  void showSelected();
  // What follows from the numbers: texts beside fields, sources, HU without a tissue, what is felt.
  void showOutcome();
  void showGaps();
  void showFelt();
  void showPlaces();
  void showProblem(const Error* why, const std::vector<HuOverlap>& overlaps);
  void chooseColour();
  void rangeEntered();
  void structureChosen(const std::string& name);
  void shellEntered(const Tissue::Shell& shell);
  void add();
  void remove();
  // Puts it in the place of the selected one, where that makes a possible set.
  Status apply(const Tissue& wanted, const QString& what);
  Status applySet(const TissueSet& set, const QString& what);
  const Tissue* current() const;
  const Tissue& declared(const Tissue& tissue) const;

  TissueSet tissues_, declared_, before_;
  TissueLooks looks_;
  std::optional<ArmsLimit> arms_;
  std::function<Impedance(const Tissue&)> demanded_;
  ControllerKind in_force_ = ControllerKind::bounded;
  bool labels_open_ = false;
  std::vector<std::string> structures_;
  QString locked_;
  QLineEdit* set_name_;
  std::unique_ptr<FieldRows<Tissue>> name_, source_, where_;
  std::unique_ptr<FieldRows<Tissue::Shell>> shell_;
  std::string shown_;  // the tissue whose fields stand there
  QToolButton *set_menu_, *undo_, *redo_;
  QMenu* sets_;
  QLabel* locked_words_;
  QPushButton* poke_;
  TissueList* list_;
  QWidget* editor_;
  QLabel *opacity_text_, *gaps_, *felt_, *problem_;
  QToolButton* colour_;
  QSlider* opacity_;
  WholeNumberField *low_, *high_, *label_;
  TissueMechanics* mechanics_;
};

// The slider is finer where tissues are nearly clear: position 0..1 against opacity per mm.
double opacityAtSlider(double position);
double sliderAtOpacity(double opacity);

}  // namespace trephine
