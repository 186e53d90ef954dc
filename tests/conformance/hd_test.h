// What the tests ask of their own libHD: two arms, troubles, and the forces that arrived.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace trephine::test {

struct HdArm {
  std::atomic<std::uint32_t> error{0};   // reported in each frame; 0: none
  std::atomic<std::uint32_t> errors{0};  // how many frames more it is reported in
  std::atomic<std::uint32_t> calibration{0x5000};
  std::atomic<bool> there{true};
  std::atomic<double> swing_mm{0.0};  // of this one alone
  std::atomic<int> buttons{0};
  std::atomic<bool> in_holder{false};
  std::array<std::atomic<double>, 3> force_N{};  // since the last frame's end
  std::atomic<bool> enabled{false};
  std::atomic<std::uint64_t> error_frame{0};  // in which it was reported last
  static constexpr std::size_t kFrames = 131072;
  // By frame, around and around: the size of the force, the force, and when it was given.
  std::array<std::atomic<double>, kFrames> sent_N{};
  std::array<std::array<std::atomic<double>, 3>, kFrames> vector_N{};
  std::array<std::atomic<std::int64_t>, kFrames> sent_ns{};
};

struct HdTest {
  std::array<HdArm, 2> arms;
  std::atomic<bool> silent{false};                // the scheduler calls nobody
  std::atomic<bool> no_numbers{false};            // of positions
  std::atomic<double> block_s{0.0};               // the next end of a frame takes so long
  std::atomic<double> swing_mm{0.0};              // of both arms along z, once a second
  std::atomic<int> styles{0b110}, style_used{0};  // bits of calibration: automatic, inkwell
  std::atomic<std::uint64_t> frames{0};
  std::atomic<int> misuses{0};  // calls outside of a frame or an initialised device
  void reset() {
    for (HdArm& arm : arms) {
      arm.error = arm.errors = 0;
      arm.calibration = 0x5000;
      arm.there = true;
      arm.swing_mm = 0.0;
      arm.buttons = 0;
      arm.in_holder = false;
    }
    silent = no_numbers = false;
    block_s = swing_mm = 0.0;
    misuses = style_used = 0;
    styles = 0b110;
  }
};

// Exported by the test's libHD.so under this name.
using HdTestEntry = HdTest* (*)();
constexpr const char* kHdTestEntry = "trephine_hd_test";

}  // namespace trephine::test
