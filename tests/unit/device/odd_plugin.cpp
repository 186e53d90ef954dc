// A plugin with one arm that does nothing, and one thing wrong with it: which one, the ODD_*
// definition of its target says.
#include <cmath>
#include <cstdlib>

#include "device/trephine_device.h"

struct TrephineDevice {
  int unused;
};

namespace {

TrephineDevice only_device{};
#ifdef ODD_GREEDY
int* volatile kept = nullptr;
#endif

uint32_t enumerate(TrephineArmInfo*, uint32_t) {
  return 1;
}
int open(const uint32_t*, uint32_t, TrephineDevice** device) {
  *device = &only_device;
  return TREPHINE_OK;
}
int configure(TrephineDevice*, const char*) {
  return TREPHINE_OK;
}
int capabilities(TrephineDevice*, uint32_t, TrephineCapabilities* c) {
  for (double& extent : c->workspace_m) extent = 0.1;
  c->input_dof = 6;
  c->peak_force_N = c->continuous_force_N = 1.0;
  c->apparent_mass_kg = c->rate_hz = 1.0;
#ifdef ODD_IMPOSSIBLE
  c->peak_force_N = std::nan("");
#endif
  return TREPHINE_OK;
}
int calibrate(TrephineDevice*, uint32_t) {
  return TREPHINE_OK;
}
int start(TrephineDevice*) {
  return TREPHINE_OK;
}
int write(TrephineDevice*, const TrephineArmCommand*) {
  return TREPHINE_OK;
}
int read(TrephineDevice*, double, TrephineArmState*) {
#ifdef ODD_GREEDY
  kept = new int(1);
  delete kept;
#endif
  return TREPHINE_OK;
}
#ifndef ODD_HOLE
int stop(TrephineDevice*) {
  return TREPHINE_OK;
}
#endif
void safeStop(TrephineDevice*) {}
const char* lastError(TrephineDevice*) {
  return "";
}
void close(TrephineDevice*) {}

[[maybe_unused]] const TrephineDeviceApi api = {
#ifdef ODD_SMALL_TABLE
    sizeof(TrephineDeviceApi) - sizeof(void*),
#else
    sizeof(TrephineDeviceApi),
#endif
#ifdef ODD_OTHER_VERSION
    TREPHINE_DEVICE_ABI + 1,
#else
    TREPHINE_DEVICE_ABI,
#endif
    "odd",
    enumerate,
    open,
    configure,
    capabilities,
    calibrate,
    start,
    read,
    write,
    nullptr,
    nullptr,
#ifdef ODD_HOLE
    nullptr,
#else
    stop,
#endif
    safeStop,
    lastError,
    close,
};

}  // namespace

#ifndef ODD_NO_ENTRY
extern "C" const TrephineDeviceApi* trephine_device_plugin(uint32_t) {
#ifdef ODD_OTHER_ABI
  return nullptr;
#else
  return &api;
#endif
}
#endif
