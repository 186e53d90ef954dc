// What the exercise asks for, and how it goes: goal, steps and hands of its card; the time; what
// was removed of each tissue and structure.
#pragma once

#include <QLabel>
#include <QPushButton>
#include <QWidget>
#include <array>
#include <vector>

#include "exercise/exercise.h"

namespace trephine {

// In whole words: 1240 mm3 as "1.24 mL".
QString volumeWords(double mm3);

struct RemovedOf {
  QString name;
  QColor colour;
  double mm3 = 0.0;
};

// What is of no tissue of the exercise, or lies at an edge.
RemovedOf unnamedRemoved(double mm3);

class ExercisePanel : public QWidget {
  Q_OBJECT
 public:
  explicit ExercisePanel(QWidget* parent = nullptr);

  void setExercise(const Exercise& exercise, const QString& language);
  void showTime(double seconds);
  // By arm, as Exercise::toolOf counts them.
  void showTools(const Exercise& exercise, const std::array<std::int32_t, kMaxArms>& in_hand);
  // Rows of nothing removed are left out.
  void showRemoved(const std::vector<RemovedOf>& tissues, const std::vector<RemovedOf>& structures);
  void showIdle();
  // The goal stands on a card over the views meanwhile, or all that is to be done.
  void setSaidOnCard(bool goal, bool all);
  // A button with these words brings back the card or the result that was put aside; empty: none.
  void offerCard(const QString& words);
  // The way back to Prepare, of an exercise that is tried.
  void offerBack(bool offered) { back_->setVisible(offered); }

 signals:
  void cardWanted();
  void backWanted();

 private:
  QPushButton *card_, *back_;
  QWidget* asked_;
  QLabel *title_, *goal_, *steps_, *tools_, *hands_, *time_, *removed_, *keys_;
};

// The card's steps, numbered, as rich text.
QString stepsWords(const CardText& card);
// Which tool is in which hand, as the exercise has it: "Right arm: burr, 6 mm".
QString toolWords(const Exercise& exercise, const std::array<std::int32_t, kMaxArms>& in_hand = {});

}  // namespace trephine
