// One line: whether this workstation is as it was commissioned, or what has changed and what to do
// about it; each change with its next step in the tip.
#pragma once

#include "machine/commission/start_check.h"
#include "ui/common/background_task.h"
#include "ui/common/placing.h"
#include "ui/views/view_widget.h"
#include "ui/work/workstation.h"

namespace trephine {

class FitnessLine : public ElidedLabel {
  Q_OBJECT
 public:
  // `storage`: the folder of cases and recordings.
  FitnessLine(Workstation& workstation, ViewWidget& view, const std::filesystem::path& storage);

  // Some seconds, in the background. An exercise that begins meanwhile ends it, and it looks after
  // that. Asked again meanwhile, it looks anew: there may be another commissioning.
  void look();
  void say(const StartWords& words);

 signals:
  void looked();  // it came to its end, and says it

 private:
  bool mayLook() const;  // no exercise runs

  Workstation& workstation_;
  ViewWidget& view_;
  std::filesystem::path storage_;
  BackgroundTask looking_;
  bool again_ = false;  // once it can
};

// Where the last commissioning and what it recommends are, of this person and of the hospital.
struct CommissionFolders {
  std::filesystem::path own, hospital;
};
CommissionFolders commissionFolders(const Policy& policy);

}  // namespace trephine
