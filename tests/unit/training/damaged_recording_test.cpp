// Files that are no recording, or one no longer: cut short, with bytes or rows that changed.
#include <hdf5.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <thread>

#include "recording_support.h"
#include "support.h"
#include "thorough.h"
#include "training/recording_layout.h"
#include "training/replay.h"
#include "training/session_reader.h"

namespace trephine {
namespace {

using test::recordRun;
using test::slab;

void takeOut(const char* dataset, const std::filesystem::path& recording) {
  const hid_t file = H5Fopen(recording.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Ldelete(file, dataset, H5P_DEFAULT), 0);
  H5Fclose(file);
}

TEST(IsBeingWritten, IsSoOfAMarkedRecordingThatWasWrittenAMomentAgo) {
  test::TemporaryFolder folder;
  recordRun(folder / "whole.h5", 500);
  EXPECT_FALSE(isBeingWritten(folder / "whole.h5"));
  auto recorder = SessionRecorder::create(
      folder / "now.h5", {toJson(test::exerciseWithOneArm()), volumeSha256(slab()), {}, "test"}, 1);
  ASSERT_TRUE(recorder.ok());
  EXPECT_TRUE(isBeingWritten(folder / "now.h5"));
  std::filesystem::copy_file(folder / "now.h5", folder / "killed.h5");
  EXPECT_TRUE(isBeingWritten(folder / "killed.h5"));
  std::filesystem::last_write_time(
      folder / "killed.h5", std::filesystem::file_time_type::clock::now() - std::chrono::minutes(1));
  EXPECT_FALSE(isBeingWritten(folder / "killed.h5"));
  std::ofstream(folder / "letter.h5") << "Dear Madam, I hope that you are well";
  EXPECT_FALSE(isBeingWritten(folder / "letter.h5"));
  std::ofstream(folder / "short.h5") << "\x89HDF";
  EXPECT_FALSE(isBeingWritten(folder / "short.h5"));
}

// A recording that points elsewhere is refused before anything else is opened: `change` is given
// the file, in which `dataset` is not there any more.
void isForeignWhere(const char* dataset, const std::function<void(hid_t)>& change) {
  test::TemporaryFolder folder;
  const auto recording = folder / "a.h5";
  recordRun(recording, 500);
  takeOut(dataset, recording);
  const hid_t file = H5Fopen(recording.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  change(file);
  H5Fclose(file);
  const auto reader = SessionReader::open(recording);
  ASSERT_FALSE(reader.ok());
  EXPECT_EQ(reader.error().code.str(), "BAD_RECORDING");
  EXPECT_NE(reader.error().what.find(dataset), std::string::npos) << reader.error().what;
  EXPECT_NE(reader.error().what.find("not in the file itself"), std::string::npos);
}

// A dataset of 500 numbers, by these properties, which are closed.
void makeNumbers(hid_t file, const char* name, hid_t properties) {
  const hsize_t count = 500, unlimited = H5S_UNLIMITED;
  const bool chunked = H5Pget_layout(properties) == H5D_CHUNKED;
  const hid_t space = H5Screate_simple(1, &count, chunked ? &unlimited : nullptr);
  const hid_t made =
      H5Dcreate2(file, name, H5T_NATIVE_INT64, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  EXPECT_GE(made, 0);
  H5Dclose(made);
  H5Sclose(space);
  H5Pclose(properties);
}

TEST(ForeignRecording, WithAnExternalOrASoftLinkIsRefused) {
  test::TemporaryFolder elsewhere;
  ASSERT_EQ(::mkfifo((elsewhere / "pipe").c_str(), 0600), 0);  // opening it would wait for ever
  for (const char* name : {"format", "scene", "ticks", "arm0", "removed_voxels", "events",
                           "tissue_tables", "end"}) {
    SCOPED_TRACE(name);
    isForeignWhere(name, [&](hid_t file) {
      H5Lcreate_external((elsewhere / "pipe").c_str(), "/x", file, name, H5P_DEFAULT, H5P_DEFAULT);
    });
    isForeignWhere(
        name, [&](hid_t file) { H5Lcreate_soft("/build", file, name, H5P_DEFAULT, H5P_DEFAULT); });
  }
  // Also one of an arm that it does not have.
  recordRun(elsewhere / "a.h5", 500);
  const hid_t file = H5Fopen((elsewhere / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Lcreate_external((elsewhere / "pipe").c_str(), "/x", file, "arm1", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  EXPECT_EQ(SessionReader::open(elsewhere / "a.h5").error().code.str(), "BAD_RECORDING");
}

TEST(ForeignRecording, WhoseDataLieInAnotherFileIsRefused) {
  isForeignWhere("ticks", [](hid_t file) {
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(properties, "/etc/hostname", 0, 500 * 8);
    makeNumbers(file, "ticks", properties);
  });
  isForeignWhere("events", [](hid_t file) {
    const hsize_t count = 500;
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE),
                space = H5Screate_simple(1, &count, nullptr);
    H5Pset_virtual(properties, space, "/etc/hostname", "/x", space);
    H5Sclose(space);
    makeNumbers(file, "events", properties);
  });
}

TEST(ForeignRecording, OfAnotherLayoutOrFilterIsRefused) {
  isForeignWhere("ticks", [](hid_t file) {  // 64 MB a chunk
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk = hsize_t{8} << 20;
    H5Pset_chunk(properties, 1, &chunk);
    H5Pset_deflate(properties, 1);
    makeNumbers(file, "ticks", properties);
  });
  isForeignWhere("ticks", [](hid_t file) {  // a deflated file of 1 MB would be a terabyte
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk = 64;
    H5Pset_chunk(properties, 1, &chunk);
    for (int n = 0; n < 2; ++n) H5Pset_deflate(properties, 1);
    makeNumbers(file, "ticks", properties);
  });
  isForeignWhere("arm0", [](hid_t file) {  // any other filter could be a plugin's
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk = 64;
    H5Pset_chunk(properties, 1, &chunk);
    H5Pset_fletcher32(properties);
    makeNumbers(file, "arm0", properties);
  });
  unsigned plugins = 1;
  ASSERT_GE(H5PLget_loading_state(&plugins), 0);
  EXPECT_EQ(plugins, 0u) << "none is loaded";
}

// What is of many elements where one is meant is not written past that one.
TEST(ForeignRecording, WithATextOrAVersionOfManyElementsIsRefused) {
  test::TemporaryFolder folder;
  const auto many = [](const char* name, const std::filesystem::path& recording, bool attribute) {
    const hid_t file = H5Fopen(recording.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hsize_t count = 100000;
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    if (attribute) {
      H5Adelete(file, name);
      const hsize_t few = 1000;
      const hid_t small = H5Screate_simple(1, &few, nullptr);
      const hid_t made = H5Acreate2(file, name, H5T_NATIVE_INT32, small, H5P_DEFAULT, H5P_DEFAULT);
      const std::vector<int> versions(few, 8);
      EXPECT_GE(H5Awrite(made, H5T_NATIVE_INT32, versions.data()), 0);
      H5Aclose(made);
      H5Sclose(small);
    } else {
      H5Ldelete(file, name, H5P_DEFAULT);
      const hid_t type = H5Tcopy(H5T_C_S1);
      H5Tset_size(type, 17);
      const hid_t made = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      const std::string texts(17 * count, 'x');
      EXPECT_GE(H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()), 0);
      H5Dclose(made);
      H5Tclose(type);
    }
    H5Sclose(space);
    H5Fclose(file);
  };
  for (const bool attribute : {false, true}) {
    const auto recording = folder / (attribute ? "a.h5" : "b.h5");
    recordRun(recording, 500);
    many(attribute ? "version" : "format", recording, attribute);
    EXPECT_FALSE(SessionReader::open(recording).ok());
  }
}

TEST(ForeignRecording, WhoseExerciseNamesAFileOpensNone) {
  test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const std::string pipe = (folder / "pipe").string();
  const auto replayed = [&](const std::function<void(Json&)>& change) {
    const Exercise one_arm = test::exerciseWithOneArm();
    Json exercise = toJson(RecordedExercise{one_arm, simulatedRig(one_arm)});
    change(exercise);
    const auto file = folder / "a.h5";
    std::filesystem::remove(file);
    auto recorder =
        SessionRecorder::create(file, {exercise, volumeSha256(slab()), slab().geometry, "test"}, 1);
    EXPECT_TRUE((*recorder)->finish({0, 0, 0, volumeSha256(slab())}));
    const auto reader = SessionReader::open(file);
    EXPECT_TRUE(reader.ok()) << reader.error().sentence();
    const auto result = replay(**reader, slab());
    if (result) return std::string();
    EXPECT_NE(result.error().what.find("names a file"), std::string::npos);
    return result.error().code.str();
  };
  EXPECT_EQ(replayed([](Json&) {}), "");
  EXPECT_EQ(replayed([&](Json& s) { s["tissues"] = pipe; }), "BAD_FIELD");
  EXPECT_EQ(replayed([&](Json& s) { s["tissues"]["elsewhere"] = pipe; }), "BAD_FIELD");
  EXPECT_EQ(replayed([&](Json& s) {
              s["tools"][0] = {{"id", "blade"}, {"file", pipe}};
            }),
            "BAD_FIELD");
  EXPECT_EQ(replayed([&](Json& s) { s["tools"][0]["mesh"] = pipe; }), "BAD_FIELD");
  EXPECT_EQ(replayed([&](Json& s) { s["arms"][0]["device"]["config"] = pipe; }), "BAD_FIELD");
  for (const char* key : {"case", "labels", "operator"}) {
    EXPECT_EQ(replayed([&](Json& s) { s[key] = pipe; }), "BAD_FIELD") << key;
  }
}

TEST(Recording, WhoseEndIsDamagedIsNotTakenForOneThatWasCutShort) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 500);
  takeOut("end", folder / "a.h5");
  const auto reader = SessionReader::open(folder / "a.h5");
  ASSERT_FALSE(reader.ok());
  EXPECT_EQ(reader.error().code.str(), "BAD_RECORDING");
  EXPECT_NE(reader.error().what.find("its end cannot be read"), std::string::npos);
}

// HDF5 would print its own words of it, once for each thread that has not been told.
TEST(Recording, ThatIsDamagedIsNamedWithoutANoiseInAnyThread) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 500);
  takeOut("removed_voxels", folder / "a.h5");
  testing::internal::CaptureStderr();
  for (int i = 0; i < 2; ++i) {
    std::thread([&] { EXPECT_FALSE(SessionReader::open(folder / "a.h5").ok()); }).join();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Recording, AFileThatIsMissingForeignOrCutShortIsNamed) {
  test::TemporaryFolder folder;
  EXPECT_EQ(SessionReader::open(folder / "none.h5").error().code.str(), "MISSING_FILE");
  std::ofstream(folder / "text.h5") << "not a recording";
  EXPECT_EQ(SessionReader::open(folder / "text.h5").error().code.str(), "BAD_RECORDING");
  recordRun(folder / "a.h5", 3000);
  const auto size = std::filesystem::file_size(folder / "a.h5");
  for (double part : {0.001, 0.02, 0.3, 0.9}) {
    const auto cut = folder / "cut.h5";
    std::filesystem::copy_file(folder / "a.h5", cut,
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, std::uintmax_t(double(size) * part));
    auto reader = SessionReader::open(cut);
    if (!reader.ok()) {
      EXPECT_EQ(reader.error().code.str(), "BAD_RECORDING");
      EXPECT_NE(reader.error().where.find("cut.h5"), std::string::npos);
      continue;
    }
    const auto result = replay(**reader, slab());
    EXPECT_TRUE(!result.ok() || result->identical) << "what is left must still be true";
  }
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// How a replay ends: "identical", "differs", an error's code, or "never" when a signal had to end
// it. In a process of its own, which is given 5 s.
std::string endOfReplay(const std::filesystem::path& file) {
  int ends[2];
  if (::pipe(ends) != 0) return "no pipe";
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(5);
    const auto reader = SessionReader::open(file);
    std::string end = reader ? "" : reader.error().code.str();
    if (reader) {
      const auto result = replay(**reader, slab());
      end = !result ? result.error().code.str() : result->identical ? "identical" : "differs";
    }
    static_cast<void>(!::write(ends[1], end.data(), end.size()));
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  char text[64] = "never";
  if (WIFEXITED(status)) text[::read(ends[0], text, sizeof(text) - 1)] = '\0';
  for (int end : ends) ::close(end);
  return text;
}

TEST(Recording, AnyByteThatChangedIsFoundWithinSecondsOrDoesNotMatter) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 600);
  const std::string whole = bytesOf(folder / "a.h5");
  std::mt19937 random(17);
  int damaged = 0;
  const int bytes = test::thoroughly(100, 30);
  for (int i = 0; i < bytes; ++i) {
    std::string changed = whole;
    const std::size_t at = random() % whole.size();
    changed[at] = char(changed[at] ^ char(1 + random() % 255));
    std::ofstream(folder / "b.h5", std::ios::binary) << changed;
    const std::string end = endOfReplay(folder / "b.h5");
    EXPECT_TRUE(end == "BAD_RECORDING" || end == "differs" || end == "identical")
        << "byte " << at << ": " << end;
    damaged += end != "identical";
  }
  EXPECT_GT(damaged, bytes / 5);
}

TEST(Recording, AHeadOfWhichALetterChangedIsDamagedAndNotAnotherExercise) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 100);
  std::string bytes = bytesOf(folder / "a.h5");
  const std::size_t at = bytes.find("226");  // HU at which bone begins
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 3, "227");
  std::ofstream(folder / "b.h5", std::ios::binary) << bytes;
  const auto reader = SessionReader::open(folder / "b.h5");
  ASSERT_FALSE(reader.ok());
  EXPECT_EQ(reader.error().code.str(), "BAD_RECORDING");
}

