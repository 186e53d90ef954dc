#include "exercise/policy.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "base/system.h"
#include "support.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;

Json settings() {
  return {{"format", "trephine.settings"}, {"version", 1}};
}
Policy locking(const Json& locks) {
  Json json = settings();
  json["locks"] = locks;
  return *parsePolicy(json, "/etc/trephine/settings.json");
}
fs::path shippedFile(const char* name = "cranium.json") {
  return resourceFolder() / "scenes" / name;
}
const Locks kAll{Lock::controller, Lock::tissues, Lock::rate};

// A folder as /etc/trephine is: nobody but who runs this test could write it. For another user than
// root that is himself, whom it shall be kept from: what is read then is what follows from that.
class PolicyFile : public testing::Test {
 protected:
  void write(const std::string& text, mode_t mode = 0644) {
    std::ofstream(file_) << text;
    ::chmod(file_.c_str(), mode);
  }
  void expectAllLocked(const std::string& code, const std::string& word) {
    const Policy policy = readPolicy(file_);
    EXPECT_EQ(policy.locks, kAll);
    EXPECT_FALSE(policy.pin) << "nothing takes these locks off";
    ASSERT_TRUE(policy.problem);
    EXPECT_EQ(policy.problem->code.str(), root_ ? code : "POLICY_UNSAFE")
        << policy.problem->sentence();
    if (!root_) return;
    EXPECT_NE(policy.problem->sentence().find(word), std::string::npos);
  }

  const bool root_ = ::geteuid() == 0;
  test::TemporaryFolder folder_;
  const fs::path file_ = folder_ / "settings.json";
};

TEST(Policy, WithoutAFileNothingIsLocked) {
  const test::TemporaryFolder folder;
  const Policy policy = readPolicy(folder / "none" / "settings.json");
  EXPECT_TRUE(policy.locks.empty());
  EXPECT_FALSE(policy.problem);
  EXPECT_TRUE(checkExercise(policy, *readExercise(shippedFile()), "/anywhere/scene.json"));
}

TEST_F(PolicyFile, IsReadWhereNobodyElseCouldHaveWrittenIt) {
  Json json = settings();
  json["storage"] = "/srv/trephine";
  json["locks"] = {{"controller", "bounded"}, {"tissues", true}, {"rate", 1000}};
  json["pin"] = toJson(*makePin("4711"));
  write(json.dump());
  const Policy policy = readPolicy(file_);
  EXPECT_EQ(policy.locks, kAll);
  if (!root_) return;
  EXPECT_FALSE(policy.problem) << policy.problem->sentence();
  EXPECT_EQ(policy.controller, ControllerKind::bounded);
  EXPECT_EQ(policy.rate_hz, 1000.0);
  EXPECT_EQ(policy.storage, "/srv/trephine");
  EXPECT_TRUE(pinMatches(*policy.pin, "4711"));
}

TEST_F(PolicyFile, ItsFolderHasExercisesOfTheWorkstationToo) {
  fs::create_directory(folder_ / "ours");
  fs::copy_file(shippedFile(), folder_ / "ours" / "b.json");
  fs::copy_file(shippedFile(), folder_ / "ours" / "a.json");
  fs::copy_file(shippedFile(), folder_ / "ours" / "anybodys.json");
  for (const char* name : {"a.json", "b.json"}) {
    ::chmod((folder_ / "ours" / name).c_str(), 0644);
  }
  ::chmod((folder_ / "ours" / "anybodys.json").c_str(), 0666);
  Policy policy;
  policy.folder = file_.parent_path();
  const std::vector<fs::path> all = exercisesOfWorkstation(policy);
  const Policy nobody_s;
  std::vector<fs::path> expected = exercisesOfWorkstation(nobody_s);
  EXPECT_GE(expected.size(), 5u);
  EXPECT_TRUE(std::is_sorted(expected.begin(), expected.end()));
  const std::vector<fs::path> for_research = exercisesOfWorkstation(nobody_s, true);
  EXPECT_EQ(for_research.size(), expected.size() + 2) << "those after a paper are not a trainee's";
  if (root_) {
    expected.push_back(folder_ / "ours" / "a.json");
    expected.push_back(folder_ / "ours" / "b.json");
  }
  EXPECT_EQ(all, expected);
}

