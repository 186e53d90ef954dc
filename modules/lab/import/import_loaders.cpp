#include "lab/import/import_loaders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>
#include <utility>

#include "base/file.h"
#include "base/json.h"
#include "lab/import/child_process.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

// Other people's programs. FOLDER is the series, OUT a folder for what they write.
struct Peer {
  const char* program;
  std::vector<std::string> arguments;
};

const std::vector<Peer>& peers() {
  static const std::vector<Peer> all{
      {"dcm2niix", {"-z", "n", "-o", "OUT", "-f", "x", "FOLDER"}},
      {"dicomtonifti", {"-s", "-r", "-o", "OUT/x.nii", "FOLDER"}},
  };
  return all;
}

// What an importer needs to know of a file to group and sort it.
const Peer& scanningPeer() {
  static const Peer peer{
      "gdcmscanner",
      {"-d", "FOLDER", "-t", "0020,000d", "-t", "0020,000e", "-t", "0008,0018", "-t", "0020,0032",
       "-t", "0020,0037", "-t", "0028,0010", "-t", "0028,0011"}};
  return peer;
}

std::string replaced(std::string text, const std::string& word, const std::string& by) {
  if (const auto at = text.find(word); at != text.npos) text.replace(at, word.size(), by);
  return text;
}

// An empty folder that goes away.
class RunFolder {
 public:
  explicit RunFolder(const fs::path& scratch) : path_(scratch / "run") { clear(); }
  ~RunFolder() {
    std::error_code none;
    fs::remove_all(path_, none);
  }
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  const fs::path& path() const { return path_; }
  const Status& made() const { return made_; }

 private:
  void clear() {
    std::error_code none;
    fs::remove_all(path_, none);
    made_ = makeFolder(path_);
  }
  fs::path path_;
  Status made_;
};

std::string tookTooLong(double limit_s) {
  return "took over " + std::to_string(std::lround(limit_s)) + " s";
}

LoaderRun failed(std::string why) {
  LoaderRun run;
  run.problem = std::move(why);
  return run;
}

// The answer of a command of ours, or what it or the system says is wrong.
struct OwnRun {
  ChildRun child;
  Json answer;
  std::string problem;
};

Result<OwnRun> runOurs(const LoaderPlaces& places, std::vector<std::string> arguments,
                       const Progress& progress) {
  const RunFolder folder(places.scratch);
  if (!folder.made()) return folder.made().error();
  ChildCommand command;
  command.words = {places.program.string()};
  command.words.insert(command.words.end(), arguments.begin(), arguments.end());
  command.output = folder.path() / "answer.json";
  command.home = folder.path();
  command.offline = false;
  command.limit_s = places.limit_s;
  Result<ChildRun> child = runChild(command, progress);
  if (!child) return child.error();
  OwnRun run{*child, {}, {}};
  if (child->timed_out) {
    run.problem = tookTooLong(places.limit_s);
    return run;
  }
  Result<Json> answer = readJsonFile(command.output);
  if (!answer) {
    run.problem = "gave no answer (exit code " + std::to_string(child->exit_code) + ")";
    return run;
  }
  run.answer = *std::move(answer);
  if (run.answer.contains("error")) run.problem = run.answer["error"].value("what", "failed");
  return run;
}

// The report of `trephine-lab import` of a folder.
Result<OwnRun> runImport(const LoaderPlaces& places, const fs::path& folder,
                         const Progress& progress) {
  return runOurs(places, {"import", folder.string(), "--json"}, progress);
}

// A number of the report, 0 where it has none.
double number(const Json& report, const std::string& pointer) {
  const Json::json_pointer at(pointer);
  return report.contains(at) && report[at].is_number() ? report[at].get<double>() : 0.0;
}

bool reportsVolume(const Json& report, const std::string& sha256) {
  if (!report.contains("series") || !report.contains("chosen")) return false;
  return std::any_of(report["series"].begin(), report["series"].end(), [&](const Json& series) {
    return series.is_object() && series.contains("uid") && series["uid"] == report["chosen"] &&
           series.contains("volume_sha256") && series["volume_sha256"] == sha256;
  });
}

Loader importLoader(const LoaderPlaces& places) {
  Loader loader;
  loader.names = {"trephine", "trephine command"};
  loader.threads = int(std::max(1U, std::thread::hardware_concurrency()));
  loader.run = [places](const fs::path& folder, const KnownVolume* known,
                        const Progress& progress) -> Result<LoaderRun> {
    Result<OwnRun> ours = runImport(places, folder, progress);
    if (!ours) return ours.error();
    LoaderRun run;
    run.problem = ours->problem;
    if (!run.problem.empty()) {
      run.correct = false;
      return run;
    }
    const Json& report = ours->answer;
    if (known) run.correct = reportsVolume(report, known->sha256);
    ImportSample sample;
    sample.peak_rss_mb = ours->child.peak_rss_mb;
    sample.above_start_mb = number(report, "/peak_rss_mb") - number(report, "/start_rss_mb");
    sample.seconds = number(report, "/seconds/scan") + number(report, "/seconds/read");
    run.samples.push_back(sample);
    sample.seconds = ours->child.seconds - number(report, "/seconds/hash");
    run.samples.push_back(sample);
    return run;
  };
  return loader;
}

