// Over the lower edge of the view while the mouse is a hand: which hand it has with which tool,
// what that touches and how hard it presses. Legible from two metres.
#pragma once

#include <QBoxLayout>
#include <QLabel>

#include "exercise/exercise.h"
#include "tissue/tissue_set.h"
#include "ui/common/floating_card.h"
#include "ui/train/force_bar.h"

namespace trephine {

class HandBar : public FloatingCard {
  Q_OBJECT
 public:
  explicit HandBar(QWidget& over);

  void setTissues(const TissueSet& tissues);
  // `waits`: another tool is wanted, and comes once this one is out of tissue. `touches`: a
  // tissue's name; empty: nothing. `at_edge`: the arm is at the edge of its workspace, and pressing
  // does nothing there.
  void showHand(const QString& hand, const QColor& colour, const QString& tool, bool waits,
                double push_N, double most_N, const QString& touches, bool at_edge);

 private:
  void fit(int width, int most_height) override;

  QBoxLayout* lines_;  // hand and tool beside the push, or above it where that is too wide
  QLabel *hand_, *tool_, *touches_, *push_, *waits_;
  ForceBar* bar_;
};

// "Left hand".
QString handName(const ExerciseArm& arm);

}  // namespace trephine
