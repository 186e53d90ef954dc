// One storage folder, several accounts of one machine: who may do what in it. As root, which makes
// the accounts of: a teacher, another, a trainee; only numbers, none is known to the machine.
#include "accounts.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <thread>

#include "base/file.h"
#include "base/shared_folder.h"
#include "cases.h"
#include "library/case_library.h"
#include "library/shared_storage.h"
#include "support.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;

using test::as, test::kGroups, test::kOther, test::kStranger, test::kTeacher, test::kTrainee;

class Accounts : public test::SharedStorage {
 protected:
  std::string savedBy(uid_t account, const std::string& name) const {
    EXPECT_TRUE(as(account, [&] { return CaseLibrary(storage_).save(named(name)).ok(); }));
    for (const ListedCase& one : CaseLibrary(storage_).list()) {
      if (one.record.name == name) return one.id;
    }
    return "";
  }
  static NewCase named(const std::string& name) {
    NewCase of = test::smallCase();
    of.name = name;
    return of;
  }
};

TEST_F(Accounts, WhatATeacherSavesTheOtherTeachersMayChangeAndTraineesOpen) {
  const std::string id = savedBy(kTeacher, "Skull one");
  ASSERT_FALSE(id.empty());
  const auto opens = [&] { return CaseLibrary(storage_).load(id).ok(); };
  EXPECT_TRUE(as(kOther, opens));
  EXPECT_TRUE(as(kTrainee, opens));
  EXPECT_FALSE(as(kStranger, opens)) << "of neither group";
  EXPECT_TRUE(as(kOther, [&] {
    return CaseLibrary(storage_).saveTissues(id, Json{{"format", "trephine.tissues"}}).ok();
  }));
  EXPECT_TRUE(as(kTeacher, opens)) << "also what the other has written";
  EXPECT_TRUE(as(kOther, [&] { return CaseLibrary(storage_).remove(id).ok(); }));
  EXPECT_TRUE(CaseLibrary(storage_).list().empty());
}

TEST_F(Accounts, ATraineeIsToldThatItMayLookAndNotChange) {
  const std::string id = savedBy(kTeacher, "Skull one");
  EXPECT_TRUE(as(kTrainee, [&] {
    CaseLibrary library(storage_);
    const auto saved = library.save(named("Mine"));
    const auto removed = library.remove(id);
    const auto renamed = library.rename(id, "Another");
    const auto says = [](const Error& error) {
      return error.code.str() == "CANNOT_WRITE" &&
             error.what == "This account may look at the cases here, and not change them";
    };
    return !saved && says(saved.error()) && !removed && says(removed.error()) && !renamed &&
           says(renamed.error());
  }));
  EXPECT_EQ(CaseLibrary(storage_).list().size(), 1u);
}

TEST_F(Accounts, WhatACaseMayNotBeCalledIsReadByItsMakerAlone) {
  NewCase of = named("");
  of.source.add(IdentityKind::patient_name, "Doe^Jane");
  ASSERT_TRUE(as(kTeacher, [&] { return CaseLibrary(storage_).save(of).ok(); }));
  std::vector<fs::path> files;
  for (const auto& file : fs::directory_iterator(storage_ / "private")) files.push_back(file);
  ASSERT_EQ(files.size(), 1u);
  const auto reads = [&] { return std::ifstream(files.front()).good(); };
  EXPECT_TRUE(as(kTeacher, reads));
  EXPECT_FALSE(as(kOther, reads));
  EXPECT_FALSE(as(kTrainee, reads));
  const std::string id = CaseLibrary(storage_).list().front().id;
  EXPECT_TRUE(as(kOther, [&] {
    const auto renamed = CaseLibrary(storage_).rename(id, "Skull");
    return !renamed && renamed.error().code.str() == "NAME_UNCHECKED";
  }));
}

