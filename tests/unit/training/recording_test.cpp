// What is recorded, and what of it replays.
#include <hdf5.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "file_size_limit.h"
#include "recording_support.h"
#include "support.h"
#include "training/recording_layout.h"
#include "training/replay.h"
#include "training/session_reader.h"

namespace trephine {
namespace {

using test::recordRun;
using test::exerciseWithOneArm;
using test::slab;

TEST(Recording, ReplaysBitForBit) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 6000);
  auto reader = SessionReader::open(folder / "a.h5");
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  EXPECT_EQ((*reader)->tickCount(), 6000u);
  EXPECT_GT((*reader)->carves()->size(), 20u);
  const auto result = replay(**reader, slab());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << (result->first_difference ? result->first_difference->field : "");
  EXPECT_EQ(result->ticks, 6000u);
  EXPECT_EQ(result->volume_sha256, (*reader)->end()->volume_sha256);
  EXPECT_FALSE(result->cut_short);
}

// The type of `from` without one member, as if it had been written before there was one.
hid_t without(hid_t from, const std::string& name) {
  const hid_t out = H5Tcreate(H5T_COMPOUND, H5Tget_size(from));
  for (unsigned i = 0; i < unsigned(H5Tget_nmembers(from)); ++i) {
    char* member = H5Tget_member_name(from, i);
    if (member != name) {
      const hid_t type = H5Tget_member_type(from, i);
      H5Tinsert(out, member, H5Tget_member_offset(from, i), type);
      H5Tclose(type);
    }
    H5free_memory(member);
  }
  return out;
}

TEST(Recording, ANumberOfATissueThatItDoesNotHaveIsNone) {
  const test::TemporaryFolder folder;
  TissueTable written = tissueTable(exerciseWithOneArm().tissues);
  written.classes[0].rupture_N = 7.0;

  const hid_t whole = tissueTableType();
  const unsigned tissues = unsigned(H5Tget_member_index(whole, "tissues"));
  const hid_t list = H5Tget_member_type(whole, tissues), tissue = H5Tget_super(list);
  const hid_t older_tissue = without(tissue, "rupture_N");
  const hsize_t most = kMaxTissues, rows = 1;
  const hid_t older_list = H5Tarray_create2(older_tissue, 1, &most);
  const hid_t older = without(whole, "tissues");
  H5Tinsert(older, "tissues", H5Tget_member_offset(whole, tissues), older_list);

  const hid_t file = H5Fcreate((folder / "a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(1, &rows, nullptr);
  const hid_t tables =
      H5Dcreate2(file, "tissue_tables", older, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(H5Dwrite(tables, whole, H5S_ALL, H5S_ALL, H5P_DEFAULT, &written), 0);
  TissueTable read;
  ASSERT_GE(H5Dread(tables, whole, H5S_ALL, H5S_ALL, H5P_DEFAULT, &read), 0);
  written.classes[0].rupture_N = 0.0;
  EXPECT_EQ(read, written);
  H5Dclose(tables);
  H5Sclose(space);
  H5Fclose(file);
  for (hid_t type : {older, older_list, older_tissue, tissue, list, whole}) H5Tclose(type);
}

// Rewrites one recorded number and expects the replay to find just that one.
TEST(Recording, AReplayNamesTheFirstDifference) {
  test::TemporaryFolder folder;
  const Exercise exercise = exerciseWithOneArm();
  Grid grid(slab());
  HapticCore core(hapticParameters(exercise), *grid.takeWriter());
  auto recorder = SessionRecorder::create(
      folder / "a.h5", {toJson(RecordedExercise{exercise, simulatedRig(exercise)}), volumeSha256(slab()), grid.geometry(), "test"}, 1);
  for (std::uint64_t t = 0; t < 1000; ++t) {
    TickInput input;
    input.tick = t;
    input.journal = core.journalState();
    input.arms[0].position_m = Vec3(0, 0, 2e-3 - 5e-6 * double(t));
    TickRecord record;
    core.tick(input, nullptr, 0, record);
    if (t == 777) record.arms[0].sent_N.y = 0.125;
    (*recorder)->tick(record);
    for (const CarveRecord& c : core.carves()) (*recorder)->carve(c);
    for (const Event& e : core.events()) (*recorder)->event(e);
  }
  ASSERT_TRUE((*recorder)->finish({1000, 0, 0, volumeSha256(grid.snapshot())}).ok());
  const auto result = replay(**SessionReader::open(folder / "a.h5"), slab());
  ASSERT_TRUE(result.ok());
  EXPECT_FALSE(result->identical);
  ASSERT_TRUE(result->first_difference.has_value());
  EXPECT_EQ(result->first_difference->tick, 777u);
  EXPECT_EQ(result->first_difference->arm, 0);
  EXPECT_EQ(result->first_difference->field, "sent_N");
  EXPECT_EQ(result->first_difference->recorded[1].get<double>(), 0.125);
}

TEST(Recording, CanBeReadAndReplayedWhileItIsStillBeingWritten) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 1700, false);
  const auto reader = SessionReader::open(folder / "a.h5");
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  EXPECT_FALSE((*reader)->end().has_value());
  EXPECT_GE((*reader)->tickCount(), 1500u);
  const auto result = replay(**reader, slab());
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(result->identical);
  EXPECT_TRUE(result->cut_short);
}

TEST(Recording, RefusesAnotherCase) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 100);
  Volume other = slab();
  other.hu[5] += 1;
  EXPECT_EQ(replay(**SessionReader::open(folder / "a.h5"), other).error().code.str(), "WRONG_CASE");
}

