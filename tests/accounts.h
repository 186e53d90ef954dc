// Several accounts of one machine: only numbers, none of which is known to it. Needs root.
#pragma once

#include <grp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "library/shared_storage.h"
#include "support.h"

namespace trephine::test {

// Groups that every Debian has.
inline const StorageGroups kGroups{"users", "games"};
constexpr uid_t kTeacher = 23001, kOther = 23002, kTrainee = 23003, kStranger = 23004;

// In a process of that account, with a plain umask. True where `work` was.
inline bool as(uid_t account, const std::function<bool()>& work) {
  const gid_t readers = ::getgrnam("users")->gr_gid, writers = ::getgrnam("games")->gr_gid;
  const pid_t child = ::fork();
  if (child == 0) {
    const bool teaches = account == kTeacher || account == kOther;
    const gid_t all[] = {readers, writers};
    const std::size_t count = teaches ? 2 : account == kTrainee ? 1 : 0;
    ::umask(022);
    const bool became =
        ::setgroups(count, all) == 0 && ::setgid(account) == 0 && ::setuid(account) == 0;
    ::_exit(became && work() ? 0 : 1);
  }
  int status = 0;
  return ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

// A storage folder that they share.
class SharedStorage : public ::testing::Test {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can be other accounts";
    std::filesystem::permissions(folder_.path(), std::filesystem::perms(0755));
    const auto shared = shareStorage(storage_, kGroups);
    ASSERT_TRUE(shared) << shared.error().sentence();
  }

  TemporaryFolder folder_;
  const std::filesystem::path storage_ = folder_ / "storage";
};

}  // namespace trephine::test
