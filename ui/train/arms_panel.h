// Both arms' state while an exercise runs: what they touch, the force against its limit, force and
// energy of the last ten seconds, what the controller does to them, their faults; whether the steps
// are on time. Words first, numbers second.
#pragma once

#include <QComboBox>
#include <QLabel>
#include <QVBoxLayout>
#include <QWidget>
#include <vector>

#include "exercise/exercise.h"
#include "haptics/haptic_loop.h"
#include "session/energy_watch.h"
#include "session/soft_watch.h"
#include "ui/train/force_bar.h"
#include "ui/train/trace_view.h"

namespace trephine {

class ArmsPanel : public QWidget {
  Q_OBJECT
 public:
  explicit ArmsPanel(QWidget* parent = nullptr);

  // One card an arm of the exercise.
  void setExercise(const Exercise& exercise);
  // The newest state; `limits_N` by arm.
  void showState(const LoopState& state, const TissueSet& tissues,
                 const std::vector<double>& limits_N);
  // With every picture, for the traces.
  void follow(const LoopState& state);
  // The recording can no longer be written; until setExercise() or showIdle().
  void showUnrecorded();
  void showIdle();
  // Why the controller may not be changed; empty: it may.
  void setLocked(const QString& why);
  void showController(std::optional<ControllerKind> kind);  // none: no exercise says which

 signals:
  void controllerWanted(trephine::ControllerKind kind);
  void toolWanted(std::size_t arm, std::size_t tool);  // Exercise::toolOf

 private:
  struct Card {
    QLabel *contact, *position, *force, *demanded, *energy, *parts, *faults;
    QComboBox* tool;
    QLabel* tool_waits;
    ForceBar* bar;
    TraceView *force_trace, *energy_trace;
    double device_per_model;  // energy
    EnergyWatch watch;
    SoftWatch soft;
  };
  Card addCard(const Exercise& exercise, std::size_t index);
  static void showTool(Card& card, std::int32_t in_hand, std::int32_t wanted);

  QVBoxLayout* cards_layout_;
  std::vector<QWidget*> card_widgets_;
  std::vector<Card> cards_;
  double period_s_ = 0.001;
  QComboBox* controller_;
  QLabel *missed_, *dropped_, *journal_;
  std::uint64_t traced_tick_ = 0;
};

// "Left arm".
QString armName(const ExerciseArm& arm);
// While another tool waits for the one in hand to be out of tissue.
QString toolWaitsWords();
// How what is felt follows from what the tissue does: "Felt as the tissue is."
QString forceScaleWords(const ExerciseArm& arm);

}  // namespace trephine
