// The scene's tissues: a list with colour and look, presets of looks, and the numbers of the one
// that is selected. What is not a possible number or set is refused in words beside the field and
// not applied; HU that have lost their tissue are mentioned.
#pragma once

#include <QLabel>
#include <QListWidget>
#include <QSlider>
#include <QToolButton>
#include <QWidget>
#include <functional>
#include <optional>

#include "haptics/controllers.h"
#include "tissue/tissue_look.h"
#include "tissue/tissue_set.h"
#include "ui/common/number_field.h"
#include "ui/tissue/look_box.h"

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
  // Why numbers, colours and opacities may not be changed; empty: they may.
  void setLocked(const QString& why);
  // Without a label map a tissue can be freed from a label, but not restricted to one.
  void setLabelsOpen(bool open);
  // The firmest tissue that the arms show, and what the scene's laws together demand of one: what
  // lies above the first is said to be felt as that under `bounded`, and to be bounded by nothing
  // under the others. `in_force` is the controller now.
  void setRenderable(const std::optional<Renderable>& most,
                     std::function<Impedance(const Tissue&)> demanded, ControllerKind in_force);

 signals:
  // A possible set, changed by a person.
  void tissuesChanged(const trephine::TissueSet& tissues);
  // Looks chosen by a person: no change of a tissue.
  void looksChanged(const trephine::TissueLooks& looks);

 private:
  struct Number {
    DecimalField* box;
    const TissueNumber* row;
  };
  void build();
  QLayout* buildPresets();
  QLayout* addNumber(const TissueNumber& row);
  void addItem();
  void lookChosen(const TissueLooks& looks);
  void showList();
  // Every field as the selected tissue is; what was typed and refused goes.
  void showSelected();
  // What follows from the numbers: texts beside fields, sources, HU without a tissue, what is felt.
  void showOutcome();
  void showGaps();
  void showFelt();
  void chooseColour();
  void rangeEntered();
  void numberEntered(const Number& number);
  // Puts it in the place of the selected one, where that makes a possible set.
  Status apply(const Tissue& wanted);
  const Tissue* current() const;
  const Tissue& declared(const Tissue& tissue) const;

  TissueSet tissues_, declared_;
  TissueLooks looks_;
  std::optional<Renderable> renderable_;
  std::function<Impedance(const Tissue&)> demanded_;
  ControllerKind in_force_ = ControllerKind::bounded;
  bool listing_ = false;
  bool labels_open_ = false;
  QString locked_;
  QLabel* locked_words_;
  QListWidget* list_;
  std::vector<LookBox*> look_boxes_;  // by row of the list
  QLabel* presets_title_;
  std::vector<std::pair<ViewPreset, QToolButton*>> presets_;
  QWidget* editor_;
  QLabel *title_, *opacity_text_, *gaps_, *felt_, *problem_;
  QToolButton* colour_;
  QSlider* opacity_;
  WholeNumberField *low_, *high_, *label_;
  std::vector<Number> numbers_;
};

// The slider is finer where tissues are nearly clear: position 0..1 against opacity per mm.
double opacityAtSlider(double position);
double sliderAtOpacity(double opacity);

}  // namespace trephine
