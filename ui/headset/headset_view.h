// The 3-D view through a headset: on and off, where the patient stands before the trainee, and that
// the exercise goes on whatever becomes of it. Between the case's view and the room
// `headset`; the window's thread.
#pragma once

#include <QAction>
#include <QObject>
#include <QTimer>
#include <atomic>
#include <memory>
#include <vector>

#include "headset/headset.h"
#include "headset/picture_painter.h"
#include "headset/room_place.h"
#include "ui/common/preferences.h"
#include "ui/headset/eye_cards.h"
#include "ui/work/case_views.h"

namespace trephine {

class HeadsetView : public QObject {
  Q_OBJECT
 public:
  HeadsetView(Workstation& workstation, Messages& messages, CaseViews& case_views);
  ~HeadsetView() override;

  QAction* onAction() const { return on_; }
  QAction* recentreAction() const { return recentre_; }
  bool isOn() const { return headset_ != nullptr; }
  // Somebody looks through it.
  bool isSeen() const { return seen_; }
  bool keepsRoom() const { return keeps_room_; }
  void recentre();
  // Height, distance, scale and mirror are others.
  void settingsChanged();
  // What is read inside, beside the patient. Nothing where no exercise runs.
  void setCards(std::vector<EyeCard> cards);
  // Three marks where the head looks now, in the room, to be touched with an arm's tip; none where
  // nobody looks.
  std::vector<Vec3> showMarks();
  void hideMarks();
  // How it goes, for the status line; empty while it is off.
  QString words() const;
  // Switches it off, and returns at once.
  void stop();
  // How it was drawn and shown, for measurements; empty while it is off.
  std::optional<HeadsetState> state() const {
    return headset_ ? std::optional(headset_->state()) : std::nullopt;
  }
  double pair_ms() const { return painter_.pair_ms(); }

 signals:
  void changed();  // on or off, seen or not, words()

 private:
  void toggle(bool on);
  void start();
  void serve();
  void ended(const HeadsetEnd& how);
  void place();
  void placeByArms();
  struct Standing {
    Pose room_from_device_m;
    double error_mm = 0.0;
    ArmInPatient in_patient;
  };
  std::vector<Standing> standing() const;
  double toolsApart_mm() const;
  void showCards();
  void showMirror();
  void sayState(const HeadsetState& state);

  Workstation& workstation_;
  Messages& messages_;
  CaseViews& case_views_;
  QAction *on_, *recentre_;
  std::unique_ptr<Headset> headset_;
  PicturePainter painter_;
  RoomPlace place_;
  bool placed_ = false;
  bool by_arms_ = false;        // the patient stands where registered arms are
  Vec3 head_m_{0.0};            // as it was when the patient was placed,
  Vec3 ahead_{0.0, 0.0, -1.0};  // and what was ahead of it, in the room
  std::vector<EyeCard> cards_;
  std::vector<Vec3> marks_m_;
  // The thread that wakes this may outlive it.
  struct Woken {
    std::atomic<bool> is{false};
  };
  std::shared_ptr<Woken> woken_ = std::make_shared<Woken>();
  bool again_ = false;  // once the one before has ended
  bool seen_ = false, flat_ = false, stuck_ = false, keeps_room_ = false;
  bool mirrors_ = preferences().headset_mirror;
  int room_changes_ = 0;
  QTimer words_timer_;
};

}  // namespace trephine
