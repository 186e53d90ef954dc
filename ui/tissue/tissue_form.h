// The numbers of one tissue of a set: name, colour, opacity, thresholds, where it is, what is felt.
// What is not possible is refused in words beside the field; HU that have lost their tissue are
// mentioned. It keeps no set: who shows one does.
#pragma once

#include <QLabel>
#include <QSlider>
#include <QToolButton>
#include <QWidget>
#include <functional>
#include <memory>

#include "tissue/tissue_edits.h"
#include "ui/common/field_rows.h"
#include "ui/common/number_field.h"
#include "ui/tissue/tissue_mechanics.h"

namespace trephine {

class TissueForm : public QWidget {
  Q_OBJECT
 public:
  explicit TissueForm(QWidget* parent = nullptr);

  // The tissue at that place of the set, every field; what was typed and refused goes. `declared`
  // is the set as its file has it.
  void show(const TissueSet& tissues, std::size_t at, const TissueSet& declared);
  // The same, but for what is typed: after it, or another of the set, was changed.
  void update(const TissueSet& tissues, std::size_t at);
  // Thresholds that were moved elsewhere.
  void showRange();
  // Without a label map a tissue can be freed from a label, but not restricted to one.
  void setLabelsOpen(bool open) { labels_open_ = open; }
  // Of the case: a tissue can be restricted to one.
  void setStructures(const std::vector<std::string>& names);
  TissueMechanics& mechanics() const { return *mechanics_; }
  // Null: nothing is wrong.
  void showProblem(const Error* why, const std::vector<HuOverlap>& overlaps = {});
  void takeTypedSource() { source_->takeTyped(); }  // a click of a button leaves it as it was
  void enterName();                                 // its text is selected

  // A person wants this instead: whoever keeps the set puts it there and calls update(), or refuses
  // it. `what`: edits of the same that follow one another are one, until editEnded().
  std::function<Status(const Tissue& wanted, const QString& what)> apply;

 signals:
  void editEnded();
  // Of a range that was refused; empty: none is.
  void overlapsShown(const std::vector<trephine::HuOverlap>& overlaps);

 private:
  void addLooks(QFormLayout& form);
  void addRange(QFormLayout& form);
  void addLabel(QFormLayout& form);
  std::unique_ptr<FieldRows<Tissue>> fieldsOf(FieldsOf<Tissue> fields, QFormLayout& form,
                                              const char* what);
  void showAll();
  // What follows from the numbers: texts beside fields, sources, HU without a tissue.
  void showOutcome();
  void showGaps();
  void showPlaces();
  void chooseColour();
  void rangeEntered();
  void structureChosen(const std::string& name);
  void shellEntered(const Tissue::Shell& shell);
  const Tissue* current() const;
  const Tissue& declared(const Tissue& tissue) const;

  TissueSet tissues_, declared_;
  std::size_t at_ = 0;
  bool labels_open_ = false;
  std::vector<std::string> structures_;
  std::string shown_;  // the tissue whose fields stand there
  std::unique_ptr<FieldRows<Tissue>> name_, source_, where_, within_;
  std::unique_ptr<FieldRows<Tissue::Shell>> shell_;
  QLabel *opacity_text_, *gaps_, *problem_;
  QToolButton* colour_;
  QSlider* opacity_;
  WholeNumberField *low_, *high_, *label_;
  TissueMechanics* mechanics_;
};

}  // namespace trephine
