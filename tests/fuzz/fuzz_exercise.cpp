// Any bytes as an exercise, tool, tissue, device or operator file, as a recording, as the list of
// an exported exercise or as a case's files: read, and where they are accepted used for a few
// hundred ticks. See README.md.
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "base/system.h"
#include "cases.h"
#include "device/device.h"
#include "exchange/exercise_folder.h"
#include "exercise_files.h"
#include "imaging/report/provenance.h"
#include "json_mutator.h"
#include "library/case_record.h"
#include "processor_time.h"
#include "session/session.h"
#include "training/recording_list.h"
#include "training/replay.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace trephine::fuzz {

namespace {

namespace fs = std::filesystem;

constexpr double kMostSeconds = 2.0;
constexpr double kMostRecordingSeconds = 5.0;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz_exercise: %s\n", what);
  std::abort();
}

// A copy of the shipped files, in which the input stands as input.json beside those of its kind.
class Files {
 public:
  Files() {
    std::string pattern = (fs::temp_directory_path() / "trephine-fuzz-XXXXXX").string();
    require(::mkdtemp(pattern.data()), "no temporary folder can be made");
    root_ = pattern;
    for (const char* folder : kFolders) {
      fs::copy(resourceFolder() / folder, root_ / folder);
      require(::mkfifo((root_ / folder / "pipe.json").c_str(), 0600) == 0, "no pipe can be made");
      fs::create_symlink("/dev/zero", root_ / folder / "link.json");
    }
    const auto exported =
        exportExercise(root_ / "scenes" / "liver-one-arm.json", "", root_ / "stick");
    require(exported.ok(), "the shipped exercise cannot be exported");
    require(::mkfifo((root_ / "stick" / "pipe.json").c_str(), 0600) == 0, "no pipe can be made");
    fs::create_symlink("/dev/zero", root_ / "stick" / "link.json");
  }
  ~Files() {
    std::error_code error;
    fs::remove_all(root_, error);
  }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;

  fs::path put(Kind kind, std::string_view bytes) const {
    const fs::path file = kind == kRecording ? root_ / "input.h5"
                          : kind == kList    ? root_ / "stick" / "exercise.json"
                          : kind > kList     ? root_ / "input.json"
                                             : root_ / kFolders[kind] / "input.json";
    std::ofstream out(file, std::ios::binary);
    out.write(bytes.data(), std::streamsize(bytes.size()));
    require(out.good(), "the temporary folder is full");
    return file;
  }
  const fs::path& root() const { return root_; }
  fs::path exercise(const char* name) const { return root_ / "scenes" / name; }

 private:
  fs::path root_;
};

void expectSaid(const Error& error) {
  require(!error.what.empty() && !error.code.empty(), "an error says nothing");
}

// What was accepted must be fit to be felt.
void run(const Exercise& exercise, const OperatorScript& script, const Rig& rig = {}) {
  SessionOptions options{{}, script};
  options.rig = rig;
  Result<std::unique_ptr<Session>> session =
      Session::create(test::placed(exercise, smallHead()), options);
  if (!session) return expectSaid(session.error());
  const Status done = (*session)->freewheel(double(kTicks) / exercise.rate_hz);
  if (!done) return expectSaid(done.error());
  const RunReport report = (*session)->report();
  require(report.machine.nonfinite == 0, "what was accepted ends in a force that is not finite");
  for (const RunMetrics::Arm& arm : report.done.arms) {
    require(isFinite(arm.max_force_N) && isFinite(arm.energy_out_J),
            "what was accepted ends in a force or an energy that is not finite");
  }
  toJson(report).dump();
  toText(report);
}

void runExercise(const Result<Exercise>& exercise, const Rig& rig = {}) {
  if (!exercise) return expectSaid(exercise.error());
  const Result<OperatorScript> script = dive(*exercise);
  if (!script) return expectSaid(script.error());
  run(*exercise, *script, rig);
}

// The shipped exercise of the burr, with one of its files replaced by the input.
void runWith(const Files& files, Kind kind) {
  Json exercise = *readJsonFile(files.exercise("burr-hole.json"));
  if (kind == kTool) exercise["tools"][0]["file"] = "../tools/input.json";
  if (kind == kTissues) exercise["tissues"] = "../tissues/input.json";
  Rig rig;
  if (kind == kDevice) {
    const fs::path config = files.root() / "devices" / "input.json";
    rig.arms.push_back({{kSimulated, 0, config.string()}, {}});
  }
  runExercise(parseExercise(exercise, files.exercise("burr-hole.json")), rig);
}

void runScript(const Files& files, const fs::path& file) {
  Result<Exercise> exercise = readExercise(files.exercise("cranium.json"));
  require(exercise.ok(), "the shipped scene cannot be read");
  exercise->rate_hz = 100.0;  // two seconds of the script
  const Result<OperatorScript> script = readOperatorScript(file, *exercise);
  if (!script) return expectSaid(script.error());
  run(*exercise, *script);
}

void importFolder(const fs::path& list, const fs::path& storage) {
  const auto imported = importExercise(list.parent_path(), storage);
  if (!imported) return expectSaid(imported.error());
  std::error_code none;
  fs::remove_all(storage, none);
}

// What is read once is written and read again as it was.
template <class Read>
void readAgain(const fs::path& file, const Read& read) {
  const Result<Json> json = readJsonFile(file);
  if (!json) return expectSaid(json.error());
  const auto once = read(*json, "input");
  if (!once) return expectSaid(once.error());
  const Json written = toJson(*once);
  const auto twice = read(written, "again");
  require(twice.ok() && toJson(*twice) == written, "what was read is written otherwise");
}

void replayFile(const fs::path& file) {
  const auto recording = SessionReader::open(file);
  if (!recording) return expectSaid(recording.error());
  const Result<ReplayResult> result = replay(**recording, smallHead());
  if (!result) return expectSaid(result.error());
  require(result->identical || result->first_difference, "a replay says nothing");
}

}  // namespace

}  // namespace trephine::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trephine;
  using namespace trephine::fuzz;
  static const Files files;
  if (size < 2) return 0;
  const Kind kind = Kind(data[0] % kKinds);
  const double start = processorSeconds();
  const std::filesystem::path file =
      files.put(kind, {reinterpret_cast<const char*>(data) + 1, size - 1});
  switch (kind) {
    case kExercise:
      runExercise(readExercise(file));
      break;
    case kOperator:
      runScript(files, file);
      break;
    case kRecording:
      replayFile(file);
      listRecording(file);
      break;
    case kList:
      importFolder(file, files.root() / "storage");
      break;
    case kCase:
      readAgain(file, caseRecordFrom);
      break;
    case kProvenance:
      readAgain(file, provenanceFrom);
      break;
    default:
      runWith(files, kind);
      break;
  }
  const double most = kind == kRecording ? kMostRecordingSeconds : kMostSeconds;
  require(processorSeconds() - start <= most, "an input takes too much processor time");
  return 0;
}

// The plugin is instrumented too, and libFuzzer reads the counters of whatever was ever loaded: it
// stays.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  static const auto kept = trephine::DevicePlugin::load("simulated", trephine::pluginFolder());
  return kept ? 0 : 1;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  using namespace trephine::fuzz;
  if (size > 1 && data[0] % kKinds != kRecording && seed % 8 != 0) {
    const std::string text = mutatedJson({reinterpret_cast<const char*>(data) + 1, size - 1}, seed);
    if (!text.empty() && text.size() < most) {
      std::copy(text.begin(), text.end(), data + 1);
      return text.size() + 1;
    }
  }
  return LLVMFuzzerMutate(data, size, most);
}
