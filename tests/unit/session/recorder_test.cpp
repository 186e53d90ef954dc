// How far a recording may be behind the session that it records.
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "cases.h"
#include "session_support.h"
#include "support.h"
#include "training/replay.h"

namespace trephine {
namespace {

using test::cranium;
using test::scripted;

// A ball of bone: enough of a cranium for the shipped exercise.
Volume ball() {
  return test::shells(64, 1.5, {{40, 1200}});
}

// A slow session is drained as often in its own time as a fast one.
TEST(Recorder, ThatComesLateWritesWhatWaitsBeforeItReturns) {
  test::TemporaryFolder folder;
  Exercise exercise = cranium();
  exercise.rate_hz = 100.0;
  auto session = Session::create(test::placed(exercise, ball()), scripted(folder / "s.h5"));
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
  EXPECT_LT((*session)->report().machine.recorder_behind_ms, 1000.0);
}

// The two ends of a pipe: who reads it waits until the other is written to.
int held_up[2];

TEST(Recorder, ThatWasHeldUpCountsItAndLosesNothing) {
  test::TemporaryFolder folder;
  auto session = Session::create(test::placed(cranium(), ball()), scripted(folder / "s.h5"));
  ASSERT_TRUE(session.ok()) << session.error().sentence();
  ASSERT_EQ(::pipe(held_up), 0);
  ASSERT_TRUE((*session)->start(3.0).ok());
  ASSERT_TRUE(test::waitUntil([&] { return (*session)->state().ticks > 500; }));
  // As a machine that gives it no time: the recorder waits in the handler of a signal.
  std::signal(SIGUSR1, [](int) {
    char go_on = 0;
    while (::read(held_up[0], &go_on, 1) < 0 && errno == EINTR) {
    }
  });
  const std::vector<pid_t> recorder = test::threadsNamed("recorder");
  ASSERT_EQ(recorder.size(), 1u);
  ASSERT_EQ(::syscall(SYS_tgkill, ::getpid(), recorder.front(), SIGUSR1), 0);
  EXPECT_TRUE(test::waitUntil([&] { return (*session)->recorderBehind_s() >= 1.6; }));
  ASSERT_EQ(::write(held_up[1], "g", 1), 1);
  EXPECT_TRUE(test::waitUntil([&] { return (*session)->finished(); }));
  ASSERT_TRUE((*session)->stop().ok());
  std::signal(SIGUSR1, SIG_DFL);
  for (const int end : held_up) ::close(end);
  const RunReport report = (*session)->report();
  EXPECT_GE(report.machine.recorder_behind_ms, 1500.0);
  EXPECT_EQ(report.machine.events_dropped, 0u);
  const auto result = replay(**SessionReader::open(folder / "s.h5"), ball());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << result->first_difference->field;
  EXPECT_EQ(result->ticks, 3000u);
}

}  // namespace
}  // namespace trephine
