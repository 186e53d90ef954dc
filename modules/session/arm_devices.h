// The devices that move an exercise's arms, and what they say of those arms.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/result.h"
#include "device/find_arms.h"
#include "haptics/haptic_loop.h"
#include "exercise/exercise.h"

namespace trephine {

// The text of a file that configures a plugin's arms, "{}" for none: held to the rules of every
// JSON file before the plugin sees it.
Result<std::string> readDeviceFile(const std::string& file);

// Arms of one plugin, by their places in its enumeration. Errors: those of plugins, files, devices.
Result<std::unique_ptr<Device>> openDevice(const std::string& plugin,
                                           const std::vector<std::uint32_t>& places,
                                           const std::string& config);

// Opens one device for each plugin and file of configuration, holding all of the exercise's arms
// that it moves by `rig`, without starting it; and the pedal, where there is one.
// `capabilities` has one an arm afterwards; the dynamics of the rig's arms and the force limits [N]
// of the exercise's are those of the devices. Errors: those of the devices, BAD_SCENE where a
// device cannot do what the exercise asks of it. Any thread that has them alone.
Status openDevices(Exercise& exercise, Rig& rig, std::vector<LoopDevice>& devices,
                   std::vector<TrephineCapabilities>& capabilities);

// Asks the plugins of a rig what its arms are, without starting them: fills in their dynamics, with
// the most that the devices give. And how far each arm reaches: the full extents of its workspace,
// device axes, mm, one an arm of the exercise, in its order. The devices are opened and closed
// again; openDevices() does not need it. After an error the rig is as it was. Errors: as above.
Status readArmDynamics(const Exercise& exercise, Rig& rig, std::vector<Vec3>* workspaces_mm = nullptr);

// A device that a workstation has chosen for the exercise's arm of that name, as it is plugged in
// now. Errors: NO_DEVICE, or why its plugin cannot be asked.
Result<ArmDevice> deviceOf(const FoundArm& wanted, const std::string& arm, const FoundArms& here);

// The devices that a workstation has chosen, by the exercise's name of an arm ("left", "right"), and
// of kPedal; an arm that is absent is simulated.
using ChosenArms = std::map<std::string, FoundArm>;

// The exercise's arms of these names moved by these devices, the others simulated. It asks what is
// plugged in: not on a window's thread. Errors: those of deviceOf() and rigWith().
Result<Rig> rigOf(const Exercise& exercise, const ChosenArms& chosen);

}  // namespace trephine
