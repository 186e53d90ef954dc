#include "base/file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <sstream>

#include "base/disk_room.h"
#include "file_size_limit.h"
#include "support.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::size_t filesIn(const fs::path& folder) {
  return std::size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(WriteTextFile, WritesANewFile) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writeTextFile(folder / "new.json", "{}\n"));
  EXPECT_EQ(contentOf(folder / "new.json"), "{}\n");
  EXPECT_EQ(filesIn(folder.path()), 1u);
}

TEST(WriteTextFile, ReplacesAnOldFile) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writeTextFile(folder / "file", "a long old text"));
  ASSERT_TRUE(writeTextFile(folder / "file", "new"));
  EXPECT_EQ(contentOf(folder / "file"), "new");
  EXPECT_EQ(filesIn(folder.path()), 1u);
}

TEST(TryRoom, LeavesNothingAndNamesTheFolderThatHasNone) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(tryRoom(folder.path(), 100'000));
  Status status;
  {
    test::FileSizeLimit limit(4096);
    status = tryRoom(folder.path(), 100'000);
  }
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE");
  EXPECT_EQ(status.error().where, folder.path().string());
  EXPECT_EQ(filesIn(folder.path()), 0u);
}

TEST(WriteTextFile, KeepsTheOldFileWhenTheDiskIsFull) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "file";
  ASSERT_TRUE(writeTextFile(file, "old"));
  Status status;
  {
    test::FileSizeLimit limit(4096);
    status = writeTextFile(file, std::string(100000, 'x'));
  }
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE");
  EXPECT_EQ(status.error().where, file.string());
  EXPECT_NE(status.error().what.find("File too large"), std::string::npos) << status.error().what;
  EXPECT_EQ(contentOf(file), "old");
  EXPECT_EQ(filesIn(folder.path()), 1u) << "a part of the new file was left behind";
}

TEST(WriteTextFile, SaysWhyItCannotWriteIntoAMissingFolder) {
  const test::TemporaryFolder folder;
  const Status status = writeTextFile(folder.path() / "none" / "file", "text");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE");
  EXPECT_NE(status.error().what.find("No such file or directory"), std::string::npos);
  EXPECT_FALSE(status.error().next.empty());
}

TEST(WriteTextFile, LeavesAFolderInItsPlaceAlone) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(makeFolder(folder / "taken"));
  const Status status = writeTextFile(folder / "taken", "text");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE");
  EXPECT_TRUE(fs::is_directory(folder / "taken"));
  EXPECT_EQ(filesIn(folder.path()), 1u);
}

TEST(NewFile, IsRefusedWhereAnythingHasItsNameAndLeavesItAlone) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writeTextFile(folder / "file", "old"));
  ASSERT_TRUE(makeFolder(folder / "folder"));
  ASSERT_EQ(::mkfifo((folder / "fifo").c_str(), 0600), 0);
  fs::create_symlink(folder / "file", folder / "link");
  fs::create_symlink(folder / "none", folder / "broken");
  for (const fs::path& taken : {folder / "file", folder / "folder", folder / "fifo",
                                folder / "link", folder / "broken", fs::path("/dev/full")}) {
    const Status status = checkNewFile(taken, "--csv");
    ASSERT_FALSE(status) << taken;
    EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE");
    EXPECT_EQ(status.error().where, taken.string());
    EXPECT_NE(status.error().next.find("--csv"), std::string::npos);
  }
  EXPECT_EQ(contentOf(folder / "file"), "old");
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(NewFile, NeedsAFolderThatTakesIt) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(checkNewFile(folder / "new", "--csv"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
  EXPECT_EQ(checkNewFile(folder / "none" / "new", "--csv").error().code.str(), "MISSING_FOLDER");
  EXPECT_EQ(checkNewFile("/proc/new", "--csv").error().code.str(), "CANNOT_WRITE");
}

TEST(AfterFailedWrite, SpaceIsNamedOnlyWhereItIsShort) {
  for (int error : {ENOSPC, EDQUOT, EFBIG}) {
    EXPECT_NE(afterFailedWrite(error).find("space"), std::string::npos) << error;
  }
  for (int error : {EACCES, EROFS, ENOENT, EIO, 0}) {
    EXPECT_EQ(afterFailedWrite(error).find("space"), std::string::npos) << error;
    EXPECT_FALSE(afterFailedWrite(error).empty());
  }
}

TEST(ReplaceFile, ShowsTheTargetOnlyWhenItIsComplete) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "file";
  const Status status = replaceFile(file, [&](const fs::path& temporary) -> Status {
    std::ofstream(temporary) << "half";
    EXPECT_FALSE(fs::exists(file));
    EXPECT_EQ(temporary.parent_path(), file.parent_path());
    std::ofstream(temporary, std::ios::app) << " and half";
    return {};
  });
  ASSERT_TRUE(status);
  EXPECT_EQ(contentOf(file), "half and half");
}

