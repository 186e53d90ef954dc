#include "base/crash_report.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "base/log.h"
#include "base/system.h"
#include "support.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;

// In a process of its own; by which signal it ended.
int endedBy(const fs::path& folder, const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (!reportCrashesTo(folder)) ::_exit(1);
    work();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

std::string textOf(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

__attribute__((noinline)) void untilTheStackIsFull(volatile char* before) {
  volatile char room[4096];
  room[0] = before ? before[0] : '\0';
  if (room[0] == '\0') untilTheStackIsFull(room);  // always
  room[1] = room[0];
}

TEST(CrashReport, SaysVersionSignalLogAndStackAndTheRecordingsNameAlone) {
  test::TemporaryFolder folder;
  const fs::path recording = folder / "Jane Doe" / "session-1.h5";
  fs::create_directories(recording.parent_path());
  std::ofstream(recording) << "cut";
  EXPECT_EQ(endedBy(folder / "state",
                    [&] {
                      setUpLog(false);
                      spdlog::warn("the last words");
                      noteRecording(recording);
                      ::raise(SIGSEGV);
                    }),
            SIGSEGV)
      << "it ends as it would have ended";
  const auto left = takeLeftBehind(folder / "state");
  ASSERT_TRUE(left);
  EXPECT_EQ(left->recording, recording);
  const std::string text = textOf(left->report);
  const std::string parts[] = {buildName(), "SIGSEGV", "the last words", "session-1.h5",
                               "test_base +0x"};
  for (const std::string& part : parts) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  }
  EXPECT_EQ(text.find("Jane Doe"), std::string::npos) << text;
  EXPECT_EQ(text.find(folder.path().string()), std::string::npos) << text;
  EXPECT_EQ(fs::status(left->report).permissions(), fs::perms(0600));
  EXPECT_FALSE(takeLeftBehind(folder / "state")) << "told once";
  EXPECT_TRUE(fs::exists(left->report)) << "and kept";
}

TEST(CrashReport, IsWrittenWhereTheStackIsFullAndByEachWayToCrash) {
  for (const int signal : {SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    test::TemporaryFolder folder;
    EXPECT_EQ(endedBy(folder.path(), [&] { ::raise(signal); }), signal);
    EXPECT_TRUE(takeLeftBehind(folder.path())) << signal;
  }
  test::TemporaryFolder folder;
  EXPECT_EQ(endedBy(folder.path(), [] { untilTheStackIsFull(nullptr); }), SIGSEGV);
  EXPECT_TRUE(takeLeftBehind(folder.path()));
}

TEST(CrashReport, OfOneThatWasKilledTheRecordingIsNamed) {
  test::TemporaryFolder folder;
  EXPECT_EQ(endedBy(folder.path(),
                    [&] {
                      noteRecording("session-2.h5");
                      ::raise(SIGKILL);
                    }),
            SIGKILL);
  const auto left = takeLeftBehind(folder.path());
  ASSERT_TRUE(left);
  EXPECT_TRUE(left->report.empty());
  EXPECT_EQ(left->recording.filename(), "session-2.h5");
}

TEST(CrashReport, ItsFolderIsOfThisAccountAlone) {
  test::TemporaryFolder folder;
  const fs::path state = folder / "state";
  fs::create_directories(state);
  fs::permissions(state, fs::perms(0755));
  EXPECT_EQ(endedBy(state, [] { noteRecording("/case of Jane Doe/session-1.h5"); }), 0);
  EXPECT_EQ(fs::status(state).permissions(), fs::perms::owner_all);
}

TEST(CrashReport, OneThatEndedAsItShouldOrStillRunsLeavesNothing) {
  test::TemporaryFolder folder;
  EXPECT_EQ(endedBy(folder.path(),
                    [&] {
                      noteRecording("session-3.h5");
                      noteRecording({});
                    }),
            0);
  EXPECT_FALSE(takeLeftBehind(folder.path()));
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    (void)reportCrashesTo(folder.path());
    noteRecording("session-4.h5");
    char done = 1;
    static_cast<void>(!::write(ends[1], &done, 1));
    ::pause();
  }
  char done = 0;
  ASSERT_EQ(::read(ends[0], &done, 1), 1);
  EXPECT_FALSE(takeLeftBehind(folder.path())) << "another window of this account is at work";
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(takeLeftBehind(folder.path()));
}

TEST(CrashReport, TheNewestIsToldByTheTimeOfItsFile) {
  test::TemporaryFolder folder;
  constexpr long kOld = 999999001, kNew = 999999000;  // no program has such a number
  const auto report = [&](long pid) { return folder / ("crash-" + std::to_string(pid) + ".txt"); };
  std::ofstream(report(kOld)) << "old";
  std::ofstream(report(kNew)) << "new";
  fs::last_write_time(report(kOld), fs::file_time_type::clock::now() - std::chrono::hours(48));
  const auto left = takeLeftBehind(folder.path());
  ASSERT_TRUE(left);
  std::ifstream told(left->report);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(told), {}), "new");
  const std::string name = left->report.filename().string();
  const double at_s = std::stod(name.substr(std::string("crash-").size()));
  EXPECT_NEAR(at_s, double(std::time(nullptr)), 60.0) << "its name has the time: " << name;
}

TEST(CrashReport, WhatIsNoReportOfOursIsNeitherReadNorDeleted) {
  test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "running-999999002").c_str(), 0600), 0);
  ASSERT_EQ(::mkfifo((folder / "crash-999999003.txt").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder / "running-999999004");
  std::ofstream(folder / "running-999999005") << "x";
  fs::resize_file(folder / "running-999999005", 2'000'000'000);
  EXPECT_FALSE(takeLeftBehind(folder.path()));
  std::ofstream(folder / "crash-mynotes.txt") << "mine";
  fs::last_write_time(folder / "crash-mynotes.txt",
                      fs::file_time_type::clock::now() - std::chrono::hours(48));
  for (int i = 0; i < 12; ++i) {
    endedBy(folder.path(), [] { ::raise(SIGABRT); });
    EXPECT_TRUE(takeLeftBehind(folder.path()));
  }
  EXPECT_TRUE(fs::exists(folder / "crash-mynotes.txt"));
}

TEST(CrashReport, TheLastTenReportsAreKeptAndAFolderThatCannotBeIsSaid) {
  test::TemporaryFolder folder;
  for (int i = 0; i < 13; ++i) {
    endedBy(folder.path(), [] { ::raise(SIGABRT); });
    EXPECT_TRUE(takeLeftBehind(folder.path()));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 10);
  std::ofstream(folder / "file") << "x";
  EXPECT_FALSE(reportCrashesTo(folder / "file" / "state"));
  EXPECT_FALSE(takeLeftBehind(folder / "none"));
}

}  // namespace
}  // namespace trephine