TEST_F(Accounts, ARecordingIsItsOwnersToChangeAndNobodyElses) {
  const fs::path own = storage_ / "sessions" / "session-1.h5";
  ASSERT_TRUE(as(kTrainee, [&] {
    const bool written = bool(std::ofstream(own) << "cut");
    keepOwn(own);
    return written;
  }));
  for (const uid_t account : {kTeacher, kOther}) {
    EXPECT_TRUE(as(account, [&] { return std::ifstream(own).good(); })) << "teachers review";
  }
  EXPECT_FALSE(as(kStranger, [&] { return std::ifstream(own).good(); }));
  for (const uid_t account : {kTeacher, kStranger}) {
    EXPECT_FALSE(as(account, [&] { return std::ofstream(own, std::ios::app).good(); }));
    EXPECT_FALSE(as(account, [&] { return std::remove(own.c_str()) == 0; }));
    EXPECT_FALSE(as(account, [&] { return writeTextFile(own, "other").ok(); }));
  }
  EXPECT_TRUE(as(kTrainee, [&] { return std::ofstream(own, std::ios::app).good(); }));
  EXPECT_TRUE(as(kTrainee, [&] { return std::remove(own.c_str()) == 0; }));
}

TEST_F(Accounts, ALockedStorageAndAHalfWrittenCaseAreSaid) {
  const std::string id = savedBy(kTeacher, "Skull one");
  // Another account is at the list and does not let go.
  const int fd = ::open((storage_ / ".lock").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(fd, LOCK_EX), 0);
  EXPECT_TRUE(as(kOther, [&] {
    const auto saved = CaseLibrary(storage_).save(named("Two"));
    return !saved && saved.error().code.str() == "BUSY";
  }));
  ::close(fd);
  fs::resize_file(storage_ / "cases" / id / "volume.mha", 100);
  EXPECT_TRUE(as(kTrainee, [&] {
    const auto loaded = CaseLibrary(storage_).load(id);
    return !loaded && !loaded.error().what.empty() && !loaded.error().next.empty();
  }));
}

TEST_F(Accounts, SharingAgainTakesInWhatWasThereBefore) {
  const fs::path old = folder_ / "old";
  ASSERT_TRUE(CaseLibrary(old).save(named("Before")).ok());
  ASSERT_TRUE(shareStorage(old, kGroups));
  const std::string id = CaseLibrary(old).list().front().id;
  EXPECT_TRUE(as(kTrainee, [&] { return CaseLibrary(old).load(id).ok(); }));
  EXPECT_TRUE(as(kTeacher, [&] { return CaseLibrary(old).remove(id).ok(); }));
  EXPECT_EQ(shareStorage(old, {"no-such-group", "games"}).error().code.str(), "NO_GROUP");
  EXPECT_TRUE(
      as(kTeacher, [&] { return shareStorage(old, kGroups).error().code.str() == "NOT_ROOT"; }));
}

// The order of these checks: nothing is changed where one of them fails.
TEST_F(Accounts, OnlyAStorageFolderIsShared) {
  const auto refused = [](const fs::path& folder) {
    struct stat before {
    }, after{};
    ::stat(folder.c_str(), &before);
    const auto shared = shareStorage(folder, kGroups);
    ::stat(folder.c_str(), &after);
    EXPECT_EQ(before.st_mode, after.st_mode) << folder;
    EXPECT_EQ(before.st_gid, after.st_gid) << folder;
    return shared ? std::string("shared") : shared.error().code.str();
  };
  for (const char* system :
       {"/", "/srv", "/srv/", "/srv/.", "/srv//", "/home", "relative/folder", "/tmp/..",
        "/usr/../srv", "/srv/x/..", "/usr/local/src", "/etc/apt/auth.conf.d", "/var/mail",
        "/var/tmp", "/var/opt", "/srv/a\nb", "/srv/\xff"}) {
    EXPECT_EQ(refused(system), "NOT_A_STORAGE") << system;
  }
  fs::create_directories(folder_ / "home" / "alice");
  EXPECT_EQ(refused(folder_ / "home"), "NOT_A_STORAGE");
  fs::create_directories(folder_ / "letters" / "cases");
  std::ofstream(folder_ / "letters" / "cases" / "letter.txt") << "x";
  EXPECT_EQ(refused(folder_ / "letters"), "NOT_A_STORAGE");
  fs::create_directory_symlink(storage_, folder_ / "link");
  EXPECT_EQ(refused(folder_ / "link"), "NOT_A_STORAGE");
  EXPECT_EQ(refused((folder_ / "link").string() + "/"), "NOT_A_STORAGE");
  fs::create_directories(folder_ / "linked" / "cases" / "c1");
  std::ofstream(folder_ / "key") << "secret";
  fs::permissions(folder_ / "key", fs::perms(0600));
  fs::create_hard_link(folder_ / "key", folder_ / "linked" / "cases" / "c1" / "hard");
  EXPECT_EQ(refused(folder_ / "linked"), "NOT_A_STORAGE");
  fs::create_directories(folder_ / "locked");
  fs::create_hard_link(folder_ / "key", folder_ / "locked" / ".lock");
  EXPECT_EQ(refused(folder_ / "locked"), "NOT_A_STORAGE");
  EXPECT_EQ(fs::status(folder_ / "key").permissions(), fs::perms(0600));
  for (const fs::perms open : {fs::perms(0777), fs::perms(01775)}) {
    fs::create_directories(folder_ / "everybodys");
    fs::permissions(folder_ / "everybodys", open);
    EXPECT_EQ(refused(folder_ / "everybodys"), "NOT_A_STORAGE");
  }
  EXPECT_EQ(refused(folder_ / "key" / "storage"), "NOT_A_STORAGE") << "a file is in the way";
  fs::create_directories(folder_ / "closed");
  fs::permissions(folder_ / "closed", fs::perms(0700));
  EXPECT_EQ(refused(folder_ / "closed" / "storage"), "CANNOT_REACH");
  EXPECT_FALSE(fs::exists(folder_ / "closed" / "storage"));
  EXPECT_TRUE(shareStorage(storage_, kGroups)) << "again";
}

