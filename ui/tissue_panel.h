// The scene's tissues: a list with colour and opacity, and the numbers of the one that is selected.
// What is not a possible set is said in words and not applied.
#pragma once

#include <QLabel>
#include <QListWidget>
#include <QSlider>
#include <QSpinBox>
#include <QToolButton>
#include <QWidget>

#include <functional>
#include <optional>

#include "haptics/arm_dynamics.h"
#include "tissue/tissue_set.h"

namespace trephine {

class TissuePanel : public QWidget {
  Q_OBJECT
 public:
  explicit TissuePanel(QWidget* parent = nullptr);

  void setTissues(const TissueSet& tissues);
  const TissueSet& tissues() const { return applied_; }
  void select(const std::string& id);
  // Without a label map a tissue can be freed from a label, but not restricted to one.
  void setLabelsOpen(bool open);
  // The firmest tissue that the arms show, and what the scene's laws together demand of one: what
  // lies above the first is said to be felt as that.
  void setRenderable(const std::optional<Renderable>& most,
                     std::function<Impedance(const Tissue&)> demanded);

 signals:
  // A possible set, changed by a person.
  void tissuesChanged(const trephine::TissueSet& tissues);

 private:
  struct Number {
    QDoubleSpinBox* box;
    SourcedNumber Tissue::*field;
  };
  void build();
  QDoubleSpinBox* addNumber(const char* name, const QString& unit, double most, double step,
                            SourcedNumber Tissue::*field);
  void showList();
  void showSelected();
  void showFelt();
  void chooseColour();
  // Takes what the controls say into the set that is being edited, and applies it when possible.
  void edited();
  Tissue* current();

  TissueSet edited_;   // what the controls say
  TissueSet applied_;  // the last possible one
  std::optional<Renderable> renderable_;
  std::function<Impedance(const Tissue&)> demanded_;
  bool showing_ = false;
  bool labels_open_ = false;
  QListWidget* list_;
  QWidget* editor_;
  QLabel *title_, *opacity_text_, *felt_, *problem_;
  QToolButton* colour_;
  QSlider* opacity_;
  QSpinBox *low_, *high_, *label_;
  std::vector<Number> numbers_;
};

// The slider is finer where tissues are nearly clear: position 0..1 against opacity per mm.
double opacityAtSlider(double position);
double sliderAtOpacity(double opacity);

}  // namespace trephine