// Label 5 where x < 0. A tissue change moves the tissue to the rest.
std::shared_ptr<const LabelMap> halves() {
  const GridGeometry geometry = slab().geometry;
  LabelMap map{geometry, std::vector<std::uint8_t>(geometry.voxelCount())};
  for (std::size_t i = 0; i < map.labels.size(); ++i) {
    map.labels[i] = geometry.indicesOf(i)[0] < 12 ? 5 : 6;
  }
  return std::make_shared<const LabelMap>(std::move(map));
}

TEST(Recording, KeepsTheLabelsOfTissuesAlsoOfAChange) {
  test::TemporaryFolder folder;
  Exercise exercise = exerciseWithOneArm();
  exercise.tissues.tissues[0].label = 5;
  exercise.tools[0].tool.made_from.motor_W = 0.5;  // it is pressed straight at the other half
  const auto labels = halves();
  Grid grid(slab(), labels);
  HapticCore core(hapticParameters(exercise), *grid.takeWriter());
  auto recorder = SessionRecorder::create(
      folder / "a.h5",
      {toJson(RecordedExercise{exercise, simulatedRig(exercise)}), volumeSha256(slab()), grid.geometry(), "test", labelsSha256(*labels)}, 1);
  ASSERT_TRUE(recorder.ok()) << recorder.error().sentence();
  TissueSet other = exercise.tissues;
  other.tissues[0].label = 6;
  for (std::uint64_t t = 0; t < 4000; ++t) {
    TickInput input;
    input.tick = t;
    input.journal = core.journalState();
    input.arms[0].position_m = Vec3(4e-6 * double(t % 2000) - 4e-3, 1e-3, -3e-6 * double(t % 2000));
    const TissueTable table = tissueTable(other);
    const Command change{CommandKind::tissues, 0, &table};
    TickRecord record;
    core.tick(input, &change, t == 2000 ? 1 : 0, record);
    (*recorder)->tick(record);
    for (const CarveRecord& c : core.carves()) {
      ASSERT_EQ(labels->labels[c.voxel], t < 2000 ? 5 : 6);
      (*recorder)->carve(c);
    }
    for (const Event& e : core.events()) (*recorder)->event(e);
  }
  ASSERT_TRUE((*recorder)->finish({4000, 0, 0, volumeSha256(grid.snapshot())}).ok());

  const auto reader = *SessionReader::open(folder / "a.h5");
  EXPECT_EQ(reader->header().labels_sha256, labelsSha256(*labels));
  ASSERT_GT(reader->carves()->size(), 20u);
  EXPECT_GT(reader->carves()->back().tick, 2000u);
  const auto result = replay(*reader, slab(), labels.get());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << result->first_difference->field;
  EXPECT_EQ(result->ticks, 4000u);
}

