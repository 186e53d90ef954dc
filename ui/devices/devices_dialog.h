// The arms of this workstation: what is plugged in and where, which is the left and which the right
// (the one that a person moves is the one that is shown), whether each knows where it is, and a
// force to tell by that it works. There is no force but in that test.
#pragma once

#include <QComboBox>
#include <QDialog>
#include <QFileSystemWatcher>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QTimer>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "session/arm_trial.h"
#include "ui/common/background_task.h"
#include "ui/devices/arm_picture.h"
#include "ui/devices/room_panel.h"

namespace trephine {

class DevicesDialog : public QDialog {
  Q_OBJECT
 public:
  // `opens_arms` is held while arms are opened here.
  DevicesDialog(std::shared_ptr<std::timed_mutex> opens_arms, QWidget* parent);
  ~DevicesDialog() override;

  // Where an arm stands in a headset's room is found here as well.
  RoomPanel& room() { return *room_; }
  // Again what is plugged in: also when something is plugged in or out.
  void look();

 signals:
  void letGo();  // it was closed, and has no arm any more; it goes by itself

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void found(const FoundArms& here);
  void showList();
  void showSides();
  void showArm();
  void showNow();
  void choose(const std::string& side, int index);
  void askForForce();
  void answer(bool felt);
  void close();
  QString sideOf(const FoundArm& arm) const;
  bool isPedal(std::size_t arm) const;
  int shown() const { return list_->currentRow(); }

  std::shared_ptr<std::timed_mutex> opens_arms_;
  std::vector<FoundArm> arms_;  // real ones
  std::shared_ptr<ArmTrial> trial_;
  bool look_again_ = false, asked_ = false, waited_ = false;
  std::vector<double> moved_m_;  // by then, of each arm
  std::map<std::string, bool> felt_by_place_;  // a force of it was tested, by its bus path

  QListWidget* list_;
  QLabel *problems_, *name_, *able_, *now_, *test_;
  ArmPicture* picture_;
  RoomPanel* room_;
  QPushButton *again_, *force_, *felt_, *not_felt_;
  QComboBox *left_, *right_, *pedal_;
  QTimer show_timer_, plug_timer_;
  QFileSystemWatcher plugs_;
  BackgroundTask looking_;
};

}  // namespace trephine
