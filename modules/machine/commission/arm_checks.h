// The arms that are plugged in: how many, and whether encoders and motors of each agree.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "machine/commission/commission_limits.h"
#include "session/motor_encoder_check.h"

namespace trephine {

// The file of its --out folder in which trephine-lab tells what its tried arms answered.
inline constexpr const char* kArmsAnswer = "arms.json";

struct ArmReadings {
  std::string model;
  double step_m = 0.0;
  MotorEncoderCheck::Phase phase = MotorEncoderCheck::Phase::off;
  double noise_m = 0.0;
  bool pushed = false;
  MotorEncoderCheck::Response response;
};
// `arm_encoders` and `arm_forces`, of the worst. Pure.
std::vector<CommissionCheck> judgedArms(const std::vector<ArmReadings>& arms);

// `arms`, without opening any.
CommissionCheck countArms();
// All three. Opens the arms, and pushes those that somebody takes within `patience_s`
// (MotorEncoderCheck); 0: none is tried. Here: a driver that ends its program ends this one.
std::vector<CommissionCheck> tryArms(double patience_s, const Progress& progress);
// The same by trephine-lab in a process of its own, so that an arm's driver which ends its program,
// or does not return, is a check that fails.
std::vector<CommissionCheck> checkArms(double patience_s, const Progress& progress);

}  // namespace trephine
