// Where the arm that is shown stands in the room of a headset: three marks, which the headset
// shows, are touched with its tip, or a person says it.
#pragma once

#include <QLabel>
#include <QPushButton>
#include <QWidget>
#include <optional>
#include <vector>

#include "base/math.h"
#include "device/find_arms.h"
#include "ui/work/arms_in_room.h"

namespace trephine {

class RoomPanel : public QWidget {
  Q_OBJECT
 public:
  explicit RoomPanel(QWidget* parent = nullptr);

  // Somebody looks through a headset; it finds the same room again the next time.
  void setHeadset(bool seen, bool keeps_room);
  // Where the marks are, in the room; fewer than three: nobody sees them.
  void setMarks(std::vector<Vec3> room_m);
  // Of another arm, or none that can be registered.
  void showArm(const std::optional<FoundArm>& arm);
  // Its tip and its buttons now; `knows`: where it is.
  void follow(const Vec3& tip_m, std::uint32_t buttons, bool knows);
  // Marks are being touched: the arm that is shown stays.
  bool isTouching() const { return touching_; }
  void stop();

 signals:
  void marksWanted(bool wanted);  // again: where the head looks now

 private:
  void begin();
  void touch();
  void byHand();
  void showWords();

  std::optional<FoundArm> arm_;
  bool headset_ = false, keeps_room_ = false;
  bool touching_ = false, knows_ = false;
  Vec3 tip_m_{0.0};
  std::uint32_t buttons_ = 0;
  std::vector<Vec3> marks_m_, touched_m_;
  QLabel* words_;
  QPushButton *begin_, *here_, *by_hand_, *forget_;
};

}  // namespace trephine
