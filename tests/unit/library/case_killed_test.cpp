// kill -9 in the middle.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <random>
#include <thread>

#include "cases.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Runs `work` in a child that is killed after that time, or ends. Whether it ended by itself.
template <class Work>
bool endedBefore(Clock::duration time, const Work& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    ::_exit(0);
  }
  std::this_thread::sleep_for(time);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status);
}

template <class Work>
Clock::duration timeOf(const Work& work) {
  const auto begin = Clock::now();
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  return Clock::now() - begin;
}

NewCase someCase() {
  NewCase of = test::smallCase({96, 96, 80});
  of.source.add(IdentityKind::patient_name, "DOE^JANE");
  return of;
}

TEST(CaseKilled, WhileItIsSavedIsThereWholeOrNotAtAll) {
  const test::TemporaryFolder temporary;
  const NewCase of = someCase();
  const auto save = [&] { (void)CaseLibrary(temporary.path()).save(of); };
  const auto whole = timeOf(save);
  std::mt19937 random(19);
  int ended = 0, there = 1;
  for (int n = 0; n < 20; ++n) {
    ended += endedBefore(whole * int(random() % 1000) / 900, save);
    CaseLibrary library(temporary.path());
    EXPECT_EQ(test::entriesIn(temporary / ".parts"), 0u);
    const auto cases = library.list();
    EXPECT_EQ(test::entriesIn(temporary / "private"), cases.size());
    for (const ListedCase& one : cases) {
      ASSERT_FALSE(one.problem) << one.problem->sentence();
      const auto loaded = library.load(one.id);
      ASSERT_TRUE(loaded) << loaded.error().sentence();
      EXPECT_EQ(loaded->volume->hu, of.volume->hu);
      EXPECT_EQ(loaded->structures->labels, of.structures->labels);
      EXPECT_EQ(loaded->tissues, of.tissues);
      EXPECT_EQ(library.rename(one.id, "Jane").error().code, "NAME_IS_IDENTITY");
    }
    EXPECT_GE(cases.size(), std::size_t(there));
    there = int(cases.size());
  }
  std::printf("[ figures  ] a save takes %.0f ms; of 20, %d ended before they were killed\n",
              std::chrono::duration<double, std::milli>(whole).count(), ended);
  EXPECT_GE(there, ended + 1);  // some were killed when it was there already
  EXPECT_LT(ended, 20);
}

TEST(CaseKilled, WhileItsStructuresAreSavedHasTheOldOrTheNewOnes) {
  const test::TemporaryFolder temporary;
  const NewCase of = someCase();
  const std::string id = CaseLibrary(temporary.path()).save(of)->record.id;
  std::vector<LabelMap> maps{*of.structures, *of.structures};
  for (auto& label : maps[1].labels) label = label == 5 ? 1 : label == 1 ? 5 : 0;
  std::swap(maps[1].structures[0], maps[1].structures[1]);
  const auto change = [&](std::size_t to) {
    (void)CaseLibrary(temporary.path()).saveStructures(id, maps[to]);
  };
  const auto whole = timeOf([&] { change(1); });
  std::mt19937 random(20);
  int old = 0;
  for (int n = 0; n < 20; ++n) {
    endedBefore(whole * int(random() % 1000) / 900, [&] { change(std::size_t(n % 2)); });
    CaseLibrary library(temporary.path());
    EXPECT_EQ(test::entriesIn(temporary / ".parts"), 0u);
    const auto loaded = library.load(id);
    ASSERT_TRUE(loaded) << loaded.error().sentence();
    const bool first = loaded->structures->labels == maps[0].labels;
    EXPECT_TRUE(first || loaded->structures->labels == maps[1].labels);
    old += first != (n % 2 == 0);
    ASSERT_EQ(library.list().size(), 1u);
    EXPECT_EQ(library.list()[0].record.structures[0].name, loaded->structures->structures[0].name);
    EXPECT_EQ(library.rename(id, "Jane").error().code, "NAME_IS_IDENTITY");
  }
  std::printf("[ figures  ] of 20 that were killed, %d kept the old ones\n", old);
}

TEST(CaseKilled, WhileItIsRemovedIsThereWholeOrNotAtAll) {
  const test::TemporaryFolder temporary;
  const NewCase of = someCase();
  std::mt19937 random(21);
  for (int n = 0; n < 10; ++n) {
    const std::string id = CaseLibrary(temporary.path()).save(of)->record.id;
    endedBefore(std::chrono::microseconds(random() % 20000),
                [&] { (void)CaseLibrary(temporary.path()).remove(id); });
    CaseLibrary library(temporary.path());
    EXPECT_EQ(test::entriesIn(temporary / ".parts"), 0u);
    const auto cases = library.list();
    EXPECT_EQ(test::entriesIn(temporary / "private"), cases.size());
    for (const ListedCase& one : cases) EXPECT_TRUE(library.load(one.id));
  }
}

}  // namespace
}  // namespace trephine
