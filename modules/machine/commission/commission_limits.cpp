#include "machine/commission/commission_limits.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/tr.h"
#include "render/gl_limits.h"

namespace trephine {

namespace {

constexpr const char* kPriorityNext =
    trLater("As an administrator: adduser NAME trephine, for each account; then log in again");
constexpr const char* kNormalNext =
    trLater("It does not matter once priority is granted; see there");
constexpr const char* kLateNext =
    trLater("End what else works on this machine, and choose performance in its power settings");
constexpr const char* kDriverNext = trLater(
    "End other programs and commission again; update the graphics driver; without a card, expect "
    "coarse pictures while things move");

// Half a period late is a missed tick (haptics/loop_clock.h); a quarter leaves room for the tick.
constexpr CommissionLimit kLimits[] = {
    {"lateness_1000_fifo", trLater("Ticks at 1000 Hz with priority: late by, 99.9 %"), "us", false,
     250.0, 500.0, trLater("half a period late is a missed tick"), kLateNext},
    {"lateness_2000_fifo", trLater("Ticks at 2000 Hz with priority: late by, 99.9 %"), "us", false,
     125.0, std::nullopt, trLater("half a period; exercises of 2000 Hz alone need it"), kLateNext},
    {"lateness_4000_fifo", trLater("Ticks at 4000 Hz with priority: late by, 99.9 %"), "us", false,
     62.5, std::nullopt, trLater("half a period; exercises of 4000 Hz alone need it"), kLateNext},
    {"lateness_1000_normal", trLater("Ticks at 1000 Hz without priority: late by, 99.9 %"), "us",
     false, 500.0, std::nullopt, trLater("how the machine does where priority is not granted"),
     kNormalNext},
    {"lateness_2000_normal", trLater("Ticks at 2000 Hz without priority: late by, 99.9 %"), "us",
     false, 250.0, std::nullopt, trLater("how the machine does where priority is not granted"),
     kNormalNext},
    {"lateness_4000_normal", trLater("Ticks at 4000 Hz without priority: late by, 99.9 %"), "us",
     false, 125.0, std::nullopt, trLater("how the machine does where priority is not granted"),
     kNormalNext},
    {"touch_cost", trLater("Touch with the recommended settings, one arm"), "% of a processor",
     false, 25.0, 45.0, trLater("two arms are served one after the other, in one tick"),
     trLater("Use exercises of a lower rate, and end what else works on this machine")},
    {"priority", trLater("Real-time priority"), "granted", true, 1.0, std::nullopt,
     trLater("without it any program makes ticks late"), kPriorityNext},
    {"locked_memory", trLater("Memory that may be held in place"), "MB", true, 3000.0, std::nullopt,
     trLater("a case of 512 x 512 x 600 needs 2.5 GB, and what is swapped out makes a tick late"),
     kPriorityNext},
    {"opengl", trLater("Graphics card"), "drawn by", true, 1.0, std::nullopt,
     trLater("processors draw coarse pictures while things move"), kDriverNext},
    {"volume_edge", trLater("Longest edge of a case that is drawn"), "voxels", true, 512.0, 512.0,
     trLater(
         "a CT has 512 rows and columns; the largest case that is kept counts where it is larger"),
     trLater("Update the graphics driver, or import large cases at half resolution")},
    {"frame_time", trLater("A picture while the camera turns"), "ms", false, 33.0, 100.0,
     trLater("30 pictures a second; below 10 a hand cannot follow"), kDriverNext},
    {"removal_to_pixel", trLater("Tissue that is cut until it is gone from the picture, at most"),
     "ms", false, 100.0, 250.0, trLater("what is seen later is taken for the next stroke"),
     kDriverNext},
    {"hand_to_tool", trLater("A hand that moves until its tool is seen there, 99 %"), "ms", false,
     60.0, 150.0, trLater("beyond it hand and eye part"), kDriverNext},
    {"disk_write", trLater("Writing to the folder of cases"), "MB/s", true, 50.0, 5.0,
     trLater("a case of 500 MB is saved within 10 s; a recording writes below 1 MB/s"),
     trLater("Choose a folder on a local disk under Settings, or in /etc/trephine/settings.json")},
    {"disk_room", trLater("Room in the folder of cases"), "GB", true, 20.0, 2.0,
     trLater("a case takes up to 0.5 GB, an hour of recordings 0.3 GB"),
     trLater("Free some space, or choose another folder of cases")},
    {"memory", trLater("Memory that is free"), "GB", true, 4.0, 2.5,
     trLater("a case of 512 x 512 x 600 needs 2.5 GB while it is practised on"),
     trLater("End other programs, or add memory")},
    {"clock", trLater("Clock: time since this version of Trephine was made"), "years", true, 0.0,
     0.0, trLater("recordings are named and sorted by the clock"), trLater("Set the clock")},
    {"screen", trLater("Room on the screen"), "lines", true, 800.0, 500.0,
     trLater("the views beside the panels; below 500 lines parts of the window do not fit"),
     trLater("Use a screen of 1280 x 800 or more")},
    {"arms", trLater("Arms that are plugged in"), "arms", true, 2.0, std::nullopt,
     trLater("both hands feel; without arms, mouse and keys move the hands"),
     trLater("Plug them in, and see File, Devices")},
    {"arm_encoders", trLater("Arms at rest: how far their samples scatter, the worst"), "steps",
     false, 1.0, 5.0,
     trLater("counting alone makes up to half a step of the encoder; more is felt as a tremble"),
     trLater("Check its cables and encoders, and keep other devices off its USB port")},
    {"arm_forces", trLater("Arms that are pushed: how much of the way they go, the least"), "of 1",
     true, 0.07, -0.05,
     trLater("a firm hand lets a tenth of the way; below 0 the arm goes against the force, and "
             "every force "
             "of an exercise would drive it on"),
     trLater(
         "Hold it lightly, and check its motors' cables; below 0 do not practise with it: have its "
         "encoders and motors mended")},
    {"headset", "OpenXR's loader", "installed", true, 1.0, std::nullopt,
     trLater("a headset alone needs it"),
     trLater("Install the package libopenxr-loader1, if there is a headset")},
};

}  // namespace

const char* nameOf(Fitness verdict) {
  return verdict == Fitness::pass ? "pass" : verdict == Fitness::warn ? "warn" : "fail";
}

std::span<const CommissionLimit> commissionLimits() {
  return kLimits;
}

const CommissionLimit* commissionLimit(const std::string& name) {
  const auto found =
      std::ranges::find_if(kLimits, [&](const CommissionLimit& each) { return each.name == name; });
  return found == std::end(kLimits) ? nullptr : &*found;
}

CommissionCheck judged(const std::string& name, double value, std::string remark,
                       std::optional<double> needed) {
  const CommissionLimit* by = commissionLimit(name);
  if (!by) std::abort();  // a name that the table lacks is a mistake of ours
  CommissionCheck check{name,     tr(by->words), value, by->unit,
                        by->warn, Fitness::pass, "",    std::move(remark)};
  const auto beyond = [&](double limit) {
    return !std::isfinite(value) || (by->at_least ? value < limit : value > limit);
  };
  std::optional<double> fail = by->fail;
  if (fail && needed) fail = std::max(*fail, *needed);
  if (fail && beyond(*fail)) {
    check.verdict = Fitness::fail;
    check.limit = fail;
  } else if (beyond(by->warn)) {
    check.verdict = Fitness::warn;
  }
  if (check.verdict != Fitness::pass) check.next = tr(by->next);
  if (!std::isfinite(value)) check.value.reset();
  return check;
}

CommissionCheck judgedCard(const std::string& driver) {
  return judged("opengl", isSoftware(driver) ? 0.0 : 1.0, driver);
}

// A screen that is higher than wide has as many lines as its width allows.
CommissionCheck judgedScreen(const std::array<int, 2>& size) {
  return judged("screen", double(std::min(size[1], size[0] * 5 / 8)),
                std::to_string(size[0]) + " x " + std::to_string(size[1]));
}

CommissionCheck notMeasured(const std::string& name, Fitness verdict, const Error& why) {
  const CommissionLimit* by = commissionLimit(name);
  if (!by) std::abort();
  return {name,
          tr(by->words),
          {},
          by->unit,
          by->warn,
          verdict,
          why.next.empty() ? tr(by->next) : why.next,
          why.what};
}

}  // namespace trephine
