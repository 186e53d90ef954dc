#include "library/case_library.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/file.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "base/json.h"
#include "cases.h"
#include "file_size_limit.h"
#include "imaging/importer.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;
using test::bytesOf;
using test::entriesIn;
using test::smallCase;

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[20];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::localtime(&now));
  return text;
}

class CaseLibraryTest : public ::testing::Test {
 protected:
  CaseRecord saved(const NewCase& of = smallCase()) {
    auto result = library_.save(of);
    EXPECT_TRUE(result) << (result ? "" : result.error().sentence());
    return result ? result->record : CaseRecord{};
  }
  fs::path storage() const { return temporary_ / "storage"; }
  fs::path folderOf(const std::string& id) const { return storage() / "cases" / id; }

  test::TemporaryFolder temporary_;
  CaseLibrary library_{temporary_ / "storage"};
};

TEST_F(CaseLibraryTest, OfAFolderThatIsNotThereIsEmpty) {
  EXPECT_TRUE(library_.list().empty());
  EXPECT_FALSE(fs::exists(storage())) << "looking makes nothing";
  EXPECT_EQ(library_.load("head").error().code.str(), "NO_SUCH_CASE");
  EXPECT_EQ(library_.remove("head").error().code.str(), "NO_SUCH_CASE");
}

TEST_F(CaseLibraryTest, GivesBackWhatWasSaved) {
  NewCase of = smallCase();
  of.provenance.emplace().slices_used = 12;
  const CaseRecord record = saved(of);
  EXPECT_EQ(record.name, "Head " + today() + " 1");
  EXPECT_EQ(record.id, "head-" + today() + "-1");
  const auto loaded = CaseLibrary(storage()).load(record.id);
  ASSERT_TRUE(loaded) << loaded.error().sentence();
  EXPECT_EQ(loaded->volume->hu, of.volume->hu);
  EXPECT_LT(glm::length(loaded->volume->geometry.centre_mm() - of.volume->geometry.centre_mm()),
            1e-9);
  ASSERT_TRUE(loaded->structures);
  EXPECT_EQ(loaded->structures->labels, of.structures->labels);
  EXPECT_EQ(loaded->structures->find("liver")->tissue, "liver");
  EXPECT_EQ(loaded->tissues, of.tissues);
  ASSERT_TRUE(loaded->provenance);
  EXPECT_EQ(loaded->provenance->slices_used, 12);
  EXPECT_EQ(loaded->record.name, record.name);
  EXPECT_EQ(loaded->record.region, BodyRegion::head);
}

TEST_F(CaseLibraryTest, GivesBackACaseOfVoxelsAlone) {
  NewCase of;
  of.volume = test::patternVolume({5, 4, 3});
  const CaseRecord record = saved(of);
  EXPECT_EQ(record.name, "CT " + today() + " 1");
  const auto loaded = library_.load(record.id);
  ASSERT_TRUE(loaded) << loaded.error().sentence();
  EXPECT_EQ(loaded->volume->hu, of.volume->hu);
  EXPECT_FALSE(loaded->structures);
  EXPECT_FALSE(loaded->provenance);
  EXPECT_EQ(loaded->tissues, Json::object());
  EXPECT_EQ(entriesIn(folderOf(record.id)), 3u) << "case.json, volume and picture";
  EXPECT_EQ(entriesIn(storage() / "private"), 0u) << "of no source there is nothing to keep";
}

