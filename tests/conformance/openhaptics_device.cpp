// Two arms of the test's own libHD, which the plugin opens as it would the maker's.
#include <dlfcn.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "hd_test.h"
#include "test_device.h"

namespace trephine::conformance {
namespace {

class OpenHapticsDevice : public TestDevice {
 public:
  OpenHapticsDevice() {
    void* library = ::dlopen("libHD.so", RTLD_NOW | RTLD_LOCAL);
    auto entry = library ? reinterpret_cast<test::HdTestEntry>(::dlsym(library, test::kHdTestEntry))
                         : nullptr;
    if (!entry) throw std::runtime_error("the libHD.so that was found is not the tests' own");
    hd_ = entry();
    hd_->reset();
  }
  ~OpenHapticsDevice() override { end(); }

  std::uint32_t arms() const override { return 2; }
  bool prepare(Trouble trouble, double after_s) override {
    end();
    hd_->reset();
    const std::uint64_t from = hd_->frames + std::uint64_t(after_s * 1000.0);
    troubles_ = std::thread([this, trouble, from] {
      while (!ending_ && hd_->frames < from) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));  // the device's own clock
      }
      if (!ending_) begin(trouble);
    });
    return true;
  }
  std::string config() const override {
    return R"({"format": "trephine.device", "version": 1, "model": "two arms",
               "names": ["Left Device", "Right Device"]})";
  }
  Vec3 force_N(std::uint32_t arm, const TrephineArmState&) override {
    const auto& f = hd_->arms[arm].force_N;
    return {f[0].load(), f[1].load(), f[2].load()};
  }
  double tolerance_N() const override { return 0.0; }

 private:
  void begin(Trouble trouble) {
    switch (trouble) {
      case Trouble::silence:
        hd_->silent = true;
        break;
      case Trouble::unplugged:
        for (test::HdArm& arm : hd_->arms) {
          arm.there = false;
          arm.error = 0x0302;
          arm.errors = 1'000'000;
        }
        break;
      case Trouble::error:
        for (test::HdArm& arm : hd_->arms) {
          arm.error = 0x0203;
          arm.errors = 1;
        }
        break;
      case Trouble::no_numbers:
        hd_->no_numbers = true;
        break;
      case Trouble::blocking:
        hd_->block_s = kBlocked_s;
        break;
      case Trouble::none:
        break;
    }
  }
  void end() {
    ending_ = true;
    if (troubles_.joinable()) troubles_.join();
    ending_ = false;
  }

  test::HdTest* hd_ = nullptr;
  std::atomic<bool> ending_{false};
  std::thread troubles_;
};

}  // namespace

std::unique_ptr<TestDevice> makeTestDevice() {
  return std::make_unique<OpenHapticsDevice>();
}

const char* pluginFile() {
  return TREPHINE_TEST_PLUGIN;
}

}  // namespace trephine::conformance