TEST_F(PolicyFile, ThatCannotBeReadLocksEverything) {
  write("{ no json");
  expectAllLocked("BAD_JSON", "settings.json");
  write(R"({"format": "trephine.settings", "version": 2})");
  expectAllLocked("BAD_FIELD", "version");
  Json json = settings();
  json["lock"] = Json::object();  // a slip of the pen, which would leave all open
  write(json.dump());
  expectAllLocked("BAD_FIELD", "lock");
  write("");
  expectAllLocked("BAD_JSON", "settings.json");
  fs::remove(file_);
  fs::create_directory(file_);
  expectAllLocked("POLICY_UNREADABLE", "folder");
  fs::remove(file_);
  ASSERT_EQ(::mkfifo(file_.c_str(), 0644), 0);
  expectAllLocked("POLICY_UNREADABLE", "pipe");
}

TEST_F(PolicyFile, ThatOthersCouldHaveWrittenLocksEverything) {
  const std::string open = settings().dump();
  for (const mode_t mode : {0666, 0664, 0646}) {
    write(open, mode);
    expectAllLocked("POLICY_UNSAFE", "go-w");
  }
  write(open);
  ::chmod(folder_.path().c_str(), 0777);  // who could put another file there
  expectAllLocked("POLICY_UNSAFE", folder_.path().string());
  fs::remove(file_);  // or take it away
  expectAllLocked("POLICY_UNSAFE", folder_.path().string());
  ::chmod(folder_.path().c_str(), 0755);
  write(open);
  const fs::path link = folder_ / "link.json";
  fs::create_symlink(file_, link);
  const Policy policy = readPolicy(link);
  EXPECT_EQ(policy.locks, kAll) << "where it leads nobody has looked";
}

TEST(Policy, OnlyTheOwnerAndThoseWithTheRightToWriteCouldChangeAFile) {
  constexpr unsigned kRoot = 0, kTrainee = 1000, kItsAdministrator = 500;
  EXPECT_FALSE(couldChange(kTrainee, kRoot, 0644));
  EXPECT_FALSE(couldChange(kTrainee, kItsAdministrator, 0644));
  EXPECT_TRUE(couldChange(kTrainee, kTrainee, 0644));
  EXPECT_TRUE(couldChange(kTrainee, kTrainee, 0444)) << "he could give himself the right";
  EXPECT_TRUE(couldChange(kTrainee, kRoot, 0664));
  EXPECT_TRUE(couldChange(kTrainee, kRoot, 0646));
  EXPECT_FALSE(couldChange(kRoot, kRoot, 0644));
}

TEST(Policy, ALockIsAFlagOrAValue) {
  EXPECT_EQ(locking({{"controller", true}}).locks, Locks{Lock::controller});
  EXPECT_EQ(locking({{"controller", false}, {"rate", false}}).locks, Locks{});
  EXPECT_EQ(locking({{"rate", 500}}).rate_hz, 500.0);
  for (const auto& [key, value] :
       std::initializer_list<std::pair<const char*, Json>>{{"controller", "strong"},
                                                           {"controller", 5},
                                                           {"tissues", "bone"},
                                                           {"rate", "fast"},
                                                           {"rate", 1},
                                                           {"colour", true}}) {
    Json json = settings();
    json["locks"] = {{key, value}};
    const Result<Policy> policy = parsePolicy(json, "settings.json");
    ASSERT_FALSE(policy) << key << " " << value;
    EXPECT_NE(policy.error().where.find(std::string("locks.") + key), std::string::npos)
        << policy.error().sentence();
  }
  Json json = settings();
  json["storage"] = "cases";
  EXPECT_NE(parsePolicy(json, "settings.json").error().where.find("storage"), std::string::npos);
}

TEST(Policy, TheExercisesLocksComeBesideTheWorkstations) {
  Exercise exercise = *readExercise(shippedFile());
  exercise.locks = {Lock::rate};
  EXPECT_EQ(locksOf(locking({{"tissues", true}}), exercise), (Locks{Lock::tissues, Lock::rate}));
  EXPECT_EQ(locksOf(Policy(), exercise), Locks{Lock::rate});
}

void expectLocked(const Status& status, const char* word) {
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code.str(), "LOCKED");
  EXPECT_NE(status.error().what.find(word), std::string::npos) << status.error().sentence();
}

