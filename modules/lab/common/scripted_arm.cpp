#include "lab/common/scripted_arm.h"

#include <algorithm>
#include <utility>

namespace trephine {

// The handle that the plugin's functions get: TrephineDevice is each plugin's own and opaque here.
struct ScriptedArmApi {
  // `open` is given no user data.
  static thread_local ScriptedArm* to_open;

  static ScriptedArm& armOf(TrephineDevice* device) {
    return *reinterpret_cast<ScriptedArm*>(device);
  }
  static int answer(TrephineDevice*) { return TREPHINE_OK; }
  static int write(TrephineDevice* device, const TrephineArmCommand* commands) {
    const double* force = commands[0].force_N;
    armOf(device).commanded_N_.emplace_back(force[0], force[1], force[2]);
    return TREPHINE_OK;
  }
  static int read(TrephineDevice* device, double, TrephineArmState* states) {
    ScriptedArm& arm = armOf(device);
    const ScriptedArm::Sample sample = arm.script_(int(arm.commanded_N_.size()));
    if (sample.answer != TREPHINE_OK) return sample.answer;
    TrephineArmState& state = states[0];
    ++state.sequence;
    state.time_ns = sample.time_ns;
    for (int axis = 0; axis < 3; ++axis) state.position_m[axis] = sample.position_m[axis];
    const Quat& q = sample.orientation;
    const double wxyz[] = {q.w, q.x, q.y, q.z};
    std::copy_n(wxyz, 4, state.orientation);
    state.flags = sample.flags;
    state.buttons = sample.buttons;
    return TREPHINE_OK;
  }
  static const TrephineDeviceApi& api() {
    static const TrephineDeviceApi made = [] {
      TrephineDeviceApi api{};
      api.size = sizeof(api);
      api.version = TREPHINE_DEVICE_ABI;
      api.name = "scripted";
      api.enumerate = [](TrephineArmInfo*, std::uint32_t) { return std::uint32_t(1); };
      api.open = [](const std::uint32_t*, std::uint32_t, TrephineDevice** device) -> int {
        *device = reinterpret_cast<TrephineDevice*>(to_open);
        return TREPHINE_OK;
      };
      api.configure = [](TrephineDevice* device, const char*) { return answer(device); };
      api.capabilities = [](TrephineDevice* device, std::uint32_t,
                            TrephineCapabilities* out) -> int {
        *out = armOf(device).capabilities_;
        return TREPHINE_OK;
      };
      api.calibrate = [](TrephineDevice* device, std::uint32_t) { return answer(device); };
      api.start = [](TrephineDevice* device) { return answer(device); };
      api.read = read;
      api.write = write;
      api.stop = answer;
      api.safe_stop = [](TrephineDevice*) {};
      api.last_error = [](TrephineDevice*) { return "scripted"; };
      api.close = [](TrephineDevice*) {};
      return api;
    }();
    return made;
  }
};
thread_local ScriptedArm* ScriptedArmApi::to_open = nullptr;

ScriptedArm::ScriptedArm(Script script, const TrephineCapabilities& capabilities,
                         std::size_t exchanges)
    : script_(std::move(script)), capabilities_(capabilities) {
  commanded_N_.reserve(exchanges);
}

Result<std::unique_ptr<Device>> ScriptedArm::open() {
  auto plugin = DevicePlugin::builtIn(ScriptedArmApi::api());
  if (!plugin) return plugin.error();
  ScriptedArmApi::to_open = this;
  return Device::open(*plugin, {0}, "{}");
}

TrephineCapabilities omniCapabilities() {
  TrephineCapabilities c{};
  c.size = sizeof(c);
  c.version = TREPHINE_DEVICE_ABI;
  c.input_dof = 6;
  const double workspace_m[] = {0.16, 0.12, 0.07};
  std::copy_n(workspace_m, 3, c.workspace_m);
  c.peak_force_N = 3.3;
  c.continuous_force_N = 0.88;
  c.apparent_mass_kg = 0.045;
  c.encoder_step_m = 0.055e-3;
  c.rate_hz = 1000.0;
  return c;
}

}  // namespace trephine
