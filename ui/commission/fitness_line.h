// One line: whether this workstation is as it was commissioned, or what has changed and what to do
// about it; each change with its next step in the tip.
#pragma once

#include "machine/commission/start_check.h"
#include "ui/common/background_task.h"
#include "ui/common/placing.h"
#include "ui/work/app_context.h"

namespace trephine {

class FitnessLine : public ElidedLabel {
  Q_OBJECT
 public:
  explicit FitnessLine(AppContext& bench);

  // Some seconds, in the background. An exercise that begins meanwhile ends it, and it looks after
  // that. Asked again meanwhile, it looks anew: there may be another commissioning.
  void look();
  void say(const StartWords& words);

 signals:
  void looked();  // it came to its end, and says it

 private:
  bool mayLook() const;  // no exercise runs

  AppContext& app_;
  BackgroundTask looking_;
  bool again_ = false;  // once it can
};

// Where the last commissioning and what it recommends are, of this person and of the hospital.
struct CommissionFolders {
  std::filesystem::path own, hospital;
};
CommissionFolders commissionFolders(const Policy& policy);

}  // namespace trephine
