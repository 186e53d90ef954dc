// The simulated arms as they ship, with encoders that read exactly and without friction, so that a
// force shows in how far it moves the hand.
#include "base/json.h"
#include "base/system.h"
#include "test_device.h"

namespace trephine::conformance {
namespace {

constexpr double kHand_N_per_m = 300.0;  // of the hand that holds an arm until it is told otherwise

class SimulatedDevice : public TestDevice {
 public:
  std::uint32_t arms() const override { return 2; }
  bool prepare(Trouble trouble, double after_s) override {
    config_ = *readJsonFile(resourceFolder() / "devices" / "omni.json");
    config_["arm"]["encoder_step_m"]["value"] = 0.0;
    config_["arm"].erase("friction_N");
    switch (trouble) {
      case Trouble::none:
        break;
      case Trouble::silence:
        config_["silent_after_s"] = after_s;
        break;
      case Trouble::unplugged:
        config_["vanish_after_s"] = after_s;
        break;
      case Trouble::error:
        config_["error_after_s"] = after_s;
        config_["error_for_s"] = 1.0;
        break;
      case Trouble::no_numbers:
        config_["no_number_after_s"] = after_s;
        break;
      case Trouble::blocking:
        config_["block_after_s"] = after_s;
        config_["block_for_s"] = kBlocked_s;
        break;
    }
    return true;
  }
  std::string config() const override { return config_.dump(); }
  Vec3 force_N(std::uint32_t, const TrephineArmState& state) override {
    const double* p = state.position_m;
    return kHand_N_per_m * Vec3(p[0], p[1], p[2]);
  }
  double tolerance_N() const override { return 0.01; }

 private:
  Json config_;
};

}  // namespace

std::unique_ptr<TestDevice> makeTestDevice() {
  return std::make_unique<SimulatedDevice>();
}

const char* pluginFile() {
  return TREPHINE_TEST_PLUGIN;
}

}  // namespace trephine::conformance
