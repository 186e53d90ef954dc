// How far a recording may be behind the session that it records.
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <ctime>
#include <fstream>
#include <thread>

#include "cases.h"
#include "session_support.h"
#include "support.h"
#include "training/replay.h"

namespace trephine {
namespace {

using test::cranium;
using test::scripted;

// A ball of bone: enough of a cranium for the shipped scene.
Volume ball() {
  return test::shells(64, 1.5, {{40, 1200}});
}

// A slow session is drained as often in its own time as a fast one.
TEST(Recorder, ThatComesLateWritesWhatWaitsBeforeItReturns) {
  test::TemporaryFolder folder;
  Scene scene = cranium();
  scene.rate_hz = 100.0;
  auto session = Session::create(scene, test::placed(scene, ball()), scripted(folder / "s.h5"));
  ASSERT_TRUE(session.ok()) << session.error().sentence();
  int looks = 0;
  const Progress look([&](double fraction, const std::string&) {
    const auto done = std::uint64_t(std::llround(fraction * 1000.0)) + 1;
    const auto reader = SessionReader::open(folder / "s.h5");
    ASSERT_TRUE(reader.ok()) << reader.error().sentence();
    EXPECT_LE(done - (*reader)->tickCount(), 50u) << "of " << done;
    ++looks;
  });
  ASSERT_TRUE((*session)->freewheel(10.0, look).ok());
  EXPECT_GE(looks, 3);
  EXPECT_LT((*session)->report().recorder_behind_ms, 1000.0);
}

std::vector<pid_t> threadsNamed(const std::string& name) {
  std::vector<pid_t> threads;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string comm;
    std::getline(std::ifstream(task.path() / "comm"), comm);
    if (comm == name) threads.push_back(std::stoi(task.path().filename()));
  }
  return threads;
}

TEST(Recorder, ThatWasHeldUpCountsItAndLosesNothing) {
  test::TemporaryFolder folder;
  auto session =
      Session::create(cranium(), test::placed(cranium(), ball()), scripted(folder / "s.h5"));
  ASSERT_TRUE(session.ok()) << session.error().sentence();
  ASSERT_TRUE((*session)->start(4.0).ok());
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  // As a machine that gives it no time: the recorder sleeps in the handler of a signal.
  std::signal(SIGUSR1, [](int) {
    timespec left{2, 0};
    while (::nanosleep(&left, &left) != 0) {
    }
  });
  const std::vector<pid_t> recorder = threadsNamed("recorder");
  ASSERT_EQ(recorder.size(), 1u);
  ASSERT_EQ(::syscall(SYS_tgkill, ::getpid(), recorder.front(), SIGUSR1), 0);
  double most_s = 0.0;
  while (!(*session)->finished()) {
    most_s = std::max(most_s, (*session)->recorderBehind_s());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ASSERT_TRUE((*session)->stop().ok());
  std::signal(SIGUSR1, SIG_DFL);
  const RunReport report = (*session)->report();
  EXPECT_GE(most_s, 1.5);
  EXPECT_GE(report.recorder_behind_ms, 1500.0);
  EXPECT_EQ(report.events_dropped, 0u);
  const auto result = replay(**SessionReader::open(folder / "s.h5"), ball());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << result->first_difference->field;
  EXPECT_EQ(result->ticks, 4000u);
}

}  // namespace
}  // namespace trephine
