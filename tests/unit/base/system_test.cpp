#include "base/system.h"

#include <gtest/gtest.h>

#include "support.h"

namespace trephine {
namespace {

using test::Environment;

TEST(System, APersonsFoldersAreWhereTheEnvironmentSaysElseAtHome) {
  const Environment home("HOME", "/people/anna"), config("XDG_CONFIG_HOME", ""),
      data("XDG_DATA_HOME", "/srv/data"), state("XDG_STATE_HOME", "not/from/the/root");
  EXPECT_EQ(configFolder(), "/people/anna/.config/trephine");
  EXPECT_EQ(dataFolder(), "/srv/data/trephine");
  EXPECT_EQ(stateFolder(), "/people/anna/.local/state/trephine");
}

TEST(System, AHomeThatIsNotGivenFromTheRootIsNone) {
  const Environment home("HOME", "anna"), config("XDG_CONFIG_HOME", ""), data("XDG_DATA_HOME", ""),
      state("XDG_STATE_HOME", "");
  EXPECT_FALSE(configFolder());
  EXPECT_FALSE(dataFolder());
  EXPECT_FALSE(stateFolder());
}

}  // namespace
}  // namespace trephine
