#include "base/child_process.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <vector>

#include "support.h"

namespace trephine {
namespace {

using namespace std::chrono_literals;

class Child : public ::testing::Test {
 protected:
  ChildCommand shell(const std::string& script) const {
    ChildCommand command;
    command.words = {"/bin/sh", "-c", script};
    command.output = folder_ / "stdout";
    command.home = folder_.path();
    return command;
  }
  std::string output() const {
    std::ifstream in(folder_ / "stdout");
    return {std::istreambuf_iterator<char>(in), {}};
  }

  test::TemporaryFolder folder_;
  Progress progress_;
};

TEST_F(Child, TellsItsExitCodeOutputAndTime) {
  const auto from = std::chrono::steady_clock::now();
  const Result<ChildRun> run = runChild(
      shell("date +%s.%N; echo lost >&2; head -c 20000000 /dev/zero | cksum; date +%s.%N; exit 7"),
      progress_);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
  ASSERT_TRUE(run) << run.error().sentence();
  EXPECT_EQ(run->exit_code, 7);
  EXPECT_FALSE(run->timed_out);
  std::istringstream out(output());
  double begun_s = 0.0, sum = 0.0, bytes = 0.0, ended_s = 0.0;
  ASSERT_TRUE(out >> begun_s >> sum >> bytes >> ended_s) << output();
  EXPECT_EQ(output().find("lost"), std::string::npos);
  EXPECT_GE(run->seconds, ended_s - begun_s);
  EXPECT_LE(run->seconds, took.count());
  const Result<ChildRun> killed = runChild(shell("kill -SEGV $$"), progress_);
  ASSERT_TRUE(killed);
  EXPECT_EQ(killed->exit_code, 128 + 11);
}

TEST_F(Child, OfACommandOfOursTheErrorIsRead) {
  const auto said = [&](const std::string& text) {
    EXPECT_TRUE(runChild(shell("printf '%s' '" + text + "'; exit 1"), progress_));
    return errorSaid(folder_ / "stdout");
  };
  const auto error =
      said(R"({"error":{"code":"NO_DEVICE","what":"No arm","where":"left","next":"Plug it in"}})");
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code.str(), "NO_DEVICE");
  EXPECT_EQ(error->sentence(), "No arm (left). Plug it in.");
  for (const char* other :
       {"", "{}", "a driver talks", R"({"error":"x"})", R"({"error":{}})", "[]"})
    EXPECT_FALSE(said(other)) << other;
}

TEST_F(Child, TellsThePeakOfItsMemory) {
  ASSERT_EQ(std::string(std::size_t(400) << 20, 'x').back(), 'x') << "ours, and given back";
  ChildCommand nothing = shell(":"),
               dd = shell("exec dd if=/dev/zero of=/dev/null bs=200M count=1");
  nothing.measures_memory = dd.measures_memory = true;
  const Result<ChildRun> small = runChild(nothing, progress_), large = runChild(dd, progress_);
  ASSERT_TRUE(small && large && small->peak_rss_mb && large->peak_rss_mb);
  EXPECT_GT(*large->peak_rss_mb, 200.0);
  EXPECT_LT(*large->peak_rss_mb, 300.0);
  EXPECT_LT(*small->peak_rss_mb, *large->peak_rss_mb - 100.0);
  EXPECT_FALSE(runChild(shell(":"), progress_)->peak_rss_mb) << "it would be ours";
}

TEST_F(Child, HasItsOwnHomeAndTheRestOfTheEnvironment) {
  ::setenv("TREPHINE_CHILD_TEST", "kept", 1);
  ASSERT_TRUE(runChild(shell("echo $HOME $TREPHINE_CHILD_TEST"), progress_));
  EXPECT_EQ(output(), folder_.path().string() + " kept\n");
}

TEST_F(Child, HasOurHomeWhereNoOtherIsGiven) {
  ChildCommand command = shell("echo $HOME");
  command.home.clear();
  ASSERT_TRUE(runChild(command, progress_));
  EXPECT_EQ(output(), std::string(std::getenv("HOME")) + "\n");
}

TEST_F(Child, IsInAGroupOfItsOwnSoThatATerminalsSignalsAreOurs) {
  ASSERT_TRUE(runChild(
      shell("read pid name state parent group rest < /proc/self/stat; echo $((group - $$))"),
      progress_));
  EXPECT_EQ(output(), "0\n");
}

TEST_F(Child, WritesWhereItIsToldToWhereThisProgramHasNoStdout) {
  const int saved = ::dup(STDOUT_FILENO);
  ::close(STDOUT_FILENO);
  const bool ran = runChild(shell("echo out"), progress_).ok();
  ::dup2(saved, STDOUT_FILENO);
  ::close(saved);
  EXPECT_TRUE(ran);
  EXPECT_EQ(output(), "out\n");
}

TEST_F(Child, ThatIsToEndIsAskedFirst) {
  ChildCommand command =
      shell("trap 'kill $!; echo in order; exit 3' TERM; tail -f /dev/null & wait");
  command.limit_s = 0.3;
  const Result<ChildRun> run = runChild(command, progress_);
  ASSERT_TRUE(run);
  EXPECT_TRUE(run->timed_out);
  EXPECT_EQ(run->exit_code, 3);
  EXPECT_EQ(output(), "in order\n");
}

TEST_F(Child, ThatDoesNotEndWhenAskedIsKilled) {
  ChildCommand command = shell("trap '' TERM; exec tail -f /dev/null");
  command.limit_s = 0.3;
  const Result<ChildRun> run = runChild(command, progress_);
  ASSERT_TRUE(run);
  EXPECT_TRUE(run->timed_out);
  EXPECT_EQ(run->exit_code, 128 + 9);
}

TEST_F(Child, SaysMeanwhileHowNearTheLimitIs) {
  ASSERT_EQ(::mkfifo((folder_ / "gate").c_str(), 0600), 0);
  std::vector<double> shares;
  const Progress progress([&](double share, const std::string& step) {
    EXPECT_EQ(step, "Waiting");
    shares.push_back(share);
    if (shares.size() == 3) std::ofstream(folder_ / "gate") << "on\n";
  });
  ChildCommand command = shell("read line < '" + (folder_ / "gate").string() + "'");
  command.limit_s = 10.0;
  command.step = "Waiting";
  ASSERT_TRUE(runChild(command, progress));
  ASSERT_GT(shares.size(), 1u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_GT(shares.back(), 0.02) << "it was asked every 0.1 s";
  EXPECT_LE(shares.back(), 1.0);
}

TEST_F(Child, IsEndedWhenItTakesTooLong) {
  ChildCommand command = shell("exec tail -f /dev/null");
  command.limit_s = 0.1;
  const Result<ChildRun> run = runChild(command, progress_);
  ASSERT_TRUE(run);
  EXPECT_TRUE(run->timed_out);
  EXPECT_LT(run->seconds, 30.0);
}

TEST_F(Child, IsEndedWhenTheWorkIsCancelled) {
  Progress progress([&](double, const std::string&) { progress.cancel(); });  // while it runs
  ChildCommand command = shell("exec tail -f /dev/null");
  command.step = "Waiting";
  const auto start = std::chrono::steady_clock::now();
  const Result<ChildRun> run = runChild(command, progress);
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code.str(), "CANCELLED");
  EXPECT_LT(std::chrono::steady_clock::now() - start, 30s);
}

TEST_F(Child, ThatCannotBeRunIsNamed) {
  ChildCommand command = shell("");
  command.words = {(folder_ / "no-such-program").string()};
  const Result<ChildRun> run = runChild(command, progress_);
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().code.str(), "CANNOT_RUN");
  EXPECT_NE(run.error().sentence().find("no-such-program"), std::string::npos);
  EXPECT_NE(run.error().sentence().find("No such file"), std::string::npos);
}

}  // namespace
}  // namespace trephine
