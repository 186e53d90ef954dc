// A bench for `trephine-measure devices`: two emulated WoodenHaptics boards in hands that swing
// them. The program has to run under umockdev-wrapper.
#include <array>
#include <cmath>
#include <memory>

#include "device/device_bench.h"
#include "wooden_hand.h"

namespace trephine {
namespace {

using test::WoodenFirmware;
using woodenhaptics::Vector;

class WoodenBench : public DeviceBench {
 public:
  ~WoodenBench() override { end(); }
  const char* plugin() const override { return "woodenhaptics"; }

  bool plugIn() override {
    end();
    bed_.reset();  // one at a time: it is an entry in the environment
    bed_ = std::make_unique<test::HidTestbed>();
    for (std::size_t i = 0; i < 2; ++i) {
      Arm& arm = arms_[i];
      arm = {};
      arm.fd = bed_->plugIn(test::woodenBoard(), i == 0 ? "1-1" : "1-2");
      if (arm.fd < 0) return false;
      arm.firmware = std::make_unique<WoodenFirmware>(arm.fd);
      arm.hand.step(*arm.firmware, Vector{}, 0.0);
    }
    ending_ = false;
    hands_ = std::thread([this] { swing(); });
    return true;
  }
  void unplug(std::uint32_t arm) override {
    std::lock_guard lock(mutex_);
    Arm& of = arms_[arm];
    of.firmware->end();
    bed_->unplug(of.fd);
    of.fd = -1;
  }
  void block(double seconds) override {
    for (Arm& arm : arms_) bed_->block(arm.fd, true);
    blocked_until_ =
        WoodenFirmware::Clock::now() + std::chrono::milliseconds(std::lround(1000.0 * seconds));
    blocked_ = true;
  }
  double force_N(std::uint32_t arm) override {
    std::lock_guard lock(mutex_);
    const Vector f = arms_[arm].hand.force_N(*arms_[arm].firmware);
    return std::hypot(f[0], f[1], f[2]);
  }
  std::optional<std::uint64_t> lost() override {
    std::uint64_t lost = 0;
    for (const Arm& arm : arms_) lost += arm.firmware ? arm.firmware->lost() : 0;
    return lost;
  }
  std::vector<Given> given(std::uint32_t arm) override {
    std::lock_guard lock(mutex_);
    const Arm& of = arms_[arm];
    std::vector<Given> all;
    if (!of.firmware) return all;
    std::size_t stood = 0;
    for (const WoodenFirmware::Told& told : of.firmware->told()) {
      while (stood + 1 < of.stood.size() && of.stood[stood + 1].at <= told.at) ++stood;
      if (of.stood.empty()) break;
      // The arm's x towards the user, y to the right, z up.
      const Vector f = test::WoodenHand::forceAt(told.milliamps, of.stood[stood].angles);
      all.push_back({ns(told.at), Vec3(f[1], f[2], f[0])});
    }
    return all;
  }
  std::vector<std::int64_t> samples_ns(std::uint32_t arm) override {
    std::vector<std::int64_t> all;
    if (!arms_[arm].firmware) return all;
    for (const auto at : arms_[arm].firmware->reportsSent()) all.push_back(ns(at));
    return all;
  }
  // Whole milliamperes, and two milliseconds of a hand's way.
  double tolerance_N() const override { return 0.03; }

 private:
  struct Arm {
    int fd = -1;
    std::unique_ptr<WoodenFirmware> firmware;
    test::WoodenHand hand;
    struct Stood {
      WoodenFirmware::Clock::time_point at;
      Vector angles;
    };
    std::vector<Stood> stood;  // each millisecond
  };
  static std::int64_t ns(WoodenFirmware::Clock::time_point at) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(at.time_since_epoch()).count();
  }

  void swing() {
    auto due = WoodenFirmware::Clock::now();
    for (double time_s = 1e-3; !ending_; time_s += 1e-3) {
      due += std::chrono::milliseconds(1);
      std::this_thread::sleep_until(due);  // the hands' own clock
      std::lock_guard lock(mutex_);
      for (Arm& arm : arms_) {
        if (arm.fd < 0) continue;
        arm.hand.step(*arm.firmware, arm.hand.force_N(*arm.firmware), time_s);
        arm.stood.push_back({WoodenFirmware::Clock::now(), arm.hand.angles()});
      }
      if (!blocked_ || WoodenFirmware::Clock::now() < blocked_until_) continue;
      for (Arm& arm : arms_) bed_->block(arm.fd, false);
      blocked_ = false;
    }
  }
  void end() {
    ending_ = true;
    if (hands_.joinable()) hands_.join();
    for (Arm& arm : arms_) {
      if (arm.fd >= 0 && blocked_) bed_->block(arm.fd, false);
      arm.firmware.reset();
      if (arm.fd >= 0) bed_->unplug(arm.fd);
      arm = {};
    }
    blocked_ = false;
  }

  std::unique_ptr<test::HidTestbed> bed_;
  std::array<Arm, 2> arms_;
  std::mutex mutex_;
  std::thread hands_;
  std::atomic<bool> ending_{false}, blocked_{false};
  WoodenFirmware::Clock::time_point blocked_until_{};
};

}  // namespace
}  // namespace trephine

extern "C" __attribute__((visibility("default"))) trephine::DeviceBench* trephine_device_bench() {
  static trephine::WoodenBench bench;
  return &bench;
}
