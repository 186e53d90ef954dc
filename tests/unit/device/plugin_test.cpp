// Finding and refusing plugin libraries.
#include <dlfcn.h>
#include <sys/stat.h>

#include <fstream>
#include <string>

#include "device_support.h"
#include "support.h"

namespace trephine {
namespace {

using test::TemporaryFolder;

Error refusal(const std::string& name, const std::filesystem::path& folder) {
  auto plugin = DevicePlugin::load(name, folder);
  if (plugin) return {Code("LOADED"), "", "", ""};
  return plugin.error();
}

Error oddRefusal(const std::string& name) {
  return refusal(name, TREPHINE_TEST_ODD_PLUGIN_DIR);
}

bool names(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(DevicePlugin, LoadsByNameFromItsFolder) {
  auto plugin = DevicePlugin::load("simulated", TREPHINE_TEST_PLUGIN_DIR);
  ASSERT_TRUE(plugin) << plugin.error().sentence();
  EXPECT_STREQ((*plugin)->api().name, "simulated");
  EXPECT_FALSE((*plugin)->api().wait) << "the host paces them";
}

TEST(DevicePlugin, EnumeratesFourSimulatedArmsToldApartByTheirBusPath) {
  auto plugin = test::simulatedPlugin();
  ASSERT_TRUE(plugin);
  const auto infos = plugin->enumerate();
  ASSERT_EQ(infos.size(), 4u);
  EXPECT_STREQ(infos[0].bus_path, "sim-0");
  EXPECT_STREQ(infos[1].bus_path, "sim-1");
  EXPECT_STREQ(infos[0].model, "Simulated arm");
}

TEST(DevicePlugin, WritesNoMoreInfosThanThereIsRoomFor) {
  auto plugin = test::simulatedPlugin();
  ASSERT_TRUE(plugin);
  TrephineArmInfo infos[2] = {};
  infos[0].size = infos[1].size = sizeof(TrephineArmInfo);
  EXPECT_EQ(plugin->api().enumerate(infos, 1), 4u);
  EXPECT_STREQ(infos[0].bus_path, "sim-0");
  EXPECT_STREQ(infos[1].bus_path, "");
}

TEST(DevicePlugin, TheSimulatedPluginAnswersOnlyTheAbiThatItSpeaks) {
  const std::string file = std::string(TREPHINE_TEST_PLUGIN_DIR) + "/trephine_simulated.so";
  void* library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  ASSERT_TRUE(library);
  auto entry = reinterpret_cast<TrephineDeviceEntry>(::dlsym(library, TREPHINE_DEVICE_ENTRY));
  ASSERT_TRUE(entry);
  EXPECT_TRUE(entry(TREPHINE_DEVICE_ABI));
  EXPECT_FALSE(entry(TREPHINE_DEVICE_ABI + 1));
  EXPECT_FALSE(entry(0));
  ::dlclose(library);
}

TEST(DevicePlugin, AMissingPluginIsNamedWithItsFolder) {
  TemporaryFolder folder;
  const Error error = refusal("touch", folder.path());
  EXPECT_EQ(error.code.str(), "NO_PLUGIN");
  EXPECT_TRUE(names(error.what, "'touch'")) << error.sentence();
  EXPECT_TRUE(names(error.where, "trephine_touch.so")) << error.sentence();
}

TEST(DevicePlugin, ANameThatLeadsOutOfTheFolderIsRefused) {
  for (const char* name : {"", "../simulated", "a/b", "Simulated", "sim ulated"}) {
    const Error error = refusal(name, TREPHINE_TEST_PLUGIN_DIR);
    EXPECT_EQ(error.code.str(), "NO_PLUGIN") << name;
    EXPECT_TRUE(names(error.what, "not the name of a device plugin")) << error.sentence();
  }
}

TEST(DevicePlugin, AFileThatIsNoLibraryIsRefused) {
  TemporaryFolder folder;
  std::ofstream(folder / "trephine_text.so") << "not a library";
  const Error error = refusal("text", folder.path());
  EXPECT_EQ(error.code.str(), "NO_PLUGIN");
  EXPECT_TRUE(names(error.what, "cannot be loaded")) << error.sentence();
}

TEST(DevicePlugin, ALibraryCutShortIsRefusedWhereverItEnds) {
  TemporaryFolder folder;
  const std::filesystem::path whole =
      std::filesystem::path(TREPHINE_TEST_PLUGIN_DIR) / "trephine_simulated.so";
  const std::filesystem::path cut = folder / "trephine_cut.so";
  const std::uintmax_t bytes = std::filesystem::file_size(whole);
  std::filesystem::copy_file(whole, cut);
  EXPECT_EQ(refusal("cut", folder.path()).code.str(), "LOADED") << "the whole file loads";
  for (int part = 19; part >= 0; --part) {
    std::filesystem::resize_file(cut, bytes * std::uintmax_t(part) / 20);
    const Error error = refusal("cut", folder.path());
    EXPECT_EQ(error.code.str(), "NO_PLUGIN") << part;
    EXPECT_TRUE(names(error.what, "cut short")) << error.sentence();
    EXPECT_TRUE(names(error.where, "trephine_cut.so")) << error.sentence();
  }
}

TEST(DevicePlugin, APipeInItsPlaceIsRefusedInsteadOfWaitedFor) {
  TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "trephine_pipe.so").c_str(), 0600), 0);
  EXPECT_EQ(refusal("pipe", folder.path()).code.str(), "NO_PLUGIN");
}

TEST(DevicePlugin, ALibraryWithoutTheEntryIsRefused) {
  const Error error = oddRefusal("no_entry");
  EXPECT_EQ(error.code.str(), "BAD_PLUGIN");
  EXPECT_TRUE(names(error.what, "trephine_device_plugin")) << error.sentence();
}

TEST(DevicePlugin, APluginThatDoesNotServeOurAbiIsRefused) {
  const Error error = oddRefusal("other_abi");
  EXPECT_EQ(error.code.str(), "BAD_PLUGIN");
  EXPECT_TRUE(names(error.what, "does not speak version " + std::to_string(TREPHINE_DEVICE_ABI))) << error.sentence();
}

TEST(DevicePlugin, ATableOfAnotherVersionIsRefused) {
  const Error error = oddRefusal("other_version");
  EXPECT_EQ(error.code.str(), "BAD_PLUGIN");
  EXPECT_TRUE(names(error.what, "version " + std::to_string(TREPHINE_DEVICE_ABI + 1))) << error.sentence();
}

TEST(DevicePlugin, ATableThatEndsEarlyIsRefused) {
  const Error error = oddRefusal("small_table");
  EXPECT_EQ(error.code.str(), "BAD_PLUGIN");
  EXPECT_TRUE(names(error.what, "bytes instead of")) << error.sentence();
}

TEST(DevicePlugin, ATableWithAHoleIsRefusedByTheMissingFunctionsName) {
  const Error error = oddRefusal("hole");
  EXPECT_EQ(error.code.str(), "BAD_PLUGIN");
  EXPECT_TRUE(names(error.what, "lacks 'stop'")) << error.sentence();
}

TEST(DevicePlugin, StaysLoadedWhileADeviceOfItLives) {
  std::unique_ptr<Device> device;
  {
    auto plugin = test::simulatedPlugin();
    ASSERT_TRUE(plugin);
    auto opened = Device::open(plugin, {0}, test::omni().dump());
    ASSERT_TRUE(opened) << opened.error().sentence();
    device = std::move(*opened);
  }
  EXPECT_TRUE(device->start());
}

}  // namespace
}  // namespace trephine
