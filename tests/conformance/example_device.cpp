// The example's one arm: it stands still and shows the last force in the place of its tip.
#include "test_device.h"

namespace trephine::conformance {
namespace {

class ExampleDevice : public TestDevice {
 public:
  std::uint32_t arms() const override { return 1; }
  bool prepare(Trouble trouble, double) override { return trouble == Trouble::none; }
  std::string whyNot(Trouble) const override { return "there is no device behind the example"; }
  std::string config() const override {
    return "{\"format\": \"trephine.device\", \"version\": 1}";
  }
  Vec3 force_N(std::uint32_t, const TrephineArmState& state) override {
    const double* p = state.position_m;
    return 100.0 * Vec3(p[0], p[1], p[2]);
  }
  double tolerance_N() const override { return 1e-9; }
};

}  // namespace

std::unique_ptr<TestDevice> makeTestDevice() {
  return std::make_unique<ExampleDevice>();
}

const char* pluginFile() {
  return TREPHINE_TEST_PLUGIN;
}

}  // namespace trephine::conformance
