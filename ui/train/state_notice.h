// What stands between the hand and the tissue in a running exercise, said large over the view: the
// pause, arms that are without force, or that all is ready. Words, and one button that mends it.
// Mouse and wheel beside the buttons go on to the view below.
#pragma once

#include <QAction>
#include <QFrame>
#include <QLabel>
#include <QPushButton>
#include <QWidget>

#include "exercise/exercise.h"
#include "haptics/haptic_loop.h"

namespace trephine {

// Which arms are without force, or that the pedal is gone, and why, in words.
struct ForceNotice {
  QString title, why;  // empty: every arm has its force
  QString mend;        // what the button says; empty: the force comes back without it
};

// `still_s`: how long the ticks have stood still, and the state with them.
ForceNotice forceNotice(const LoopState& state, const Exercise& exercise, double still_s);

// What is said once a rewind has come to its second: the state is the one after it.
QString backWords(std::uint32_t second, const LoopState& state, const Exercise& exercise);
// How much an undo brought back, or a redo took again, of which arm; empty: nothing.
QString undoneWords(const LoopState& before, const LoopState& after, const Exercise& exercise,
                    double voxel_mm3);

class StateNotice : public QWidget {
  Q_OBJECT
 public:
  // Lies over `view`, as wide as there is room, at its top or below `bar`, a child of it.
  explicit StateNotice(QWidget* view, const QWidget* bar = nullptr);

  // `ready`: nothing has been touched yet.
  void showState(const LoopState& state, const Exercise& exercise, double still_s,
                 bool ready = false);
  void showIdle() { show(false, {}, false); }
  // "Force on" with its key, for a menu; enabled while it can be used.
  QAction* forceOnAction() { return force_on_; }

 signals:
  void goOnWanted();
  void forceWanted();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  struct Card {
    QFrame* frame;
    QLabel *title, *why;
    QPushButton* button;
  };
  Card makeCard(const char* name, const char* button_name);
  void show(bool paused, const ForceNotice& force, bool ready);
  void place();

  Card pause_, force_, ready_;
  const QWidget* bar_;
  QAction* force_on_;
};

}  // namespace trephine
