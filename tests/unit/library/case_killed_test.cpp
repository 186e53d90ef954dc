// kill -9 in the middle: before each step that changes the disk, and halfway through what is
// written.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <new>

#include "cases.h"

namespace trephine {
namespace {

// Of a child, in memory that it shares: the steps that it has taken, and the one at which it dies.
struct DiskSteps {
  std::atomic<int> taken{0}, last{-1};
};
DiskSteps* disk_steps = nullptr;  // null: this is no child

bool isLastStep() {
  return disk_steps && disk_steps->taken++ == disk_steps->last;
}

[[noreturn]] void dieHere() {
  for (;;) ::kill(::getpid(), SIGKILL);
}

template <class Function>
Function* theSystems(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace
}  // namespace trephine

// In the way of the C library's, for all of the program.
extern "C" {

ssize_t write(int descriptor, const void* from, size_t bytes) {
  static auto* const real = trephine::theSystems<ssize_t(int, const void*, size_t)>("write");
  if (!trephine::isLastStep()) return real(descriptor, from, bytes);
  static_cast<void>(!real(descriptor, from, bytes / 2));
  trephine::dieHere();
}

int fsync(int descriptor) {
  static auto* const real = trephine::theSystems<int(int)>("fsync");
  if (trephine::isLastStep()) trephine::dieHere();
  return real(descriptor);
}

int rename(const char* from, const char* to) noexcept {
  static auto* const real = trephine::theSystems<int(const char*, const char*)>("rename");
  if (trephine::isLastStep()) trephine::dieHere();
  return real(from, to);
}

int remove(const char* path) noexcept {
  static auto* const real = trephine::theSystems<int(const char*)>("remove");
  if (trephine::isLastStep()) trephine::dieHere();
  return real(path);
}

int unlinkat(int folder, const char* path, int flags) noexcept {
  static auto* const real = trephine::theSystems<int(int, const char*, int)>("unlinkat");
  if (trephine::isLastStep()) trephine::dieHere();
  return real(folder, path, flags);
}

int mkdir(const char* path, mode_t mode) noexcept {
  static auto* const real = trephine::theSystems<int(const char*, mode_t)>("mkdir");
  if (trephine::isLastStep()) trephine::dieHere();
  return real(path, mode);
}

}  // extern "C"

namespace trephine {
namespace {

// Runs `work` in a child that dies at that step, or ends where it has fewer; how many it took.
class Child {
 public:
  Child()
      : steps_(new (::mmap(nullptr, sizeof(DiskSteps), PROT_READ | PROT_WRITE,
                           MAP_SHARED | MAP_ANONYMOUS, -1, 0)) DiskSteps) {}
  ~Child() { ::munmap(steps_, sizeof(DiskSteps)); }
  template <class Work>
  bool isKilledAt(int step, const Work& work) {
    steps_->taken = 0;
    steps_->last = step;
    const pid_t child = ::fork();
    if (child == 0) {
      disk_steps = steps_;
      work();
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
  }
  template <class Work>
  int stepsOf(const Work& work) {
    EXPECT_FALSE(isKilledAt(-1, work));
    return steps_->taken;
  }

 private:
  DiskSteps* steps_;
};

NewCase someCase() {
  NewCase of = test::smallCase({40, 40, 32});
  of.source.add(IdentityKind::patient_name, "DOE^JANE");
  return of;
}

TEST(CaseKilled, WhileItIsSavedIsThereWholeOrNotAtAll) {
  const test::TemporaryFolder temporary;
  const NewCase of = someCase();
  const auto save = [&] { (void)CaseLibrary(temporary.path()).save(of); };
  save();
  Child child;
  const int steps = child.stepsOf(save);
  std::size_t there = 2;
  int first = steps;  // at which it is there already
  for (int step = 0; step < steps; ++step) {
    ASSERT_TRUE(child.isKilledAt(step, save)) << step;
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
      EXPECT_EQ(library.rename(one.id, "Jane").error().code.str(), "NAME_IS_IDENTITY");
    }
    if (cases.size() > there && first == steps) first = step;
    there += step >= first;
    EXPECT_EQ(cases.size(), there) << step;
  }
  std::printf("[ figures  ] of %d steps on the disk it is there after %d\n", steps, first);
  EXPECT_GT(first, steps / 2);
  EXPECT_LT(first, steps) << "some kill comes when it is there";
}

TEST(CaseKilled, WhileItsStructuresAreSavedHasTheOldOrTheNewOnes) {
  const test::TemporaryFolder temporary;
  const NewCase of = someCase();
  const std::string id = CaseLibrary(temporary.path()).save(of)->record.id;
  std::vector<LabelMap> maps{*of.structures, *of.structures};
  for (auto& label : maps[1].labels) label = label == 5 ? 1 : label == 1 ? 5 : 0;
  std::swap(maps[1].structures[0], maps[1].structures[1]);
  std::size_t has = 0;
  const auto change = [&] {
    (void)CaseLibrary(temporary.path()).saveStructures(id, maps[1 - has]);
  };
  Child child;
  const int steps = child.stepsOf(change);
  has = 1;
  int old = 0;
  for (int step = 0; step < steps; ++step) {
    ASSERT_TRUE(child.isKilledAt(step, change)) << step;
    CaseLibrary library(temporary.path());
    EXPECT_EQ(test::entriesIn(temporary / ".parts"), 0u);
    const auto loaded = library.load(id);
    ASSERT_TRUE(loaded) << loaded.error().sentence();
    const bool kept = loaded->structures->labels == maps[has].labels;
    if (!kept) has = 1 - has;
    EXPECT_EQ(loaded->structures->labels, maps[has].labels);
    EXPECT_TRUE(!kept || old == step) << "first the old ones, then the new ones";
    old += kept;
    ASSERT_EQ(library.list().size(), 1u);
    EXPECT_EQ(library.list()[0].record.structures[0].name, loaded->structures->structures[0].name);
    EXPECT_EQ(library.rename(id, "Jane").error().code.str(), "NAME_IS_IDENTITY");
  }
  std::printf("[ figures  ] of %d steps on the disk the old ones are there until %d\n", steps, old);
  EXPECT_GT(old, 1);
  EXPECT_LT(old, steps);
}

TEST(CaseKilled, WhileItIsRemovedIsThereWholeOrNotAtAll) {
  const test::TemporaryFolder temporary;
  const NewCase of = someCase();
  std::string id = CaseLibrary(temporary.path()).save(of)->record.id;
  const auto remove = [&] { (void)CaseLibrary(temporary.path()).remove(id); };
  Child child;
  const int steps = child.stepsOf(remove);
  EXPECT_GT(steps, 5);
  bool there = false;
  for (int step = 0; step < steps; ++step) {
    if (!there) id = CaseLibrary(temporary.path()).save(of)->record.id;
    ASSERT_TRUE(child.isKilledAt(step, remove)) << step;
    CaseLibrary library(temporary.path());
    EXPECT_EQ(test::entriesIn(temporary / ".parts"), 0u);
    const auto cases = library.list();
    there = !cases.empty();
    EXPECT_EQ(there, step == 0) << "its first step takes it away";
    EXPECT_EQ(test::entriesIn(temporary / "private"), cases.size());
    for (const ListedCase& one : cases) EXPECT_TRUE(library.load(one.id));
  }
}

}  // namespace
}  // namespace trephine
