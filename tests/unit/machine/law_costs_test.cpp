#include "machine/ticks/law_costs.h"

#include <gtest/gtest.h>

#include "base/system.h"

namespace trephine {
namespace {

Exercise cranium() {
  return *readExercise(resourceFolder() / "scenes" / "cranium.json");
}

// Which law costs how much is the machine's; that each is measured where tissue is touched, and
// that no law takes more than all of the tick, is not.
TEST(LawCosts, EveryLawAndEveryControllerHasAFigure) {
  const Result<LawCosts> costs = measureLawCosts(cranium());
  ASSERT_TRUE(costs.ok()) << costs.error().sentence();
  EXPECT_TRUE(costs->touched) << "a tool that waits, or is in the air, costs next to nothing";
  EXPECT_GT(costs->tick_ns, 50.0);
  EXPECT_GE(costs->noise_ns, 0.0);
  EXPECT_EQ(costs->law_ns.size(), kLawNames.size());
  EXPECT_EQ(costs->controller_ns.size(), kControllerNames.size());
  for (const auto& [law, ns] : costs->law_ns)
    EXPECT_LT(ns, costs->tick_ns + 3.0 * costs->noise_ns + 1000.0) << int(law);
  for (const auto& [kind, ns] : costs->controller_ns) EXPECT_GT(ns, 50.0);
}

TEST(LawCosts, IsCancelledAndSaysWhatIsMissing) {
  Progress progress;
  progress.cancel();
  EXPECT_EQ(measureLawCosts(cranium(), progress).error().code.str(), "CANCELLED");
  Exercise none = cranium();
  none.arms.clear();
  EXPECT_EQ(measureLawCosts(none).error().code.str(), "BAD_SCENE");
}

}  // namespace
}  // namespace trephine
