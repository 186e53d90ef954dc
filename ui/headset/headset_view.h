// The 3-D view through a headset: on and off, where the patient stands before the trainee, and that the
// exercise goes on whatever becomes of it. Between the bench's view and the room `headset`; the
// window's thread.
#pragma once

#include <QAction>
#include <QObject>
#include <atomic>
#include <memory>
#include <vector>

#include "headset/headset.h"
#include "headset/picture_painter.h"
#include "headset/room_place.h"
#include "ui/headset/eye_cards.h"
#include "ui/work/bench.h"

namespace trephine {

class HeadsetView : public QObject {
  Q_OBJECT
 public:
  HeadsetView(Bench& bench, QWidget& window);
  ~HeadsetView() override;

  QAction* onAction() const { return on_; }
  QAction* recentreAction() const { return recentre_; }
  QAction* mirrorAction() const { return mirror_; }
  bool isOn() const { return headset_ != nullptr; }
  void recentre();
  // What is read inside, beside the patient. Nothing where no exercise runs.
  void setCards(std::vector<EyeCard> cards);
  // How it goes, for the status line; empty while it is off.
  QString words() const;
  void stop();

 signals:
  void changed();  // on or off, seen or not, words()

 private:
  void toggle(bool on);
  void start();
  void serve();
  void ended(const HeadsetEnd& how);
  void place();
  void showCards();
  void sayState(const HeadsetState& state);

  Bench& bench_;
  QAction *on_, *recentre_, *mirror_;
  std::unique_ptr<Headset> headset_;
  PicturePainter painter_;
  RoomPlace place_;
  bool placed_ = false;
  std::vector<EyeCard> cards_;
  // The thread that wakes this may outlive it.
  std::shared_ptr<std::atomic<bool>> woken_;
  bool seen_ = false, flat_ = false;
};

}  // namespace trephine
