// What a plugin's conformance test needs of the device behind it: two arms that can be brought into
// trouble, and the force that they have. One implementation a plugin.
#pragma once

#include <memory>
#include <string>

#include "base/math.h"
#include "device/trephine_device.h"

namespace trephine::conformance {

enum class Trouble {
  none,
  silence,     // no sample comes any more
  unplugged,   // it is gone
  error,       // it reports a fault of its own
  no_numbers,  // what it sends is no number, or nothing that can be one
  blocking     // a call to it does not return for kBlocked_s
};
constexpr double kBlocked_s = 0.3;

class TestDevice {
 public:
  virtual ~TestDevice() = default;
  virtual std::uint32_t arms() const = 0;
  // Plugs the arms in, and after so many seconds of samples brings them into trouble; false where
  // such a device cannot have it, and whyNot. Before the plugin opens them.
  virtual bool prepare(Trouble trouble, double after_s) = 0;
  virtual std::string whyNot(Trouble) const { return {}; }
  // Of a device without a clock of its own (`wait`), where the host's has to go as time does: it
  // was started, and then the host waits for its next tick.
  virtual void beginTicks() {}
  virtual void awaitTick() {}
  // Text for `configure`, as prepared.
  virtual std::string config() const = 0;
  // Where it can be told in another way than by the states: the force that an arm has now [N].
  // `state`: its newest one, after the same force for 0.6 s.
  virtual Vec3 force_N(std::uint32_t arm, const TrephineArmState& state) = 0;
  // Of force_N.
  virtual double tolerance_N() const = 0;
};

// Of the program's plugin: the device, and the library.
std::unique_ptr<TestDevice> makeTestDevice();
const char* pluginFile();

}  // namespace trephine::conformance