TEST(Recording, WhoseHeadIsNoLongerGuardedIsDamaged) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 100);
  const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Ldelete(file, "head_sha256", H5P_DEFAULT), 0);
  H5Fclose(file);
  EXPECT_EQ(endOfReplay(folder / "a.h5"), "BAD_RECORDING");
}

// Reads the rows of a table, lets them be changed, and writes them back, as many as are left.
template <class Row>
void edit(const std::filesystem::path& file, const char* table, hid_t type,
          const std::function<void(std::vector<Row>&)>& change) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(opened, table, H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset);
  hsize_t size = 0;
  H5Sget_simple_extent_dims(space, &size, nullptr);
  H5Sclose(space);
  std::vector<Row> rows(size);
  ASSERT_GE(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), 0);
  change(rows);
  size = rows.size();
  ASSERT_GE(H5Dset_extent(dataset, &size), 0);
  if (size > 0) {
    ASSERT_GE(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), 0);
  }
  H5Tclose(type);
  H5Dclose(dataset);
  H5Fclose(opened);
}

// How the replay of a run ends whose table was edited.
template <class Row>
std::string endOfEdited(const char* table, hid_t type,
                        const std::function<void(std::vector<Row>&)>& change) {
  static const test::TemporaryFolder folder;
  if (!std::filesystem::exists(folder / "whole.h5")) recordRun(folder / "whole.h5", 1000);
  std::filesystem::copy_file(folder / "whole.h5", folder / "edited.h5",
                             std::filesystem::copy_options::overwrite_existing);
  edit(folder / "edited.h5", table, type, change);
  return endOfReplay(folder / "edited.h5");
}

