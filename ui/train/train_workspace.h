// Train: the exercise: its start and end, what the hands do, what is said before and after it.
// Between its panels, the views and the workstation. (train_hands.cpp is what the hands do.)
#pragma once

#include <QTimer>
#include <optional>

#include "ui/train/arms_panel.h"
#include "ui/train/exercise_choice.h"
#include "ui/train/exercise_panel.h"
#include "ui/train/hand_bar.h"
#include "ui/train/pedal_switches.h"
#include "ui/train/pointer_hands.h"
#include "ui/train/result_page.h"
#include "ui/train/rewind_bar.h"
#include "ui/train/running_view.h"
#include "ui/train/start_card.h"
#include "ui/train/state_notice.h"
#include "ui/work/app_context.h"

namespace trephine {

class TrainWorkspace : public Workspace {
  Q_OBJECT
 public:
  static constexpr double kNoEnd_s = 1e9;

  explicit TrainWorkspace(AppContext& app);

  QString title() const override { return tr("Train"); }
  Symbol symbol() const override { return Symbol::train; }
  Parts parts() override;
  void enter() override;
  void leave() override;
  bool escape() override;

  // The exercises to choose from, for the bar; what one does with a running one.
  QComboBox* exercises() const { return choice_->list(); }
  QAction* startAction() const { return start_; }
  QAction* stopAction() const { return stop_; }
  QAction* pauseAction() const { return pause_; }
  QAction* resetAction() const { return reset_; }
  QList<QAction*> handActions() const { return {other_hand_, change_tool_, clutch_, recentre_}; }
  QAction* forceOnAction() const { return notice_->forceOnAction(); }
  QAction* backAction() const { return rewind_->backAction(); }

  // `script` plays until the mouse takes a hand; after `seconds` the exercise stops by itself.
  void startExercise(std::optional<OperatorScript> script = {}, double seconds = kNoEnd_s);
  // Shows the exercise as it is now; a timer does so 60 times a second while one runs.
  void tick() { follow(false); }
  // A tick of which also those parts are shown that change more slowly than pictures, but for the
  // rates, which are of the true clock.
  void showAll() { follow(true); }
  // An exercise that is about to open may not be in the list.
  void chooseNothing() { choice_->showNone(); }
  void showInUse() { choice_->showInUse(); }  // in the list of exercises
  // Somebody reads the state as cards (cardsChanged).
  void setCardsWanted(bool wanted) { running_->setCardsWanted(wanted); }

 signals:
  void ratesChanged(const QString& words);
  void structureWanted();  // that the exercise needs and the case lacks
  void replayWanted();     // of the exercise that ended last
  void cardsChanged(const std::vector<trephine::EyeCard>& cards);
  void recentreWanted();  // by both outer switches of a pedal at once

 private:
  void buildActions();
  void connectParts();
  void showChosen();
  void showPhase();
  void showReset();
  void start() { startUnlessLost({UnsavedWork::cuts}); }
  // What was cut can be seen again by its recording, so nothing is asked.
  void tryAgain() { recorded_ ? startUnlessLost({}) : start(); }
  void startUnlessLost(const std::vector<UnsavedWork>& losses);
  void reset();
  void sessionStarted();
  static bool isRecorded(const Session& session, const RunReport& report);
  void sessionEnded(Session& session);
  void follow(bool all);
  void followPedal(const LoopState& state);
  bool pointerHasAHand() const;
  void command(CommandKind kind);
  void askToGoOn(const Error& error);
  void showSaid();
  void putCard();
  void showCard();
  void putAside(bool aside);
  void showHand();
  void showOutline();
  void showPractising();
  void showLocks();
  void showResult(Session& session, const RunReport& report);
  void showChangeTool();
  void giveTool(std::size_t arm, std::size_t tool);
  void nextTool();
  void clutch();
  void recentre();

  AppContext& app_;
  Workstation& workstation_;
  Messages& messages_;
  WorkGuards& guards_;
  CaseViews& case_views_;
  FourUp* views_;
  ViewWidget* view_;
  QAction *start_, *stop_, *pause_, *reset_, *clutch_, *recentre_, *other_hand_, *change_tool_;
  ExerciseChoice* choice_;
  ArmsPanel* arms_;
  StateNotice* notice_;  // over the views
  RewindBar* rewind_;
  ExercisePanel* exercise_;
  QWidget* exercise_page_;
  StartCard* card_;
  ResultPage* result_;
  HandBar* hand_bar_;
  PointerHands* hands_;
  RunningView* running_;
  bool here_ = false;             // this workspace is the one that is shown
  bool result_shown_ = false;     // instead of the card
  bool recorded_ = false;         // whole, the exercise of the result
  bool aside_ = false;            // card or result, by the person
  bool back_from_trial_ = false;  // once it has ended
  QTimer frame_timer_;
  PedalSwitches pedal_;
};

}  // namespace trephine
