// The device file, and the sentences with which a wrong one is refused.
#include <functional>
#include <string>

#include "device_support.h"

namespace trephine {
namespace {

using test::omni;

Error configRefusal(const std::string& config, std::vector<std::uint32_t> arms = {0, 1}) {
  auto plugin = test::simulatedPlugin();
  if (!plugin) return {};
  auto device = Device::open(plugin, arms, config);
  if (device) return {Code("OPENED"), "", "", ""};
  return device.error();
}

// The refusal of the Omni's file after one edit.
Error refusalAfter(const std::function<void(Json&)>& edit) {
  Json json = omni();
  edit(json);
  return configRefusal(json.dump());
}

void expectRefused(const Error& error, const std::string& field, const std::string& value) {
  EXPECT_EQ(error.code.str(), "BAD_DEVICE_CONFIG") << error.sentence();
  EXPECT_NE(error.what.find("'" + field + "'"), std::string::npos) << error.sentence();
  EXPECT_NE(error.what.find(value), std::string::npos) << error.sentence();
}

TEST(DeviceConfig, TheOmniHasTheCapabilitiesOfItsFile) {
  test::Bench bench(omni(), 2);
  ASSERT_TRUE(bench.device);
  ASSERT_EQ(bench.device->armCount(), 2u);
  for (std::size_t arm = 0; arm < 2; ++arm) {
    const TrephineCapabilities& c = bench.device->capabilities(arm);
    EXPECT_EQ(c.apparent_mass_kg, 0.045);
    EXPECT_EQ(c.encoder_step_m, 0.055e-3);
    EXPECT_EQ(c.workspace_m[0], 0.160);
    EXPECT_EQ(c.workspace_m[1], 0.120);
    EXPECT_EQ(c.workspace_m[2], 0.070);
    EXPECT_EQ(c.peak_force_N, 3.3);
    EXPECT_EQ(c.continuous_force_N, 0.88);
    EXPECT_EQ(c.input_dof, 6u);
  }
}

TEST(DeviceConfig, WarmthAndLatencyMayBeStatedAndAreNothingElse) {
  test::Bench usual(omni());
  ASSERT_TRUE(usual.device);
  EXPECT_EQ(usual.device->capabilities(0).thermal_s, 0.0);
  EXPECT_EQ(usual.device->capabilities(0).latency_s, 0.0);
  Json json = omni();
  json["arm"]["thermal_s"] = {{"value", 40.0}, {"source", "this test"}, {"verified", true}};
  json["arm"]["latency_s"] = {{"value", 0.0012}, {"source", "this test"}, {"verified", true}};
  test::Bench bench(json);
  ASSERT_TRUE(bench.device);
  EXPECT_EQ(bench.device->capabilities(0).thermal_s, 40.0);
  EXPECT_EQ(bench.device->capabilities(0).latency_s, 0.0012);
}

TEST(DeviceConfig, EveryNumberOfTheOmniSaysWhereItComesFrom) {
  const Json json = omni();
  ASSERT_TRUE(json.contains("arm"));
  for (const auto& [key, number] : json["arm"].items()) {
    EXPECT_FALSE(number.at("source").get<std::string>().empty()) << key;
    const bool remembered =
        number.at("source").get<std::string>().find("remembered") != std::string::npos;
    EXPECT_FALSE(remembered && number.at("verified").get<bool>()) << key;
  }
}

TEST(DeviceConfig, EachArmMayHaveItsOwnParameters) {
  Json json = omni();
  json["arms"] = Json::array({json["arm"], json["arm"]});
  json.erase("arm");
  json["arms"][1]["apparent_mass_kg"]["value"] = 0.2;
  test::Bench bench(json, 2);
  ASSERT_TRUE(bench.device);
  EXPECT_EQ(bench.device->capabilities(0).apparent_mass_kg, 0.045);
  EXPECT_EQ(bench.device->capabilities(1).apparent_mass_kg, 0.2);
}

TEST(DeviceConfig, AListForAnotherNumberOfArmsIsRefused) {
  const Error error = refusalAfter([](Json& json) {
    json["arms"] = Json::array({json["arm"]});
    json.erase("arm");
  });
  expectRefused(error, "arms", "describes 1 arms, and 2 are open");
}

TEST(DeviceConfig, BothOrNeitherOfArmAndArmsIsRefused) {
  expectRefused(refusalAfter([](Json& json) { json["arms"] = Json::array(); }), "arm", "either");
  expectRefused(refusalAfter([](Json& json) { json.erase("arm"); }), "arm", "either");
}

TEST(DeviceConfig, ANegativeMassIsRefusedWithFieldAndValue) {
  expectRefused(refusalAfter([](Json& json) { json["arm"]["apparent_mass_kg"]["value"] = -0.045; }),
                "arm.apparent_mass_kg.value", "-0.045");
}

TEST(DeviceConfig, ImpossibleNumbersAreRefusedWithFieldAndValue) {
  const std::pair<const char*, double> wrong[] = {
      {"apparent_mass_kg", 0.0},
      {"plant_damping_Ns_per_m", -1.0},
      {"encoder_step_m", -1e-5},
      {"encoder_step_m", 1e-12},
      {"peak_force_N", 0.0},
      {"continuous_force_N", 4.0},
      {"thermal_s", -1.0},
      {"latency_s", 0.2},
      {"rate_hz", 0.0},
      {"apparent_mass_kg", 1e-300},
      {"peak_force_N", 1e-308},
      {"peak_force_N", 1e300},
      {"plant_damping_Ns_per_m", 1e300},
  };
  for (const auto& [key, value] : wrong) {
    const char* const field = key;
    const double number = value;
    expectRefused(refusalAfter([&](Json& json) {
                    Json& of = json["arm"][field];
                    if (of.is_null()) of = {{"source", "this test"}, {"verified", true}};
                    of["value"] = number;
                  }),
                  std::string("arm.") + field + ".value", Json(number).dump());
  }
  expectRefused(refusalAfter([](Json& json) { json["arm"]["workspace_m"]["value"][1] = -0.12; }),
                "arm.workspace_m.value[1]", "-0.12");
}

TEST(DeviceConfig, AnUnknownFieldIsRefusedWithFieldAndValue) {
  expectRefused(refusalAfter([](Json& json) { json["arm"]["colour"] = "red"; }), "arm.colour",
                "red");
  expectRefused(refusalAfter([](Json& json) { json["vanish"] = 3; }), "vanish", "3");
  expectRefused(refusalAfter([](Json& json) { json["arm"]["rate_hz"]["unit"] = "Hz"; }),
                "arm.rate_hz.unit", "Hz");
}

TEST(DeviceConfig, AWrongTypeIsRefusedWithFieldAndValue) {
  expectRefused(refusalAfter([](Json& json) { json["arm"]["peak_force_N"]["value"] = "3.3"; }),
                "arm.peak_force_N.value", "\"3.3\"");
  expectRefused(refusalAfter([](Json& json) { json["arm"]["peak_force_N"] = 3.3; }),
                "arm.peak_force_N", "3.3");
  expectRefused(refusalAfter([](Json& json) { json["arm"]["workspace_m"]["value"] = 0.16; }),
                "arm.workspace_m.value", "0.16");
  expectRefused(refusalAfter([](Json& json) { json["vanish_after_s"] = "soon"; }), "vanish_after_s",
                "\"soon\"");
}

TEST(DeviceConfig, AMissingFieldIsNamed) {
  expectRefused(refusalAfter([](Json& json) { json["arm"].erase("rate_hz"); }), "arm.rate_hz",
                "missing");
}

TEST(DeviceConfig, ANumberWithoutSourceIsRefused) {
  expectRefused(refusalAfter([](Json& json) { json["arm"]["rate_hz"].erase("source"); }),
                "arm.rate_hz.source", "missing");
  expectRefused(refusalAfter([](Json& json) { json["arm"]["rate_hz"]["source"] = ""; }),
                "arm.rate_hz.source", "expected text");
}

TEST(DeviceConfig, AnotherFormatAndANewerVersionAreRefusedByName) {
  expectRefused(refusalAfter([](Json& json) { json["format"] = "trephine.scene"; }), "format",
                "trephine.scene");
  expectRefused(refusalAfter([](Json& json) { json["version"] = 2; }), "version",
                "version 2 is newer than version 1");
  expectRefused(refusalAfter([](Json& json) { json["version"] = 0; }), "version", "0");
}

TEST(DeviceConfig, TextThatIsNotAJsonObjectIsRefused) {
  EXPECT_NE(configRefusal("").what.find("not valid JSON"), std::string::npos);
  EXPECT_NE(configRefusal("{\"format\": ").what.find("not valid JSON"), std::string::npos);
  EXPECT_NE(configRefusal("[1, 2]").what.find("Expected an object"), std::string::npos);
  // A number beyond a double, and bytes that are not UTF-8.
  EXPECT_EQ(configRefusal("{\"version\": 1e999}").code.str(), "BAD_DEVICE_CONFIG");
  EXPECT_EQ(configRefusal("{\"\xff\": 1}").code.str(), "BAD_DEVICE_CONFIG");
}

TEST(DeviceConfig, NestingWithoutEndIsRefused) {
  const std::size_t depth = 100'000;
  for (const char* before : {"", R"({"arm": )", R"({"format": )"}) {
    const std::string end = *before ? "}" : "";
    const Error error =
        configRefusal(before + std::string(depth, '[') + std::string(depth, ']') + end);
    EXPECT_EQ(error.code.str(), "BAD_DEVICE_CONFIG") << before;
    EXPECT_NE(error.what.find("nested deeper than 64"), std::string::npos) << error.sentence();
  }
}

TEST(DeviceConfig, AnArmThatIsNotThereIsNamed) {
  const Error error = configRefusal(omni().dump(), {7});
  EXPECT_EQ(error.code.str(), "NO_DEVICE");
  EXPECT_NE(error.what.find("no simulated arm 7"), std::string::npos) << error.sentence();
  EXPECT_EQ(configRefusal(omni().dump(), {1, 1}).code.str(), "NO_DEVICE");
  EXPECT_EQ(configRefusal(omni().dump(), {}).code.str(), "NO_DEVICE");
}

}  // namespace
}  // namespace trephine
