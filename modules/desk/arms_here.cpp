#include "desk/arms_here.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/tr.h"
#include "desk/codes.h"

namespace trephine {

Exercise withForceLimit(Exercise exercise, double most_N) {
  for (ExerciseArm& arm : exercise.arms) arm.max_force_N = std::min(arm.max_force_N, most_N);
  return exercise;
}

Status waitForArms(std::unique_lock<std::timed_mutex>& lock, const Rig& rig,
                   const ChosenArms& chosen) {
  const auto is_real = [](const Rig::Arm& arm) { return arm.device.plugin != kSimulated; };
  if (chosen.empty() && std::ranges::none_of(rig.arms, is_real)) return {};
  if (lock.try_lock_for(std::chrono::seconds(10))) return {};
  return Error{
      code::kArmsBusy, tr("Looking for arms has not come to an end: a device does not answer"), "",
      tr("Unplug it and wait, or start Trephine again; mouse and keys move hands that have no "
         "arm under Devices")};
}

ArmsHere::ArmsHere(std::function<std::optional<ChosenArms>()> chosen,
                   std::function<void()> answered, std::function<void()> wake)
    : chosen_(std::move(chosen)), answered_(std::move(answered)), asking_(std::move(wake)) {}

void ArmsHere::read(const Exercise& exercise) {
  exercise_ = exercise;
  ask_again_ = asking_.busy();  // what is asked now is of another
  rig_ = simulatedRig(exercise_);
  if (!readArmDynamics(exercise_, rig_, &workspaces_mm_)) workspaces_mm_.clear();
  answered_();
  ask();
}

void ArmsHere::ask() {
  const std::optional<ChosenArms> chosen = chosen_();
  if (!chosen || chosen->empty()) return;
  if (asking_.busy()) return;
  struct Answer {
    Rig rig;
    std::vector<Vec3> workspaces_mm;
  };
  asking_.run(
      [exercise = exercise_, chosen = *chosen, opens = opens_](const Progress&) -> Result<Answer> {
        std::unique_lock lock(*opens, std::defer_lock);
        if (Status free = waitForArms(lock, {}, chosen); !free) return free.error();
        Result<Rig> rig = rigOf(exercise, chosen);
        if (!rig) return rig.error();
        Answer answer{*std::move(rig), {}};
        if (Status asked = readArmDynamics(exercise, answer.rig, &answer.workspaces_mm); !asked) {
          return asked.error();
        }
        return answer;
      },
      [this](Result<Answer> answer) {
        if (std::exchange(ask_again_, false)) return ask();
        if (!answer) return;
        rig_ = std::move(answer->rig);
        workspaces_mm_ = std::move(answer->workspaces_mm);
        answered_();
      });
}

}  // namespace trephine
