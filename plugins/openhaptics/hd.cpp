#include "hd.h"

#include <dlfcn.h>

namespace trephine::openhaptics {

namespace {

struct Symbol {
  const char* name;
  void** to;
};

// Null where it is not installed.
void* openLibrary() {
  for (const char* name : {"libHD.so", "libHD.so.3.4", "libHD.so.3.0"}) {
    if (void* library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL)) return library;
  }
  return nullptr;
}

}  // namespace

const Library* loadLibrary(std::string& why) {
  static Library hd;
  static void* library = nullptr;
  if (library) return &hd;
  void* opened = openLibrary();
  if (!opened) {
    why =
        "The maker's library for Phantom and Touch arms (libHD.so) is not installed: install "
        "OpenHaptics and the arm's driver, then start Trephine again.";
    return nullptr;
  }
  const Symbol symbols[] = {
      {"hdInitDevice", reinterpret_cast<void**>(&hd.initDevice)},
      {"hdDisableDevice", reinterpret_cast<void**>(&hd.disableDevice)},
      {"hdMakeCurrentDevice", reinterpret_cast<void**>(&hd.makeCurrentDevice)},
      {"hdBeginFrame", reinterpret_cast<void**>(&hd.beginFrame)},
      {"hdEndFrame", reinterpret_cast<void**>(&hd.endFrame)},
      {"hdEnable", reinterpret_cast<void**>(&hd.enable)},
      {"hdDisable", reinterpret_cast<void**>(&hd.disable)},
      {"hdGetIntegerv", reinterpret_cast<void**>(&hd.getIntegerv)},
      {"hdGetBooleanv", reinterpret_cast<void**>(&hd.getBooleanv)},
      {"hdGetDoublev", reinterpret_cast<void**>(&hd.getDoublev)},
      {"hdSetDoublev", reinterpret_cast<void**>(&hd.setDoublev)},
      {"hdGetError", reinterpret_cast<void**>(&hd.getError)},
      {"hdGetErrorString", reinterpret_cast<void**>(&hd.getErrorString)},
      {"hdCheckCalibration", reinterpret_cast<void**>(&hd.checkCalibration)},
      {"hdUpdateCalibration", reinterpret_cast<void**>(&hd.updateCalibration)},
      {"hdSetSchedulerRate", reinterpret_cast<void**>(&hd.setSchedulerRate)},
      {"hdStartScheduler", reinterpret_cast<void**>(&hd.startScheduler)},
      {"hdStopScheduler", reinterpret_cast<void**>(&hd.stopScheduler)},
      {"hdScheduleAsynchronous", reinterpret_cast<void**>(&hd.scheduleAsynchronous)},
      {"hdUnschedule", reinterpret_cast<void**>(&hd.unschedule)},
  };
  for (const Symbol& symbol : symbols) {
    *symbol.to = ::dlsym(opened, symbol.name);
    if (*symbol.to) continue;
    why = std::string("The installed libHD.so has no '") + symbol.name +
          "': it is of another version; install OpenHaptics 3.4.";
    ::dlclose(opened);
    return nullptr;
  }
  library = opened;
  return &hd;
}

}  // namespace trephine::openhaptics