TEST_F(CaseLibraryTest, ListsWhatACardShows) {
  const NewCase of = smallCase();
  saved(of);
  const auto cases = CaseLibrary(storage()).list();
  ASSERT_EQ(cases.size(), 1u);
  const CaseRecord& record = cases[0].record;
  EXPECT_FALSE(cases[0].problem) << cases[0].problem->sentence();
  EXPECT_EQ(record.grid.size, (Index3{20, 16, 12}));
  EXPECT_EQ(record.volume_sha256, volumeSha256(*of.volume));
  ASSERT_EQ(record.structures.size(), 2u);
  EXPECT_EQ(record.structures[0].name, "liver");
  EXPECT_NEAR(record.structures[0].ml, 20 * 16 * 12 / 4 * 0.7 * 1.1 * 2.5 / 1000.0, 1e-9);
  EXPECT_EQ(record.structures[0].colour, Vec3(0.5, 0.25, 0.125));
  std::uint64_t bytes = 0;
  for (const auto& file : fs::directory_iterator(record.folder)) bytes += file.file_size();
  EXPECT_EQ(record.bytes, bytes);
  EXPECT_EQ(bytesOf(record.folder / "picture.png").substr(1, 3), "PNG");
  EXPECT_EQ(entriesIn(storage() / ".parts"), 0u);
}

TEST_F(CaseLibraryTest, NumbersTheCasesOfADayByTheFirstThatIsFree) {
  saved();
  saved();
  NewCase abdomen = smallCase();
  abdomen.region = BodyRegion::abdomen;
  EXPECT_EQ(saved(abdomen).name, "Abdomen " + today() + " 1");
  ASSERT_TRUE(library_.remove("head-" + today() + "-1"));
  EXPECT_EQ(saved().id, "head-" + today() + "-1");
  EXPECT_EQ(saved().id, "head-" + today() + "-3");
  // A name that another case has been given is not taken once more.
  ASSERT_TRUE(library_.rename("head-" + today() + "-1", "HEAD " + today() + " 4"));
  EXPECT_EQ(saved().name, "Head " + today() + " 5");
}

TEST_F(CaseLibraryTest, ListsTheNewestFirst) {
  const std::string old = saved().id, young = saved().id;
  Json json = *readJsonFile(folderOf(old) / "case.json");
  json["imported"] = "2001-01-01T00:00:00";
  std::ofstream(folderOf(old) / "case.json") << json;
  EXPECT_EQ(library_.list()[0].id, young);
  EXPECT_EQ(library_.list()[1].id, old);
}

TEST_F(CaseLibraryTest, ListsADamagedFolderWithItsProblemBesideTheOthers) {
  const std::string good = saved().id;
  std::map<std::string, std::string> expected;  // id -> code
  const auto spoil = [&](const std::string& code, const std::function<void(const fs::path&)>& how) {
    const CaseRecord record = saved();
    how(record.folder);
    expected[record.id] = code;
  };
  const auto edit = [](const fs::path& folder, const char* key, const Json& value) {
    Json json = *readJsonFile(folder / "case.json");
    json[key] = value;
    std::ofstream(folder / "case.json") << json;
  };
  spoil("CASE_PART_MISSING", [](const fs::path& f) { fs::remove(f / "case.json"); });
  spoil("CASE_PART_MISSING", [](const fs::path& f) { fs::remove(f / "volume.mha"); });
  spoil("CASE_CHANGED", [](const fs::path& f) { fs::resize_file(f / "volume.mha", 400); });
  spoil("BAD_JSON", [](const fs::path& f) { std::ofstream(f / "case.json") << "{\"format\":"; });
  spoil("BAD_FIELD", [&](const fs::path& f) { edit(f, "version", 2); });
  spoil("BAD_FIELD", [&](const fs::path& f) { edit(f, "colour", "red"); });
  spoil("BAD_FIELD", [&](const fs::path& f) { edit(f, "direction", Json::array({1, 2})); });
  spoil("BAD_FIELD", [&](const fs::path& f) { edit(f, "volume_sha256", "../../x"); });
  spoil("CASE_PART_MISSING", [](const fs::path& f) {
    fs::remove(f / "case.json");
    fs::create_directory(f / "case.json");
  });
  // Pipes, for which nobody would be waited.
  for (const char* file : {"case.json", "volume.mha"}) {
    spoil("CASE_PART_MISSING", [file](const fs::path& f) {
      fs::remove(f / file);
      ASSERT_EQ(::mkfifo((f / file).c_str(), 0600), 0);
    });
  }
  fs::create_directory(folderOf("empty"));
  expected["empty"] = "CASE_PART_MISSING";
  std::ofstream(storage() / "cases" / "a file") << "not a case";

  const auto cases = library_.list();
  EXPECT_EQ(cases.size(), expected.size() + 1);
  for (const ListedCase& one : cases) {
    if (one.id == good) {
      EXPECT_FALSE(one.problem);
      continue;
    }
    ASSERT_TRUE(one.problem) << one.id;
    EXPECT_EQ(one.problem->code.str(), expected[one.id]) << one.problem->sentence();
    EXPECT_TRUE(one.problem->where.starts_with(one.id)) << one.problem->where;
    const auto loaded = library_.load(one.id);
    ASSERT_FALSE(loaded);
    EXPECT_FALSE(loaded.error().next.empty());
    EXPECT_TRUE(library_.remove(one.id)) << "all can be deleted";
  }
  EXPECT_EQ(library_.list().size(), 1u);
  EXPECT_TRUE(library_.load(good));
}

