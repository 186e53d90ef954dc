// What an exercise came to, over the view: what was removed of what, the time, the way of the
// tools, and what can be done next.
#pragma once

#include <QLabel>
#include <QPushButton>

#include "session/run_report.h"
#include "ui/common/floating_card.h"
#include "ui/train/exercise_panel.h"

namespace trephine {

struct ExerciseResult {
  QString exercise, goal;
  double seconds = 0.0;
  std::vector<RemovedOf> tissues;
  double unnamed_mm3 = 0.0;  // that was removed, of none of these
  std::vector<CutStructure> structures;
  struct Way {
    QString hand;
    double mm = 0.0;
    double most_N = 0.0;  // sent
  };
  std::vector<Way> ways;
  bool recorded = true;  // whole
  std::uint64_t late = 0;
  std::uint64_t undos = 0, rewinds = 0;
  double brought_back_mm3 = 0.0;  // that was cut and put back
};

class ResultPage : public FloatingCard {
  Q_OBJECT
 public:
  explicit ResultPage(QWidget& over);

  void setResult(const ExerciseResult& result);

 signals:
  void againWanted();
  void replayWanted();
  void lookWanted();  // at the tissue as it was left

 private:
  QLabel *title_, *goal_, *time_, *rows_;
  QPushButton *again_, *replay_, *look_;
};

}  // namespace trephine