std::string endOfEditedEvents(const std::function<void(std::vector<EventRow>&)>& change) {
  return endOfEdited<EventRow>("events", eventType(), change);
}

EventRow rowOf(const Event& event, std::int32_t table = -1) {
  return {event, table};
}

TEST(Recording, WhoseEventsWereEmptiedOrEditedDiffers) {
  const auto& edited = endOfEditedEvents;
  EXPECT_EQ(edited([](auto&) {}), "identical");
  EXPECT_EQ(edited([](auto& e) { e.clear(); }), "differs");
  EXPECT_EQ(edited([](auto& e) { e.pop_back(); }), "differs");
  EXPECT_EQ(edited([](auto& e) { e[0].event.kind = EventKind(99); }), "differs");
  EXPECT_EQ(edited([](auto& e) { e[0].event.tick += 1; }), "differs");
  EXPECT_EQ(edited([](auto& e) { e[0].event.arm = 3; }), "differs");
  EXPECT_EQ(edited([](auto& e) { e.back().event.tick = std::uint64_t(-1); }), "differs");
  EXPECT_EQ(edited([](auto& e) {
              e.push_back(rowOf({std::uint64_t(-1), EventKind(99), 0, 0, {}}));
            }),
            "differs");
  EXPECT_EQ(edited([](auto& e) {
              e.insert(e.begin(), rowOf({0, EventKind::starts_in_tissue, 0, 0, {}}));
            }),
            "differs");
}

