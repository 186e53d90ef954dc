// Two WoodenHaptics boards on two USB ports, their firmware emulated, through the real hidapi.
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "test_device.h"
#include "wooden_arm.h"
#include "wooden_firmware.h"

namespace trephine::conformance {
namespace {

using test::WoodenFirmware;
namespace wooden = woodenhaptics;

class WoodenDevice : public TestDevice {
 public:
  WoodenDevice() {
    wooden::Vector angles{};
    test::anglesAt({0.0, 0.0, 0.0}, angles);
    const wooden::Vector counts = test::countsAt(angles);
    for (std::size_t i = 0; i < 3; ++i) counts_[i] = std::int16_t(std::lround(counts[i]));
    angles_ = wooden::jointAngles({double(counts_[0]), double(counts_[1]), double(counts_[2])});
  }
  ~WoodenDevice() override { unplug(); }

  std::uint32_t arms() const override { return 2; }
  bool prepare(Trouble trouble, double after_s) override {
    if (trouble == Trouble::error) return false;
    unplug();
    for (int i = 0; i < 2; ++i) {
      const int fd = bed_.plugIn(test::woodenBoard(), i == 0 ? "1-1" : "1-2.3");
      fds_[std::size_t(i)] = fd;
      if (fd < 0) throw std::runtime_error("no board can be emulated: " + bed_.why());
      firmware_[std::size_t(i)] = std::make_unique<WoodenFirmware>(fd);
      firmware_[std::size_t(i)]->setCounts(counts_);
    }
    ending_ = false;
    if (trouble != Trouble::none) {
      troubles_ = std::thread([this, trouble, after_s] { begin(trouble, after_s); });
    }
    return true;
  }
  std::string whyNot(Trouble) const override { return "its reports have no room for a fault"; }
  std::string config() const override {
    return R"({"format": "trephine.device", "version": 1, "model": "emulated"})";
  }
  Vec3 force_N(std::uint32_t arm, const TrephineArmState&) override {
    const auto milliamps = firmware_[arm]->milliamps();
    wooden::Vector amps{};
    for (std::size_t i = 0; i < 3; ++i) amps[i] = 1e-3 * milliamps[i];
    const wooden::Vector f = test::forceOf(angles_, test::torquesOf(amps));
    return {f[1], f[2], f[0]};
  }
  double tolerance_N() const override { return 0.005; }  // of whole milliamperes

 private:
  void begin(Trouble trouble, double after_s) {
    while (!ending_ && firmware_[0]->since_s() < after_s) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));  // the device's own clock
    }
    if (ending_) return;
    switch (trouble) {
      case Trouble::silence:
        for (auto& each : firmware_) each->setState(WoodenFirmware::State::silent);
        break;
      case Trouble::no_numbers:
        for (auto& each : firmware_) each->setState(WoodenFirmware::State::garbage);
        break;
      case Trouble::unplugged:
        for (auto& each : firmware_) each->end();
        for (int fd : fds_) bed_.unplug(fd);
        break;
      case Trouble::blocking:
        for (int fd : fds_) bed_.block(fd, true);
        std::this_thread::sleep_for(std::chrono::duration<double>(kBlocked_s));  // so too
        for (int fd : fds_) bed_.block(fd, false);
        break;
      case Trouble::none:
      case Trouble::error:
        break;
    }
  }
  void unplug() {
    ending_ = true;
    if (troubles_.joinable()) troubles_.join();
    for (int i = 0; i < 2; ++i) {
      firmware_[std::size_t(i)].reset();
      bed_.unplug(fds_[std::size_t(i)]);
    }
  }

  test::HidTestbed bed_;
  std::array<std::unique_ptr<WoodenFirmware>, 2> firmware_;
  std::array<int, 2> fds_{-1, -1};
  std::array<std::int16_t, 3> counts_{};
  wooden::Vector angles_{};
  std::atomic<bool> ending_{false};
  std::thread troubles_;
};

}  // namespace

std::unique_ptr<TestDevice> makeTestDevice() {
  return std::make_unique<WoodenDevice>();
}

const char* pluginFile() {
  return TREPHINE_TEST_PLUGIN;
}

}  // namespace trephine::conformance
