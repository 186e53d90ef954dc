// Two SpaceMice on two USB ports, a wired and a wireless one, through the real hidapi. A force
// shows in how far it pushes the arm that their hand holds.
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>

#include "pedal_hid.h"
#include "test_device.h"

namespace trephine::conformance {
namespace {

using test::CapFirmware;
constexpr double kHand_N_per_m = 600.0;
constexpr double kHalfStep_m = 0.5 * 55e-6;  // of the encoders

class PedalDevice : public TestDevice {
 public:
  ~PedalDevice() override { unplug(); }

  std::uint32_t arms() const override { return 2; }
  bool prepare(Trouble trouble, double after_s) override {
    if (!whyNot(trouble).empty()) return false;
    unplug();
    for (std::size_t i = 0; i < 2; ++i) {
      const bool wireless = i == 1;
      fds_[i] = bed_.plugIn(test::spaceMouse(wireless), wireless ? "1-2.3" : "1-1");
      if (fds_[i] < 0) throw std::runtime_error("no SpaceMouse can be emulated: " + bed_.why());
      firmware_[i] = std::make_unique<CapFirmware>(fds_[i], wireless);
    }
    ending_ = false;
    if (trouble != Trouble::none) {
      troubles_ = std::thread([this, trouble, after_s] { begin(trouble, after_s); });
    }
    return true;
  }
  std::string whyNot(Trouble trouble) const override {
    if (trouble == Trouble::silence) return "a cap at rest sends nothing";
    if (trouble == Trouble::error) return "its reports have no room for a fault";
    if (trouble == Trouble::blocking) return "nothing is sent to it, so that no call can block";
    return {};
  }
  void beginTicks() override { ticks_.begin(); }
  void awaitTick() override { ticks_.await(); }
  std::string config() const override {
    return R"({"format": "trephine.device", "version": 1, "model": "emulated"})";
  }
  Vec3 force_N(std::uint32_t, const TrephineArmState& state) override {
    const double* p = state.position_m;
    return kHand_N_per_m * Vec3(p[0], p[1], p[2]);
  }
  double tolerance_N() const override { return 0.001 + 1.75 * kHand_N_per_m * kHalfStep_m; }

 private:
  void begin(Trouble trouble, double after_s) {
    const auto pass_ms = [](int ms) {
      std::this_thread::sleep_for(std::chrono::milliseconds(ms));  // the device's own clock
    };
    while (!ending_ && !test::isOpen(fds_[1])) pass_ms(1);
    for (int ms = 0; !ending_ && ms < int(1000.0 * after_s); ++ms) pass_ms(1);
    if (ending_) return;
    for (auto& each : firmware_) {
      if (trouble == Trouble::no_numbers) {
        each->sendGarbage();
      } else {
        each->end();
      }
    }
    if (trouble == Trouble::unplugged) bed_.unplug({fds_[0], fds_[1]});
  }
  void unplug() {
    ending_ = true;
    if (troubles_.joinable()) troubles_.join();
    for (auto& each : firmware_) each.reset();
    bed_.unplug({fds_[0], fds_[1]});
  }

  test::HidTestbed bed_;
  test::HostTicks ticks_;
  std::array<std::unique_ptr<CapFirmware>, 2> firmware_;
  std::array<int, 2> fds_{-1, -1};
  std::atomic<bool> ending_{false};
  std::thread troubles_;
};

}  // namespace

std::unique_ptr<TestDevice> makeTestDevice() {
  return std::make_unique<PedalDevice>();
}

const char* pluginFile() {
  return TREPHINE_TEST_PLUGIN;
}

}  // namespace trephine::conformance
