// What stands over the view before an exercise: its goal, its steps, which tool is in which hand
// and how to move it, and the button that starts it; or, without a case, where to get one.
#pragma once

#include <QLabel>
#include <QPushButton>

#include "exercise/exercise.h"
#include "ui/common/floating_card.h"

namespace trephine {

class StartCard : public FloatingCard {
  Q_OBJECT
 public:
  explicit StartCard(QWidget& over);

  void showNoCase();
  void showExercise(const Exercise& exercise, const QString& language, bool may_start);
  QPushButton& asideButton() { return *aside_; }
  // Whether there is room for the steps and the hands beside the goal.
  bool saysAll() const;

 signals:
  void startWanted();
  void caseWanted();
  void asideWanted();
  void fitted();  // saysAll() may be another

 protected:
  void fit(int width, int most_height) override;

 private:
  QLabel *title_, *goal_, *steps_, *hands_, *keys_;
  QPushButton *start_, *choose_, *aside_;
};

}  // namespace trephine
