// The arms of this workstation as the open exercise has them: which device is which and how far
// each reaches. Asked in the background, as devices may take their time.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "base/job.h"
#include "exercise/exercise.h"
#include "exercise/rig.h"
#include "session/arm_devices.h"

namespace trephine {

// What a person's settings say of this workstation's arms.
struct ArmSettings {
  ChosenArms chosen;
  double most_N = 1e9;  // no arm gives more
};

// No arm gives more than that.
Exercise withForceLimit(Exercise exercise, double most_N);

// On its owner's thread.
class ArmsHere {
 public:
  // `chosen`: the devices to be asked, none where all is simulated; empty: not now. `answered`:
  // rig() and workspaces_mm() are others. `wake`: as Job has it.
  ArmsHere(std::function<std::optional<ChosenArms>()> chosen, std::function<void()> answered,
           std::function<void()> wake);

  void take() { asking_.take(); }
  // As simulated, at once; then, where any is chosen, as those devices say. An arm that is not
  // there now may be when a session starts, which then says so.
  void read(const Exercise& exercise);
  const Rig& rig() const { return rig_; }
  // Of each arm of the exercise, device axes, mm; empty where an arm is not there.
  const std::vector<Vec3>& workspaces_mm() const { return workspaces_mm_; }
  // Held while arms are opened: by one at a time.
  const std::shared_ptr<std::timed_mutex>& opens() const { return opens_; }

 private:
  void ask();

  std::function<std::optional<ChosenArms>()> chosen_;
  std::function<void()> answered_;
  Exercise exercise_;  // that they are asked for
  Rig rig_;
  std::vector<Vec3> workspaces_mm_;
  bool ask_again_ = false;  // read() came while they were asked
  const std::shared_ptr<std::timed_mutex> opens_ = std::make_shared<std::timed_mutex>();
  Job asking_;  // last: joined before what it works on goes
};

// Waits at most 10 s until nobody else opens arms; who wants none need not. Errors: ARMS_BUSY.
Status waitForArms(std::unique_lock<std::timed_mutex>& lock, const Rig& rig,
                   const ChosenArms& chosen);

}  // namespace trephine