TEST(Policy, AExerciseOfTheUsersOwnBringsNothingThatIsLocked) {
  const Exercise exercise = *readExercise(shippedFile());
  const test::TemporaryFolder home;
  const fs::path own = home / "cranium.json";
  fs::copy_file(shippedFile(), own);
  expectLocked(checkExercise(locking({{"tissues", true}}), exercise, own), "tissues");
  expectLocked(checkExercise(locking({{"controller", true}}), exercise, own), "controller");
  expectLocked(checkExercise(locking({{"rate", true}}), exercise, own), "rate");
  for (const char* key : {"tissues", "controller", "rate"}) {
    EXPECT_TRUE(checkExercise(locking({{key, true}}), exercise, shippedFile())) << key;
    expectLocked(checkExercise(locking({{key, true}}), exercise, ""), "own");
  }
  // Not by a name that looks like the product's, nor by a link.
  const fs::path exercises = resourceFolder() / "scenes",
                 around = exercises / fs::relative(own, exercises);
  ASSERT_TRUE(fs::exists(around));
  expectLocked(checkExercise(locking({{"tissues", true}}), exercise, around), "tissues");
  const fs::path link = home / "link.json";
  fs::create_symlink(shippedFile(), link);
  EXPECT_TRUE(checkExercise(locking({{"tissues", true}}), exercise, link))
      << "what it leads to counts";
}

TEST(Policy, AValueThatIsPrescribedIsAskedOfEveryExercise) {
  Exercise exercise = *readExercise(shippedFile());
  const Policy policy = locking({{"controller", "bounded"}, {"rate", 1000}});
  EXPECT_TRUE(checkExercise(policy, exercise, "/somewhere/own/scene.json"));
  exercise.rate_hz = 2000.0;
  expectLocked(checkExercise(policy, exercise, "/somewhere/own/scene.json"), "2000 Hz");
  expectLocked(checkExercise(policy, *readExercise(shippedFile("research/seed-cranium.json")),
                             shippedFile("research/seed-cranium.json")),
               "'seed'");
}

TEST(Policy, AExercisesFolderOfTheWorkstationIsItsOwnWhileUsersCannotWriteIt) {
  const test::TemporaryFolder etc;
  const fs::path exercises = etc / "scenes";
  fs::create_directory(exercises);
  const fs::path file = exercises / "cranium.json";
  fs::copy_file(shippedFile(), file);
  ::chmod(file.c_str(), 0644);
  ::chmod(exercises.c_str(), 0755);
  const Exercise exercise = *readExercise(shippedFile());
  Policy policy = locking({{"tissues", true}});
  policy.folder = etc.path();
  EXPECT_EQ(checkExercise(policy, exercise, file).ok(), ::geteuid() == 0);
  ::chmod(exercises.c_str(), 0777);
  expectLocked(checkExercise(policy, exercise, file), "tissues");
}

TEST_F(PolicyFile, TheProblemIsSaidWithEveryExerciseThatItKeepsOut) {
  write("{", 0666);
  const Policy policy = readPolicy(file_);
  const Status status =
      checkExercise(policy, *readExercise(shippedFile()), "/somewhere/own/scene.json");
  expectLocked(status, "tissues, a controller, a rate");
  EXPECT_NE(status.error().next.find("Everything is locked: "), std::string::npos);
  EXPECT_TRUE(checkExercise(policy, *readExercise(shippedFile()), shippedFile()));
}

// Exercises and plugins of one's own would be a way round every lock.
TEST_F(PolicyFile, WhereAnythingIsLockedTheEnvironmentDoesNotSayWhereExercisesAndPluginsAre) {
  const fs::path exercises = resourceFolder(), plugins = pluginFolder();
  const test::Environment own_exercises("TREPHINE_RESOURCES", "/somewhere/own/resources");
  const test::Environment own_plugins("TREPHINE_PLUGINS", "/somewhere/own/plugins");
  policyAtStart(folder_ / "none" / "settings.json");
  EXPECT_EQ(resourceFolder(), "/somewhere/own/resources");
  EXPECT_EQ(pluginFolder(), "/somewhere/own/plugins");
  Json json = settings();
  json["locks"] = {{"rate", true}};
  write(json.dump());
  EXPECT_FALSE(policyAtStart(file_).locks.empty());
  EXPECT_EQ(resourceFolder(), exercises);
  EXPECT_EQ(pluginFolder(), plugins);
}

}  // namespace
}  // namespace trephine
