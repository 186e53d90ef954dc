// Arms that a person tries, in real time, and what may go wrong with them meanwhile. In a program
// of its own: it has device files of its own, and leaves a device behind.
#include "session/arm_trial.h"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>

#include "base/json.h"
#include "base/system.h"
#include "support.h"

namespace trephine {
namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// The simulated arms of a workstation on which these troubles await them.
class ArmTrialTest : public ::testing::Test {
 protected:
  void begin(const Json& troubles, std::uint32_t place) {
    Json json = *readJsonFile(resourceFolder() / "devices" / "omni.json");
    json.update(troubles);
    std::filesystem::create_directories(folder_ / "devices");
    std::ofstream(folder_ / "devices" / "simulated.json") << json.dump();
    ::setenv("TREPHINE_RESOURCES", folder_.path().c_str(), 1);
    FoundArm arm{"simulated", "simulated-" + std::to_string(place), "", "an arm", place};
    trial_ = ArmTrial::start({arm});
    ::unsetenv("TREPHINE_RESOURCES");
    ASSERT_FALSE(trial_->problem(0)) << trial_->problem(0)->sentence();
  }
  bool comes(const std::function<bool(const TriedArm&)>& condition) {
    return test::waitUntil([&] { return condition(trial_->state()[0]); });
  }
  static bool isLost(const TriedArm& arm) { return arm.flags & TREPHINE_ARM_LOST; }

  test::TemporaryFolder folder_;
  std::unique_ptr<ArmTrial> trial_;
};

TEST_F(ArmTrialTest, AnArmThatAnswersIsThere) {
  begin(Json::object(), 0);
  EXPECT_TRUE(comes([](const TriedArm& arm) { return arm.samples > 100; }));
  EXPECT_FALSE(isLost(trial_->state()[0]));
  const auto at = Clock::now();
  trial_.reset();
  EXPECT_LT(msSince(at), 500.0);
  begin(Json::object(), 0);  // and can be had again
}

TEST_F(ArmTrialTest, APoseThatIsNoNumberIsALostArmAndEndsItsForceTest) {
  begin({{"no_number_after_s", 0.5}}, 1);
  trial_->askForForce(0, 1.0);
  ASSERT_TRUE(comes([](const TriedArm& arm) { return arm.test == ForceTest::Phase::waiting; }));
  ASSERT_TRUE(comes(isLost));
  ASSERT_TRUE(comes([](const TriedArm& arm) { return arm.test == ForceTest::Phase::lost; }));
  EXPECT_TRUE(isFinite(trial_->state()[0].pose_m));
  EXPECT_EQ(trial_->state()[0].force_N, 0.0);
}

TEST_F(ArmTrialTest, OneWhoseCallDoesNotReturnIsLostAtOnceAndHoldsUpNobody) {
  begin({{"block_after_s", 0.5}, {"block_for_s", 3.0}}, 2);
  trial_->askForForce(0, 1.0);
  ASSERT_TRUE(comes([](const TriedArm& arm) { return arm.samples > 450; }));
  const auto from = Clock::now();
  ASSERT_TRUE(comes(isLost));
  EXPECT_LT(msSince(from), 1000.0);
  EXPECT_EQ(trial_->state()[0].test, ForceTest::Phase::lost);
  const auto at = Clock::now();
  trial_.reset();
  EXPECT_LT(msSince(at), 500.0);
  const auto again = ArmTrial::start({FoundArm{"simulated", "simulated-2", "", "an arm", 2}});
  ASSERT_TRUE(again->problem(0));
  EXPECT_EQ(again->problem(0)->code.str(), "DEVICE_STUCK");
}

}  // namespace
}  // namespace trephine
