// A bench for `trephine-measure devices`: the two arms of our own libHD.so, which the program
// has to find (LD_LIBRARY_PATH).
#include <dlfcn.h>

#include <algorithm>
#include <cmath>

#include "device/device_bench.h"
#include "hd_test.h"

namespace trephine {
namespace {

using test::HdTest;

class HdBench : public DeviceBench {
 public:
  const char* plugin() const override { return "openhaptics"; }

  bool plugIn() override {
    if (!library_) library_ = ::dlopen("libHD.so", RTLD_NOW | RTLD_LOCAL);
    const auto entry =
        library_ ? reinterpret_cast<test::HdTestEntry>(::dlsym(library_, test::kHdTestEntry))
                 : nullptr;
    hd_ = entry ? entry() : nullptr;
    if (!hd_) return false;
    hd_->reset();
    hd_->swing_mm = 25.0;
    first_ = hd_->frames;
    return true;
  }
  void unplug(std::uint32_t arm) override {
    HdTest& hd = *hd_;
    constexpr std::uint32_t kCommunication = 0x0302;
    hd.arms[arm].error = kCommunication;
    hd.arms[arm].there = false;
    hd.arms[arm].errors = 1'000'000'000;
  }
  void block(double seconds) override { hd_->block_s = seconds; }
  double force_N(std::uint32_t arm) override {
    const test::HdArm& of = hd_->arms[arm];
    if (!of.enabled) return 0.0;
    return std::sqrt(of.force_N[0] * of.force_N[0] + of.force_N[1] * of.force_N[1] +
                     of.force_N[2] * of.force_N[2]);
  }
  std::vector<Given> given(std::uint32_t arm) override {
    const test::HdArm& of = hd_->arms[arm];
    const std::uint64_t frames = hd_->frames;
    const std::uint64_t from = std::max(first_, frames - std::min(frames, kKept));
    std::vector<Given> all;
    for (std::uint64_t f = from; f < frames; ++f) {
      const std::size_t at = f % test::HdArm::kFrames;
      const auto& vector = of.vector_N[at];
      all.push_back(
          {of.sent_ns[at].load(), Vec3(vector[0].load(), vector[1].load(), vector[2].load())});
    }
    return all;
  }

 private:
  void* library_ = nullptr;
  HdTest* hd_ = nullptr;
  std::uint64_t first_ = 0;
  static constexpr std::uint64_t kKept = test::HdArm::kFrames - 100;  // none is written meanwhile
};

}  // namespace
}  // namespace trephine

extern "C" __attribute__((visibility("default"))) trephine::DeviceBench* trephine_device_bench() {
  static trephine::HdBench bench;
  return &bench;
}