TEST(ReplaceFile, KeepsTheOldFileAndTheWritersReasonWhenWritingFails) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "file";
  ASSERT_TRUE(writeTextFile(file, "old"));
  const Status status = replaceFile(file, [](const fs::path& temporary) -> Status {
    std::ofstream(temporary) << "half";
    return Error{Code("BROKEN"), "The writer broke", "", ""};
  });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code.str(), "BROKEN");
  EXPECT_EQ(contentOf(file), "old");
  EXPECT_EQ(filesIn(folder.path()), 1u);
}

TEST(ReplaceFile, KeepsTheOldFileWhenTheWriterWroteNothing) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "file";
  ASSERT_TRUE(writeTextFile(file, "old"));
  const Status status = replaceFile(file, [](const fs::path&) -> Status { return {}; });
  ASSERT_FALSE(status);
  EXPECT_EQ(contentOf(file), "old");
}

TEST(ReplaceFile, KeepsTheExtensionByWhichWritersChooseTheFormat) {
  const test::TemporaryFolder folder;
  const auto temporaryName = [&](const std::string& name) {
    std::string seen;
    EXPECT_TRUE(replaceFile(folder / name, [&](const fs::path& temporary) {
      seen = temporary.filename().string();
      return writeTextFile(temporary, "x");
    }));
    return seen;
  };
  EXPECT_TRUE(temporaryName("a.mha").ends_with(".mha"));
  EXPECT_TRUE(temporaryName("a.nii.gz").ends_with(".nii.gz"));
  EXPECT_NE(temporaryName("a.mha"), "a.mha");
}

TEST(MakeFolder, MakesParentsAndAcceptsAnExistingFolder) {
  const test::TemporaryFolder folder;
  const fs::path deep = folder.path() / "a" / "b" / "c";
  EXPECT_TRUE(makeFolder(deep));
  EXPECT_TRUE(fs::is_directory(deep));
  EXPECT_TRUE(makeFolder(deep));
}

TEST(MakeFolder, RefusesWhereAFileIs) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writeTextFile(folder / "file", "text"));
  for (const fs::path& path : {folder / "file", folder.path() / "file" / "below"}) {
    const Status status = makeFolder(path);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE");
    EXPECT_EQ(status.error().where, path.string());
  }
  EXPECT_EQ(contentOf(folder / "file"), "text");
}

TEST(DiskRoom, IsThatOfTheNearestFolderThatIsThere) {
  const test::TemporaryFolder folder;
  const fs::path wanted = folder / "new" / "storage";
  EXPECT_TRUE(enoughRoom(folder.path(), 1000.0, "the case"));
  EXPECT_TRUE(enoughRoom(wanted, 1000.0, "the case"));
  const Status status = enoughRoom(wanted, 1e30, "the exercise");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE");
  EXPECT_EQ(status.error().where, wanted.string());
  EXPECT_EQ(status.error().what.find("The disk has no room for the exercise: it needs "), 0U);
  EXPECT_FALSE(fs::exists(folder / "new"));
}

TEST(TemporaryFolder, IsTheOneThatTheEnvironmentNames) {
  const test::TemporaryFolder folder;
  const test::Environment named("TMPDIR", folder.path().string());
  const Result<fs::path> temporary = temporaryFolder();
  ASSERT_TRUE(temporary);
  EXPECT_EQ(*temporary, folder.path());
  const test::Environment empty("TMPDIR", "");
  EXPECT_EQ(*temporaryFolder(), "/tmp");
}

TEST(TemporaryFolder, ThatIsMissingOrAFileIsAnErrorThatNamesIt) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writeTextFile(folder / "file", "text"));
  for (const fs::path& path : {folder / "none", folder / "file"}) {
    const test::Environment named("TMPDIR", path.string());
    const Result<fs::path> temporary = temporaryFolder();
    ASSERT_FALSE(temporary);
    EXPECT_EQ(temporary.error().code.str(), "NO_TEMPORARY_FOLDER");
    EXPECT_EQ(temporary.error().where, "TMPDIR=" + path.string());
    EXPECT_NE(temporary.error().next.find("TMPDIR"), std::string::npos);
  }
}

}  // namespace
}  // namespace trephine