TEST(Recording, NamesTheLabelAmongATissuesNumbers) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 10);
  const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t tables = H5Dopen2(file, "tissue_tables", H5P_DEFAULT), table = H5Dget_type(tables);
  const int at = H5Tget_member_index(table, "tissues");
  ASSERT_GE(at, 0);
  const hid_t tissues = H5Tget_member_type(table, unsigned(at)), tissue = H5Tget_super(tissues);
  EXPECT_GE(H5Tget_member_index(tissue, "label"), 0);
  for (hid_t type : {tissue, tissues, table}) H5Tclose(type);
  H5Dclose(tables);
  H5Fclose(file);
}

TEST(Recording, RefusesAnotherLabelMapAndOneTooMany) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 100);
  EXPECT_EQ((*SessionReader::open(folder / "a.h5"))->header().labels_sha256, "");
  const auto too_many = replay(**SessionReader::open(folder / "a.h5"), slab(), halves().get());
  ASSERT_FALSE(too_many.ok());
  EXPECT_EQ(too_many.error().code.str(), "WRONG_LABELS");
  EXPECT_NE(too_many.error().what.find("without a label map"), std::string::npos);
}

TEST(Recording, OfAnOlderVersionIsRefusedByName) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 500);
  const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t version = H5Aopen(file, "version", H5P_DEFAULT);
  for (int number : {kRecordingVersion, kOldestRecording - 1, 1}) {
    ASSERT_GE(H5Awrite(version, H5T_NATIVE_INT, &number), 0);
    H5Fflush(file, H5F_SCOPE_GLOBAL);
    if (number == kRecordingVersion) {
      EXPECT_TRUE(replay(**SessionReader::open(folder / "a.h5"), slab())->identical);
    } else {
      EXPECT_EQ(SessionReader::open(folder / "a.h5").error().code.str(), "OLDER_VERSION");
    }
  }
  H5Aclose(version);
  H5Fclose(file);
}

// The table of an arm written anew without a column, or with whole numbers in it.
void writeArmAnew(const std::filesystem::path& path, const char* column, bool whole, int version) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t old = H5Dopen2(file, "arm0", H5P_DEFAULT), type = H5Dget_type(old);
  const hid_t other = H5Tcreate(H5T_COMPOUND, H5Tget_size(type));
  for (int i = 0; i < H5Tget_nmembers(type); ++i) {
    char* name = H5Tget_member_name(type, unsigned(i));
    const hid_t member = H5Tget_member_type(type, unsigned(i));
    const std::size_t offset = H5Tget_member_offset(type, unsigned(i));
    if (name != std::string(column)) H5Tinsert(other, name, offset, member);
    if (name == std::string(column) && whole) H5Tinsert(other, name, offset, H5T_NATIVE_INT64);
    H5Tclose(member);
    H5free_memory(name);
  }
  const hid_t space = H5Dget_space(old), plist = H5Dget_create_plist(old);
  std::vector<char> rows(std::size_t(H5Sget_simple_extent_npoints(space)) * H5Tget_size(type));
  H5Dread(old, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
  H5Dclose(old);
  H5Ldelete(file, "arm0", H5P_DEFAULT);
  const hid_t made = H5Dcreate2(file, "arm0", other, space, H5P_DEFAULT, plist, H5P_DEFAULT);
  H5Dwrite(made, other, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
  const hid_t at = H5Aopen(file, "version", H5P_DEFAULT);
  H5Awrite(at, H5T_NATIVE_INT, &version);
  H5Aclose(at);
  H5Pclose(plist);
  H5Sclose(space);
  H5Dclose(made);
  H5Tclose(other);
  H5Tclose(type);
  H5Fclose(file);
}

TEST(Recording, WithoutAColumnOfItsVersionIsDamagedAndAnOlderOneWithoutItIsNot) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 500);
  for (const auto& [column, whole] :
       {std::pair("heat_J", false), {"heat_J", true}, {"sent_N", false}}) {
    std::filesystem::copy_file(folder / "a.h5", folder / "b.h5",
                               std::filesystem::copy_options::overwrite_existing);
    writeArmAnew(folder / "b.h5", column, whole, kRecordingVersion);
    const auto opened = SessionReader::open(folder / "b.h5");
    ASSERT_FALSE(opened.ok()) << column;
    EXPECT_EQ(opened.error().code.str(), "BAD_RECORDING");
    EXPECT_NE(opened.error().what.find(column), std::string::npos) << opened.error().what;
  }
  std::filesystem::copy_file(folder / "a.h5", folder / "b.h5",
                             std::filesystem::copy_options::overwrite_existing);
  writeArmAnew(folder / "b.h5", "heat_J", false, 11);
  const auto older = SessionReader::open(folder / "b.h5");
  ASSERT_TRUE(older.ok()) << older.error().sentence();
  EXPECT_TRUE(replay(**older, slab())->identical) << "what it does not say is not compared";
}