TEST_F(Accounts, ATraineeOpensWhatATeacherSavesWhateverItsUmask) {
  EXPECT_TRUE(as(kTeacher, [&] {
    ::umask(077);
    return CaseLibrary(storage_).save(named("Closed")).ok();
  }));
  const std::string id = CaseLibrary(storage_).list().front().id;
  EXPECT_TRUE(as(kTrainee, [&] { return CaseLibrary(storage_).load(id).ok(); }));
  EXPECT_FALSE(as(kStranger, [&] { return CaseLibrary(storage_).load(id).ok(); }));
}

TEST_F(Accounts, WhatATraineeHasMadeBeforeIsNotItsToChangeAnyMore) {
  const std::string id = savedBy(kTeacher, "Skull one");
  const fs::path file = storage_ / "cases" / id / "case.json";
  ASSERT_EQ(::chown(file.c_str(), kTrainee, gid_t(-1)), 0);
  fs::permissions(file, fs::perms(04666));
  ASSERT_EQ(::chown((storage_ / "cases" / id).c_str(), kTrainee, gid_t(-1)), 0);
  ASSERT_TRUE(shareStorage(storage_, kGroups));
  EXPECT_FALSE(as(kTrainee, [&] { return std::ofstream(file, std::ios::app).good(); }));
  EXPECT_FALSE(as(kTrainee, [&] { return std::remove(file.c_str()) == 0; }));
  EXPECT_FALSE(as(kTrainee, [&] { return ::chmod(file.c_str(), 0666) == 0; }));
  EXPECT_TRUE(as(kTeacher, [&] { return CaseLibrary(storage_).rename(id, "Skull two").ok(); }));
  EXPECT_EQ(fs::status(file).permissions(), fs::perms(0664));
}

TEST_F(Accounts, WhatIsHalfWrittenOfACaseAndItsMakersAloneStaysSo) {
  const fs::path file = storage_ / ".parts" / "new-1" / "private.json";
  fs::create_directory(file.parent_path());
  std::ofstream(file) << "x";
  fs::permissions(file, fs::perms(0600));
  ASSERT_EQ(::chown(file.c_str(), kTeacher, gid_t(-1)), 0);
  ASSERT_TRUE(shareStorage(storage_, kGroups));
  struct stat at {};
  ASSERT_EQ(::stat(file.c_str(), &at), 0);
  EXPECT_EQ(at.st_mode & 0777, 0600u);
  EXPECT_EQ(at.st_uid, uid_t(kTeacher));
}

