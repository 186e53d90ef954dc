// Device plugins, loaded and owned. The C ABI is trephine_device.h; this is its C++ side.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/math.h"
#include "base/result.h"
#include "device/trephine_device.h"

namespace trephine {

// A loaded plugin library. Stays loaded while a Device of it lives.
class DevicePlugin {
 public:
  // `name` such as "simulated": the library trephine_<name>.so in `folder`. Errors: NO_PLUGIN (not
  // there or not loadable), BAD_PLUGIN (no entry symbol, another ABI, a table with holes).
  static Result<std::shared_ptr<const DevicePlugin>> load(const std::string& name,
                                                          const std::filesystem::path& folder);
  // A device compiled in, such as a measurement's own: `api` outlives it. Error: BAD_PLUGIN.
  static Result<std::shared_ptr<const DevicePlugin>> builtIn(const TrephineDeviceApi& api);
  ~DevicePlugin();
  DevicePlugin(const DevicePlugin&) = delete;
  DevicePlugin& operator=(const DevicePlugin&) = delete;

  const TrephineDeviceApi& api() const { return *api_; }
  std::vector<TrephineArmInfo> enumerate() const;
  // After that: why there can be none, empty where the plugin does not say.
  std::string whyNone() const;

 private:
  DevicePlugin() = default;
  void* library_ = nullptr;
  const TrephineDeviceApi* api_ = nullptr;
};

// Opened arms of one plugin. Stops and closes itself.
class Device {
 public:
  // `config` is JSON text for the plugin. Errors: NO_DEVICE and BAD_DEVICE_CONFIG with the plugin's
  // own sentence, DEVICE_STUCK after leaveBehind(), BAD_PLUGIN for capabilities that no arm has.
  static Result<std::unique_ptr<Device>> open(std::shared_ptr<const DevicePlugin> plugin,
                                              const std::vector<std::uint32_t>& arms,
                                              const std::string& config);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  std::size_t armCount() const { return capabilities_.size(); }
  const TrephineCapabilities& capabilities(std::size_t arm) const { return capabilities_[arm]; }
  bool takesTargets() const { return plugin_->api().set_target != nullptr; }
  // Its samples come by a clock of its own, at their rate: wait() waits for the next.
  bool hasClock() const { return plugin_->api().wait != nullptr; }

  // Calibrates and starts every arm. Errors, with the plugin's own sentence:
  // NOT_CALIBRATED where an arm does not know where it is and cannot find out by itself,
  // DEVICE_NOT_STARTED.
  Status start();
  void stop();
  // Zero force until a write has commanded zero on all arms, or the next start. Any thread,
  // also while another call does not return.
  void safeStop();
  // A call to this device did not return: it is not offered again while this program runs, since a
  // second opening would meet the same call. open() then answers DEVICE_STUCK. Any thread.
  void leaveBehind() const;

  // Haptic thread. `states` and `commands` have armCount() elements; sizes and versions in them are
  // set here. read() is false when the device failed, or did not take what was written last: the
  // states are then the last good ones, marked TREPHINE_ARM_LOST.
  bool read(double dt_s, TrephineArmState* states);
  void write(const TrephineArmCommand* commands);
  // Until there is a sample that read() has not given yet; false when none came in time. Only where
  // hasClock().
  bool wait(double timeout_s);
  // Haptic thread; nothing happens on arms that are not simulated. Position in device metres.
  void setTarget(std::size_t arm, const Pose& pose_m, double stiffness_N_per_m,
                 double damping_Ns_per_m);

 private:
  Device() = default;
  std::shared_ptr<const DevicePlugin> plugin_;
  TrephineDevice* handle_ = nullptr;
  std::vector<std::uint32_t> places_;  // in the plugin's enumeration
  std::vector<TrephineCapabilities> capabilities_;
  std::vector<TrephineArmState> last_states_;  // good ones
  std::vector<TrephineArmCommand> commands_;   // scratch: the caller's, with size and version
  bool refused_ = false;                       // the last write
  bool running_ = false;
};

}  // namespace trephine