TEST(Recording, KeepsWhichArmWasClutchedAndWhereItsMapTurned) {
  test::TemporaryFolder folder;
  const Exercise exercise = exerciseWithOneArm();
  Grid grid(slab());
  HapticCore core(hapticParameters(exercise), *grid.takeWriter());
  auto recorder = SessionRecorder::create(
      folder / "a.h5", {toJson(RecordedExercise{exercise, simulatedRig(exercise)}), volumeSha256(slab()), grid.geometry(), "test"}, 1);
  const Quat turned = glm::angleAxis(0.3, Vec3(0, 0, 1));
  for (std::uint64_t t = 0; t < 3000; ++t) {
    TickInput input;
    input.tick = t;
    input.journal = core.journalState();
    input.arms[0].position_m = Vec3(1e-6 * double(t), 0, 4e-3 - 4e-6 * double(t % 1500));
    std::vector<Command> commands;
    if (t == 1200) commands.push_back({CommandKind::clutch_on, 0, {}, 0});
    if (t == 1500) commands.push_back({CommandKind::clutch_off, 1, {}, 0, turned});
    if (t == 2600) commands.push_back({CommandKind::recentre, 0, {}, 0});
    TickRecord record;
    core.tick(input, commands.data(), commands.size(), record);
    (*recorder)->tick(record);
    for (const CarveRecord& c : core.carves()) (*recorder)->carve(c);
    for (const Event& e : core.events()) (*recorder)->event(e);
  }
  ASSERT_TRUE((*recorder)->finish({3000, 0, 0, volumeSha256(grid.snapshot())}).ok());
  const auto reader = SessionReader::open(folder / "a.h5");
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  const auto events = *(*reader)->events();
  const auto off = std::find_if(events.begin(), events.end(), [](const Event& event) {
    return event.command.kind == CommandKind::clutch_off;
  });
  ASSERT_NE(off, events.end());
  EXPECT_EQ(off->tick, 1500u);
  EXPECT_EQ(off->command.arm, 0);
  EXPECT_EQ(off->command.rotation, turned);
  const auto result = replay(**reader, slab());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << (result->first_difference ? result->first_difference->field
                                                              : "");
  EXPECT_EQ(result->ticks, 3000u);
}

TEST(Recording, KeepsWhichToolAnArmTookAndWhen) {
  test::TemporaryFolder folder;
  Exercise exercise = exerciseWithOneArm();
  exercise.tools.push_back({"burr", makeBurr(0.002, 16, 2, 0.02), {}});
  exercise.arms[0].other_tools = {"burr"};
  Grid grid(slab());
  HapticCore core(hapticParameters(exercise), *grid.takeWriter());
  auto recorder = SessionRecorder::create(
      folder / "a.h5", {toJson(RecordedExercise{exercise, simulatedRig(exercise)}), volumeSha256(slab()), grid.geometry(), "test"}, 1);
  for (std::uint64_t t = 0; t < 2000; ++t) {
    TickInput input;
    input.tick = t;
    input.journal = core.journalState();
    // Into the slab and out again.
    const double way = double(t % 1000) / 500.0;
    input.arms[0].position_m = Vec3(1e-6 * double(t), 0, 3e-3 - 5e-3 * std::min(way, 2.0 - way));
    std::vector<Command> commands;
    if (t == 500) commands.push_back({CommandKind::tool, 1, {}, 0});
    TickRecord record;
    core.tick(input, commands.data(), commands.size(), record);
    (*recorder)->tick(record);
    for (const CarveRecord& c : core.carves()) (*recorder)->carve(c);
    for (const Event& e : core.events()) (*recorder)->event(e);
  }
  ASSERT_TRUE((*recorder)->finish({2000, 0, 0, volumeSha256(grid.snapshot())}).ok());
  const auto reader = SessionReader::open(folder / "a.h5");
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  const auto events = *(*reader)->events();
  const auto changed = std::find_if(events.begin(), events.end(), [](const Event& event) {
    return event.kind == EventKind::tool_changed;
  });
  ASSERT_NE(changed, events.end());
  EXPECT_EQ(changed->value, 1u);
  EXPECT_GT(changed->tick, 550u) << "not before it is out of the bone";
  EXPECT_LT(changed->tick, 1000u);
  const auto ticks = (*reader)->ticks(0, 2000);
  for (const TickRecord& tick : *ticks) {
    const bool waits = (tick.arms[0].tool_state & kToolToCome) != 0;
    EXPECT_EQ(waits, tick.tick >= 500 && tick.tick < changed->tick) << tick.tick;
  }
  const auto result = replay(**reader, slab());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << (result->first_difference ? result->first_difference->field
                                                              : "");
}

