// The outline of an exercise: drawn by clicks, its points one by one, and the landmark that it goes
// with. Points are shown and changed where they lie in the case that is open.
#pragma once

#include <QComboBox>
#include <memory>
#include <optional>
#include <vector>

#include "exercise/exercise_fields.h"
#include "ui/common/number_field.h"
#include "ui/prepare/form_group.h"

namespace trephine {

// For the fields of one point.
struct OutlinePoint {
  Vec3 at_mm{0.0};
};

class OutlineForm : public FormGroup {
  Q_OBJECT
 public:
  OutlineForm(const ExerciseEdited& wanted, QWidget* parent);

  // `landmarks`: as they are placed in the open case; empty: the points are shown as they were
  // drawn.
  void show(const Exercise& exercise, const std::vector<PlacedLandmark>& landmarks);
  // Clicks on the surface add points.
  void showDrawing(bool drawing);

 signals:
  void drawingWanted(bool on);

 private:
  QWidget* buildButtons();
  void editOutline(const std::string& what, const std::optional<ExerciseOutline>& outline);
  void takeOff(std::size_t point);
  void goWith(const std::string& landmark);
  void showPoint();

  std::optional<ExerciseOutline> here_;  // as it lies in the open case
  std::vector<PlacedLandmark> landmarks_;
  QLabel* count_;
  QToolButton *draw_, *clear_, *back_, *point_off_;
  QComboBox* landmark_;
  WholeNumberField* point_;
  std::unique_ptr<FieldRows<OutlinePoint>> place_;
  std::unique_ptr<FieldRows<ExerciseOutline>> line_;
};

}  // namespace trephine