TEST_F(CaseLibraryTest, NamesTheVersionOfANewerCase) {
  const CaseRecord record = saved();
  Json json = *readJsonFile(record.folder / "case.json");
  json["version"] = 7;
  std::ofstream(record.folder / "case.json") << json;
  const auto cases = library_.list();
  ASSERT_TRUE(cases[0].problem);
  EXPECT_NE(cases[0].problem->what.find("version 7"), std::string::npos);
  EXPECT_NE(cases[0].problem->next.find("newer Trephine"), std::string::npos);
}

TEST_F(CaseLibraryTest, SaysWhichPartOfACaseIsNotAsItWasSaved) {
  const CaseRecord record = saved();
  const std::string volume = bytesOf(record.folder / "volume.mha");
  const auto whereOf = [&] {
    const auto loaded = library_.load(record.id);
    return loaded ? "none" : loaded.error().code.str() + " " + loaded.error().where;
  };
  std::string other = volume;
  other.back() = char(other.back() ^ 1);
  std::ofstream(record.folder / "volume.mha", std::ios::binary) << other;
  EXPECT_EQ(whereOf(), "CASE_CHANGED " + record.id + "/volume.mha") << "one voxel";
  other = volume;
  other.replace(other.find("ElementSpacing = 0.7"), 20, "ElementSpacing = 0.8");
  std::ofstream(record.folder / "volume.mha", std::ios::binary) << other;
  EXPECT_EQ(whereOf(), "CASE_CHANGED " + record.id + "/volume.mha") << "its place";
  std::ofstream(record.folder / "volume.mha", std::ios::binary) << volume;
  EXPECT_EQ(whereOf(), "none");
  const std::vector<CaseStructure> structures = record.structures;
  std::ofstream(record.folder / "structures.seg.nrrd", std::ios::binary) << "NRRD0004\n";
  std::ofstream(record.folder / "tissues.json") << "[";
  const auto loaded = library_.load(record.id);
  ASSERT_TRUE(loaded) << "the case is worth more than its tissues and structures";
  EXPECT_FALSE(loaded->structures);
  ASSERT_TRUE(loaded->structures_problem);
  EXPECT_EQ(loaded->structures_problem->code.str() + " " + loaded->structures_problem->where,
            "UNREADABLE " + record.id + "/structures.seg.nrrd");
  EXPECT_EQ(library_.list()[0].record.structures.size(), structures.size())
      << "what it had is not forgotten for that";
  EXPECT_TRUE(loaded->tissues.empty());
  ASSERT_TRUE(loaded->tissues_problem);
  EXPECT_EQ(loaded->tissues_problem->code.str() + " " + loaded->tissues_problem->where,
            "BAD_JSON " + record.id + "/tissues.json");
}

