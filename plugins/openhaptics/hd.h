// The few functions of the maker's libHD that are used, found at run time: Trephine starts without
// it. Names, types and numbers are those of its C interface (HDAPI 3).
#pragma once

#include <cstdint>
#include <string>

namespace trephine::openhaptics {

using HHD = std::uint32_t;
using HDenum = std::uint32_t;
using HDErrorCode = std::uint32_t;
using HDCallback = std::uint32_t (*)(void* user);

struct HDErrorInfo {
  HDErrorCode code;
  int internal;
  HHD device;
};

constexpr HHD kInvalidHandle = 0xFFFFFFFF;
constexpr std::uint32_t kCallbackDone = 0, kCallbackContinue = 1;
constexpr std::uint16_t kPriority = 0x7FFF;  // the usual one

enum : HDenum {
  kCurrentButtons = 0x2000,
  kCurrentInkwell = 0x2002,    // a boolean: the stylus is in its holder
  kCurrentTransform = 0x2052,  // 16 doubles, column by column, mm
  kUsableWorkspace = 0x2551,   // 6 doubles, mm: low, high
  kInputDof = 0x2553,
  kCalibrationStyle = 0x2555,
  kNominalMaxForce = 0x2603,
  kNominalMaxContinuousForce = 0x2604,
  kCurrentForce = 0x2700,
  kForceOutput = 0x4000,
  kCalibrationOk = 0x5000,
  kCalibrationNeedsUpdate = 0x5001
};

// Bits of kCalibrationStyle: how an arm can be calibrated.
constexpr int kStyleAuto = 1 << 1, kStyleInkwell = 1 << 2;

enum : HDErrorCode {
  kWarmMotors = 0x0200,
  kFirstPassing = 0x0201,  // of force, impulse or velocity
  kLastPassing = 0x0204,
  kFirstLost = 0x0300,  // of device and communication
  kLastLost = 0x0304,
  kFirstScheduler = 0x0500,
  kLastScheduler = 0x0501
};

struct Library {
  HHD (*initDevice)(const char* name) = nullptr;
  void (*disableDevice)(HHD) = nullptr;
  void (*makeCurrentDevice)(HHD) = nullptr;
  void (*beginFrame)(HHD) = nullptr;
  void (*endFrame)(HHD) = nullptr;
  void (*enable)(HDenum) = nullptr;
  void (*disable)(HDenum) = nullptr;
  void (*getIntegerv)(HDenum, int*) = nullptr;
  void (*getBooleanv)(HDenum, std::uint8_t*) = nullptr;
  void (*getDoublev)(HDenum, double*) = nullptr;
  void (*setDoublev)(HDenum, const double*) = nullptr;
  HDErrorInfo (*getError)() = nullptr;
  const char* (*getErrorString)(HDErrorCode) = nullptr;
  HDenum (*checkCalibration)() = nullptr;
  void (*updateCalibration)(HDenum style) = nullptr;
  void (*setSchedulerRate)(unsigned long) = nullptr;
  void (*startScheduler)() = nullptr;
  void (*stopScheduler)() = nullptr;
  unsigned long (*scheduleAsynchronous)(HDCallback, void* user, std::uint16_t priority) = nullptr;
  void (*unschedule)(unsigned long) = nullptr;
};

// Loaded once and kept. Null, and `why` in one sentence, where it is not there or lacks a function.
const Library* loadLibrary(std::string& why);

}  // namespace trephine::openhaptics