TEST_F(Accounts, ANameAloneKeepsNothingForItsOwner) {
  const fs::path set = storage_ / "tissues" / "private.json", inside = storage_ / "cases" / "a",
                 folder = storage_ / ".parts" / "new-1" / "private.json";
  fs::create_directories(inside);
  fs::create_directories(folder);
  for (const fs::path& file : {set, inside / "private.json", folder / "private.json"}) {
    std::ofstream(file) << "x";
  }
  for (const fs::path& file : {set, inside / "private.json", folder / "private.json", folder}) {
    ASSERT_EQ(::chown(file.c_str(), kTeacher, gid_t(-1)), 0);
  }
  ASSERT_TRUE(shareStorage(storage_, kGroups));
  for (const fs::path& file : {set, inside / "private.json", folder / "private.json", folder}) {
    struct stat at {};
    ASSERT_EQ(::stat(file.c_str(), &at), 0);
    EXPECT_EQ(at.st_uid, 0u) << file;
  }
}

TEST_F(Accounts, ATraineeCannotKeepTheLock) {
  EXPECT_FALSE(as(kTrainee, [&] {
    const int fd = ::open((storage_ / ".lock").c_str(), O_RDONLY | O_CLOEXEC);
    return fd >= 0 && ::flock(fd, LOCK_EX | LOCK_NB) == 0;
  }));
}

TEST_F(Accounts, SharingFollowsNoLinkOutOfTheStorage) {
  const fs::path secret = folder_ / "secret";
  fs::create_directories(secret);
  std::ofstream(secret / "key") << "x";
  fs::permissions(secret / "key", fs::perms(0600));
  fs::permissions(secret, fs::perms(0700));
  for (const char* in : {"tissues", ".parts", "cases"}) {
    const fs::path link = storage_ / in / "link";
    fs::create_directory_symlink(secret, link);
    EXPECT_EQ(shareStorage(storage_, kGroups).error().code.str(), "NOT_A_STORAGE") << in;
    giveToGroup(link);
    fs::remove(link);
  }
  ASSERT_EQ(::mkfifo((storage_ / "tissues" / "fifo").c_str(), 0600), 0);
  EXPECT_EQ(shareStorage(storage_, kGroups).error().code.str(), "NOT_A_STORAGE");
  fs::remove(storage_ / "tissues" / "fifo");
  EXPECT_EQ(fs::status(secret / "key").permissions(), fs::perms(0600));
  EXPECT_EQ(fs::status(secret).permissions(), fs::perms(0700));
}

// A teacher puts a link in the place of a folder and takes it away, as fast as it can.
TEST_F(Accounts, WhoChangesNamesWhileItIsSharedGetsNothingElse) {
  const fs::path secret = folder_ / "secret", inside = storage_ / "cases" / "a";
  fs::create_directories(secret);
  fs::create_directories(inside / "real");
  for (int i = 0; i < 50; ++i) {
    for (const fs::path& at : {secret, inside / "real"}) {
      std::ofstream(at / std::to_string(i)) << "x";
      fs::permissions(at / std::to_string(i), fs::perms(0600));
    }
  }
  fs::create_directory_symlink(secret, folder_ / "link");
  const auto exchange = [&] {
    return ::renameat2(AT_FDCWD, (inside / "real").c_str(), AT_FDCWD, (folder_ / "link").c_str(),
                       RENAME_EXCHANGE) == 0;
  };
  if (!exchange()) GTEST_SKIP() << "this file system exchanges no names";
  std::jthread teacher([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) exchange();
  });
  for (int i = 0; i < 60; ++i) (void)shareStorage(storage_, kGroups);
  teacher = {};
  for (const auto& file : fs::directory_iterator(secret)) {
    struct stat at {};
    ASSERT_EQ(::stat(file.path().c_str(), &at), 0);
    ASSERT_EQ(at.st_mode & 0777, 0600u);
    ASSERT_EQ(at.st_gid, 0u);
  }
}

TEST(SharedFolder, OneOfAPersonsOwnIsLeftAsItIs) {
  test::TemporaryFolder folder;
  fs::create_directory(folder / "own");
  std::ofstream(folder / "own" / "file") << "x";
  fs::permissions(folder / "own" / "file", fs::perms(0600));
  giveToGroup(folder / "own" / "file");
  keepOwn(folder / "own" / "file");
  EXPECT_EQ(fs::status(folder / "own" / "file").permissions(), fs::perms(0600));
}

}  // namespace
}  // namespace trephine