TEST_F(CaseLibraryTest, WaitsForNobodyWhoKeepsTheLockOfTheList) {
  const CaseRecord record = saved();
  const int held = ::open((storage() / ".lock").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(held, LOCK_EX), 0);
  const auto begin = std::chrono::steady_clock::now();
  CaseLibrary library(storage());
  EXPECT_EQ(library.list().size(), 1u);
  EXPECT_TRUE(library.load(record.id));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
  const Status removed = library.remove(record.id);
  ASSERT_FALSE(removed);
  EXPECT_EQ(removed.error().code.str(), "BUSY");
  ::close(held);
  EXPECT_TRUE(library.remove(record.id));
}

TEST_F(CaseLibraryTest, KnowsAFolderThatWasRenamedUnderneathByItsNewName) {
  const CaseRecord record = saved();
  fs::rename(record.folder, folderOf("Mein Fall 3"));
  EXPECT_EQ(library_.load(record.id).error().code.str(), "NO_SUCH_CASE");
  const auto cases = library_.list();
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_EQ(cases[0].id, "Mein Fall 3");
  EXPECT_EQ(cases[0].record.name, record.name);
  EXPECT_TRUE(library_.load("Mein Fall 3"));
}

TEST_F(CaseLibraryTest, FollowsNoNameOutOfItsFolder) {
  saved();
  for (const char* id : {"", ".", "..", "../cases", ".parts", "a/b", "/"}) {
    EXPECT_EQ(library_.load(id).error().code.str(), "NO_SUCH_CASE") << id;
    EXPECT_EQ(library_.remove(id).error().code.str(), "NO_SUCH_CASE") << id;
  }
  EXPECT_EQ(library_.list().size(), 1u);
}

TEST_F(CaseLibraryTest, RemovesACaseWhole) {
  NewCase of = smallCase();
  of.source.add(IdentityKind::patient_name, "DOE^JANE");
  const CaseRecord record = saved(of), other = saved(of);
  EXPECT_EQ(entriesIn(storage() / "private"), 2u);
  ASSERT_TRUE(library_.remove(record.id));
  EXPECT_FALSE(fs::exists(record.folder));
  EXPECT_EQ(entriesIn(storage() / ".parts"), 0u);
  EXPECT_EQ(entriesIn(storage() / "private"), 1u);
  EXPECT_EQ(library_.remove(record.id).error().code.str(), "NO_SUCH_CASE");
  // Of a case whose case.json says nothing any more, too.
  std::ofstream(other.folder / "case.json") << "x";
  ASSERT_TRUE(library_.remove(other.id));
  EXPECT_EQ(entriesIn(storage() / "private"), 0u);
}

TEST_F(CaseLibraryTest, RemovesACaseWhereTheFoldersBesideItAreMissing) {
  CaseLibrary library(storage());
  const auto saved = library.save(test::smallCase());
  ASSERT_TRUE(saved) << saved.error().sentence();
  for (const char* folder : {".parts", "private"}) fs::remove_all(storage() / folder);
  const Status removed = library.remove(saved->record.id);
  EXPECT_TRUE(removed.ok()) << removed.error().sentence();
  EXPECT_FALSE(fs::exists(saved->record.folder));
  EXPECT_EQ(library.remove(saved->record.id).error().code.str(), "NO_SUCH_CASE");
}

TEST_F(CaseLibraryTest, PutsAStorageFolderInOrderWhenItIsOpened) {
  ASSERT_TRUE(CaseLibrary(storage()).save(test::smallCase()));
  for (const char* folder : {".parts", "private"}) fs::remove_all(storage() / folder);
  const CaseLibrary again(storage());
  for (const char* folder : {".parts", "private"})
    EXPECT_TRUE(fs::is_directory(storage() / folder));
}

