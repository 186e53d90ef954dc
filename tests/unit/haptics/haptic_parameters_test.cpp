// What the core may be made of.
#include "haptics/haptic_parameters.h"

#include <functional>
#include <limits>

#include "haptics/haptic_loop.h"
#include "haptics_support.h"

namespace trephine {
namespace {

TEST(HapticParameters, ThatAreImpossibleAreRefusedByNameAndValue) {
  ASSERT_TRUE(validate(test::oneArm()).ok());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Wrong {
    std::function<void(HapticParameters&)> change;
    const char* where;
    const char* value;
  };
  const Wrong cases[] = {
      {[](auto& p) { p.arms[0].dynamics.delay_s = 17 * p.period_s; }, "arm 0: delay_s", "17"},
      {[](auto& p) { p.arms[0].dynamics.delay_s = -5; }, "arm 0: delay_s", "-5"},
      {[](auto& p) { p.arms[0].dynamics.apparent_mass_kg = 0.0; }, "arm 0: apparent_mass_kg", "0"},
      {[](auto& p) { p.arms[0].dynamics.encoder_step_m = 1.0; }, "arm 0: encoder_step_m", "1"},
      {[&](auto& p) { p.arms[0].dynamics.peak_force_N = nan; }, "arm 0: peak_force_N", "nan"},
      {[](auto& p) { p.arms[0].max_force_N = -1.0; }, "arm 0: max_force_N", "-1"},
      {[](auto& p) { p.arms[0].map.motion_scale = 0.0; }, "arm 0: motion_scale", "0"},
      {[](auto& p) { p.arms[0].map.force_scale = 1e3; }, "arm 0: force_scale", "1000"},
      {[&](auto& p) { p.arms[0].map.centre_mm.y = nan; }, "arm 0: centre_mm", "nan"},
      {[](auto& p) { p.arms[0].map.rotation = Quat(0.5, 0, 0, 0); }, "arm 0: rotation_wxyz", "0.5"},
      {[](auto& p) { p.period_s = 0.0; }, "the loop: period_s", "0"},
      {[](auto& p) { p.arms.assign(kMaxArms + 1, p.arms[0]); }, "the arms", "5"},
      {[](auto& p) { p.tissues.classes[0].friction_N = -1.0; }, "tissue 0: friction_N", "-1"},
  };
  for (const Wrong& wrong : cases) {
    HapticParameters parameters = test::oneArm();
    wrong.change(parameters);
    const Status status = validate(parameters);
    ASSERT_FALSE(status.ok()) << wrong.where;
    EXPECT_EQ(status.error().where, wrong.where);
    EXPECT_NE(status.error().what.find(wrong.value), std::string::npos)
        << status.error().sentence();
  }
}

TEST(HapticParameters, ThatContradictTouchByPointsAreRefused) {
  HapticParameters good = test::oneArm();
  good.laws = {LawKind::viscous};
  good.touch_by_points = 1;
  ASSERT_TRUE(validate(good).ok());
  struct Wrong {
    std::function<void(HapticParameters&)> change;
    const char* value;
  };
  const Wrong cases[] = {
      {[](auto& p) { p.laws.push_back(LawKind::elastic); }, "`elastic`"},
      {[](auto& p) { p.laws = {LawKind::coulomb}; }, "`coulomb`"},
      {[](auto& p) { p.force_at = ForceAt::distributed; }, "`distributed`"},
      {[](auto& p) { p.removal = RemovalKind::work; }, "`work`"},
      {[](auto& p) { p.touch_by_points = 2; }, "none of the 1"},
  };
  for (const Wrong& wrong : cases) {
    HapticParameters parameters = good;
    wrong.change(parameters);
    const Status status = validate(parameters);
    ASSERT_FALSE(status.ok()) << wrong.value;
    EXPECT_EQ(status.error().code.str(), "CONTRADICTION");
    EXPECT_EQ(status.error().where, "touch_by_points");
    EXPECT_NE(status.error().what.find(wrong.value), std::string::npos)
        << status.error().sentence();
    parameters.touch_by_points = 0;
    EXPECT_TRUE(validate(parameters).ok()) << wrong.value << " by the other rule";
  }
}

TEST(HapticParameters, ThatAreImpossibleStartNoLoop) {
  HapticParameters parameters = test::oneArm();
  parameters.arms[0].map.motion_scale = 1e6;
  test::Bench bench(parameters);
  HapticLoop loop(bench.core, {}, nullptr);
  const Status started = loop.startDevices();
  ASSERT_FALSE(started.ok());
  EXPECT_EQ(started.error().code.str(), "IMPOSSIBLE_NUMBER");
}

}  // namespace
}  // namespace trephine