// A command for tissues has a table, and nothing else has one.
TEST(Recording, WhoseTablesOfTissuesCannotBeIsDamaged) {
  const Event tissues{2000, EventKind::command, -1, 0, {CommandKind::tissues}};
  const Event undo{2000, EventKind::command, -1, 0, {CommandKind::undo}};
  for (const EventRow& row : {rowOf(tissues, -1), rowOf(tissues, -2), rowOf(tissues, 99),
                              rowOf(tissues, 0), rowOf(undo, 0)}) {
    EXPECT_EQ(endOfEditedEvents([&](auto& e) { e.push_back(row); }), "BAD_RECORDING")
        << row.tissue_table;
  }
}

TEST(Recording, WhichHasMoreTablesOfTissuesThanEventsIsReadAsFarAsItsEventsGo) {
  EXPECT_EQ(endOfEdited<TissueTable>("tissue_tables", tissueTableType(),
                                     [](auto& tables) { tables.resize(1000); }),
            "identical");
}

// An arm that was left behind is told of in the tick that did not come.
TEST(Recording, OfAnArmThatWasLeftBehindReplays) {
  EXPECT_EQ(endOfEditedEvents([](auto& e) {
              e.push_back(rowOf({1000, EventKind::silenced, -1, 0, {}}));
              e.push_back(rowOf({1000, EventKind::fault, 0, kFaultStuck, {}}));
            }),
            "identical");
}