TEST_F(CaseLibraryTest, SavesOtherStructuresOfACase) {
  const NewCase of = smallCase();
  const CaseRecord record = saved(of);
  LabelMap map = *of.structures;
  map.structures = {{1, "kidney", Vec3(1, 0, 0)}};
  for (auto& label : map.labels) label = label == 1;
  const auto changed = library_.saveStructures(record.id, map);
  ASSERT_TRUE(changed) << changed.error().sentence();
  ASSERT_EQ(changed->structures.size(), 1u);
  EXPECT_EQ(library_.list()[0].record.structures[0].name, "kidney");
  EXPECT_EQ(library_.load(record.id)->structures->labels, map.labels);
  EXPECT_EQ(entriesIn(storage() / ".parts"), 0u);

  ASSERT_TRUE(library_.saveStructures(record.id, LabelMap{map.geometry, map.labels, {}}));
  EXPECT_FALSE(library_.load(record.id)->structures);
  EXPECT_TRUE(library_.list()[0].record.structures.empty());
  EXPECT_FALSE(fs::exists(record.folder / "structures.seg.nrrd"));

  map.geometry.origin_mm.x += 1.0;
  EXPECT_EQ(library_.saveStructures(record.id, map).error().code.str(), "WRONG_GRID");
  EXPECT_EQ(library_.saveStructures("gone", *of.structures).error().code.str(), "NO_SUCH_CASE");
}

TEST_F(CaseLibraryTest, MendsRowsThatAreNotThoseOfTheStructures) {
  const NewCase of = smallCase();
  const CaseRecord record = saved(of);
  Json json = *readJsonFile(record.folder / "case.json");
  json["structures"] = Json::array();  // as where a program ended before it wrote them
  std::ofstream(record.folder / "case.json") << json;
  EXPECT_TRUE(library_.list()[0].record.structures.empty());
  EXPECT_EQ(library_.load(record.id)->record.structures.size(), 2u);
  EXPECT_EQ(library_.list()[0].record.structures.size(), 2u);
}

TEST_F(CaseLibraryTest, SavesOtherTissuesOfACase) {
  const CaseRecord record = saved();
  ASSERT_TRUE(library_.saveTissues(record.id, {{"damping", 3}}));
  EXPECT_EQ(library_.load(record.id)->tissues, Json({{"damping", 3}}));
  ASSERT_TRUE(library_.saveTissues(record.id, Json::object()));
  EXPECT_EQ(library_.load(record.id)->tissues, Json::object());
  EXPECT_FALSE(fs::exists(record.folder / "tissues.json"));
  EXPECT_EQ(library_.saveTissues("gone", {}).error().code.str(), "NO_SUCH_CASE");
}

TEST_F(CaseLibraryTest, CancelledLeavesNothing) {
  for (const char* step : {"Saving the volume", "Saving the structures", "Drawing"}) {
    Progress* asked = nullptr;
    Progress progress([&](double, const std::string& now) {
      if (now.starts_with(step)) asked->cancel();
    });
    asked = &progress;
    const auto result = library_.save(smallCase(), progress);
    ASSERT_FALSE(result) << step;
    EXPECT_EQ(result.error().code.str(), "CANCELLED") << step;
    EXPECT_TRUE(library_.list().empty());
    EXPECT_EQ(entriesIn(storage() / ".parts"), 0u) << step;
    EXPECT_EQ(entriesIn(storage() / "private"), 0u) << step;
  }
}

TEST_F(CaseLibraryTest, DoesNotSweepWhatIsStillBeingWritten) {
  bool swept = false;
  const Progress progress([&](double, const std::string& step) {
    if (step != "Saving the structures") return;
    const CaseLibrary other(storage());  // as another program that starts meanwhile
    EXPECT_EQ(entriesIn(storage() / ".parts"), 1u);
    EXPECT_TRUE(other.list().empty()) << "nothing is there before it is whole";
    swept = true;
  });
  const auto result = library_.save(smallCase(), progress);
  EXPECT_TRUE(swept);
  ASSERT_TRUE(result) << result.error().sentence();
  EXPECT_TRUE(library_.load(result->record.id));
}

TEST_F(CaseLibraryTest, SweepsWhatNobodyWritesAnyMore) {
  saved();
  fs::create_directories(storage() / ".parts" / "case-0123");
  std::ofstream(storage() / ".parts" / "case-0123" / ".lock") << "";
  std::ofstream(storage() / ".parts" / "case-0123" / "volume.mha") << "half";
  const CaseLibrary next(storage());
  EXPECT_EQ(entriesIn(storage() / ".parts"), 0u);
  EXPECT_EQ(next.list().size(), 1u);
}

