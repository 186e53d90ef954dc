#include "device/device.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <set>
#include <utility>

#include "base/tr.h"
#include "base/utf8.h"
#include "device/arm_numbers.h"
#include "device/codes.h"
#include "device/library_file.h"

namespace trephine {

namespace {

constexpr std::size_t kMaxSentence = 1000;

// A name may come from a file: it must not lead out of the plugin folder.
bool isPluginName(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

Error badPlugin(const std::string& what, const std::string& where) {
  return {code::kBadPlugin, what, where, tr("Install the plugin that belongs to this Trephine")};
}

// Empty when the table is whole, else what is wrong with it.
std::string tableFault(const TrephineDeviceApi& api) {
  if (api.version != TREPHINE_DEVICE_ABI) {
    return tr("The plugin speaks version {} of the device interface, and this program speaks {}",
              api.version, TREPHINE_DEVICE_ABI);
  }
  if (api.size < sizeof(TrephineDeviceApi)) {
    return tr("The plugin's function table has {} bytes instead of {}", api.size,
              sizeof(TrephineDeviceApi));
  }
  const std::pair<const char*, bool> functions[] = {
      {"enumerate", api.enumerate},   {"open", api.open},
      {"configure", api.configure},   {"calibrate", api.calibrate},
      {"start", api.start},           {"read", api.read},
      {"write", api.write},           {"stop", api.stop},
      {"safe_stop", api.safe_stop},   {"capabilities", api.capabilities},
      {"close", api.close},           {"name", api.name},
      {"last_error", api.last_error},
  };
  for (const auto& [name, present] : functions) {
    if (!present) return tr("The plugin's function table lacks '{}'", name);
  }
  return {};
}

// The plugin's own sentence, without its full stop: Error adds one.
std::string lastSentence(const TrephineDeviceApi& api, TrephineDevice* handle) {
  const char* text = api.last_error(handle);
  std::string sentence = text ? std::string(text, strnlen(text, kMaxSentence)) : std::string();
  while (!sentence.empty() && (sentence.back() == '.' || sentence.back() == '\n')) {
    sentence.pop_back();
  }
  sentence = cleanUtf8(sentence);
  return sentence.empty() ? tr("The plugin gave no reason") : sentence;
}

// What a device says of itself may be any bytes.
template <std::size_t N>
void clean(char (&text)[N]) {
  const std::string plain = cutUtf8(cleanUtf8({text, strnlen(text, N - 1)}), N - 1);
  std::memcpy(text, plain.c_str(), plain.size() + 1);
}

template <class T>
T sized() {
  T value{};
  value.size = sizeof(T);
  value.version = TREPHINE_DEVICE_ABI;
  return value;
}

// The arms whose calls did not return: a fact of the process, like the libraries that it has
// loaded.
struct LeftBehind {
  std::mutex mutex;
  std::set<std::pair<std::string, std::uint32_t>> arms;  // plugin's name, place
};
LeftBehind& leftBehind() {
  static LeftBehind arms;
  return arms;
}

}  // namespace

Result<std::shared_ptr<const DevicePlugin>> DevicePlugin::load(
    const std::string& name, const std::filesystem::path& folder) {
  if (!isPluginName(name)) {
    return Error{code::kNoPlugin, tr("'{}' is not the name of a device plugin", name.substr(0, 60)),
                 tr("device name"),
                 tr("Use lower-case letters, digits, '_' and '-', such as 'simulated'")};
  }
  std::error_code ec;
  // Made absolute: dlopen searches the system for a name without a folder.
  const std::filesystem::path file =
      std::filesystem::absolute(folder / ("trephine_" + name + ".so"), ec);
  if (ec || !std::filesystem::exists(file, ec)) {
    return Error{code::kNoPlugin, tr("There is no device plugin '{}'", name), file.string(),
                 tr("Check the device name, or install that plugin into this folder")};
  }
  if (Status whole = checkLibraryFile(file); !whole) return whole.error();
  std::shared_ptr<DevicePlugin> plugin(new DevicePlugin);
  plugin->library_ = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!plugin->library_) {
    const char* reason = ::dlerror();
    return Error{code::kNoPlugin,
                 tr("The device plugin '{}' cannot be loaded: {}", name,
                    (reason ? reason : tr("the system gave no reason"))),
                 file.string(), tr("Install it again, with the libraries that it needs")};
  }
  auto entry =
      reinterpret_cast<TrephineDeviceEntry>(::dlsym(plugin->library_, TREPHINE_DEVICE_ENTRY));
  if (!entry) {
    return badPlugin(tr("The library is no device plugin: it has no '{}'", TREPHINE_DEVICE_ENTRY),
                     file.string());
  }
  plugin->api_ = entry(TREPHINE_DEVICE_ABI);
  if (!plugin->api_) {
    return badPlugin(
        tr("The plugin does not speak version {} of the device interface", TREPHINE_DEVICE_ABI),
        file.string());
  }
  if (std::string fault = tableFault(*plugin->api_); !fault.empty()) {
    return badPlugin(fault, file.string());
  }
  return std::shared_ptr<const DevicePlugin>(std::move(plugin));
}

Result<std::shared_ptr<const DevicePlugin>> DevicePlugin::builtIn(const TrephineDeviceApi& api) {
  if (std::string fault = tableFault(api); !fault.empty()) return badPlugin(fault, tr("built in"));
  std::shared_ptr<DevicePlugin> plugin(new DevicePlugin);
  plugin->api_ = &api;
  return std::shared_ptr<const DevicePlugin>(std::move(plugin));
}

DevicePlugin::~DevicePlugin() {
  if (library_) ::dlclose(library_);
}

std::vector<TrephineArmInfo> DevicePlugin::enumerate() const {
  const std::uint32_t count =
      std::min(api_->enumerate(nullptr, 0), std::uint32_t(kMaxArmsOfAPlugin));
  std::vector<TrephineArmInfo> infos(count, sized<TrephineArmInfo>());
  if (count == 0) return infos;
  // An arm may have come or gone in between.
  infos.resize(std::min(api_->enumerate(infos.data(), count), count));
  for (TrephineArmInfo& info : infos) {
    clean(info.bus_path);
    clean(info.serial);
    clean(info.model);
  }
  return infos;
}

std::string DevicePlugin::whyNone() const {
  const char* text = api_->last_error(nullptr);
  return text && *text ? lastSentence(*api_, nullptr) : std::string();
}

Result<std::unique_ptr<Device>> Device::open(std::shared_ptr<const DevicePlugin> plugin,
                                             const std::vector<std::uint32_t>& arms,
                                             const std::string& config) {
  const TrephineDeviceApi& api = plugin->api();
  const std::string where = tr("device '{}'", api.name);
  {
    std::lock_guard lock(leftBehind().mutex);
    for (std::uint32_t arm : arms) {
      if (!leftBehind().arms.contains({api.name, arm})) continue;
      return Error{code::kDeviceStuck, tr("This arm stopped answering before and was left behind"),
                   where, tr("Switch it off and on, then start Trephine again")};
    }
  }
  std::unique_ptr<Device> device(new Device);
  device->plugin_ = plugin;
  device->places_ = arms;
  const auto notThere = [&](TrephineDevice* handle) {
    return Error{code::kNoDevice, lastSentence(api, handle), where,
                 tr("Connect the arm and switch it on, or choose another device")};
  };
  if (api.open(arms.data(), std::uint32_t(arms.size()), &device->handle_) != TREPHINE_OK ||
      !device->handle_) {
    device->handle_ = nullptr;  // what comes with an error is none
    return notThere(nullptr);
  }
  const int configured = api.configure(device->handle_, config.c_str());
  if (configured == TREPHINE_ERROR_NO_DEVICE) return notThere(device->handle_);
  if (configured != TREPHINE_OK) {
    return Error{code::kBadDeviceConfig, lastSentence(api, device->handle_),
                 tr("configuration of {}", where), tr("Correct that file")};
  }
  for (std::uint32_t arm = 0; arm < arms.size(); ++arm) {
    auto capabilities = sized<TrephineCapabilities>();
    if (api.capabilities(device->handle_, arm, &capabilities) != TREPHINE_OK) {
      return badPlugin(tr("The plugin does not say what arm {} can do: {}", arm,
                          lastSentence(api, device->handle_)),
                       where);
    }
    if (std::string wrong = impossibleCapability(capabilities); !wrong.empty()) {
      return badPlugin(tr("The plugin states for arm {} an impossible {}", arm, wrong), where);
    }
    device->capabilities_.push_back(capabilities);
  }
  auto state = sized<TrephineArmState>();
  state.orientation[0] = 1.0;
  device->last_states_.assign(arms.size(), state);
  device->commands_.assign(arms.size(), sized<TrephineArmCommand>());
  return device;
}

Device::~Device() {
  if (!handle_) return;
  stop();
  plugin_->api().close(handle_);
}

Status Device::start() {
  const TrephineDeviceApi& api = plugin_->api();
  const auto failed = [&](Code code) {
    return Error{code, lastSentence(api, handle_), tr("device '{}'", api.name),
                 tr("Check the arm and start again")};
  };
  for (std::uint32_t arm = 0; arm < armCount(); ++arm) {
    if (api.calibrate(handle_, arm) != TREPHINE_OK) return failed(code::kNotCalibrated);
  }
  if (api.start(handle_) != TREPHINE_OK) return failed(code::kDeviceNotStarted);
  refused_ = false;
  running_ = true;
  return {};
}

void Device::stop() {
  if (!running_) return;
  running_ = false;
  plugin_->api().safe_stop(handle_);
  plugin_->api().stop(handle_);
}

void Device::leaveBehind() const {
  std::lock_guard lock(leftBehind().mutex);
  for (std::uint32_t arm : places_) leftBehind().arms.insert({plugin_->api().name, arm});
}

void Device::safeStop() {
  plugin_->api().safe_stop(handle_);
}

bool Device::read(double dt_s, TrephineArmState* states) {
  const std::size_t count = armCount();
  for (std::size_t i = 0; i < count; ++i) states[i] = last_states_[i];
  const bool good = plugin_->api().read(handle_, dt_s, states) == TREPHINE_OK && !refused_;
  for (std::size_t i = 0; i < count; ++i) {
    if (good) {
      last_states_[i] = states[i];
    } else {
      states[i] = last_states_[i];
      states[i].flags |= TREPHINE_ARM_LOST;
    }
  }
  return good;
}

void Device::write(const TrephineArmCommand* commands) {
  for (std::size_t i = 0; i < armCount(); ++i) {
    std::copy_n(commands[i].force_N, 3, commands_[i].force_N);
  }
  refused_ = plugin_->api().write(handle_, commands_.data()) != TREPHINE_OK;
}

bool Device::wait(double timeout_s) {
  return plugin_->api().wait(handle_, timeout_s) == TREPHINE_OK;
}

void Device::setTarget(std::size_t arm, const Pose& pose_m, double stiffness_N_per_m,
                       double damping_Ns_per_m) {
  const TrephineDeviceApi& api = plugin_->api();
  if (!api.set_target) return;
  const double position[3] = {pose_m.position.x, pose_m.position.y, pose_m.position.z};
  const double orientation[4] = {pose_m.orientation.w, pose_m.orientation.x, pose_m.orientation.y,
                                 pose_m.orientation.z};
  api.set_target(handle_, std::uint32_t(arm), position, orientation, stiffness_N_per_m,
                 damping_Ns_per_m);
}

}  // namespace trephine
