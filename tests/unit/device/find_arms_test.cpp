// What is plugged in, asked of a folder of plugins that are not all well.
#include "device/find_arms.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/file.h"
#include "support.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;

struct FindArms : ::testing::Test {
  void add(const fs::path& from, const char* as) { fs::copy_file(from, folder / as); }
  static fs::path simulated() {
    return fs::path(TREPHINE_TEST_PLUGIN_DIR) / "trephine_simulated.so";
  }

  test::TemporaryFolder folder;
};

TEST_F(FindArms, EachArmIsNamedByPluginPlaceAndWhatTellsItFromTheOthers) {
  add(simulated(), "trephine_simulated.so");
  const FoundArms found = findArms(folder.path());
  EXPECT_TRUE(found.problems.empty());
  ASSERT_EQ(found.arms.size(), 4u);
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(found.arms[i].plugin, "simulated");
    EXPECT_EQ(found.arms[i].place, i);
    EXPECT_FALSE(found.arms[i].model.empty());
    for (std::uint32_t j = 0; j < i; ++j) EXPECT_FALSE(found.arms[i].isSame(found.arms[j]));
  }
}

TEST_F(FindArms, ABrokenPluginAndOneOfAnotherInterfaceAreNamedAndTheRestIsFound) {
  add(simulated(), "trephine_simulated.so");
  add(fs::path(TREPHINE_TEST_ODD_PLUGIN_DIR) / "trephine_other_abi.so", "trephine_other_abi.so");
  ASSERT_TRUE(writeTextFile(folder / "trephine_broken.so", "this is no library"));
  ASSERT_TRUE(writeTextFile(folder / "notes.txt", "not looked at"));
  const FoundArms found = findArms(folder.path());
  EXPECT_EQ(found.arms.size(), 4u);
  ASSERT_EQ(found.problems.size(), 2u);
  EXPECT_NE(found.problems[0].sentence().find("trephine_broken.so"), std::string::npos);
  EXPECT_EQ(found.problems[1].code.str(), "BAD_PLUGIN");
  EXPECT_NE(found.problems[1].sentence().find("trephine_other_abi.so"), std::string::npos);
}

TEST_F(FindArms, OfTwoPluginsWithOneDeviceTheFirstHasItAndBothAreNamed) {
  add(simulated(), "trephine_simulated.so");
  add(simulated(), "trephine_twin.so");
  const FoundArms found = findArms(folder.path());
  EXPECT_EQ(found.arms.size(), 4u);
  EXPECT_TRUE(std::ranges::all_of(found.arms,
                                  [](const FoundArm& arm) { return arm.plugin == "simulated"; }));
  ASSERT_EQ(found.problems.size(), 4u) << "one a device";
  const std::string sentence = found.problems[0].sentence();
  for (const char* part : {"'simulated'", "'twin'", "sim-0"}) {
    EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
  }
}

TEST_F(FindArms, AFolderThatIsNotThereHasNone) {
  const FoundArms found = findArms(folder / "nowhere");
  EXPECT_TRUE(found.arms.empty());
  EXPECT_TRUE(found.problems.empty());
}

TEST(DeviceFile, IsTheProductsUnlessTheHospitalHasOne) {
  const std::string file = deviceFile("woodenhaptics");
  EXPECT_EQ(fs::path(file).filename(), "woodenhaptics.json");
  EXPECT_EQ(deviceFile("nosuch"), "");
}

}  // namespace
}  // namespace trephine
