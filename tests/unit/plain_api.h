// The table of a plugin with one arm of six degrees of freedom that does nothing: a test puts in
// what it is about.
#pragma once

#include "device/trephine_device.h"

namespace trephine::test {

inline TrephineDeviceApi plainApi(const char* name) {
  TrephineDeviceApi api{};
  api.size = sizeof(api);
  api.version = TREPHINE_DEVICE_ABI;
  api.name = name;
  api.enumerate = [](TrephineArmInfo*, uint32_t) { return uint32_t(1); };
  api.open = [](const uint32_t*, uint32_t, TrephineDevice** device) {
    static int any;
    *device = reinterpret_cast<TrephineDevice*>(&any);
    return int(TREPHINE_OK);
  };
  api.configure = [](TrephineDevice*, const char*) { return int(TREPHINE_OK); };
  api.capabilities = [](TrephineDevice*, uint32_t, TrephineCapabilities* c) {
    for (double& extent : c->workspace_m) extent = 0.1;
    c->input_dof = 6;
    c->peak_force_N = c->continuous_force_N = 3.3;
    c->apparent_mass_kg = 0.045;
    c->rate_hz = 1000.0;
    return int(TREPHINE_OK);
  };
  api.calibrate = [](TrephineDevice*, uint32_t) { return int(TREPHINE_OK); };
  api.start = [](TrephineDevice*) { return int(TREPHINE_OK); };
  api.read = [](TrephineDevice*, double, TrephineArmState*) { return int(TREPHINE_OK); };
  api.write = [](TrephineDevice*, const TrephineArmCommand*) { return int(TREPHINE_OK); };
  api.stop = [](TrephineDevice*) { return int(TREPHINE_OK); };
  api.safe_stop = [](TrephineDevice*) {};
  api.last_error = [](TrephineDevice*) { return ""; };
  api.close = [](TrephineDevice*) {};
  return api;
}

}  // namespace trephine::test