TEST(Recording, RefusesToReplayWhatWasDropped) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 100, true, 3);
  EXPECT_EQ(replay(**SessionReader::open(folder / "a.h5"), slab()).error().code.str(),
            "NOT_REPLAYABLE");
}

TEST(Recording, IsNeverWrittenOverAnotherFile) {
  test::TemporaryFolder folder;
  std::ofstream(folder / "a.h5") << "precious";
  auto recorder = SessionRecorder::create(folder / "a.h5", {Json::object(), "", {}, ""}, 1);
  ASSERT_FALSE(recorder.ok());
  EXPECT_EQ(recorder.error().code.str(), "CANNOT_WRITE");
  std::string text;
  std::ifstream(folder / "a.h5") >> text;
  EXPECT_EQ(text, "precious");
}

TEST(Recording, ThatCannotBeStartedLeavesNoFile) {
  const test::TemporaryFolder folder;
  for (const rlim_t room : {0, 500, 20'000}) {
    const test::FileSizeLimit full(room);
    const auto recorder = SessionRecorder::create(folder / "a.h5", {Json::object(), "", {}, ""}, 1);
    ASSERT_FALSE(recorder.ok());
    EXPECT_EQ(recorder.error().code.str(), "CANNOT_WRITE");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.h5")) << room;
  }
}

TEST(Recording, ThatIsDeletedWhileItIsWrittenIsSaid) {
  const test::TemporaryFolder folder;
  auto recorder = SessionRecorder::create(folder / "a.h5", {Json::object(), "", {}, ""}, 1);
  ASSERT_TRUE(recorder.ok());
  EXPECT_TRUE((*recorder)->flush());
  std::filesystem::remove(folder / "a.h5");
  (*recorder)->tick(TickRecord{});
  const Status status = (*recorder)->flush();
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code.str(), "RECORDING_GONE");
  EXPECT_FALSE((*recorder)->finish({}));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.h5"));
}

TEST(Recording, AFullDiskEndsTheRecordingAndKeepsWhatWasWritten) {
  test::TemporaryFolder folder;
  const Exercise exercise = exerciseWithOneArm();
  Grid grid(slab());
  HapticCore core(hapticParameters(exercise), *grid.takeWriter());
  auto recorder = SessionRecorder::create(
      folder / "a.h5", {toJson(RecordedExercise{exercise, simulatedRig(exercise)}), volumeSha256(slab()), grid.geometry(), "test"}, 1);
  ASSERT_TRUE(recorder.ok());
  std::optional<test::FileSizeLimit> full(4'000'000);
  Status status;
  std::uint64_t ticks = 0;
  // Positions without a pattern, so that compression cannot make room.
  std::uint32_t random = 1;
  for (; ticks < 200'000 && status; ++ticks) {
    TickInput input;
    input.tick = ticks;
    for (int axis = 0; axis < 3; ++axis) {
      random = random * 1664525u + 1013904223u;
      input.arms[0].position_m[axis] = 1e-12 * random;
    }
    input.arms[0].position_m.z += 0.006;
    TickRecord record;
    core.tick(input, nullptr, 0, record);
    (*recorder)->tick(record);
    if (ticks % 100 == 99) status = (*recorder)->flush();
  }
  EXPECT_FALSE(status.ok());
  if (!status) {
    EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE");
  }
  EXPECT_FALSE((*recorder)->finish({ticks, 0, 0, ""}).ok());
  full.reset();
  const auto reader = SessionReader::open(folder / "a.h5");
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  EXPECT_GT((*reader)->tickCount(), 0u);
  EXPECT_LT((*reader)->tickCount(), ticks);
  const auto result = replay(**reader, slab());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical);
}

}  // namespace
}  // namespace trephine