TEST(Recording, OfVoxelsRemovedAfterItsEndDiffers) {
  EXPECT_EQ(
      endOfEdited<CarveRecord>("removed_voxels", compoundType(carveFields(), sizeof(CarveRecord)),
                               [](auto& carves) {
                                 carves.push_back(carves.back());
                                 carves.back().tick = 5000;
                               }),
      "differs");
}

TEST(Recording, WhoseEndAndTablesCountOtherTicksIsDamaged) {
  EXPECT_EQ(endOfEdited<EndRow>("end", endType(), [](auto& end) { end[0].ticks = 10; }),
            "BAD_RECORDING");
  EXPECT_EQ(endOfEdited<TickRow>("ticks", compoundType(tickFields(), sizeof(TickRow)),
                                 [](auto& ticks) { ticks.resize(ticks.size() + 100); }),
            "BAD_RECORDING");
}

TEST(Recording, OfAJournalThatCannotBeSaysSoAndAsksForNoSpace) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 1000);
  edit<TickRow>(folder / "a.h5", "ticks", compoundType(tickFields(), sizeof(TickRow)),
                [](auto& ticks) { ticks[700].journal = 255; });
  const auto result = replay(**SessionReader::open(folder / "a.h5"), slab());
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code.str(), "NOT_REPLAYABLE");
  const std::string sentence = result.error().sentence();
  EXPECT_NE(sentence.find("tick 700 "), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("255"), std::string::npos) << sentence;
  EXPECT_EQ(sentence.find("space"), std::string::npos) << sentence;
}

// Where in the file the chunk with row `row` of a table lies.
std::pair<std::uint64_t, std::uint64_t> chunkWith(const std::filesystem::path& file,
                                                  const char* table, hsize_t row) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(opened, table, H5P_DEFAULT);
  haddr_t address = 0;
  hsize_t bytes = 0;
  unsigned filters = 0;
  EXPECT_GE(H5Dget_chunk_info_by_coord(dataset, &row, &filters, &address, &bytes), 0);
  H5Dclose(dataset);
  H5Fclose(opened);
  return {address, bytes};
}

TEST(Recording, ThatIsDamagedInTheMiddleNamesTheTick) {
  test::TemporaryFolder folder;
  recordRun(folder / "a.h5", 3000);
  const auto [address, bytes] = chunkWith(folder / "a.h5", "arm0", 1024);  // chunks of 512 ticks
  std::fstream file(folder / "a.h5", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(std::streamoff(address));
  file << std::string(std::size_t(bytes), '\x5a');
  file.close();
  const auto result = replay(**SessionReader::open(folder / "a.h5"), slab());
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code.str(), "BAD_RECORDING");
  EXPECT_NE(result.error().what.find("from tick 1024 on"), std::string::npos)
      << result.error().what;
}

}  // namespace
}  // namespace trephine