TEST_F(CaseLibraryTest, GivesTwoThatSaveAtOnceTwoNames) {
  std::vector<std::string> names(2);
  const auto save = [&](std::size_t n) {
    if (auto result = CaseLibrary(storage()).save(smallCase())) names[n] = result->record.name;
  };
  std::thread other(save, 0);
  save(1);
  other.join();
  EXPECT_NE(names[0], names[1]);
  EXPECT_EQ(library_.list().size(), 2u);
}

TEST_F(CaseLibraryTest, LeavesNothingWhereAFileCannotBeWrittenToItsEnd) {
  const CaseRecord before = saved();
  for (const rlim_t bytes : {100, 3000, 7000}) {  // within case.json's, and the volume's, length
    const test::FileSizeLimit limit(bytes);
    const auto result = library_.save(smallCase());
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code.str(), "CANNOT_WRITE");
    EXPECT_EQ(result.error().where, storage().string());
    LabelMap map = *smallCase().structures;
    EXPECT_FALSE(bytes < 1000 && library_.saveStructures(before.id, map));
    EXPECT_FALSE(bytes < 1000 && library_.rename(before.id, "Another name"));
  }
  EXPECT_EQ(library_.list().size(), 1u);
  EXPECT_EQ(entriesIn(storage() / ".parts"), 0u);
  EXPECT_TRUE(library_.load(before.id));
  EXPECT_EQ(library_.list()[0].record.name, before.name);
}

TEST_F(CaseLibraryTest, SaysHowMuchRoomACaseNeeds) {
  NewCase of;
  Volume volume;
  volume.geometry.size = {2048, 2048, 2048};
  of.volume = std::make_shared<const Volume>(std::move(volume));
  const case_folders::Folders folders(temporary_.path());
  const Status room = folders.roomFor(std::uint64_t(1) << 60);
  ASSERT_FALSE(room);
  EXPECT_EQ(room.error().code.str(), "CANNOT_WRITE");
  EXPECT_NE(room.error().what.find("it needs 1152921504607 MB"), std::string::npos)
      << room.error().what;
  EXPECT_TRUE(folders.roomFor(1));
}

// In a process of its own with a disk of 8 MB that fills up while the case is written. 0: all is as
// it should be; 77: no disk could be made.
int saveOnAFullDisk(const fs::path& disk) {
  if (::unshare(CLONE_NEWNS) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) ||
      ::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=8m") != 0) {
    return 77;
  }
  CaseLibrary library(disk);
  if (!library.save(smallCase())) return 1;
  const Progress progress([&](double, const std::string& step) {
    if (step != "Saving the volume" || fs::exists(disk / "hog")) return;
    std::ofstream(disk / "hog") << std::string(16 << 20, 'x');
  });
  const auto result = library.save(smallCase({64, 64, 128}), progress);
  if (result || result.error().code.str() != "CANNOT_WRITE") return 2;
  if (result.error().what.find("no room") == std::string::npos) return 3;
  if (entriesIn(disk / ".parts") != 0 || library.list().size() != 1) return 4;
  // Full from the start, it does not even begin.
  if (library.save(smallCase()) || entriesIn(disk / ".parts") != 0) return 5;
  if (!library.load(library.list()[0].id)) return 6;
  // Deleting needs no room.
  if (!library.remove(library.list()[0].id)) return 7;
  return 0;
}

TEST_F(CaseLibraryTest, LeavesNothingOnADiskThatFillsUpMeanwhile) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(saveOnAFullDisk(temporary_.path()));
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) {
    std::printf(
        "[ figures  ] no disk could be mounted here: RLIMIT_FSIZE stands in for a full one\n");
    const test::FileSizeLimit limit(3000);
    EXPECT_FALSE(library_.save(smallCase()));
    EXPECT_EQ(entriesIn(storage() / ".parts"), 0u);
    return;
  }
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace trephine
