#include "training/tick_table.h"

#include <fstream>

#include "exercise/exercise.h"
#include "file_size_limit.h"
#include "support.h"
#include "training/session_recorder.h"

namespace trephine {
namespace {

// Two ticks of one arm, each number another.
std::filesystem::path recordTwoTicks(const test::TemporaryFolder& folder, const std::string& arm) {
  const auto file = folder / "a.h5";
  Json exercise = {{"rate_hz", 1000.0}, {"arms", Json::array({Json{{"name", arm}}})}};
  GridGeometry geometry;
  geometry.size = {2, 2, 2};
  auto recorder = SessionRecorder::create(file, {exercise, "", geometry, "test"}, 1);
  EXPECT_TRUE(recorder.ok());
  for (std::uint64_t t = 0; t < 2; ++t) {
    TickRecord record;
    record.tick = t;
    ArmRecord& at = record.arms[0];
    at.device_position_m = {0.001 * double(t), 0.0, 0.1};
    at.sent_N = {1.0, 2.0, 0.1 + 0.2};
    at.proxy_position_mm = {10.5, -20.0, 1.0 / 3.0};
    at.tool_state = kToolHeld;
    at.controller_parts = 65;
    (*recorder)->tick(record);
  }
  EXPECT_TRUE((*recorder)->finish({2, 0, 0, ""}).ok());
  return file;
}

std::vector<std::string> linesOf(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(TickTable, HasALineATickAndArmUnderNamedColumnsThatReadBackAsTheyWere) {
  test::TemporaryFolder folder;
  const auto reader = *SessionReader::open(recordTwoTicks(folder, "right"));
  ASSERT_TRUE(writeTickTable(*reader, folder / "t.csv"));
  const auto lines = linesOf(folder / "t.csv");
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(lines[0].starts_with("tick,t_s,arm,x_m,"));
  EXPECT_TRUE(
      lines[0].ends_with(",sent_z_N,proxy_x_mm,proxy_y_mm,proxy_z_mm,tool_state,controller_parts"));
  EXPECT_TRUE(lines[2].starts_with("1,0.001,right,0.001,0,0.10000000000000001,1,0,0,")) << lines[2];
  EXPECT_TRUE(lines[2].ends_with(",1,2,0.30000000000000004,10.5,-20,0.33333333333333331,2,65"))
      << lines[2];
}

TEST(TickTable, KeepsAnArmsNameInItsColumn) {
  test::TemporaryFolder folder;
  const auto reader = *SessionReader::open(recordTwoTicks(folder, "left, the \"old\" one"));
  ASSERT_TRUE(writeTickTable(*reader, folder / "t.csv"));
  EXPECT_TRUE(linesOf(folder / "t.csv")[1].starts_with("0,0,\"left, the \"\"old\"\" one\",0,0,"));
}

TEST(TickTable, NamesTheCauseWhereItCannotBeWritten) {
  test::TemporaryFolder folder;
  const auto reader = *SessionReader::open(recordTwoTicks(folder, "right"));
  const Status written = writeTickTable(*reader, folder / "none" / "t.csv");
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().code.str(), "CANNOT_WRITE");
  EXPECT_NE(written.error().what.find("No such file"), std::string::npos) << written.error().what;
  EXPECT_EQ(written.error().sentence().find("space"), std::string::npos);
}

TEST(TickTable, ForWhichTheDiskHasNoRoomSaysSoAndLeavesNothing) {
  test::TemporaryFolder folder;
  const auto reader = *SessionReader::open(recordTwoTicks(folder, "right"));
  const Status written = [&] {
    const test::FileSizeLimit full(100);
    return writeTickTable(*reader, folder / "t.csv");
  }();
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().code.str(), "CANNOT_WRITE");
  EXPECT_NE(written.error().sentence().find("Free some space"), std::string::npos)
      << written.error().sentence();
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace trephine
