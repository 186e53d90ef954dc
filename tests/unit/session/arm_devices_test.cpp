// The devices that an exercise names, and their files.
#include <sys/stat.h>

#include <functional>

#include "base/file.h"
#include "cases.h"
#include "session_support.h"
#include "support.h"

namespace trephine {
namespace {

using test::cranium;
using test::smallHead;

// The one-arm exercise with a device file of its own.
Error errorWithDeviceFile(const std::function<void(Json&)>& change, double rate_hz = 1000.0) {
  test::TemporaryFolder folder;
  Json device = *readJsonFile(resourceFolder() / "devices" / "omni.json");
  change(device);
  EXPECT_TRUE(writeTextFile(folder / "device.json", device.dump()));
  Exercise exercise = *readExercise(resourceFolder() / "scenes" / "cranium-one-arm.json");
  exercise.rate_hz = rate_hz;
  SessionOptions options;
  options.rig = simulatedRig(exercise);
  options.rig.arms[0].device.config = (folder / "device.json").string();
  const auto session = Session::create(test::placed(exercise, smallHead()), options);
  return session ? Error{} : session.error();
}

TEST(Session, NamesFileFieldAndValueOfAWrongDeviceFile) {
  const Error error =
      errorWithDeviceFile([](Json& d) { d["arm"]["peak_force_N"]["value"] = 1e300; });
  EXPECT_EQ(error.code.str(), "BAD_DEVICE_CONFIG");
  for (const char* part : {"device.json", "arm.peak_force_N.value", "1e+300"}) {
    EXPECT_NE(error.sentence().find(part), std::string::npos) << error.sentence();
  }
}

TEST(Session, RefusesADeviceFileNestedWithoutEndAndOneThatIsAPipe) {
  test::TemporaryFolder folder;
  const Exercise exercise = *readExercise(resourceFolder() / "scenes" / "cranium-one-arm.json");
  SessionOptions options;
  options.rig = simulatedRig(exercise);
  const std::size_t depth = 100'000;
  ASSERT_TRUE(writeTextFile(folder / "deep.json", R"({"format": )" + std::string(depth, '[') +
                                                      std::string(depth, ']') + "}"));
  ASSERT_EQ(::mkfifo((folder / "pipe.json").c_str(), 0600), 0);
  for (const char* name : {"deep.json", "pipe.json"}) {
    options.rig.arms[0].device.config = (folder / name).string();
    const auto session = Session::create(test::placed(exercise, smallHead()), options);
    ASSERT_FALSE(session.ok()) << name;
    EXPECT_NE(session.error().where.find(name), std::string::npos) << session.error().sentence();
  }
}

TEST(Session, RefusesARateThatTheDeviceCannotKeep) {
  const auto slow = [](Json& d) { d["arm"]["rate_hz"]["value"] = 500; };
  const Error error = errorWithDeviceFile(slow, 1000.0);
  EXPECT_EQ(error.code.str(), "BAD_SCENE");
  EXPECT_EQ(error.where, "rate_hz");
  EXPECT_NE(error.what.find("1000 Hz"), std::string::npos) << error.what;
  EXPECT_NE(error.what.find("at most 500 Hz"), std::string::npos) << error.what;
  EXPECT_EQ(errorWithDeviceFile(slow, 500.0).code.str(), "");
}

TEST(Session, SaysWhenAPluginIsMissing) {
  const Exercise exercise = cranium();
  SessionOptions options;
  options.rig = simulatedRig(exercise);
  for (Rig::Arm& arm : options.rig.arms) arm.device.plugin = "nosuch";
  auto session = Session::create(test::placed(exercise, smallHead()), options);
  ASSERT_FALSE(session.ok());
  EXPECT_EQ(session.error().code.str(), "NO_PLUGIN");
}

}  // namespace
}  // namespace trephine
