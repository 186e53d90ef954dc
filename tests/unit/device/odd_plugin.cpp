// A plugin with one arm that does nothing, and one thing wrong with it: which one, the ODD_*
// definition of its target says.
#include <cmath>

#include "unit/plain_api.h"

namespace {

#ifdef ODD_GREEDY
int* volatile kept = nullptr;
#endif

[[maybe_unused]] TrephineDeviceApi oddApi() {
  TrephineDeviceApi api = trephine::test::plainApi("odd");
#ifdef ODD_SMALL_TABLE
  api.size -= sizeof(void*);
#endif
#ifdef ODD_OTHER_VERSION
  api.version = TREPHINE_DEVICE_ABI + 1;
#endif
#ifdef ODD_IMPOSSIBLE
  api.capabilities = [](TrephineDevice* device, uint32_t arm, TrephineCapabilities* c) {
    const int plain = trephine::test::plainApi("odd").capabilities(device, arm, c);
    c->peak_force_N = std::nan("");
    return plain;
  };
#endif
#ifdef ODD_GREEDY
  api.read = [](TrephineDevice*, double, TrephineArmState*) {
    kept = new int(1);
    delete kept;
    return int(TREPHINE_OK);
  };
#endif
#ifdef ODD_HOLE
  api.stop = nullptr;
#endif
  return api;
}

}  // namespace

#ifndef ODD_NO_ENTRY
extern "C" const TrephineDeviceApi* trephine_device_plugin(uint32_t) {
#ifdef ODD_OTHER_ABI
  return nullptr;
#else
  static const TrephineDeviceApi api = oddApi();
  return &api;
#endif
}
#endif
