// A session whose time its owner moves.
#include <gtest/gtest.h>

#include <cmath>

#include "cases.h"
#include "session_support.h"
#include "support.h"
#include "training/replay.h"

namespace trephine {
namespace {

using test::cranium;
using test::scripted;
using test::smallHead;

std::unique_ptr<Session> made(const std::filesystem::path& recording = {}) {
  auto session = Session::create(test::placed(cranium(), smallHead()), scripted(recording));
  EXPECT_TRUE(session.ok()) << session.error().sentence();
  return *std::move(session);
}

TEST(SteppedSession, ComesToTheSameInPiecesOfAnyLength) {
  const auto whole = made();
  ASSERT_TRUE(whole->freewheel(3.0).ok());
  const test::TemporaryFolder folder;
  const auto pieces = made(folder.path() / "s.h5");
  ASSERT_TRUE(pieces->startStepped(3.0).ok());
  for (double piece_s = 0.001; !pieces->finished(); piece_s *= 1.7) pieces->advance(piece_s);
  EXPECT_EQ(pieces->state().ticks, 3000u);
  pieces->advance(1.0);
  EXPECT_EQ(pieces->state().ticks, 3000u) << "it is over";
  ASSERT_TRUE(pieces->stop().ok());
  const RunReport report = pieces->report();
  EXPECT_GT(report.done.removed_voxels, 0u);
  EXPECT_EQ(report.volume_sha256, whole->report().volume_sha256);
  EXPECT_EQ(report.machine.missed_deadlines, 0u);
  const auto again = replay(**SessionReader::open(folder.path() / "s.h5"), smallHead());
  ASSERT_TRUE(again.ok()) << again.error().sentence();
  EXPECT_TRUE(again->identical);
  EXPECT_EQ(again->ticks, 3000u);
}

TEST(SteppedSession, ItsTimeIsThatOfItsTicks) {
  const auto session = made();
  ASSERT_TRUE(session->startStepped().ok());
  EXPECT_TRUE(session->running());
  EXPECT_EQ(session->now_ns(), 0);
  session->advance(0.25);
  EXPECT_EQ(session->now_ns(), 250'000'000);
  EXPECT_EQ(session->standsStillFor_s(), 0.0);
  ASSERT_TRUE(session->stop().ok());
  EXPECT_FALSE(session->running());
}

TEST(SteppedSession, DoesNotGoBackAndStandsStillOnceItIsStopped) {
  const test::TemporaryFolder folder;
  const auto session = made(folder.path() / "s.h5");
  ASSERT_TRUE(session->startStepped().ok());
  session->advance(0.25);
  for (const double seconds : {-0.1, 0.0, std::nan("")}) session->advance(seconds);
  EXPECT_EQ(session->now_ns(), 250'000'000);
  ASSERT_TRUE(session->stop().ok());
  const std::uint64_t ticks = session->state().ticks;
  session->advance(1.0);
  EXPECT_EQ(session->state().ticks, ticks);
  EXPECT_EQ((*SessionReader::open(folder.path() / "s.h5"))->tickCount(), ticks);
}

TEST(SteppedSession, OneOfNoLengthIsOverAtOnce) {
  const auto session = made();
  ASSERT_TRUE(session->startStepped(0.0).ok());
  EXPECT_TRUE(session->finished());
  session->advance(1.0);
  EXPECT_EQ(session->state().ticks, 0u);
  EXPECT_TRUE(session->stop().ok());
  EXPECT_EQ(session->report().volume_sha256, session->report().volume_sha256_before);
}

TEST(SteppedSession, FreezesAndTakesCommandsAsTimeGoesOn) {
  const auto session = made();
  ASSERT_TRUE(session->startStepped().ok());
  session->advance(1.0);
  EXPECT_FALSE(session->freeze()) << "what was asked for before comes first";
  int asked = 0;
  for (; !session->freeze() && asked < 100; ++asked) session->advance(0.01);
  EXPECT_LT(asked, 100);
  EXPECT_TRUE(session->state().paused);
  session->thaw();
  session->advance(0.1);
  EXPECT_FALSE(session->state().paused);
  EXPECT_TRUE(session->stop().ok());
}

}  // namespace
}  // namespace trephine
