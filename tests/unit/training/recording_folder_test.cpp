// A folder's recordings, of which each may be anybody's: read by trephine-lab, a child process.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "recording_support.h"
#include "support.h"
#include "training/recording_list.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;

class RecordingFolder : public ::testing::Test {
 protected:
  void record(const std::string& name) { test::recordRun(folder_ / name, 200); }
  // A program that does with its files what the script says, the n-th being "$f".
  ReadApart by(const std::string& script) {
    const fs::path program = folder_ / "program";
    std::ofstream(program) << "#!/bin/sh\nshift 3\nfor f in \"$@\"; do\n" << script << "\ndone\n";
    fs::permissions(program, fs::perms::owner_all);
    return {program, 1.0};
  }
  std::vector<ListedRecording> listed(const ReadApart& how = ReadApart()) {
    const auto rows = listRecordings(folder_.path(), Progress(), how);
    EXPECT_TRUE(rows.ok()) << rows.error().sentence();
    return rows ? *rows : std::vector<ListedRecording>();
  }
  test::TemporaryFolder folder_;
};

TEST_F(RecordingFolder, IsListedAsEachOfItsFilesIs) {
  record("a.h5");
  record("b.h5");
  std::ofstream(folder_ / "empty.h5");
  std::ofstream(folder_ / "letter.txt") << "Dear Sir";
  ASSERT_EQ(::mkfifo((folder_ / "pipe.h5").c_str(), 0600), 0);
  const auto rows = listed();
  ASSERT_EQ(rows.size(), 4u);
  for (const ListedRecording& row : rows) {
    const ListedRecording alone = listRecording(row.file);
    EXPECT_EQ(row.exercise, alone.exercise);
    EXPECT_EQ(row.caseKey(), alone.caseKey());
    EXPECT_EQ(row.seconds, alone.seconds);
    EXPECT_EQ(row.cut_short, alone.cut_short);
    ASSERT_EQ(row.problem.has_value(), alone.problem.has_value()) << row.file;
    if (row.problem) {
      EXPECT_EQ(row.problem->sentence(), alone.problem->sentence());
    }
    EXPECT_EQ(row.written, fs::last_write_time(row.file));
  }
  EXPECT_TRUE(listRecordings(folder_ / "none")->empty());
}

TEST_F(RecordingFolder, IsReadTheNewestFirstAndToldAsItIsRead) {
  for (int n = 0; n < 60; ++n) {
    const fs::path file = folder_ / (std::to_string(n) + ".h5");
    std::ofstream(file) << "x";
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::minutes(n));
  }
  std::vector<std::size_t> told;
  ReadApart how;
  how.read = [&](const std::vector<ListedRecording>& so_far) {
    told.push_back(so_far.size());
    EXPECT_EQ(so_far.front().file.filename(), "0.h5");
    EXPECT_EQ(so_far.back().written, fs::last_write_time(so_far.back().file));
  };
  const auto rows = listed(how);
  ASSERT_EQ(rows.size(), 60u);
  // More often than a person sees it need not be told.
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.front(), 10u) << "the first few before the others are read";
  EXPECT_TRUE(std::ranges::is_sorted(told));
  for (std::size_t n = 0; n < rows.size(); ++n) {
    EXPECT_EQ(rows[n].file.filename(), std::to_string(n) + ".h5");
  }
}

TEST_F(RecordingFolder, HasARowForANameThatIsNoPlainLine) {
  record("a\nb.h5");
  const auto rows = listed();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_FALSE(rows[0].problem) << rows[0].problem->sentence();
  EXPECT_EQ(rows[0].file.filename(), "a\nb.h5");
}

const std::string kHangs = "exec sleep 600";  // a file that keeps its reader for ever

constexpr const char* kRow =
    R"(echo '{"schema": "s", "build": "b", "file": "f", "exercise": "x", "case": "", )"
    R"("volume_sha256": "", "seconds": 1.5, "cut_short": false}')";

TEST_F(RecordingFolder, GoesOnPastAFileThatTakesLongOrEndsItsReader) {
  for (const char* name : {"a.h5", "long.h5", "c.h5", "bad.h5", "e.h5"}) {
    std::ofstream(folder_ / name) << "x";
  }
  const auto rows = listed(by("case \"$f\" in *long*) " + kHangs +
                              ";; *bad*) kill -SEGV $$;; esac\n" + std::string(kRow)));
  ASSERT_EQ(rows.size(), 5u);
  for (const ListedRecording& row : rows) {
    const std::string name = row.file.filename().string();
    const std::string code = name == "long.h5"  ? "TAKES_TOO_LONG"
                             : name == "bad.h5" ? "BAD_RECORDING"
                                                : "";
    EXPECT_EQ(row.problem ? row.problem->code.str() : "", code) << name;
    if (code.empty()) {
      EXPECT_EQ(row.seconds, 1.5);
    }
  }
}

TEST_F(RecordingFolder, IsCancelledWhileAFileTakesLong) {
  std::ofstream(folder_ / "a.h5") << "x";
  Progress progress;
  ReadApart how = by("touch '" + (folder_ / "begun").string() + "'; " + kHangs + "");
  how.patience_s = 600.0;
  std::thread person([&] {
    EXPECT_TRUE(test::waitUntil([&] { return fs::exists(folder_ / "begun"); }));
    progress.cancel();
  });
  const auto rows = listRecordings(folder_.path(), progress, how);
  person.join();
  ASSERT_FALSE(rows);
  EXPECT_EQ(rows.error().code.str(), "CANCELLED");
}

TEST_F(RecordingFolder, SaysThatTheReaderCannotWorkWhereItEndsWithoutAWordAgainAndAgain) {
  for (const char* name : {"a.h5", "b.h5", "c.h5", "d.h5"}) std::ofstream(folder_ / name) << "x";
  const auto rows = listRecordings(folder_.path(), Progress(), by("exit 1"));
  ASSERT_FALSE(rows);
  EXPECT_EQ(rows.error().code.str(), "CANNOT_RUN");
  // One such file is a row.
  const auto others = listed(by("case \"$f\" in *b.h5) exit 1;; esac\n" + std::string(kRow)));
  ASSERT_EQ(others.size(), 4u);
  EXPECT_EQ(std::ranges::count_if(others, [](const auto& row) { return row.problem.has_value(); }),
            1);
}

TEST_F(RecordingFolder, SaysThatTheReaderIsNotThere) {
  std::ofstream(folder_ / "a.h5") << "x";
  const auto rows = listRecordings(folder_.path(), Progress(), {folder_ / "none", 1.0});
  ASSERT_FALSE(rows);
  EXPECT_EQ(rows.error().code.str(), "CANNOT_RUN");
}

}  // namespace
}  // namespace trephine
