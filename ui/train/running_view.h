// What is shown while an exercise runs: the tools with every picture; numbers, as often as they can
// be read; cards for a headset; how often pictures and forces come. The undo or rewind that is
// asked for here is waited for, and what came of it is said. Window's thread.
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "exercise/cut_tally.h"
#include "ui/headset/eye_cards.h"
#include "ui/train/arms_panel.h"
#include "ui/train/exercise_panel.h"
#include "ui/train/pointer_hands.h"
#include "ui/train/rewind_bar.h"
#include "ui/train/state_notice.h"
#include "ui/work/app_context.h"

namespace trephine {

class RunningView : public QObject {
  Q_OBJECT
 public:
  struct Panels {
    ArmsPanel& arms;
    StateNotice& notice;
    RewindBar& rewind;
    ExercisePanel& exercise;
  };

  // Panels and hands outlive it.
  RunningView(AppContext& app, const Panels& panels, const PointerHands& hands, QObject* parent);

  // An exercise has started; it has ended, as it is shown last.
  void begin(Session& session);
  void end(Session& session);
  // What moves: with every picture.
  void showPicture(Session& session, const LoopState& state);
  // What changes more slowly, where it is due. With `all` it is, but for the rates, which are of
  // the true clock.
  void showNumbers(Session& session, const LoopState& state, bool all);
  // Somebody reads the state as cards (cardsChanged).
  void setCardsWanted(bool wanted) { cards_wanted_ = wanted; }
  // Of the session that runs; nothing without one. `which`: undo or redo.
  void undo(CommandKind which);
  void rewind(std::uint32_t second);

 signals:
  void stateShown(const trephine::LoopState& state);  // while a session runs
  void ratesChanged(const QString& words);
  void cardsChanged(const std::vector<trephine::EyeCard>& cards);

 private:
  void showTools(const std::vector<ToolView>& tools);
  void showState(Session& session, const LoopState& state, bool all);
  void tellCards(const Session& session, const LoopState& state);
  void showRemoved(const Session& session, bool all);
  void showRates();
  void showRewind(const LoopState& state);

  AppContext& app_;
  Workstation& workstation_;
  Messages& messages_;
  FourUp& views_;
  ArmsPanel& arms_;
  StateNotice& notice_;
  RewindBar& rewind_;
  ExercisePanel& exercise_;
  const PointerHands& hands_;
  QElapsedTimer panel_clock_, rate_clock_, removed_clock_, cards_clock_;
  // What is cut of the running session's case, which is kept meanwhile.
  struct Tally {
    std::shared_ptr<const Volume> before;
    std::shared_ptr<const LabelMap> labels, structures;  // as tissues were placed; the case's
    TrueTissues tissues;
    CutTally cut;
    Tally(const Case& of, Session& session);
  };
  std::unique_ptr<Tally> tally_;
  std::vector<double> limits_N_;  // of the running session's arms
  struct GoingBack {
    std::uint32_t second;
    std::uint64_t asked_tick;
  };
  std::optional<GoingBack> going_back_;  // until it is said that one is there
  std::optional<LoopState> undoing_;     // what was there when it was asked for
  bool paused_ = false;
  std::optional<Vec3> worked_at_mm_;     // where a tool was in tissue last
  bool touched_ = false;                 // something has been, in this exercise
  bool cards_wanted_ = false;
  int frames_ = 0;  // since the rates were shown
  std::uint64_t ticks_shown_ = 0;
};

}  // namespace trephine