Loader floorLoader(const LoaderPlaces& places) {
  Loader loader;
  loader.names = {"floor", "floor kept"};
  loader.run = [places](const fs::path& folder, const KnownVolume*,
                        const Progress& progress) -> Result<LoaderRun> {
    Result<OwnRun> ours = runOurs(places, {"measure", "read", folder.string(), "--json"}, progress);
    if (!ours) return ours.error();
    if (!ours->problem.empty()) return failed(ours->problem);
    LoaderRun run;
    for (const char* figure : {"/seconds", "/kept_seconds"}) {
      run.samples.push_back({number(ours->answer, figure), ours->child.peak_rss_mb, {}});
    }
    return run;
  };
  return loader;
}

// The NIfTI volumes in a folder.
std::vector<fs::path> volumesIn(const fs::path& out) {
  std::vector<fs::path> volumes;
  std::error_code error;
  for (fs::directory_iterator it(out, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".nii") volumes.push_back(it->path());
  }
  return volumes;
}

Loader peerLoader(const Peer& peer, const LoaderPlaces& places, bool makes_volume) {
  Loader loader;
  loader.names = {peer.program};
  const std::optional<fs::path> program = findProgram(peer.program);
  if (!program) {
    loader.missing = "not installed";
    return loader;
  }
  loader.run = [=](const fs::path& folder, const KnownVolume* known,
                   const Progress& progress) -> Result<LoaderRun> {
    const RunFolder out(places.scratch);
    if (!out.made()) return out.made().error();
    ChildCommand command;
    command.words = {program->string()};
    for (const std::string& argument : peer.arguments) {
      command.words.push_back(
          replaced(replaced(argument, "FOLDER", folder.string()), "OUT", out.path().string()));
    }
    command.output = out.path() / "stdout";
    command.home = out.path();
    command.limit_s = places.limit_s;
    Result<ChildRun> child = runChild(command, progress);
    if (!child) {
      if (child.error().code == "CANCELLED") return child.error();
      return failed(child.error().what);
    }
    if (child->timed_out) return failed(tookTooLong(places.limit_s));
    LoaderRun run;
    const std::vector<fs::path> volumes = volumesIn(out.path());
    if (child->exit_code != 0) {
      run.problem = "failed with exit code " + std::to_string(child->exit_code);
    } else if (makes_volume && volumes.size() != 1) {
      run.problem = "wrote " + std::to_string(volumes.size()) + " volumes";
    } else {
      run.samples.push_back({child->seconds, child->peak_rss_mb, std::nullopt});
    }
    if (makes_volume && !run.problem.empty()) run.correct = false;
    if (makes_volume && run.problem.empty() && known) {
      run.correct = holdsKnownVoxels(volumes.front(), *known);
    }
    return run;
  };
  return loader;
}

// +1 or -1 for a unit vector along the axis, else 0.
int wayAlong(const Vec3& direction, int axis) {
  Vec3 unit(0.0);
  unit[axis] = 1.0;
  const double along = glm::dot(direction, unit);
  return std::abs(along) > 0.999 ? (along > 0.0 ? 1 : -1) : 0;
}

}  // namespace

bool holdsKnownVoxels(const fs::path& file, const KnownVolume& known) {
  const Result<Volume> read = readVolume(file);
  if (!read || read->geometry.size != known.geometry.size) return false;
  const Index3& size = read->geometry.size;
  std::array<bool, 3> turned{};
  for (int axis = 0; axis < 3; ++axis) {
    const int way = wayAlong(read->geometry.direction[axis], axis);
    if (way == 0) return false;
    turned[std::size_t(axis)] = way < 0;
  }
  Volume upright{known.geometry, {}};
  upright.hu.reserve(read->hu.size());
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      const int from_j = turned[1] ? size[1] - 1 - j : j;
      const int from_k = turned[2] ? size[2] - 1 - k : k;
      const auto row = read->hu.begin() + std::ptrdiff_t(read->geometry.indexOf(0, from_j, from_k));
      if (turned[0]) {
        std::reverse_copy(row, row + size[0], std::back_inserter(upright.hu));
      } else {
        std::copy(row, row + size[0], std::back_inserter(upright.hu));
      }
    }
  }
  return volumeSha256(upright) == known.sha256;
}

std::vector<Loader> ownLoaders(const LoaderPlaces& places) {
  return {importLoader(places), floorLoader(places)};
}

std::vector<Loader> peerLoaders(const LoaderPlaces& places) {
  std::vector<Loader> loaders;
  for (const Peer& peer : peers()) loaders.push_back(peerLoader(peer, places, true));
  return loaders;
}

Loader ownScanner(const LoaderPlaces& places) {
  Loader loader;
  loader.names = {"trephine"};
  loader.threads = int(std::max(1U, std::thread::hardware_concurrency()));
  loader.run = [places](const fs::path& folder, const KnownVolume*,
                        const Progress& progress) -> Result<LoaderRun> {
    Result<OwnRun> ours = runImport(places, folder, progress);
    if (!ours) return ours.error();
    if (!ours->problem.empty()) return failed(ours->problem);
    LoaderRun run;
    run.samples.push_back({number(ours->answer, "/seconds/scan"), ours->child.peak_rss_mb, {}});
    return run;
  };
  return loader;
}

Loader peerScanner(const LoaderPlaces& places) {
  return peerLoader(scanningPeer(), places, false);
}

}  // namespace trephine
