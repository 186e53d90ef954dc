// The outline of an exercise: drawn by clicks, its points one by one, and the landmark that it goes
// with. Points are shown and changed where they lie in the case that is open.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QToolButton>
#include <QWidget>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "exercise/exercise.h"
#include "ui/common/number_rows.h"

namespace trephine {

// For the fields of one point.
struct OutlinePoint {
  Vec3 at_mm{0.0};
};

class OutlineForm : public QWidget {
  Q_OBJECT
 public:
  explicit OutlineForm(QWidget* parent = nullptr);

  // `landmarks`: as they are placed in the open case; empty: the points are shown as they were
  // drawn.
  void show(const Exercise& exercise, const std::vector<PlacedLandmark>& landmarks);
  // Clicks on the surface add points.
  void showDrawing(bool drawing);
  // What was refused was of another exercise.
  void forgetRefusal() { problem_->hide(); }

  // A person wants this change of the exercise as it is then; `what` of it.
  std::function<Status(const std::string& what, const std::function<void(Exercise&)>& change)>
      wanted;

 signals:
  void drawingWanted(bool on);

 private:
  QWidget* buildButtons(QWidget* parent);
  void edit(const std::string& what, const std::function<void(Exercise&)>& change);
  // As it lies here, changed.
  void editHere(const std::string& what, const std::function<void(ExerciseOutline&)>& change);
  void takeOff(std::size_t point);
  void goWith(const std::string& landmark);
  void showPoint();

  std::optional<ExerciseOutline> here_;
  std::vector<PlacedLandmark> landmarks_;
  bool showing_ = false;
  QLabel *problem_, *count_;
  QToolButton *draw_, *clear_, *back_, *point_off_;
  QCheckBox* closed_;
  QComboBox* landmark_;
  WholeNumberField* point_;
  std::unique_ptr<NumberRows<OutlinePoint>> place_;
  std::unique_ptr<NumberRows<ExerciseOutline>> width_;
};

}  // namespace trephine
