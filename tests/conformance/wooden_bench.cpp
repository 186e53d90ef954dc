// A bench for `trephine-lab measure devices`: two emulated WoodenHaptics boards in hands that swing
// them. The program has to run under umockdev-wrapper.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "device/device_bench.h"
#include "wooden_arm.h"
#include "wooden_firmware.h"

namespace trephine {
namespace {

using test::WoodenFirmware;
using woodenhaptics::Vector;

// A point mass in a hand that leads it to and fro along the arm's x, under the motors' force.
struct Swung {
  Vector at_m{}, speed_m_s{}, angles{};

  void step(const Vector& force_N, double time_s) {
    constexpr double kMass_kg = 0.15, kHand_N_per_m = 400.0, kHand_Ns_per_m = 6.0, kT_s = 1e-3;
    const Vector hand{0.025 * std::sin(2.0 * std::numbers::pi * 0.5 * time_s), 0.0, 0.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double pull = force_N[axis] + kHand_N_per_m * (hand[axis] - at_m[axis]) -
                          kHand_Ns_per_m * speed_m_s[axis];
      speed_m_s[axis] += kT_s * pull / kMass_kg;
      at_m[axis] += kT_s * speed_m_s[axis];
    }
  }
};

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
      step(arm, 0.0);
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
    const Vector f = forceAt(arms_[arm]);
    return std::hypot(f[0], f[1], f[2]);
  }
  std::optional<std::uint64_t> lost() override {
    std::uint64_t lost = 0;
    for (const Arm& arm : arms_) lost += arm.firmware ? arm.firmware->lost() : 0;
    return lost;
  }
  std::vector<double> answers_ms() override {
    std::vector<double> all;
    for (Arm& arm : arms_) {
      if (!arm.firmware) continue;
      for (double us : arm.firmware->answers_us()) all.push_back(1e-3 * us);
    }
    return all;
  }

 private:
  struct Arm {
    int fd = -1;
    std::unique_ptr<WoodenFirmware> firmware;
    Swung swung;
  };

  static Vector forceAt(const Arm& arm) {
    Vector amps{};
    const auto milliamps = arm.firmware->milliamps();
    for (std::size_t i = 0; i < 3; ++i) amps[i] = 1e-3 * milliamps[i];
    return test::forceOf(arm.swung.angles, test::torquesOf(amps));
  }
  static void step(Arm& arm, double time_s) {
    arm.swung.step(time_s > 0.0 ? forceAt(arm) : Vector{}, time_s);
    if (!test::anglesAt(arm.swung.at_m, arm.swung.angles)) return;
    const Vector counts = test::countsAt(arm.swung.angles);
    arm.firmware->setCounts({std::int16_t(std::lround(counts[0])),
                             std::int16_t(std::lround(counts[1])),
                             std::int16_t(std::lround(counts[2]))});
  }
  void swing() {
    auto due = WoodenFirmware::Clock::now();
    for (double time_s = 1e-3; !ending_; time_s += 1e-3) {
      due += std::chrono::milliseconds(1);
      std::this_thread::sleep_until(due);
      std::lock_guard lock(mutex_);
      for (Arm& arm : arms_) {
        if (arm.fd >= 0) step(arm, time_s);
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
