#include "base/system.h"

#include <gtest/gtest.h>

#include <cstdlib>

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

TEST(System, WhatLoadsCodeIsTakenOutOfTheEnvironmentWhereItKeepsToItsOwnFolders) {
  const Environment hdf5("HDF5_PLUGIN_PATH", "/x"), qt("QT_PLUGIN_PATH", "/x"),
      platform("QT_QPA_PLATFORM_PLUGIN_PATH", "/x"), runtime("XR_RUNTIME_JSON", "/x"),
      layers("XR_API_LAYER_PATH", "/x"), openssl("OPENSSL_CONF", "/x"),
      dictionary("DCMDICTPATH", "/x"), drivers("LIBGL_DRIVERS_PATH", "/x"),
      plugins("TREPHINE_PLUGINS", "/x"), resources("TREPHINE_RESOURCES", "/x"),
      display("DISPLAY", ":7"), software("LIBGL_ALWAYS_SOFTWARE", "1");
  keepToOwnFolders();
  for (const char* name : {"HDF5_PLUGIN_PATH", "QT_PLUGIN_PATH", "QT_QPA_PLATFORM_PLUGIN_PATH",
                           "XR_RUNTIME_JSON", "XR_API_LAYER_PATH", "OPENSSL_CONF", "DCMDICTPATH",
                           "LIBGL_DRIVERS_PATH", "TREPHINE_PLUGINS", "TREPHINE_RESOURCES"}) {
    EXPECT_EQ(std::getenv(name), nullptr) << name;
  }
  EXPECT_STREQ(std::getenv("DISPLAY"), ":7");
  EXPECT_STREQ(std::getenv("LIBGL_ALWAYS_SOFTWARE"), "1") << "it names no code";
}

}  // namespace
}  // namespace trephine
