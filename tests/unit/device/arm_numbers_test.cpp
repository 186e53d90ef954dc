// The numbers of an arm: what the host takes, what the simulated arms' file may say, and the tables
// that tell people.
#include "device/arm_numbers.h"

#include "base/system.h"
#include "device_support.h"
#include "schema_page.h"
#include "simulated/arm_config.h"

namespace trephine {
namespace {

const std::filesystem::path kRoot = resourceFolder().parent_path();

TEST(ArmNumbers, TheHostRefusesEachThatIsOutOfItsRangeByName) {
  TrephineCapabilities possible{};
  possible.input_dof = 6;
  for (const CapabilityNumber& number : kCapabilityNumbers) {
    for (std::size_t i = 0; i < number.count; ++i) {
      std::memcpy(reinterpret_cast<char*>(&possible) + number.offset + 8 * i,
                  &number.row.range.high, 8);
    }
  }
  EXPECT_EQ(impossibleCapability(possible), "");
  TrephineCapabilities pedal{};
  EXPECT_NE(impossibleCapability(pedal).find("rate_hz"), std::string::npos);
  pedal.rate_hz = 100.0;
  EXPECT_EQ(impossibleCapability(pedal), "") << "it has buttons alone";
  for (std::uint32_t dof : {1u, 2u, 4u, 7u}) {
    TrephineCapabilities wrong = possible;
    wrong.input_dof = dof;
    EXPECT_NE(impossibleCapability(wrong).find("input_dof"), std::string::npos) << dof;
  }
  for (const CapabilityNumber& number : kCapabilityNumbers) {
    TrephineCapabilities wrong = possible;
    const double beyond = 2.0 * number.row.range.high;
    std::memcpy(reinterpret_cast<char*>(&wrong) + number.offset + 8 * (number.count - 1), &beyond,
                8);
    const std::string fault = impossibleCapability(wrong);
    EXPECT_NE(fault.find(number.row.key), std::string::npos) << fault;
    EXPECT_NE(fault.find(plainNumber(beyond)), std::string::npos) << fault;
  }
}

// A plugin builds without our headers, so its rows stand a second time.
TEST(ArmNumbers, ASimulatedArmMayBeWhatTheHostTakes) {
  int shared = 0;
  for (const simulated::ArmNumber& own : simulated::kArmNumbers) {
    for (const CapabilityNumber& host : kCapabilityNumbers) {
      if (std::string(own.key) != host.row.key) continue;
      ++shared;
      EXPECT_EQ(own.low, host.row.range.low) << own.key;
      EXPECT_EQ(own.high, host.row.range.high) << own.key;
      EXPECT_STREQ(own.unit, host.row.range.unit) << own.key;
      EXPECT_EQ(own.count, host.count) << own.key;
    }
  }
  EXPECT_EQ(shared, int(std::size(kCapabilityNumbers)));
}

TEST(ArmNumbers, ThePagesAreAsTheRowsAre) {
  test::expectNumbers(kRoot / "modules" / "device" / "README.md", "capabilities", capabilityPage());
  std::string page = schemaHead();
  for (const simulated::ArmNumber& n : simulated::kArmNumbers) {
    const FieldRow row{
        n.key, {n.low, n.high, n.unit}, n.optional ? Given::may_be : Given::always, n.meaning};
    page +=
        schemaLine("arm", row, n.count == 3 ? "three numbers" : "number", n.optional ? "0" : "");
  }
  test::expectNumbers(kRoot / "plugins" / "simulated" / "README.md", "simulated arm", page);
  std::string troubles = schemaHead();
  for (const simulated::TroubleNumber& n : simulated::kTroubleNumbers) {
    const FieldRow row{n.key, {0.0, 1e6, "s"}, Given::may_be, n.meaning};
    troubles += schemaLine("device", row, "number", "never");
  }
  test::expectNumbers(kRoot / "plugins" / "simulated" / "README.md", "troubles", troubles);
}

}  // namespace
}  // namespace trephine
